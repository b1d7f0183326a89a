//! Who leads the camera in a window: a path while the flood is played, else the mouse around a place, or free flight.
use crate::{cameras::CameraPath, hover, viewer::Viewer};
use bevy::{
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin, FreeCameraState},
    prelude::*,
};
use bevy_egui::input::EguiWantsInput;
use bevy_freshet::{flood::Flood, panel::OrbitCamera};

/// Flies the camera, and lets paths lead it.
pub struct SteeringPlugin;

impl Plugin for SteeringPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(FreeCameraPlugin).init_resource::<Steering>().add_systems(Update, (toggle, steer).chain());
    }
}

/// How the camera is moved.
#[derive(Resource, Default)]
pub struct Steering {
    /// Whether it flies.
    pub flies: bool,
    leader: Option<Leader>,
}

/// Who moves the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leader {
    Path,
    Flight,
    Orbit,
}

/// F begins and ends the flight.
fn toggle(keys: Res<ButtonInput<KeyCode>>, egui: Res<EguiWantsInput>, mut steering: ResMut<Steering>) {
    if keys.just_pressed(KeyCode::KeyF) && !egui.wants_keyboard_input() {
        steering.flies = !steering.flies;
    }
}

/// Hands the camera, where it is, to who is to lead it.
fn steer(
    mut commands: Commands,
    path: Option<Res<CameraPath>>,
    viewer: Res<Viewer>,
    mut steering: ResMut<Steering>,
    flood: Single<&Flood>,
    camera: Single<(Entity, &Camera, &mut Transform, &mut OrbitCamera)>,
) {
    let (entity, camera, mut pose, mut orbit) = camera.into_inner();
    let path = path.filter(|_| flood.playing);
    let leader = match () {
        () if path.is_some() => Leader::Path,
        () if steering.flies => Leader::Flight,
        () => Leader::Orbit,
    };
    if let Some(path) = path {
        *pose = path.at(flood.usable_time());
    }
    if steering.leader == Some(leader) {
        return;
    }
    match leader {
        // New, so that it begins with this pose.
        Leader::Flight => _ = commands.entity(entity).insert((flight_of(&viewer), FreeCameraState::default())),
        Leader::Orbit if steering.leader.is_some() => *orbit = around(camera, &pose, &orbit, &viewer),
        _ => {}
    }
    // While it is enabled, the flight rests; the panel's plugin sees to that, and to what egui wants.
    orbit.enabled = leader == Leader::Orbit;
    steering.leader = Some(leader);
}

/// The flight over a flood: across it in about ten seconds.
fn flight_of(viewer: &Viewer) -> FreeCamera {
    let speed = 0.1 * viewer.terrain.extent().max_element();
    FreeCamera { walk_speed: speed, run_speed: 4.0 * speed, ..default() }
}

/// The orbit with this view: around the ground in the middle of the picture, if there is some, else as far away as before.
fn around(camera: &Camera, pose: &Transform, before: &OrbitCamera, viewer: &Viewer) -> OrbitCamera {
    let middle = camera.logical_viewport_size().map(|size| 0.5 * size);
    let seen = middle.and_then(|middle| hover::ground(camera, &GlobalTransform::from(*pose), middle, viewer));
    let distance = seen.map_or(before.distance, |seen| seen.distance(pose.translation)).clamp(1.0, 5000.0);
    let target = pose.translation + distance * pose.forward();
    OrbitCamera { target, distance, ..OrbitCamera::through(pose, 0.0) }
}
