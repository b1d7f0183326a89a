//! Loading and saving presets.
use super::{OrbitCamera, WaterPanel};
use crate::preset::{Preset, PresetError, PresetScene};
use bevy::{camera_controller::free_camera::FreeCameraState, prelude::*};
use bevy_egui::egui::{self, Ui};
use std::path::{Path, PathBuf};

/// What is chosen in the section, and what came of it.
#[derive(Debug)]
pub(super) struct PresetChoice {
    name: String,
    with_camera: bool,
    message: String,
}

impl Default for PresetChoice {
    fn default() -> Self {
        Self { name: "mine".into(), with_camera: false, message: String::new() }
    }
}

/// Draws the section; loads into and saves from `scene`.
pub(super) fn draw(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, scene: PresetScene) {
    egui::CollapsingHeader::new("Presets").show(ui, |ui| {
        let folder = panel.presets.clone();
        let choice = &mut panel.preset;
        ui.horizontal_wrapped(|ui| {
            for name in names(&folder) {
                if ui.button(&name).on_hover_text("Loads this preset.").clicked() {
                    choice.message = message(load(world, choice.scene(scene), &file(&folder, &name)));
                    choice.name = name;
                }
            }
        });
        ui.checkbox(&mut choice.with_camera, "with the camera")
            .on_hover_text("Whether the camera's view is loaded and saved as well.");
        ui.horizontal(|ui| {
            ui.add(egui::TextEdit::singleline(&mut choice.name).desired_width(120.0))
                .on_hover_text("Name of the file, without its ending.");
            if ui.button("Save").on_hover_text(format!("Writes to {}.", folder.display())).clicked() {
                choice.message = message(save(world, choice.scene(scene), &folder, &choice.name));
            }
        });
        if !choice.message.is_empty() {
            ui.weak(&choice.message);
        }
    });
}

impl PresetChoice {
    fn scene(&self, scene: PresetScene) -> PresetScene {
        PresetScene { camera: scene.camera.filter(|_| self.with_camera), ..scene }
    }
}

/// The presets of a folder, by name.
fn names(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let presets = files.filter(|path| path.extension().is_some_and(|ending| ending == "ron"));
    let mut names: Vec<_> = presets.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
    names.sort();
    names
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.ron"))
}

fn message(result: Result<String, String>) -> String {
    result.unwrap_or_else(|error| {
        warn!("{error}");
        error
    })
}

fn load(world: &mut World, scene: PresetScene, path: &Path) -> Result<String, String> {
    let read = {
        let registry = world.resource::<AppTypeRegistry>().read();
        Preset::read(path, &registry)
    };
    let preset = read.map_err(|error: PresetError| error.to_string())?;
    preset.apply(world, scene);
    if let Some(camera) = scene.camera {
        follow_pose(world, camera);
    }
    Ok(match preset.ignored() {
        [] => format!("{} is loaded", path.display()),
        ignored => format!("{} is loaded but for {}, which is unknown", path.display(), ignored.join(", ")),
    })
}

/// A free camera keeps its own angles, and an orbit that was not in the file would take the camera back.
fn follow_pose(world: &mut World, camera: Entity) {
    let Ok(mut camera) = world.get_entity_mut(camera) else { return };
    let Some(pose) = camera.get::<Transform>().copied() else { return };
    let (yaw, pitch, _) = pose.rotation.to_euler(EulerRot::YXZ);
    if let Some(mut state) = camera.get_mut::<FreeCameraState>() {
        (state.yaw, state.pitch) = (yaw, pitch);
    }
    if let Some(mut orbit) = camera.get_mut::<OrbitCamera>()
        && orbit.pose().translation.distance(pose.translation) > 0.01
    {
        orbit.enabled = false;
    }
}

fn save(world: &World, scene: PresetScene, folder: &Path, name: &str) -> Result<String, String> {
    let is_plain = |c: char| c.is_alphanumeric() || "_- ".contains(c);
    if name.is_empty() || !name.chars().all(is_plain) {
        return Err(format!("{name:?} is no name: letters, digits, spaces, - and _ are"));
    }
    let path = file(folder, name);
    let registry = world.resource::<AppTypeRegistry>().read();
    Preset::of(world, scene).write(&path, &registry).map_err(|error| error.to_string())?;
    Ok(format!("{} is saved", path.display()))
}
