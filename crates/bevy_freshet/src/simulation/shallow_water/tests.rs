//! The stages on a GPU against the scheme's twin, and against theory.
#[path = "../../../../freshet_hydro/tests/shallow_water/analytic.rs"]
mod analytic;
#[path = "../../../../freshet_hydro/tests/shallow_water/cases/mod.rs"]
mod cases;
#[path = "../../../../../tests/said.rs"]
pub(super) mod said;

use super::{super::tests::stage::Stage, *};
use bevy::{
    prelude::*,
    render::{
        RenderApp,
        render_resource::{CachedPipelineState, PipelineCache},
    },
};
use freshet_hydro::{
    grid::Grid,
    shallow_water::{Balance, Restored, ShallowWater},
};
use std::sync::{Arc, atomic::Ordering};

/// Simulates on the GPU.
struct Gpu {
    stage: Stage,
    entity: Entity,
    version: u64,
    grounds: u64,
    pictures: Option<(UVec2, [Handle<Image>; 2])>,
}

impl Gpu {
    fn new() -> Self {
        let mut stage = Stage::with(|app| _ = app.add_plugins(StagesPlugin));
        let entity = stage.spawn(());
        Self { stage, entity, version: 0, grounds: 0, pictures: None }
    }

    fn pictures(&mut self, size: UVec2) -> [AssetId<Image>; 2] {
        if self.pictures.as_ref().is_none_or(|(of, _)| *of != size) {
            let mut images = self.stage.app.world_mut().resource_mut::<Assets<Image>>();
            self.pictures = Some((size, frame::pictures(size).map(|image| images.add(image))));
        }
        self.pictures.as_ref().expect("just made").1.each_ref().map(Handle::id)
    }

    /// Fails if a pipeline cannot be made.
    fn complain(&self) {
        let cache = self.stage.app.sub_app(RenderApp).world().resource::<PipelineCache>();
        for pipeline in cache.pipelines() {
            if let CachedPipelineState::Err(error) = &pipeline.state {
                panic!("{error}");
            }
        }
    }

    /// Advances `water` by `duration` (s), and returns the number of steps. What acts on it is asked for every few steps if it
    /// changes with time, else every few hundred.
    fn run(&mut self, water: &mut ShallowWater, duration: f64) -> u32 {
        let (mut asked, mut steps, mut at_once) = (0.0, 0, 4.0);
        let mut edges: Vec<(u32, [f32; 2])> = Vec::new();
        let mut started = None;
        while duration - asked > 1e-7 * duration {
            let step = f64::from(water.courant() * water.cell_size() / water.fastest_signal().max(1e-3));
            let added = (duration - asked).min((at_once * step).max(duration / 1e4));
            asked += added;
            steps +=
                self.advance(water, added, started.get_or_insert_with(|| (water.balance(), water.time(), default())));
            let now: Vec<(u32, [f32; 2])> = water.edge_cells().collect();
            at_once = if now == edges { (2.0 * at_once).min(200.0) } else { 4.0 };
            edges = now;
        }
        steps
    }

    /// Advances `water` by `added` (s) from the state that it `started` with: its book, its time and what the GPU holds of it.
    fn advance(&mut self, water: &mut ShallowWater, added: f64, started: &(Balance, f64, Arc<Held>)) -> u32 {
        let (before, began, held) = started;
        if held.start.load(Ordering::Relaxed) == 0 {
            self.version += 1;
        }
        let returned = self.frames(water, added, held);
        let restored = Restored {
            time: began + returned.time,
            fastest_signal: returned.fastest,
            balance: on_gpu::balance(before, &returned, water),
        };
        water.restore(returned.cells.iter().map(|cell| cell.to_array()), restored);
        returned.steps
    }

    /// Runs frames until the time `added` has been simulated.
    fn frames(&mut self, water: &mut ShallowWater, mut added: f64, held: &Arc<Held>) -> Returned {
        let pictures = self.pictures(water.size());
        let step = f64::from(water.courant() * water.cell_size() / water.fastest_signal().max(1e-3));
        let most = ((1.5 * added / step).ceil() as u32 + 4).min(256);
        let mut steps = 0;
        for frames in 0.. {
            let holds = held.start.load(Ordering::Relaxed) == self.version;
            let now = if holds { std::mem::take(&mut added) } else { 0.0 };
            self.grounds += 1;
            let work = work(water, [self.version, self.grounds], now, most, held);
            let frame = ShallowFrame { work: ShallowWork::Gpu(Box::new(work)), pictures };
            self.stage.app.world_mut().entity_mut(self.entity).insert(frame);
            self.stage.app.update();
            if frames == 100 {
                self.complain();
            }
            if let Some(returned) = held.take() {
                steps += returned.steps;
                if added == 0.0 && returned.owed <= 0.0 && returned.time > 0.0 {
                    return Returned { steps, ..returned };
                }
            }
        }
        unreachable!("frames go on for ever")
    }
}

