//! Keeps the simulation of every water: makes it, changes it, advances it, and says what it has come to.
use super::{
    ShallowFrame, ShallowWork,
    control::{Asked, Pace},
    domain::{Domain, ground_below, set_edges, set_rims, set_walls, usable_area, usable_ground},
    frame::pictures,
    on_gpu::OnGpu,
    usable::UsableGpu,
};
use crate::{
    body::{
        ResolvedBed, ResolvedSimulation, ResolvedWater, SimulatedArea, SimulatedWater, SimulationBackend,
        SimulationStart, SimulationState, WaterEdges, WaterSimulation, WaterSources, WaterWalls,
    },
    report::Reported,
};
use bevy::{
    ecs::query::QueryData,
    prelude::*,
    render::renderer::{RenderAdapterInfo, RenderDevice},
};
use freshet_hydro::{
    grid::{Grid, Raster},
    shallow_water::{Advance, Field, PointSource, Push, ShallowWater, ShallowWaterError},
};
use std::{sync::Arc, time::Duration};

/// The simulation of a water, and the pictures of it that the surface's shader reads.
#[derive(Component, Default)]
pub(crate) struct Simulated {
    pub(super) simulation: Option<Box<Simulation>>,
    /// What silhouettes do to its cells.
    pub pushes: Vec<Push>,
    /// Forces that floating bodies return to them.
    pub forces: Vec<Push>,
    #[cfg(feature = "rapier")]
    pub exchange: super::Exchange,
    pub pictures: Option<[Handle<Image>; 2]>,
    pub(super) asked: Asked,
    /// What is played back where nothing is simulated.
    pub(super) played: Option<ResolvedSimulation>,
}

/// A running simulation.
pub(super) struct Simulation {
    pub water: ShallowWater,
    made_of: MadeOf,
    area: SimulatedArea,
    /// Elevation of the ground where there is no bed, m.
    flat: f32,
    ground: Option<GroundKey>,
    applied: Option<Applied>,
    pub field: Arc<Field>,
    /// Volume of all water, m³.
    pub volume: f64,
    pub pace: Pace,
    pub on_gpu: Option<OnGpu>,
}

/// What a simulation begins anew for.
#[derive(Clone, Debug, PartialEq)]
struct MadeOf {
    domain: Domain,
    /// Which sides have other water beyond them.
    inner: [bool; 4],
    start: SimulationStart,
    backend: SimulationBackend,
}

/// Which ground is under the cells.
#[derive(Clone, Debug)]
struct GroundKey {
    bed: Option<ResolvedBed>,
    level: f32,
    flat: f32,
}

/// What has been handed to the simulation.
#[derive(Clone, Debug, PartialEq)]
struct Applied {
    edges: WaterEdges,
    sources: WaterSources,
    walls: WaterWalls,
    /// Which map flows around it, and its factor.
    around: Option<(usize, f32)>,
    manning: f32,
    rain: f32,
}

/// A water and all that its simulation is made by.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct Waters {
    entity: Entity,
    resolved: &'static ResolvedWater,
    settings: &'static WaterSimulation,
    edges: &'static WaterEdges,
    sources: &'static WaterSources,
    walls: &'static WaterWalls,
    simulated: &'static mut Simulated,
    state: &'static mut SimulationState,
}

impl Simulated {
    /// How far the ground lies below the still level where there is no bed, m.
    pub fn flat_ground(&self) -> Option<f32> {
        let played = self.played.as_ref().map(|_| 0.0);
        self.simulation.as_ref().map(|simulation| -simulation.flat).or(played)
    }

    /// The cells of the simulation.
    pub fn raster(&self) -> Option<Raster> {
        let Simulation { water, area, .. } = self.simulation.as_deref()?;
        let (cell, size) = (water.cell_size(), water.size());
        Some(Raster { origin: area.center - 0.5 * cell * size.as_vec2(), cell, size })
    }

    /// The newest state.
    pub fn resolve(&self) -> Option<ResolvedSimulation> {
        let Some(simulation) = &self.simulation else { return self.played.clone() };
        let age = simulation.on_gpu.as_ref().map_or(0.0, OnGpu::age) as f32;
        Some(ResolvedSimulation { water: SimulatedWater::Field(simulation.field.clone()), age, area: simulation.area })
    }
}

