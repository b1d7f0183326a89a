//! The cameras that see water.
use super::sync::SurfaceOf;
use crate::{reflection::MirrorCamera, report::Reported};
use bevy::{
    camera::{
        Exposure,
        visibility::{RenderLayers, VisibleEntities},
    },
    core_pipeline::prepass::DepthPrepass,
    ecs::{entity::EntityHashSet, query::QueryData, system::SystemParam},
    light::{EnvironmentMapLight, ShadowFilteringMethod, Skybox},
    pbr::DistanceFog,
    prelude::*,
};
use core::any::TypeId;

/// Put on a camera that shall not see any water: it gets no surfaces and no mirrors.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default, Clone, Debug)]
pub struct NoWater;

/// What the water needs to know of a camera.
#[derive(QueryData)]
pub(crate) struct Viewer {
    entity: Entity,
    camera: &'static Camera,
    pose: &'static GlobalTransform,
    projection: &'static Projection,
    exposure: Option<&'static Exposure>,
    layers: Option<&'static RenderLayers>,
    environment: Option<&'static EnvironmentMapLight>,
    skybox: Option<&'static Skybox>,
    fog: Option<&'static DistanceFog>,
    ambient: Option<&'static AmbientLight>,
    shadow_filter: Option<&'static ShadowFilteringMethod>,
}

/// A viewing camera at this instant.
pub(crate) struct ViewerData<'a> {
    pub entity: Entity,
    pub camera: &'a Camera,
    pub pose: &'a GlobalTransform,
    pub projection: &'a Projection,
    /// Size of the viewport, pixels.
    pub viewport: UVec2,
    pub exposure: Option<&'a Exposure>,
    pub layers: Option<&'a RenderLayers>,
    pub environment: Option<&'a EnvironmentMapLight>,
    pub skybox: Option<&'a Skybox>,
    fog: Option<&'a DistanceFog>,
    ambient: Option<&'a AmbientLight>,
    shadow_filter: Option<&'a ShadowFilteringMethod>,
}

impl ViewerData<'_> {
    /// Height of what a pixel in the middle of the picture shows, m, of things `distance` metres away; 0 if the projection
    /// does not tell.
    pub fn pixel_size(&self, distance: f32) -> f32 {
        let clip_from_view = match &self.camera.sub_camera_view {
            Some(part) => self.projection.get_clip_from_view_for_sub(part),
            None => self.projection.get_clip_from_view(),
        };
        let (up, depth) = (clip_from_view.row(1), clip_from_view.row(3));
        // A projection may turn the picture: what counts is how fast the row changes across the view.
        let pixels = 0.5 * up.xy().length() * self.viewport.y as f32;
        let size = (depth.w + depth.z.abs() * distance) / pixels;
        if size.is_finite() { size.max(0.0) } else { 0.0 }
    }

    /// Gives `mirror` the fog, light and shadows of this camera.
    pub fn insert_lighting(&self, mirror: &mut EntityCommands) {
        fn copy<C: Component + Clone>(from: Option<&C>, to: &mut EntityCommands) {
            match from {
                Some(component) => to.try_insert(component.clone()),
                None => to.try_remove::<C>(),
            };
        }
        copy(self.environment, mirror);
        copy(self.fog, mirror);
        copy(self.ambient, mirror);
        copy(self.shadow_filter, mirror);
    }
}

/// All active 3D cameras but mirrors and those marked [`NoWater`].
#[derive(SystemParam)]
pub(crate) struct Viewers<'w, 's> {
    cameras: Query<'w, 's, Viewer, (With<Camera3d>, Without<MirrorCamera>, Without<NoWater>)>,
}

impl Viewers<'_, '_> {
    pub fn iter(&self) -> impl Iterator<Item = ViewerData<'_>> {
        self.cameras.iter().filter_map(viewer)
    }

    pub fn get(&self, entity: Entity) -> Option<ViewerData<'_>> {
        self.cameras.get(entity).ok().and_then(viewer)
    }
}

