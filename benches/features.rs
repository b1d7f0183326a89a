//! What the parts of the river cost: `cargo xtask bench features` prints tables in Markdown.
//!
//! Times depend on the machine, ratios much less: every row stands beside "all on", which is measured again just before
//! it, so that a machine that slows down does not look like a costly feature.
#[path = "../examples/common/mod.rs"]
#[expect(dead_code, reason = "a bench takes no picture")]
mod common;
#[path = "../examples/common/river.rs"]
mod river;

use bevy::{
    diagnostic::DiagnosticsStore, prelude::*, render::diagnostic::RenderDiagnosticsPlugin, time::TimeUpdateStrategy,
};
use bevy_freshet::{features::Feature, prelude::*};
use clap::Parser;
use common::{Options, size};
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

/// What is measured, and how.
#[derive(Parser)]
struct Arguments {
    /// Width and height of the picture, pixels.
    #[arg(long, default_value = "480x270", value_parser = size)]
    size: UVec2,
    /// Frames per row, of which the median counts; at least 15.
    #[arg(long, default_value_t = 15, value_parser = clap::value_parser!(u32).range(15..))]
    frames: u32,
    /// Which of the river's cameras to look through.
    #[arg(long, default_value = "drift")]
    camera: String,
}

/// Frames that are run and not counted after every change.
const WARM_UP: u32 = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = Arguments::parse();
    let mut bench = Bench::new(&arguments)?;
    let adapter = bench.adapter();
    println!("River, camera {}, {}x{}, {adapter}.", arguments.camera, arguments.size.x, arguments.size.y);
    println!("Medians of {} frames after {WARM_UP} of warm-up.\n", arguments.frames);
    let dry = bench.table_of_the_water();
    bench.table_of_passes();
    bench.table_of_features(dry);
    bench.table_of_grids(dry);
    bench.table_of_bodies();
    Ok(())
}

struct Bench {
    app: App,
    water: Entity,
    frames: u32,
}

