//! The regions of the pieces, by parry's V-HACD.
//!
//! Its parts are sets of voxels, cut from each other along the axes, so that each is what is enclosed in a box of the grid. Its own hulls are not
//! used: those of voxels are thicker than the mesh, and those of the mesh are cut at every voxel, which makes thousands of corners
//! that rounding has put beside flat faces.

use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parry3d_f64::math::Vector;
use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};
use parry3d_f64::transformation::voxelization::{FillMode, VoxelSet};
use solid3d::Aabb;
use solid3d::glam::DVec3;

use crate::clip::Region;
use crate::error::{Error, Result};
use crate::options::{Options, TESTS_MAX};
use crate::piece::Corner;

/// How far a region reaches beyond its voxels, in voxels, so that rounding leaves no crack between two.
const OVERLAP: f64 = 1e-9;

/// How far a side of a region may be moved to a vertex, in voxels: the voxels of a surface are a layer, beside which it is cut.
const MOVE_MAX: f64 = 2.0;

/// What a piece is made of.
#[derive(Debug)]
pub struct Part {
    /// Where the surface is its: the box of its voxels, the sides moved to the nearest vertices. No two overlap.
    pub region: Region,
    /// The box of its voxels, which leaves out nothing that is in them.
    pub voxels: Region,
    /// Corners of the voxels at its cuts that are wholly inside the mesh.
    pub inner_corners: Vec<Corner>,
}

/// The parts of a mesh whose size is about one, and not zero.
pub fn parts(faces: &[[DVec3; 3]], options: &Options) -> Result<Vec<Part>> {
    check_work(faces, options.resolution)?;
    let points: Vec<Vector> = faces.as_flattened().iter().map(|p| Vector::from_array(p.to_array())).collect();
    let indices: Vec<[u32; 3]> = (0..faces.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let parameters = VHACDParameters {
        concavity: options.concavity,
        resolution: options.resolution,
        max_convex_hulls: options.pieces_max as u32,
        ..VHACDParameters::default()
    };
    // Numbers were checked, so that no assertion there should fail; if one does, nothing of it is kept.
    let decomposed = catch_unwind(AssertUnwindSafe(|| {
        let fill = FillMode::FloodFill { detect_cavities: false };
        let voxels = VoxelSet::voxelize(&points, &indices, options.resolution, fill, false);
        let surface = voxels.voxels().iter().filter(|voxel| voxel.is_on_surface);
        let surface: HashSet<[i64; 3]> = surface.map(|voxel| coordinates(&voxel.coords.to_array())).collect();
        (VHACD::from_voxels(&parameters, voxels), surface)
    }));
    let (decomposed, surface) = decomposed.map_err(|_| Error::Voxels { resolution: options.resolution })?;
    let parts = decomposed.voxel_parts().iter().filter(|part| !part.is_empty());
    let planes = Planes::of(faces);
    Ok(parts.map(|part| part_of(part, &surface, &planes)).collect())
}

/// The coordinates of the vertices on each axis, ascending.
struct Planes([Vec<f64>; 3]);

impl Planes {
    fn of(faces: &[[DVec3; 3]]) -> Planes {
        Planes([0, 1, 2].map(|axis| {
            let mut coordinates: Vec<f64> = faces.as_flattened().iter().map(|p| p[axis]).collect();
            coordinates.sort_unstable_by(f64::total_cmp);
            coordinates
        }))
    }

    /// The corner of a box with its sides moved to the nearest vertices, if these are within a distance. Which is the nearest does not
    /// depend on the box, so that boxes side by side stay so; and the order of sides stays, too.
    fn moved(&self, corner: DVec3, within: f64) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis| {
            let (all, side) = (&self.0[axis], corner[axis]);
            let above = all.partition_point(|&x| x < side);
            let near = all[above.saturating_sub(1)..].iter().take(2).copied();
            let nearest = near.min_by(|x, y| (x - side).abs().total_cmp(&(y - side).abs()));
            nearest.filter(|x| (x - side).abs() <= within).unwrap_or(side)
        }))
    }
}

fn part_of(set: &VoxelSet, surface: &HashSet<[i64; 3]>, planes: &Planes) -> Part {
    let origin = DVec3::from_array(set.origin.to_array());
    let place = |grid: DVec3| origin + grid * set.scale;
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut inner = Vec::new();
    for voxel in set.voxels() {
        let coordinates = coordinates(&voxel.coords.to_array());
        let middle = DVec3::from(coordinates.map(|x| x as f64));
        (min, max) = (min.min(middle), max.max(middle));
        // Cutting makes voxels inside the mesh ones of the surface of a part.
        if voxel.is_on_surface && !surface.contains(&coordinates) {
            inner.push(middle);
        }
    }
    let (min, max, overlap) = (place(min - 0.5), place(max + 0.5), DVec3::splat(OVERLAP * set.scale));
    let moved = [min, max].map(|side| planes.moved(side, MOVE_MAX * set.scale));
    let region = Region::new(moved[0] - overlap, moved[1] + overlap);
    // Where a side was moved inward, what of an inner voxel is left.
    let (least, greatest) = (moved[0].max(min), moved[1].min(max));
    let left =
        inner.iter().map(|&middle| (place(middle - 0.5).max(least), place(middle + 0.5).min(greatest)));
    let corners = left.filter(|(min, max)| min.cmple(*max).all()).flat_map(|(min, max)| {
        let corner =
            move |i: u32| DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { min[k] } else { max[k] }));
        (0..8).map(move |i| Corner { at: corner(i), is_cut: true })
    });
    let inner_corners = corners.collect();
    Part { region, voxels: Region::new(min - overlap, max + overlap), inner_corners }
}

/// As `i64`, whichever width the library has.
fn coordinates<T: Copy + Into<i64>>(coordinates: &[T; 3]) -> [i64; 3] {
    coordinates.map(Into::into)
}

/// Counts the voxels in the boxes of all triangles, which the library goes through, with one more on each side.
fn check_work(faces: &[[DVec3; 3]], resolution: u32) -> Result<()> {
    let whole = Aabb::of_points(faces.as_flattened().iter().copied());
    let per_voxel = f64::from(resolution - 1) / (2.0 * whole.half_extents().max_element());
    let boxes = faces.iter().map(|face| {
        let spans = Aabb::of_points(*face).half_extents() * (2.0 * per_voxel) + 4.0;
        let spans = spans.min(DVec3::splat(f64::from(resolution)));
        (spans.x * spans.y * spans.z).ceil()
    });
    let tests = boxes.sum::<f64>() as u64;
    if tests > TESTS_MAX {
        return Err(Error::TooMuchWork { triangles: faces.len(), resolution, tests, limit: TESTS_MAX });
    }
    Ok(())
}
