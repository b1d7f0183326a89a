//! A real river: checkered balls, crates, logs and a boat float down a meandering channel.
//!
//! `--flow simulated` begins with a dry bed, which fills; `--flow sluice` with a full valley behind a dike, whose sluice floods the
//! plain below.
//!
//! With the feature `panel` every setting has a slider: F1 hides and shows them.
//!
//! `--camera` chooses from `bank`, `bend`, `drift`, `shallows`, `boat`, `above`, `sluice`, `bridge`, `noon`, `sunset`, `night`, `frost`
//! and `ice`.
mod common;
#[path = "common/river.rs"]
mod river;
#[cfg(feature = "panel")]
#[path = "common/river_panel.rs"]
mod river_panel;

use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use clap::Parser;
use common::Options;

#[derive(Parser)]
struct RiverOptions {
    #[command(flatten)]
    options: Options,
    /// Where the current comes from.
    #[arg(long, value_enum, default_value_t)]
    flow: river::Flow,
}

fn main() -> AppExit {
    let RiverOptions { options, flow } = RiverOptions::parse();
    let mut app = river::app(&options, flow).unwrap_or_else(|problem| common::fail(problem));
    #[cfg(feature = "panel")]
    app.add_plugins(river_panel::plugin);
    if options.out.is_some() {
        app.add_systems(Last, print_table);
    }
    common::run(app)
}

/// After the last frame: where each body is, how fast, and how deep in the water.
fn print_table(
    mut frame: Local<u32>,
    time: Res<Time>,
    options: Res<Options>,
    bodies: Query<(&Name, &Transform, &Velocity, &Buoyancy)>,
) {
    *frame += u32::from(!time.delta().is_zero());
    if *frame != options.frames || time.delta().is_zero() {
        return;
    }
    println!("{:<10} {:>24} {:>12} {:>10}", "body", "position (m)", "speed (m/s)", "draft (m)");
    for (name, pose, velocity, buoyancy) in &bodies {
        let Vec3 { x, y, z } = pose.translation;
        let speed = velocity.linear.length();
        println!("{name:<10} {x:>8.2}{y:>8.2}{z:>8.2} {speed:>12.2} {:>10.2}", buoyancy.draft);
    }
}
