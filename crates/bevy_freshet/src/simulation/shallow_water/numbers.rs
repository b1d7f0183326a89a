//! What the stages read, as `bindings.wgsl` has it.
use bevy::{prelude::*, render::render_resource::ShaderType};

/// Numbers of a frame.
#[derive(Clone, Debug, Default, PartialEq, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuShallow {
    /// Columns and rows.
    pub size: IVec2,
    /// Whether x and z wrap around.
    pub periodic: UVec2,
    /// Side of a cell, m.
    pub cell: f32,
    /// Courant number of a step.
    pub courant: f32,
    /// g n².
    pub drag: f32,
    /// Rain, m/s.
    pub rain: f32,
    /// Time that this frame adds, s.
    pub added: f32,
    /// Time that may be owed, s; what exceeds it is never simulated.
    pub most_owed: f32,
    /// Fastest signal that may enter at the edges, m/s.
    pub entering: f32,
    /// Longest step that the sources allow, s.
    pub longest: f32,
}

/// What is outside a cell of a side; see [`ShallowWater::edge_cells`](freshet_hydro::shallow_water::ShallowWater::edge_cells).
#[derive(Clone, Copy, Debug, Default, PartialEq, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuEdge {
    pub kind: u32,
    pub value: f32,
    pub entering: f32,
}

/// What a body does to the water of a cell; see [`Push`](freshet_hydro::shallow_water::Push).
#[derive(Clone, Copy, Debug, Default, PartialEq, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuPush {
    /// Index of the cell.
    pub cell: u32,
    pub strength: f32,
    pub velocity: Vec2,
    pub force: Vec2,
}

/// A cell whose bed bodies raise, or have left.
#[derive(Clone, Copy, Debug, Default, PartialEq, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuRaised {
    /// Index of the cell.
    pub cell: u32,
    /// What counts as its bed, m.
    pub bed: f32,
}

/// The clock; atomic numbers are plain ones here.
#[derive(Clone, Copy, Debug, Default, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(super) struct GpuClock {
    pub fastest: UVec2,
    pub owed: Vec2,
    pub rests: UVec2,
    pub dt: f32,
    pub steps: u32,
    pub time: Vec2,
    pub rained: Vec2,
}

/// What left through a cell of a side.
#[derive(Clone, Copy, Debug, Default, ShaderType)]
#[cfg_attr(test, derive(Reflect))]
pub(super) struct GpuLeaving {
    pub sum: Vec2,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::assert_same_layout;

    #[test]
    fn the_shaders_read_what_is_written() {
        // Pairs of numbers in arrays have no padding in storage buffers: they lie as vectors do.
        let wgsl = include_str!("bindings.wgsl")
            .replace("array<atomic<u32>, 2>", "vec2<u32>")
            .replace("array<u32, 2>", "vec2<u32>")
            .replace("array<f32, 2>", "vec2<f32>");
        assert_same_layout::<GpuShallow, _>(&wgsl, "Numbers");
        assert_same_layout::<GpuClock, _>(&wgsl, "Clock");
        assert_same_layout::<GpuEdge, _>(&wgsl, "Edge");
        assert_same_layout::<GpuPush, _>(&wgsl, "Push");
        assert_same_layout::<GpuRaised, _>(&wgsl, "Raised");
        assert_same_layout::<GpuLeaving, _>(&wgsl, "Leaving");
    }
}
