//! A bend of a river that freezes from its banks and thaws again, while a current runs in its middle.
//!
//! `--camera` chooses from `bank`, `above`, `close`; `--freezing 0.5` holds the winter at its half.
mod common;

use bevy::{camera::Hdr, core_pipeline::tonemapping::Tonemapping, light::CascadeShadowConfigBuilder, prelude::*};
use bevy_freshet::{
    prelude::*,
    sky::{Sky, SkyPlugin, SkyView},
};
use clap::Parser;
use common::{Canvas, Options};
use freshet_hydro::{grid::Grid, noise::fractal_noise};
use std::f32::consts::TAU;

/// Width of the water, m.
const WIDTH: f32 = 30.0;
/// Depth of its middle, m.
const DEPTH: f32 = 2.2;
/// Time in which the river freezes over, s.
const WINTER: f32 = 20.0;

/// Eye and target, m.
const CAMERAS: [(&str, Vec3, Vec3); 3] = [
    ("bank", vec3(-3.0, 3.4, 36.0), vec3(8.0, 0.0, 0.0)),
    ("above", vec3(-24.0, 32.0, 46.0), vec3(4.0, 0.0, 4.0)),
    ("close", vec3(1.0, 1.6, 24.0), vec3(5.0, 0.0, 15.0)),
];

#[derive(Parser)]
struct Command {
    #[command(flatten)]
    options: Options,
    /// Holds the winter here, 0…1, instead of letting it come and go.
    #[arg(long)]
    freezing: Option<f32>,
}

fn main() -> AppExit {
    let command = Command::parse();
    let mut app = common::app("bevy_freshet: ice", &command.options);
    app.add_plugins((WaterPlugin, SkyPlugin)).add_systems(Startup, setup);
    match command.freezing {
        Some(share) => app.add_systems(PostStartup, move |mut ice: Single<&mut WaterIce>| ice.freezing = share),
        None => app.add_systems(Update, freeze),
    };
    common::run(app)
}

/// Distance from the middle of the river, m: it winds about the z axis.
fn across(place: Vec2) -> f32 {
    place.x - 14.0 * (place.y / 160.0 * TAU).sin()
}

/// Elevation of the ground, m; the water's level is 0.
fn ground(place: Vec2) -> f32 {
    let uneven = fractal_noise(place / 11.0, UVec2::splat(1 << 16), 4, 3);
    let from_bank = across(place).abs() - 0.5 * WIDTH - 2.0 * uneven;
    // A bowl below the water, and banks that rise to low hills.
    let bed = DEPTH * ((from_bank / (0.5 * WIDTH) + 1.0).powi(2) - 1.0);
    let land = 2.6 * (from_bank / 5.0).tanh() + 0.05 * from_bank.max(0.0);
    if from_bank < 0.0 { bed } else { land + 0.25 * uneven }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    options: Res<Options>,
    canvas: Res<Canvas>,
) {
    let bed = WaterBed::from_fn(uvec2(320, 320), 0.75, ground).expect("the formula gives elevations");
    let size = bed.elevations().extent();
    // Fastest in the middle, along the bend.
    let velocity = |place: Vec2| {
        let speed = 1.0 * (1.0 - (across(place) / (0.5 * WIDTH)).powi(2)).max(0.0);
        vec2(14.0 / 160.0 * TAU * (place.y / 160.0 * TAU).cos(), 1.0).normalize() * speed
    };
    let cells = Grid::from_fn(uvec2(120, 120), 2.0, |cell| cell).expect("it has cells");
    let flow =
        WaterFlow::from_map(Grid::from_fn(uvec2(120, 120), 2.0, |c| velocity(cells.position(c))).expect("as above"));

    if let Some(mut mesh) = bed.mesh(0..320, 0..320) {
        // Snow on gravel.
        let color = |height: f32| Vec4::from_array([0.05, 0.045, 0.04, 1.0]).lerp(Vec4::ONE, height);
        let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION).and_then(|positions| positions.as_float3());
        let colors = positions
            .map(|p| p.iter().map(|p| color((p[1] * 10.0 + 1.5).clamp(0.0, 1.0)).to_array()).collect::<Vec<_>>());
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors.unwrap_or_default());
        let snowy =
            StandardMaterial { base_color: Color::srgb(0.86, 0.88, 0.91), perceptual_roughness: 0.95, ..default() };
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(materials.add(snowy))));
    }
    commands.spawn(bed);
    commands.spawn((
        Water::new(size),
        WaterOptics::RIVER,
        WaterWaves::wind(2.2, 300.0, vec2(0.4, 1.0)).scaled(0.5),
        WaterSurface { ripples: 0.03, ..default() },
        WaterIce::frozen(0.0),
        WaterFoam { amount: 0.4, ..default() },
        flow,
    ));
    plant(&mut commands, &mut meshes, &mut materials, options.seed);

    let name = options.camera.as_deref().unwrap_or("bank");
    let camera = CAMERAS.iter().find(|camera| camera.0 == name);
    let &(_, eye, target) = camera.unwrap_or_else(|| common::fail("the cameras are bank, above and close"));
    let shadows = CascadeShadowConfigBuilder { num_cascades: 2, maximum_distance: 120.0, ..default() };
    commands.spawn((Sky::with_sun(16.0, 235.0), shadows.build()));
    commands.spawn((
        Camera3d::default(),
        (Hdr, Tonemapping::TonyMcMapface),
        SkyView { visibility: Some(1500.0), exposure: Some(0.3) },
        canvas.target(),
        Transform::from_translation(eye).looking_at(target, Vec3::Y),
    ));
}

/// Bare firs on the banks, so that there is something to mirror.
fn plant(commands: &mut Commands, meshes: &mut Assets<Mesh>, materials: &mut Assets<StandardMaterial>, seed: u64) {
    let fir = meshes.add(Cone { radius: 1.0, height: 1.0 });
    let green = materials.add(StandardMaterial {
        base_color: Color::srgb(0.09, 0.13, 0.11),
        perceptual_roughness: 1.0,
        ..default()
    });
    let mut random = fastrand::Rng::with_seed(seed);
    for _ in 0..260 {
        let place = vec2(random.f32() - 0.5, random.f32() - 0.5) * 220.0;
        let height = 5.0 + 6.0 * random.f32();
        if across(place).abs() < 0.5 * WIDTH + 7.0 {
            continue;
        }
        for (from, width) in [(0.1, 0.24), (0.35, 0.19), (0.6, 0.13)] {
            let middle = ground(place) + height * (from + 0.2);
            commands.spawn((
                Mesh3d(fir.clone()),
                MeshMaterial3d(green.clone()),
                Transform::from_xyz(place.x, middle, place.y).with_scale(vec3(
                    width * height,
                    0.4 * height,
                    width * height,
                )),
            ));
        }
    }
}

/// Lets the winter come and go.
fn freeze(time: Res<Time>, mut ice: Single<&mut WaterIce>) {
    ice.freezing = 1.0 - (1.0 - time.elapsed_secs() / WINTER % 2.0).abs();
}