/// Advances the waters that are simulated on the CPU, in every fixed step.
pub(super) fn simulate_on_cpu(
    time: Res<Time>,
    adapter: Option<Res<RenderAdapterInfo>>,
    device: Option<Res<RenderDevice>>,
    mut reported: ResMut<Reported>,
    mut waters: Query<Waters>,
) {
    let gpu = UsableGpu::new(adapter.as_deref(), device.as_deref());
    for mut water in &mut waters {
        prepare(&mut water, &gpu, &mut reported);
        let (entity, settings) = (water.entity, water.settings);
        let Some(simulation) = water.simulated.simulation.as_mut().filter(|simulation| simulation.on_gpu.is_none())
        else {
            continue;
        };
        let duration = time.delta_secs_f64() * f64::from(settings.usable_speed(entity, &mut reported));
        if duration > 0.0 && !settings.paused {
            let advance = simulation.advance(duration, most_steps(entity, settings, &mut reported));
            if advance.left > 0.0 {
                reported.warn(entity, "WaterSimulation::max_steps", "does not suffice: the water runs late");
            }
        }
        water.state.set_if_neq(simulation.state());
    }
}

/// Takes what the GPU has come to, and asks it for the time of the frame.
pub(super) fn simulate_on_gpu(
    time: Res<Time>,
    adapter: Option<Res<RenderAdapterInfo>>,
    device: Option<Res<RenderDevice>>,
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut reported: ResMut<Reported>,
    mut waters: Query<Waters>,
) {
    let gpu = UsableGpu::new(adapter.as_deref(), device.as_deref());
    for mut water in &mut waters {
        prepare(&mut water, &gpu, &mut reported);
        let (entity, settings) = (water.entity, water.settings);
        let Simulated { simulation: Some(simulation), pictures, asked, .. } = &mut *water.simulated else {
            commands.entity(entity).remove::<ShallowFrame>();
            continue;
        };
        if device.is_none() {
            continue;
        }
        let pictures = pictures_of(pictures, simulation.made_of.domain.size, &mut images);
        let work = if simulation.on_gpu.is_some() {
            simulation.take_returned();
            let speed = settings.usable_speed(entity, &mut reported);
            let steps = most_steps(entity, settings, &mut reported);
            let work = if !settings.paused {
                simulation.ask(time.delta().mul_f32(speed), steps, speed)
            } else if simulation.is_up_to_date() && asked.takes_step() {
                let step = simulation.water.next_step();
                simulation.ask(Duration::from_secs_f64(step), steps, 0.0)
            } else {
                // Nothing may be owed.
                simulation.ask(Duration::ZERO, steps, 0.0)
            };
            if simulation.on_gpu.as_ref().is_some_and(|gpu| gpu.late > 30) {
                reported.warn(entity, "WaterSimulation::max_steps", "does not suffice: the water runs late");
            }
            ShallowWork::Gpu(Box::new(work))
        } else {
            ShallowWork::Cpu(simulation.field.clone())
        };
        water.state.set_if_neq(simulation.state());
        commands.entity(entity).insert(ShallowFrame { work, pictures: pictures.map(|picture| picture.id()) });
    }
}

pub(super) fn pictures_of(
    known: &mut Option<[Handle<Image>; 2]>,
    size: UVec2,
    images: &mut Assets<Image>,
) -> [Handle<Image>; 2] {
    let fits = |pair: &[Handle<Image>; 2]| images.get(&pair[0]).is_some_and(|image| image.size() == size);
    if let Some(pair) = known.as_ref().filter(|pair| fits(pair)) {
        return pair.clone();
    }
    known.insert(pictures(size).map(|image| images.add(image))).clone()
}

fn most_steps(entity: Entity, settings: &WaterSimulation, reported: &mut Reported) -> u32 {
    reported.clamp(entity, "WaterSimulation::max_steps", settings.max_steps as f32, 1.0..=4096.0, 64.0) as u32
}

