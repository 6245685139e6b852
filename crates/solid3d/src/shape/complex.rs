//! The complex shape: a soup of convex primitives over one vertex buffer, under a tree (thesis, section 6.3.1).

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::DVec3;
use solid_convex::{IndexedPoints, Support};

use super::hulled::Hulled;
use super::parts::parts;
use super::solid::Solid;
use super::soup_hull::SoupHull;
use super::topology::{Positioned, Topology};
use super::validate;
use crate::bounds::Aabb;
use crate::error::{Error, Result};
use crate::polygon::Polygon;
use crate::threads::{both, for_each_part, in_pool};
use crate::tree::{LeafImages, LeafPoints, Slabs, Tree};

/// To build a tree of so many primitives, or to refit it, is worth entering the pool of threads.
const BUILT_MANY: usize = 1 << 13;
const REFITTED_MANY: usize = 1 << 16;

/// A soup of convex primitives. Clones share what a deformation leaves alone.
#[derive(Clone, Debug)]
pub(crate) struct Complex {
    primitives: Arc<Primitives>,
    vertices: Vec<DVec3>,
    tree: Tree,
    /// What keeps a mesh closed, when it bounds a solid.
    solid: Option<Arc<Solid>>,
    /// A vertex of each connected part, found when first asked for. Shared by the deformations of one soup, and by nothing
    /// else.
    parts: Arc<OnceLock<Vec<u32>>>,
    /// What lies next to what, at these positions, found when first asked for.
    topology: OnceLock<Arc<Topology>>,
    /// The mean of all corners, at these positions, found when first asked for.
    center: OnceLock<DVec3>,
    /// The hulls of primitives of more than three vertices, at these positions, each made when first asked for.
    hulls: OnceLock<Arc<PrimitiveHulls>>,
    /// Whether each polygon that is in pieces is convex, at these positions, found when first asked for.
    convex: OnceLock<Arc<Vec<OnceLock<bool>>>>,
    /// How flat it is, at these positions, found when first asked for.
    slabs: OnceLock<Arc<Slabs>>,
    /// Images of the triangles of a mesh, found when first asked for.
    images: OnceLock<Option<Arc<LeafImages>>>,
    /// Whether the positions are others than those for which the tree was built: then nothing is found that only saves time, as what deforms
    /// again and again would have it found again and again.
    is_deformed: bool,
    /// What a refit reads, of this tree at any positions, found at the first deformation.
    leaf_points: OnceLock<Arc<LeafPoints>>,
}

/// By primitive.
type PrimitiveHulls = Vec<OnceLock<Box<Hulled>>>;

/// Which vertices make up each primitive: its hull is the primitive. Invariant: there is at least one, each names at
/// least one vertex, and every index is in range.
#[derive(Debug)]
pub(super) enum Primitives {
    /// All are triangles.
    Triangles(Vec<[u32; 3]>),
    /// Primitive `i` is the hull of `indices[first[i]..first[i + 1]]`.
    Mixed {
        first: Vec<u32>,
        indices: Vec<u32>,
        /// Of which of the user's primitives each is a piece, ascending from 0 without gaps; empty when all are whole.
        owners: Vec<u32>,
        /// Those of the user's that are polygons of several pieces, ascending.
        polygons: Vec<CutPolygon>,
    },
}

/// A simple polygon that is in pieces.
#[derive(Clone, Debug)]
pub(super) struct CutPolygon {
    pub pieces: Range<u32>,
    /// The vertices around it.
    pub chain: Box<[u32]>,
}

impl Primitives {
    fn len(&self) -> usize {
        match self {
            Primitives::Triangles(triangles) => triangles.len(),
            Primitives::Mixed { first, .. } => first.len() - 1,
        }
    }

    /// The user's primitive that a primitive is a piece of: what a result names.
    fn owner(&self, primitive: u32) -> u32 {
        match self {
            Primitives::Mixed { owners, .. } if !owners.is_empty() => owners[primitive as usize],
            _ => primitive,
        }
    }

    /// The simple polygons that are in pieces.
    fn polygons(&self) -> &[CutPolygon] {
        match self {
            Primitives::Triangles(_) => &[],
            Primitives::Mixed { polygons, .. } => polygons,
        }
    }

