//! The timeline: play, step, loop, speed and scrub; colouring, cameras and exaggeration.
use crate::{
    cameras,
    steering::Steering,
    viewer::{Coloring, Viewer},
};
use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui, input::EguiWantsInput};
use bevy_freshet::{flood::Flood, panel::OrbitCamera};
use freshet_flood::duration::clock;

/// How the camera is moved.
const ORBIT: &str = "drag: orbit   right drag: pan   wheel: zoom   F: fly";
const FLIGHT: &str = "W A S D Q E: fly   right drag: look   wheel: speed   shift: faster   F: orbit";

/// Draws it at the bottom of the window.
pub fn draw(
    mut contexts: EguiContexts,
    mut viewer: ResMut<Viewer>,
    mut flood: Single<&mut Flood>,
    mut steering: ResMut<Steering>,
    camera: Single<(&mut OrbitCamera, &mut Transform)>,
) -> Result {
    let (mut orbit, mut pose) = camera.into_inner();
    let context = contexts.ctx_mut()?;
    let anchor = egui::Align2::CENTER_BOTTOM;
    egui::Window::new("Flood").title_bar(false).resizable(false).anchor(anchor, [0.0, -8.0]).show(context, |ui| {
        ui.horizontal(|ui| run(ui, &mut flood));
        ui.horizontal(|ui| {
            look(ui, &mut viewer);
            ui.separator();
            for name in cameras::NAMES {
                if ui.button(name).clicked()
                    && let Ok(wanted) = cameras::orbit(Some(name), &viewer)
                {
                    *pose = wanted.pose();
                    *orbit = wanted;
                    steering.flies = false;
                }
            }
            let mut flies = steering.flies;
            if ui.toggle_value(&mut flies, "fly").on_hover_text(FLIGHT).changed() {
                steering.flies = flies;
            }
        });
        ui.weak(if steering.flies { FLIGHT } else { ORBIT });
        ui.weak("click: depth over time   space: play   arrows: step   K: keyframe   F1: water");
    });
    Ok(())
}

/// The clock and its buttons.
fn run(ui: &mut egui::Ui, flood: &mut Mut<Flood>) {
    let (first, last) = flood.span();
    if ui.button("⏮").on_hover_text("To the first step").clicked() {
        flood.time = first;
    }
    if ui.button("◀").on_hover_text("A step back").clicked() {
        flood.step(-1);
    }
    if ui.button(if flood.playing { "⏸" } else { "▶" }).on_hover_text("Plays, or pauses").clicked() {
        toggle(flood);
    }
    if ui.button("▶|").on_hover_text("A step on").clicked() {
        flood.step(1);
    }
    let mut looping = flood.looping;
    if ui.toggle_value(&mut looping, "loop").changed() {
        flood.looping = looping;
    }
    let mut time = flood.usable_time();
    ui.spacing_mut().slider_width = 360.0;
    let slider = egui::Slider::new(&mut time, first..=last).show_value(false);
    if ui.add_enabled(last > first, slider).changed() {
        flood.time = time;
    }
    ui.monospace(clock(time));
    let mut speed = flood.speed;
    let drag = egui::DragValue::new(&mut speed).range(-3600.0..=3600.0).speed(1.0).prefix("× ");
    if ui.add(drag).on_hover_text("Seconds of the flood in a second").changed() {
        flood.speed = speed;
    }
}

/// Plays or pauses; at its end it begins anew.
fn toggle(flood: &mut Mut<Flood>) {
    let (first, last) = flood.span();
    if !flood.playing && flood.time >= last {
        flood.time = first;
    }
    flood.playing = !flood.playing;
}

/// What is shown, and how high.
fn look(ui: &mut egui::Ui, viewer: &mut ResMut<Viewer>) {
    let mut coloring = viewer.coloring;
    for choice in Coloring::ALL {
        ui.selectable_value(&mut coloring, choice, choice.name());
    }
    if coloring != viewer.coloring {
        viewer.coloring = coloring;
    }
    ui.separator();
    let mut exaggeration = viewer.exaggeration;
    let drag = egui::DragValue::new(&mut exaggeration).range(0.5..=20.0).speed(0.05).prefix("heights × ");
    if ui.add(drag).changed() {
        viewer.exaggeration = exaggeration;
    }
}

/// Space plays and pauses, the arrows step.
pub fn keys(keys: Res<ButtonInput<KeyCode>>, egui: Res<EguiWantsInput>, mut flood: Single<&mut Flood>) {
    if egui.wants_keyboard_input() {
        return;
    }
    if keys.just_pressed(KeyCode::Space) {
        toggle(&mut flood);
    }
    for (key, count) in [(KeyCode::ArrowLeft, -1), (KeyCode::ArrowRight, 1)] {
        if keys.just_pressed(key) {
            flood.step(count);
        }
    }
}
