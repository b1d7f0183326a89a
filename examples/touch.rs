//! A pond that answers what touches it: floating bodies, a stirring bar, rain, dye, and your mouse.
//!
//! Left button: push the water. Right button: spill dye. R: rain on and off.
mod common;

use bevy::{camera::Hdr, prelude::*};
use bevy_freshet::{
    prelude::*,
    sky::{Sky, SkyPlugin, SkyView},
};
use bevy_rapier3d::prelude::*;
use clap::Parser;
use common::{Canvas, Options};
use std::f32::consts::FRAC_PI_2;

/// Size of the pond, m.
const POND: Vec2 = Vec2::new(24.0, 18.0);
/// Rain that the key R switches on, mm/h.
const DOWNPOUR: f32 = 30.0;

/// A bar that turns about its upright axis, in rad/s.
#[derive(Component)]
struct Stirrer(f32);

fn main() -> AppExit {
    let options = Options::parse();
    let mut app = common::app("bevy_freshet: touch", &options);
    app.add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin, SkyPlugin))
        .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
        .add_systems(Startup, setup)
        .add_systems(Update, (stir, toggle_rain));
    // Without a window there is no hand to touch the water, so a script does it.
    if options.out.is_some() {
        app.add_systems(Update, act);
    }
    common::run(app)
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    canvas: Res<Canvas>,
) {
    let mut paint = |red, green, blue| materials.add(Color::srgb(red, green, blue));
    let (sand, wood, red, iron) =
        (paint(0.65, 0.58, 0.42), paint(0.6, 0.4, 0.2), paint(0.8, 0.1, 0.1), paint(0.3, 0.3, 0.35));

    // `WaterInteraction` says how finely the pond is simulated: here in cells of 10 cm.
    let interaction = WaterInteraction { cell: 0.1, ..default() };
    commands.spawn((Water::new(POND), WaterWaves::still(), interaction));
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(40.0, 40.0))),
        MeshMaterial3d(sand),
        Transform::from_xyz(0.0, -1.5, 0.0),
    ));

    // Floating bodies disturb the water by themselves: no component is needed for that.
    let bodies: [(Mesh, Collider, f32); 3] = [
        (Cuboid::new(1.2, 0.6, 0.8).into(), Collider::cuboid(0.6, 0.3, 0.4), 400.0),
        (Sphere::new(0.5).mesh().uv(32, 18), Collider::ball(0.5), 300.0),
        (Cylinder::new(0.35, 1.2).into(), Collider::cylinder(0.6, 0.35), 550.0),
    ];
    for (i, (mesh, collider, density)) in bodies.into_iter().enumerate() {
        let mut body = commands.spawn((
            RigidBody::Dynamic,
            collider,
            Floating::with_density(density),
            Mesh3d(meshes.add(mesh)),
            MeshMaterial3d(if i == 1 { red.clone() } else { wood.clone() }),
            Transform::from_xyz(i as f32 * 2.5 - 5.0, 1.0 + i as f32, 2.0 - i as f32 * 1.5),
        ));
        // The ball leaks dye wherever it drifts.
        if i == 1 {
            body.insert(DyesWater { rate: 2e-4, ..DyesWater::of_color(Color::srgb(0.9, 0.1, 0.3)) });
        }
    }

    // What moves without physics, or not at all, says that it disturbs the water.
    commands.spawn((
        DisturbsWater,
        Stirrer(1.2),
        Mesh3d(meshes.add(Cuboid::new(2.4, 1.0, 0.15))),
        MeshMaterial3d(iron.clone()),
        Transform::from_xyz(4.0, 0.0, 0.0),
    ));
    commands.spawn((
        DisturbsWater,
        Mesh3d(meshes.add(Cylinder::new(0.3, 4.0))),
        MeshMaterial3d(iron),
        Transform::from_xyz(-7.0, 0.0, -3.0),
    ));

    commands.spawn(Sky::with_sun(38.0, 215.0));
    // With `WaterTouch` the camera's viewer can reach into the water.
    commands.spawn((
        Camera3d::default(),
        Hdr,
        SkyView { exposure: Some(0.3), ..default() },
        WaterTouch::default(),
        canvas.target(),
        Transform::from_xyz(-1.0, 7.0, 10.0).looking_at(vec3(-0.5, -0.5, 0.0), Vec3::Y),
    ));
}

fn stir(time: Res<Time>, mut stirrers: Query<(&Stirrer, &mut Transform)>) {
    for (stirrer, mut pose) in &mut stirrers {
        pose.rotation = Quat::from_rotation_y(stirrer.0 * time.elapsed_secs());
    }
}

fn toggle_rain(keys: Res<ButtonInput<KeyCode>>, mut waters: Query<&mut WaterInteraction>) {
    if keys.just_pressed(KeyCode::KeyR) {
        for mut interaction in &mut waters {
            interaction.rain = if interaction.rain > 0.0 { 0.0 } else { DOWNPOUR };
        }
    }
}

/// The script: it rains from the second second on, a stone falls in every half second, and ink is spilled along a circle.
fn act(time: Res<Time>, mut disturb: MessageWriter<Disturb>, mut waters: Query<&mut WaterInteraction>) {
    let (before, now) = (time.elapsed_secs() - time.delta_secs(), time.elapsed_secs());
    if before < 1.0 && now >= 1.0 {
        waters.iter_mut().for_each(|mut interaction| interaction.rain = DOWNPOUR);
    }
    let half_seconds = (now * 2.0).floor();
    if half_seconds > (before * 2.0).floor() {
        let place = vec3(7.0 - 2.0 * half_seconds % 9.0, 0.0, 4.0);
        disturb.write(Disturb::push(place, 0.3, 0.12).with_foam(0.2));
    }
    let ink = bevy_freshet::interaction::absorption_from_color(Color::srgb(0.1, 0.2, 0.8), 1e-3);
    let pen = Vec2::from_angle(now * FRAC_PI_2) * 2.5;
    disturb.write(Disturb::dye(vec3(pen.x, 0.0, pen.y), 0.2, ink, 2e-3 * time.delta_secs()));
}
