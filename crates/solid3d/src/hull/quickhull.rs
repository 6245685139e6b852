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
    let mut hull = Quickhull {
        sites,
        faces: Vec::new(),
        free: Vec::new(),
        next_outside: vec![NONE; sites.len() as usize],
        new_face_from: vec![NONE; sites.len() as usize],
    };
    hull.start(simplex);
    let mut to_do: Vec<u32> = vec![0, 1, 2, 3];
    let (mut visible, mut new_faces) = (Vec::new(), Vec::new());
    // Each turn drops a face from the list or makes a site a vertex; a site is made a vertex at most once.
    while let Some(&face) = to_do.last() {
        let Face { outside, state, .. } = hull.faces[face as usize];
        if state != State::OnHull || outside == NONE {
            to_do.pop();
            continue;
        }
        hull.find_visible(face, outside, &mut visible);
        hull.make_cone(outside, &visible, &mut new_faces);
        hull.hand_over(outside, &visible, &new_faces);
        to_do.extend_from_slice(&new_faces);
    }
    hull.compacted()
}

impl Quickhull<'_> {
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
