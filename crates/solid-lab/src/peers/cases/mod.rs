//! What is measured. A case draws inputs, brings them to each contestant, and lets them race; adding one is adding a function to
//! [`ALL`].

mod broad;
mod convex;
mod lifecycle;
mod mesh_convex;
mod meshes;
mod pairs;
mod primitives;
mod rays;
mod simulation;

use super::Bench;

/// A group of cases.
type Case = fn(&mut Bench);

/// All of them, with their names.
pub const ALL: [(&str, Case); 8] = [
    ("convex-pairs", convex::measure),
    ("primitive-pairs", primitives::measure),
    ("mesh-pairs", meshes::measure),
    ("mesh-and-convex", mesh_convex::measure),
    ("rays", rays::measure),
    ("build-refit-memory", lifecycle::measure),
    ("broad-phase", broad::measure),
    ("simulation", simulation::measure),
];

/// A number with commas between thousands.
pub fn with_commas(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn thousands_have_commas() {
        assert_eq!([1, 999, 1000, 1_234_567].map(super::with_commas), ["1", "999", "1,000", "1,234,567"]);
    }
}