    #[inline(always)]
    fn get(&self, primitive: u32) -> &[u32] {
        let i = primitive as usize;
        match self {
            Primitives::Triangles(triangles) => &triangles[i],
            Primitives::Mixed { first, indices, .. } => &indices[first[i] as usize..first[i + 1] as usize],
        }
    }

    /// The indices of all primitives, one after the other.
    fn indices(&self) -> &[u32] {
        match self {
            Primitives::Triangles(triangles) => triangles.as_flattened(),
            Primitives::Mixed { indices, .. } => indices,
        }
    }

    /// The box around a primitive.
    #[inline(always)]
    fn bounds(&self, primitive: u32, vertices: &[DVec3]) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for &index in self.get(primitive) {
            bounds.grow(vertices[index as usize]);
        }
        bounds
    }

    /// The memory that the primitives own, in bytes.
    fn memory(&self) -> usize {
        match self {
            Primitives::Triangles(triangles) => triangles.capacity() * size_of::<[u32; 3]>(),
            Primitives::Mixed { first, indices, owners, polygons } => {
                let chains: usize = polygons.iter().map(|polygon| polygon.chain.len()).sum();
                (first.capacity() + indices.capacity() + owners.capacity() + chains) * size_of::<u32>()
                    + polygons.capacity() * size_of::<CutPolygon>()
            }
        }
    }
}

impl Complex {
    pub fn mesh(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        validate::vertex_count("vertices", vertices.len())?;
        validate::primitive_count("triangles", triangles.len())?;
        in_pool(triangles.len() >= BUILT_MANY, || {
            validate::triangles(&triangles, vertices.len())?;
            Self::new(vertices, Primitives::Triangles(triangles))
        })
    }

    /// The vertices are checked here; the primitives were by the caller.
    pub(super) fn new(vertices: Vec<DVec3>, primitives: Primitives) -> Result<Self> {
        let tree = in_pool(primitives.len() >= BUILT_MANY, || {
            validate::vertices(&vertices).map(|()| build(&primitives, &vertices))
        })?;
        Ok(Complex {
            primitives: Arc::new(primitives),
            vertices,
            tree,
            solid: None,
            parts: Arc::default(),
            topology: OnceLock::new(),
            center: OnceLock::new(),
            hulls: OnceLock::new(),
            convex: OnceLock::new(),
            slabs: OnceLock::new(),
            images: OnceLock::new(),
            is_deformed: false,
            leaf_points: OnceLock::new(),
        })
    }

    pub fn is_mesh(&self) -> bool {
        matches!(*self.primitives, Primitives::Triangles(_))
    }

    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    pub fn triangles(&self) -> Option<&[[u32; 3]]> {
        match &*self.primitives {
            Primitives::Triangles(triangles) => Some(triangles),
            Primitives::Mixed { .. } => None,
        }
    }

    /// Makes a mesh solid; other soups stay as they are.
    pub fn solidify(&mut self) -> Result<()> {
        if let (Primitives::Triangles(triangles), None) = (&*self.primitives, &self.solid) {
            self.solid = Some(Arc::new(Solid::of(&self.vertices, triangles)?));
            self.parts = Arc::default();
            self.topology = OnceLock::new();
        }
        Ok(())
    }

    /// Whether it is a mesh that stands for the region which it bounds.
    pub fn is_solid(&self) -> bool {
        self.solid.is_some()
    }

    /// A vertex of each connected part. Cost: nearly linear at the first call for a soup and its deformations.
    pub fn parts(&self) -> &[u32] {
        self.parts.get_or_init(|| {
            let primitives = (0..self.primitives.len() as u32).map(|i| self.primitives.get(i));
            let twins = self.solid.as_ref().map_or(&[][..], |solid| solid.twins());
            parts(self.vertices.len(), primitives, twins)
        })
    }

    /// What lies next to what. Cost: O(n) at the first call since the last deformation, O(n log n) for a closed convex mesh.
    pub fn topology(&self) -> &Topology {
        self.topology.get_or_init(|| {
            Arc::new(match self.positioned() {
                Some(mesh) => Topology::of_mesh(mesh, &self.bounds(), self.is_solid()),
                None => {
                    let primitives = (0..self.primitives.len() as u32).map(|i| self.primitives.get(i));
                    Topology::of(&self.vertices, primitives)
                }
            })
        })
    }

