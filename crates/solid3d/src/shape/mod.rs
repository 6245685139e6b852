//! Shapes: geometry in its own space, instanced by any number of objects.

mod builder;
mod chord;
mod complex;
mod convexity;
mod debug;
mod enclosed;
mod facets;
mod hulled;
mod incidence;
mod kind;
mod measures;
mod parts;
mod radius;
mod simple;
mod solid;
mod soup_hull;
mod surface;
mod topology;
mod validate;

use std::sync::Arc;

use fearless_simd::Simd;
use glam::{DAffine3, DMat3, DVec3};
use solid_convex::{Capsule, Cone, Cuboid, Cylinder, Polytope, Sphere, Support};

pub use builder::ComplexShapeBuilder;
pub(crate) use complex::Complex;
pub(crate) use facets::Facet;
pub(crate) use hulled::Hulled;
pub use kind::ShapeKind;
pub(crate) use simple::{Round, Simple};
pub use solid::{OpenEdge, OpenEdges};
pub(crate) use surface::{Surface, boundary};

use crate::error::{Error, Result};
use crate::hull::{Hull, POINTS_MAX};

/// Geometry in its own space. Cheap to clone: clones share the geometry.
///
/// Shapes are closed sets, so objects that touch collide. A mesh and a complex shape are the union of their primitives:
/// a mesh is a surface, and what lies wholly inside it does not collide with it, unless it is made
/// [solid](Shape::into_solid).
///
/// ```
/// use solid3d::{Shape, ShapeKind};
/// let ball = Shape::sphere(0.5)?;
/// assert_eq!(ball.kind(), ShapeKind::Sphere);
/// let error = Shape::sphere(-1.0).unwrap_err();
/// assert_eq!(error.to_string(), "radius is -1.0; it must be from 1e-100 to 1e100");
/// # Ok::<(), solid3d::Error>(())
/// ```
#[derive(Clone)]
pub struct Shape {
    geometry: Geometry,
}

#[derive(Clone)]
enum Geometry {
    Sphere(Sphere),
    Cuboid(Cuboid),
    Cone(Cone),
    Cylinder(Cylinder),
    Capsule(Capsule),
    Polytope(Arc<Hulled>),
    Complex(Arc<Complex>),
}

