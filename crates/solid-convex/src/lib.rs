//! Convex shapes as support mappings, and the GJK family of algorithms on them.
