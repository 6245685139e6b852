//! The surface of a solid hull as triangles over sites, by quickhull with exact visibility.
//!
//! A face is visible from a site only if the site is *strictly* above its plane. From that follow, exactly:
//!
//! * A site outside the hull sees a face, so it is never lost.
//! * The visible faces form a disc, so their horizon is one simple cycle: at a vertex the normals of the incident faces
//!   form a convex cone, which a half-space cuts in one interval.
//! * A new face over a horizon edge is no degenerate one: on the edge's line the site would not see the visible side.
//! * A site that saw a removed face and is still outside sees a *new* face. (If it saw only old ones, it would see both
//!   sides of some horizon edge, and then the new face over that edge lies between them.) So the sites of the removed
//!   faces need be tested against the new faces only.
//!
//! A face coplanar with the new site stays, and the new face beside it continues its plane; `facets` merges them.

use std::collections::VecDeque;

use super::exact::{Site, Sites};

/// No face or no site.
const NONE: u32 = u32::MAX;

#[derive(Clone, Debug)]
pub(super) struct Face {
    /// Counter-clockwise from outside.
    pub corners: [Site; 3],
    /// The faces beyond the edges; edge `i` goes from corner `i` to the next.
    pub beyond: [u32; 3],
    /// The first of the unprocessed sites given to this face: one that is about the highest above it. The others follow
    /// in `Quickhull::next_outside`.
    outside: Site,
    highest: f64,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    OnHull,
    /// About to be removed.
    Visible,
    Removed,
}

#[derive(Debug)]
struct Quickhull<'a> {
    sites: &'a Sites,
    faces: Vec<Face>,
    /// Removed faces, to be used again.
    free: Vec<u32>,
    /// By site: the next in the list it stands in.
    next_outside: Vec<Site>,
    /// Scratch, by site: the new face whose horizon edge starts there.
    new_face_from: Vec<u32>,
}

/// The triangles of the hull of the sites, given four that span space. Corners, and the indices of the faces beyond the
/// edges.
pub(super) fn surface(sites: &Sites, simplex: [Site; 4]) -> Vec<Face> {
    let mut hull = Quickhull::new(sites);
    hull.grow(simplex);
    hull.compacted()
}

impl<'a> Quickhull<'a> {
    fn new(sites: &'a Sites) -> Self {
        let of_each = vec![NONE; sites.len() as usize];
        Quickhull {
            sites,
            faces: Vec::new(),
            free: Vec::new(),
            next_outside: of_each.clone(),
            new_face_from: of_each,
        }
    }

    /// Makes a vertex of each site that is one. Returns how many faces were made on the way.
    fn grow(&mut self, simplex: [Site; 4]) -> usize {
        self.start(simplex);
        // The oldest first, so that the hull grows on all sides: of two rings, one after the other, each site of the second sees half of a ring.
        let mut to_do = VecDeque::from([0, 1, 2, 3]);
        let (mut visible, mut new_faces) = (Vec::new(), Vec::new());
        let mut made = to_do.len();
        // Each turn drops a face from the list and may make a site a vertex, which sees the face; a site is made a vertex at most once.
        while let Some(face) = to_do.pop_front() {
            let Face { outside, state, .. } = self.faces[face as usize];
            if state != State::OnHull || outside == NONE {
                continue;
            }
            self.find_visible(face, outside, &mut visible);
            self.make_cone(outside, &visible, &mut new_faces);
            self.hand_over(outside, &visible, &new_faces);
            made += new_faces.len();
            to_do.extend(new_faces.iter().filter(|&&face| self.faces[face as usize].outside != NONE));
        }
        made
    }

    fn start(&mut self, [a, b, c, d]: [Site; 4]) {
        let (b, c) = if self.sites.height([a, b, c], d) > 0.0 { (c, b) } else { (b, c) };
        let faces =
            [([a, b, c], [1, 2, 3]), ([b, a, d], [0, 3, 2]), ([c, b, d], [0, 1, 3]), ([a, c, d], [0, 2, 1])];
        for (corners, beyond) in faces {
            self.add_face(corners, beyond);
        }
        for site in (0..self.sites.len()).filter(|site| ![a, b, c, d].contains(site)) {
            self.give(site, &[0, 1, 2, 3]);
        }
    }

    fn add_face(&mut self, corners: [Site; 3], beyond: [u32; 3]) -> u32 {
        let face = Face { corners, beyond, outside: NONE, highest: 0.0, state: State::OnHull };
        match self.free.pop() {
            Some(index) => {
                self.faces[index as usize] = face;
                index
            }
            None => {
                self.faces.push(face);
                self.faces.len() as u32 - 1
            }
        }
    }

