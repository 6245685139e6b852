use solid3d::glam::{DAffine3, DMat3, DVec3};

/// The points x with `normal . x = offset`; below it is where the product is less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A unit vector.
    pub normal: DVec3,
    /// The distance from the origin, along the normal.
    pub offset: f64,
}

/// Where something is, seen from a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Below,
    On,
    Above,
    Both,
}

impl Plane {
    /// Through a point, with a normal of any length; `None` when it has none.
    pub fn through(point: DVec3, normal: DVec3) -> Option<Plane> {
        let normal = normal.try_normalize()?;
        Some(Plane { normal, offset: normal.dot(point) })
    }

    /// How far above the plane a point is.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// The plane of the points that `placement` takes the plane's to; `transposed_inverse` is that of its matrix.
    pub fn placed(&self, placement: &DAffine3, transposed_inverse: &DMat3) -> Plane {
        let point = placement.transform_point3(self.normal * self.offset);
        Plane::through(point, *transposed_inverse * self.normal)
            .expect("a matrix with an inverse keeps a normal")
    }

    /// Where the point of the segment from `below` to `above` is that lies in the plane, their heights being known.
    pub fn crossing(below: (DVec3, f64), above: (DVec3, f64)) -> DVec3 {
        below.0 + (above.0 - below.0) * (below.1 / (below.1 - above.1))
    }
}

impl Side {
    /// Of points of these heights.
    pub fn of_heights(heights: impl IntoIterator<Item = f64>, tolerance: f64) -> Side {
        let (mut below, mut above) = (false, false);
        for height in heights {
            below |= height < -tolerance;
            above |= height > tolerance;
        }
        match (below, above) {
            (true, true) => Side::Both,
            (true, false) => Side::Below,
            (false, true) => Side::Above,
            (false, false) => Side::On,
        }
    }
}

/// The parts of a convex polygon below and above a plane, and the points on it. A part may have less than three corners: then there is
/// none.
pub fn cut_polygon(polygon: &[DVec3], plane: &Plane, tolerance: f64) -> [Vec<DVec3>; 3] {
    let [mut below, mut above, mut on] = [const { Vec::new() }; 3];
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let [at_p, at_q] = [p, q].map(|x| plane.height(x));
        match Side::of_heights([at_p], tolerance) {
            Side::Below => below.push(p),
            Side::Above => above.push(p),
            Side::On | Side::Both => {
                for part in [&mut below, &mut above, &mut on] {
                    part.push(p);
                }
            }
        }
        if Side::of_heights([at_p, at_q], tolerance) == Side::Both {
            // From below to above, so that both faces of an edge get the same point.
            let x = if at_p < at_q {
                Plane::crossing((p, at_p), (q, at_q))
            } else {
                Plane::crossing((q, at_q), (p, at_p))
            };
            for part in [&mut below, &mut above, &mut on] {
                part.push(x);
            }
        }
    }
    [below, above, on]
}
