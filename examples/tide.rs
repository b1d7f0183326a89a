//! The tide comes in over a marsh: a range of 3.1 m and a period of 12.4 h, shown in two minutes.
mod common;

use bevy::{camera::Hdr, light::CascadeShadowConfigBuilder, prelude::*};
use bevy_freshet::prelude::*;
use clap::Parser;
use common::{Canvas, Loading, Options};

/// Mean level of the sea, m above the terrain's zero.
const SEA: f32 = 0.0;
/// Time between two high waters, s.
const PERIOD: f32 = 12.4 * 3600.0;
/// Time in which one is shown, s.
const SHOWN: f32 = 120.0;

fn main() -> AppExit {
    let mut app = common::app("bevy_freshet: tide", &Options::parse());
    app.add_plugins((WaterPlugin, SkyPlugin)).add_systems(Startup, setup);
    #[cfg(feature = "panel")]
    app.add_plugins(bevy_freshet::panel::WaterPanelPlugin::default());
    common::run(app)
}

fn setup(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut loading: ResMut<Loading>,
    canvas: Res<Canvas>,
    options: Res<Options>,
) {
    // The ground: a tidal river and its marsh, 600 m × 904 m.
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/terrain/tidal_river_2m.asc");
    let bed = WaterBed::from_file(file).unwrap_or_else(|problem| common::fail(problem)).filled(2.0);
    let size = bed.elevations().extent();
    let [mud, sand, grass] = ["mud", "sand", "grass"].map(|name| assets.load(format!("textures/{name}.png")));
    loading.0.extend([&mud, &sand, &grass].map(|texture| texture.clone().untyped()));
    commands.spawn((
        bed,
        BedShading { level: SEA + 0.8, mud: Some(mud), sand: Some(sand), grass: Some(grass), ..default() },
    ));

    // All of it is simulated in cells of 4 m, from half tide on. In the south the sea rises and falls.
    let period = f64::from(PERIOD);
    // In a picture the frames that were asked for show a quarter of it: high water.
    let shown = if options.out.is_some() { 4.0 * options.frames as f32 * common::FRAME as f32 } else { SHOWN };
    let tide = Series::Tide { mean: 0.0, amplitude: 1.55, period, high_water: 0.25 * period };
    commands.spawn((
        Water::new(size),
        WaterSimulation { cell_size: 4.0, speed: PERIOD / shown, max_steps: 4096, ..default() },
        WaterEdges { parts: vec![WaterEdge::all(DomainSide::South, Edge::Level(tide))], ..default() },
        WaterOptics::RIVER,
        WaterFoam { amount: 0.0, ..default() },
        Transform::from_xyz(0.0, SEA, 0.0),
    ));

    // The sky lights the scene; its sun casts shadows.
    let cascades = CascadeShadowConfigBuilder { maximum_distance: 250.0, ..default() }.build();
    commands.spawn((Sky::default(), DirectionalLight { shadow_maps_enabled: true, ..default() }, cascades));
    commands.spawn((
        Camera3d::default(),
        Hdr,
        canvas.target(),
        SkyView::default(),
        Transform::from_xyz(-60.0, 60.0, 400.0).looking_at(vec3(-20.0, 0.0, 250.0), Vec3::Y),
    ));
}
