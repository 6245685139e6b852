use solid3d::glam::DVec3;

/// The directions that make no obtuse angle with any of some vectors: a convex cone, as its extreme rays in order around it.
///
/// It tells whether an axis is left that weakly separates the origin from all points met so far (thesis, section 4.2.2).
#[derive(Clone, Debug, Default)]
pub struct Cone {
    rays: Vec<Ray>,
    spare: Vec<Ray>,
    /// Whether any vector has been met; before that the cone is everything.
    bounded: bool,
}

/// An extreme ray, and the inward normal of the side from it to the next.
#[derive(Clone, Copy, Debug)]
struct Ray {
    along: DVec3,
    side: DVec3,
}

/// An angle from the boundary, in radians, below which a ray is on it: some tens of roundings.
const ON_BOUNDARY: f64 = 1e-14;

impl Cone {
    /// Everything again.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.bounded = false;
    }

    /// Cuts off the directions at an obtuse angle with `w`; false when no inside is left. Cost: linear in the rays.
    pub fn cut(&mut self, w: DVec3) -> bool {
        let w = w.normalize_or_zero();
        if !self.bounded {
            self.bounded = true;
            // A hemisphere, by four rays around its rim.
            let x = w.any_orthonormal_vector();
            let y = w.cross(x);
            self.rays.extend([x, y, -x, -y].map(|along| Ray { along, side: w }));
            return w != DVec3::ZERO;
        }
        self.spare.clear();
        let mut new_side = None;
        for (i, ray) in self.rays.iter().enumerate() {
            let next = &self.rays[(i + 1) % self.rays.len()];
            let (inside, next_inside) = (w.dot(ray.along) > ON_BOUNDARY, w.dot(next.along) > ON_BOUNDARY);
            if inside {
                self.spare.push(*ray);
            }
            // Going along the side, `along` moves towards side x along.
            if inside && !next_inside {
                new_side = Some(self.spare.len());
                self.spare.push(Ray { along: ray.side.cross(w).normalize_or(next.along), side: w });
            } else if !inside && next_inside {
                self.spare.push(Ray { along: w.cross(ray.side).normalize_or(ray.along), side: ray.side });
            }
        }
        std::mem::swap(&mut self.rays, &mut self.spare);
        if let Some(i) = new_side {
            let (from, to) = (self.rays[i].along, self.rays[(i + 1) % self.rays.len()].along);
            if from.dot(to) < 0.0 {
                // Beyond a right angle a ray in between keeps the mean of the rays inside.
                self.rays.insert(i + 1, Ray { along: w.cross(from), side: w });
            }
        }
        !self.rays.is_empty()
    }

    /// A direction well inside.
    pub fn inside(&self) -> DVec3 {
        let sum: DVec3 = self.rays.iter().map(|ray| ray.along).sum();
        let side = self.rays.first().map_or(DVec3::X, |ray| ray.side);
        // The rays of a hemisphere cancel out.
        if sum.length() > ON_BOUNDARY { sum.normalize() } else { side }
    }
}
