use solid3d::glam::DVec3;

use super::Feature;

/// What a test learned about a pair, for the next frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    /// The last separating axis, or direction of search; zero for none.
    pub axis: DVec3,
    /// The vertices of A and of B seen last, where hill climbing starts.
    pub vertices: [u32; 2],
    /// The features of A and of B that were closest, if any were looked for.
    pub features: Option<(Feature, Feature)>,
}

impl Default for Memory {
    fn default() -> Self {
        Memory { axis: DVec3::ZERO, vertices: [0, 0], features: None }
    }
}