/// Makes the simulation if there is none that fits, hands it what has changed, and on the CPU takes the single steps of a paused
/// one.
fn prepare(water: &mut WatersItem, gpu: &UsableGpu, reported: &mut Reported) {
    let (entity, settings, resolved) = (water.entity, water.settings, water.resolved);
    let simulated = &mut *water.simulated;
    if resolved.half_size == Vec2::ZERO {
        simulated.simulation = None;
        water.state.set_if_neq(default());
        return;
    }
    let cell = reported.clamp(entity, "WaterSimulation::cell_size", settings.cell_size, 1e-3..=1e5, 1.0);
    let area = usable_area(entity, resolved, settings, reported);
    let (domain, area) = Domain::new(area, cell);
    let made_of = MadeOf {
        domain,
        inner: area.per_blend.to_array().map(|per_blend| per_blend > 0.0),
        start: settings.start,
        backend: settings.backend,
    };
    let fits = simulated.simulation.as_ref().is_some_and(|simulation| simulation.made_of == made_of);
    if simulated.asked.takes_reset() || !fits {
        simulated.simulation = begin(made_of, entity, resolved, settings, gpu, reported);
        simulated.pushes.clear();
        simulated.forces.clear();
    }
    let Some(simulation) = &mut simulated.simulation else {
        water.state.set_if_neq(default());
        return;
    };
    // Those of a simulation of another size are none of this one.
    let pushes = [simulated.pushes.as_slice(), &simulated.forces].concat();
    if simulation.water.set_pushes(&pushes).is_err() {
        simulated.pushes.clear();
        simulated.forces.clear();
        _ = simulation.water.set_pushes(&[]);
    }
    simulation.area = area;
    simulation.follow_ground(entity, resolved, settings, reported);
    let around = resolved.flow.as_ref().filter(|_| area.is_part());
    let applied = Applied {
        around: around.map(|(map, scale)| (Arc::as_ptr(map) as usize, *scale)),
        edges: water.edges.clone(),
        sources: water.sources.clone(),
        walls: water.walls.clone(),
        manning: settings.manning,
        rain: settings.rain,
    };
    simulation.apply(entity, applied, resolved, reported);
    if !settings.paused {
        simulated.asked.forget_steps();
    } else if simulation.on_gpu.is_none() {
        simulation.pace.steps = 0;
        if simulated.asked.takes_step() {
            let step = simulation.water.next_step();
            simulation.advance(step, 1);
        }
    }
}

/// A simulation at its start; nothing if it cannot begin.
fn begin(
    made_of: MadeOf,
    entity: Entity,
    resolved: &ResolvedWater,
    settings: &WaterSimulation,
    gpu: &UsableGpu,
    reported: &mut Reported,
) -> Option<Box<Simulation>> {
    let (size, backend) = (made_of.domain.size, made_of.backend);
    let ground = ground_below(resolved, settings, &made_of.domain);
    match Simulation::new(made_of, &ground) {
        Ok(mut simulation) => {
            simulation.ground = Some(GroundKey::new(resolved, settings));
            let cells = u64::from(size.x) * u64::from(size.y);
            let on_gpu = gpu.is_chosen(entity, backend, cells, reported);
            simulation.on_gpu = on_gpu.then(|| OnGpu::new(simulation.water.balance()));
            Some(Box::new(simulation))
        }
        Err(error) => {
            reported.warn(entity, "WaterSimulation", format_args!("cannot begin: {error}"));
            None
        }
    }
}

impl GroundKey {
    fn new(water: &ResolvedWater, settings: &WaterSimulation) -> Self {
        Self { bed: water.bed.clone(), level: water.level, flat: usable_ground(settings) }
    }
}

impl PartialEq for GroundKey {
    fn eq(&self, other: &Self) -> bool {
        let same_bed = match (&self.bed, &other.bed) {
            (Some(a), Some(b)) => {
                let same_place = a.bed_from_local == b.bed_from_local && a.base == b.base;
                same_place && Arc::ptr_eq(&a.elevations, &b.elevations)
            }
            (a, b) => a.is_none() && b.is_none(),
        };
        same_bed && self.level == other.level && self.flat == other.flat
    }
}

