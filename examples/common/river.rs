//! The river scene: real terrain and its current, banks and a bridge, light, and bodies that drift.
#[path = "banks.rs"]
mod banks;
#[path = "bodies.rs"]
mod bodies;
#[path = "bridge.rs"]
mod bridge;
#[path = "lantern.rs"]
mod lantern;
#[path = "sluice.rs"]
mod sluice;
#[path = "views.rs"]
mod views;

use crate::common::{self, Canvas, Loading, Options};
use bevy::{
    camera::Hdr,
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    core_pipeline::tonemapping::Tonemapping,
    light::CascadeShadowConfigBuilder,
    prelude::*,
    render::view::{ColorGrading, ColorGradingGlobal},
};
use bevy_freshet::{
    buoyancy::ReturnTo,
    prelude::*,
    sky::{Moon, Sky, SkyPlugin, SkyView},
    star_filter::{StarFilter, StarFilterPlugin},
};
use bevy_rapier3d::prelude::*;
pub use bodies::Bodies;
use std::path::Path;
use views::View;

/// World height of the river, m above mean sea level.
pub const LEVEL: f32 = 0.8;
/// Where bodies begin, upstream of the cameras.
const START: Vec2 = Vec2::new(-98.0, 196.0);
/// Where the river leaves the terrain, and a sensor returns bodies to the start.
const END: Vec2 = Vec2::new(-2.0, 446.0);
/// Time in a window in which the simulated river comes to rest, s.
const SECONDS: f32 = 60.0;
/// The ends of the footbridge.
const BRIDGE: [Vec2; 2] = [Vec2::new(-107.0, 228.5), Vec2::new(-75.0, 223.0)];
/// Where the boat lies.
const BOAT: Vec2 = Vec2::new(-24.0, 253.0);
/// Number of bodies without the boat.
const BODIES: usize = 24;

/// Where the current of the river comes from.
#[derive(clap::ValueEnum, Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Flow {
    /// A map of the steady current, made beforehand
    #[default]
    Map,
    /// The river is simulated: it begins dry, fills from its spring and from the sea, and finds its own current
    Simulated,
    /// As simulated, but the valley is full behind a dike, whose sluice opens: the plain below is flooded
    Sluice,
}

impl Flow {
    /// Simulated time in which it comes to rest, s.
    fn duration(self) -> f32 {
        if self == Self::Sluice { 900.0 } else { 3600.0 }
    }
}

/// An app with the river, seen as the options say.
///
/// # Errors
/// A camera that there is not; terrain or current that cannot be read.
pub fn app(options: &Options, flow: Flow) -> Result<App, Box<dyn std::error::Error>> {
    let view = View::named(options.camera.as_deref())?;
    // Terrain and current are read before anything is drawn, so that a missing file is an error and not a dry river.
    let terrain = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/terrain");
    let bed = WaterBed::from_file(terrain.join("tidal_river_2m.asc"))?.filled(LEVEL + 0.4);
    let map = WaterFlow::from_file(terrain.join("tidal_river_flow.png"))?;

    let mut app = common::app("bevy_freshet: the river", options);
    app.add_plugins((
        RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(),
        WaterPlugin,
        SkyPlugin,
        StarFilterPlugin,
        FreeCameraPlugin,
    ))
    .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
    .insert_resource(Scene { bed, map, flow, view })
    .add_systems(Startup, (make_bodies, land, river, light, float).chain())
    .add_systems(Update, (slow_down, sluice::open));
    Ok(app)
}

#[derive(Resource)]
struct Scene {
    bed: WaterBed,
    map: WaterFlow,
    flow: Flow,
    view: View,
}