    /// Gives a site to the first of some faces that it sees; if it sees none it is inside, and forgotten.
    fn give(&mut self, site: Site, faces: &[u32]) {
        for &index in faces {
            let face = &mut self.faces[index as usize];
            let height = self.sites.height(face.corners, site);
            if height > 0.0 {
                if height > face.highest {
                    face.highest = height;
                    self.next_outside[site as usize] = face.outside;
                    face.outside = site;
                } else {
                    let second = std::mem::replace(&mut self.next_outside[face.outside as usize], site);
                    self.next_outside[site as usize] = second;
                }
                return;
            }
        }
    }

    /// Collects and marks the faces visible from a site, one of which is known.
    fn find_visible(&mut self, start: u32, from: Site, visible: &mut Vec<u32>) {
        visible.clear();
        visible.push(start);
        self.faces[start as usize].state = State::Visible;
        let mut done = 0;
        // Each face enters once.
        while let Some(&index) = visible.get(done) {
            done += 1;
            for beyond in self.faces[index as usize].beyond {
                let face = &mut self.faces[beyond as usize];
                if face.state == State::OnHull && self.sites.height(face.corners, from) > 0.0 {
                    face.state = State::Visible;
                    visible.push(beyond);
                }
            }
        }
    }

    /// Joins the horizon of the visible faces to a new vertex.
    fn make_cone(&mut self, apex: Site, visible: &[u32], new_faces: &mut Vec<u32>) {
        new_faces.clear();
        for &index in visible {
            let Face { corners, beyond, .. } = self.faces[index as usize];
            for edge in 0..3 {
                let outer = beyond[edge];
                if self.faces[outer as usize].state == State::Visible {
                    continue;
                }
                let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
                let new = self.add_face([from, to, apex], [outer, NONE, NONE]);
                self.new_face_from[from as usize] = new;
                let outer = &mut self.faces[outer as usize];
                let back = (0..3).find(|&i| outer.beyond[i] == index && outer.corners[i] == to);
                outer.beyond[back.expect("faces are linked both ways")] = new;
                new_faces.push(new);
            }
        }
        // The horizon is a simple cycle: one new face starts where another ends.
        for &new in new_faces.iter() {
            let next = self.new_face_from[self.faces[new as usize].corners[1] as usize];
            self.faces[new as usize].beyond[1] = next;
            self.faces[next as usize].beyond[2] = new;
        }
    }

    /// Gives the sites of the visible faces to the new faces, and removes the visible ones.
    fn hand_over(&mut self, apex: Site, visible: &[u32], new_faces: &[u32]) {
        for &index in visible {
            let face = &mut self.faces[index as usize];
            face.state = State::Removed;
            let mut site = face.outside;
            while site != NONE {
                let next = self.next_outside[site as usize];
                if site != apex {
                    self.give(site, new_faces);
                }
                site = next;
            }
        }
        self.free.extend_from_slice(visible);
    }

    /// The faces on the hull, without gaps.
    fn compacted(self) -> Vec<Face> {
        let mut new_index = vec![NONE; self.faces.len()];
        let on_hull = |face: &Face| face.state == State::OnHull;
        for (new, (old, _)) in (0..).zip(self.faces.iter().enumerate().filter(|(_, f)| on_hull(f))) {
            new_index[old] = new;
        }
        let mut faces: Vec<Face> = self.faces.into_iter().filter(on_hull).collect();
        for face in &mut faces {
            face.beyond = face.beyond.map(|old| new_index[old as usize]);
        }
        faces
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;

    use super::*;

    /// Law: a site makes as many faces as it sees edges of the horizon, on average a few, also of a prism, of two rings that are linked, and of one in
    /// front of another, where half of them would be seen if one ring were done first.
    #[test]
    fn a_site_makes_few_faces() {
        const SIDES: u32 = 4000;
        let ring = |at: &dyn Fn(f64, f64) -> DVec3| -> Vec<DVec3> {
            (0..SIDES)
                .map(|i| (f64::from(i) / f64::from(SIDES) * TAU).sin_cos())
                .map(|(s, c)| at(s, c))
                .collect()
        };
        let bottom = ring(&|s, c| DVec3::new(c, -1.0, s));
        let beside: [Vec<DVec3>; 3] = [
            ring(&|s, c| DVec3::new(c, 1.0, s)),
            ring(&|s, c| DVec3::new(0.5 * c, 1.0, 0.5 * s)),
            ring(&|s, c| DVec3::new(c + 1.0, s - 1.0, 0.0)),
        ];
        for (case, other) in beside.into_iter().enumerate() {
            let sites = Sites::new(&[&bottom[..], &other].concat());
            let quarter = [0, SIDES / 3, 2 * SIDES / 3, SIDES + 1].map(|i| {
                (0..sites.len()).find(|&site| sites.input(site) == i).expect("no two points are one")
            });
            let made = Quickhull::new(&sites).grow(quarter);
            assert!(made < 8 * sites.len() as usize, "case {case}: {made} faces for {} sites", sites.len());
        }
    }
}
