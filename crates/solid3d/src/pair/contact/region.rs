//! Contacts of primitives put together to regions of the surface.

use std::collections::HashMap;

use foldhash::fast::RandomState;
use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::joining::Joining;
use super::{Part, Patch, SAME_DEPTH, Touch};
use crate::hull::outline;

/// Points nearer to each other than this are one, in the unit of the pair.
const SAME_POINT: f64 = 1e-8;

/// The cells of the grid that finds such points.
const CELL: f64 = 100.0 * SAME_POINT;

/// Points that are off a plane by less than this are in it, in the unit of the pair.
const FLAT: f64 = 1e-8;

/// Distances whose squares differ by no more than this part of the greater are the same.
const SAME_DISTANCE: f64 = 1e-9;

/// Contacts with one normal, each with its primitives. Space: common.
pub(super) struct Region {
    pub normal: DVec3,
    pub points: Vec<Touch>,
}

/// Puts patches together whose primitives are connected on both sides, and whose normals are that of the deepest of them. In the order
/// of their first primitives. Cost: follows the patches at one vertex, times how many normals they have.
pub(super) fn regions(a: &Part, b: &Part, mut patches: Vec<Patch>) -> Vec<Region> {
    if patches.len() == 1 {
        return patches
            .into_iter()
            .map(|patch| Region { normal: patch.normal, points: patch.touches })
            .collect();
    }
    patches.sort_by_key(|patch| patch.touches[0].primitives); // stable
    let deepest = |patch: &Patch| patch.touches.iter().map(|touch| touch.depth).fold(f64::MIN, f64::max);
    let depths: Vec<f64> = patches.iter().map(deepest).collect();
    let mut seeds: Vec<usize> = (0..patches.len()).collect();
    seeds.sort_by(|&i, &j| depths[j].total_cmp(&depths[i])); // stable
    let mut joining = Joining::new(a, b, &patches);
    let mut joined: Vec<(DVec3, Vec<usize>)> =
        seeds.into_iter().filter_map(|seed| Some((patches[seed].normal, joining.grow(seed)?))).collect();
    joined.sort_unstable_by_key(|(_, members)| members[0]);
    let region = |(normal, members): (DVec3, Vec<usize>)| {
        let touches = members.iter().flat_map(|&i| patches[i].touches.iter().copied());
        Region { normal, points: thinned(touches.collect(), normal, members.len() > 1) }
    };
    joined.into_iter().map(region).collect()
}

/// Points without duplicates; of flat surfaces of several primitives, those at the outline, which say all of the others.
fn thinned(points: Vec<Touch>, normal: DVec3, several: bool) -> Vec<Touch> {
    let (u, v) = normal.any_orthonormal_pair();
    let Some(origin) = points.first().map(|touch| touch.on_a) else { return points };
    let flat = |touch: &Touch| DVec2::new(u.dot(touch.on_a - origin), v.dot(touch.on_a - origin));
    if !several {
        return points;
    }
    let places: Vec<DVec2> = points.iter().map(flat).collect();
    let height = |i: usize| normal.dot(points[i].on_a - origin);
    let depth = |i: usize| points[i].depth;
    // Of most that are not flat this tells, in a fraction of the time that the outline takes.
    if !is_bent(&places, height) && !is_bent(&places, depth) {
        let around = outline(&places, FLAT);
        if is_linear(&places, &around, height) && is_linear(&places, &around, depth) {
            return around.into_iter().map(|i| points[i]).collect();
        }
    }
    without_duplicates(points, &places)
}

/// Of points at one place, the deepest; by a grid, whose cells hold few.
fn without_duplicates(points: Vec<Touch>, places: &[DVec2]) -> Vec<Touch> {
    let mut order: Vec<(f64, usize)> = points.iter().map(|touch| touch.depth).zip(0..).collect();
    order.sort_unstable_by(|(x, i), (y, j)| y.total_cmp(x).then(i.cmp(j)));
    let mut kept_in: HashMap<[i64; 2], SmallVec<[usize; 2]>, RandomState> =
        HashMap::with_capacity_and_hasher(points.len(), RandomState::default());
    let mut kept = Vec::new();
    for (_, i) in order {
        let [x, y] = [places[i].x, places[i].y].map(Cells::of);
        let near = (x.from..=x.to).flat_map(|x| (y.from..=y.to).map(move |y| [x, y]));
        let same = |&j: &usize| {
            let (p, q) = (&points[i], &points[j]);
            p.on_a.distance(q.on_a) <= SAME_POINT && p.on_b.distance(q.on_b) <= SAME_POINT
        };
        if !near.into_iter().any(|cell| kept_in.get(&cell).is_some_and(|others| others.iter().any(same))) {
            kept_in.entry([x.own, y.own]).or_default().push(i);
            kept.push(i);
        }
    }
    kept.sort_unstable();
    kept.into_iter().map(|i| points[i]).collect()
}

/// The cells, along one axis, in which there may be what is at one place with a coordinate: mostly its own alone, as it is seldom next to the end of that.
struct Cells {
    from: i64,
    own: i64,
    to: i64,
}

