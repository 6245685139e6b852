//! Numbers and names in words for people.

use solid3d::glam::DVec3;

/// How many digits of a coordinate are worth reading.
const DIGITS: i32 = 4;

/// `1 frame`, `2 frames`.
pub fn count(n: impl Into<u64>, noun: &str) -> String {
    match n.into() {
        1 => format!("1 {noun}"),
        n if noun.ends_with('x') => format!("{n} {noun}es"),
        n => format!("{n} {noun}s"),
    }
}

/// What so many things do: `is`, `are`.
pub fn are(n: impl Into<u64>) -> &'static str {
    if n.into() == 1 { "is" } else { "are" }
}

/// A number of things, to count.
pub fn size(n: usize) -> u64 {
    n as u64
}

/// A time or duration in seconds, without the unit: to the millisecond, as far as there are digits for it.
pub fn seconds(time: f64) -> String {
    if time < 1e12 { format!("{time:.3}") } else { figure(time) }
}

/// A point, to four significant digits.
pub fn point(p: DVec3) -> String {
    format!("({}, {}, {})", figure(p.x), figure(p.y), figure(p.z))
}

/// A number, to four significant digits.
pub fn figure(x: f64) -> String {
    let magnitude = if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    if !(-4..=6).contains(&magnitude) {
        return format!("{x:.*e}", (DIGITS - 1) as usize);
    }
    let text = format!("{x:.*}", (DIGITS - 1 - magnitude).max(0) as usize);
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A name from a file as it can be shown: characters that could move the cursor, or turn what stands around them, escaped.
pub fn printable(name: &str) -> String {
    let escape = |c: char| match c.is_control() || is_bidi_control(c) {
        true => c.escape_default().collect(),
        false => String::from(c),
    };
    name.chars().map(escape).collect()
}

/// Whether a character changes the direction of writing (Unicode's property Bidi_Control).
fn is_bidi_control(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A text from a file in quotes, escaped, as far as anybody would read it.
pub fn quoted(text: &str) -> String {
    const CHARS_MAX: usize = 80;
    let shown: String = text.chars().take(CHARS_MAX).collect();
    format!("{shown:?}{}", if shown.len() < text.len() { "..." } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_four_digits_and_no_idle_zeros() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (1.23456, "1.235"),
            (12345.6, "12346"),
            (0.000123456, "0.0001235"),
            (1e-9, "1.000e-9"),
            (-1.5e20, "-1.500e20"),
            (9.99996, "10"),
            (100.0, "100"),
        ];
        for (x, text) in cases {
            assert_eq!(figure(x), text);
        }
    }

    #[test]
    fn nouns_agree_with_their_number() {
        assert_eq!(count(1u64, "frame"), "1 frame");
        assert_eq!(count(0u64, "frame"), "0 frames");
        assert_eq!(count(2u64, "box"), "2 boxes");
    }

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        assert_eq!(printable("a\x1b[2Jb\n"), "a\\u{1b}[2Jb\\n");
        assert_eq!(printable("Würfel 1"), "Würfel 1");
        assert_eq!(quoted("a\x1b[2Jb"), "\"a\\u{1b}[2Jb\"");
    }

    #[test]
    fn characters_that_turn_the_text_do_not_reach_the_terminal() {
        let controls = ['\u{61c}', '\u{200e}', '\u{200f}'].into_iter();
        for c in controls.chain('\u{202a}'..='\u{202e}').chain('\u{2066}'..='\u{2069}') {
            let escaped = format!("a\\u{{{:x}}}b", u32::from(c));
            assert_eq!(printable(&format!("a{c}b")), escaped);
            assert_eq!(quoted(&format!("a{c}b")), format!("\"{escaped}\""));
        }
        for name in ["שלום", "قطعة", "零件"] {
            assert_eq!(printable(name), name);
        }
    }

    #[test]
    fn long_texts_are_quoted_by_their_beginning() {
        assert_eq!(quoted(&"ü".repeat(80)), format!("\"{}\"", "ü".repeat(80)));
        assert_eq!(quoted(&"ü".repeat(81)), format!("\"{}\"...", "ü".repeat(80)));
    }
}
