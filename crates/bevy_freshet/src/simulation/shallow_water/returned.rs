//! How the state of the water comes back to the CPU, without anybody waiting for it.
//!
//! After the steps of a frame the buffers are copied to one of a few others, which the device maps when it gets there. If all
//! of them are still on their way, the frame is not copied.
use super::{
    numbers::{GpuClock, GpuLeaving},
    state::ShallowState,
};
use bevy::{
    prelude::*,
    render::{
        render_resource::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, MapMode, ShaderType, encase},
        renderer::RenderDevice,
    },
};
use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, AtomicU64, Ordering},
};

/// Copies that may be on their way at a time.
const MOST_COPIES: usize = 3;

/// What the render world holds of a water, and the newest state that came back.
#[derive(Debug, Default)]
pub(crate) struct Held {
    /// Version of the state that it began with, 0 if it has none.
    pub start: AtomicU64,
    /// Version of the ground.
    pub ground: AtomicU64,
    /// Whether a device was lost that held a state, until somebody asks.
    lost: AtomicBool,
    returned: Mutex<Option<Returned>>,
}

/// A state of the water as the GPU has come to it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Returned {
    /// Version of the state that it began with.
    pub start: u64,
    /// Simulated time since then, s.
    pub time: f64,
    /// Time that it had been asked for since then, s.
    pub asked: f64,
    /// Time that was owed, s.
    pub owed: f64,
    /// Steps of the frame.
    pub steps: u32,
    /// Fastest signal, m/s.
    pub fastest: f32,
    /// Depth of rain since then, m.
    pub rained: f64,
    /// Depth that sources gave since then, without rain, summed over the cells, m.
    pub given: f64,
    /// Volume per width that left through every cell of the sides, m².
    pub left: Vec<f64>,
    /// Depth, discharge and carry of every cell.
    pub cells: Vec<Vec4>,
}

impl Held {
    /// The newest state, once.
    pub fn take(&self) -> Option<Returned> {
        self.returned.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
    }

    /// Whether a device was lost with the state that it held; said once.
    pub fn was_lost(&self) -> bool {
        self.lost.swap(false, Ordering::Relaxed)
    }

    /// The device is lost, and with it what it held.
    pub(super) fn lose(&self) {
        let held = self.start.swap(0, Ordering::Relaxed);
        self.ground.store(0, Ordering::Relaxed);
        self.lost.fetch_or(held != 0, Ordering::Relaxed);
    }

    fn put(&self, returned: Returned) {
        *self.returned.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(returned);
    }
}

/// Buffers that copies go to.
#[derive(Default)]
pub(super) struct Copies {
    free: Arc<Mutex<Vec<Buffer>>>,
    made: usize,
    /// The copy of this frame, to be mapped once it has been submitted.
    filled: Option<Buffer>,
}

/// Sizes of the parts of a copy, bytes.
struct Parts([u64; 4]);

impl Parts {
    fn of(state: &ShallowState) -> Self {
        Self([&state.clock, &state.leaving, &state.given, &state.states[0]].map(|buffer| buffer.size()))
    }

    fn total(&self) -> u64 {
        self.0.iter().sum()
    }

    fn slice<'a>(&self, bytes: &'a [u8], part: usize) -> &'a [u8] {
        let from: u64 = self.0[..part].iter().sum();
        &bytes[from as usize..(from + self.0[part]) as usize]
    }
}

/// Copies clock, edges, sources and state, if there is a buffer for it.
pub(super) fn copy(state: &mut ShallowState, device: &RenderDevice, encoder: &mut CommandEncoder) {
    let parts = Parts::of(state);
    let copies = &mut state.copies;
    let free = copies.free.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).pop();
    let buffer = match free {
        Some(buffer) => buffer,
        None if copies.made < MOST_COPIES => {
            copies.made += 1;
            device.create_buffer(&BufferDescriptor {
                label: Some("water_shallow_copy"),
                size: parts.total(),
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        }
        None => return,
    };
    let mut to = 0;
    for (from, size) in [&state.clock, &state.leaving, &state.given, &state.states[0]].into_iter().zip(parts.0) {
        encoder.copy_buffer_to_buffer(from, 0, &buffer, to, size);
        to += size;
    }
    copies.filled = Some(buffer);
}

/// Asks for the copies of this frame, which have been submitted.
pub(super) fn map_copies(mut states: Query<(&mut ShallowState, &super::ShallowFrame)>) {
    for (mut state, frame) in &mut states {
        let Some(buffer) = state.copies.filled.take() else { continue };
        let super::ShallowWork::Gpu(work) = &frame.work else { continue };
        let (parts, start) = (Parts::of(&state), state.start);
        let (free, held, asked) = (state.copies.free.clone(), work.held.clone(), work.asked);
        let mapped = buffer.clone();
        buffer.slice(..).map_async(MapMode::Read, move |result| {
            // After an error the buffer belongs to a lost device.
            if result.is_err() {
                return;
            }
            if held.start.load(Ordering::Relaxed) == start {
                let returned = read(&mapped.slice(..).get_mapped_range(), &parts, start);
                held.put(Returned { asked, ..returned });
            }
            mapped.unmap();
            free.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(mapped.clone());
        });
    }
}

fn read(bytes: &[u8], parts: &Parts, start: u64) -> Returned {
    let clock: GpuClock = parse(parts.slice(bytes, 0));
    let leaving: Vec<GpuLeaving> = parse(parts.slice(bytes, 1));
    let given: Vec<Vec2> = parse(parts.slice(bytes, 2));
    let sum = |pair: Vec2| f64::from(pair.x) + f64::from(pair.y);
    Returned {
        start,
        asked: 0.0,
        time: sum(clock.time),
        owed: f64::from(clock.owed.x),
        steps: clock.steps,
        fastest: f32::from_bits(clock.fastest.x),
        rained: sum(clock.rained),
        given: given.into_iter().map(sum).sum(),
        left: leaving.into_iter().map(|leaving| sum(leaving.sum)).collect(),
        cells: parse(parts.slice(bytes, 3)),
    }
}

fn parse<T: Default + ShaderType + encase::internal::ReadFrom>(bytes: &[u8]) -> T {
    let mut value = T::default();
    if let Err(error) = encase::StorageBuffer::new(bytes).read(&mut value) {
        error!("a copy of the shallow water is not what its layout says: {error}");
    }
    value
}
