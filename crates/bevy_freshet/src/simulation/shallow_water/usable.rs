//! Whether a GPU can simulate a water.
use crate::{body::SimulationBackend, report::Reported};
use bevy::{
    prelude::*,
    render::renderer::{RenderAdapterInfo, RenderDevice},
};

/// A GPU that can simulate.
pub(super) struct UsableGpu {
    /// What is missing, if something is.
    missing: Option<String>,
    is_hardware: bool,
    largest_binding: u64,
}

impl UsableGpu {
    pub fn new(adapter: Option<&RenderAdapterInfo>, device: Option<&RenderDevice>) -> Self {
        let Some(device) = device else {
            return Self { missing: Some("there is no GPU".into()), is_hardware: false, largest_binding: 0 };
        };
        let limits = device.limits();
        let buffers = limits.max_storage_buffers_per_shader_stage;
        let missing =
            (buffers < 8).then(|| format!("max_storage_buffers_per_shader_stage is {buffers}, and 8 are needed"));
        // The type of the device has no name in the engine.
        let is_software = adapter.is_some_and(|adapter| format!("{:?}", adapter.device_type) == "Cpu");
        let largest_binding = limits.max_storage_buffer_binding_size;
        Self { missing, is_hardware: !is_software, largest_binding }
    }

    /// Whether a water of so many cells is simulated on the GPU.
    pub fn is_chosen(&self, entity: Entity, backend: SimulationBackend, cells: u64, reported: &mut Reported) -> bool {
        let room = (cells * 16 > self.largest_binding).then(|| {
            let most = self.largest_binding / 16;
            format!("max_storage_buffer_binding_size has room for {most} cells, and {cells} are needed")
        });
        let missing = self.missing.clone().or(room);
        match (backend, missing) {
            (SimulationBackend::Cpu, _) | (SimulationBackend::Auto, Some(_)) => false,
            (SimulationBackend::Auto, None) => self.is_hardware,
            (SimulationBackend::Gpu, None) => true,
            (SimulationBackend::Gpu, Some(missing)) => {
                let problem = format_args!("asks for a GPU, but {missing}; the CPU is used");
                reported.warn(entity, "WaterSimulation::backend", problem);
                false
            }
        }
    }
}
