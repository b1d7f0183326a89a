//! A flood of a hydraulic model, played back over its terrain: as water, or coloured by depth, speed, arrival or danger.
//!
//! `flood [DIR]` plays a folder that `freshet-flood convert` made, without one the flood in `assets/flood/played`. `--out` draws
//! a picture, `--film` a film. `--camera` chooses from `slope`, `top` and `plain`, or reads keyframes from a file that ends in
//! `.ron`; K records such in a window. A click on the ground, or `--mark`, shows the depth there over time; F flies.
#[path = "../common/mod.rs"]
mod common;

mod cameras;
mod drape;
mod film;
mod gauges;
mod hover;
mod land;
mod overlay;
mod paint;
mod relief;
mod steering;
mod terrain;
#[cfg(test)]
mod tests;
mod texture;
mod timeline;
mod viewer;
mod world_file;

use bevy::{
    camera::Hdr, core_pipeline::tonemapping::Tonemapping, light::CascadeShadowConfigBuilder, math::DVec2, prelude::*,
};
use bevy_egui::{EguiPrimaryContextPass, PrimaryEguiContext};
use bevy_freshet::{
    flood::FloodMaps,
    panel::{OrbitCamera, WaterPanelPlugin},
    prelude::*,
};
use cameras::CameraPath;
use clap::Parser;
use common::{Canvas, Options};
use drape::Georeferenced;
use film::{Output, Plan};
use freshet_flood::flow_map::MOST_CELLS;
use gauges::GaugesPlugin;
use paint::PaintPlugin;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};
use viewer::{Coloring, Viewer};

/// Most frames of a film: nine hours at 30 in a second.
const MOST_FRAMES: usize = 1_000_000;

/// Plays back a flood: in a window, or, with --out or --film, into pictures.
#[derive(Parser, Resource, Clone, Debug)]
#[command(about = "Plays back a flood: in a window, or, with --out or --film, into pictures")]
struct Arguments {
    /// Folder of a converted flood. Without it the one in assets/flood/played.
    folder: Option<PathBuf>,
    /// Time in the data at which it begins, or of the picture: 90, 30min, 1.5h.
    #[arg(long, value_parser = freshet_flood::duration::time, allow_hyphen_values = true)]
    at: Option<f64>,
    /// How the water is shown.
    #[arg(long, value_enum, default_value_t)]
    color: Coloring,
    /// Factor on all heights.
    #[arg(long, default_value_t = 2.0, value_parser = exaggeration)]
    exaggeration: f32,
    /// Image of the ground, a PNG or JPEG: over all of it, or where its world file (.pgw, .jgw, .wld) says.
    #[arg(long)]
    image: Option<PathBuf>,
    /// Most pixels by which the drawn ground may be off, as far as eight million triangles go; at 0 they are all spent.
    #[arg(long, default_value_t = 0.5, value_parser = pixels)]
    tolerance: f32,
    /// Seconds of the flood in a second.
    #[arg(long, default_value_t = 60.0, value_parser = factor)]
    speed: f32,
    /// Write a film: a video (film.mp4), an animated picture (film.gif), or a picture for each frame (film/%05d.png).
    ///
    /// Videos are AV1 in MP4, in BT.709 and at least 16 pixels wide and high, with a frame to go to every 2 s; players since about 2020
    /// know AV1. A film that ends early, by an error or by Ctrl-C, leaves no file, but the pictures that are done.
    #[arg(long, value_parser = Output::film, conflicts_with = "out")]
    film: Option<Output>,
    /// Frames in a second of the film.
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=100), requires = "film", conflicts_with = "out")]
    fps: u32,
    /// Time in the data at which the film begins.
    #[arg(long, value_parser = freshet_flood::duration::time, allow_hyphen_values = true, requires = "film", conflicts_with = "out")]
    from: Option<f64>,
    /// Time in the data at which the film ends.
    #[arg(long, value_parser = freshet_flood::duration::time, allow_hyphen_values = true, requires = "film", conflicts_with = "out")]
    to: Option<f64>,
    /// Show the depth over time at a place of the map: easting and northing, E,N. For more places again.
    #[arg(long, value_name = "E,N", value_parser = gauges::place, allow_hyphen_values = true)]
    mark: Vec<DVec2>,
    #[command(flatten)]
    options: Options,
}

