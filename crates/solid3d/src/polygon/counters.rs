//! How much work the algorithms did.

/// Counts that depend on the input alone: they repeat exactly, on any machine (thesis, section 3.2.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Edges tested against a plane.
    pub edge_plane_tests: u64,
    /// Points of a plane tested for containment in a polygon.
    pub point_in_polygon_tests: u64,
    /// Comparisons of two points on the line in which two planes meet.
    pub comparisons: u64,
}
