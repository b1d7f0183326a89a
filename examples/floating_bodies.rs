//! Every shape that floats, on a gentle sea: change their density with the arrow keys (or, with the feature `panel`, by a slider).
//!
//! G shows waterlines, forces, centres of buoyancy and metacentres.
//!
//! A hull is cut by the water triangle by triangle, so each body lies as deep and as level as Archimedes wants it: the cube
//! turns a corner up, the cone points down or up by its density, and the ring stays flat.
mod common;

use bevy::{
    camera::Hdr,
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    prelude::*,
};
use bevy_freshet::{
    prelude::*,
    sky::{Sky, SkyPlugin, SkyView},
};
use bevy_rapier3d::prelude::*;
use clap::Parser;
use common::{Canvas, Options};

/// What all single bodies weigh, kg/m³.
#[derive(Resource, Clone, Copy, PartialEq)]
struct Density(f32);

fn main() -> AppExit {
    let mut app = common::app("bevy_freshet: floating bodies", &Options::parse());
    app.add_plugins((
        RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(),
        WaterPlugin,
        SkyPlugin,
        FreeCameraPlugin,
    ))
    .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
    .insert_resource(Density(500.0))
    .add_systems(Startup, (setup, spawn_shapes, spawn_rafts))
    .add_systems(Update, (press_keys, weigh.run_if(resource_changed::<Density>)).chain())
    .add_systems(Update, show_forces);
    #[cfg(feature = "panel")]
    app.add_plugins(bevy_freshet::panel::WaterPanelPlugin::default())
        .add_systems(bevy_egui::EguiPrimaryContextPass, slide);
    common::run(app)
}

fn setup(mut commands: Commands, canvas: Res<Canvas>) {
    let swell = WaterWaves::wind(4.0, 500.0, vec2(0.3, 1.0));
    commands.spawn((Water::new(Vec2::splat(400.0)), swell, WaterOptics::TROPICAL));
    commands.spawn((Sky::with_sun(30.0, 160.0), DirectionalLight { shadow_maps_enabled: true, ..default() }));
    commands.spawn((
        (Camera3d::default(), Hdr, SkyView::default(), FreeCamera::default()),
        canvas.target(),
        Transform::from_xyz(0.0, 2.6, 8.5).looking_at(vec3(0.0, 0.7, -1.5), Vec3::Y),
    ));
}

/// Shapes of Rapier, and a ring, whose hull is its closed mesh.
fn spawn_shapes(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    density: Res<Density>,
) {
    let bow = [(-1.1, 0.35), (0.6, 0.35), (1.3, 0.0), (0.6, -0.35), (-1.1, -0.35)];
    let boat: Vec<Vec3> = bow.iter().flat_map(|&(x, z)| [vec3(x, 0.3, z), vec3(0.8 * x, -0.3, 0.4 * z)]).collect();
    let bodies: [(Mesh, Option<Collider>); 8] = [
        (Sphere::new(0.5).mesh().ico(12).expect("few enough triangles"), Some(Collider::ball(0.5))),
        (Cuboid::from_length(0.9).into(), Some(Collider::cuboid(0.45, 0.45, 0.45))),
        (Cuboid::new(1.2, 0.4, 0.7).into(), Some(Collider::cuboid(0.6, 0.2, 0.35))),
        (Cylinder::new(0.4, 0.9).into(), Some(Collider::cylinder(0.45, 0.4))),
        (Capsule3d::new(0.3, 0.9).into(), Some(Collider::capsule_y(0.45, 0.3))),
        (Cone::new(0.5, 1.0).into(), Some(Collider::cone(0.5, 0.5))),
        (Torus::new(0.3, 0.7).into(), None),
        (mesh_of(&boat), Collider::convex_hull(&boat)),
    ];
    for (k, (mesh, collider)) in bodies.into_iter().enumerate() {
        let (column, row) = (k % 4, k / 4);
        let body = (
            RigidBody::Dynamic,
            Floating::with_density(density.0),
            Single,
            Mesh3d(meshes.add(mesh)),
            MeshMaterial3d(materials.add(Color::hsl(45.0 * k as f32, 0.65, 0.5))),
            Transform::from_xyz(2.2 * column as f32 - 3.3, 1.0, 1.6 - 2.4 * row as f32),
        );
        let mut body = commands.spawn(body);
        if let Some(collider) = collider {
            body.insert(collider);
        }
    }
}

/// A body whose density changes.
#[derive(Component)]
struct Single;

/// A chain of rafts, hinged to each other: joints and water act together.
fn spawn_rafts(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (mesh, wood) = (meshes.add(Cuboid::new(1.3, 0.16, 1.0)), materials.add(Color::srgb(0.6, 0.42, 0.22)));
    let mut last: Option<Entity> = None;
    for k in 0..6 {
        let raft = commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.65, 0.08, 0.5),
            Floating::with_density(400.0),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(wood.clone()),
            Transform::from_xyz(1.4 * k as f32 - 3.5, 0.2, -3.6),
        ));
        let raft = raft.id();
        if let Some(before) = last {
            let hinge = RevoluteJointBuilder::new(Vec3::Z)
                .local_anchor1(vec3(0.7, 0.0, 0.0))
                .local_anchor2(vec3(-0.7, 0.0, 0.0));
            commands.entity(raft).insert(ImpulseJoint::new(before, hinge));
        }
        last = Some(raft);
    }
}

/// The mesh of the convex hull of some points.
fn mesh_of(points: &[Vec3]) -> Mesh {
    let (vertices, triangles) = bevy_rapier3d::parry::transformation::convex_hull(points);
    Mesh::new(bevy::mesh::PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vertices)
        .with_inserted_indices(bevy::mesh::Indices::U32(triangles.into_flattened()))
        .with_duplicated_vertices()
        .with_computed_flat_normals()
}

fn press_keys(keys: Res<ButtonInput<KeyCode>>, time: Res<Time>, mut density: ResMut<Density>) {
    let way = f32::from(keys.pressed(KeyCode::ArrowUp)) - f32::from(keys.pressed(KeyCode::ArrowDown));
    if way != 0.0 {
        density.0 = (density.0 + 300.0 * way * time.delta_secs()).clamp(20.0, 1500.0);
    }
}

fn show_forces(keys: Res<ButtonInput<KeyCode>>, mut gizmos: ResMut<GizmoConfigStore>) {
    if keys.just_pressed(KeyCode::KeyG) {
        let shown = gizmos.config_mut::<BuoyancyGizmos>().1;
        shown.draw_all = !shown.draw_all;
    }
}

fn weigh(density: Res<Density>, mut bodies: Query<&mut Floating, With<Single>>) {
    for mut floating in &mut bodies {
        floating.weight = Weight::Density(density.0);
    }
}

#[cfg(feature = "panel")]
fn slide(mut contexts: bevy_egui::EguiContexts, mut density: ResMut<Density>) -> Result {
    use bevy_egui::egui;
    let mut value = density.0;
    egui::Window::new("Bodies").show(contexts.ctx_mut()?, |ui| {
        ui.add(egui::Slider::new(&mut value, 20.0..=1500.0).text("density, kg/m³"));
    });
    density.set_if_neq(Density(value));
    Ok(())
}