/// A number from a tenth, so that wet cells keep more than a millimetre, to a hundred.
fn exaggeration(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| (0.1..=100.0).contains(number));
    number.ok_or_else(|| format!("expected a number from 0.1 to 100, found {text:?}"))
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
    let (mut app, plan) = viewer_of(Arguments::parse());
    if let Some(plan) = plan {
        return film::run(app, &plan);
    }
    app.add_plugins(steering::SteeringPlugin)
        .add_systems(Update, (timeline::keys, cameras::pan, cameras::record))
        .add_systems(EguiPrimaryContextPass, (timeline::draw, hover::tell).after(overlay::draw));
    common::run(app)
}

/// The viewer, and what is to be drawn if it is without a window.
fn viewer_of(arguments: Arguments) -> (App, Option<Plan>) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/played");
    let folder = arguments.folder.clone().unwrap_or(sample);
    let maps = Arc::new(FloodMaps::open(folder).unwrap_or_else(|problem| common::fail(problem)));
    let viewer =
        Viewer::new(maps, arguments.color, arguments.exaggeration).unwrap_or_else(|problem| common::fail(problem));
    let (first, last) = (viewer.maps.times()[0], viewer.maps.times()[viewer.maps.times().len() - 1]);
    for (option, time) in [("--at", arguments.at), ("--from", arguments.from), ("--to", arguments.to)] {
        if let Some(time) = time.filter(|time| !(first..=last).contains(time)) {
            common::fail(format!("{option}: expected a time of the flood, {first} s to {last} s, found {time} s"));
        }
    }
    if let (Some(from), Some(to)) = (arguments.from, arguments.to)
        && from > to
    {
        common::fail("a film ends (--to) after it begins (--from)");
    }
    let size = viewer.terrain.size();
    if size.max_element() > MOST_CELLS {
        common::fail(format!("expected a flood of at most {MOST_CELLS} columns and rows, found {size}"));
    }
    let image = arguments.image.as_deref().map(|path| {
        let read = Georeferenced::read(path, viewer.maps.georeference());
        read.unwrap_or_else(|problem| common::fail(problem))
    });
    let plan = plan(&arguments, &viewer.maps);
    if let Some(frames) = plan.as_ref().map(Plan::frames).filter(|frames| *frames > MOST_FRAMES) {
        common::fail(format!(
            "expected a film of at most {MOST_FRAMES} frames, found {frames}: --speed makes it shorter"
        ));
    }
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
    let gauges = GaugesPlugin { places: arguments.mark.clone(), is_headless: plan.is_some() };
    app.insert_resource(viewer)
        .insert_resource(land::Cover(image))
        .add_plugins((WaterPlugin, SkyPlugin, WaterPanelPlugin { visible: false, ..default() }, gauges, PaintPlugin))
        .insert_resource(arguments)
        .init_resource::<cameras::Recorded>()
        .add_systems(
            Startup,
            (land::setup, play, move |commands: Commands, canvas: Res<Canvas>, viewer: Res<Viewer>| {
                light(commands, canvas, viewer, orbit);
            })
                .chain(),
        )
        .add_systems(Update, (land::exaggerate, land::dress, relief::follow, show_water))
        .add_systems(PostUpdate, terrain::show.before(TransformSystems::Propagate))
        .add_systems(EguiPrimaryContextPass, overlay::draw);
    if let Some(path) = path {
        app.insert_resource(path);
    }
    (app, plan)
}

/// What is drawn without a window, if anything is.
fn plan(arguments: &Arguments, maps: &FloodMaps) -> Option<Plan> {
    let times = maps.times();
    let (first, last) = (times[0], times[times.len() - 1]);
    let film = |output| Plan {
        output,
        from: arguments.from.unwrap_or(first),
        to: arguments.to.unwrap_or(last),
        speed: f64::from(arguments.speed),
        fps: arguments.fps,
        lead: 30,
    };
    let picture = |output| Plan {
        to: arguments.at.unwrap_or(0.5 * (first + last)),
        lead: arguments.options.frames,
        fps: 60,
        ..film(output)
    };
    let out = arguments.options.out.clone().map(|path| picture(Output::Picture(path)));
    out.or_else(|| arguments.film.clone().map(film))
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