fn viewer<'a>(item: ViewerItem<'a, '_>) -> Option<ViewerData<'a>> {
    let viewport = item.camera.physical_viewport_size()?;
    (item.camera.is_active && item.pose.affine().is_finite() && viewport.min_element() > 0).then_some(ViewerData {
        entity: item.entity,
        camera: item.camera,
        pose: item.pose,
        projection: item.projection,
        viewport,
        exposure: item.exposure,
        layers: item.layers,
        environment: item.environment,
        skybox: item.skybox,
        fog: item.fog,
        ambient: item.ambient,
        shadow_filter: item.shadow_filter,
    })
}

/// Gives every viewing camera the depth prepass from which the water reads how deep it is.
pub(super) fn require_depth(
    mut commands: Commands,
    waters: Query<(), With<crate::body::Water>>,
    cameras: Query<Entity, (With<Camera3d>, Without<MirrorCamera>, Without<NoWater>, Without<DepthPrepass>)>,
) {
    if !waters.is_empty() {
        for camera in &cameras {
            commands.entity(camera).try_insert(DepthPrepass);
        }
    }
}

/// Frames that a water may go unseen by any camera before it is worth a warning: cameras may be spawned late.
const FRAMES_WITHOUT_CAMERA: u32 = 60;

/// Warns once if there is water to draw but no camera at all.
pub(super) fn report_missing_camera(
    mut frames: Local<u32>,
    mut reported: ResMut<Reported>,
    waters: Query<Entity, With<crate::body::Water>>,
    cameras: Query<(), (With<Camera3d>, Without<MirrorCamera>)>,
) {
    *frames = if cameras.is_empty() { *frames + 1 } else { 0 };
    if *frames > FRAMES_WITHOUT_CAMERA
        && let Some(water) = waters.iter().next()
    {
        reported.warn(water, "Water", "is not drawn: there is no Camera3d");
    }
}

/// Takes out of every camera's list the surfaces that belong to another camera.
///
/// Render layers could do this too, but they are the game's, and there are too few.
pub(super) fn show_each_viewer_its_own(
    mut views: Query<(Entity, &mut VisibleEntities)>,
    surfaces: Query<(Entity, &SurfaceOf)>,
) {
    for (view, mut visible) in &mut views {
        let foreign: EntityHashSet =
            surfaces.iter().filter(|(_, surface)| surface.viewer != view).map(|(entity, _)| entity).collect();
        if !foreign.is_empty() {
            visible.get_mut(TypeId::of::<Mesh3d>()).retain(|entity| !foreign.contains(entity));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{
        camera::{ScalingMode, SubCameraView},
        math::Affine3A,
    };

    fn pixel_size(projection: &Projection, camera: &Camera) -> f32 {
        let pose = GlobalTransform::from(Affine3A::IDENTITY);
        let viewer = ViewerData {
            entity: Entity::PLACEHOLDER,
            camera,
            pose: &pose,
            projection,
            viewport: uvec2(200, 100),
            exposure: None,
            layers: None,
            environment: None,
            skybox: None,
            fog: None,
            ambient: None,
            shadow_filter: None,
        };
        viewer.pixel_size(30.0)
    }

    #[test]
    fn a_pixel_shows_what_the_projection_says() {
        let whole = Camera::default();
        // A right angle: 60 m high at a distance of 30 m.
        let perspective = PerspectiveProjection { fov: core::f32::consts::FRAC_PI_2, ..default() };
        let eye = Projection::Perspective(perspective);
        assert!((pixel_size(&eye, &whole) - 0.6).abs() < 1e-4);
        let orthographic = OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical { viewport_height: 8.0 },
            ..OrthographicProjection::default_3d()
        };
        let mut orthographic = Projection::Orthographic(orthographic);
        orthographic.update(200.0, 100.0);
        assert!((pixel_size(&orthographic, &whole) - 0.08).abs() < 1e-4);
        // A quarter of a picture is twice as fine along each side.
        let quarter = SubCameraView { full_size: uvec2(400, 200), offset: Vec2::ZERO, size: uvec2(200, 100) };
        let quarter = Camera { sub_camera_view: Some(quarter), ..default() };
        assert!((pixel_size(&eye, &quarter) - 0.3).abs() < 1e-4);
    }
}
