//! Penetration of objects that are a core with a radius: spheres and capsules.

use glam::{DAffine3, DVec3};

use super::{Nearest, Penetration, deepen};
use crate::difference::Difference;
use crate::gjk::{DISTANCE_TOLERANCE, End, Goal, descend};
use crate::rounded::Core;
use crate::{Support, Witness};

/// How deep two objects are in each other, of which at least one has a core with a radius: by the distance of the cores, or by their
/// depth. `None` when they are certainly further apart than the bound, in the unit of the difference.
pub(super) fn penetration<A, B>(
    a: &Core<A>,
    placement_a: &DAffine3,
    b: &Core<B>,
    placement_b: &DAffine3,
    bound: f64,
) -> Option<Penetration>
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let difference = Difference::new(a, placement_a, b, placement_b);
    let radius = (a.radius() + b.radius()) * difference.scale();
    let goal = Goal::DistanceWithin { tolerance: DISTANCE_TOLERANCE, bound: radius + bound };
    let descent = descend(&difference, goal);
    if descent.beyond {
        return None;
    }
    let nearest = match descent.end {
        End::Separated => apart(&difference, descent.v, Witness::of(&descent.simplex)),
        End::Undecided | End::Inside => deepen(&difference, &descent.simplex),
    };
    let mut found = nearest.penetration(difference.scale(), radius);
    found.points.on_a -= a.to_surface(placement_a, found.direction);
    found.points.on_b += b.to_surface(placement_b, found.direction);
    Some(found)
}

/// Of cores that are apart, `v` is the difference of their closest points.
fn apart<A, B>(difference: &Difference<Core<A>, Core<B>>, v: DVec3, points: Witness) -> Nearest
where
    A: Support + ?Sized,
    B: Support + ?Sized,
{
    let normal = -v.normalize();
    let height = normal.dot(difference.support_against(-normal).w);
    Nearest { height, lower: -v.length(), normal, points }
}
