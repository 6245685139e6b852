//! Whole files, small ones.
