//! The least it takes: water, and a box that floats on it.
mod common;

use bevy::{camera::Hdr, prelude::*};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use clap::Parser;
use common::{Canvas, Options};

fn main() -> AppExit {
    let mut app = common::app("bevy_freshet: minimal", &Options::parse());
    // Physics runs in the fixed schedule, where the water hands it its forces.
    app.add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin))
        .insert_resource(ClearColor(Color::srgb(0.55, 0.75, 0.95)))
        .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
        .add_systems(Startup, setup);
    common::run(app)
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    canvas: Res<Canvas>,
) {
    // Water of 600 m × 600 m, two metres above the origin.
    commands.spawn((Water::new(vec2(600.0, 600.0)), WaterOptics::RIVER, Transform::from_xyz(0.0, 2.0, 0.0)));

    // A crate of 400 kg/m³: two fifths of it are under water when it has come to rest.
    commands.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(0.5, 0.5, 0.5),
        Floating::with_density(400.0),
        Mesh3d(meshes.add(Cuboid::from_length(1.0))),
        MeshMaterial3d(materials.add(Color::srgb(0.72, 0.45, 0.2))),
        Transform::from_xyz(0.0, 4.0, 0.0).with_rotation(Quat::from_rotation_y(0.6)),
    ));

    commands.spawn((
        DirectionalLight { illuminance: 20_000.0, shadow_maps_enabled: true, ..default() },
        Transform::from_xyz(3.0, 5.0, -4.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Camera3d::default(),
        Hdr,
        canvas.target(),
        Transform::from_xyz(-3.0, 4.0, 6.0).looking_at(vec3(0.0, 2.0, 0.0), Vec3::Y),
    ));
}