impl Bench {
    fn new(arguments: &Arguments) -> Result<Self, Box<dyn std::error::Error>> {
        let options = Options {
            size: arguments.size,
            frames: 0,
            camera: Some(arguments.camera.clone()),
            // A picture, so that no window is opened; it is never written.
            out: Some("bench.png".into()),
            ..Options::parse_from(["bench"])
        };
        let mut app = river::app(&options, river::Flow::Map)?;
        app.add_plugins(RenderDiagnosticsPlugin);
        common::start(&mut app);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(common::FRAME)));
        let mut waters = app.world_mut().query_filtered::<Entity, With<Water>>();
        let water = waters.single(app.world())?;
        Ok(Self { app, water, frames: arguments.frames })
    }

    fn adapter(&self) -> String {
        let info = self.app.world().resource::<bevy::render::renderer::RenderAdapterInfo>();
        format!("{} ({})", info.name, info.driver_info)
    }

    /// Median time of a frame, ms.
    fn median(&mut self) -> f64 {
        for _ in 0..WARM_UP {
            self.app.update();
        }
        let mut times: Vec<f64> = (0..self.frames)
            .map(|_| {
                let start = Instant::now();
                self.app.update();
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }

    /// Time that each pass takes on the GPU in a frame, of all cameras together, ms.
    fn passes(&mut self) -> BTreeMap<String, f64> {
        // As many as the store of diagnostics keeps for three cameras; times come back some frames late.
        const FRAMES: u32 = 30;
        self.median();
        let start = Instant::now();
        (0..FRAMES).for_each(|_| self.app.update());
        let frames = f64::from(FRAMES);
        let store = self.app.world().resource::<DiagnosticsStore>();
        let passes = store.iter().filter_map(|pass| {
            let name = pass.path().as_str().strip_prefix("render/")?.strip_suffix("/elapsed_gpu")?;
            let new = pass.measurements().filter(|measured| measured.time > start);
            Some((name.to_owned(), new.map(|measured| measured.value).sum::<f64>() / frames))
        });
        passes.collect()
    }

    /// Median with all on and with `change` made and unmade again, ms.
    fn compare(&mut self, change: impl FnOnce(&mut World, Entity), undo: impl FnOnce(&mut World, Entity)) -> [f64; 2] {
        let water = self.water;
        let on = self.median();
        change(self.app.world_mut(), water);
        let changed = self.median();
        undo(self.app.world_mut(), water);
        [on, changed]
    }

    /// Shows the water, or hides it and all that works for it.
    fn show(world: &mut World, water: Entity, on: bool) {
        let mut water = world.entity_mut(water);
        Feature::Interaction.switch(on, &mut water);
        Feature::Reflection.switch(on, &mut water);
        water.insert(if on { Visibility::Inherited } else { Visibility::Hidden });
    }

    /// The same scene with and without water; gives the share of the frame that is not water.
    fn table_of_the_water(&mut self) -> f64 {
        let show = |on| move |world: &mut World, water| Self::show(world, water, on);
        let [on, off] = self.compare(show(false), show(true));
        println!("| scene | frame (ms) | ratio |\n|---|---|---|");
        println!("| all on | {on:.1} | 1.00 |");
        println!("| without water | {off:.1} | {:.2} |", off / on);
        println!("| the water | {:.1} | {:.2} |\n", on - off, 1.0 - off / on);
        off / on
    }

    /// Where the GPU's time goes. Shadow maps, copies and clears are not among the passes.
    fn table_of_passes(&mut self) {
        let on = self.passes();
        Self::show(self.app.world_mut(), self.water, false);
        let off = self.passes();
        Self::show(self.app.world_mut(), self.water, true);
        println!("| pass | all on (ms) | without water (ms) |\n|---|---|---|");
        for (pass, time) in on.iter().filter(|(_, time)| **time > 0.5) {
            println!("| {pass} | {time:.1} | {:.1} |", off.get(pass).unwrap_or(&0.0));
        }
        println!();
    }

    /// One row of a table: the frame and its water, against all on.
    fn row(name: &str, [on, changed]: [f64; 2], dry: f64) {
        let water = (changed / on - dry) / (1.0 - dry);
        println!("| {name} | {changed:.1} | {:.2} | {water:.2} |", changed / on);
    }

    fn table_of_features(&mut self, dry: f64) {
        println!("| off | frame (ms) | frame / all on | water / all on |\n|---|---|---|---|");
        for feature in Feature::ALL {
            // What the river is without, such as ice, is switched on: the water half frozen.
            let is_on = feature.is_on(self.app.world().entity(self.water));
            let switch = |on| move |world: &mut World, water: Entity| feature.switch(on, &mut world.entity_mut(water));
            let times = self.compare(switch(!is_on), switch(is_on));
            let name = if is_on { feature.name().to_owned() } else { format!("{}, added", feature.name()) };
            Self::row(&name, times, dry);
        }
        println!();
    }

    fn table_of_grids(&mut self, dry: f64) {
        println!("| cells of the finest mesh | frame (ms) | frame / all on | water / all on |\n|---|---|---|---|");
        let usual = self.app.world().get::<WaterSurface>(self.water).copied().unwrap_or_default();
        for cells in [12, 16, 32, 64, 128] {
            let set = |cells| {
                move |world: &mut World, water: Entity| {
                    _ = world.entity_mut(water).insert(WaterSurface { cells, ..usual })
                }
            };
            let times = self.compare(set(cells), set(usual.cells));
            Self::row(&format!("{cells}²"), times, dry);
        }
        println!();
    }

    /// Replaces all floating bodies by `count` others.
    fn set_bodies(&mut self, count: usize) {
        let world = self.app.world_mut();
        let floating: Vec<Entity> = world.query_filtered::<Entity, With<Floating>>().iter(world).collect();
        for body in floating {
            world.despawn(body);
        }
        world.resource_scope(|world, bodies: Mut<river::Bodies>| {
            river::strew(&mut world.commands(), &bodies, count, 1);
        });
        world.flush();
    }

    fn table_of_bodies(&mut self) {
        println!("| bodies | frame (ms) | frame / none |\n|---|---|---|");
        for count in [1, 3, 10, 50] {
            self.set_bodies(0);
            let none = self.median();
            self.set_bodies(count);
            let time = self.median();
            println!("| {count} | {time:.1} | {:.2} |", time / none);
        }
    }
}
