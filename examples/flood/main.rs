//! A flood of a hydraulic model, played back over its terrain: as water, or coloured by depth, speed, arrival or danger.
//!
//! `flood [DIR]` plays a folder that `freshet-flood convert` made, without one the flood in `assets/flood/played`. `--out` draws
//! a picture, `--film` a film. `--camera` chooses from `slope`, `top` and `plain`, or reads keyframes from a file that ends in
//! `.ron`; K records such in a window.
#[path = "../common/mod.rs"]
mod common;

mod cameras;
mod drape;
mod headless;
mod hover;
mod land;
mod overlay;
mod paint;
mod relief;
mod terrain;
mod texture;
mod timeline;
mod viewer;
mod world_file;

use bevy::{camera::Hdr, core_pipeline::tonemapping::Tonemapping, light::CascadeShadowConfigBuilder, prelude::*};
use bevy_egui::{EguiPrimaryContextPass, PrimaryEguiContext};
use bevy_freshet::{
    flood::FloodMaps,
    panel::{OrbitCamera, WaterPanelPlugin},
    prelude::*,
};
use cameras::CameraPath;
use clap::Parser;
use common::{Canvas, Options};
use headless::{Output, Plan};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};
use viewer::{Coloring, Viewer};

/// Plays back a flood: in a window, or, with --out or --film, into pictures.
#[derive(Parser, Resource, Clone, Debug)]
#[command(about)]
struct Arguments {
    /// Folder of a converted flood. Without it the one in assets/flood/played.
    folder: Option<PathBuf>,
    /// Time in the data at which it begins, or of the picture: 90, 30min, 1.5h.
    #[arg(long, value_parser = freshet_flood::duration::seconds)]
    at: Option<f64>,
    /// How the water is shown.
    #[arg(long, value_enum, default_value_t)]
    color: Coloring,
    /// Factor on all heights.
    #[arg(long, default_value_t = 2.0, value_parser = factor)]
    exaggeration: f32,
    /// Image of the ground, a PNG or JPEG: over all of it, or where its world file (.pgw, .jgw, .wld) says.
    #[arg(long)]
    image: Option<PathBuf>,
    /// Most pixels by which the drawn ground may be off; 0 draws every cell.
    #[arg(long, default_value_t = 0.5, value_parser = pixels)]
    tolerance: f32,
    /// Seconds of the flood in a second.
    #[arg(long, default_value_t = 60.0, value_parser = factor)]
    speed: f32,
    /// Write a film: a PNG for each frame (film/%05d.png), or a GIF.
    #[arg(long, value_parser = headless::film, conflicts_with = "out")]
    film: Option<Output>,
    /// Frames in a second of the film.
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=100))]
    fps: u32,
    /// Time in the data at which the film begins.
    #[arg(long, value_parser = freshet_flood::duration::seconds)]
    from: Option<f64>,
    /// Time in the data at which the film ends.
    #[arg(long, value_parser = freshet_flood::duration::seconds)]
    to: Option<f64>,
    #[command(flatten)]
    options: Options,
}

/// A number from a hundredth to 10 000.
fn factor(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| (0.01..=1e4).contains(number));
    number.ok_or_else(|| format!("expected a number from 0.01 to 10000, found {text:?}"))
}

/// A number from 0 to 1000.
fn pixels(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| (0.0..=1e3).contains(number));
    number.ok_or_else(|| format!("expected a number from 0 to 1000, found {text:?}"))
}

