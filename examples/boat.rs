//! A boat to drive: W and S (or the arrows up and down) are the throttle, A and D (left and right) the rudder, R begins anew.
//!
//! Nothing tells the boat where to go. Its propeller pushes it at a place below the stern and its rudder is a foil in the stream
//! behind; with the water's push and resistance on the hull it gathers way, heels and slides through its turns.
//! Without a window (`--out`) a script is at the helm: `--frames 310` is in the middle of its first turn.
#[path = "common/boat.rs"]
mod boat;
#[path = "common/boat_mesh.rs"]
mod boat_mesh;
mod common;

use bevy::{camera::Hdr, light::CascadeShadowConfigBuilder, prelude::*};
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use boat::Helm;
use clap::Parser;
use common::{Canvas, Options};

/// Where the boat starts, m, a little above its draft.
const START: Transform = Transform::from_xyz(0.0, 0.3, 0.0);

fn main() -> AppExit {
    let options = Options::parse();
    let mut app = common::app("bevy_freshet: boat", &options);
    app.add_plugins((RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(), WaterPlugin, SkyPlugin))
        .insert_resource(TimestepMode::Fixed { dt: common::FRAME as f32, substeps: 1 })
        .add_systems(Startup, (setup, spawn_boat, spawn_buoys))
        // Before Rapier takes over what has changed, so that forces act in this step.
        .add_systems(FixedUpdate, boat::drive.before(PhysicsSet::SyncBackend))
        .add_systems(Update, (follow, churn, show_speed));
    if options.out.is_some() {
        app.add_systems(FixedPreUpdate, |time: Res<Time>, mut helm: Single<&mut Helm>| {
            **helm = boat::script(time.elapsed_secs());
        });
    } else {
        app.add_systems(Update, (steer, begin_anew));
    }
    common::run(app)
}

fn setup(mut commands: Commands, canvas: Res<Canvas>) {
    // Rings need fine cells; a window of them goes with the camera.
    let interaction = WaterInteraction { cell: 0.15, wavelength: 1.6, decay: 8.0, ..default() };
    let waves = WaterWaves::wind(3.5, 400.0, vec2(0.6, 1.0));
    commands.spawn((Water::new(Vec2::splat(1200.0)), waves, WaterOptics::OCEAN, interaction));
    let shadows = CascadeShadowConfigBuilder { maximum_distance: 60.0, ..default() }.build();
    commands.spawn((Sky::with_sun(36.0, 225.0), DirectionalLight { shadow_maps_enabled: true, ..default() }, shadows));
    commands.spawn((Camera3d::default(), Hdr, SkyView::default(), Chase::default(), canvas.target()));
}

fn spawn_boat(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let paint = StandardMaterial { perceptual_roughness: 0.3, ..default() };
    let looks = (Mesh3d(meshes.add(boat_mesh::hull_mesh())), MeshMaterial3d(materials.add(paint)));
    let boat = commands.spawn((boat::boat(START), looks)).id();
    boat_mesh::fit_out(&mut commands, boat, &mut meshes, &mut materials);
}

/// Buoys to steer between, red to port and green to starboard, and crates that nobody has missed yet.
fn spawn_buoys(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let [red, green, wood] = [(0.8, 0.06, 0.05), (0.03, 0.45, 0.15), (0.6, 0.4, 0.2)]
        .map(|(red, green, blue)| materials.add(Color::srgb(red, green, blue)));
    let (buoy, cube) = (meshes.add(Cylinder::new(0.3, 1.4)), meshes.add(Cuboid::from_length(0.8)));
    // Weight in its foot keeps a buoy upright.
    let ballasted = Floating { center_of_mass: Some(vec3(0.0, -0.5, 0.0)), ..Floating::with_density(400.0) };
    for gate in 0..8 {
        let middle = vec3(9.0 * ops::sin(1.1 * gate as f32), 0.0, -14.0 * (gate + 1) as f32);
        for (side, paint) in [(-3.5, &red), (3.5, &green)] {
            commands.spawn((
                RigidBody::Dynamic,
                Collider::cylinder(0.7, 0.3),
                ballasted,
                Mesh3d(buoy.clone()),
                MeshMaterial3d(paint.clone()),
                Transform::from_translation(middle + Vec3::X * side),
            ));
        }
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.4, 0.4, 0.4),
            Floating::with_density(350.0),
            Mesh3d(cube.clone()),
            MeshMaterial3d(wood.clone()),
            Transform::from_translation(middle + vec3(9.0, 0.0, 5.0)),
        ));
    }
}

/// Keys to helm; the rudder takes half a second from side to side.
fn steer(keys: Res<ButtonInput<KeyCode>>, time: Res<Time>, mut helm: Single<&mut Helm>) {
    let way =
        |more: [KeyCode; 2], less: [KeyCode; 2]| f32::from(keys.any_pressed(more)) - f32::from(keys.any_pressed(less));
    helm.throttle = way([KeyCode::KeyW, KeyCode::ArrowUp], [KeyCode::KeyS, KeyCode::ArrowDown]);
    let wanted = way([KeyCode::KeyD, KeyCode::ArrowRight], [KeyCode::KeyA, KeyCode::ArrowLeft]);
    let most = 4.0 * time.delta_secs();
    helm.rudder += (wanted - helm.rudder).clamp(-most, most);
}

fn begin_anew(keys: Res<ButtonInput<KeyCode>>, boat: Single<(&mut Transform, &mut Velocity), With<Helm>>) {
    if keys.just_pressed(KeyCode::KeyR) {
        let (mut pose, mut velocity) = boat.into_inner();
        (*pose, *velocity) = (START, Velocity::zero());
    }
}

/// A camera that comes after the boat.
#[derive(Component, Default)]
struct Chase {
    /// The way that it looks, rad: it neither rolls nor pitches with the boat.
    yaw: f32,
}

/// Comes round behind the boat within a second or two, and looks at where it goes.
fn follow(
    boat: Single<&Transform, With<Helm>>,
    mut camera: Single<(&mut Chase, &mut Transform), Without<Helm>>,
    time: Res<Time>,
) {
    let (chase, pose) = &mut *camera;
    let (heading, ..) = boat.rotation.to_euler(EulerRot::YXZ);
    // The shorter way round, by a share that does not depend on how long frames are.
    let behindhand = Rot2::radians(chase.yaw).angle_to(Rot2::radians(heading));
    chase.yaw += behindhand * (1.0 - ops::exp(-1.5 * time.delta_secs()));
    let (around, place) = (Quat::from_rotation_y(chase.yaw), boat.translation.with_y(0.0));
    **pose = Transform::from_translation(place + around * vec3(0.0, 4.0, 12.5))
        .looking_at(place + around * vec3(0.0, 0.6, -4.0), Vec3::Y);
}

/// The propeller beats air into the water.
fn churn(boat: Single<(&Transform, &Helm)>, water: WaterQuery, time: Res<Time>, mut disturb: MessageWriter<Disturb>) {
    let (pose, helm) = *boat;
    let place = pose.transform_point(boat::PROPELLER);
    if water.sample(place).is_some_and(|water| water.height > place.y) {
        let foam = 2.0 * helm.throttle.abs() * time.delta_secs();
        disturb.write(Disturb::at(place, 0.3).with_foam(foam));
    }
}

fn show_speed(boat: Single<&Velocity, With<Helm>>, mut windows: Query<&mut Window>) {
    let speed = boat.linear.xz().length();
    for mut window in &mut windows {
        window.title = format!("bevy_freshet: boat — {speed:.1} m/s, {:.0} knots", speed * 3600.0 / 1852.0);
    }
}
