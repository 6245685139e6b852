//! The chain of vertices as the exact predicates see it.

use glam::{DVec2, DVec3};

use super::exact::{self, flatten, height, turn};

/// Four times covers the rounding of a determinant's value, of which only the sign is exact.
const WAVINESS_FACTOR: f64 = 4.0;

/// Vertices in a scale in which predicates are exact.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub vertices: Vec<DVec3>,
    /// `None` exactly if the vertices are collinear.
    pub base: Option<Base>,
    /// The greatest height of a vertex over the base, as [`height`] has it; 0 exactly if the vertices are coplanar.
    waviness: f64,
}

/// What stands for the polygon's plane: three vertices that are not collinear, nor appear so along the dropped axis, from
/// which they run counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Base {
    pub corners: [usize; 3],
    pub dropped: usize,
}

impl Chain {
    /// `normal` says which axis is best to drop: the one closest to it (thesis, section 3.2.1).
    pub fn new(vertices: Vec<DVec3>, normal: DVec3) -> Chain {
        let base = base(&vertices, normal);
        Chain::with_base(vertices, base)
    }

    /// A chain whose coordinates the predicates do not bear: to be scaled before use, by about `scale`.
    pub fn unfit(vertices: Vec<DVec3>, normal: DVec3, scale: f64) -> Chain {
        let base = base(&vertices.iter().map(|&p| scaled(p, scale)).collect::<Vec<_>>(), normal);
        Chain { vertices, base, waviness: 0.0 }
    }

    fn with_base(vertices: Vec<DVec3>, base: Option<Base>) -> Chain {
        let mut chain = Chain { vertices, base, waviness: 0.0 };
        let off = |p: &DVec3| base.map_or(0.0, |base| chain.side(base, *p).abs());
        chain.waviness = WAVINESS_FACTOR * chain.vertices.iter().map(off).fold(0.0, f64::max);
        chain
    }

    /// The chain in another unit of length; `scale` is a power of two.
    pub fn scaled(&self, scale: f64) -> Chain {
        Chain::with_base(self.vertices.iter().map(|&p| scaled(p, scale)).collect(), self.base)
    }

    /// Whether the vertices are exactly coplanar.
    pub fn is_flat(&self) -> bool {
        self.waviness == 0.0
    }

    /// Whether a point whose side is this is so near the plane that the unevenness of the polygon decides.
    pub fn is_unclear(&self, side: f64) -> bool {
        self.waviness > 0.0 && side.abs() <= self.waviness
    }

    /// Positive where a point lies above the plane of the base.
    pub fn side(&self, base: Base, point: DVec3) -> f64 {
        let [a, b, c] = base.corners.map(|i| self.vertices[i]);
        height(a, b, c, point)
    }

    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// The edges, by their vertices' places.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let n = self.len();
        (0..n).map(move |i| [i, if i + 1 == n { 0 } else { i + 1 }])
    }

    /// The vertices seen along an axis.
    pub fn flattened(&self, dropped: usize) -> Vec<DVec2> {
        self.vertices.iter().map(|&p| flatten(dropped, p)).collect()
    }
}

pub(super) fn scaled(p: DVec3, scale: f64) -> DVec3 {
    exact::plain(p * scale)
}

fn base(vertices: &[DVec3], normal: DVec3) -> Option<Base> {
    let first = *vertices.first()?;
    let far = (1..vertices.len()).max_by(|&i, &j| {
        vertices[i].distance_squared(first).total_cmp(&vertices[j].distance_squared(first))
    })?;
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| normal[j].abs().total_cmp(&normal[i].abs()));
    axes.into_iter().find_map(|dropped| {
        let turn_of = |i: usize| {
            turn(flatten(dropped, first), flatten(dropped, vertices[far]), flatten(dropped, vertices[i]))
        };
        let third = (1..vertices.len()).max_by(|&i, &j| turn_of(i).abs().total_cmp(&turn_of(j).abs()))?;
        let turned = turn_of(third);
        let corners = if turned > 0.0 { [0, far, third] } else { [0, third, far] };
        (turned != 0.0).then_some(Base { corners, dropped })
    })
}
