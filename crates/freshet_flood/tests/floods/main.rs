//! Floods: their arrival, the way between their steps, and their conversion, in the library and as a command.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

mod arrival;
mod conversion;
mod convert_command;
mod fronts_between_steps;
mod known;
mod leave_one_out;
mod playback;
