//! The models of section 5.2.4, as triangles.

mod bezier;
mod newell;
mod teapot;
mod torus;
mod x_wing;

pub use teapot::teapot;
pub use torus::{MAJOR, MINOR, torus};
pub use x_wing::x_wing;

use crate::comparators::tree::Triangle;

/// A model under its name.
pub struct Model {
    /// As the thesis calls it.
    pub name: &'static str,
    /// Its surface.
    pub triangles: Vec<Triangle>,
}

/// The three models that the thesis measures.
pub fn all() -> [Model; 3] {
    [
        Model { name: "Torus", triangles: torus() },
        Model { name: "X-wing", triangles: x_wing() },
        Model { name: "Teapot", triangles: teapot() },
    ]
}

/// The triangles of a grid of `n` by `m` cells; those without area, where a side of the grid is a point, are left out.
fn grid(
    n: usize,
    m: usize,
    point: impl Fn(f64, f64) -> solid3d::glam::DVec3,
) -> impl Iterator<Item = Triangle> {
    let at = move |i: usize, j: usize| point(i as f64 / n as f64, j as f64 / m as f64);
    (0..n * m)
        .flat_map(move |cell| {
            let (i, j) = (cell / m, cell % m);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .filter(|[p, q, r]| p != q && q != r && r != p)
}

#[cfg(test)]
mod tests {
    use solid3d::Aabb;

    use super::*;

    #[test]
    fn the_models_have_as_many_triangles_as_in_the_thesis() {
        let counts = all().map(|model| (model.name, model.triangles.len()));
        assert_eq!(counts, [("Torus", 5000), ("X-wing", 6084), ("Teapot", 3752)]);
    }

    #[test]
    fn the_teapot_is_as_large_as_newells() {
        let bounds = Aabb::of_points(teapot().into_iter().flatten());
        // The surface reaches the control points only at the corners of patches; the spout bulges beyond its own.
        assert_eq!((bounds.min.z, bounds.max.z), (0.0, 3.15));
        assert_eq!((bounds.min.x, bounds.min.y, bounds.max.y), (-3.0, -2.0, 2.0));
        assert!((3.4..3.45).contains(&bounds.max.x), "{}", bounds.max.x);
    }
}
