//! Binary STL: 80 bytes of header, the count of triangles, and 50 bytes for each of them, little-endian.

use glam::DVec3;

use crate::fault::Result;
use crate::text::counted;

const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;
/// Where the corners begin, after the normal.
const CORNERS: usize = 12;
const CORNER: usize = 12;

/// How long a file is whose header tells so many triangles.
fn length(count: u32) -> u64 {
    (HEADER + COUNT) as u64 + u64::from(count) * TRIANGLE as u64
}

fn count(bytes: &[u8]) -> Option<u32> {
    bytes.get(HEADER..)?.first_chunk().map(|count| u32::from_le_bytes(*count))
}

/// Whether the file is exactly as long as its header tells.
pub(super) fn has_exact_length(bytes: &[u8]) -> bool {
    count(bytes).is_some_and(|count| length(count) == bytes.len() as u64)
}

/// What to tell of bytes after the last triangle that the header tells, where they are enough for another.
pub(super) fn left_over(bytes: &[u8]) -> Option<String> {
    let over = (bytes.len() as u64).checked_sub(length(count(bytes)?))?;
    let triangles = counted(count(bytes)? as usize, "triangle");
    (over >= TRIANGLE as u64)
        .then(|| format!("the header tells {triangles}; the {over} bytes after that are passed over"))
}

/// The corners of the triangles.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>> {
    let Some(count) = count(bytes) else {
        return Err("neither text that begins with \"solid\" nor the 84 bytes of a binary header".into());
    };
    let (needed, present) = (length(count), bytes.len());
    if needed > present as u64 {
        let triangles = counted(count as usize, "triangle");
        let message =
            format!("the header tells {triangles}, a file of {needed} bytes; the file has {present}");
        return Err(message.into());
    }
    let triangles = bytes[HEADER + COUNT..].chunks_exact(TRIANGLE).take(count as usize);
    triangles.enumerate().map(|(number, triangle)| corners(number, triangle)).collect()
}

fn corners(number: usize, triangle: &[u8]) -> Result<[DVec3; 3]> {
    let mut corners = [DVec3::ZERO; 3];
    for (i, bytes) in triangle[CORNERS..].chunks_exact(CORNER).take(3).enumerate() {
        corners[i] = vertex(bytes);
        if !corners[i].is_finite() {
            let message =
                format!("vertex {i} of triangle {number} is {}; expected finite numbers", corners[i]);
            return Err(message.into());
        }
    }
    Ok(corners)
}

fn vertex(bytes: &[u8]) -> DVec3 {
    let mut numbers =
        bytes.chunks_exact(4).filter_map(|b| b.first_chunk()).map(|b| f32::from_le_bytes(*b).into());
    DVec3::from_array(std::array::from_fn(|_| numbers.next().unwrap_or(f64::NAN)))
}
