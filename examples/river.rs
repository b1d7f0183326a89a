//! A real river: checkered balls, crates, logs and a boat float down a meandering channel.
//!
//! `--camera` chooses from `bank`, `bend`, `drift`, `shallows`, `boat`, `above`, `sunset`, `night`.
#[path = "common/banks.rs"]
mod banks;
#[path = "common/bodies.rs"]
mod bodies;
mod common;
#[path = "common/lantern.rs"]
mod lantern;

use bevy::{
    camera::Hdr,
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    core_pipeline::tonemapping::Tonemapping,
    light::CascadeShadowConfigBuilder,
    prelude::*,
    render::view::{ColorGrading, ColorGradingGlobal},
};
use bevy_freshet::{
    buoyancy::{Buoyancy, ReturnTo},
    prelude::*,
    sky::{Moon, Sky, SkyPlugin, SkyView},
    star_filter::{StarFilter, StarFilterPlugin},
};
use bevy_rapier3d::prelude::*;
use bodies::Bodies;
use clap::Parser;
use common::{Canvas, Loading, Options};
use std::path::Path;

/// World height of the river, m above mean sea level.
const LEVEL: f32 = 0.8;
/// Where bodies begin, upstream of the cameras.
const START: Vec2 = Vec2::new(-98.0, 196.0);
/// Where the river leaves the terrain, and a sensor returns bodies to the start.
const END: Vec2 = Vec2::new(-2.0, 446.0);
/// Number of bodies without the boat.
const BODIES: usize = 24;

/// A camera and the sun it is seen under.
struct View {
    name: &'static str,
    /// x, height over the water, z; m.
    eye: Vec3,
    target: Vec3,
    /// Elevation and azimuth, degrees.
    sun: (f32, f32),
}

const AFTERNOON: (f32, f32) = (32.0, 215.0);

/// Elevation and azimuth of the full moon, while the sun is down; degrees.
const MOON: (f32, f32) = (19.0, 252.0);

const VIEWS: [View; 8] = [
    View { name: "bank", eye: vec3(-62.0, 2.2, 262.0), target: vec3(-20.0, 0.3, 250.0), sun: AFTERNOON },
    View { name: "bend", eye: vec3(-75.0, 7.5, 232.0), target: vec3(-30.0, -1.0, 262.0), sun: AFTERNOON },
    View { name: "drift", eye: vec3(-40.0, 0.9, 262.0), target: vec3(-18.0, 0.2, 252.0), sun: AFTERNOON },
    View { name: "shallows", eye: vec3(-66.0, 2.6, 240.0), target: vec3(-72.0, -0.8, 246.0), sun: AFTERNOON },
    View { name: "boat", eye: vec3(-32.0, 2.4, 254.0), target: vec3(-23.0, 0.2, 252.0), sun: AFTERNOON },
    View { name: "above", eye: vec3(-30.0, 70.0, 320.0), target: vec3(-20.0, 0.0, 245.0), sun: AFTERNOON },
    View { name: "sunset", eye: vec3(-8.0, 2.0, 244.0), target: vec3(-50.0, 1.5, 261.0), sun: (7.0, 246.0) },
    View { name: "night", eye: vec3(-8.0, 2.0, 244.0), target: vec3(-50.0, 2.2, 261.0), sun: (-40.0, 60.0) },
];

fn main() -> Result<AppExit, Box<dyn std::error::Error>> {
    let options = Options::parse();
    let name = options.camera.clone().unwrap_or_else(|| VIEWS[0].name.into());
    let Some(view) = VIEWS.iter().find(|view| view.name == name) else {
        let names: Vec<_> = VIEWS.iter().map(|view| view.name).collect();
        return Err(format!("there is no camera {name:?}; there are {}", names.join(", ")).into());
    };
    // Terrain and current are read before anything is drawn, so that a missing file is an error and not a dry river.
    let terrain = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/terrain");
    let bed = WaterBed::from_file(terrain.join("tidal_river_2m.asc"))?.filled(LEVEL + 0.4);
    let flow = WaterFlow::from_file(terrain.join("tidal_river_flow.png"))?;

    let mut app = common::app("bevy_freshet: the river", &options);
    app.add_plugins((
        RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(),
        WaterPlugin,
        SkyPlugin,
        StarFilterPlugin,
        FreeCameraPlugin,
    ))
    .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
    .insert_resource(Scene { bed, flow, view })
    .add_systems(Startup, (land, river, light, float).chain());
    if options.out.is_some() {
        app.add_systems(Last, print_table);
    }
    Ok(common::run(app))
}

