//! Patches put together by the vertices that their primitives have in common.

use std::cmp::Ordering;
use std::collections::HashMap;

use foldhash::fast::RandomState;
use glam::DVec3;
use smallvec::{SmallVec, smallvec};

use super::{Part, Patch};

/// Normals that differ by less than this angle, in radians, are one.
const SAME_NORMAL: f64 = 1e-3;

/// Among more patches than so many, those are looked up whose normals are about as high along [`SKEW`].
const MANY: usize = 16;

/// A direction along which normals seldom are equally high that are not the same.
const SKEW: DVec3 = DVec3::new(0.36, 0.48, 0.8);

/// Normals that are one are no further from each other along that.
const SAME_HEIGHT: f64 = 1.01 * SAME_NORMAL;

/// So many pairs of vertices are kept of each patch, on average: two boxes have 64.
const MOST_CONNECTIONS: usize = 100;

/// Patches, and by which vertices they are connected: two are, when their primitives have a vertex in common, on each of the surfaces.
pub(super) struct Joining<'p> {
    patches: &'p [Patch],
    is_taken: Vec<bool>,
    corners: [Corners; 2],
    connections: Connections,
}

/// The vertices by which primitives are connected to others, in ascending order. A body is connected to itself.
type Corners = HashMap<u32, SmallVec<[u32; 4]>, RandomState>;

/// How the patches are found with which one is connected.
enum Connections {
    /// By pairs of vertices, one of each surface.
    Grouped(Groups),
    /// All others that are not taken are looked at: there are fewer of them than of pairs of vertices, or those would be too many to keep.
    Any(Vec<usize>),
}

/// The patches at each pair of vertices. Those of patch `i` are the groups `groups_of[starts[i]..starts[i + 1]]`.
struct Groups {
    groups: Vec<Neighbours>,
    groups_of: Vec<usize>,
    starts: Vec<usize>,
    /// How high the normal of each patch is along [`SKEW`].
    heights: Vec<f64>,
}

/// Patches that have a vertex of each surface in common.
struct Neighbours {
    /// Mostly few; more than [`MANY`] by their heights.
    patches: SmallVec<[usize; 4]>,
    /// The seed of the region that looked at them last.
    seen_by: Option<usize>,
}

impl<'p> Joining<'p> {
    pub fn new(a: &Part, b: &Part, patches: &'p [Patch]) -> Self {
        Joining::keeping(a, b, patches, patches.len().min(MOST_CONNECTIONS))
    }

    /// Of each patch so many pairs of vertices are kept at most, on average.
    fn keeping(a: &Part, b: &Part, patches: &'p [Patch], most: usize) -> Self {
        let mut corners = [a, b].map(|part| {
            let count = if matches!(part, Part::Soup(_)) { patches.len() } else { 1 };
            Corners::with_capacity_and_hasher(count, RandomState::default())
        });
        let mut count = 0u64;
        for patch in patches {
            let [i, j] = patch.touches[0].primitives;
            let of_a = corners[0].entry(i).or_insert_with(|| corners_of(a, i)).len();
            let of_b = corners[1].entry(j).or_insert_with(|| corners_of(b, j)).len();
            count += of_a as u64 * of_b as u64;
        }
        let connections = if count <= most as u64 * patches.len() as u64 {
            Connections::Grouped(Groups::new(&corners, patches))
        } else {
            Connections::Any((0..patches.len()).collect())
        };
        Joining { patches, is_taken: vec![false; patches.len()], corners, connections }
    }

    /// Takes a patch, and all of its normal that are connected with it; `None` when it is taken already. In ascending order.
    pub fn grow(&mut self, seed: usize) -> Option<Vec<usize>> {
        let Joining { patches, is_taken, corners, connections } = self;
        if std::mem::replace(&mut is_taken[seed], true) {
            return None;
        }
        let mut members = vec![seed];
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            next += 1;
            let mut take = |i: usize, is_connected: &dyn Fn() -> bool| {
                if !is_taken[i] && is_same(patches[i].normal, patches[seed].normal) && is_connected() {
                    is_taken[i] = true;
                    members.push(i);
                }
                is_taken[i]
            };
            match connections {
                Connections::Any(left) => {
                    left.retain(|&i| !take(i, &|| are_connected(corners, &patches[i], &patches[member])));
                }
                Connections::Grouped(groups) => groups.look_around(member, seed, |i| {
                    take(i, &|| true);
                }),
            }
        }
        members.sort_unstable();
        Some(members)
    }
}

