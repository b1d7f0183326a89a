//! Every setting of a water under a slider: a beach with a floating box, and the panel (F1 hides and shows it).
mod common;

use bevy::{
    camera::Hdr,
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    core_pipeline::tonemapping::Tonemapping,
    prelude::*,
};
use bevy_freshet::{
    panel::{DropRequested, RestartRequested, WaterPanelPlugin},
    prelude::*,
    sky::{Sky, SkyPlugin, SkyView},
};
use bevy_rapier3d::prelude::*;
use clap::Parser;
use common::{Canvas, Options};
use std::path::Path;

/// Height from which boxes fall at the start, m over the water.
const START: f32 = 1.0;

fn main() -> AppExit {
    let mut app = common::app("bevy_freshet: the panel", &Options::parse());
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/presets");
    app.add_plugins((
        RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(),
        (WaterPlugin, SkyPlugin, FreeCameraPlugin),
        WaterPanelPlugin { presets, actions: true, ..default() },
    ))
    .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
    .add_systems(Startup, (setup, restart).chain())
    .add_systems(Update, (drop_boxes, restart.run_if(on_message::<RestartRequested>)));
    common::run(app)
}

/// What a box is made of.
#[derive(Resource)]
struct Crate {
    mesh: Handle<Mesh>,
    material: Handle<StandardMaterial>,
}

fn setup(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    canvas: Res<Canvas>,
) {
    // A beach that falls by 1 m in 8 m.
    let bed = WaterBed::from_fn(uvec2(121, 121), 0.5, |place| 0.125 * place.y - 0.3);
    let [mud, sand, grass] = ["mud", "sand", "grass"].map(|name| Some(assets.load(format!("textures/{name}.png"))));
    match bed {
        Ok(bed) => _ = commands.spawn((bed, BedShading { mud, sand, grass, ..default() })),
        Err(error) => error!("{error}"),
    }
    commands.spawn((Name::new("Bay"), Water::new(Vec2::splat(60.0)), WaterFlow::uniform(vec2(0.2, 0.0))));
    commands.spawn(Sky { resolution: 256, ..Sky::with_sun(35.0, 120.0) });
    commands.spawn((
        Camera3d::default(),
        (Hdr, Tonemapping::TonyMcMapface),
        (SkyView::default(), FreeCamera::default()),
        canvas.target(),
        Transform::from_xyz(2.0, 2.5, 9.0).looking_at(vec3(-0.5, 0.0, 0.0), Vec3::Y),
    ));
    commands.insert_resource(Crate {
        mesh: meshes.add(Cuboid::from_length(0.8)),
        material: materials.add(Color::srgb(0.72, 0.45, 0.2)),
    });
}

/// Removes all boxes and begins with one.
fn restart(mut commands: Commands, boxes: Query<Entity, With<Floating>>, look: Res<Crate>) {
    for floating in &boxes {
        commands.entity(floating).despawn();
    }
    spawn_box(&mut commands, &look, vec3(0.0, START, 0.0));
}

fn drop_boxes(mut commands: Commands, mut requests: MessageReader<DropRequested>, look: Res<Crate>) {
    for request in requests.read() {
        spawn_box(&mut commands, &look, request.place);
    }
}

fn spawn_box(commands: &mut Commands, look: &Crate, place: Vec3) {
    commands.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(0.4, 0.4, 0.4),
        Floating::with_density(400.0),
        Mesh3d(look.mesh.clone()),
        MeshMaterial3d(look.material.clone()),
        Transform::from_translation(place).with_rotation(Quat::from_rotation_y(0.6)),
    ));
}
