use super::ExactVec3;

/// Whether the convex hull of at most four points contains the origin: closed, exact, degenerate simplices included.
pub(crate) fn contains_origin(points: &[ExactVec3]) -> bool {
    match points {
        [] => false,
        [a] => a.is_zero(),
        [a, b] => segment_contains_origin(a, b),
        [a, b, c] => triangle_contains_origin(a, b, c),
        [a, b, c, d] => tetrahedron_contains_origin([a, b, c, d]),
        _ => unreachable!("a simplex in space has at most four vertices"),
    }
}

fn segment_contains_origin(a: &ExactVec3, b: &ExactVec3) -> bool {
    a.cross(b).is_zero() && a.dot(b).sign() <= 0
}

fn triangle_contains_origin(a: &ExactVec3, b: &ExactVec3, c: &ExactVec3) -> bool {
    let (ab, bc, ca) = (a.cross(b), b.cross(c), c.cross(a));
    let normal = &(&ab + &bc) + &ca;
    if normal.is_zero() {
        return segment_contains_origin(a, b)
            || segment_contains_origin(b, c)
            || segment_contains_origin(c, a);
    }
    normal.dot(a).sign() == 0 && [ab, bc, ca].iter().all(|weight| normal.dot(weight).sign() >= 0)
}

fn tetrahedron_contains_origin([a, b, c, d]: [&ExactVec3; 4]) -> bool {
    let det = |x: &ExactVec3, y: &ExactVec3, z: &ExactVec3| x.dot(&y.cross(z)).sign();
    let volume = det(&(b - a), &(c - a), &(d - a));
    if volume == 0 {
        return [[a, b, c], [a, b, d], [a, c, d], [b, c, d]]
            .iter()
            .any(|[x, y, z]| triangle_contains_origin(x, y, z));
    }
    // The weight of a vertex is the volume of the tetrahedron with that vertex replaced by the origin.
    [det(b, c, d), -det(a, c, d), det(a, b, d), -det(a, b, c)].iter().all(|&sign| sign * volume >= 0)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec3};

    use super::*;

    fn contains(points: &[DVec3]) -> bool {
        contains_origin(&points.iter().map(|&p| ExactVec3::from_f64(p)).collect::<Vec<_>>())
    }

    #[test]
    fn a_tetrahedron_is_closed_and_its_orientation_does_not_matter() {
        let mut t =
            [dvec3(-1.0, -1.0, -1.0), dvec3(3.0, 0.0, 0.0), dvec3(0.0, 3.0, 0.0), dvec3(0.0, 0.0, 3.0)];
        assert!(contains(&t));
        t.swap(0, 1);
        assert!(contains(&t));
        t[1] = dvec3(1e-300, 0.0, 0.0);
        assert!(!contains(&t));
        t[1] = DVec3::ZERO;
        assert!(contains(&t));
    }

    #[test]
    fn degenerate_simplices_are_decided() {
        let x = DVec3::X;
        assert!(contains(&[-x, x, 2.0 * x, 3.0 * x]));
        assert!(!contains(&[x, x, 2.0 * x, 3.0 * x]));
        assert!(contains(&[x, DVec3::Y, dvec3(-1.0, -1.0, 0.0), x]));
        assert!(!contains(&[x, DVec3::Y, dvec3(-1.0, -1.0, 1e-9)]));
        assert!(contains(&[x, -x]) && !contains(&[x, dvec3(-1.0, 1e-200, 0.0)]));
    }
}
