//! A camera that goes round a place.
use bevy::{
    input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseScrollUnit},
    math::ops,
    prelude::*,
};
use bevy_egui::input::EguiWantsInput;
use core::f32::consts::{FRAC_PI_2, TAU};

/// Beside a camera: dragging with the left button moves it round a place, the wheel nearer and farther. The panel switches
/// it on and off. While it is enabled, a `FreeCamera` beside it rests.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, Debug)]
pub struct OrbitCamera {
    /// Whether it moves the camera. Default true.
    pub enabled: bool,
    /// The place in the middle of the picture, world, m. Default the origin.
    pub target: Vec3,
    /// Distance of the eye from it, m, 0.5…100 000. Default 20.
    pub distance: f32,
    /// Angle of the eye above the horizon of the target, rad, −1.55…1.55. Default 0.4.
    pub elevation: f32,
    /// Bearing of the eye from the target, rad: 0 is south (+z), growing towards east (+x). Any value. Default 0.
    pub azimuth: f32,
}

impl Default for OrbitCamera {
    fn default() -> Self {
        Self { enabled: true, target: Vec3::ZERO, distance: 20.0, elevation: 0.4, azimuth: 0.0 }
    }
}

/// Turn for a pixel of the mouse's way, rad.
const TURN: f32 = 0.006;
/// Factor on the distance for a notch of the wheel, as its logarithm.
const ZOOM: f32 = 0.12;

impl OrbitCamera {
    /// The orbit through a camera's pose: round the place at which it looks at the height `level` (m), at most 60 m away.
    pub fn through(pose: &Transform, level: f32) -> Self {
        let forward = pose.forward().as_vec3();
        let way = (level - pose.translation.y) / forward.y;
        let distance = if way > 0.0 { way.clamp(1.0, 60.0) } else { 20.0 };
        let (elevation, azimuth) = ((-forward.y).clamp(-1.0, 1.0).asin(), ops::atan2(-forward.x, -forward.z));
        Self { enabled: true, target: pose.translation + forward * distance, distance, elevation, azimuth }
    }

    /// The camera's pose.
    pub fn pose(&self) -> Transform {
        let Self { target, distance, elevation, azimuth, .. } = self.usable();
        let (sin, cos) = (ops::sin(elevation), ops::cos(elevation));
        let to_eye = vec3(cos * ops::sin(azimuth), sin, cos * ops::cos(azimuth));
        Transform::from_translation(target + to_eye * distance).looking_at(target, Vec3::Y)
    }

    /// The nearest usable orbit.
    fn usable(&self) -> Self {
        let usual = Self::default();
        let number =
            |value: f32, low: f32, high: f32, else_: f32| if value.is_nan() { else_ } else { value.clamp(low, high) };
        Self {
            target: if self.target.is_finite() { self.target } else { usual.target },
            distance: number(self.distance, 0.5, 1e7, usual.distance),
            // Straight up and down have no bearing.
            elevation: number(self.elevation, -FRAC_PI_2 + 0.02, FRAC_PI_2 - 0.02, usual.elevation),
            azimuth: if self.azimuth.is_finite() { self.azimuth % TAU } else { usual.azimuth },
            ..*self
        }
    }
}

/// Moves orbiting cameras by mouse, unless the panel has it.
pub(super) fn orbit(
    buttons: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    scroll: Res<AccumulatedMouseScroll>,
    egui: Res<EguiWantsInput>,
    mut cameras: Query<(&mut OrbitCamera, &mut Transform)>,
) {
    let is_free = !egui.wants_pointer_input();
    let drag = if is_free && buttons.pressed(MouseButton::Left) { motion.delta } else { Vec2::ZERO };
    let notches = match scroll.unit {
        _ if !is_free => 0.0,
        MouseScrollUnit::Line => scroll.delta.y,
        MouseScrollUnit::Pixel => scroll.delta.y / MouseScrollUnit::SCROLL_UNIT_CONVERSION_FACTOR,
    };
    for (mut orbit, mut pose) in &mut cameras {
        if !orbit.enabled {
            continue;
        }
        if drag != Vec2::ZERO || notches != 0.0 {
            let usable = orbit.usable();
            orbit.azimuth = usable.azimuth - drag.x * TURN;
            orbit.elevation = usable.elevation + drag.y * TURN;
            orbit.distance = usable.distance * ops::exp(-notches * ZOOM);
            *orbit = orbit.usable();
        }
        pose.set_if_neq(orbit.pose());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_begins_where_the_camera_is() {
        for (eye, target) in [
            (vec3(3.0, 5.0, 8.0), vec3(-1.0, 1.0, 2.0)),
            (vec3(-40.0, 2.0, 1.0), vec3(0.0, 2.5, 0.0)),
            (vec3(0.0, 9.0, 0.0), vec3(0.0, 1.0, 1e-3)),
        ] {
            let pose = Transform::from_translation(eye).looking_at(target, Vec3::Y);
            let orbit = OrbitCamera::through(&pose, 1.0);
            let begun = orbit.pose();
            assert!(begun.translation.distance(eye) < 0.3, "{eye}: {begun:?}");
            assert!(begun.forward().dot(*pose.forward()) > 0.999, "{eye}: {begun:?}");
        }
    }

    #[test]
    fn unusable_orbits_give_usable_poses() {
        for value in [f32::NAN, f32::INFINITY, -1e30, 0.0] {
            let orbit = OrbitCamera {
                target: Vec3::splat(value),
                distance: value,
                elevation: value,
                azimuth: value,
                enabled: true,
            };
            assert!(orbit.pose().is_finite() && orbit.pose().rotation.is_normalized(), "{value}");
        }
    }
}
