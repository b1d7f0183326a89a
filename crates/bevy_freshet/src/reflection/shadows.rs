//! Shadow maps of the sun that a mirror and its viewer share.
//!
//! Bevy fits cascades to every view and draws their maps anew for each, although all views use one texture. A mirror sees much
//! the same place as its viewer, so it takes the viewer's cascades; drawn just before the viewer, it leaves the very maps behind
//! that the viewer needs.
use bevy::{
    light::Cascades,
    pbr::ViewLightEntities,
    prelude::*,
    render::{camera::SortedCameras, extract_component::ExtractComponent, sync_world::MainEntity},
};

/// Marks a mirror camera whose shadow maps are its viewer's.
#[derive(Component, ExtractComponent, Clone, Copy, Debug, PartialEq)]
pub(super) struct SharesShadows {
    pub viewer: Entity,
}

/// Gives mirrors the cascades of their viewers.
pub(super) fn share_cascades(mirrors: Query<(Entity, &SharesShadows, &Camera)>, mut lights: Query<&mut Cascades>) {
    for (mirror, shares, camera) in &mirrors {
        for mut cascades in lights.iter_mut().filter(|_| camera.is_active) {
            if let Some(of_viewer) = cascades.cascades.get(&shares.viewer).cloned() {
                cascades.cascades.insert(mirror, of_viewer);
            }
        }
    }
}

/// Takes the shadow passes from cameras whose maps the camera before has drawn.
pub(super) fn skip_drawn_shadows(
    cameras: Res<SortedCameras>,
    mut views: Query<(&MainEntity, Option<&SharesShadows>, &mut ViewLightEntities)>,
) {
    // Whose cascades are in the maps.
    let mut drawn = None;
    for camera in &cameras.0 {
        let Ok((view, shares, mut lights)) = views.get_mut(camera.entity) else { continue };
        let owner = shares.map_or(view.id(), |shares| shares.viewer);
        if drawn == Some(owner) {
            lights.lights.clear();
        }
        drawn = Some(owner);
    }
}
