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
    // While it is enabled, the flight rests; the panel's plugin sees to that, and to what egui wants. Buttons set orbits that are.
    let orbits = leader == Leader::Orbit;
    if orbit.enabled != orbits {
        orbit.enabled = orbits;
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
    let distance = seen.map_or(before.distance, |seen| seen.distance(pose.translation)).max(1.0);
    let target = pose.translation + distance * pose.forward();
    OrbitCamera { target, distance, ..OrbitCamera::through(pose, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::Coloring;
    use bevy_freshet::flood::FloodMaps;
    use std::{path::Path, sync::Arc};

    fn app() -> (App, Entity) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood");
        let maps = Arc::new(FloodMaps::open(folder.join("played")).expect("the sample"));
        let mut app = App::new();
        app.init_resource::<ButtonInput<KeyCode>>().init_resource::<EguiWantsInput>().init_resource::<Steering>();
        app.insert_resource(Viewer::new(maps.clone(), Coloring::Water, 1.0).expect("the sample"));
        app.add_systems(Update, (toggle, steer).chain());
        let mut flood = Flood::new(maps);
        flood.playing = false;
        app.world_mut().spawn(flood);
        let orbit = OrbitCamera { distance: 300.0, ..default() };
        let camera = app.world_mut().spawn((Camera::default(), orbit.pose(), orbit)).id();
        app.update();
        (app, camera)
    }

    fn press(app: &mut App, key: KeyCode) {
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.release(key);
        keys.clear();
        keys.press(key);
        app.update();
        app.world_mut().resource_mut::<ButtonInput<KeyCode>>().clear();
    }

    fn orbit(app: &App, camera: Entity) -> OrbitCamera {
        *app.world().get::<OrbitCamera>(camera).expect("an orbit")
    }

    #[test]
    fn a_flight_begins_where_the_orbit_is_and_ends_where_it_looks() {
        let (mut app, camera) = app();
        assert!(orbit(&app, camera).enabled);
        let before = *app.world().get::<Transform>(camera).expect("a pose");
        press(&mut app, KeyCode::KeyF);
        assert!(
            !orbit(&app, camera).enabled && app.world().get::<FreeCameraState>(camera).is_some_and(|it| it.enabled)
        );
        assert_eq!(app.world().get::<Transform>(camera), Some(&before));

        let flown = Transform::from_xyz(40.0, 90.0, -30.0).looking_at(vec3(-20.0, 10.0, 60.0), Vec3::Y);
        app.world_mut().entity_mut(camera).insert(flown);
        press(&mut app, KeyCode::KeyF);
        let pose = orbit(&app, camera).pose();
        assert!(orbit(&app, camera).enabled && pose.translation.distance(flown.translation) < 0.1, "{pose:?}");
        assert!(pose.forward().dot(*flown.forward()) > 0.9999, "{pose:?}");
    }

    #[test]
    fn a_path_leads_while_the_flood_is_played_and_leaves_the_camera_there() {
        let (mut app, camera) = app();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/flood/path.ron");
        app.insert_resource(CameraPath::read(&path).expect("the sample's path"));
        let play = |app: &mut App, playing: bool| {
            let world = app.world_mut();
            world.query::<&mut Flood>().iter_mut(world).for_each(|mut flood| flood.playing = playing);
            app.update();
        };
        play(&mut app, true);
        let led = *app.world().get::<Transform>(camera).expect("a pose");
        assert_eq!(led, app.world().resource::<CameraPath>().at(0.0));
        assert!(!orbit(&app, camera).enabled);
        // Also where a button asks for another orbit meanwhile.
        app.world_mut().entity_mut(camera).insert(OrbitCamera { distance: 50.0, ..default() });
        app.update();
        assert!(!orbit(&app, camera).enabled);
        play(&mut app, false);
        assert!(orbit(&app, camera).enabled && orbit(&app, camera).pose().translation.distance(led.translation) < 0.1);
    }
}
