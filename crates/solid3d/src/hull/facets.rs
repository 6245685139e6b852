//! Coplanar triangles merged into the facets of the hull.

use super::exact::{Site, Sites};
use super::quickhull::Face;

/// Polygons, one after the other.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    corners: Vec<Site>,
    /// Where in `corners` each polygon ends.
    ends: Vec<usize>,
}

impl Polygons {
    pub fn iter(&self) -> impl Iterator<Item = &[Site]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.corners[start..end])
    }

    fn close(&mut self) {
        self.ends.push(self.corners.len());
    }
}

impl FromIterator<Vec<Site>> for Polygons {
    fn from_iter<I: IntoIterator<Item = Vec<Site>>>(polygons: I) -> Self {
        let mut all = Polygons::default();
        for polygon in polygons {
            all.corners.extend(polygon);
            all.close();
        }
        all
    }
}

/// The facets of a closed convex surface: largest sets of triangles in one plane, as polygons whose corners are extreme.
///
/// A point inside a facet is on no outline, one inside an edge on the outlines of two facets, an extreme one on three or
/// more: so counting tells which to keep, and two facets drop the same points of the edge between them.
pub(super) fn merge(sites: &Sites, surface: &[Face]) -> Polygons {
    let outlines = outlines(surface, &facet_of_each(sites, surface), sites.len());
    let mut facets_at = vec![0u32; sites.len() as usize];
    for &site in &outlines.corners {
        facets_at[site as usize] += 1;
    }
    let mut polygons = Polygons::default();
    for outline in outlines.iter() {
        polygons.corners.extend(outline.iter().filter(|&&site| facets_at[site as usize] >= 3));
        polygons.close();
    }
    polygons
}

/// Numbers the facets; gives each triangle the number of its facet.
fn facet_of_each(sites: &Sites, surface: &[Face]) -> Vec<u32> {
    const UNKNOWN: u32 = u32::MAX;
    let mut facet = vec![UNKNOWN; surface.len()];
    let mut count = 0;
    let mut stack = Vec::new();
    for start in 0..surface.len() {
        if facet[start] != UNKNOWN {
            continue;
        }
        facet[start] = count;
        stack.push(start);
        // Each triangle enters once.
        while let Some(index) = stack.pop() {
            let face = &surface[index];
            for beyond in face.beyond.map(|i| i as usize) {
                let in_plane = |&corner: &Site| sites.height(face.corners, corner) == 0.0;
                if facet[beyond] == UNKNOWN && surface[beyond].corners.iter().all(in_plane) {
                    facet[beyond] = count;
                    stack.push(beyond);
                }
            }
        }
        count += 1;
    }
    facet
}

/// The outline of each facet, all sites on it included.
fn outlines(surface: &[Face], facet: &[u32], sites: Site) -> Polygons {
    // The edges between different facets, by the facet on their left; (facet, from, to).
    let mut edges = Vec::new();
    for (index, face) in surface.iter().enumerate() {
        for i in 0..3 {
            if facet[face.beyond[i] as usize] != facet[index] {
                edges.push((facet[index], face.corners[i], face.corners[(i + 1) % 3]));
            }
        }
    }
    edges.sort_unstable();
    let mut outlines = Polygons::default();
    let mut next = vec![0; sites as usize];
    for outline in edges.chunk_by(|a, b| a.0 == b.0) {
        for &(_, from, to) in outline {
            next[from as usize] = to;
        }
        // A facet is convex, so its outline is one cycle.
        let mut at = outline[0].1;
        for _ in outline {
            outlines.corners.push(at);
            at = next[at as usize];
        }
        outlines.close();
    }
    outlines
}
