//! Steps and beginnings that are asked for, and how the water stands.
use super::{
    driver::{Simulated, Simulation},
    on_gpu::OnGpu,
};
use crate::body::{ResetSimulation, SimulationBackend, SimulationState, StepSimulation};
use bevy::prelude::*;

/// What a water has been asked for.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asked {
    reset: bool,
    steps: u32,
}

pub(super) fn ask_for_step(step: On<StepSimulation>, mut waters: Query<&mut Simulated>) {
    if let Ok(mut water) = waters.get_mut(step.0) {
        water.asked.steps = water.asked.steps.saturating_add(1);
    }
}

pub(super) fn ask_for_reset(reset: On<ResetSimulation>, mut waters: Query<&mut Simulated>) {
    if let Ok(mut water) = waters.get_mut(reset.0) {
        water.asked = Asked { reset: true, steps: 0 };
    }
}

impl Asked {
    /// Whether to begin anew; once.
    pub fn takes_reset(&mut self) -> bool {
        std::mem::take(&mut self.reset)
    }

    /// Whether to take one of the steps that were asked for.
    pub fn takes_step(&mut self) -> bool {
        let takes = self.steps > 0;
        self.steps = self.steps.saturating_sub(1);
        takes
    }

    /// A water that runs takes no single steps.
    pub fn forget_steps(&mut self) {
        self.steps = 0;
    }
}

impl Simulation {
    /// How it stands.
    pub fn state(&self) -> SimulationState {
        let on_gpu = self.on_gpu.as_ref();
        SimulationState {
            backend: if on_gpu.is_some() { SimulationBackend::Gpu } else { SimulationBackend::Cpu },
            cells: self.water.size(),
            cell_size: self.water.cell_size(),
            time: self.water.time(),
            late: self.pace.late,
            steps: self.pace.steps,
            step: self.pace.step,
            age: on_gpu.map_or(0.0, OnGpu::age) as f32,
            volume: self.volume,
            balance: self.water.balance(),
        }
    }
}

/// How fast a simulation goes on: the last three numbers of [`SimulationState`] that the water itself does not know.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    /// Steps of the newest frame.
    pub steps: u32,
    /// Length of a step, s.
    pub step: f64,
    /// Time by which it has fallen behind, s.
    pub late: f64,
}
