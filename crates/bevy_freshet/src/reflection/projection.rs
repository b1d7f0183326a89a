//! Mirror geometry: poses and projections of cameras that look from under the water plane.
use bevy::{
    camera::{CameraProjection, SubCameraView},
    math::Vec3A,
    prelude::*,
};

/// Nearest distance of a mirrored eye to the clip plane, m: below it the projection degenerates.
const MIN_NEAR: f32 = 0.01;

/// Reflection about the plane y = `level`: T·S·T⁻¹.
pub(super) fn reflection(level: f32) -> Mat4 {
    Mat4::from_translation(Vec3::Y * (2.0 * level)) * Mat4::from_scale(vec3(1.0, -1.0, 1.0))
}

/// The plane y = `clip_level` in the view space of the camera at `mirror`, with the normal towards the kept side above
/// and the negative height of the plane over the eye as w.
pub(super) fn clip_plane(mirror: &GlobalTransform, clip_level: f32) -> Vec4 {
    let normal = mirror.affine().inverse().transform_vector3(Vec3::Y).normalize();
    normal.extend(mirror.translation().y - clip_level)
}

/// The projection of a mirrored view of `viewer`: the same picture with everything under `plane` cut away. `aspect` is
/// that of the target. `None` if the plane hides everything or the projection is not of a known kind.
pub(super) fn mirrored(viewer: &Projection, plane: Vec4, aspect: f32) -> Option<Projection> {
    match viewer {
        Projection::Perspective(perspective) => {
            let mirrored = PerspectiveProjection {
                near_clip_plane: plane,
                // Exact for a camera that looks straight down, and without influence on any other.
                near: -plane.w,
                aspect_ratio: aspect,
                ..perspective.clone()
            };
            (mirrored.near > MIN_NEAR && keeps_something(&mirrored, plane)).then(|| mirrored.into())
        }
        Projection::Orthographic(orthographic) => {
            let oblique = ObliqueOrthographic { orthographic: orthographic.clone(), plane };
            (oblique.largest_distance() > 0.0).then(|| Projection::custom(oblique))
        }
        Projection::Custom(_) => None,
    }
}

/// Whether a corner ray of the view points to the kept side of the plane.
fn keeps_something(projection: &PerspectiveProjection, plane: Vec4) -> bool {
    let corners = projection.get_frustum_corners(-1.0, -1.0);
    corners.iter().any(|&ray| plane.truncate().dot(ray.into()) > 0.0)
}

/// An orthographic projection whose near plane is replaced by an arbitrary plane.
///
/// In the manner of Lengyel (2005), for reverse z: with `m` the largest `C·p` over the corners of the view volume the z
/// row `(0, 0, 0, 1) − C/m` gives 1 on the plane C and 0 at the farthest corner.
#[derive(Clone, Debug)]
pub(super) struct ObliqueOrthographic {
    pub orthographic: OrthographicProjection,
    /// View space, normal towards the kept side.
    pub plane: Vec4,
}

impl ObliqueOrthographic {
    /// Distance of the farthest corner of the view volume on the kept side, m; negative if all is cut away.
    fn largest_distance(&self) -> f32 {
        let (near, far) = (-self.orthographic.near, -self.orthographic.far);
        let corners = self.orthographic.get_frustum_corners(near, far);
        corners.iter().map(|&p| self.plane.dot(Vec3::from(p).extend(1.0))).fold(f32::NEG_INFINITY, f32::max)
    }

    fn with_plane(&self, mut clip_from_view: Mat4) -> Mat4 {
        let row = Vec4::W - self.plane / self.largest_distance().max(MIN_NEAR);
        clip_from_view.x_axis.z = row.x;
        clip_from_view.y_axis.z = row.y;
        clip_from_view.z_axis.z = row.z;
        clip_from_view.w_axis.z = row.w;
        clip_from_view
    }
}

impl CameraProjection for ObliqueOrthographic {
    fn get_clip_from_view(&self) -> Mat4 {
        self.with_plane(self.orthographic.get_clip_from_view())
    }

    fn get_clip_from_view_for_sub(&self, sub_view: &SubCameraView) -> Mat4 {
        self.with_plane(self.orthographic.get_clip_from_view_for_sub(sub_view))
    }

    /// The area is the viewer's, whatever the size of the mirror's target.
    fn update(&mut self, _width: f32, _height: f32) {}

