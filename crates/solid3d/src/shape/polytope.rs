//! The convex hull of points, as a shape.

use glam::DVec3;
use solid_convex::{Points, Support};

use super::validate;
use crate::error::{Error, Result};
use crate::hull::Hull;

/// What [`Hull::of`] takes.
const POINTS_MAX: usize = (u32::MAX / 8) as usize;

/// A polytope by its vertices. Invariant: at least one, all of them extreme points of the hull.
#[derive(Debug)]
pub(crate) struct Polytope {
    vertices: Vec<DVec3>,
    reach: DVec3,
    center: DVec3,
}

impl Polytope {
    pub fn new(points: &[DVec3]) -> Result<Self> {
        validate::vertex_count("points", points.len())?;
        validate::at_most(POINTS_MAX, "points", points.len())?;
        validate::vertices(points)?;
        let hull = Hull::of(points).ok_or(Error::NoVertices { argument: "points" })?;
        let vertices: Vec<DVec3> = hull.vertices().iter().map(|&index| points[index as usize]).collect();
        let hull = Points::new(&vertices).ok_or(Error::NoVertices { argument: "points" })?;
        let (reach, center) = (hull.reach(), hull.center());
        Ok(Polytope { vertices, reach, center })
    }

    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }
}

impl Support for Polytope {
    fn support(&self, direction: DVec3) -> DVec3 {
        Points::new(&self.vertices).map_or(DVec3::ZERO, |hull| hull.support(direction))
    }

    fn reach(&self) -> DVec3 {
        self.reach
    }

    fn center(&self) -> DVec3 {
        self.center
    }
}
