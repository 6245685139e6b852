//! Meshes as unions of convex pieces (thesis, section 3.1.1), so that a body that is not convex has a depth and contacts like one
//! that is.
//!
//! Which region belongs to which piece is decided on a grid of voxels, by V-HACD (Mamou, *Volumetric Hierarchical Approximate
//! Convex Decomposition*, 2016) as the library parry has it. A region is a box of the grid, whose sides are moved to the nearest
//! vertex, so that a notch is cut at its corner. What a piece is made of is the mesh itself within the box, cut there, and where
//! the box cuts through the inside of the mesh, the voxels at the cut. Pieces that make a nearly convex one are joined again: voxels make every slanted surface a staircase, which is split for no
//! reason.
//!
//! This crate is apart so that `solid3d` does not depend on parry.

mod clip;
mod error;
mod join;
mod options;
mod piece;
mod voxels;

use piece::{Corner, Piece};
use solid3d::convex::unit_scale;
use solid3d::glam::DVec3;
use solid3d::{ComplexShapeBuilder, Shape, ShapeKind};

pub use error::{Error, Result};
pub use options::{Options, PIECES_MAX, RESOLUTION_MAX, RESOLUTION_MIN, TESTS_MAX};

/// A mesh as a union of convex pieces.
#[derive(Clone, Debug)]
pub struct Decomposition {
    /// The pieces, each a convex hull, in the mesh's space. At least one; they may overlap.
    pub pieces: Vec<Shape>,
    /// All pieces as one complex shape, whose primitives are the pieces in the same order.
    pub shape: Shape,
}

/// Decomposes a mesh, which need not be [solid](Shape::into_solid), into convex pieces.
///
/// - The pieces cover the whole surface, but for 1e-11 of the size of the mesh. Their corners are vertices of it, and points at which it
///   was cut, which are rounded as its coordinates are.
/// - They cover what the mesh encloses, but for gaps of less than two voxels. Cavities count as enclosed, too.
/// - They cover more: by what [`Options::concavity`] allows, where there are pieces enough. That is told in volumes, of which what
///   lies in a plane has none, so that notches of what is flat may be closed.
/// - A mesh with holes wider than a voxel encloses nothing, and is covered as the surface that it is. A flat mesh has flat
///   pieces.
///
/// The same mesh and options give the same pieces. Cost: with the default options one to three seconds, and some 15 MB; more by far
/// for twice the resolution.
///
/// # Errors
/// [`Error::NotAMesh`] for other shapes; [`Error::Option`] for an option that is out of range; [`Error::TooMuchWork`] for very
/// many large triangles on a fine grid.
///
/// ```
/// use solid_decompose::{Options, decompose};
/// use solid3d::{Shape, query, glam::{DAffine3, DVec3}};
/// // An L, one thick: a column, and a foot that is two long.
/// let outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)];
/// let at = |z: i32| outline.map(|(x, y)| DVec3::new(x.into(), y.into(), z.into()));
/// let mut triangles = vec![[0, 2, 1], [0, 3, 2], [0, 5, 3], [3, 5, 4], [6, 7, 8], [6, 8, 9], [6, 9, 11], [9, 10, 11]];
/// for i in 0..6 {
///     let j = (i + 1) % 6;
///     triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
/// }
/// let mesh = Shape::mesh([at(0), at(1)].concat(), triangles)?;
/// let parts = decompose(&mesh, &Options::default())?;
/// assert_eq!(parts.pieces.len(), 2);
///
/// // A ball that is 0.1 deep in the foot, beside the column: the shortest way out is up.
/// let (ball, here) = (Shape::sphere(0.25)?, DAffine3::IDENTITY);
/// let low = DAffine3::from_translation(DVec3::new(1.7, 1.15, 0.5));
/// let found = query::penetration(&ball, &low, &parts.shape, &here)?.unwrap();
/// assert!((found.depth - 0.1).abs() < 0.01 && found.normal.y > 0.99);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn decompose(mesh: &Shape, options: &Options) -> Result<Decomposition> {
    options.check()?;
    let (Some(vertices), Some(triangles), ShapeKind::Mesh) = (mesh.vertices(), mesh.triangles(), mesh.kind())
    else {
        return Err(Error::NotAMesh { kind: mesh.kind() });
    };
    // Of the vertices that triangles name, from a point beside the mesh, in a unit of length near its size: a power of two. Neither
    // changes a vertex.
    let corners = || triangles.as_flattened().iter().map(|&i| vertices[i as usize]);
    let (min, max) =
        corners().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), v| (min.min(v), max.max(v)));
    let extent = (max - min).max_element();
    let pieces = if extent > 0.0 {
        let (beside, scale) = (beside(min, max), unit_scale(extent));
        let faces: Vec<[DVec3; 3]> =
            triangles.iter().map(|t| t.map(|i| (vertices[i as usize] - beside) * scale)).collect();
        let pieces = pieces(&faces, options)?;
        let pieces = pieces.iter().map(Piece::corners).collect::<solid3d::Result<Vec<_>>>()?;
        pieces.into_iter().map(|corners| corners.into_iter().map(|p| p / scale + beside).collect()).collect()
    } else {
        vec![vec![min]]
    };
    assemble(&pieces)
}

