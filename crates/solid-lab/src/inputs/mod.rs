//! Shapes, pairs and motions to measure on: the same for the same seed.
