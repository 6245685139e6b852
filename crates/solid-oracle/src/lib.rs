//! Slow and right answers.
