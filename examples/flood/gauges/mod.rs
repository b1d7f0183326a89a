//! Gauges: places at which the depth is shown over the time of the whole flood. A click on the ground sets one, `--mark` too.
mod csv;
mod read;
mod series;
mod window;

use crate::{hover, viewer::Viewer};
use bevy::{math::DVec2, prelude::*, window::PrimaryWindow};
use bevy_egui::{EguiPrimaryContextPass, input::EguiWantsInput};
use bevy_freshet::panel::OrbitCamera;
use read::Reading;
use series::Series;

/// Reads gauges and shows them.
pub struct GaugesPlugin {
    /// Places of the first gauges: easting and northing on the map.
    pub places: Vec<DVec2>,
    /// Whether nothing is clicked, and frames wait for what is read.
    pub is_headless: bool,
}

impl Plugin for GaugesPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Gauges { is_headless: self.is_headless, ..default() })
            .add_systems(Update, read::read)
            .add_systems(EguiPrimaryContextPass, (window::mark, window::plot).chain().after(crate::overlay::draw));
        if !self.is_headless {
            app.add_systems(Update, click.before(read::read));
        }
        for place in &self.places {
            let world = app.world_mut();
            let cell = world.resource::<Viewer>().cell_on_map(*place);
            let cell = cell.unwrap_or_else(|problem| crate::common::fail(format!("--mark: {problem}")));
            world.resource_mut::<Gauges>().add(*place, cell);
        }
    }
}

/// All gauges.
#[derive(Resource, Default)]
pub struct Gauges {
    list: Vec<Gauge>,
    reading: Option<Reading>,
    is_headless: bool,
    /// What became of the last table.
    said: Option<String>,
}

/// A place at which the depth is shown.
pub struct Gauge {
    /// Easting and northing, m.
    place: DVec2,
    cell: usize,
    depths: Depths,
}

/// What is known of a gauge.
enum Depths {
    Unread,
    /// The series, and its line: s and m.
    Read(Series, Vec<egui_plot::PlotPoint>),
    /// Why it cannot be read.
    Failed(String),
}

impl Gauge {
    /// Its depths, if they are known.
    fn series(&self) -> Option<&Series> {
        if let Depths::Read(series, _) = &self.depths { Some(series) } else { None }
    }
}

impl Gauges {
    /// Sets a gauge, unless there is one in this cell.
    fn add(&mut self, place: DVec2, cell: usize) {
        if self.list.iter().all(|gauge| gauge.cell != cell) {
            self.list.push(Gauge { place, cell, depths: Depths::Unread });
        }
    }

    /// Takes all away.
    fn clear(&mut self) {
        *self = Self { is_headless: self.is_headless, ..default() };
    }
}

/// A place as it is typed: `E,N`.
///
/// # Errors
/// What is expected.
pub fn place(text: &str) -> Result<DVec2, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    let numbers = text.split_once(',').and_then(|(east, north)| number(east).zip(number(north)));
    numbers.map(DVec2::from).ok_or_else(|| format!("expected easting and northing like 2100.5,480, found {text:?}"))
}

/// Farthest way of the pointer, px, that is a click and no drag.
const STILL: f32 = 4.0;

/// Sets a gauge where the ground is clicked.
fn click(
    mut pressed: Local<Option<Vec2>>,
    buttons: Res<ButtonInput<MouseButton>>,
    egui: Res<EguiWantsInput>,
    viewer: Res<Viewer>,
    mut gauges: ResMut<Gauges>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform), With<OrbitCamera>>,
) {
    if buttons.just_pressed(MouseButton::Left) {
        *pressed = window.cursor_position().filter(|_| !egui.wants_pointer_input());
    }
    if !buttons.just_released(MouseButton::Left) {
        return;
    }
    let (Some(from), Some(to)) = (pressed.take(), window.cursor_position()) else { return };
    if from.distance(to) > STILL {
        return;
    }
    let Some(ground) = hover::ground(camera.0, camera.1, to, &viewer) else { return };
    let place = viewer.on_map(ground.xz());
    if let Ok(cell) = viewer.cell_on_map(place) {
        // To the decimetre: the pointer is no finer.
        gauges.add((place * 10.0).round() / 10.0, cell);
    }
}

#[cfg(test)]
mod tests;