/// The ground, drawn and solid, with its plants and stones.
fn land(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut loading: ResMut<Loading>,
    scene: Res<Scene>,
    options: Res<Options>,
) {
    let [mud, sand, grass] = ["mud", "sand", "grass"].map(|name| assets.load(format!("textures/{name}.png")));
    loading.0.extend([&mud, &sand, &grass].map(|texture| texture.clone().untyped()));
    let shading = BedShading { level: LEVEL, mud: Some(mud), sand: Some(sand), grass: Some(grass), ..default() };
    commands.spawn((scene.bed.clone(), shading, ground_collider(&scene.bed), RigidBody::Fixed));

    let height = |x: f32, z: f32| scene.bed.height(vec2(x, z)).unwrap_or(f32::NAN);
    let site = banks::Site {
        height: &height,
        water_level: LEVEL,
        area: Rect::from_center_size(vec2(-10.0, 240.0), vec2(220.0, 200.0)),
        seed: options.seed,
    };
    banks::spawn_banks(&mut commands, &assets, &mut meshes, &mut materials, &site);
    let footbridge = bridge::Site { ends: BRIDGE, water_level: LEVEL, height: &height };
    bridge::spawn_bridge(&mut commands, &mut meshes, &mut materials, &footbridge);
    if scene.flow == Flow::Sluice {
        sluice::spawn_dike(&mut commands, &mut meshes, &mut materials, LEVEL);
    }
}

/// The bed as a height field: columns of a Rapier height field run along x, rows along z.
fn ground_collider(bed: &WaterBed) -> Collider {
    let grid = bed.elevations();
    let (columns, rows) = (grid.size().x as usize, grid.size().y as usize);
    // Rapier stores columns one after the other.
    let heights = (0..columns).flat_map(|x| (0..rows).map(move |z| (x, z)));
    let heights = heights.map(|(x, z)| grid.values()[z * columns + x]).collect();
    let spacing = grid.cell_size();
    let size = vec3((columns - 1) as f32 * spacing, 1.0, (rows - 1) as f32 * spacing);
    Collider::heightfield(heights, rows, columns, size)
}

/// The water, as large as the terrain.
fn river(mut commands: Commands, scene: Res<Scene>, options: Res<Options>) {
    let mut river = commands.spawn((
        Name::new("river"),
        Water::new(scene.bed.elevations().extent()),
        WaterOptics::RIVER,
        // A calm afternoon.
        WaterWaves::wind(2.2, 300.0, vec2(0.8, -0.5)).scaled(0.45),
        WaterSurface { ripples: 0.025, ..default() },
        Transform::from_xyz(0.0, LEVEL, 0.0),
    ));
    match scene.flow {
        Flow::Map => river.insert(scene.map.clone()),
        Flow::Simulated => river.insert(simulated(&options, scene.flow, SimulationStart::Dry)),
        Flow::Sluice => river.insert((simulated(&options, scene.flow, sluice::start()), sluice::walls())),
    };
    if scene.view.freezing > 0.0 {
        river.insert(WaterIce { freezing: scene.view.freezing, ..default() });
    }
    // Who arrives at the end begins anew.
    commands.spawn((
        Collider::cuboid(24.0, 4.0, 3.0),
        ReturnTo::new(vec3(START.x, LEVEL + 0.3, START.y)).with_spread(4.0),
        Transform::from_xyz(END.x, LEVEL, END.y),
    ));
}

/// The simulated river: 25 m³/s come down from its upper arms, and at its mouth the sea stands at the still level.
fn simulated(options: &Options, flow: Flow, start: SimulationStart) -> impl Bundle {
    let spring = WaterSource { at: vec2(-42.0, -88.0), radius: 10.0, rate: 25.0.into() };
    let mouth = WaterEdge { side: DomainSide::South, from: -24.0, to: 20.0, edge: Edge::Level(0.0.into()) };
    // In a window it is watched; a picture is to show what it comes to.
    let seconds = if options.out.is_some() { options.frames as f32 * common::FRAME as f32 } else { SECONDS };
    let settings = WaterSimulation {
        cell_size: 2.0,
        start,
        speed: (flow.duration() / seconds).max(1.0),
        max_steps: 1024,
        ..default()
    };
    (settings, WaterSources { sources: vec![spring] }, WaterEdges { parts: vec![mouth], ..default() })
}