fn main() -> AppExit {
    let arguments = Arguments::parse();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/played");
    let folder = arguments.folder.clone().unwrap_or(sample);
    let maps = Arc::new(FloodMaps::open(folder).unwrap_or_else(|problem| common::fail(problem)));
    let viewer =
        Viewer::new(maps, arguments.color, arguments.exaggeration).unwrap_or_else(|problem| common::fail(problem));
    if let (Some(from), Some(to)) = (arguments.from, arguments.to)
        && from > to
    {
        common::fail("a film ends (--to) after it begins (--from)");
    }
    let plan = plan(&arguments, &viewer.maps);
    let camera = arguments.options.camera.as_deref();
    let (path, camera) = match camera.filter(|name| name.ends_with(".ron")) {
        Some(file) => (Some(CameraPath::read(file.as_ref()).unwrap_or_else(|problem| common::fail(problem))), None),
        None => (None, camera),
    };
    let orbit = cameras::orbit(camera, &viewer).unwrap_or_else(|problem| common::fail(problem));

    // A film has no window either.
    let mut options = arguments.options.clone();
    options.out = options.out.or(plan.as_ref().map(|_| PathBuf::new()));
    let mut app = common::app("bevy_freshet: flood", &options);
    app.add_plugins((WaterPlugin, SkyPlugin, WaterPanelPlugin { visible: false, ..default() }))
        .insert_resource(viewer)
        .insert_resource(arguments)
        .init_resource::<cameras::Recorded>()
        .add_systems(
            Startup,
            (land::setup, play, move |commands: Commands, canvas: Res<Canvas>, viewer: Res<Viewer>| {
                light(commands, canvas, viewer, orbit);
            })
                .chain(),
        )
        .add_systems(Update, (land::exaggerate, relief::follow, show_water))
        .add_systems(
            PostUpdate,
            (
                paint::paint.after(WaterSystems::Resolve),
                (land::dress, terrain::show).chain().before(TransformSystems::Propagate),
            ),
        )
        .add_systems(EguiPrimaryContextPass, overlay::draw);
    if let Some(path) = path {
        app.insert_resource(path);
    }
    if let Some(plan) = plan {
        return headless::run(app, &plan);
    }
    app.add_systems(Update, (timeline::keys, cameras::pan, cameras::record, follow_path))
        .add_systems(EguiPrimaryContextPass, (timeline::draw, hover::tell).after(overlay::draw));
    common::run(app)
}

/// What is drawn without a window, if anything is.
fn plan(arguments: &Arguments, maps: &FloodMaps) -> Option<Plan> {
    let times = maps.times();
    let (first, last) = (times[0], times[times.len() - 1]);
    let plan = Plan {
        output: Output::Picture(PathBuf::new()),
        from: arguments.from.unwrap_or(first).clamp(first, last),
        to: arguments.to.unwrap_or(last).clamp(first, last),
        speed: f64::from(arguments.speed),
        fps: arguments.fps,
        lead: 30,
    };
    let out = arguments.options.out.clone();
    let picture = |out| Plan {
        output: Output::Picture(out),
        to: arguments.at.unwrap_or(0.5 * (first + last)).clamp(first, last),
        lead: arguments.options.frames,
        fps: 60,
        ..plan.clone()
    };
    out.map(picture).or(arguments.film.clone().map(|output| Plan { output, ..plan.clone() }))
}

/// Sets the flood going.
fn play(arguments: Res<Arguments>, mut flood: Single<&mut Flood>) {
    let is_headless = arguments.options.out.is_some() || arguments.film.is_some();
    flood.time = arguments.at.unwrap_or(flood.time);
    flood.speed = arguments.speed;
    (flood.playing, flood.waits) = (!is_headless, is_headless);
}

/// The sky, its sun, and the camera.
fn light(mut commands: Commands, canvas: Res<Canvas>, viewer: Res<Viewer>, orbit: OrbitCamera) {
    let farthest = 2.5 * viewer.terrain.extent().max_element();
    let cascades = CascadeShadowConfigBuilder { maximum_distance: farthest, ..default() }.build();
    // In the south-west.
    let sky = Sky { sun_azimuth: 4.0, sun_elevation: 0.7, ..default() };
    commands.spawn((sky, DirectionalLight { shadow_maps_enabled: true, ..default() }, cascades));
    commands.spawn((
        Camera3d::default(),
        (Hdr, Msaa::Off, PrimaryEguiContext),
        Projection::Perspective(PerspectiveProjection { far: 20.0 * farthest, ..default() }),
        SkyView { exposure: Some(0.6), ..default() },
        canvas.target(),
        orbit.pose(),
        orbit,
    ));
}

/// Under a colouring the water is not drawn, and colours are those of the legend.
fn show_water(mut commands: Commands, viewer: Res<Viewer>, cameras: Query<(Entity, Has<NoWater>), With<OrbitCamera>>) {
    for (camera, without) in &cameras {
        match viewer.coloring {
            Coloring::Water if without => {
                commands.entity(camera).remove::<NoWater>().insert(Tonemapping::default());
            }
            Coloring::Water => {}
            _ if !without => _ = commands.entity(camera).insert((NoWater, Tonemapping::None)),
            _ => {}
        }
    }
}

/// In a window a path leads the camera while the flood is played.
fn follow_path(
    path: Option<Res<CameraPath>>,
    flood: Single<&Flood>,
    mut cameras: Query<(&mut Transform, &mut OrbitCamera)>,
) {
    let Some(path) = path else { return };
    for (mut pose, mut orbit) in &mut cameras {
        orbit.enabled = !flood.playing;
        if flood.playing {
            *pose = path.at(flood.usable_time());
        }
    }
}
