//! Placeholder that the first change to this crate replaces.
fn main() {}
