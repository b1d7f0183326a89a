//! Where the flood is seen from: a few places by name, or a path through keyframes.
use crate::viewer::Viewer;
use bevy::{
    camera::CameraProjection,
    input::mouse::AccumulatedMouseMotion,
    math::cubic_splines::{CubicCardinalSpline, CubicCurve, CubicGenerator},
    prelude::*,
};
use bevy_egui::input::EguiWantsInput;
use bevy_freshet::panel::OrbitCamera;
use serde::{Deserialize, Serialize};
use std::{f32::consts::FRAC_PI_2, path::Path};

/// Names of the cameras.
pub const NAMES: [&str; 3] = ["slope", "top", "plain"];

/// The orbit that goes by a name.
///
/// # Errors
/// The names that there are.
pub fn orbit(name: Option<&str>, viewer: &Viewer) -> Result<OrbitCamera, String> {
    let extent = viewer.terrain.extent();
    let height = |place: Vec2| viewer.terrain.sample(place) * viewer.exaggeration;
    let usual = OrbitCamera { target: Vec3::Y * height(Vec2::ZERO), distance: extent.max_element(), ..default() };
    match name.unwrap_or(NAMES[0]) {
        "slope" => {
            // The longer side lies across the picture, seen with the sun, and so much from above as fills its height.
            let azimuth = if extent.y > extent.x { 0.18 - FRAC_PI_2 } else { 0.18 };
            let flatness = extent.max_element() / extent.min_element() * SHAPE.recip();
            let elevation = flatness.clamp(0.55, 0.75).asin();
            Ok(framed(OrbitCamera { elevation, azimuth, ..usual }, viewer, 1.05))
        }
        "top" => Ok(framed(OrbitCamera { elevation: 1.55, azimuth: 0.0, ..usual }, viewer, 0.97)),
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

/// Width of a usual picture over its height.
const SHAPE: f32 = 16.0 / 9.0;

/// The orbit from which the corners of the terrain reach to `share` of a usual picture.
fn framed(mut orbit: OrbitCamera, viewer: &Viewer, share: f32) -> OrbitCamera {
    let half = 0.5 * viewer.terrain.extent();
    let corners = [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(1.0, 1.0)].map(|side| side * half);
    let corners = corners.map(|at| vec3(at.x, viewer.terrain.sample(at) * viewer.exaggeration, at.y));
    let projection = PerspectiveProjection { aspect_ratio: SHAPE, ..default() }.get_clip_from_view();
    // Each round halves what is missing, or better.
    for _ in 0..40 {
        let pose = orbit.pose();
        let clip_from_world = projection * pose.to_matrix().inverse();
        let seen = corners.map(|corner| clip_from_world.project_point3(corner).xy());
        let (low, high) = seen.into_iter().fold((Vec2::MAX, Vec2::MIN), |(low, high), at| (low.min(at), high.max(at)));
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
        let width = orbit.distance / projection.y_axis.y;
        let ahead = pose.forward().with_y(0.0).normalize_or(Vec3::NEG_Z);
        orbit.target += 0.7 * width * (middle.x * SHAPE * pose.right() + middle.y * ahead);
        orbit.distance *= (reach.max_element() / share).clamp(0.5, 2.0);
    }
    orbit
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