fn work(water: &mut ShallowWater, [start, ground]: [u64; 2], added: f64, steps: u32, held: &Arc<Held>) -> GpuWork {
    let size = water.size();
    let forcing = water.forcing();
    let (rain, entering, longest) = (forcing.rain, forcing.entering, forcing.longest_step);
    let sources = forcing.sources.to_vec();
    let numbers = GpuShallow {
        size: size.as_ivec2(),
        periodic: uvec2(water.periodic().0.into(), water.periodic().1.into()),
        cell: water.cell_size(),
        courant: water.courant(),
        drag: freshet_hydro::waves::GRAVITY * water.manning() * water.manning(),
        rain,
        added: added as f32,
        most_owed: 1e6,
        entering,
        longest,
    };
    let has_walls = water.crests().is_some();
    let extras = on_gpu::extras(water, &sources, has_walls || !sources.is_empty());
    GpuWork {
        numbers,
        asked: 0.0,
        edges: water.edge_cells().map(|(kind, [value, entering])| GpuEdge { kind, value, entering }).collect(),
        pushes: on_gpu::pushes(water),
        raised: on_gpu::raised(water),
        start: Some(Arc::new(StartState {
            version: start,
            cells: water.conserved().map(Vec4::from).collect(),
            fastest: water.fastest_signal(),
        })),
        ground: Some(Arc::new(Ground { version: ground, bed: water.ground(), extras })),
        has_walls,
        has_sources: !sources.is_empty(),
        steps,
        held: held.clone(),
    }
}

/// Makes a test of every case of the twin, on the GPU.
macro_rules! on_the_gpu {
    ($($module:ident { $($case:ident)* })*) => {
        $(mod $module {
            $(#[test]
            fn $case() {
                let mut gpu = super::Gpu::new();
                super::cases::$module::$case(&mut |water, duration| _ = gpu.run(water, duration));
            })*
        })*
    };
}

cases::every_case!(on_the_gpu);

#[test]
fn the_volume_of_a_shaken_basin_is_kept() {
    let mut gpu = Gpu::new();
    cases::volume::in_a_basin_that_is_shaken(&mut |water, duration| _ = gpu.run(water, duration));
}

#[test]
fn a_dam_break_is_that_of_the_twin() {
    let mut gpu = Gpu::new();
    let bed = Grid::from_fn(uvec2(150, 70), 0.5, |cell| {
        let at = (cell.as_vec2() - vec2(100.0, 40.0)) / 12.0;
        0.8 * (-at.length_squared()).exp() + 0.004 * cell.x as f32
    })
    .expect("a valid shape");
    let mut twin = ShallowWater::new(&bed).expect("a finite bed");
    twin.set_manning(0.02).expect("sane");
    twin.set_water(|at, bed| ((if at.x < -10.0 { 1.2 } else { 0.0 } - bed).max(0.0), Vec2::ZERO)).expect("sane");
    let mut water = twin.clone();
    let advance = twin.advance(6.0, 10_000);
    let started = (water.balance(), 0.0, default());
    let steps = gpu.advance(&mut water, 6.0, &started);
    let off = twin.depths().iter().zip(water.depths()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    println!("{} steps, {steps} on the GPU: depths differ by {off:e} m", advance.steps);
    assert!(steps > 100 && off < 1e-5, "{off}");
}

#[test]
#[ignore = "measures"]
fn costs_of_steps() {
    let mut gpu = Gpu::new();
    for size in [64, 128, 256, 512, 1024, 2048] {
        let bed = Grid::from_fn(UVec2::splat(size), 1.0, |cell| -5.0 + 0.01 * cell.x as f32).expect("valid");
        let mut water = ShallowWater::new(&bed).expect("finite");
        water.set_manning(0.03).expect("sane");
        water
            .set_water(|at, bed| ((2.0 * (-at.length_squared() / 400.0).exp() - bed).max(0.0), Vec2::ZERO))
            .expect("sane");
        let mut twin = water.clone();
        let steps = (1 << 24) / (size * size);
        let duration = f64::from(steps) * 0.45 / f64::from(water.fastest_signal());
        let started = (water.balance(), 0.0, default());
        gpu.advance(&mut water, 0.01, &started);
        let start = std::time::Instant::now();
        let done = gpu.advance(&mut water, duration, &started);
        let spent = start.elapsed().as_secs_f64();
        let start = std::time::Instant::now();
        let on_cpu = twin.advance(duration, u32::MAX).steps;
        let twin_spent = start.elapsed().as_secs_f64();
        let rate = |steps: u32, spent: f64| f64::from(steps) * f64::from(size * size) / spent / 1e6;
        println!(
            "{size}²: {done} steps, {:.1} M cell-steps/s, twin {:.1}",
            rate(done, spent),
            rate(on_cpu, twin_spent)
        );
    }
}