    /// Whether a primitive is a triangle whose surroundings are in its plane on all sides.
    pub fn is_flat(&self, primitive: u32) -> bool {
        self.positioned().is_some_and(|mesh| self.topology().is_flat(mesh, primitive))
    }

    /// Whether a primitive is a triangle whose surroundings are in its plane, as far as they go.
    pub fn is_level(&self, primitive: u32) -> bool {
        self.positioned().is_some_and(|mesh| self.topology().is_level(mesh, primitive))
    }

    fn positioned(&self) -> Option<Positioned<'_>> {
        Some(Positioned { vertices: &self.vertices, triangles: self.triangles()? })
    }

    /// How flat the surface is below each lane of the tree. Cost: O(n) at the first call since the last deformation.
    pub fn slabs(&self) -> &Slabs {
        self.slabs.get_or_init(|| {
            Arc::new(Slabs::new(&self.tree, &self.vertices, |primitive| self.primitives.get(primitive)))
        })
    }

    /// The slabs, if they are likely to last: not after a deformation, also when they are known.
    pub fn lasting_slabs(&self) -> Option<&Slabs> {
        (!self.is_deformed).then(|| self.slabs())
    }

    /// Images of the triangles in the leaves of the tree; none of other primitives, nor after a deformation. Cost: O(n) at the first call.
    pub fn images(&self) -> Option<&LeafImages> {
        if self.is_deformed {
            return None;
        }
        let found = self.images.get_or_init(|| {
            let triangles = self.triangles()?;
            let triangle = |primitive: u32| triangles[primitive as usize];
            Some(Arc::new(LeafImages::new(&self.tree, &self.vertices, triangle)))
        });
        found.as_deref()
    }

    /// Whether both are soups of the same primitives, both solid or both not: one is a deformation of the other.
    pub fn same_primitives(&self, other: &Complex) -> bool {
        Arc::ptr_eq(&self.parts, &other.parts)
    }

    /// The primitive that the user gave, of which this one is a part.
    pub fn owner(&self, primitive: u32) -> u32 {
        self.primitives.owner(primitive)
    }

    /// How many primitives the user gave: those of one owner count as one.
    pub fn primitive_count(&self) -> usize {
        // There is at least one.
        self.primitives.owner(self.primitives.len() as u32 - 1) as usize + 1
    }

    /// The indices of the vertices of all primitives, one primitive after the other.
    pub fn indices(&self) -> &[u32] {
        self.primitives.indices()
    }

    /// The indices of the vertices whose hull the primitive is.
    pub fn primitive(&self, primitive: u32) -> &[u32] {
        self.primitives.get(primitive)
    }

    /// The vertices that stand for those of the primitive and all at their positions.
    pub fn welded(&self, primitive: u32) -> impl Iterator<Item = u32> + '_ {
        self.primitive(primitive).iter().map(|&i| self.topology().welded(i))
    }

    /// The points whose hull the primitive is.
    #[inline(always)]
    pub fn points_of(&self, primitive: u32) -> impl Iterator<Item = DVec3> + Clone + '_ {
        self.points_at(self.primitive(primitive))
    }

    #[inline(always)]
    fn points_at<'s>(&'s self, indices: &'s [u32]) -> impl Iterator<Item = DVec3> + Clone + 's {
        indices.iter().map(|&i| self.vertices[i as usize])
    }

    /// The primitive as a convex object.
    pub fn primitive_hull(&self, primitive: u32) -> IndexedPoints<'_> {
        self.hull_at(self.primitive(primitive))
    }

    fn hull_at<'s>(&'s self, indices: &'s [u32]) -> IndexedPoints<'s> {
        IndexedPoints::new(&self.vertices, indices)
            .expect("a primitive has a vertex, and its indices were checked")
    }

    /// Whether it has polygons that are in pieces.
    pub fn has_polygons(&self) -> bool {
        !self.primitives.polygons().is_empty()
    }

    /// Whether a primitive, of those that were given, is a polygon that was cut into pieces. Cost: O(log n).
    pub fn is_cut(&self, primitive: u32) -> bool {
        let owner = |polygon: &CutPolygon| self.owner(polygon.pieces.start);
        self.primitives.polygons().binary_search_by_key(&primitive, owner).is_ok()
    }

    /// The convex polygon that a primitive is a piece of. Cost: O(n log n) for a polygon at the first call since the last deformation.
    fn convex_polygon(&self, piece: u32) -> Option<&CutPolygon> {
        let polygons = self.primitives.polygons();
        let last = polygons.partition_point(|polygon| polygon.pieces.start <= piece).checked_sub(1)?;
        let polygon = &polygons[last];
        (polygon.pieces.contains(&piece) && self.is_convex(last)).then_some(polygon)
    }

    fn is_convex(&self, polygon: usize) -> bool {
        let polygons = self.primitives.polygons();
        let none = || Arc::new(vec![OnceLock::new(); polygons.len()]);
        *self.convex.get_or_init(none)[polygon].get_or_init(|| {
            let corners: Vec<DVec3> = self.points_at(&polygons[polygon].chain).collect();
            Polygon::new(corners).is_ok_and(|polygon| polygon.fills_hull())
        })
    }

    /// Whether a primitive is one of the pieces of a convex polygon.
    pub fn is_piece(&self, primitive: u32) -> bool {
        self.convex_polygon(primitive).is_some()
    }

    /// What stands for a primitive where it is asked how deep it is: the first of all pieces of a convex polygon, any other itself.
    pub fn whole(&self, primitive: u32) -> u32 {
        self.convex_polygon(primitive).map_or(primitive, |polygon| polygon.pieces.start)
    }

    /// The indices of the vertices whose hull the whole of a primitive is.
    fn of_whole(&self, primitive: u32) -> &[u32] {
        self.convex_polygon(primitive).map_or_else(|| self.primitive(primitive), |polygon| &polygon.chain)
    }

    /// The points whose hull the whole of a primitive is.
    pub fn points_of_whole(&self, primitive: u32) -> impl Iterator<Item = DVec3> + '_ {
        self.points_at(self.of_whole(primitive))
    }

    /// The whole of a primitive as a convex object.
    pub fn whole_hull(&self, primitive: u32) -> IndexedPoints<'_> {
        self.hull_at(self.of_whole(primitive))
    }

    /// The hull of a primitive, with its faces. Cost: O(n log n) at the first call since the last deformation.
    pub fn hull_of(&self, primitive: u32) -> &Hulled {
        let none = || Arc::new(vec![OnceLock::new(); self.primitives.len()]);
        self.hulls.get_or_init(none)[primitive as usize].get_or_init(|| {
            Box::new(Hulled::new(self.points_of(primitive).collect()).expect("a primitive has a vertex"))
        })
    }

    /// The box around a primitive.
    pub fn primitive_bounds(&self, primitive: u32) -> Aabb {
        self.primitives.bounds(primitive, &self.vertices)
    }

    /// The convex hull of all primitives; vertices that none of them names have no part in it. Cost: O(n) at the first call since the last
    /// deformation, for its middle.
    pub fn hull(&self) -> SoupHull<'_> {
        SoupHull::new(self, *self.center.get_or_init(|| self.corners().center()))
    }

    /// The corners of all primitives, one after the other.
    pub(super) fn corners(&self) -> IndexedPoints<'_> {
        self.hull_at(self.indices())
    }

    /// The memory that it owns, in bytes, with what clones share.
    pub fn memory(&self) -> usize {
        fn shared<T>(it: &Arc<T>, owned: impl Fn(&T) -> usize) -> usize {
            size_of::<T>() + owned(it)
        }
        let primitives = shared(&self.primitives, Primitives::memory);
        let parts =
            |parts: &OnceLock<Vec<u32>>| parts.get().map_or(0, |parts| parts.capacity() * size_of::<u32>());
        let solid = self.solid.as_ref().map_or(0, |solid| solid.memory());
        let topology = self.topology.get().map_or(0, |it| shared(it, Topology::bytes));
        let hulls = self.hulls.get().map_or(0, |it| shared(it, bytes_of));
        let convex =
            self.convex.get().map_or(0, |it| shared(it, |it| it.capacity() * size_of::<OnceLock<bool>>()));
        let slabs = self.slabs.get().map_or(0, |it| shared(it, Slabs::bytes));
        let images = self.images.get().and_then(Option::as_ref).map_or(0, |it| shared(it, LeafImages::bytes));
        let leaf_points = self.leaf_points.get().map_or(0, |it| shared(it, LeafPoints::bytes));
        let found = shared(&self.parts, parts) + topology + hulls + convex + slabs + images + leaf_points;
        let vertices = self.vertices.capacity() * size_of::<DVec3>();
        size_of::<Complex>() + primitives + vertices + self.tree.bytes() + solid + found
    }

    /// The tree over the primitives.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The box around all primitives.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// The largest magnitude of each coordinate over all primitives.
    pub fn reach(&self) -> DVec3 {
        let Aabb { min, max } = self.bounds();
        min.abs().max(max.abs())
    }

    fn check_positions(&self, positions: &[DVec3]) -> Result<()> {
        if positions.len() != self.vertices.len() {
            return Err(Error::PositionCount { count: positions.len(), expected: self.vertices.len() });
        }
        validate::vertices(positions)?;
        self.solid.as_ref().map_or(Ok(()), |solid| solid.check(positions))
    }

    /// Has a shape take new positions, if they may be taken.
    pub fn deform(complex: &mut Arc<Self>, positions: &[DVec3]) -> Result<()> {
        in_pool(complex.primitives.len() >= REFITTED_MANY, || {
            complex.check_positions(positions)?;
            Arc::make_mut(complex).take_positions(positions);
            Ok(())
        })
    }

    /// Takes new positions, which were checked.
    pub(super) fn take_positions(&mut self, positions: &[DVec3]) {
        let Complex { primitives, vertices, tree, leaf_points, .. } = self;
        let points = leaf_points
            .get_or_init(|| Arc::new(LeafPoints::new(tree, |primitive| primitives.get(primitive))));
        let part = validate::VERTICES_PART;
        let copy = || {
            for_each_part(vertices, part, validate::VERTICES_MANY, |i, vertices| {
                vertices.copy_from_slice(&positions[i * part..][..vertices.len()]);
            });
        };
        // Not from the copies: what one thread has just written another waits for.
        let refit = || tree.refit_points(points, positions);
        both(positions.len() >= validate::VERTICES_MANY, refit, copy);
        self.topology = OnceLock::new();
        self.center = OnceLock::new();
        self.hulls = OnceLock::new();
        self.convex = OnceLock::new();
        self.slabs = OnceLock::new();
        self.images = OnceLock::new();
        self.is_deformed = !self.tree.degraded();
        if !self.is_deformed {
            self.tree = build(&self.primitives, &self.vertices);
            self.leaf_points = OnceLock::new();
        }
    }
}