impl Simulation {
    fn new(made_of: MadeOf, ground: &Grid<f32>) -> Result<Self, ShallowWaterError> {
        let mut water = ShallowWater::new(ground)?;
        match made_of.start {
            SimulationStart::Still => water.fill(0.0)?,
            SimulationStart::Dry => {}
            SimulationStart::Column { at, half_size, level } => water.set_water(|place, bed| {
                let is_inside = (place + made_of.domain.center - at).abs().cmple(half_size).all();
                (if is_inside { (level - bed).max(0.0) } else { 0.0 }, Vec2::ZERO)
            })?,
        }
        let field = Arc::new(Field::new(&water, None, 0.0));
        let volume = water.volume();
        let pace = Pace::default();
        let area = SimulatedArea::default();
        Ok(Self { water, made_of, area, flat: 0.0, ground: None, applied: None, field, volume, pace, on_gpu: None })
    }

    /// The field of the newest state, `elapsed` seconds after the one before.
    pub fn see(&mut self, elapsed: f64) {
        self.field = Arc::new(Field::new(&self.water, Some(&self.field), elapsed));
        self.volume = self.water.volume();
    }

    /// Advances it on the CPU.
    fn advance(&mut self, duration: f64, most: u32) -> Advance {
        let advance = self.water.advance(duration, most);
        self.see(advance.time);
        let step = advance.time / f64::from(advance.steps.max(1));
        self.pace = Pace { steps: advance.steps, step, late: self.pace.late + advance.left };
        advance
    }

    fn follow_ground(
        &mut self,
        entity: Entity,
        resolved: &ResolvedWater,
        settings: &WaterSimulation,
        reported: &mut Reported,
    ) {
        let key = GroundKey::new(resolved, settings);
        self.flat = usable_ground(settings);
        if self.ground.as_ref() == Some(&key) {
            return;
        }
        let ground = ground_below(resolved, settings, &self.made_of.domain);
        self.ground = Some(key);
        if let Err(error) = self.water.set_bed(&ground) {
            reported.warn(entity, "WaterBed", format_args!("is refused: {error}; the water keeps the one that it had"));
            return;
        }
        self.new_ground();
        self.see(0.0);
        if self.area.is_part() {
            // What flows in from around it depends on its depth.
            self.applied = None;
        }
    }

    fn new_ground(&mut self) {
        if let Some(gpu) = &mut self.on_gpu {
            gpu.ground += 1;
        }
    }

    /// Hands over edges, sources, walls and numbers that have changed.
    fn apply(&mut self, entity: Entity, wanted: Applied, resolved: &ResolvedWater, reported: &mut Reported) {
        if self.applied.as_ref() == Some(&wanted) {
            return;
        }
        let before = self.applied.take();
        let mut refuse = |field, result: Result<(), ShallowWaterError>| {
            if let Err(error) = result {
                reported.warn(entity, field, format_args!("is refused: {error}"));
            }
        };
        let center = self.made_of.domain.center;
        let same_edges = |before: &Applied| before.edges == wanted.edges && before.around == wanted.around;
        if !before.as_ref().is_some_and(same_edges) {
            let rims = set_rims(&mut self.water, &self.area, resolved);
            refuse("WaterEdges", rims.and(set_edges(&mut self.water, &wanted.edges, center)));
        }
        refuse("WaterSimulation::manning", self.water.set_manning(wanted.manning));
        // mm/h to m/s
        refuse("WaterSimulation::rain", self.water.set_rain(wanted.rain / 3.6e6));
        if before.as_ref().is_none_or(|before| before.walls != wanted.walls) {
            refuse("WaterWalls", set_walls(&mut self.water, &wanted.walls, center));
            self.new_ground();
        }
        if before.as_ref().is_none_or(|before| before.sources != wanted.sources) {
            let source = |source: &crate::body::WaterSource| PointSource {
                at: source.at - center,
                radius: source.radius,
                rate: source.rate.clone(),
            };
            refuse("WaterSources", self.water.set_sources(wanted.sources.sources.iter().map(source).collect()));
            self.new_ground();
        }
        self.applied = Some(wanted);
    }
}
