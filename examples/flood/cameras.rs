//! Where the flood is seen from: a few places by name, or a path through keyframes.
use crate::viewer::Viewer;
use bevy::{
    input::mouse::AccumulatedMouseMotion,
    math::cubic_splines::{CubicCardinalSpline, CubicCurve, CubicGenerator},
    prelude::*,
};
use bevy_egui::input::EguiWantsInput;
use bevy_freshet::panel::OrbitCamera;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Names of the cameras.
pub const NAMES: [&str; 3] = ["slope", "top", "plain"];

/// The orbit that goes by a name.
///
/// # Errors
/// The names that there are.
pub fn orbit(name: Option<&str>, viewer: &Viewer) -> Result<OrbitCamera, String> {
    let extent = viewer.terrain.extent();
    let height = |place: Vec2| viewer.terrain.sample(place) * viewer.exaggeration;
    let usual = OrbitCamera { target: Vec3::Y * height(Vec2::ZERO), distance: 1.15 * extent.y, ..default() };
    match name.unwrap_or(NAMES[0]) {
        "slope" => Ok(OrbitCamera { elevation: 0.65, azimuth: 0.45, ..usual }),
        "top" => Ok(OrbitCamera { elevation: 1.55, azimuth: 0.0, distance: 1.25 * extent.y, ..usual }),
        "plain" => {
            let place = vec2(0.15 * extent.x, -0.05 * extent.y);
            let target = vec3(place.x, height(place), place.y);
            Ok(OrbitCamera { target, distance: 0.14 * extent.y, elevation: 0.3, azimuth: 0.3, ..usual })
        }
        other => {
            Err(format!("there is no camera {other:?}; there are {}, or a file that ends in .ron", NAMES.join(", ")))
        }
    }
}

/// A place of the camera at a time of the flood.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Keyframe {
    /// s in the data.
    pub time: f64,
    /// Where the camera is, m: east, up and south of the middle of the flood.
    pub eye: Vec3,
    /// What it looks at.
    pub target: Vec3,
}

/// A smooth way through keyframes.
#[derive(Resource)]
pub struct CameraPath {
    keyframes: Vec<Keyframe>,
    /// Eye and target, one segment from each keyframe to the next.
    curves: Option<[CubicCurve<Vec3>; 2]>,
}

impl CameraPath {
    /// Reads a list of [`Keyframe`]s in RON.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn read(path: &Path) -> Result<Self, String> {
        let named = |problem: &dyn core::fmt::Display| format!("{}: {problem}", path.display());
        let text = std::fs::read_to_string(path).map_err(|problem| named(&problem))?;
        let keyframes: Vec<Keyframe> = ron::from_str(&text).map_err(|problem| named(&problem))?;
        let is_usable = |key: &Keyframe| key.time.is_finite() && key.eye.is_finite() && key.target.is_finite();
        if keyframes.is_empty() || !keyframes.iter().all(is_usable) {
            return Err(named(&"expected keyframes of finite numbers"));
        }
        if !keyframes.is_sorted_by(|a, b| a.time < b.time) {
            return Err(named(&"expected times that increase"));
        }
        let curve =
            |place: fn(&Keyframe) -> Vec3| CubicCardinalSpline::new_catmull_rom(keyframes.iter().map(place)).to_curve();
        let curves = [curve(|key| key.eye), curve(|key| key.target)];
        let [eye, target] = curves;
        Ok(Self { curves: eye.ok().zip(target.ok()).map(<[_; 2]>::from), keyframes })
    }

    /// The camera's pose at a time of the flood; that of the nearest keyframe before the first and after the last.
    pub fn at(&self, time: f64) -> Transform {
        let keys = &self.keyframes;
        let next = keys.partition_point(|key| key.time <= time).clamp(1, keys.len().max(2) - 1);
        let (Some(curves), Some(b)) = (&self.curves, keys.get(next)) else { return pose(keys[0].eye, keys[0].target) };
        let a = keys[next - 1];
        let share = ((time - a.time) / (b.time - a.time)).clamp(0.0, 1.0) as f32;
        let [eye, target] = curves.each_ref().map(|curve| curve.position((next - 1) as f32 + share));
        pose(eye, target)
    }
}

fn pose(eye: Vec3, target: Vec3) -> Transform {
    // Straight down, north is up.
    let up = if (target - eye).xz().length() < 1e-3 * (target - eye).length() { Vec3::NEG_Z } else { Vec3::Y };
    Transform::from_translation(eye).looking_at(target, up)
}

/// Keyframes that are recorded with K, written to `camera.ron`.
#[derive(Resource, Default)]
pub struct Recorded(Vec<Keyframe>);

/// Records the camera with K.
pub fn record(
    keys: Res<ButtonInput<KeyCode>>,
    egui: Res<EguiWantsInput>,
    mut recorded: ResMut<Recorded>,
    flood: Single<&bevy_freshet::flood::Flood>,
    camera: Single<(&Transform, &OrbitCamera)>,
) {
    if !keys.just_pressed(KeyCode::KeyK) || egui.wants_keyboard_input() {
        return;
    }
    // Also where a path leads it or it flies, and the orbit is elsewhere.
    let (pose, orbit) = *camera;
    let target = pose.translation + orbit.distance * pose.forward();
    let key = Keyframe { time: flood.usable_time(), eye: pose.translation, target };
    recorded.0.retain(|other| other.time != key.time);
    recorded.0.push(key);
    recorded.0.sort_by(|a, b| a.time.total_cmp(&b.time));
    let text = ron::ser::to_string_pretty(&recorded.0, default()).map_err(|problem| problem.to_string());
    match text.and_then(|text| std::fs::write("camera.ron", text).map_err(|problem| problem.to_string())) {
        Ok(()) => info!("camera.ron has {} keyframes", recorded.0.len()),
        Err(problem) => warn!("camera.ron: {problem}"),
    }
}

/// Moves the middle of the orbit with the right mouse button, along the ground.
pub fn pan(
    buttons: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    egui: Res<EguiWantsInput>,
    mut orbits: Query<&mut OrbitCamera>,
) {
    if !buttons.pressed(MouseButton::Right) || egui.wants_pointer_input() || motion.delta == Vec2::ZERO {
        return;
    }
    for mut orbit in orbits.iter_mut().filter(|orbit| orbit.enabled) {
        let along = Vec2::from_angle(orbit.azimuth);
        let way = 0.0015 * orbit.distance * motion.delta;
        let (right, towards) = (vec2(along.x, -along.y), vec2(along.y, along.x));
        let moved = -way.x * right - way.y * towards;
        orbit.target += vec3(moved.x, 0.0, moved.y);
    }
}
