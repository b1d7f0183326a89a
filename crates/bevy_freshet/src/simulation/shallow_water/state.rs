//! The state of a shallow water on the GPU.
use super::{
    GpuWork, ShallowFrame, ShallowWork,
    frame::{Ground, StartState},
    numbers::{GpuClock, GpuEdge, GpuLeaving, GpuPush, GpuRaised, GpuShallow},
    returned::Copies,
};
use bevy::{
    prelude::*,
    render::{
        render_resource::{
            Buffer, BufferInitDescriptor, BufferUsages, ShaderType, StorageBuffer, UniformBuffer, encase,
        },
        renderer::{RenderDevice, RenderQueue},
    },
};
use std::sync::atomic::Ordering;

/// Buffers of one water.
#[derive(Component)]
pub(super) struct ShallowState {
    /// Which state and ground they hold.
    pub start: u64,
    pub ground: u64,
    pub numbers: UniformBuffer<GpuShallow>,
    pub edges: StorageBuffer<Vec<GpuEdge>>,
    pub pushes: StorageBuffer<Vec<GpuPush>>,
    /// Cells of the bed that change in this frame.
    pub raising: StorageBuffer<Vec<GpuRaised>>,
    /// Cells that bodies are in, as the bed has them.
    raised: Vec<(u32, [f32; 2])>,
    /// Which of two values a step reads: 0 in the first and 1 in the second.
    pub parities: [UniformBuffer<UVec4>; 2],
    pub clock: Buffer,
    /// The first is read and the second written by even steps, the other way round by odd ones.
    pub states: [Buffer; 2],
    pub bed: Buffer,
    pub leaving: Buffer,
    pub extras: Buffer,
    pub given: Buffer,
    pub copies: Copies,
}

const STORAGE: BufferUsages = BufferUsages::STORAGE.union(BufferUsages::COPY_SRC);

impl ShallowState {
    /// Buffers with this state over this ground.
    pub fn new(device: &RenderDevice, work: &GpuWork, start: &StartState, ground: &Ground) -> Self {
        let buffer = |label, contents: &[u8]| {
            device.create_buffer_with_data(&BufferInitDescriptor { label: Some(label), contents, usage: STORAGE })
        };
        let clock = GpuClock { fastest: UVec2::splat(start.fastest.to_bits()), ..default() };
        let cells = bytes_of_list(&start.cells);
        let parity = |parity| {
            let mut uniform = UniformBuffer::from(UVec4::new(parity, 0, 0, 0));
            uniform.set_label(Some("water_shallow_parity"));
            uniform
        };
        let mut state = Self {
            start: start.version,
            ground: 0,
            numbers: default(),
            edges: default(),
            pushes: default(),
            raising: default(),
            raised: Vec::new(),
            parities: [parity(0), parity(1)],
            clock: buffer("water_shallow_clock", &bytes_of(&clock)),
            states: [buffer("water_shallow_a", &cells), buffer("water_shallow_b", &cells)],
            bed: buffer("water_shallow_bed", &[0; 4]),
            leaving: buffer("water_shallow_leaving", &bytes_of_list(&vec![GpuLeaving::default(); work.edges.len()])),
            extras: buffer("water_shallow_extras", &[0; 16]),
            given: buffer("water_shallow_given", &[0; 8]),
            copies: Copies::default(),
        };
        state.numbers.set_label(Some("water_shallow_numbers"));
        state.edges.set_label(Some("water_shallow_edges"));
        state.pushes.set_label(Some("water_shallow_pushes"));
        state.raising.set_label(Some("water_shallow_raised"));
        state.set_ground(device, ground, work.has_sources);
        state
    }

    /// Replaces bed, walls and sources.
    pub fn set_ground(&mut self, device: &RenderDevice, ground: &Ground, has_sources: bool) {
        let buffer = |label, contents: &[u8]| {
            device.create_buffer_with_data(&BufferInitDescriptor { label: Some(label), contents, usage: STORAGE })
        };
        self.bed = buffer("water_shallow_bed", &bytes_of_list(&ground.bed));
        self.raised.clear();
        let none = [Vec4::ZERO];
        self.extras = buffer(
            "water_shallow_extras",
            &bytes_of_list(if ground.extras.is_empty() { &none[..] } else { &ground.extras }),
        );
        let given = 8 * ground.bed.len() as u64;
        if has_sources && self.given.size() < given {
            // The first sources there are. Copies have room for what they give from now on.
            self.given = buffer("water_shallow_given", &vec![0; given as usize]);
            self.copies = Copies::default();
        }
        self.ground = ground.version;
    }

    /// Hands the numbers of a frame to the GPU, and says what it holds.
    pub fn upload(&mut self, work: &GpuWork, device: &RenderDevice, queue: &RenderQueue) {
        self.numbers.set(work.numbers.clone());
        self.numbers.write_buffer(device, queue);
        self.edges.set(work.edges.clone());
        self.edges.write_buffer(device, queue);
        if !work.pushes.is_empty() {
            self.pushes.set(work.pushes.clone());
            self.pushes.write_buffer(device, queue);
        }
        self.raising.set(changes(&self.raised, &work.raised));
        if !self.raising.get().is_empty() {
            self.raising.write_buffer(device, queue);
        }
        self.raised.clone_from(&work.raised);
        self.parities.iter_mut().for_each(|parity| parity.write_buffer(device, queue));
        work.held.start.store(self.start, Ordering::Relaxed);
        work.held.ground.store(self.ground, Ordering::Relaxed);
    }
}

/// What a bed with bodies in these cells has to change for them to be in those; both lists ascend.
fn changes(old: &[(u32, [f32; 2])], new: &[(u32, [f32; 2])]) -> Vec<GpuRaised> {
    let is_in = |list: &[(u32, [f32; 2])], cell: u32| list.binary_search_by_key(&cell, |(cell, _)| *cell);
    let left = old.iter().filter(|(cell, _)| is_in(new, *cell).is_err());
    let left = left.map(|&(cell, [ground, _])| GpuRaised { cell, bed: ground });
    let moved = new.iter().filter(|raised| is_in(old, raised.0).map(|place| old[place]) != Ok(**raised));
    left.chain(moved.map(|&(cell, [_, bed])| GpuRaised { cell, bed })).collect()
}

/// Bytes of a value in the layout of a storage buffer.
fn bytes_of<T: ShaderType + encase::internal::WriteInto>(value: &T) -> Vec<u8> {
    let mut buffer = encase::StorageBuffer::new(Vec::new());
    buffer.write(value).expect("a vector grows");
    buffer.into_inner()
}

/// Bytes of a list in the layout of a storage buffer.
fn bytes_of_list<T: ShaderType + encase::ShaderSize + encase::internal::WriteInto>(list: &[T]) -> Vec<u8> {
    bytes_of(&list)
}

/// Buffers of a lost device are of no use.
pub(super) fn forget_states(
    mut commands: Commands,
    states: Query<(Entity, Option<&ShallowFrame>), With<ShallowState>>,
) {
    for (entity, frame) in &states {
        commands.entity(entity).remove::<ShallowState>();
        if let Some(ShallowFrame { work: ShallowWork::Gpu(work), .. }) = frame {
            work.held.lose();
        }
    }
}
