//! The one door to wide instructions.
//!
//! Loops over lanes are written once, over `fearless_simd`'s vectors, and compiled for each level of instructions; which
//! level runs is chosen here, at run time. A level changes no bit of any answer: no loop contracts a product and a sum, ties
//! go to the lowest lane or index, and the scalar level is what tests hold the others against.

use std::sync::OnceLock;

use fearless_simd::Level;

/// The level of instructions that loops over lanes use: the widest of this machine, or what the environment variable
/// `SOLID_SIMD` says when the process first asks: `scalar` (no vectors at all) or `baseline` (what every machine of the
/// architecture has). Any other value is as if it were not set.
pub fn level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    *LEVEL.get_or_init(|| named(std::env::var("SOLID_SIMD").ok().as_deref()))
}

fn named(name: Option<&str>) -> Level {
    match name {
        Some("scalar") => Level::fallback(),
        Some("baseline") => Level::baseline(),
        _ => Level::new(),
    }
}

/// All levels that this machine can run, from scalar to widest: for tests that hold them against each other.
pub fn levels() -> [Level; 3] {
    [Level::fallback(), Level::baseline(), Level::new()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_chosen_by_its_name() {
        assert!(named(Some("scalar")).is_fallback());
        assert_eq!(format!("{:?}", named(Some("baseline"))), format!("{:?}", Level::baseline()));
        assert_eq!(format!("{:?}", named(None)), format!("{:?}", Level::new()));
        assert_eq!(format!("{:?}", named(Some("other"))), format!("{:?}", Level::new()));
    }
}
