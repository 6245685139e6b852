//! A complex shape under construction: what lies between `dtNewComplexShape` and `dtEndComplexShape`.

use solid3d::glam::DVec3;

use crate::fault::{Code, Fault, Result};
use crate::reference::Reference;
use crate::soup::{Soup, coordinates, in_range};

/// The last place in a vertex array: an array of 3 GB. Beyond lie the indices that are really negative numbers.
pub(crate) const PLACE_MAX: u32 = (1 << 27) - 1;

/// A complex shape under construction.
#[derive(Debug)]
pub(crate) struct Builder {
    /// The reference that was promised.
    pub reference: Reference,
    /// The client's array, if it was named.
    pub base: Option<Reference>,
    vertices: Vec<Vertex>,
    /// Where each polytope ends in `vertices`.
    ends: Vec<usize>,
    /// Whether a polytope is begun.
    open: bool,
    /// The vertices given by value.
    fixed: Vec<DVec3>,
}

#[derive(Clone, Copy, Debug)]
enum Vertex {
    /// A place in the client's array.
    Place(u32),
    /// One of those given by value.
    Fixed(u32),
}

impl Builder {
    pub fn new(reference: Reference) -> Self {
        Builder {
            reference,
            base: None,
            vertices: Vec::new(),
            ends: Vec::new(),
            open: false,
            fixed: Vec::new(),
        }
    }

    pub fn begin(&mut self) -> Result<()> {
        if self.open {
            return Err(Fault::new(Code::Order, "a polytope is begun already; dtEnd must come first"));
        }
        self.open = true;
        Ok(())
    }

    pub fn end(&mut self) -> Result<()> {
        self.check_open()?;
        self.open = false;
        if self.vertices.len() == self.ends.last().copied().unwrap_or(0) {
            return Err(Fault::new(Code::Empty, "the polytope has no vertex; it is left out"));
        }
        reserve(&mut self.ends, 1)?;
        self.ends.push(self.vertices.len());
        Ok(())
    }

    pub fn vertex(&mut self, vertex: DVec3) -> Result<()> {
        self.check_open()?;
        in_range(vertex).map_err(|limit| {
            Fault::new(Code::Value, format!("the vertex is {}; {limit}", coordinates(vertex)))
        })?;
        reserve(&mut self.vertices, 1)?;
        reserve(&mut self.fixed, 1)?;
        let number = u32::try_from(self.fixed.len())
            .map_err(|_| Fault::new(Code::Limit, "there are as many vertices as 32-bit numbers can name"))?;
        self.fixed.push(vertex);
        self.vertices.push(Vertex::Fixed(number));
        Ok(())
    }

    pub fn vertex_index(&mut self, index: u32) -> Result<()> {
        self.check_open()?;
        check_place("index", index)?;
        reserve(&mut self.vertices, 1)?;
        self.vertices.push(Vertex::Place(index));
        Ok(())
    }

    /// A polytope of its own by places in the array.
    pub fn polytope(&mut self, places: impl ExactSizeIterator<Item = u32> + Clone) -> Result<()> {
        self.check_closed()?;
        for place in places.clone() {
            check_place("an index", place)?;
        }
        reserve(&mut self.vertices, places.len())?;
        reserve(&mut self.ends, 1)?;
        self.vertices.extend(places.map(Vertex::Place));
        self.ends.push(self.vertices.len());
        Ok(())
    }

    /// A polytope of `count` places from `first` on.
    pub fn range(&mut self, first: u32, count: u32) -> Result<()> {
        let end = first
            .checked_add(count)
            .filter(|&end| end <= PLACE_MAX + 1)
            .ok_or_else(|| out_of_range("the last index", u64::from(first) + u64::from(count) - 1))?;
        self.polytope((0..(end - first) as usize).map(|i| first + i as u32))
    }

    /// All polytopes over their vertices.
    pub fn finish(self) -> Result<Soup> {
        if self.open {
            return Err(Fault::new(Code::Order, "a polytope is not ended; the shape is given up"));
        }
        if self.ends.is_empty() {
            return Err(Fault::new(Code::Empty, "the shape has no polytope; it is given up"));
        }
        let mut places: Vec<u32> = Vec::new();
        reserve(&mut places, self.vertices.len())?;
        places.extend(self.vertices.iter().filter_map(|vertex| match vertex {
            Vertex::Place(place) => Some(*place),
            Vertex::Fixed(_) => None,
        }));
        places.sort_unstable();
        places.dedup();
        places.shrink_to_fit();
        if !places.is_empty() && self.base.is_none() {
            let message =
                "vertices are named by index, but dtVertexBase was not called; the shape is given up";
            return Err(Fault::new(Code::Order, message));
        }
        if places.len() + self.fixed.len() > u32::MAX as usize || self.vertices.len() > u32::MAX as usize {
            return Err(Fault::new(Code::Limit, "the shape has more vertices than 32-bit numbers can name"));
        }
        let mut indices = Vec::new();
        reserve(&mut indices, self.vertices.len())?;
        indices.extend(self.vertices.iter().map(|vertex| match vertex {
            Vertex::Place(place) => {
                places.binary_search(place).expect("every place was collected above") as u32
            }
            Vertex::Fixed(number) => places.len() as u32 + number,
        }));
        Ok(Soup::new(places, self.fixed, indices, self.ends))
    }

    fn check_open(&self) -> Result<()> {
        match self.open {
            true => Ok(()),
            false => Err(Fault::new(Code::Order, "no polytope is begun; dtBegin must come first")),
        }
    }

    fn check_closed(&self) -> Result<()> {
        match self.open {
            true => Err(Fault::new(Code::Order, "a polytope is begun; dtEnd must come first")),
            false => Ok(()),
        }
    }
}

fn check_place(argument: &str, place: u32) -> Result<()> {
    if place <= PLACE_MAX { Ok(()) } else { Err(out_of_range(argument, place.into())) }
}

fn out_of_range(argument: &str, place: u64) -> Fault {
    Fault::new(Code::Limit, format!("{argument} is {place}; it must be at most {PLACE_MAX}"))
}

/// Room for more elements, without an abort when there is none.
fn reserve<T>(vec: &mut Vec<T>, more: usize) -> Result<()> {
    vec.try_reserve(more).map_err(|_| Fault::new(Code::Limit, "out of memory"))
}
