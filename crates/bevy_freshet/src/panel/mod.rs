//! A panel of sliders for every setting, with presets, switches and inspecting views (feature `panel`).
//!
//! ```no_run
//! # use bevy::prelude::*;
//! # use bevy_freshet::{prelude::*, panel::WaterPanelPlugin};
//! App::new().add_plugins((DefaultPlugins, WaterPlugin, WaterPanelPlugin::default())).run();
//! ```
//!
//! It opens over the camera that draws to a window, never over mirrors or pictures, and is hidden and shown by a key.
//! While the pointer is over it, [`FreeCamera`](bevy::camera_controller::free_camera::FreeCamera) and [`OrbitCamera`]
//! stand still, and [`WaterTouch`](crate::interaction::WaterTouch) is blocked.
mod actions;
mod around;
mod attach;
mod group;
mod groups;
mod hold;
mod orbit;
mod presets;
mod rows;
mod scale;
mod simulation;
mod waves;
mod window;

pub use actions::{DropRequested, RestartRequested};
pub use orbit::OrbitCamera;

use crate::interaction::WaterTouchBlocked;
use bevy::{
    app::{RunFixedMainLoop, RunFixedMainLoopSystems},
    camera_controller::free_camera::rotate_freecam_to,
    input::InputSystems,
    platform::collections::HashMap,
    prelude::*,
};
use bevy_egui::{EguiGlobalSettings, EguiPlugin, EguiPreUpdateSet, EguiPrimaryContextPass};
use std::path::PathBuf;

/// Adds the panel. Brings `EguiPlugin` along if the app does not have it.
///
/// Does nothing in an app without a renderer.
#[derive(Clone, Debug)]
pub struct WaterPanelPlugin {
    /// Shows and hides the panel. Default F1.
    pub key: KeyCode,
    /// Whether the panel is shown at the start. Default true.
    pub visible: bool,
    /// Folder of the preset files. Default `assets/presets`.
    pub presets: PathBuf,
    /// Whether there are buttons for [`RestartRequested`] and [`DropRequested`]: an app that answers them says so. Default
    /// false.
    pub actions: bool,
}

impl Default for WaterPanelPlugin {
    fn default() -> Self {
        Self { key: KeyCode::F1, visible: true, presets: "assets/presets".into(), actions: false }
    }
}

/// The panel's state.
#[derive(Resource, Debug)]
pub struct WaterPanel {
    /// Whether it is shown.
    pub visible: bool,
    /// Shows and hides it.
    pub key: KeyCode,
    /// Folder of the preset files.
    pub presets: PathBuf,
    /// Whether there are buttons for [`RestartRequested`] and [`DropRequested`].
    pub actions: bool,
    /// The water whose settings are shown; without it the first one.
    pub water: Option<Entity>,
    preset: presets::PresetChoice,
    pending: group::Pending,
    places: HashMap<&'static str, Rect>,
}

impl WaterPanel {
    /// Where the control called `label` was in the last frame, in logical pixels of the window; `None` where it is not
    /// drawn, because the panel is hidden, its group is closed, or it is scrolled away. For tutorials and tests.
    pub fn place(&self, label: &str) -> Option<Rect> {
        self.places.get(label).copied()
    }
}

impl Plugin for WaterPanelPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(bevy::render::RenderApp).is_none() {
            return;
        }
        if !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins(EguiPlugin::default());
            // Egui would take the first camera, which may draw to a picture.
            app.world_mut().resource_mut::<EguiGlobalSettings>().auto_create_primary_context = false;
        }
        app.insert_resource(WaterPanel {
            visible: self.visible,
            key: self.key,
            presets: self.presets.clone(),
            actions: self.actions,
            water: None,
            preset: default(),
            pending: default(),
            places: default(),
        })
        .init_resource::<WaterTouchBlocked>()
        .add_message::<RestartRequested>()
        .add_message::<DropRequested>()
        .add_systems(
            PreUpdate,
            (
                attach::attach_to_window.before(EguiPreUpdateSet::InitContexts),
                (toggle, hold::hold_controllers, hold::block_touch).chain().after(InputSystems),
            ),
        )
        .add_systems(
            RunFixedMainLoop,
            orbit::orbit.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop).after(rotate_freecam_to),
        )
        .add_systems(EguiPrimaryContextPass, window::draw);
    }
}

/// Shows and hides the panel by its key, unless a text is being typed.
fn toggle(mut panel: ResMut<WaterPanel>, keys: Res<ButtonInput<KeyCode>>, egui: Res<bevy_egui::input::EguiWantsInput>) {
    if keys.just_pressed(panel.key) && !egui.wants_keyboard_input() {
        panel.visible = !panel.visible;
    }
}
