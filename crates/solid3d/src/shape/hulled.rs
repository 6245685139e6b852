//! A convex hull as a shape: its support mapping, and its faces when they are asked for.

use std::sync::OnceLock;

use glam::DVec3;
use solid_convex::Polytope;

use super::Complex;
use super::facets::Facets;
use super::surface::of_hull;
use crate::hull::Hull;

/// A polytope, with its faces once they were needed.
#[derive(Clone, Debug)]
pub(crate) struct Hulled {
    polytope: Polytope,
    facets: OnceLock<Facets>,
    surface: OnceLock<Box<Complex>>,
}

impl Hulled {
    /// The hull of points; `None` for none.
    pub fn new(points: Vec<DVec3>) -> Option<Hulled> {
        Some(Polytope::new(points)?.into())
    }

    /// The hull of points whose faces are known; `None` for no points.
    pub fn with_facets(points: Vec<DVec3>, facets: Facets) -> Option<Hulled> {
        Some(Hulled { facets: facets.into(), ..Hulled::new(points)? })
    }

    /// A hull, of the points that it was made from.
    pub fn of(hull: &Hull, points: &[DVec3]) -> Hulled {
        let mut slots = vec![0; points.len()];
        (0u32..).zip(hull.vertices()).for_each(|(slot, &i)| slots[i as usize] = slot);
        let faces: Vec<[u32; 3]> =
            hull.triangles().iter().map(|corners| corners.map(|i| slots[i as usize])).collect();
        let extreme = hull.vertices().iter().map(|&i| points[i as usize]).collect();
        Polytope::new(extreme).expect("a hull has a vertex").with_faces(&faces).into()
    }

    pub fn polytope(&self) -> &Polytope {
        &self.polytope
    }

    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        let of_surface = self.surface.get().map_or(0, |surface| surface.memory());
        self.polytope.bytes() + self.facets.get().map_or(0, Facets::bytes) + of_surface
    }

    pub fn points(&self) -> &[DVec3] {
        self.polytope.points()
    }

    /// The faces. Cost: O(n log n) at the first call.
    pub fn facets(&self) -> &Facets {
        self.facets.get_or_init(|| Facets::of(self.points()))
    }

    /// Its surface as a mesh of exactly flat triangles. Cost: O(n log n) at the first call.
    pub fn surface(&self) -> &Complex {
        self.surface.get_or_init(|| Box::new(of_hull(self.points().to_vec())))
    }
}

impl From<Polytope> for Hulled {
    fn from(polytope: Polytope) -> Self {
        Hulled { polytope, facets: OnceLock::new(), surface: OnceLock::new() }
    }
}
