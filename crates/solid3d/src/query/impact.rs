//! Shapes that move from one placement to another.

use glam::DAffine3;

use super::placed;
use crate::error::{Error, Result};
use crate::pair::swept::{self, Meeting, Moving, TOLERANCE_MIN, deformation};
use crate::pair::{Path, Scratch};
use crate::shape::Shape;

/// When and where two moving shapes first meet: the time from 0 to 1, the point, and the normal.
pub type Impact = super::ShapeCast;

/// How [`time_of_impact`] is to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactOptions {
    /// How the shapes move between their placements.
    pub path: Path,
    /// How near the shapes may be that are reported as meeting, relative to the sum of their sizes: of the half extents of their local boxes,
    /// placed; from 1e-10 to 1. Default: 1e-8.
    ///
    /// Also at least 1e-13 of the distance of the origins at the start and at the end, and of how far the shapes reach from these. Shapes
    /// that start nearer than this count as meeting when half of the gap is left, so that what slides or leaves does not meet at the start.
    /// A gap of less than some 1e-7 of the size may pass for one that is within the tolerance: where points are so near, rounding hides in
    /// which direction.
    pub tolerance: f64,
}

impl Default for ImpactOptions {
    fn default() -> Self {
        ImpactOptions { path: Path::default(), tolerance: 1e-8 }
    }
}

/// When two shapes that move, and turn, each from one placement to another, first meet between time 0 and 1; `None` when they do
/// not.
///
/// How they move in between is [`ImpactOptions::path`]; any placements will do. Every pair of kinds. Shapes that intersect at the
/// start meet at time 0, without a normal, also where one is inside of the other, a solid.
///
/// Conservative: the time is never later than the first contact, up to the rounding of positions, and no contact is missed. At
/// that time the shapes are nearer to each other than the tolerance, or than some 1e-7 of their sizes and of how far they are apart;
/// shapes that pass each other nearer than that may be reported, too. When the search gives up, after 4,096 steps of a pair of
/// primitives, it reports a contact where it is, which is earlier: only shapes that turn past each other for long, at a gap of less than
/// some 1e-6 of their size, take so many.
///
/// Cost: for convex shapes that meet head on some five times [`distance`](super::distance()), for those that stay clear of each other
/// little more than once; for meshes that of each pair of primitives whose boxes meet on the
/// way, before the first that meets does.
///
/// ```
/// use solid3d::{Shape, query::{self, ImpactOptions}, glam::{DAffine3, DVec3}};
/// // A blade of length 2, turning by a right angle about its end, hits a ball at 60 degrees.
/// let blade = Shape::mesh([DVec3::ZERO, DVec3::X * 2.0, DVec3::new(2.0, 0.0, 1.0)], [[0, 1, 2]])?;
/// let (from, to) = (DAffine3::IDENTITY, DAffine3::from_rotation_z(90f64.to_radians()));
/// let ball = Shape::sphere(0.001)?;
/// let at = DAffine3::from_translation(DVec3::new(60f64.to_radians().cos(), 60f64.to_radians().sin(), 0.0));
/// let options = ImpactOptions::default();
/// let impact = query::time_of_impact(&blade, &from, &to, &ball, &at, &at, &options)?.unwrap();
/// let angle = 60.0 - 0.001f64.asin().to_degrees();
/// assert!((impact.time - angle / 90.0).abs() < 1e-6);
/// // Seen from there, the blade comes from below.
/// assert!(impact.normal.unwrap().x > 0.86 && impact.normal.unwrap().y < 0.0);
/// # Ok::<(), solid3d::Error>(())
/// ```
pub fn time_of_impact(
    a: &Shape,
    from_a: &DAffine3,
    to_a: &DAffine3,
    b: &Shape,
    from_b: &DAffine3,
    to_b: &DAffine3,
    options: &ImpactOptions,
) -> Result<Option<Impact>> {
    time_of_impact_deforming([(a, from_a), (a, to_a)], [(b, from_b), (b, to_b)], options)
}

/// The same for shapes that may also deform: each is given with its placement at time 0 and at time 1.
///
/// The two of a motion are the same shape, or clones of one mesh or complex shape that were [deformed](Shape::deform) differently.
/// Where one of the two moving shapes deforms, every vertex of both moves straight, from where it was to where it is.
///
/// ```
/// use solid3d::{Shape, query::{self, ImpactOptions}, glam::{DAffine3, DVec3}};
/// let flat = Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]])?;
/// let mut lifted = flat.clone();
/// lifted.deform(&[DVec3::Z * 2.0, DVec3::X, DVec3::Y])?; // one corner rises
/// let (here, ball) = (DAffine3::IDENTITY, Shape::sphere(0.1)?);
/// let at = DAffine3::from_translation(DVec3::Z * 1.1);
/// let impact =
///     query::time_of_impact_deforming([(&flat, &here), (&lifted, &here)], [(&ball, &at); 2], &ImpactOptions::default())?;
/// assert!((impact.unwrap().time - 0.5).abs() < 0.01);
/// # Ok::<(), solid3d::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::NotADeformation`] when the two shapes of a motion are different ones. Placements are named as they are by
/// [`time_of_impact`]: `from_a`, `to_a`, `from_b`, `to_b`.
pub fn time_of_impact_deforming(
    a: [(&Shape, &DAffine3); 2],
    b: [(&Shape, &DAffine3); 2],
    options: &ImpactOptions,
) -> Result<Option<Impact>> {
    let (a, b) = (moving("a", ["from_a", "to_a"], a)?, moving("b", ["from_b", "to_b"], b)?);
    Scratch::with(|scratch| impact_of(&a, &b, options, scratch))
}

/// The same for what was checked, but for the options.
pub(crate) fn impact_of(
    a: &Moving,
    b: &Moving,
    options: &ImpactOptions,
    scratch: &mut Scratch,
) -> Result<Option<Impact>> {
    let &ImpactOptions { path, tolerance } = options;
    if !(TOLERANCE_MIN..=1.0).contains(&tolerance) {
        return Err(Error::Tolerance { argument: "tolerance", value: tolerance, least: TOLERANCE_MIN });
    }
    Ok(swept::impact(a, b, path, tolerance, scratch).map(Impact::from))
}

fn moving<'a>(
    argument: &'static str,
    [from_name, to_name]: [&'static str; 2],
    [(was, from), (is, to)]: [(&'a Shape, &'a DAffine3); 2],
) -> Result<Moving<'a>> {
    if !was.is_same_or_deformed(is) {
        return Err(Error::NotADeformation { argument, kinds: [was.kind(), is.kind()] });
    }
    let (from, to) = (placed(from_name, was, from)?, placed(to_name, is, to)?);
    Ok(Moving { from, to, deformation: deformation(was, is) })
}

impl From<Meeting> for Impact {
    fn from(Meeting { time, point, normal }: Meeting) -> Self {
        Impact { time, point, normal }
    }
}
