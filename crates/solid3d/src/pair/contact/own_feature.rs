//! What of a body touches a plane, told in the body's own space, where that takes no corners: a placement that is a similarity changes no angle.

use glam::{DAffine3, DVec2, DVec3};
use solid_convex::{Capsule, Cuboid, unit_scale};

use super::super::reach::reach;
use super::Feature;
use super::bodies::touched;
use super::face::{ALIGNED_SINE, Placed, RIM, SIDE_COSINE, is_aligned};
use super::map::Map;
use crate::shape::{Body, Shape};

/// The line on the side of a cylinder or a cone.
const SIDE: Feature = Feature::Edge(2 * RIM, 2 * RIM + 1);

/// What of a convex shape touches a plane across an outward unit vector.
pub(super) fn own_feature(shape: &Shape, out: DVec3) -> Option<Feature> {
    let (body, lower) = (shape.body()?, u32::from(out.y < 0.0));
    Some(match &body {
        Body::Cuboid(cuboid) => of_box(cuboid, out),
        Body::Capsule(capsule) => of_capsule(capsule, out),
        Body::Cylinder(_) if is_aligned(out.y.abs()) => Feature::Face(lower),
        Body::Cylinder(_) if out.y.abs() <= ALIGNED_SINE => SIDE,
        Body::Cone(_) if is_aligned(-out.y) => Feature::Face(1),
        Body::Cone(cone) if is_level(out, DVec2::new(cone.radius(), -cone.height())) => SIDE,
        _ => touched(&Placed::new(&body, &unit_map(shape)), out),
    })
}

/// To a unit of length near the size of a shape, in which corners of a rim are told apart.
fn unit_map(shape: &Shape) -> Map {
    Map::new(DAffine3::from_scale(DVec3::splat(unit_scale(reach(shape).max_element()))))
}

fn of_box(cuboid: &Cuboid, out: DVec3) -> Feature {
    let (sines, axis) = (out.abs(), out.abs().max_position());
    if is_aligned(sines[axis]) {
        return Feature::Face(2 * axis as u32 + u32::from(out[axis] < 0.0));
    }
    let vertex = (0..3).map(|k| u32::from(out[k] >= 0.0) << k).sum();
    let drop = |k: usize| cuboid.size()[k] * sines[k];
    let level = [(axis + 1) % 3, (axis + 2) % 3].into_iter().filter(|&k| sines[k] <= ALIGNED_SINE);
    match level.min_by(|&i, &j| drop(i).total_cmp(&drop(j))) {
        Some(along) => Feature::Edge(vertex & !(1 << along), vertex | 1 << along),
        None => Feature::Vertex(vertex),
    }
}

fn of_capsule(capsule: &Capsule, out: DVec3) -> Feature {
    let (radius, cosine) = (capsule.radius(), DVec2::new(out.x, out.z).length());
    // From the furthest point to the far end of the side.
    let (inward, along) = (radius * (1.0 - cosine), capsule.height() + radius * out.y.abs());
    let drop = capsule.height() * out.y.abs() + inward;
    if cosine >= SIDE_COSINE && drop <= ALIGNED_SINE * DVec2::new(inward, along).length() {
        Feature::Edge(0, 1)
    } else {
        Feature::Vertex(u32::from(out.y >= 0.0))
    }
}

/// Whether a line on the side of a cone, which leads so far outward and up, lies across a unit vector.
fn is_level(out: DVec3, line: DVec2) -> bool {
    let across = DVec2::new(DVec2::new(out.x, out.z).length(), out.y);
    across.dot(line).abs() <= ALIGNED_SINE * line.length()
}

#[cfg(test)]
mod tests {
    use solid_oracle::generate::{in_cube, seeded};

    use super::super::ways::bodies;
    use super::*;
    use crate::shape::ShapeKind;

    /// Law: it is the feature that the corners of the face tell; along axes, near them, and anywhere.
    #[test]
    fn it_is_what_the_corners_tell() {
        let mut rng = seeded(175);
        for shape in bodies(&mut rng).iter().filter(|shape| shape.kind() != ShapeKind::ConvexHull) {
            let (body, own) = (shape.body().unwrap(), unit_map(shape));
            let mut kinds = [0; 3];
            for case in 0..3_000 {
                let tilt = |k: usize| [1.0, 0.02, 0.002][case / 4_usize.pow(k as u32) % 3];
                let tilts = DVec3::new(tilt(1), tilt(2), tilt(3));
                let Some(out) = (in_cube(&mut rng) * tilts).try_normalize() else { continue };
                let feature = own_feature(shape, out).unwrap();
                assert_eq!(feature, touched(&Placed::new(&body, &own), out), "{shape:?}, {out}");
                let kind = match feature {
                    Feature::Vertex(_) => 0,
                    Feature::Edge(..) => 1,
                    Feature::Face(_) => 2,
                };
                kinds[kind] += 1;
            }
            assert!(kinds[0] > 300 && kinds[1] > 300, "{shape:?}: {kinds:?} vertices, edges, faces");
        }
    }
}
