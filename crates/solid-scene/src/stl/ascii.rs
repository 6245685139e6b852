//! ASCII STL, in any case and however it is divided into lines: any number of solids, each of any number of facets.

use glam::DVec3;

use crate::fault::{Fault, Result};
use crate::text;

/// The words that begin something.
const KEYWORDS: [&str; 7] = ["solid", "facet", "outer", "vertex", "endloop", "endfacet", "endsolid"];

/// The corners of the triangles.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>> {
    let text = String::from_utf8_lossy(text::without_mark(bytes));
    let mut reader = Reader::default();
    let mut last = 0;
    for (line, content) in text::lines(&text) {
        reader.line(line, content)?;
        last = line;
    }
    match reader.place {
        Place::Outside => Ok(reader.triangles),
        place => Err(Fault::at(last, format!("expected {}, but the file ends", place.end()))),
    }
}

#[derive(Default)]
struct Reader {
    triangles: Vec<[DVec3; 3]>,
    place: Place,
    /// The corners of the facet so far.
    corners: Vec<DVec3>,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Place {
    #[default]
    Outside,
    Solid,
    Facet,
}

impl Place {
    /// The line that ends it.
    fn end(self) -> &'static str {
        match self {
            Place::Outside => "`solid`",
            Place::Solid => "`endsolid`",
            Place::Facet => "`endfacet`",
        }
    }
}

impl Reader {
    fn line(&mut self, line: usize, content: &str) -> Result<()> {
        let mut words = content.split_whitespace().peekable();
        let (mut is_first, mut is_name) = (true, false);
        while let Some(word) = words.next() {
            let keyword = word.to_ascii_lowercase();
            // The name of a solid may hold any word; where there are more lines it has one of its own.
            let begins = match is_name {
                true => {
                    keyword == "facet" && words.peek().is_some_and(|next| next.eq_ignore_ascii_case("normal"))
                }
                false => is_first || KEYWORDS.contains(&keyword.as_str()),
            };
            if begins {
                self.keyword(line, &keyword, &mut words)?;
                is_name = matches!(keyword.as_str(), "solid" | "endsolid");
            }
            is_first = false;
        }
        Ok(())
    }

    fn keyword<'a>(
        &mut self,
        line: usize,
        keyword: &str,
        words: &mut impl Iterator<Item = &'a str>,
    ) -> Result<()> {
        match (self.place, keyword) {
            (Place::Outside | Place::Solid, "solid") => self.place = Place::Solid,
            (Place::Outside | Place::Solid, "endsolid") => self.place = Place::Outside,
            (Place::Outside | Place::Solid, "facet") => self.place = Place::Facet,
            (Place::Facet, "outer" | "endloop") => {}
            (Place::Facet, "vertex") => self.corners.push(text::vertex(words, line)?),
            (Place::Facet, "endfacet") => self.end_facet(line)?,
            (place, keyword) => return Err(unexpected(place, keyword, line)),
        }
        Ok(())
    }

    fn end_facet(&mut self, line: usize) -> Result<()> {
        let Ok(triangle) = <[DVec3; 3]>::try_from(self.corners.as_slice()) else {
            let count = self.corners.len();
            return Err(Fault::at(line, format!("expected a facet of 3 vertices, but this one has {count}")));
        };
        self.triangles.push(triangle);
        self.corners.clear();
        self.place = Place::Solid;
        Ok(())
    }
}

fn unexpected(place: Place, keyword: &str, line: usize) -> Fault {
    let of_facet = matches!(keyword, "vertex" | "outer" | "endloop" | "endfacet");
    let expected = match place {
        Place::Facet => "`endfacet`",
        _ if of_facet => "`facet`",
        _ => "`facet` or `endsolid`",
    };
    Fault::at(line, format!("expected {expected}, but there is `{}`", text::quoted(keyword)))
}