/// Once the simulated river has come to rest its clock runs as all others do.
fn slow_down(options: Res<Options>, scene: Res<Scene>, mut rivers: Query<(&SimulationState, &mut WaterSimulation)>) {
    let (duration, is_picture) = (scene.flow.duration(), options.out.is_some());
    for (state, mut river) in &mut rivers {
        let has_rested = !is_picture && state.time > duration.into();
        // Only once: what the panel sets afterwards stays.
        if has_rested && river.speed == duration / SECONDS {
            river.speed = 1.0;
        }
    }
}

/// Sky, sun or moon, and the camera.
fn light(mut commands: Commands, scene: Res<Scene>, canvas: Res<Canvas>) {
    let view = scene.view;
    let cascades = CascadeShadowConfigBuilder {
        num_cascades: 2,
        maximum_distance: 90.0 + 2.0 * view.eye.y,
        first_cascade_far_bound: 22.0,
        ..default()
    };
    let (elevation, azimuth) = view.sun;
    let moon = view.is_night().then(|| Moon::full(views::MOON.0, views::MOON.1));
    commands.spawn((Sky { moon, ..Sky::with_sun(elevation, azimuth) }, cascades.build()));
    let mut camera = commands.spawn((
        Camera3d::default(),
        (Hdr, Tonemapping::TonyMcMapface),
        SkyView { visibility: Some(2500.0), exposure: Some(0.3) },
        canvas.target(),
        FreeCamera::default(),
        view.pose(LEVEL),
    ));
    if view.is_night() {
        // The glare of lantern and moon, and what the eye makes of colours in the dark: paler and bluer (Purkinje 1825).
        let global = ColorGradingGlobal { temperature: -0.1, tint: 0.06, post_saturation: 0.75, ..default() };
        camera.insert((
            StarFilter { intensity: 0.2, threshold: 8.0, limit: 60.0, length: 0.06, ..default() },
            ColorGrading { global, ..default() },
        ));
    } else if elevation < 10.0 {
        camera.insert(StarFilter { intensity: 1.5, threshold: 60.0, limit: 400.0, length: 0.07, ..default() });
    }
}

fn make_bodies(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    commands.insert_resource(Bodies::new(&assets, &mut meshes, &mut materials, &mut images));
}

/// The bodies, and a boat with, at night, a lantern.
fn float(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    bodies: Res<Bodies>,
    options: Res<Options>,
    scene: Res<Scene>,
) {
    strew(&mut commands, &bodies, BODIES, options.seed);
    let moored = Transform::from_xyz(BOAT.x, LEVEL + 0.1, BOAT.y).with_rotation(Quat::from_rotation_y(-0.9));
    let boat = bodies.spawn_boat(&mut commands, moored);
    if scene.view.is_night() {
        let mast = Transform::from_xyz(0.0, -0.1, -1.2);
        let lantern = lantern::spawn_lantern(&mut commands, &mut meshes, &mut materials, mast, 1.5);
        commands.entity(boat).add_child(lantern);
    }
}

/// Spawns `count` bodies along the stretch that the cameras see.
pub fn strew(commands: &mut Commands, bodies: &Bodies, count: usize, seed: u64) {
    // The middle of the channel from the start round the first bend.
    let channel =
        [START, vec2(-88.0, 226.0), vec2(-70.0, 250.0), vec2(-42.0, 259.0), vec2(-14.0, 249.0), vec2(8.0, 226.0)];
    let mut random = fastrand::Rng::with_seed(seed);
    for i in 0..count {
        let along = (i as f32 + 0.5) / count as f32 * (channel.len() - 1) as f32;
        let (from, share) = (along as usize, along.fract());
        let place = channel[from].lerp(channel[from + 1], share) + vec2(random.f32() - 0.5, random.f32() - 0.5) * 8.0;
        let turn = Quat::from_rotation_y(random.f32() * std::f32::consts::TAU);
        bodies.spawn(commands, i, Transform::from_xyz(place.x, LEVEL + 0.2, place.y).with_rotation(turn));
    }
}
