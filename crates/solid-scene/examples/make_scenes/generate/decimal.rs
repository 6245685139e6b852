//! Numbers as text.

/// Rounds to so many decimals: what platforms disagree on in sines is far beyond them.
pub fn round(x: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding 0 makes -0 into 0.
    (x * scale).round() / scale + 0.0
}

/// The shortest text of the rounded number.
pub fn text(x: f64, decimals: i32) -> String {
    round(x, decimals).to_string()
}

/// Numbers with something between.
pub fn list(numbers: impl IntoIterator<Item = f64>, decimals: i32, separator: &str) -> String {
    let texts: Vec<String> = numbers.into_iter().map(|x| text(x, decimals)).collect();
    texts.join(separator)
}
