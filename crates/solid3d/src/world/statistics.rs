//! What tests cost, in counts that repeat exactly.

use std::ops::AddAssign;

/// The work that the tests of a world, and its searches for what is [near](super::World::near), did since it was made. The same calls give
/// the same counts, whatever the machine and the number of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Pairs whose boxes overlap and whose response is not to ignore them.
    pub candidates: u64,
    /// Candidates that were examined. Of the others nothing had changed since they were: what was found then still holds.
    pub examined: u64,
    /// Candidates that were examined and of which what an earlier test found still showed whether they collide: the axis that separated them, or the
    /// vertices by which two hulls had a common point. Of two balls, boxes or capsules nothing is kept: they are seen anew as quickly.
    pub cache_hits: u64,
    /// Tests of one box against the eight of a tree's node.
    pub box_tests: u64,
    /// Tests of one primitive, or convex shape, against another.
    pub primitive_tests: u64,
    /// Candidates that are apart now, and whose way from the previous frame was searched for a collision.
    pub sweeps: u64,
    /// Collisions.
    pub collisions: u64,
}

impl Statistics {
    /// What `count` candidates will cost if they are like those examined so far, in units of about a box test.
    pub(super) fn units_for(&self, count: usize) -> u64 {
        /// What a candidate costs at least, of which what is cached still tells.
        const UNITS_PER_CANDIDATE: u64 = 4;
        /// What the search of two convex shapes for a common point costs.
        const UNITS_PER_PRIMITIVE_TEST: u64 = 6;
        let units = self.box_tests + UNITS_PER_PRIMITIVE_TEST * self.primitive_tests;
        count as u64 * (UNITS_PER_CANDIDATE + units / self.examined.max(1))
    }
}

impl AddAssign for Statistics {
    fn add_assign(&mut self, other: Statistics) {
        self.candidates += other.candidates;
        self.examined += other.examined;
        self.cache_hits += other.cache_hits;
        self.box_tests += other.box_tests;
        self.primitive_tests += other.primitive_tests;
        self.sweeps += other.sweeps;
        self.collisions += other.collisions;
    }
}
