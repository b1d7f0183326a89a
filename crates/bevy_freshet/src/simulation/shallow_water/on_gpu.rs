//! A simulation on the GPU as the CPU knows it: what is asked of it, and what has come back.
use super::{GpuEdge, GpuPush, GpuShallow, GpuWork, Ground, Held, Returned, StartState, driver::Simulation};
use bevy::prelude::*;
use freshet_hydro::{
    shallow_water::{Balance, CLOSED, Push, Restored, ShallowWater},
    waves::GRAVITY,
};
use std::{
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

/// Most time that a water on the GPU may owe, s of the frame's clock.
const MOST_OWED: f32 = 0.25;
/// A state of the GPU is carried on for so long at most, s.
const OLDEST: f32 = 0.25;
/// Steps are planned for a signal that is faster than the last known one by this factor.
const RESERVE: f64 = 1.5;

/// How far the GPU has come.
#[derive(Default)]
pub(super) struct OnGpu {
    held: Arc<Held>,
    /// Versions of state and ground.
    start: u64,
    pub ground: u64,
    /// Time asked for since the state was set, s.
    asked: f64,
    /// Book and time when the state was set.
    balance: Balance,
    began: f64,
    /// Simulated time of the newest state that came back, since then, s.
    returned: f64,
    owed: f64,
    /// Time asked for that went with lost devices, s.
    lost: f64,
    /// Time that had been asked for when that state was under way, s.
    answered: f64,
    /// Late frames in a row.
    pub late: u32,
    /// Point sources of the ground that it has, m/s.
    sources: Vec<f32>,
}

impl OnGpu {
    /// The GPU before it has been asked for anything, with the book of the state that it begins with.
    pub fn new(balance: Balance) -> Self {
        Self { start: next_start(), ground: 1, balance, ..default() }
    }

    /// How much older than what was asked for the newest state is that came back, s.
    pub fn age(&self) -> f64 {
        (self.asked - self.answered + self.owed).clamp(0.0, OLDEST.into())
    }
}

/// A version of a state that no water has had: what the GPU holds of one that has been replaced is not taken for the new one.
fn next_start() -> u64 {
    static STARTS: AtomicU64 = AtomicU64::new(1);
    STARTS.fetch_add(1, Ordering::Relaxed)
}

impl Simulation {
    /// Takes over the newest state that the GPU has come to.
    pub fn take_returned(&mut self) {
        let Some(gpu) = &mut self.on_gpu else { return };
        let Some(returned) = gpu.held.take().filter(|returned| returned.start == gpu.start) else { return };
        gpu.late = if returned.owed > 1e-4 && returned.steps > 0 { gpu.late + 1 } else { 0 };
        (gpu.owed, gpu.answered) = (returned.owed, returned.asked);
        self.pace.steps = returned.steps;
        self.pace.late = gpu.lost + (returned.asked - returned.time).max(0.0);
        if returned.time <= gpu.returned {
            return;
        }
        let elapsed = returned.time - gpu.returned;
        gpu.returned = returned.time;
        let restored = Restored {
            time: gpu.began + returned.time,
            fastest_signal: returned.fastest,
            balance: balance(&gpu.balance, &returned, &self.water),
        };
        self.water.restore(returned.cells.iter().map(|cell| cell.to_array()), restored);
        self.see(elapsed);
    }

    /// Whether the GPU holds its state, and owes nothing that it was asked for.
    pub fn is_up_to_date(&self) -> bool {
        self.on_gpu.as_ref().is_some_and(|gpu| {
            gpu.held.start.load(Ordering::Relaxed) == gpu.start && gpu.answered == gpu.asked && gpu.owed <= 0.0
        })
    }

    /// What the GPU is asked to do for a frame of this duration.
    pub fn ask(&mut self, duration: Duration, most: u32, speed: f32) -> GpuWork {
        let forcing = self.water.forcing();
        let (rain, entering, longest) = (forcing.rain, forcing.entering, forcing.longest_step);
        let sources = forcing.sources.to_vec();
        let gpu = self.on_gpu.get_or_insert_default();
        // A lost device takes the state with it: what came back last is the beginning of another one.
        let holds = gpu.held.start.load(Ordering::Relaxed) == gpu.start;
        if !holds && gpu.held.was_lost() {
            gpu.start = next_start();
            gpu.began = self.water.time();
            gpu.balance = self.water.balance();
            gpu.lost += (gpu.asked - gpu.returned).max(0.0);
            self.pace.late = gpu.lost;
            (gpu.asked, gpu.answered, gpu.returned, gpu.owed) = (0.0, 0.0, 0.0, 0.0);
        }
        let added = if holds { duration.as_secs_f64() } else { 0.0 };
        // What the GPU gets of it.
        gpu.asked += f64::from(added as f32);
        let asked = gpu.asked;
        let signal = f64::from(self.water.courant() * self.water.cell_size())
            / f64::from(self.water.fastest_signal().max(entering).max(1e-3));
        self.pace.step = signal.min(f64::from(longest));
        let needed = (RESERVE * (added + gpu.owed) / self.pace.step).ceil() + 2.0;
        let size = self.water.size();
        let manning = self.water.manning();
        let periodic = self.water.periodic();
        let numbers = GpuShallow {
            size: size.as_ivec2(),
            periodic: uvec2(periodic.0.into(), periodic.1.into()),
            cell: self.water.cell_size(),
            courant: self.water.courant(),
            drag: GRAVITY * manning * manning,
            rain,
            added: added as f32,
            most_owed: (MOST_OWED * speed).max(added as f32),
            entering,
            longest,
        };
        let has_walls = self.water.crests().is_some();
        let has_sources = self.water.has_sources();
        let start = (!holds).then(|| {
            Arc::new(StartState {
                version: gpu.start,
                cells: self.water.conserved().map(Vec4::from).collect(),
                fastest: self.water.fastest_signal(),
            })
        });
        if gpu.sources != sources {
            gpu.ground += 1;
            gpu.sources.clone_from(&sources);
        }
        let has_ground = gpu.held.ground.load(Ordering::Relaxed) == gpu.ground;
        let version = gpu.ground;
        // A water that is paused and owes nothing rests, and so does its picture.
        let rests = added == 0.0 && holds && has_ground && self.is_up_to_date();
        if rests {
            self.pace.steps = 0;
        }
        let ground = (!holds || !has_ground).then(|| {
            Arc::new(Ground {
                version,
                bed: self.water.ground(),
                extras: extras(&self.water, &sources, has_walls || has_sources),
            })
        });
        GpuWork {
            numbers,
            asked,
            edges: self.water.edge_cells().map(|(kind, [value, entering])| GpuEdge { kind, value, entering }).collect(),
            pushes: pushes(&self.water),
            raised: raised(&self.water),
            start,
            ground,
            has_walls,
            has_sources,
            steps: if rests { 0 } else { (needed as u32).min(most).next_multiple_of(2) },
            held: self.on_gpu.as_ref().map(|gpu| gpu.held.clone()).unwrap_or_default(),
        }
    }
}

/// What bodies do to the water.
pub(super) fn pushes(water: &ShallowWater) -> Vec<GpuPush> {
    let columns = water.size().x;
    let push = |push: &Push| GpuPush {
        cell: push.cell.y * columns + push.cell.x,
        strength: push.strength,
        velocity: push.velocity,
        force: push.force,
    };
    water.pushes().iter().map(push).collect()
}

/// Where bodies are in the water.
pub(super) fn raised(water: &ShallowWater) -> Vec<(u32, [f32; 2])> {
    let mut raised: Vec<_> = water.raised().map(|(index, elevations)| (index as u32, elevations)).collect();
    raised.sort_unstable_by_key(|(cell, _)| *cell);
    raised
}

/// Crests and sources of every cell; nothing if there are none.
pub(super) fn extras(water: &ShallowWater, sources: &[f32], any: bool) -> Vec<Vec4> {
    if !any {
        return Vec::new();
    }
    let open =
        || Box::new(std::iter::repeat_n([f32::NEG_INFINITY; 2], water.bed().len())) as Box<dyn Iterator<Item = _>>;
    let crests = water.crests().map_or_else(open, |crests| Box::new(crests));
    // Shaders need not know infinity.
    let finite = |crest: f32| if crest == CLOSED { 1e30 } else { crest.max(-1e30) };
    let source = |i: usize| sources.get(i).copied().unwrap_or_default();
    crests.enumerate().map(|(i, [east, south])| vec4(finite(east), finite(south), source(i), 0.0)).collect()
}

/// The book of a state that came back.
pub(super) fn balance(before: &Balance, returned: &Returned, water: &ShallowWater) -> Balance {
    let cell = f64::from(water.cell_size());
    let count = water.bed().len() as f64;
    let rain = returned.rained * count * cell * cell;
    let mut balance = *before;
    balance.rain += rain;
    balance.sources += returned.given * cell * cell;
    let (columns, rows) = (water.size().x as usize, water.size().y as usize);
    let mut sides = returned.left.as_slice();
    for (left, length) in balance.left.iter_mut().zip([rows, rows, columns, columns]) {
        let (side, rest) = sides.split_at(length.min(sides.len()));
        *left += side.iter().sum::<f64>() * cell;
        sides = rest;
    }
    balance
}