impl Groups {
    fn new([of_a, of_b]: &[Corners; 2], patches: &[Patch]) -> Groups {
        let heights: Vec<f64> = patches.iter().map(|patch| patch.normal.dot(SKEW)).collect();
        let mut group_of: HashMap<[u32; 2], usize, RandomState> =
            HashMap::with_capacity_and_hasher(patches.len(), RandomState::default());
        let (mut groups, mut groups_of, mut starts) = (Vec::new(), Vec::new(), vec![0]);
        for (patch, Patch { touches, .. }) in patches.iter().enumerate() {
            let [i, j] = touches[0].primitives;
            for vertices in of_a[&i].iter().flat_map(|&x| of_b[&j].iter().map(move |&y| [x, y])) {
                let group = *group_of.entry(vertices).or_insert(groups.len());
                if group == groups.len() {
                    groups.push(Neighbours { patches: SmallVec::new(), seen_by: None });
                }
                groups[group].patches.push(patch);
                groups_of.push(group);
            }
            starts.push(groups_of.len());
        }
        for Neighbours { patches, .. } in groups.iter_mut().filter(|group| group.patches.len() > MANY) {
            patches.sort_by(|&i, &j| heights[i].total_cmp(&heights[j]));
        }
        Groups { groups, groups_of, starts, heights }
    }

    /// Tells all patches that have a pair of vertices with one in common, and may have the normal of a seed that has not been there.
    fn look_around(&mut self, patch: usize, seed: usize, mut tell: impl FnMut(usize)) {
        let Groups { groups, groups_of, starts, heights } = self;
        for &group in &groups_of[starts[patch]..starts[patch + 1]] {
            let Neighbours { patches, seen_by } = &mut groups[group];
            if seen_by.replace(seed) == Some(seed) {
                continue;
            }
            let [from, to] = [-1.0, 1.0].map(|sign| heights[seed] + sign * SAME_HEIGHT);
            let near = match patches.len() > MANY {
                true => {
                    patches.partition_point(|&i| heights[i] < from)
                        ..patches.partition_point(|&i| heights[i] <= to)
                }
                false => 0..patches.len(),
            };
            patches[near].iter().for_each(|&i| tell(i));
        }
    }
}

/// Whether two unit normals are one.
fn is_same(normal: DVec3, other: DVec3) -> bool {
    normal.dot(other) > 1.0 - 0.5 * SAME_NORMAL * SAME_NORMAL
}

/// Whether the primitives of two patches have a vertex in common, on each of the surfaces.
fn are_connected(corners: &[Corners; 2], x: &Patch, y: &Patch) -> bool {
    let [x, y] = [x.touches[0].primitives, y.touches[0].primitives];
    (0..2).all(|side| have_common(&corners[side][&x[side]], &corners[side][&y[side]]))
}

/// Whether two ascending lists have an element in common.
fn have_common(mut x: &[u32], mut y: &[u32]) -> bool {
    while let ([i, after_i @ ..], [j, after_j @ ..]) = (x, y) {
        match i.cmp(j) {
            Ordering::Equal => return true,
            Ordering::Less => x = after_i,
            Ordering::Greater => y = after_j,
        }
    }
    false
}

