//! What the panel asks the app for, as it does not know the scene.
use bevy::prelude::*;

/// The scene shall begin anew.
#[derive(Message, Clone, Copy, Debug, Default)]
pub struct RestartRequested;

/// A body shall be dropped.
#[derive(Message, Clone, Copy, Debug)]
pub struct DropRequested {
    /// Where: in front of the camera and over the water, world, m.
    pub place: Vec3,
}

/// Where a body is dropped: on the ray through the middle of the picture where that meets the water at `level`, but
/// between 4 and 30 m away, and 2 m above the water.
pub(super) fn place_before(camera: &GlobalTransform, level: f32) -> Vec3 {
    let (eye, forward) = (camera.translation(), camera.forward().as_vec3());
    let to_water = (level - eye.y) / forward.y;
    let way = if to_water > 0.0 { to_water.clamp(4.0, 30.0) } else { 10.0 };
    let ahead = eye + forward * way;
    vec3(ahead.x, level + 2.0, ahead.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_fall_where_the_camera_looks() {
        let camera = |eye: Vec3, target: Vec3| Transform::from_translation(eye).looking_at(target, Vec3::Y).into();
        let place = place_before(&camera(vec3(0.0, 7.0, 0.0), vec3(8.0, 1.0, 0.0)), 1.0);
        assert!(place.distance(vec3(8.0, 3.0, 0.0)) < 1e-4, "{place}");
        // To the horizon, the sky and the feet: still in sight and over the water.
        for target in [vec3(1.0, 2.0, 0.0), vec3(1.0, 3.0, 0.0), vec3(0.001, 1.9, 0.0)] {
            let place = place_before(&camera(vec3(0.0, 2.0, 0.0), target), 1.0);
            assert!(place.y == 3.0 && place.xz().length() <= 30.0, "{place}");
        }
    }
}
