//! Triangles, segments and points out of a primitive's indices.

use gltf::json::mesh::Mode;

use crate::soup::Soup;

/// Adds what the indices of a primitive stand for. What is left over of an incomplete triangle or line is passed over.
pub(super) fn add(mode: Mode, indices: &[u32], soup: &mut Soup) {
    match mode {
        Mode::Points => soup.points.extend(indices),
        Mode::Lines => soup.segments.extend(indices.chunks_exact(2).map(|pair| [pair[0], pair[1]])),
        Mode::LineStrip => soup.segments.extend(strip(indices)),
        Mode::LineLoop => {
            soup.segments.extend(strip(indices));
            if let [first, _, .., last] = indices {
                soup.segments.push([*last, *first]);
            }
        }
        Mode::Triangles => soup.triangles.extend(indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]])),
        Mode::TriangleStrip => soup.triangles.extend(indices.windows(3).enumerate().map(turned)),
        Mode::TriangleFan => {
            soup.triangles.extend(indices.windows(2).skip(1).map(|pair| [pair[0], pair[1], indices[0]]));
        }
    }
}

fn strip(indices: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    indices.windows(2).map(|pair| [pair[0], pair[1]])
}

/// Every second triangle of a strip is turned round, so that all face the same way.
fn turned((i, t): (usize, &[u32])) -> [u32; 3] {
    if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soup(mode: Mode, indices: &[u32]) -> Soup {
        let mut soup = Soup::default();
        add(mode, indices, &mut soup);
        soup
    }

    #[test]
    fn triangles() {
        assert_eq!(soup(Mode::Triangles, &[0, 1, 2, 3, 4, 5, 6]).triangles, [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(soup(Mode::TriangleStrip, &[0, 1, 2, 3]).triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(soup(Mode::TriangleFan, &[0, 1, 2, 3]).triangles, [[1, 2, 0], [2, 3, 0]]);
    }

    #[test]
    fn lines_and_points() {
        assert_eq!(soup(Mode::Lines, &[0, 1, 2, 3, 4]).segments, [[0, 1], [2, 3]]);
        assert_eq!(soup(Mode::LineStrip, &[0, 1, 2]).segments, [[0, 1], [1, 2]]);
        assert_eq!(soup(Mode::LineLoop, &[0, 1, 2]).segments, [[0, 1], [1, 2], [2, 0]]);
        assert_eq!(soup(Mode::LineLoop, &[0]).segments, [[0; 2]; 0]);
        assert_eq!(soup(Mode::Points, &[2, 0]).points, [2, 0]);
    }

    #[test]
    fn too_few_indices_give_nothing() {
        for mode in [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan, Mode::Lines, Mode::LineStrip] {
            assert!(soup(mode, &[]).is_empty() && soup(mode, &[1]).is_empty());
        }
    }
}
