//! Water that is simulated: what to simulate, and what acts on it from outside.
use super::SimulationState;
use crate::{report::Reported, simulation::Simulated};
use bevy::prelude::*;
pub use freshet_hydro::shallow_water::{CLOSED, DomainSide, Edge, Series};

/// Simulates the water by the shallow-water equations: it fills, flows, floods and falls dry by itself, over the
/// [`WaterBed`](super::WaterBed) below, and is drawn, asked and felt as it is simulated. Waves and ripples ride on it.
///
/// What acts on it from outside are [`WaterEdges`], [`WaterSources`] and [`WaterWalls`] beside it. All levels are in metres over
/// the water's still level, the height of its entity.
///
/// Changing `cell_size`, `start`, `area` or `backend`, or the water's size, begins anew; all else may change while it runs. [`SimulationState`] says
/// how it stands, [`ResetSimulation`](super::ResetSimulation) begins anew, and while it is paused
/// [`StepSimulation`](super::StepSimulation) takes it a step further.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
#[require(WaterEdges, WaterSources, WaterWalls, SimulationState, Simulated)]
pub struct WaterSimulation {
    /// Side of a cell, m, > 0. Default 1.
    pub cell_size: f32,
    /// What there is at the beginning.
    pub start: SimulationStart,
    /// Manning's n of the bed, s/m^⅓, ≥ 0. Default 0.03: a clean winding river (Chow 1959).
    pub manning: f32,
    /// Elevation of the ground where it is simulated and there is no bed, m over the still level. Default −2.
    pub ground: f32,
    /// Rain, mm/h, ≥ 0. Default 0.
    pub rain: f32,
    /// Factor on what resists bodies when it pushes the water, 0…10, default 1. At 0 they do nothing to the water.
    ///
    /// Floating bodies (feature `rapier`) take up the room of their hulls, and the water gets the opposite of what it does to them. Other
    /// entities that [disturb water](crate::interaction::DisturbsWater) push it as bluff bodies, with a drag coefficient of 1.
    pub push: f32,
    /// The part of the water that is simulated, local xz, m. Default `None`: all of it. The water around it is as it were without
    /// simulation, still and with the current of its [`WaterFlow`](super::WaterFlow) map. Where that one enters the part or leaves it
    /// and [`WaterEdges`] say nothing, it does so in the simulation too.
    pub area: Option<Rect>,
    /// Width of the strip within the rim of `area` along which the two pass into each other, m, ≥ 0. Default 4.
    pub blend: f32,
    /// Simulated seconds in a second, 0…10⁴. Default 1.
    pub speed: f32,
    /// Most steps in a frame (on the CPU: in a fixed step), 1…4096. Default 64. If more were needed the water runs late.
    pub max_steps: u32,
    /// Where it is simulated.
    pub backend: SimulationBackend,
    /// Whether it stands still: levels and currents stay, and no time is owed for it. Waves, ripples, rings and foam go on, and
    /// foam drifts with the current that stands. Default false.
    pub paused: bool,
}

/// Where a water is simulated.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Clone, Debug)]
pub enum SimulationBackend {
    /// On the GPU if there is one, else on the CPU. A renderer in software counts as none.
    #[default]
    Auto,
    /// In compute shaders, once a frame. Bodies and queries know the state of a few frames ago, carried on to the present.
    Gpu,
    /// On the CPU, in every fixed step. Bodies and queries know the present. The same on every
    /// machine, unless bodies that do not float push it: they are seen once a frame.
    Cpu,
}

/// What there is at the beginning of a simulation.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Clone, Debug)]
pub enum SimulationStart {
    /// Still water at the water's level.
    #[default]
    Still,
    /// Nothing.
    Dry,
    /// Nothing but still water up to `level` within a rectangle: a column that falls.
    Column {
        /// Middle of the rectangle, local xz, m.
        at: Vec2,
        /// Half of its sides, m.
        half_size: Vec2,
        /// Level, m over the still level.
        level: f32,
    },
}

impl WaterSimulation {
    /// Checked [`WaterSimulation::speed`].
    pub(crate) fn usable_speed(&self, entity: Entity, reported: &mut Reported) -> f32 {
        reported.clamp(entity, "WaterSimulation::speed", self.speed, 0.0..=1e4, 1.0)
    }

    /// Checked [`WaterSimulation::push`].
    pub(crate) fn usable_push(&self, entity: Entity, reported: &mut Reported) -> f32 {
        reported.clamp(entity, "WaterSimulation::push", self.push, 0.0..=10.0, 1.0)
    }
}

impl Default for WaterSimulation {
    fn default() -> Self {
        Self {
            cell_size: 1.0,
            start: SimulationStart::Still,
            manning: 0.03,
            ground: -2.0,
            rain: 0.0,
            push: 1.0,
            area: None,
            blend: 4.0,
            speed: 1.0,
            max_steps: 64,
            backend: SimulationBackend::Auto,
            paused: false,
        }
    }
}

/// What is outside the sides of a simulated water. Walls where nothing else is said.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterEdges {
    /// Whether the western side continues in the eastern one, and the northern in the southern one.
    pub periodic: BVec2,
    /// Parts of sides; a later one comes before an earlier one.
    #[reflect(ignore)]
    pub parts: Vec<WaterEdge>,
}

/// A part of a side.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterEdge {
    /// The side, in the water's frame: west is −x, north is −z.
    pub side: DomainSide,
    /// Where the part begins and ends along the side, local x or z, m. May be infinite.
    pub from: f32,
    /// See `from`.
    pub to: f32,
    /// What is there. Levels are in m over the still level.
    pub edge: Edge,
}

impl WaterEdge {
    /// All of a side.
    pub fn all(side: DomainSide, edge: Edge) -> Self {
        Self { side, from: f32::NEG_INFINITY, to: f32::INFINITY, edge }
    }
}

/// Springs and drains of a simulated water.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterSources {
    /// All of them.
    #[reflect(ignore)]
    pub sources: Vec<WaterSource>,
}

/// A spring, or a drain.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterSource {
    /// Where it is, local xz, m.
    pub at: Vec2,
    /// Radius over which it is spread, m, ≥ 0.
    pub radius: f32,
    /// What it gives, m³/s; takes, if negative.
    pub rate: Series,
}

/// Thin walls in a simulated water: dams, dikes, gates.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct WaterWalls {
    /// All of them.
    pub walls: Vec<WaterWall>,
}

/// A thin wall along a straight line, on the faces of the cells next to it.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Clone, Debug)]
pub struct WaterWall {
    /// One end, local xz, m.
    pub from: Vec2,
    /// The other end, local xz, m.
    pub to: Vec2,
    /// Elevation of its top, m over the still level: water passes above it. [`CLOSED`] lets none pass.
    pub crest: f32,
}