    fn far(&self) -> f32 {
        self.orthographic.far()
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        self.orthographic.get_frustum_corners(z_near, z_far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Rect;

    /// Views above the plane: level, steep, straight down, upward, perspective and orthographic.
    fn views() -> Vec<(Projection, Transform)> {
        let perspective = Projection::from(PerspectiveProjection { aspect_ratio: 1.6, ..default() });
        let orthographic = Projection::from(OrthographicProjection {
            area: Rect::new(-8.0, -5.0, 8.0, 5.0),
            near: -20.0,
            far: 80.0,
            ..OrthographicProjection::default_3d()
        });
        let poses = [
            Transform::from_xyz(1.0, 3.0, 9.0).looking_to(vec3(0.1, -0.05, -1.0), Vec3::Y),
            Transform::from_xyz(-4.0, 12.0, 2.0).looking_to(vec3(0.3, -2.0, -1.0), Vec3::Y),
            Transform::from_xyz(0.0, 7.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::Z),
            Transform::from_xyz(5.0, 2.5, 0.0).looking_to(vec3(-1.0, 0.2, 0.0), Vec3::Y),
        ];
        poses.into_iter().flat_map(|pose| [(perspective.clone(), pose), (orthographic.clone(), pose)]).collect()
    }

    fn mirror_of(projection: &Projection, pose: &Transform, level: f32) -> (Mat4, Mat4) {
        let viewer = GlobalTransform::from(*pose);
        let mirror = GlobalTransform::from(Transform::from_matrix(reflection(level) * viewer.to_matrix()));
        let plane = clip_plane(&mirror, level);
        let clip_from_view = mirrored(projection, plane, 1.6).unwrap().get_clip_from_view();
        (clip_from_view * mirror.to_matrix().inverse(), projection.get_clip_from_view() * viewer.to_matrix().inverse())
    }

    #[test]
    fn points_on_the_plane_lie_where_the_viewer_sees_them_and_on_the_near_plane() {
        for (projection, pose) in views() {
            let (mirror, viewer) = mirror_of(&projection, &pose, 0.8);
            for i in 0..100 {
                let point = vec3((i % 10) as f32 - 5.0, 0.8, (i / 10) as f32 - 5.0);
                if (viewer * point.extend(1.0)).w <= 0.1 {
                    continue;
                }
                let (seen, mirrored) = (viewer.project_point3(point), mirror.project_point3(point));
                assert!(seen.xy().distance(mirrored.xy()) < 1e-3, "{projection:?}: {seen} {mirrored}");
                assert!((mirrored.z - 1.0).abs() < 1e-3, "{mirrored}");
            }
        }
    }

    #[test]
    fn what_is_under_water_is_cut_away_and_what_is_above_is_kept() {
        for (projection, pose) in views() {
            let (mirror, _) = mirror_of(&projection, &pose, 0.8);
            for i in 0..1000 {
                let spread = |step: i32, width: f32| ((i * step) % 1000) as f32 / 1000.0 * width - width / 2.0;
                let point = vec3(spread(7, 20.0), 0.8 + spread(331, 10.0), spread(173, 20.0));
                let clip = mirror * point.extend(1.0);
                let inside = clip.xy().abs().max_element() < clip.w && clip.w > 0.0;
                if inside && (point.y - 0.8).abs() > 1e-3 {
                    assert_eq!(clip.z <= clip.w, point.y > 0.8, "{point} {clip}");
                    assert!(point.y < 0.8 || clip.z >= 0.0, "beyond the far plane: {point} {clip}");
                }
            }
        }
    }

    #[test]
    fn a_view_of_nothing_but_sky_or_depths_needs_no_mirror() {
        let up = GlobalTransform::from(Transform::from_xyz(0.0, 3.0, 0.0).looking_to(Vec3::Y, Vec3::Z));
        let mirror = GlobalTransform::from(Transform::from_matrix(reflection(0.0) * up.to_matrix()));
        let plane = clip_plane(&mirror, 0.0);
        assert!(mirrored(&PerspectiveProjection::default().into(), plane, 1.0).is_none());
        let above = GlobalTransform::from_xyz(0.0, 1.0, 0.0);
        let plane = clip_plane(&above, 0.0);
        assert!(
            mirrored(&PerspectiveProjection::default().into(), plane, 1.0).is_none(),
            "the mirrored eye of an eye under water is above it"
        );
    }
}
