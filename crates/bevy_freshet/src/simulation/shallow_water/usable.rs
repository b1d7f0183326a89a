//! Whether a GPU can simulate a water.
use crate::{body::SimulationBackend, report::Reported};
use bevy::{
    prelude::*,
    render::{
        renderer::{RenderAdapterInfo, RenderDevice},
        settings::WgpuLimits,
    },
};

/// Bytes of a cell in the largest buffer that is bound: that of its state.
const BOUND: u64 = 16;
/// Bytes of a cell in the copy that comes back, at most: its state, what sources gave, and what left through four edges.
const COPIED: u64 = 16 + 8 + 4 * 8;

/// A GPU that can simulate.
pub(super) struct UsableGpu {
    /// What is missing, if something is.
    missing: Option<String>,
    is_hardware: bool,
    /// Limits of the sizes of buffers: their names, how much they are, and how much a cell takes of them.
    sizes: [(&'static str, u64, u64); 2],
}

impl UsableGpu {
    pub fn new(adapter: Option<&RenderAdapterInfo>, device: Option<&RenderDevice>) -> Self {
        // The type of the device has no name in the engine.
        let is_software = adapter.is_some_and(|adapter| format!("{:?}", adapter.device_type) == "Cpu");
        Self::with(device.map(|device| device.limits()), !is_software)
    }

    /// A GPU with these limits; without any there is none.
    fn with(limits: Option<WgpuLimits>, is_hardware: bool) -> Self {
        let Some(limits) = limits else {
            return Self { missing: Some("there is no GPU".into()), is_hardware: false, sizes: default() };
        };
        let buffers = limits.max_storage_buffers_per_shader_stage;
        let missing =
            (buffers < 8).then(|| format!("max_storage_buffers_per_shader_stage is {buffers}, and 8 are needed"));
        let sizes = [
            ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size, BOUND),
            ("max_buffer_size", limits.max_buffer_size, COPIED),
        ];
        Self { missing, is_hardware, sizes }
    }

    /// Whether a water of so many cells is simulated on the GPU.
    pub fn is_chosen(&self, entity: Entity, backend: SimulationBackend, cells: u64, reported: &mut Reported) -> bool {
        match (backend, self.missing_for(cells)) {
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

    /// What it lacks to simulate so many cells.
    fn missing_for(&self, cells: u64) -> Option<String> {
        let lacks_room = |(name, size, per_cell): &(&str, u64, u64)| {
            let most = size / per_cell;
            (cells > most).then(|| format!("{name} has room for {most} cells, and {cells} are needed"))
        };
        self.missing.clone().or_else(|| self.sizes.iter().find_map(lacks_room))
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::said::complaints, *};

    /// Whether a GPU is chosen for a water of 1000 cells, asked three times, and what is said.
    fn asked(gpu: UsableGpu, backend: SimulationBackend) -> (bool, Vec<String>) {
        let mut chosen = Vec::new();
        let said = complaints(&mut App::new(), |_| {
            let mut reported = Reported::default();
            chosen.extend(
                (0..3).map(|_| gpu.is_chosen(Entity::from_raw_u32(7).expect("an index"), backend, 1000, &mut reported)),
            );
        });
        assert!(chosen.windows(2).all(|pair| pair[0] == pair[1]));
        (chosen[0], said)
    }

    #[test]
    fn hardware_is_chosen_where_the_choice_is_free() {
        use SimulationBackend::{Auto, Cpu, Gpu};
        for (is_hardware, backend, chosen) in
            [(true, Auto, true), (false, Auto, false), (true, Gpu, true), (false, Gpu, true), (true, Cpu, false)]
        {
            let gpu = UsableGpu::with(Some(WgpuLimits::default()), is_hardware);
            assert_eq!(asked(gpu, backend), (chosen, Vec::new()), "{is_hardware} {backend:?}");
        }
    }

    #[test]
    fn a_gpu_that_lacks_something_is_not_used_and_the_limit_is_named_once() {
        let usual = WgpuLimits::default;
        let lacking = [
            (None, "there is no GPU"),
            (
                Some(WgpuLimits { max_storage_buffers_per_shader_stage: 7, ..usual() }),
                "max_storage_buffers_per_shader_stage is 7",
            ),
            (
                Some(WgpuLimits { max_storage_buffer_binding_size: 15_999, ..usual() }),
                "max_storage_buffer_binding_size has room for 999 cells",
            ),
            (Some(WgpuLimits { max_buffer_size: 55_999, ..usual() }), "max_buffer_size has room for 999 cells"),
        ];
        for (limits, reason) in lacking {
            let (chosen, said) = asked(UsableGpu::with(limits.clone(), true), SimulationBackend::Gpu);
            let [line] = said.as_slice() else { panic!("one complaint was expected: {said:#?}") };
            let words =
                [&*format!(" {}: WaterSimulation::backend ", Entity::from_raw_u32(7).expect("an index")), reason];
            assert!(!chosen && words.iter().all(|word| line.contains(word)), "{line}");
            let unasked = asked(UsableGpu::with(limits, true), SimulationBackend::Auto);
            assert_eq!(unasked, (false, Vec::new()), "nobody asked for it: {reason}");
        }
        let enough = WgpuLimits { max_storage_buffer_binding_size: 16_000, max_buffer_size: 56_000, ..usual() };
        assert!(asked(UsableGpu::with(Some(enough), true), SimulationBackend::Gpu).0);
    }
}
