//! What is under the pointer.
use crate::viewer::Viewer;
use bevy::{math::DVec2, prelude::*, window::PrimaryWindow};
use bevy_egui::{EguiContexts, egui, input::EguiWantsInput};
use bevy_freshet::{flood::FloodState, panel::OrbitCamera};
use freshet_flood::duration::clock;
use freshet_hydro::shallow_water::WaterCells;

/// The ground that is seen at a place of the picture, world.
pub fn ground(camera: &Camera, pose: &GlobalTransform, at: Vec2, viewer: &Viewer) -> Option<Vec3> {
    let ray = camera.viewport_to_world(pose, at).ok()?;
    let height = |point: Vec3| {
        let inside = viewer.terrain.cell_at(point.xz()).is_some();
        let elevation = viewer.terrain.sample(point.xz()) * viewer.exaggeration;
        point.y - if inside { elevation } else { 0.0 }
    };
    // In steps that grow with the distance, then by halving.
    let (mut before, mut after) = (0.0, 0.0);
    let farthest = 20.0 * viewer.terrain.extent().max_element() + ray.origin.length();
    while height(ray.get_point(after)) > 0.0 {
        before = after;
        after += (0.3 * height(ray.get_point(after))).max(0.5 * viewer.terrain.cell_size());
        if after > farthest {
            return None;
        }
    }
    for _ in 0..24 {
        let middle = 0.5 * (before + after);
        if height(ray.get_point(middle)) > 0.0 { before = middle } else { after = middle }
    }
    Some(ray.get_point(after))
}

/// Says where the pointer is, and what the flood is there.
pub fn tell(
    mut contexts: EguiContexts,
    wants: Res<EguiWantsInput>,
    viewer: Res<Viewer>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform), With<OrbitCamera>>,
    state: Single<&FloodState>,
) -> Result {
    let Some(at) = window.cursor_position().filter(|_| !wants.wants_pointer_input()) else { return Ok(()) };
    let Some(place) = ground(camera.0, camera.1, at, &viewer) else { return Ok(()) };
    let Some(cell) = viewer.terrain.cell_at(place.xz()) else { return Ok(()) };
    let Some(index) = viewer.terrain.index(cell) else { return Ok(()) };
    let DVec2 { x: east, y: north } = viewer.on_map(place.xz());
    let mut text = format!("E {east:.0}  N {north:.0}\nelevation {:.2} m", viewer.terrain.values()[index]);
    match state.moment().map(|moment| moment.cell(index)).filter(|water| water.y > 0.0) {
        Some(water) => {
            text += &format!("\ndepth {:.2} m\nspeed {:.2} m/s", water.y / viewer.exaggeration, water.zw().length());
        }
        None => text += "\ndry",
    }
    match viewer.arrival_of(index) {
        Some(arrival) => text += &format!("\nwet from {}", clock(arrival)),
        None => text += "\nnever wet",
    }
    let corner = egui::pos2(at.x + 16.0, at.y + 16.0);
    let area = egui::Area::new("hover".into()).fixed_pos(corner).interactable(false);
    area.show(contexts.ctx_mut()?, |ui| egui::Frame::popup(ui.style()).show(ui, |ui| ui.label(text)));
    Ok(())
}
