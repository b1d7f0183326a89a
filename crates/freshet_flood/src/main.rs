//! The command `freshet-flood`.
fn main() {}
