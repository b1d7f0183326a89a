//! The few commands a newcomer types.
fn main() {}