/// A point from which a mesh in a box is not far, and from which all of its coordinates have exact differences: those between a number
/// and its double do (Sterbenz), and where they are farther apart than that, the origin is as near as they are wide.
fn beside(min: DVec3, max: DVec3) -> DVec3 {
    DVec3::from([0, 1, 2].map(|k| {
        let (near, far) = if min[k] > 0.0 { (min[k], max[k]) } else { (max[k].min(0.0), min[k]) };
        if far.abs() <= 2.0 * near.abs() { near } else { 0.0 }
    }))
}

/// The pieces of a mesh whose size is about one.
fn pieces(faces: &[[DVec3; 3]], options: &Options) -> Result<Vec<Piece>> {
    let parts = voxels::parts(faces, options)?;
    let mut clouds: Vec<Vec<Corner>> = parts.iter().map(|part| part.inner_corners.clone()).collect();
    for face in faces {
        for (part, cloud) in parts.iter().zip(&mut clouds) {
            clip::clip(face, &part.region, cloud);
        }
        if !clip::is_left(face, parts.iter().map(|part| &part.region)) {
            continue;
        }
        for (part, cloud) in parts.iter().zip(&mut clouds) {
            clip::clip(face, &part.voxels, cloud);
        }
        // Rounding may leave a corner in no region at all: it goes to the nearest.
        for &at in face {
            let distance = |i: &usize| parts[*i].voxels.distance(at);
            let nearest = (0..parts.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
            clouds[nearest.expect("a mesh has a voxel, and so a part")].push(Corner { at, is_cut: false });
        }
    }
    let pieces = clouds.into_iter().filter_map(Piece::of).collect();
    let corner = |&at: &DVec3| Corner { at, is_cut: false };
    let whole = Piece::of(faces.as_flattened().iter().map(corner).collect()).expect("a mesh has a corner");
    Ok(join::join(pieces, options.pieces_max, options.concavity * whole.volume()))
}

/// The pieces as shapes.
fn assemble(pieces: &[Vec<DVec3>]) -> Result<Decomposition> {
    let pieces =
        pieces.iter().map(|points| Shape::convex_hull(points)).collect::<solid3d::Result<Vec<_>>>()?;
    let corners = |piece: &Shape| piece.vertices().expect("a convex hull has vertices").to_vec();
    let vertices: Vec<DVec3> = pieces.iter().flat_map(corners).collect();
    let mut builder = ComplexShapeBuilder::new(vertices);
    let mut first = 0;
    for piece in &pieces {
        let end = first + corners(piece).len() as u32;
        builder = builder.polyhedron(&(first..end).collect::<Vec<u32>>());
        first = end;
    }
    Ok(Decomposition { shape: builder.build()?, pieces })
}
