//! The window of the panel.
use super::{
    DropRequested, OrbitCamera, RestartRequested, WaterPanel, actions, attach::scene_camera, group, group::Owner,
    groups::GROUPS, presets, scale, simulation, waves,
};
use crate::{
    body::Water,
    features::Feature,
    preset::PresetScene,
    sky::Sky,
    surface::{SurfaceView, WaterSurface},
};
use bevy::prelude::*;
use bevy_egui::{
    EguiContext, PrimaryEguiContext,
    egui::{self, ComboBox, Ui},
};

/// Draws the panel and writes what is changed.
pub(super) fn draw(world: &mut World) {
    let mut contexts = world.query_filtered::<(Entity, &mut EguiContext), With<PrimaryEguiContext>>();
    let Ok((own, mut context)) = contexts.single_mut(world) else { return };
    let context = context.get_mut().clone();
    let camera = scene_camera(world, own);
    world.resource_scope(|world, mut panel: Mut<WaterPanel>| {
        let panel = &mut *panel;
        panel.places.clear();
        if !context.input(|input| input.pointer.any_down()) {
            group::write_pending(world, panel);
        }
        if !panel.visible {
            return;
        }
        egui::Window::new("Water").default_pos([8.0, 8.0]).default_size([320.0, 620.0]).vscroll(true).show(
            &context,
            |ui| {
                ui.spacing_mut().slider_width = 110.0;
                contents(ui, world, panel, camera);
            },
        );
    });
}

fn contents(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, camera: Entity) {
    let water = choose_water(ui, world, panel);
    let sky = world.query_filtered::<Entity, With<Sky>>().iter(world).min();
    let level = level(world, water);
    clock_and_actions(ui, world, panel, camera, level);
    camera_choice(ui, world, camera, level);
    if let Some(water) = water {
        view_choice(ui, world, panel, water);
        switches(ui, world, panel, water);
        simulation::draw(ui, world, panel, water);
        presets::draw(ui, world, panel, PresetScene { water, sky, camera: Some(camera) });
    } else {
        ui.label("There is no water.");
    }
    ui.separator();
    for group in GROUPS {
        let owner = match group.owner {
            Owner::Water => water,
            Owner::Sky => sky,
            Owner::Camera => Some(camera),
        };
        if let Some(owner) = owner {
            group::draw_group(ui, world, panel, owner, group);
        }
    }
    if let Some(water) = water {
        waves::draw(ui, world, panel, water);
    }
    ui.weak(format!("{:?} hides and shows this panel.", panel.key));
}

/// The water whose settings are shown: the chosen one if it is still there, else the first.
fn choose_water(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel) -> Option<Entity> {
    let mut waters: Vec<(Entity, String)> = world
        .query_filtered::<(Entity, Option<&Name>), With<Water>>()
        .iter(world)
        .map(|(entity, name)| (entity, name.map_or_else(|| format!("water {entity}"), ToString::to_string)))
        .collect();
    waters.sort();
    let chosen = waters.iter().find(|(water, _)| Some(*water) == panel.water).or(waters.first())?;
    let mut water = chosen.0;
    if waters.len() > 1 {
        ComboBox::from_label("Water").selected_text(&chosen.1).show_ui(ui, |ui| {
            for (entity, name) in &waters {
                ui.selectable_value(&mut water, *entity, name);
            }
        });
        panel.water = Some(water);
    }
    Some(water)
}

fn clock_and_actions(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, camera: Entity, level: f32) {
    ui.horizontal(|ui| {
        let mut time = world.resource_mut::<Time<Virtual>>();
        let mut paused = time.is_paused();
        let pause = ui.toggle_value(&mut paused, "Pause").on_hover_text("Stops water and bodies.");
        panel.note(ui, "Pause", &pause);
        if pause.changed() {
            if paused { time.pause() } else { time.unpause() }
        }
        if !panel.actions {
            return;
        }
        if ui.button("Restart").on_hover_text("Puts the scene back to its beginning.").clicked() {
            world.write_message(RestartRequested);
        }
        let drop = ui.button("Drop a body").on_hover_text("Drops a body in front of the camera.");
        panel.note(ui, "Drop a body", &drop);
        if drop.clicked()
            && let Some(camera) = world.get::<GlobalTransform>(camera)
        {
            let place = actions::place_before(camera, level);
            world.write_message(DropRequested { place });
        }
    });
}

/// World height of a water, m.
fn level(world: &World, water: Option<Entity>) -> f32 {
    water.and_then(|water| world.get::<GlobalTransform>(water)).map_or(0.0, |pose| pose.translation().y)
}

/// Begins to orbit a camera that does not yet.
fn camera_choice(ui: &mut Ui, world: &mut World, camera: Entity, level: f32) {
    let Ok(mut camera) = world.get_entity_mut(camera) else { return };
    let mut orbits = camera.get::<OrbitCamera>().is_some_and(|orbit| orbit.enabled);
    let before = orbits;
    ui.checkbox(&mut orbits, "Orbit the camera")
        .on_hover_text("Left button turns round the water in the middle of the picture, wheel zooms.");
    if orbits && !before {
        let pose = camera.get::<Transform>().copied().unwrap_or_default();
        camera.insert(OrbitCamera::through(&pose, level));
    } else if before
        && !orbits
        && let Some(mut orbit) = camera.get_mut::<OrbitCamera>()
    {
        orbit.enabled = false;
    }
}

fn view_choice(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, water: Entity) {
    let Some(mut surface) = world.get_mut::<WaterSurface>(water) else { return };
    let mut view = surface.view;
    let combo = ComboBox::from_label("View").height(400.0).selected_text(view.name()).show_ui(ui, |ui| {
        for each in SurfaceView::ALL {
            ui.selectable_value(&mut view, each, each.name()).on_hover_text(each.legend());
        }
    });
    panel.note(ui, "View", &combo.response);
    combo.response.on_hover_text("Draws the water, or one of its parts.");
    if view != SurfaceView::Water {
        ui.weak(view.legend());
    }
    if let Some(shown) = view.scale() {
        scale::draw(ui, shown.times(surface.view_scale));
    }
    if view != surface.view {
        surface.view = view;
    }
}

fn switches(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, water: Entity) {
    let Ok(mut water) = world.get_entity_mut(water) else { return };
    let header = egui::CollapsingHeader::new("Switches").show(ui, |ui| {
        egui::Grid::new("switches").num_columns(3).show(ui, |ui| {
            for (i, feature) in Feature::ALL.into_iter().enumerate() {
                let mut on = feature.is_on(water.as_readonly());
                let tick = ui.checkbox(&mut on, feature.name()).on_hover_text(feature.effect());
                panel.note(ui, feature.name(), &tick);
                if tick.changed() {
                    feature.switch(on, &mut water);
                }
                if i % 3 == 2 {
                    ui.end_row();
                }
            }
        });
    });
    panel.note(ui, "Switches", &header.header_response);
}
