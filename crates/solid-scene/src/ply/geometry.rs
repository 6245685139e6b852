//! Vertices, faces and triangle strips out of a PLY file.

use glam::DVec3;
use solid3d::convex::MAGNITUDE_MAX;

use super::header::{Element, Header, Property};
use super::payload::Payload;
use crate::fault::{Fault, Result};
use crate::polygon::{Cut, folded_warning, short_warning, triangulate};
use crate::soup::Soup;
use crate::text::{quoted, there_are};

/// The names that the list of a face's corners goes by; the first that is there is taken.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads the payload; faces of fewer than three corners are passed over with a warning.
pub(super) fn read(header: &Header, mut payload: Payload) -> Result<(Soup, Vec<String>)> {
    let mut faces = Lists::default();
    let mut strips = Lists::default();
    let mut soup = Soup::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => soup.vertices = vertices(element, &mut payload)?,
            "face" => faces.read(element, &mut payload)?,
            "tristrips" => strips.read(element, &mut payload)?,
            _ => skip(element, &mut payload)?,
        }
    }
    let (mut short, mut folded) = (0, 0);
    for (place, face) in faces.iter() {
        let corners = corners("face", place, face, soup.vertices.len())?;
        short += usize::from(corners.len() < 3);
        let cut = triangulate(&corners, &soup.vertices, &mut soup.triangles);
        folded += usize::from(cut == Cut::Folded);
    }
    for (place, list) in strips.iter() {
        for strip in list.split(|&index| index == -1.0) {
            strip_triangles(&corners("tristrips", place, strip, soup.vertices.len())?, &mut soup.triangles);
        }
    }
    if soup.is_empty() {
        header.elements.iter().try_for_each(check_has_corners)?;
    }
    let warnings = short_warning(short).into_iter().chain(folded_warning(folded)).collect();
    Ok((soup, warnings))
}

/// Refuses faces or strips whose corners go by another name.
fn check_has_corners(element: &Element) -> Result<()> {
    let is_of_corners = matches!(element.name.as_str(), "face" | "tristrips") && element.count > 0;
    if !is_of_corners || corner_list(element).is_some() {
        return Ok(());
    }
    let [indices, index] = CORNERS;
    Err(Fault::at(element.line, format!("`{}` has no list `{indices}` or `{index}`", element.name)))
}

/// Which property of an element is the list of its corners.
fn corner_list(element: &Element) -> Option<usize> {
    let is_list = |name: &str| element.properties.iter().position(|p| p.length.is_some() && p.name == name);
    CORNERS.into_iter().find_map(is_list)
}

/// Every second triangle of a strip is turned round, so that all face the same way.
fn strip_triangles(strip: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for (i, corners) in strip.windows(3).enumerate() {
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        triangles.push(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
    }
}

fn vertices(element: &Element, payload: &mut Payload) -> Result<Vec<DVec3>> {
    let mut axes = [0; 3];
    for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
        let place = element.properties.iter().position(|p| p.name == name && p.length.is_none());
        *axis = place
            .ok_or_else(|| Fault::at(element.line, format!("`vertex` has no scalar property `{name}`")))?;
    }
    let mut vertices = Vec::new();
    for number in 0..element.count {
        let mut vertex = DVec3::ZERO;
        for (place, property) in element.properties.iter().enumerate() {
            let value = read_property(element, number, property, payload, |_| {})?;
            axes.iter().enumerate().filter(|&(_, &axis)| axis == place).for_each(|(i, _)| vertex[i] = value);
        }
        if !vertex.is_finite() {
            return Err(payload.fault(format!("`vertex` {number} is {vertex}; expected finite numbers")));
        }
        if let Some(value) = vertex.to_array().into_iter().find(|value| value.abs() > MAGNITUDE_MAX) {
            let limit = format!("it must be at most {MAGNITUDE_MAX:e} in magnitude");
            return Err(payload.fault(format!("`vertex` {number} has the coordinate {value:e}; {limit}")));
        }
        vertices.push(vertex);
    }
    Ok(vertices)
}

fn skip(element: &Element, payload: &mut Payload) -> Result<()> {
    for number in 0..element.count {
        for property in &element.properties {
            read_property(element, number, property, payload, |_| {})?;
        }
    }
    Ok(())
}

/// Reads a property: gives its value, or its length if it is a list, whose values go to `each`.
fn read_property(
    element: &Element,
    number: u64,
    property: &Property,
    payload: &mut Payload,
    mut each: impl FnMut(f64),
) -> Result<f64> {
    // Words for errors alone: they take memory, and this is asked for each number of the file.
    let which = || format!("`{}` {number}", quoted(&element.name));
    let name = || format!("`{}`", quoted(&property.name));
    let ends = |expected: String| format!("the file ends in {}: expected {expected}", which());
    let first = payload.next(property.length.unwrap_or(property.scalar))?;
    let Some(first) = first else { return Err(payload.fault(ends(name()))) };
    if property.length.is_none() {
        return Ok(first);
    }
    if !(first >= 0.0 && first.fract() == 0.0) {
        return Err(payload.fault(format!("{} has a list {} of length {first}", which(), name())));
    }
    let numbers = if first == 1.0 { "number" } else { "numbers" };
    let cut = || ends(format!("{first} {numbers} of {}", name()));
    if first > payload.left(property.scalar) as f64 {
        return Err(payload.fault(cut()));
    }
    for _ in 0..first as u64 {
        match payload.next(property.scalar)? {
            Some(value) => each(value),
            None => return Err(payload.fault(cut())),
        }
    }
    Ok(first)
}

/// Where an element stands: its number among those of its kind, and its line in a text.
#[derive(Clone, Copy)]
struct Place {
    number: usize,
    line: Option<usize>,
}

/// The lists of corners of all elements of a kind, one after the other.
#[derive(Default)]
struct Lists {
    values: Vec<f64>,
    /// Where each element's list ends, and its line in a text.
    ends: Vec<(usize, Option<usize>)>,
}

impl Lists {
    fn read(&mut self, element: &Element, payload: &mut Payload) -> Result<()> {
        let corners = corner_list(element);
        for number in 0..element.count {
            for (place, property) in element.properties.iter().enumerate() {
                let keep = corners == Some(place);
                let each = |value| {
                    if keep {
                        self.values.push(value)
                    }
                };
                read_property(element, number, property, payload, each)?;
            }
            self.ends.push((self.values.len(), payload.line()));
        }
        Ok(())
    }

    /// Where each element stands, and its list.
    fn iter(&self) -> impl Iterator<Item = (Place, &[f64])> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|&(end, _)| end));
        let lists = starts.zip(&self.ends).enumerate();
        lists.map(|(number, (start, &(end, line)))| (Place { number, line }, &self.values[start..end]))
    }
}

/// The vertices that a list names.
fn corners(element: &str, place: Place, list: &[f64], vertices: usize) -> Result<Vec<u32>> {
    let corner = |&index: &f64| {
        let named = index.fract() == 0.0 && (0.0..vertices as f64).contains(&index);
        let wrong =
            || format!("`{element}` {} names vertex {index}, but {}", place.number, there_are(vertices));
        if named { Ok(index as u32) } else { Err(Fault::new(place.line, wrong())) }
    };
    list.iter().map(corner).collect()
}
