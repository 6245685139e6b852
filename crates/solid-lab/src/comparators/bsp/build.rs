use solid3d::Aabb;
use solid3d::glam::DVec3;

use super::FLAT;
use super::plane::{Plane, Side, cut_polygon};

/// A polyhedron as a tree of planes. Space: its own.
///
/// Source: Thibault and Naylor, *Set operations on polyhedra using binary space partitioning trees*, 1987: the planes are those of the
/// facets, which are cut where they lie across one; below the last is inside, above it outside.
#[derive(Clone, Debug, PartialEq)]
pub struct BspTree {
    nodes: Vec<Node>,
    bounds: Aabb,
}

/// A plane, and what is on both sides of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Of a facet.
    pub plane: Plane,
    /// Inside of the facet.
    pub below: Child,
    /// Outside of it.
    pub above: Child,
}

/// A part of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// Cut further, by the node of that number.
    Node(u32),
    /// Inside of the polyhedron.
    In,
    /// Outside.
    Out,
}

/// So many facets are tried for a plane; more hardly make better trees.
const CANDIDATES_MAX: usize = 8;

/// A facet cut counts as so many facets of difference between the sides.
const CUT_COST: usize = 4;

/// Facets still to be divided, and where the node for them goes: on which node, and whether above it.
type Task = (Vec<Facet>, Option<(u32, bool)>);

/// A part of a facet, and the plane of the whole, which is not made less exact by cuts.
struct Facet {
    polygon: Vec<DVec3>,
    plane: Plane,
}

impl BspTree {
    /// Of a closed surface that does not cross itself, of triangles that are counter-clockwise seen from outside. Triangles without area are left
    /// out.
    ///
    /// The nodes may be as many as the square of the triangles (Paterson and Yao); each takes a facet off, so the depth is at most their
    /// number.
    pub fn of_triangles(triangles: impl IntoIterator<Item = [DVec3; 3]>) -> Self {
        let facet = |[p, q, r]: [DVec3; 3]| {
            let plane = Plane::through(p, (q - p).cross(r - p))?;
            Some(Facet { polygon: vec![p, q, r], plane })
        };
        let facets: Vec<Facet> = triangles.into_iter().filter_map(facet).collect();
        let bounds = Aabb::of_points(facets.iter().flat_map(|f| f.polygon.iter().copied()));
        let tolerance = FLAT * greatest_coordinate(&bounds);
        let mut nodes: Vec<Node> = Vec::new();
        let mut open: Vec<Task> = vec![(facets, None)];
        while let Some((facets, place)) = open.pop() {
            if facets.is_empty() {
                continue;
            }
            let number = nodes.len() as u32;
            if let Some((parent, above)) = place {
                let parent = &mut nodes[parent as usize];
                *(if above { &mut parent.above } else { &mut parent.below }) = Child::Node(number);
            }
            let (plane, [below, above]) = divide(facets, tolerance);
            nodes.push(Node { plane, below: Child::In, above: Child::Out });
            open.extend([(below, Some((number, false))), (above, Some((number, true)))]);
        }
        BspTree { nodes, bounds }
    }

    /// All planes, the first at the root; none for no facets.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Where to begin.
    pub fn root(&self) -> Child {
        if self.nodes.is_empty() { Child::Out } else { Child::Node(0) }
    }

    /// The box around the polyhedron.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Whether a point is inside; either, on the surface and within rounding of it.
    pub fn contains(&self, point: DVec3) -> bool {
        let mut child = self.root();
        while let Child::Node(number) = child {
            let node = &self.nodes[number as usize];
            child = if node.plane.height(point) <= 0.0 { node.below } else { node.above };
        }
        child == Child::In
    }
}

/// The greatest absolute coordinate.
pub fn greatest_coordinate(bounds: &Aabb) -> f64 {
    bounds.min.abs().max(bounds.max.abs()).max_element()
}

/// The plane of one of the facets, and what of the others is below and above it. Those on it are done.
fn divide(facets: Vec<Facet>, tolerance: f64) -> (Plane, [Vec<Facet>; 2]) {
    let step = facets.len().div_ceil(CANDIDATES_MAX);
    let chosen = (0..facets.len())
        .step_by(step)
        .min_by_key(|&i| cost(&facets[i].plane, &facets, tolerance))
        .expect("there are facets");
    let plane = facets[chosen].plane;
    let mut sides = [const { Vec::new() }; 2];
    for (i, facet) in facets.into_iter().enumerate() {
        match side(&facet, &plane, tolerance) {
            // The facet itself, which must not come again.
            _ if i == chosen => (),
            Side::On => (),
            Side::Below => sides[0].push(facet),
            Side::Above => sides[1].push(facet),
            Side::Both => {
                let [below, above, _] = cut_polygon(&facet.polygon, &plane, tolerance);
                for (side, polygon) in sides.iter_mut().zip([below, above]) {
                    side.push(Facet { polygon, plane: facet.plane });
                }
            }
        }
    }
    (plane, sides)
}

fn side(facet: &Facet, plane: &Plane, tolerance: f64) -> Side {
    Side::of_heights(facet.polygon.iter().map(|p| plane.height(*p)), tolerance)
}

/// How bad a plane is: cuts make the tree large, uneven sides make it deep.
fn cost(plane: &Plane, facets: &[Facet], tolerance: f64) -> usize {
    let (mut below, mut above, mut cut) = (0usize, 0usize, 0);
    for facet in facets {
        match side(facet, plane, tolerance) {
            Side::Below => below += 1,
            Side::Above => above += 1,
            Side::Both => cut += 1,
            Side::On => (),
        }
    }
    below.abs_diff(above) + CUT_COST * cut
}