#[derive(Resource)]
struct Scene {
    bed: WaterBed,
    flow: WaterFlow,
    view: &'static View,
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
fn river(mut commands: Commands, scene: Res<Scene>) {
    commands.spawn((
        Water::new(scene.bed.elevations().extent()),
        WaterOptics::RIVER,
        // A calm afternoon.
        WaterWaves::wind(2.2, 300.0, vec2(0.8, -0.5)).scaled(0.45),
        WaterSurface { ripples: 0.025, ..default() },
        scene.flow.clone(),
        Transform::from_xyz(0.0, LEVEL, 0.0),
    ));
    // Who arrives at the end begins anew.
    commands.spawn((
        Collider::cuboid(24.0, 4.0, 3.0),
        ReturnTo::new(vec3(START.x, LEVEL + 0.3, START.y)).with_spread(4.0),
        Transform::from_xyz(END.x, LEVEL, END.y),
    ));
}

/// Sky, sun and camera.
fn light(mut commands: Commands, scene: Res<Scene>, canvas: Res<Canvas>) {
    let cascades = CascadeShadowConfigBuilder {
        num_cascades: 2,
        maximum_distance: 90.0 + 2.0 * scene.view.eye.y,
        first_cascade_far_bound: 22.0,
        ..default()
    };
    let (elevation, azimuth) = scene.view.sun;
    let moon = (elevation < 0.0).then(|| Moon::full(MOON.0, MOON.1));
    commands.spawn((Sky { moon, ..Sky::with_sun(elevation, azimuth) }, cascades.build()));
    let mut camera = commands.spawn((
        Camera3d::default(),
        (Hdr, Tonemapping::TonyMcMapface),
        SkyView { visibility: Some(2500.0), exposure: Some(0.3) },
        canvas.target(),
        FreeCamera::default(),
        Transform::from_translation(scene.view.eye + Vec3::Y * LEVEL)
            .looking_at(scene.view.target + Vec3::Y * LEVEL, Vec3::Y),
    ));
    if elevation < 0.0 {
        // The glare of lantern and moon, and what the eye makes of colours in the dark: paler and bluer (Purkinje 1825).
        let global = ColorGradingGlobal { temperature: -0.1, tint: 0.06, post_saturation: 0.75, ..default() };
        camera.insert((
            StarFilter { intensity: 0.2, threshold: 8.0, limit: 60.0, length: 0.06, ..default() },
            ColorGrading { global, ..default() },
        ));
    } else if elevation < 15.0 {
        camera.insert(StarFilter { intensity: 1.5, threshold: 60.0, limit: 400.0, length: 0.07, ..default() });
    }
}

/// The bodies, strewn along the stretch that the cameras see.
fn float(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
    options: Res<Options>,
    scene: Res<Scene>,
) {
    let bodies = Bodies::new(&assets, &mut meshes, &mut materials, &mut images);
    // The middle of the channel from the start round the first bend.
    let channel =
        [START, vec2(-88.0, 226.0), vec2(-70.0, 250.0), vec2(-42.0, 259.0), vec2(-14.0, 249.0), vec2(8.0, 226.0)];
    let mut random = fastrand::Rng::with_seed(options.seed);
    for i in 0..BODIES {
        let along = (i as f32 + 0.5) / BODIES as f32 * (channel.len() - 1) as f32;
        let (from, share) = (along as usize, along.fract());
        let place = channel[from].lerp(channel[from + 1], share) + vec2(random.f32() - 0.5, random.f32() - 0.5) * 8.0;
        let turn = Quat::from_rotation_y(random.f32() * std::f32::consts::TAU);
        bodies.spawn(&mut commands, i, Transform::from_xyz(place.x, LEVEL + 0.2, place.y).with_rotation(turn));
    }
    let moored = Transform::from_xyz(-24.0, LEVEL + 0.1, 253.0).with_rotation(Quat::from_rotation_y(-0.9));
    let boat = bodies.spawn_boat(&mut commands, moored);
    if scene.view.sun.0 < 0.0 {
        let mast = Transform::from_xyz(0.0, -0.1, -1.2);
        let lantern = lantern::spawn_lantern(&mut commands, &mut meshes, &mut materials, mast, 1.5);
        commands.entity(boat).add_child(lantern);
    }
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