/// The vertices by which a primitive is connected to others.
fn corners_of(part: &Part, primitive: u32) -> SmallVec<[u32; 4]> {
    let Part::Soup(complex) = part else { return smallvec![0] };
    let mut corners: SmallVec<[u32; 4]> = complex.welded(primitive).collect();
    corners.sort_unstable();
    corners.dedup();
    // One that no other primitive has connects it with itself alone: of these the first of its corners will do.
    let first = corners[0];
    corners.retain(|&mut corner| corner == first || complex.topology().around(corner).len() > 1);
    corners
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use rand::rngs::StdRng;
    use solid_oracle::generate::{direction, seeded};

    use super::super::{Feature, Touch};
    use super::*;
    use crate::ComplexShapeBuilder;
    use crate::shape::{Class, Complex, Shape};

    /// Polyhedra that each have some of the same corners.
    fn pieces(rng: &mut StdRng, count: usize, corners: usize, share: f64) -> Shape {
        let vertices: Vec<DVec3> = (0..corners).map(|_| direction(rng)).collect();
        let mut piece = || -> Vec<u32> {
            let some: Vec<u32> = (0..corners as u32).filter(|_| rng.random_bool(share)).collect();
            if some.is_empty() { vec![0] } else { some }
        };
        (0..count)
            .fold(ComplexShapeBuilder::new(vertices), |pieces, _| pieces.polyhedron(&piece()))
            .build()
            .unwrap()
    }

    fn complex(shape: &Shape) -> &Complex {
        let Class::Complex(complex) = shape.class() else { unreachable!("pieces are complex") };
        complex
    }

    /// A patch for each pair of primitives, or one in so many; their normals are one of few, or off it by no more than an angle.
    fn patches(rng: &mut StdRng, [a, b]: [u32; 2], one_in: u32, angle: f64) -> Vec<Patch> {
        let pairs = (0..a).flat_map(|i| (0..b).map(move |j| [i, j]));
        let mut patch = |primitives| {
            let [on_a, on_b] = [DVec3::ZERO; 2];
            let touch = Touch { on_a, on_b, depth: 0.0, primitives, features: [Feature::Face(0); 2] };
            let off = direction(rng) * (angle * rng.random::<f64>());
            let normal = (DVec3::AXES[rng.random_range(0..3)] + off).normalize();
            Patch { normal, touches: vec![touch], is_inward: false }
        };
        pairs.filter(|[i, j]| (i + j) % one_in == 0).map(&mut patch).collect()
    }

    fn grown(mut joining: Joining) -> Vec<Option<Vec<usize>>> {
        (0..joining.patches.len()).map(|seed| joining.grow(seed)).collect()
    }

    /// Law: pairs of vertices join what is found by looking at all other patches.
    #[test]
    fn pairs_of_vertices_are_a_shortcut() {
        let mut rng = seeded(163);
        let mut joined = 0;
        for angle in [0.0, 0.5, 2.0].map(|part| part * SAME_NORMAL).into_iter().cycle().take(300) {
            let [a, b] = [(); 2].map(|()| {
                let (count, corners) = (rng.random_range(1..15), rng.random_range(1..40));
                let share = rng.random_range(0.02..0.3);
                pieces(&mut rng, count, corners, share)
            });
            let [a, b] = [&a, &b].map(complex);
            let one_in = rng.random_range(1..4);
            let patches =
                patches(&mut rng, [a, b].map(|complex| complex.primitive_count() as u32), one_in, angle);
            let [a, b] = [a, b].map(Part::Soup);
            let grouped = grown(Joining::keeping(&a, &b, &patches, 40 * 40));
            assert_eq!(grouped, grown(Joining::keeping(&a, &b, &patches, 0)));
            joined += grouped.iter().flatten().filter(|members| members.len() > 1).count();
        }
        assert!(joined > 500, "{joined}");
    }

    /// Pieces that all have the same thousand corners are a million pairs of vertices for each of their patches.
    #[test]
    fn few_pairs_of_vertices_are_kept() {
        let mut rng = seeded(167);
        let shape = pieces(&mut rng, 30, 1000, 1.0);
        let [a, b] = [(); 2].map(|()| Part::Soup(complex(&shape)));
        let patches = patches(&mut rng, [30; 2], 1, 0.0);
        let joining = Joining::new(&a, &b, &patches);
        assert!(matches!(joining.connections, Connections::Any(_)));
        assert_eq!(grown(joining).iter().flatten().count(), 3, "one region of each normal");
    }
}
