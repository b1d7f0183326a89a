//! A simulated water while it runs: single steps, beginning anew, and how it stands.
use super::SimulationBackend;
use bevy::prelude::*;
pub use freshet_hydro::shallow_water::Balance;

/// Lets a simulated water that is [paused](super::WaterSimulation::paused) take one step: `commands.trigger(StepSimulation(water))`.
///
/// The step is as long as the Courant number allows, and is taken in the next frame or fixed step; steps that are asked for at
/// once are taken one after the other. A water that runs takes none.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepSimulation(pub Entity);

/// Begins a simulated water anew: `commands.trigger(ResetSimulation(water))`.
///
/// Water, time, and the book of volumes are those of its [start](super::WaterSimulation::start) from the next frame or fixed step
/// on; a water that is paused stays paused. Rings, foam and dye stay where they are.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResetSimulation(pub Entity);

/// How a simulated water stands. Read only; beside every [`WaterSimulation`](super::WaterSimulation).
///
/// It is that of the newest state that the CPU knows. Of a water on the GPU that is a few frames old.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Clone, Debug, PartialEq)]
pub struct SimulationState {
    /// Where it is simulated; `Auto` until it has begun.
    pub backend: SimulationBackend,
    /// Cells along local x and z.
    pub cells: UVec2,
    /// Side of a cell, m.
    pub cell_size: f32,
    /// Time that has been simulated since the start, s.
    pub time: f64,
    /// Steps of the newest frame (on the CPU: fixed step).
    pub steps: u32,
    /// Length of a step, s: on the CPU of the newest, on the GPU as the Courant number allows.
    pub step: f64,
    /// Simulated time by which it has fallen behind its clock since the start, s.
    pub late: f64,
    /// Age of the state that bodies and queries know, s of simulated time, 0…0.25.
    pub age: f32,
    /// Volume of all water, m³.
    pub volume: f64,
    /// What there was at the start, and what has come and gone since, m³.
    #[reflect(ignore)]
    pub balance: Balance,
}

impl SimulationState {
    /// Volume that is there and should not be, m³: what rounding has made, or lost if it is negative.
    pub fn error(&self) -> f64 {
        self.volume - self.balance.expected()
    }
}
