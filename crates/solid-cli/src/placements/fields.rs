//! The fields of a row of placements, each checked on its own.

use solid3d::glam::{DAffine3, DQuat, DVec3, DVec4};

use crate::words::quoted;

/// What is wrong with a field, without the place.
pub type Result<T> = std::result::Result<T, String>;

/// A frame's number.
pub fn frame(text: &str) -> Result<u64> {
    text.parse().map_err(|_| format!("frame is {}; expected a whole number, at least 0", quoted(text)))
}

/// The placement that the fields tx to qw, and perhaps sx to sz, say; `names` are their columns.
pub fn placement(texts: &[&str], names: &[&str]) -> Result<DAffine3> {
    let mut x = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    for ((x, text), name) in x.iter_mut().zip(texts).zip(names) {
        *x = number(text, name)?;
    }
    let [tx, ty, tz, qx, qy, qz, qw, sx, sy, sz] = x;
    let rotation = rotation(DVec4::new(qx, qy, qz, qw))?;
    Ok(DAffine3::from_scale_rotation_translation(DVec3::new(sx, sy, sz), rotation, DVec3::new(tx, ty, tz)))
}

fn number(text: &str, name: &str) -> Result<f64> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("{name} is {}; expected a finite number", quoted(text))),
    }
}

/// The rotation of a quaternion (x, y, z, w) of any length but zero.
fn rotation(q: DVec4) -> Result<DQuat> {
    let largest = q.abs().max_element();
    if largest == 0.0 {
        return Err("the quaternion qx, qy, qz, qw is zero; expected a rotation".to_owned());
    }
    // Scaled first, so that the squares neither overflow nor vanish.
    Ok(DQuat::from_vec4((q / largest).normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 10] = ["tx", "ty", "tz", "qx", "qy", "qz", "qw", "sx", "sy", "sz"];

    fn parse(row: &str) -> Result<DAffine3> {
        placement(&row.split(' ').collect::<Vec<_>>(), &NAMES)
    }

    #[test]
    fn quaternions_of_any_length_are_rotations() {
        let turned = parse("1 2 3 0 0 0.7071067811865476 0.7071067811865476").expect("a rotation");
        for scale in ["1e-300", "1", "1e300", "-7"] {
            let placement = parse(&format!("1 2 3 0 0 {scale} {scale}")).expect("a rotation");
            assert!(placement.abs_diff_eq(turned, 1e-15), "{scale}");
        }
        assert!(turned.transform_point3(DVec3::X).abs_diff_eq(DVec3::new(1.0, 3.0, 3.0), 1e-15));
    }

    #[test]
    fn scale_comes_first() {
        let placement = parse("1 0 0 0 0 1 0 2 3 4").expect("a half turn about z");
        assert!(placement.transform_point3(DVec3::ONE).abs_diff_eq(DVec3::new(-1.0, -3.0, 4.0), 1e-14));
    }

    #[test]
    fn what_is_no_placement_is_named() {
        for (row, message) in [
            ("1 2 3 0 0 0 0", "the quaternion qx, qy, qz, qw is zero; expected a rotation"),
            ("1 2 3 0 nan 0 1", "qy is \"nan\"; expected a finite number"),
            ("1 inf 3 0 0 0 1", "ty is \"inf\"; expected a finite number"),
            ("1 2 3 0 0 0 1 1 1 1e999", "sz is \"1e999\"; expected a finite number"),
            ("one 2 3 0 0 0 1", "tx is \"one\"; expected a finite number"),
        ] {
            assert_eq!(parse(row), Err(message.to_owned()));
        }
        assert!(frame("-1").is_err() && frame("1.5").is_err() && frame("99999999999999999999").is_err());
        assert_eq!(frame("4000000000"), Ok(4_000_000_000));
    }
}