/// The two classes that the algorithm table distinguishes (thesis, section 6.3.4).
pub(crate) enum Class<'a> {
    /// Known by its support mapping.
    Convex(&'a dyn Support),
    /// A soup of convex primitives under a tree.
    Complex(&'a Complex),
}

/// A convex shape by its kind: what its faces are found from.
pub(crate) enum Body<'a> {
    Sphere(&'a Sphere),
    Cuboid(&'a Cuboid),
    Cone(&'a Cone),
    Cylinder(&'a Cylinder),
    Capsule(&'a Capsule),
    /// A convex hull.
    Hull {
        hull: &'a Hulled,
        /// What its points are called, when not by their places.
        names: Option<&'a [u32]>,
    },
    /// A primitive of up to three vertices: which of the complex shape.
    Simplex(&'a [u32]),
}

impl<'a> Body<'a> {
    /// A primitive of a complex shape. Cost: O(n log n) at the first call for one of more than three vertices.
    pub fn of_primitive(complex: &'a Complex, primitive: u32) -> Body<'a> {
        let indices = complex.primitive(primitive);
        if indices.len() <= 3 {
            return Body::Simplex(indices);
        }
        Body::Hull { hull: complex.hull_of(primitive), names: Some(indices) }
    }
}

impl Shape {
    /// A ball centred at the origin.
    pub fn sphere(radius: f64) -> Result<Shape> {
        Ok(Geometry::Sphere(Sphere::new(radius)?).into())
    }

    /// A box centred at the origin, along the axes; `size` is the full size.
    pub fn cuboid(size: impl Into<DVec3>) -> Result<Shape> {
        Ok(Geometry::Cuboid(Cuboid::new(size.into())?).into())
    }

    /// A capped cone on the axis y, centred at the origin: apex at +height/2, base of the given radius at -height/2.
    pub fn cone(radius: f64, height: f64) -> Result<Shape> {
        Ok(Geometry::Cone(Cone::new(radius, height)?).into())
    }

    /// A capped cylinder on the axis y, centred at the origin.
    pub fn cylinder(radius: f64, height: f64) -> Result<Shape> {
        Ok(Geometry::Cylinder(Cylinder::new(radius, height)?).into())
    }

    /// All points within `radius` of a segment on the axis y, centred at the origin; `height` is the length of the
    /// segment, from centre to centre of the round ends.
    pub fn capsule(radius: f64, height: f64) -> Result<Shape> {
        Ok(Geometry::Capsule(Capsule::new(radius, height)?).into())
    }

    /// The convex hull of any points: interior, duplicate, coplanar and collinear ones are welcome, and a single one
    /// does. The hull is solid. Cost: O(n log n).
    ///
    /// ```
    /// use solid3d::{Shape, glam::DVec3};
    /// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.1)];
    /// let shape = Shape::convex_hull(&corner)?;
    /// assert_eq!(shape.vertices().unwrap().len(), 4); // the fifth is inside
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn convex_hull(points: &[DVec3]) -> Result<Shape> {
        validate::vertex_count("points", points.len())?;
        validate::at_most(POINTS_MAX, "points", points.len())?;
        validate::vertices(points)?;
        let hull = Hull::of(points).ok_or(Error::NoVertices { argument: "points" })?;
        Ok(Geometry::Polytope(Arc::new(Hulled::of(&hull, points))).into())
    }

    /// A triangle mesh: a surface, closed or not. Triangles may be degenerate. Cost: O(n log n), for the tree.
    ///
    /// ```
    /// use solid3d::{Shape, glam::DVec3};
    /// let sheet = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
    /// let shape = Shape::mesh(sheet, [[0, 1, 2], [0, 2, 3]])?;
    /// assert_eq!(shape.primitive_count(), 2);
    /// let error = Shape::mesh(sheet, [[0, 1, 4]]).unwrap_err();
    /// assert_eq!(error.to_string(), "primitive 0 names vertex 4, but there are 4 vertices");
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn mesh(vertices: impl Into<Vec<DVec3>>, triangles: impl Into<Vec<[u32; 3]>>) -> Result<Shape> {
        Ok(Geometry::Complex(Arc::new(Complex::mesh(vertices.into(), triangles.into())?)).into())
    }

    /// A mesh as the solid that it bounds: what lies wholly inside it then collides with it (thesis, section 3.1.2). Convex
    /// shapes are solid already.
    ///
    /// The solid is the surface with all points around which it winds (the winding number is not 0): inside out is as well
    /// as outside out, a part inside another is a cavity when it is turned the other way, and parts that overlap are joined
    /// when they are turned the same way.
    ///
    /// The mesh must be closed: every edge must be run through by as many triangles in one direction as in the other, as
    /// two triangles side by side do that both show their front. Vertices at exactly the same position count as one here;
    /// triangles may be degenerate. [`Error::OpenMesh`] lists the edges where that is not so, and
    /// [`Error::NotAMesh`] refuses complex shapes. Cost: O(n log n).
    ///
    /// A deformation of a solid is solid. It may not part vertices that were at the same position when the mesh was made
    /// solid: that is [`Error::TornSolid`].
    ///
    /// ```
    /// use solid3d::{Error, Shape, query, glam::{DAffine3, DVec3}};
    /// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let surface = Shape::mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// let solid = surface.clone().into_solid()?;
    /// let (here, inside) = (DAffine3::IDENTITY, DAffine3::from_translation(DVec3::splat(0.2)));
    /// let ball = Shape::sphere(0.01)?;
    /// assert!(!query::intersects(&surface, &here, &ball, &inside)?);
    /// assert!(query::intersects(&solid, &here, &ball, &inside)?);
    ///
    /// let open = Shape::mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2]])?;
    /// let Err(Error::OpenMesh { edges }) = open.into_solid() else { panic!() };
    /// assert_eq!(edges.iter().map(|edge| edge.vertices).collect::<Vec<_>>(), [[1, 2], [1, 3], [2, 3]]);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn into_solid(mut self) -> Result<Shape> {
        match &mut self.geometry {
            // What is solid stays shared.
            Geometry::Complex(complex) if complex.is_solid() => {}
            Geometry::Complex(complex) if complex.is_mesh() => Arc::make_mut(complex).solidify()?,
            Geometry::Complex(_) => return Err(Error::NotAMesh { kind: self.kind() }),
            _ => {}
        }
        Ok(self)
    }

    /// Whether the shape contains what it bounds: convex shapes, and meshes made [solid](Shape::into_solid).
    ///
    /// ```
    /// # use solid3d::{Shape, glam::DVec3};
    /// assert!(Shape::sphere(1.0)?.is_solid());
    /// assert!(!Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]])?.is_solid());
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn is_solid(&self) -> bool {
        match &self.geometry {
            Geometry::Complex(complex) => complex.is_solid(),
            _ => true,
        }
    }

    /// The kind of the shape.
    pub fn kind(&self) -> ShapeKind {
        match &self.geometry {
            Geometry::Sphere(_) => ShapeKind::Sphere,
            Geometry::Cuboid(_) => ShapeKind::Cuboid,
            Geometry::Cone(_) => ShapeKind::Cone,
            Geometry::Cylinder(_) => ShapeKind::Cylinder,
            Geometry::Capsule(_) => ShapeKind::Capsule,
            Geometry::Polytope(_) => ShapeKind::ConvexHull,
            Geometry::Complex(complex) if complex.is_mesh() => ShapeKind::Mesh,
            Geometry::Complex(_) => ShapeKind::Complex,
        }
    }

    /// How many primitives the shape consists of: 1 for a convex shape.
    pub fn primitive_count(&self) -> usize {
        match &self.geometry {
            Geometry::Complex(complex) => complex.primitive_count(),
            _ => 1,
        }
    }

    /// The memory that the shape owns, in bytes, everything counted: vertices, indices, tree, and what queries found out about it and
    /// keep. Clones share it.
    ///
    /// ```
    /// use solid3d::{Shape, glam::DVec3};
    /// // A floor of 5,000 triangles: at most 70 bytes each.
    /// let at = |i: u32| DVec3::new(f64::from(i % 51), f64::from(i / 51), 0.0);
    /// let vertices: Vec<DVec3> = (0..51 * 51).map(at).collect();
    /// let cell = |i: u32| 51 * (i / 50) + i % 50;
    /// let triangles: Vec<[u32; 3]> =
    ///     (0..2500).map(cell).flat_map(|i| [[i, i + 1, i + 52], [i, i + 52, i + 51]]).collect();
    /// assert!(Shape::mesh(vertices, triangles)?.memory() <= 70 * 5000);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn memory(&self) -> usize {
        let owned = match &self.geometry {
            Geometry::Complex(complex) => complex.memory(),
            Geometry::Polytope(polytope) => size_of_val(&**polytope) + polytope.bytes(),
            _ => 0,
        };
        size_of::<Shape>() + owned
    }

    /// The vertices of a convex hull (its corners alone), a mesh or a complex shape; `None` for the other kinds.
    pub fn vertices(&self) -> Option<&[DVec3]> {
        match &self.geometry {
            Geometry::Polytope(polytope) => Some(polytope.points()),
            Geometry::Complex(complex) => Some(complex.vertices()),
            _ => None,
        }
    }

    /// The triangles of a mesh, as indices into [`vertices`](Shape::vertices); `None` for the other kinds.
    pub fn triangles(&self) -> Option<&[[u32; 3]]> {
        match &self.geometry {
            Geometry::Complex(complex) => complex.triangles(),
            _ => None,
        }
    }

    /// Deforms a mesh or a complex shape: gives its vertices new positions. Its tree is refitted, and rebuilt when
    /// refitting has let its cost (by the surface-area heuristic) grow by more than 30 % since it was built.
    ///
    /// Clones made before keep the old positions. A solid stays closed; see [`into_solid`](Shape::into_solid). Cost: O(n), and
    /// O(n log n) when the tree is rebuilt.
    ///
    /// Errors, on which nothing has changed: another number of positions than of vertices, one that is not finite or too large, a shape of
    /// another kind, a solid that would be torn.
    ///
    /// ```
    /// use solid3d::{Shape, glam::DVec3};
    /// let mut cloth = Shape::mesh([DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]])?;
    /// let before = cloth.clone();
    /// cloth.deform(&[DVec3::Z, DVec3::X, DVec3::Y])?;
    /// assert_eq!(cloth.vertices().unwrap()[0], DVec3::Z);
    /// assert_eq!(before.vertices().unwrap()[0], DVec3::ZERO);
    /// # Ok::<(), solid3d::Error>(())
    /// ```
    pub fn deform(&mut self, positions: &[DVec3]) -> Result<()> {
        match &mut self.geometry {
            Geometry::Complex(complex) => Complex::deform(complex, positions),
            _ => Err(Error::NotDeformable { kind: self.kind() }),
        }
    }

    /// Whether the two are the same mesh or complex shape, deformed differently.
    pub(crate) fn is_deformation_of(&self, other: &Shape) -> bool {
        match (&self.geometry, &other.geometry) {
            (Geometry::Complex(a), Geometry::Complex(b)) => !Arc::ptr_eq(a, b) && a.same_primitives(b),
            _ => false,
        }
    }

    /// Whether the two are one shape, of which a mesh or complex shape may be deformed differently.
    pub(crate) fn is_same_or_deformed(&self, other: &Shape) -> bool {
        match (&self.geometry, &other.geometry) {
            (Geometry::Sphere(a), Geometry::Sphere(b)) => a == b,
            (Geometry::Cuboid(a), Geometry::Cuboid(b)) => a == b,
            (Geometry::Cone(a), Geometry::Cone(b)) => a == b,
            (Geometry::Cylinder(a), Geometry::Cylinder(b)) => a == b,
            (Geometry::Capsule(a), Geometry::Capsule(b)) => a == b,
            (Geometry::Polytope(a), Geometry::Polytope(b)) => Arc::ptr_eq(a, b),
            (Geometry::Complex(a), Geometry::Complex(b)) => a.same_primitives(b),
            _ => false,
        }
    }

    /// Whether the primitives of the two have the same numbers: both are convex, or one is and the other has one primitive, or both are one
    /// mesh or complex shape, deformed or not.
    pub(crate) fn has_primitives_of(&self, other: &Shape) -> bool {
        match (&self.geometry, &other.geometry) {
            (Geometry::Complex(a), Geometry::Complex(b)) => a.same_primitives(b),
            (Geometry::Complex(one), _) | (_, Geometry::Complex(one)) => one.tree().len() == 1,
            _ => true,
        }
    }

    /// The shape as a body with faces; `None` for a mesh or a complex shape.
    pub(crate) fn body(&self) -> Option<Body<'_>> {
        match &self.geometry {
            Geometry::Sphere(shape) => Some(Body::Sphere(shape)),
            Geometry::Cuboid(shape) => Some(Body::Cuboid(shape)),
            Geometry::Cone(shape) => Some(Body::Cone(shape)),
            Geometry::Cylinder(shape) => Some(Body::Cylinder(shape)),
            Geometry::Capsule(shape) => Some(Body::Capsule(shape)),
            Geometry::Polytope(shape) => Some(Body::Hull { hull: shape, names: None }),
            Geometry::Complex(_) => None,
        }
    }

    /// The primitive that the user gave, of which one of the shape's own is a part: what a result names.
    pub(crate) fn owner(&self, primitive: u32) -> u32 {
        match &self.geometry {
            Geometry::Complex(complex) => complex.owner(primitive),
            _ => primitive,
        }
    }

    /// What stands for a primitive where it is asked how deep it is: for the pieces of a convex polygon the first.
    pub(crate) fn whole(&self, primitive: u32) -> u32 {
        match &self.geometry {
            Geometry::Complex(complex) => complex.whole(primitive),
            _ => primitive,
        }
    }

    /// The polytope, of a convex hull.
    pub(crate) fn polytope(&self) -> Option<&Polytope> {
        match &self.geometry {
            Geometry::Polytope(shape) => Some(shape.polytope()),
            _ => None,
        }
    }

    /// The least and the greatest coordinates of its image under a linear map, up to rounding; of a complex shape, those of the image of its box.
    #[inline(always)]
    pub(crate) fn image_bounds<S: Simd>(&self, simd: S, linear: &DMat3) -> [DVec3; 2] {
        match &self.geometry {
            Geometry::Sphere(shape) => shape.image_bounds(linear),
            Geometry::Cuboid(shape) => shape.image_bounds(linear),
            Geometry::Cone(shape) => shape.image_bounds(linear),
            Geometry::Cylinder(shape) => shape.image_bounds(linear),
            Geometry::Capsule(shape) => shape.image_bounds(linear),
            Geometry::Polytope(shape) => shape.polytope().image_bounds_by(simd, linear),
            Geometry::Complex(shape) => {
                let image = shape.bounds().transformed(&DAffine3::from_mat3(*linear));
                [image.min, image.max]
            }
        }
    }

    pub(crate) fn class(&self) -> Class<'_> {
        match &self.geometry {
            Geometry::Sphere(shape) => Class::Convex(shape),
            Geometry::Cuboid(shape) => Class::Convex(shape),
            Geometry::Cone(shape) => Class::Convex(shape),
            Geometry::Cylinder(shape) => Class::Convex(shape),
            Geometry::Capsule(shape) => Class::Convex(shape),
            Geometry::Polytope(shape) => Class::Convex(shape.polytope()),
            Geometry::Complex(shape) => Class::Complex(shape),
        }
    }
}

impl From<Geometry> for Shape {
    fn from(geometry: Geometry) -> Self {
        Shape { geometry }
    }
}
