//! Making primitives of an OBJ file's elements.

use super::reader::{ElementKind, Statements};
use crate::fault::Result;
use crate::polygon::{Cut, triangulate};
use crate::soup::Soup;

/// No vertex of a group's own yet.
const UNUSED: u32 = u32::MAX;

/// The primitives of a file by name.
#[derive(Debug, Default)]
pub(super) struct Soups {
    pub named: Vec<(String, Soup)>,
    /// How many polygons are folded over.
    pub folded: usize,
}

impl Statements {
    /// The file as one soup over all its vertices, used or not.
    pub fn whole(self, name: &str) -> Result<Soups> {
        let (mut soups, folded) = self.soups(1, |_| 0);
        let mut soup = soups.pop().unwrap_or_default();
        soup.vertices = self.vertices;
        not_empty(Soups { named: vec![(name.to_owned(), soup)], folded })
    }

    /// A soup for each group that has primitives, over the vertices that it uses.
    pub fn split(self) -> Result<Soups> {
        let (mut soups, folded) = self.soups(self.groups.len(), |group| group);
        let mut own = vec![UNUSED; self.vertices.len()];
        for soup in &mut soups {
            compact(soup, &self.vertices, &mut own);
        }
        not_empty(Soups { named: self.groups.into_iter().zip(soups).collect(), folded })
    }

    /// The elements as primitives over the file's vertices, in `count` soups without vertices of their own, and how many
    /// polygons are folded over.
    fn soups(&self, count: usize, soup_of_group: impl Fn(usize) -> usize) -> (Vec<Soup>, usize) {
        let mut soups = vec![Soup::default(); count];
        let mut folded = 0;
        let mut rest = self.corners.as_slice();
        for element in &self.elements {
            let (corners, others) = rest.split_at(element.corners);
            rest = others;
            let soup = &mut soups[soup_of_group(element.group)];
            match element.kind {
                ElementKind::Face => {
                    let cut = triangulate(corners, &self.vertices, &mut soup.triangles);
                    folded += usize::from(cut == Cut::Folded);
                }
                ElementKind::Line => soup.segments.extend(corners.windows(2).map(|pair| [pair[0], pair[1]])),
                ElementKind::Points => soup.points.extend(corners),
            }
        }
        (soups, folded)
    }
}

/// Gives a soup the vertices that it uses, in order of first use; `own` is all [`UNUSED`], and is left so.
fn compact(soup: &mut Soup, vertices: &[glam::DVec3], own: &mut [u32]) {
    let mut used: Vec<u32> = Vec::new();
    let triangles = soup.triangles.iter_mut().flatten();
    let segments = soup.segments.iter_mut().flatten();
    for index in triangles.chain(segments).chain(&mut soup.points) {
        let vertex = *index as usize;
        if own[vertex] == UNUSED {
            own[vertex] = used.len() as u32;
            used.push(*index);
        }
        *index = own[vertex];
    }
    soup.vertices = used.iter().map(|&vertex| vertices[vertex as usize]).collect();
    used.iter().for_each(|&vertex| own[vertex as usize] = UNUSED);
}

fn not_empty(mut soups: Soups) -> Result<Soups> {
    soups.named.retain(|(_, soup)| !soup.is_empty());
    if soups.named.is_empty() {
        return Err("the file has no geometry: no face, line or point".into());
    }
    Ok(soups)
}
