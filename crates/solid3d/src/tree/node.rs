//! The eight-wide node.

use super::packed::{FAR, PackedBox};
use std::ops::Range;

/// The number of children of a node.
pub(super) const WIDTH: usize = 8;

/// The greatest number of primitives in a leaf: as many as are tested at once.
pub const LEAF_SIZE: usize = 8;

/// The greatest number of primitives: a child word holds 28 bits of position, the last of which marks an empty lane.
pub const PRIMITIVES_MAX: usize = (1 << 28) - 1;

/// Eight boxes as structure of arrays, and what each bounds.
///
/// Lanes in use come first. Empty lanes hold an inverted box, which is neutral in a union and overlaps nothing that
/// lies within [`FAR`].
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Node {
    pub min: [[f32; WIDTH]; 3],
    pub max: [[f32; WIDTH]; 3],
    pub child: [Child; WIDTH],
}

impl Node {
    pub const EMPTY: Node =
        Node { min: [[FAR; WIDTH]; 3], max: [[-FAR; WIDTH]; 3], child: [Child::EMPTY; WIDTH] };

    /// The box of a lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> PackedBox {
        let (min, max) = (&self.min, &self.max);
        PackedBox([
            min[0][lane],
            min[1][lane],
            min[2][lane],
            FAR, //
            -max[0][lane],
            -max[1][lane],
            -max[2][lane],
            FAR,
        ])
    }

    /// Sets the box of a lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, bounds: &PackedBox) {
        let (min, max) = (bounds.min(), bounds.max());
        for axis in 0..3 {
            self.min[axis][lane] = min[axis];
            self.max[axis][lane] = max[axis];
        }
    }

    /// The union of all lanes.
    #[inline(always)]
    pub fn union(&self) -> PackedBox {
        let mut bounds = PackedBox::EMPTY;
        for axis in 0..3 {
            bounds.0[axis] = least(&self.min[axis]);
            bounds.0[4 + axis] = -greatest(&self.max[axis]);
        }
        bounds
    }
}

#[inline(always)]
fn least(lanes: &[f32; WIDTH]) -> f32 {
    halves(lanes, |a, b| if a < b { a } else { b })
}

#[inline(always)]
fn greatest(lanes: &[f32; WIDTH]) -> f32 {
    halves(lanes, |a, b| if a > b { a } else { b })
}

/// Reduces eight lanes to one, half by half, as a vector unit does.
#[inline(always)]
pub(super) fn halves(l: &[f32; WIDTH], f: impl Fn(f32, f32) -> f32) -> f32 {
    let mut four = [0.0; 4];
    for (i, x) in four.iter_mut().enumerate() {
        *x = f(l[i], l[i + 4]);
    }
    f(f(four[0], four[2]), f(four[1], four[3]))
}

/// What a lane bounds, in one word: bit 31 set, a leaf of `(word >> 28 & 7) + 1` primitives from `word & (2^28 - 1)`; else a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

/// A child word, decoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The lane is not in use.
    Empty,
    /// A node, by index.
    Inner(usize),
    /// A range of the tree's order.
    Leaf(Range<usize>),
}

const LEAF_BIT: u32 = 1 << 31;
const START_BITS: u32 = 28;

impl Child {
    /// Would be the leaf that starts at 2^28 - 1, which [`PRIMITIVES_MAX`] rules out.
    pub const EMPTY: Child = Child(u32::MAX);

    pub fn inner(node: usize) -> Self {
        Child(node as u32)
    }

    pub fn leaf(range: Range<usize>) -> Self {
        assert!((1..=LEAF_SIZE).contains(&range.len()) && range.end <= PRIMITIVES_MAX);
        Child(LEAF_BIT | ((range.len() - 1) as u32) << START_BITS | range.start as u32)
    }

    /// The same among nodes that stand after `first` others.
    #[cfg(feature = "rayon")]
    pub fn after(self, first: usize) -> Self {
        match self.kind() {
            Kind::Inner(node) => Child::inner(node + first),
            Kind::Empty | Kind::Leaf(_) => self,
        }
    }

    #[inline]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF_BIT != 0
    }

    #[inline]
    pub fn kind(self) -> Kind {
        if self == Child::EMPTY {
            Kind::Empty
        } else if self.is_leaf() {
            let start = (self.0 & ((1 << START_BITS) - 1)) as usize;
            Kind::Leaf(start..start + (self.0 >> START_BITS & 7) as usize + 1)
        } else {
            Kind::Inner(self.0 as usize)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn child_words_decode_to_what_was_encoded() {
        let last = PRIMITIVES_MAX - 1..PRIMITIVES_MAX;
        for range in [0..1, 0..8, 17..20, last] {
            assert_eq!(Child::leaf(range.clone()).kind(), Kind::Leaf(range));
        }
        assert_eq!(Child::inner(12).kind(), Kind::Inner(12));
        assert_eq!(Child::EMPTY.kind(), Kind::Empty);
    }

    #[test]
    fn an_empty_node_is_neutral() {
        let mut node = Node::EMPTY;
        assert_eq!(node.union(), PackedBox::EMPTY);
        let bounds = PackedBox([0.0, 1.0, 2.0, FAR, -3.0, -4.0, -5.0, FAR]);
        node.set_lane(3, &bounds);
        assert_eq!(node.lane(3), bounds);
        assert_eq!(node.union(), bounds);
    }
}
