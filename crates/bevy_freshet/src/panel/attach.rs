//! The panel belongs to the camera that draws to a window.
use crate::reflection::MirrorCamera;
use bevy::{camera::RenderTarget, prelude::*};
use bevy_egui::PrimaryEguiContext;

/// Gives the primary context to the camera of a window that is drawn last, unless a camera has it. Cameras that draw to
/// pictures, such as mirrors, never get it.
pub(super) fn attach_to_window(
    mut commands: Commands,
    contexts: Query<(), With<PrimaryEguiContext>>,
    cameras: Query<(Entity, &Camera, &RenderTarget), Without<MirrorCamera>>,
) {
    if !contexts.is_empty() {
        return;
    }
    let windows =
        cameras.iter().filter(|(_, camera, target)| camera.is_active && matches!(target, RenderTarget::Window(_)));
    if let Some((camera, ..)) = windows.max_by_key(|(entity, camera, _)| (camera.order, *entity)) {
        commands.entity(camera).try_insert(PrimaryEguiContext);
    }
}

/// The camera whose settings the panel shows: its own, or, if that draws an overlay, the 3D camera of a window that is drawn
/// last.
pub(super) fn scene_camera(world: &mut World, own: Entity) -> Entity {
    if world.get::<Camera3d>(own).is_some() {
        return own;
    }
    let mut cameras =
        world.query_filtered::<(Entity, &Camera, &RenderTarget), (With<Camera3d>, Without<MirrorCamera>)>();
    let windows =
        cameras.iter(world).filter(|(_, camera, target)| camera.is_active && matches!(target, RenderTarget::Window(_)));
    windows.max_by_key(|(entity, camera, _)| (camera.order, *entity)).map_or(own, |(camera, ..)| camera)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn context(app: &mut App) -> Vec<Entity> {
        app.update();
        let world = app.world_mut();
        world.query_filtered::<Entity, With<PrimaryEguiContext>>().iter(world).collect()
    }

    #[test]
    fn the_panel_is_over_the_last_camera_of_a_window() {
        let mut app = App::new();
        app.add_systems(PreUpdate, attach_to_window);
        let mirror = MirrorCamera { viewer: Entity::PLACEHOLDER, level: 0.0 };
        app.world_mut().spawn((Camera { order: 9, ..default() }, RenderTarget::default(), mirror));
        let picture = RenderTarget::Image(Handle::<Image>::default().into());
        app.world_mut().spawn((Camera { order: 8, ..default() }, picture));
        app.world_mut().spawn((Camera { order: 7, is_active: false, ..default() }, RenderTarget::default()));
        assert_eq!(context(&mut app), []);
        let scene = app.world_mut().spawn((Camera { order: 1, ..default() }, RenderTarget::default())).id();
        assert_eq!(context(&mut app), [scene]);
        // It does not wander, but finds another camera when its own is gone.
        let overlay = app.world_mut().spawn((Camera { order: 2, ..default() }, RenderTarget::default())).id();
        assert_eq!(context(&mut app), [scene]);
        app.world_mut().despawn(scene);
        assert_eq!(context(&mut app), [overlay]);
    }

    #[test]
    fn under_an_overlay_the_panel_is_about_the_scene() {
        let mut world = World::new();
        let overlay = world.spawn((Camera { order: 2, ..default() }, RenderTarget::default())).id();
        assert_eq!(scene_camera(&mut world, overlay), overlay);
        let scene = world.spawn((Camera3d::default(), Camera::default(), RenderTarget::default())).id();
        assert_eq!(scene_camera(&mut world, overlay), scene);
        assert_eq!(scene_camera(&mut world, scene), scene);
    }
}
