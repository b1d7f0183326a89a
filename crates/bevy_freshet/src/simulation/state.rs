//! The state of a water's fields on the GPU.
use super::{
    FieldWindow,
    frame::FieldWork,
    numbers::GpuNumbers,
    tiles::{GpuSilhouette, GpuStroke, GpuTile},
};
use crate::surface::GpuSurface;
use bevy::{
    prelude::*,
    render::{
        render_resource::{Buffer, BufferDescriptor, BufferUsages, StorageBuffer, UniformBuffer},
        renderer::{RenderDevice, RenderQueue},
    },
};

/// Buffers of one water, one number or vector for every cell of its window, and what they hold.
#[derive(Component)]
pub(super) struct FieldState {
    pub window: FieldWindow,
    /// Whether cells hold anything yet.
    pub filled: bool,
    /// Which ground is in [`FieldState::ground`].
    pub version: u64,
    /// Whether the last frame had silhouettes, which are still in [`FieldState::bodies`].
    pub covered: bool,

    pub ground: Buffer,
    pub celerity: Buffer,
    pub bodies: Buffer,
    pub stream: Buffer,
    /// The first is read, the second written; then they swap.
    pub waves: [Buffer; 2],
    pub matter: [Buffer; 2],

    pub numbers: UniformBuffer<GpuNumbers>,
    pub surface: StorageBuffer<GpuSurface>,
    pub silhouettes: StorageBuffer<Vec<GpuSilhouette>>,
    pub tiles: StorageBuffer<Vec<GpuTile>>,
    pub strokes: StorageBuffer<Vec<GpuStroke>>,
}

impl FieldState {
    /// Empty buffers for the window of `work`.
    pub fn new(device: &RenderDevice, work: &FieldWork) -> Self {
        let cells = u64::from(work.window.size.x) * u64::from(work.window.size.y);
        let buffer = |label, floats: u64| {
            device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size: cells * floats * 4,
                usage: BufferUsages::STORAGE | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let mut state = Self {
            window: work.window,
            filled: false,
            version: 0,
            covered: false,
            ground: buffer("water_ground", 4),
            celerity: buffer("water_celerity", 1),
            bodies: buffer("water_bodies", 4),
            stream: buffer("water_stream", 4),
            waves: [buffer("water_waves_a", 2), buffer("water_waves_b", 2)],
            matter: [buffer("water_matter_a", 4), buffer("water_matter_b", 4)],
            numbers: default(),
            surface: default(),
            silhouettes: default(),
            tiles: default(),
            strokes: default(),
        };
        state.numbers.set_label(Some("water_numbers"));
        state.surface.set_label(Some("water_below"));
        state.silhouettes.set_label(Some("water_silhouettes"));
        state.tiles.set_label(Some("water_tiles"));
        state.strokes.set_label(Some("water_strokes"));
        state
    }

    /// Whether the buffers have room for the window of `work`, and what they hold is worth keeping.
    pub fn fits(&self, work: &FieldWork) -> bool {
        self.window.size == work.window.size && self.window.cell == work.window.cell
    }

    /// How far the window has moved, cells; by all of it if nothing is known yet.
    pub fn shift(&self, work: &FieldWork) -> IVec2 {
        if self.filled { work.window.first - self.window.first } else { work.window.size.as_ivec2() }
    }

    /// Hands the numbers and lists of a frame to the GPU.
    pub fn upload(&mut self, work: &FieldWork, device: &RenderDevice, queue: &RenderQueue) {
        self.numbers.set(GpuNumbers { shift: self.shift(work), ..work.numbers.clone() });
        self.surface.set(work.surface.clone());
        // A binding needs at least one element.
        self.silhouettes.set(or_one(&work.deposits.silhouettes));
        self.tiles.set(or_one(&work.deposits.tiles));
        self.strokes.set(or_one(&work.deposits.strokes));
        self.numbers.write_buffer(device, queue);
        self.surface.write_buffer(device, queue);
        self.silhouettes.write_buffer(device, queue);
        self.tiles.write_buffer(device, queue);
        self.strokes.write_buffer(device, queue);
    }
}

fn or_one<T: Clone + Default>(list: &[T]) -> Vec<T> {
    if list.is_empty() { vec![T::default()] } else { list.to_vec() }
}

/// Buffers of a lost device are of no use.
pub(super) fn forget_states(mut commands: Commands, states: Query<Entity, With<FieldState>>) {
    for entity in &states {
        commands.entity(entity).remove::<FieldState>();
    }
}
