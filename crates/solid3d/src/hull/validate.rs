//! The exact check of a hull against its points.

use super::Hull;
use super::exact::{Site, Sites};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

impl Hull {
    /// Checks exactly that this is the hull of `points`: no point above a facet, all vertices extreme and of lowest
    /// index, the surface a closed manifold of Euler characteristic 2, the edges those of the facets. For tests: the cost
    /// is the number of points times the number of triangles.
    ///
    /// # Panics
    /// If anything is wrong.
    ///
    /// ```should_panic
    /// use solid3d::{glam::DVec3, hull::Hull};
    /// let triangle = Hull::of(&[DVec3::ZERO, DVec3::X, DVec3::Y]).expect("there are points");
    /// triangle.validate(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE]); // not the hull of these
    /// ```
    pub fn validate(&self, points: &[DVec3]) {
        let sites = Sites::new(points);
        let site_of: BTreeMap<u32, Site> = (0..sites.len()).map(|s| (sites.input(s), s)).collect();
        let site = |input: &u32| *site_of.get(input).expect("a vertex is the first of equal points");
        let vertices: Vec<Site> = self.vertices.iter().map(site).collect();
        let triangles: Vec<[Site; 3]> = self.triangles.iter().map(|t| t.each_ref().map(site)).collect();
        assert!(self.vertices.is_sorted_by(|a, b| a < b));
        self.validate_adjacency();
        match self.dimension {
            0 => assert_eq!((sites.len(), vertices.len(), triangles.len()), (1, 1, 0)),
            1 => {
                assert!(vertices.len() == 2 && triangles.is_empty());
                assert_eq!(sites.farthest_from_line(vertices[0], vertices[1]), None);
                assert_eq!(BTreeSet::from_iter(vertices), BTreeSet::from([0, sites.len() - 1]));
            }
            2 => validate_polygon(&sites, &vertices, &triangles),
            3 => validate_solid(&sites, &vertices, &triangles),
            d => panic!("dimension {d}"),
        }
        if self.dimension >= 2 {
            self.validate_surface();
        }
    }

    fn validate_adjacency(&self) {
        assert_eq!(self.neighbour_starts.len(), self.vertices.len() + 1);
        for slot in 0..self.vertices.len() {
            let neighbours = self.neighbours(slot);
            assert!(neighbours.is_sorted_by(|a, b| a < b), "neighbours of slot {slot}: {neighbours:?}");
            assert!(neighbours.len() >= usize::from(self.dimension), "slot {slot} has too few neighbours");
            for &other in neighbours {
                assert!(other as usize != slot && self.neighbours(other as usize).contains(&(slot as u32)));
            }
        }
    }

    /// Closed, manifold, of Euler characteristic 2, and over the vertices and edges given.
    fn validate_surface(&self) {
        let mut edges = BTreeSet::new();
        for &[a, b, c] in &self.triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                assert!(edges.insert(edge) || self.dimension == 2, "{edge:?} is in two triangles");
            }
        }
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))), "the surface is not closed");
        if self.dimension == 3 {
            assert_eq!(self.vertices.len() + self.triangles.len(), edges.len() / 2 + 2, "Euler");
        }
        let used: BTreeSet<u32> = self.triangles.iter().flatten().copied().collect();
        assert!(used.iter().eq(&self.vertices), "vertices and triangles disagree");
        for (slot, &vertex) in self.vertices.iter().enumerate() {
            for &other in self.neighbours(slot) {
                assert!(
                    edges.contains(&(vertex, self.vertices[other as usize])),
                    "an edge is no side of a triangle"
                );
            }
        }
    }
}

fn validate_polygon(sites: &Sites, vertices: &[Site], triangles: &[[Site; 3]]) {
    let plane = triangles[0];
    assert_eq!(sites.farthest_from_plane(plane), None);
    let (_, axis) = sites.farthest_from_line(plane[0], plane[1]).expect("a triangle is not flat");
    let is_front = |&&t: &&[Site; 3]| sites.turn(axis, t) > 0.0;
    let front: Vec<_> = triangles.iter().filter(is_front).collect();
    assert_eq!(2 * front.len(), triangles.len());
    assert_eq!(front.len() + 2, vertices.len());
    let sides: BTreeSet<_> = front.iter().flat_map(|&&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
    for &(a, b) in sides.iter().filter(|&&(a, b)| !sides.contains(&(b, a))) {
        for site in (0..sites.len()).filter(|&s| s != a && s != b) {
            let turn = sites.turn(axis, [a, b, site]);
            assert!(turn >= 0.0, "a point is outside");
            assert!(turn > 0.0 || !vertices.contains(&site), "a vertex lies on an edge");
        }
    }
}

fn validate_solid(sites: &Sites, vertices: &[Site], triangles: &[[Site; 3]]) {
    for &triangle in triangles {
        for site in 0..sites.len() {
            let height = sites.height(triangle, site);
            assert!(height <= 0.0, "point {} is above {triangle:?} by {height:e}", sites.input(site));
        }
    }
    let mut incident: BTreeMap<Site, Vec<[Site; 3]>> = BTreeMap::new();
    for &triangle in triangles {
        triangle.iter().for_each(|&corner| incident.entry(corner).or_default().push(triangle));
    }
    for vertex in vertices {
        let mut planes: Vec<[Site; 3]> = Vec::new();
        for &triangle in &incident[vertex] {
            if planes.iter().all(|&p| triangle.iter().any(|&corner| sites.height(p, corner) != 0.0)) {
                planes.push(triangle);
            }
        }
        assert!(planes.len() >= 3, "point {} is not extreme", sites.input(*vertex));
    }
}
