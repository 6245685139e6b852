//! Convex shapes that are held against triangles in closed form, eight at a time: points, balls and capsules that their placement leaves
//! what they are, and boxes under any placement.

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::Support;
use solid_convex::simd::each;

use super::closed_form::Similarity;
use super::frame::Frame;
use super::reach::core;
use super::row::{Cube, Near, Row, Verdict, distances_of_core, exceed, stretch_max};
use crate::bounds::Aabb;
use crate::placement::{inverse_linear, row_norm};

/// What a convex shape is to triangles.
pub(super) enum Direct {
    Round(Round),
    Cube(Cube),
    /// Known by its support mapping.
    None,
}

/// All that is within a radius of a core, in the common frame.
#[derive(Clone, Copy)]
pub(super) struct Round {
    pub radius: f64,
    /// The ends of the core, in the shape's own space: of a ball both the same.
    pub local_ends: [DVec3; 2],
    /// The way from that space.
    pub at: Similarity,
    ends: [DVec3; 2],
}

impl Direct {
    /// A gap of `gap` in the common frame is clear.
    pub fn new(shape: &dyn Support, frame: &Frame, gap: f64) -> Direct {
        match cube(shape, frame, gap) {
            Some(cube) => Direct::Cube(cube),
            None => Direct::round(shape, frame),
        }
    }

    /// What is not round is known by its support mapping.
    pub fn round(shape: &dyn Support, frame: &Frame) -> Direct {
        Round::new(shape, frame).map_or(Direct::None, Direct::Round)
    }
}

impl Round {
    fn new(shape: &dyn Support, frame: &Frame) -> Option<Round> {
        let (local_ends, radius) = core(shape).or_else(|| Some((point(shape)?, 0.0)))?;
        let map = &frame.common[1];
        let at = Similarity::new(&map.matrix3)?;
        let ends = each(local_ends, |end| map.transform_point3(end));
        Some(Round { radius: radius * at.stretch, local_ends, at, ends })
    }

    /// The centre of a ball, in the common frame; `None` for a capsule.
    pub fn center(&self) -> Option<DVec3> {
        (self.ends[0] == self.ends[1]).then_some(self.ends[0])
    }

    /// The box around it.
    pub fn bounds(&self) -> Aabb {
        Aabb::of_points(self.ends).inflated(self.radius)
    }

    /// The distances of the core and the triangles of a row in some lanes, given as bits.
    #[inline(always)]
    pub fn distances<S: Simd>(&self, simd: S, row: &Row, lanes: u32) -> Near {
        let [end, other] = self.ends;
        if end == other {
            distances_of_core(simd, &[end], row, lanes)
        } else {
            distances_of_core(simd, &self.ends, row, lanes)
        }
    }

    /// Which of the triangles in some lanes meet it, and which do not, by a gap or an overlap of at least `gap`.
    #[inline(always)]
    pub fn verdict<S: Simd>(&self, simd: S, row: &Row, lanes: u32, gap: f64) -> Verdict {
        let near = self.distances(simd, row, lanes);
        let apart = exceed(simd, &near.least, self.radius + gap);
        let meet = !exceed(simd, &near.distance, self.radius - gap);
        Verdict { meet: meet & lanes, apart: apart & lanes }
    }
}

/// The place of what is a single point, twice.
fn point(shape: &dyn Support) -> Option<[DVec3; 2]> {
    match shape.as_polytope()?.points() {
        &[point] => Some([point; 2]),
        _ => None,
    }
}

/// The cube that a box is in a space of its own.
fn cube(shape: &dyn Support, frame: &Frame, gap: f64) -> Option<Cube> {
    let [x, y, z] = shape.half_edges()?;
    let relative = frame.relative();
    let of_complex = frame.stretch_of_a();
    let to_cube = inverse_linear(&DMat3::from_cols(x, y, z));
    let linear = to_cube * relative.a_to_b.matrix3;
    let translation = to_cube * (relative.a_to_b.translation - shape.center());
    let growth = stretch_max(&linear) / of_complex.least;
    let slack = relative.slack_in_b * row_norm(&to_cube);
    Cube::new(DAffine3 { matrix3: linear, translation }, growth, gap, slack)
}