impl Cells {
    fn of(coordinate: f64) -> Cells {
        const NEXT: f64 = 2.0 * SAME_POINT / CELL;
        let place = coordinate / CELL;
        let (part, own) = (place - place.floor(), place.floor() as i64);
        Cells { from: own - i64::from(part < NEXT), own, to: own + i64::from(part > 1.0 - NEXT) }
    }
}

/// Whether a value at places in a plane plainly is not that of a linear function. With the value for a height, the triple product of the ways from one
/// place to three others is 0 for such a function; where it is off by [`FLAT`], no more than 6 times that, times the square of the longest in the plane.
fn is_bent(places: &[DVec2], value: impl Fn(usize) -> f64) -> bool {
    let third = places.len() / 3;
    (1..third).any(|i| {
        let from_first = |j: usize| (places[j] - places[0]).extend(value(j) - value(0));
        let [p, q, r] = [i, i + third, i + 2 * third].map(from_first);
        let reach = [p, q, r].map(|p| p.truncate().length_squared()).into_iter().fold(0.0, f64::max);
        p.dot(q.cross(r)).abs() > 8.0 * FLAT * reach
    })
}

/// Whether a value at places in a plane is that of a linear function; `around` is their outline.
fn is_linear(places: &[DVec2], around: &[usize], value: impl Fn(usize) -> f64) -> bool {
    let Some(&first) = around.first() else { return true };
    let furthest = |measure: &dyn Fn(usize) -> f64| {
        around.iter().copied().max_by(|&i, &j| measure(i).total_cmp(&measure(j))).unwrap_or(first)
    };
    let second = furthest(&|i| places[i].distance_squared(places[first]));
    let along = places[second] - places[first];
    let third = furthest(&|i| along.perp_dot(places[i] - places[first]).abs());
    let length_squared = along.length_squared();
    if length_squared == 0.0 {
        return (0..places.len()).all(|i| (value(i) - value(first)).abs() <= FLAT);
    }
    let across = |i: usize| along.perp_dot(places[i] - places[first]);
    let on_line = |i: usize| {
        let t = along.dot(places[i] - places[first]) / length_squared;
        value(first) + (value(second) - value(first)) * t
    };
    let slope = if across(third).abs() > FLAT * length_squared.sqrt() {
        (value(third) - on_line(third)) / across(third)
    } else {
        0.0
    };
    (0..places.len()).all(|i| (value(i) - on_line(i) - slope * across(i)).abs() <= FLAT)
}

/// Leaves at most so many points: the deepest, then always the one furthest from those.
pub(super) fn reduce(points: &mut Vec<Touch>, normal: DVec3, most: usize) {
    if points.len() <= most {
        return;
    }
    let across = |i: usize, j: usize| {
        let v = points[i].on_a - points[j].on_a;
        (v - normal * v.dot(normal)).length_squared()
    };
    // Of those that differ by rounding the first, so that it is the same in the next frame.
    let first_of_most = |value: &dyn Fn(usize) -> f64, same: &dyn Fn(f64) -> f64| {
        let most = (0..points.len()).map(value).fold(f64::NEG_INFINITY, f64::max);
        (0..points.len()).find(|&i| value(i) >= same(most)).unwrap_or(0)
    };
    let mut next = first_of_most(&|i| points[i].depth, &|most| most - SAME_DEPTH);
    let (mut kept, mut distance) = (Vec::new(), vec![f64::INFINITY; points.len()]);
    loop {
        kept.push(next);
        if kept.len() == most {
            break;
        }
        // It is no longer sought.
        distance[next] = f64::NEG_INFINITY;
        for (i, nearest) in distance.iter_mut().enumerate() {
            *nearest = nearest.min(across(i, next));
        }
        next = first_of_most(&|i| distance[i], &|most| most * (1.0 - SAME_DISTANCE));
    }
    kept.sort_unstable();
    *points = kept.into_iter().map(|i| points[i]).collect();
}

#[cfg(test)]
mod tests {
    use rand::Rng;
    use solid_oracle::generate::seeded;

    use super::*;

    /// Law: what is told to be bent is not linear.
    #[test]
    fn what_is_bent_is_not_linear() {
        let mut rng = seeded(173);
        let (mut bent, mut linear, cases) = (0, 0, 4000);
        for case in 0..cases {
            let [width, off] = [[1.0, 1e-4, 1e-7][case % 3], [0.2, 1.1, 10.0, 1e6][case / 3 % 4] * FLAT];
            let count = rng.random_range(6..30);
            let mut place = || DVec2::new(rng.random_range(-1.0..1.0), rng.random_range(-width..width));
            let mut places: Vec<DVec2> = (0..count).map(|_| place()).collect();
            places.push(places[0]);
            let errors: Vec<f64> = (0..=count).map(|_| rng.random_range(-off..off)).collect();
            let value = |i: usize| 0.3 * places[i].x - 2.0 * places[i].y + errors[i];
            let [is_bent, is_linear] =
                [is_bent(&places, value), is_linear(&places, &outline(&places, FLAT), value)];
            assert!(!(is_bent && is_linear), "case {case}");
            (bent, linear) = (bent + usize::from(is_bent), linear + usize::from(is_linear));
        }
        assert!(bent > cases / 10 && linear > cases / 10, "{bent} and {linear} of {cases}");
    }
}
