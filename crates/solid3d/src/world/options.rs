//! Options of a world.

use super::Response;
use crate::broad::BroadPhaseKind;

/// Options of a world.
///
/// ```
/// use solid3d::{BroadPhaseKind, World, WorldOptions};
/// let options = WorldOptions { broad_phase: BroadPhaseKind::SweepAndPrune, ..Default::default() };
/// assert!(World::with_options(&options).is_empty());
/// ```
#[derive(Clone, Debug)]
pub struct WorldOptions {
    /// The response for pairs without one of their own: [`Response::Witness`] by default.
    pub default_response: Response,
    /// The engine that finds the pairs whose boxes overlap; any gives the same answers.
    pub broad_phase: BroadPhaseKind,
    /// Whether tests use what earlier tests found out: `true` by default; the answers are the same.
    pub caching: bool,
}

impl Default for WorldOptions {
    fn default() -> Self {
        WorldOptions {
            default_response: Response::Witness,
            broad_phase: BroadPhaseKind::default(),
            caching: true,
        }
    }
}
