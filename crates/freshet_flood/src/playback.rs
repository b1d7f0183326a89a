//! Floods as water that is played back: level, depth and velocity of any cell at any time between two steps.
//!
//! What is kept of a step takes eight bytes a cell and is laid out as a shader reads it, so that the same numbers are drawn and asked.
//! A [`Moment`] has no cells of its own: it is two steps and a time, and works out the cells that are looked up.

mod ground;
mod interval;
mod moment;
mod step;

pub use ground::{BANK, Ground};
pub use interval::PlayedInterval;
pub use moment::Moment;
pub use step::{PlayedCell, PlayedStep};
