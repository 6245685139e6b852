//! The polytope.

use super::{Chord, End, Line};
use crate::kinds::Passage;
use crate::simd::dispatch;
use crate::{Polytope, Support};

impl Polytope {
    /// The part of a line that is in the hull. `None` where its faces do not tell: they are unknown, or more than 384, or the line passes so near to
    /// an edge, or through slivers, that rounding might decide. Cost: O(faces), some 30 ns where there are 36.
    ///
    /// ```
    /// use solid_convex::{Line, Polytope};
    /// use glam::DVec3;
    /// let corner = Polytope::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
    /// let line = Line::new(DVec3::new(0.25, 0.25, -1.0), DVec3::Z).unwrap();
    /// assert!(corner.chord(&line).is_none());
    /// let corner = corner.with_faces(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    /// let chord = corner.chord(&line).unwrap().unwrap();
    /// assert_eq!((chord.enter.t, chord.leave.t), (1.0, 1.5));
    /// assert_eq!(chord.enter.normal, DVec3::NEG_Z);
    /// ```
    pub fn chord(&self, line: &Line) -> Option<Option<Chord>> {
        let planes = self.planes()?;
        let (center, along) = (self.center(), line.along);
        let middle = center.dot(along) * line.inverse_square;
        let foot = line.foot + along * middle - center;
        let [enter, leave] = match dispatch!(simd => planes.passage(simd, foot, along)) {
            Passage::Beside => return Some(None),
            Passage::Through(crossings) => {
                crossings.map(|(t, inward)| End { t: middle + t, normal: -inward })
            }
            Passage::Unsure => return None,
        };
        Some(line.chord(Some(Chord { enter, leave }), 1.0))
    }
}
