//! The command `solid`.
fn main() {}
