//! The stages on a GPU against the scheme's twin, and against theory.
#[expect(dead_code, reason = "made for pictures; only a part is needed here")]
#[path = "../../../../../tests/stage.rs"]
mod stage;

use super::*;
use bevy::{
    prelude::*,
    render::{
        RenderApp,
        render_resource::{CachedPipelineState, PipelineCache},
    },
};
use freshet_hydro::{grid::Grid, shallow_water::ShallowWater};
use stage::Stage;
use std::sync::Arc;

/// Simulates on the GPU.
struct Gpu {
    stage: Stage,
    entity: Entity,
    version: u64,
    pictures: Option<(UVec2, [Handle<Image>; 2])>,
}

impl Gpu {
    fn new() -> Self {
        let mut stage = Stage::with(|app| _ = app.add_plugins(StagesPlugin));
        let entity = stage.spawn(());
        Self { stage, entity, version: 0, pictures: None }
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

    /// Advances `water` by `duration` (s), `most` steps in a frame.
    fn run(&mut self, water: &mut ShallowWater, duration: f64, most: u32) -> u32 {
        self.version += 1;
        let held: Arc<Held> = default();
        let (mut added, mut steps, mut frames) = (duration, 0, 0);
        loop {
            let holds = held.start.load(std::sync::atomic::Ordering::Relaxed) == self.version;
            let work = work(water, self.version, if holds { std::mem::take(&mut added) } else { 0.0 }, most, &held);
            let pictures = self.pictures(water.size());
            let frame = ShallowFrame { work: ShallowWork::Gpu(Box::new(work)), pictures };
            self.stage.app.world_mut().entity_mut(self.entity).insert(frame);
            self.stage.app.update();
            frames += 1;
            if frames == 50 {
                self.complain();
            }
            let Some(returned) = held.take() else { continue };
            steps += returned.steps;
            if added == 0.0 && returned.owed <= 0.0 && returned.time > 0.0 {
                let balance = water.balance();
                water.restore(
                    returned.cells.iter().map(|cell| cell.to_array()),
                    freshet_hydro::shallow_water::Restored {
                        time: water.time() + returned.time,
                        fastest_signal: returned.fastest,
                        balance,
                    },
                );
                return steps;
            }
        }
    }
}

fn work(water: &mut ShallowWater, version: u64, added: f64, steps: u32, held: &Arc<Held>) -> GpuWork {
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
    let none = || vec![[-1e30_f32; 2]; water.bed().len()];
    let crests: Vec<[f32; 2]> = water.crests().map_or_else(none, Iterator::collect);
    let source = |i: usize| sources.get(i).copied().unwrap_or_default();
    let extras = crests.iter().enumerate().map(|(i, crest)| vec4(crest[0], crest[1], source(i), 0.0)).collect();
    GpuWork {
        numbers,
        edges: water.edge_cells().map(|(kind, value)| GpuEdge { kind, value }).collect(),
        start: Some(Arc::new(StartState {
            version,
            cells: water.conserved().map(Vec4::from).collect(),
            fastest: water.fastest_signal(),
        })),
        ground: Some(Arc::new(Ground { version, bed: water.bed().to_vec(), extras })),
        has_walls: water.crests().is_some(),
        has_sources: !sources.is_empty(),
        steps,
        held: held.clone(),
    }
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
    let steps = gpu.run(&mut water, 6.0, 200);
    let off = twin.depths().iter().zip(water.depths()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    println!("{} steps, {steps} on the GPU: depths differ by {off:e} m", advance.steps);
    assert!(off < 1e-4, "{off}");
}

#[test]
#[ignore = "measures"]
fn costs_of_steps() {
    let mut gpu = Gpu::new();
    for size in [64, 128, 256, 512, 1024] {
        let bed = Grid::from_fn(UVec2::splat(size), 1.0, |cell| -5.0 + 0.01 * cell.x as f32).expect("valid");
        let mut water = ShallowWater::new(&bed).expect("finite");
        water.set_manning(0.03).expect("sane");
        water
            .set_water(|at, bed| ((2.0 * (-at.length_squared() / 400.0).exp() - bed).max(0.0), Vec2::ZERO))
            .expect("sane");
        let mut twin = water.clone();
        let steps = (1 << 24) / (size * size);
        let duration = f64::from(steps) * 0.45 / f64::from(water.fastest_signal());
        gpu.run(&mut water, 0.01, 2);
        let start = std::time::Instant::now();
        let done = gpu.run(&mut water, duration, steps + steps / 8);
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