/// The memory that hulls own, in bytes.
fn bytes_of(hulls: &PrimitiveHulls) -> usize {
    let of_made: usize =
        hulls.iter().filter_map(OnceLock::get).map(|hull| size_of::<Hulled>() + hull.bytes()).sum();
    hulls.capacity() * size_of::<OnceLock<Box<Hulled>>>() + of_made
}

fn build(primitives: &Primitives, vertices: &[DVec3]) -> Tree {
    Tree::build_of(
        primitives.len(),
        #[inline(always)]
        |primitive| primitives.bounds(primitive, vertices),
    )
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use crate::{ComplexShapeBuilder, Shape, query};

    /// The hull of the primitives, not of the vertex buffer, has a separating axis.
    #[test]
    fn vertices_without_a_primitive_take_no_part() {
        let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z * 100.0];
        let mesh = Shape::mesh(vertices, [[0, 1, 2]]).unwrap();
        let complex = ComplexShapeBuilder::new(vertices).triangle([0, 1, 2]).segment([0, 1]).build().unwrap();
        let above = DAffine3::from_translation(DVec3::new(0.1, 0.1, 10.0));
        let ball = Shape::sphere(1.0).unwrap();
        for shape in [&mesh, &complex] {
            for other in [&mesh, &complex, &ball] {
                let axis = query::separating_axis(shape, &DAffine3::IDENTITY, other, &above).unwrap();
                assert!(axis.is_some_and(|axis| axis.z < 0.0), "{axis:?}");
            }
        }
    }
}
