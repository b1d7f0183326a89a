//! Gauges as they are seen: a mark on the ground, and a line in a plot of depth over time.
use super::{Depths, Gauge, Gauges, csv};
use crate::viewer::Viewer;
use bevy::prelude::*;
use bevy_egui::{
    EguiContexts,
    egui::{self, Align2, Color32, FontId, LayerId, Order, Stroke, Ui, pos2, vec2 as size},
};
use bevy_freshet::{flood::Flood, panel::OrbitCamera};
use egui_plot::{Corner, HoverPosition, Legend, Line, Plot, PlotPoints, VLine, uniform_grid_spacer};
use freshet_flood::duration::clock;

/// Colours of gauges, one after the other: those of Okabe and Ito (2008), which the colour-blind tell apart, without black.
const COLORS: [Color32; 7] = [
    Color32::from_rgb(230, 159, 0),
    Color32::from_rgb(86, 180, 233),
    Color32::from_rgb(0, 158, 115),
    Color32::from_rgb(240, 228, 66),
    Color32::from_rgb(0, 114, 178),
    Color32::from_rgb(213, 94, 0),
    Color32::from_rgb(204, 121, 167),
];
/// Where tables are saved.
const TABLE: &str = "depths.csv";
/// Times between the lines of a grid, s: from a second to a hundred days.
const SPACES: [f64; 12] =
    [1.0, 5.0, 15.0, 60.0, 300.0, 900.0, 3600.0, 14_400.0, 86_400.0, 432_000.0, 1_728_000.0, 8_640_000.0];

fn color(index: usize) -> Color32 {
    COLORS[index % COLORS.len()]
}

/// Draws the gauges on the ground.
pub fn mark(
    mut contexts: EguiContexts,
    viewer: Res<Viewer>,
    gauges: Res<Gauges>,
    camera: Single<(&Camera, &GlobalTransform), With<OrbitCamera>>,
) -> Result {
    let painter = contexts.ctx_mut()?.layer_painter(LayerId::new(Order::Background, "gauges".into()));
    for (index, gauge) in gauges.list.iter().enumerate() {
        let place = viewer.in_world(gauge.place);
        let height = viewer.terrain.sample(place) * viewer.exaggeration;
        let Ok(at) = camera.0.world_to_viewport(camera.1, vec3(place.x, height, place.y)) else { continue };
        // A pin: its point is the place.
        let (point, head) = (pos2(at.x, at.y), pos2(at.x, at.y - 20.0));
        painter.line_segment([point, head], Stroke::new(2.0, Color32::WHITE));
        painter.circle(head, 8.0, color(index), Stroke::new(1.5, Color32::WHITE));
        painter.text(head, Align2::CENTER_CENTER, index + 1, FontId::proportional(11.0), Color32::BLACK);
    }
    Ok(())
}

/// Draws the depths of all gauges over time.
pub fn plot(
    mut contexts: EguiContexts,
    viewer: Res<Viewer>,
    flood: Single<&Flood>,
    mut gauges: ResMut<Gauges>,
) -> Result {
    if gauges.list.is_empty() {
        return Ok(());
    }
    // Under the clock.
    let window = egui::Window::new("Depth over time").default_pos([14.0, 56.0]).default_size([340.0, 210.0]);
    window.collapsible(!gauges.is_headless).show(contexts.ctx_mut()?, |ui| {
        let gauges = gauges.bypass_change_detection();
        if !gauges.is_headless {
            ui.horizontal(|ui| buttons(ui, &viewer, gauges));
        }
        if let Some(reading) = &gauges.reading {
            ui.weak(format!("reading: {} of {} steps", reading.steps(), viewer.maps.times().len()));
        }
        for gauge in &gauges.list {
            if let Depths::Failed(problem) = &gauge.depths {
                ui.colored_label(ui.visuals().error_fg_color, problem);
            }
        }
        lines(ui, &gauges.list, &flood);
    });
    Ok(())
}

/// What can be done with them.
fn buttons(ui: &mut Ui, viewer: &Viewer, gauges: &mut Gauges) {
    let is_known = gauges.list.iter().all(|gauge| !matches!(gauge.depths, Depths::Unread));
    if ui.add_enabled(is_known, egui::Button::new("Save CSV")).on_hover_text(TABLE).clicked() {
        let saved = std::fs::write(TABLE, csv::table(viewer.maps.times(), &gauges.list));
        gauges.said = Some(saved.map_or_else(|problem| format!("{TABLE}: {problem}"), |()| format!("saved {TABLE}")));
    }
    if ui.button("Clear").clicked() {
        gauges.clear();
    }
    if let Some(said) = &gauges.said {
        ui.weak(said);
    }
}

/// The plot.
fn lines(ui: &mut Ui, gauges: &[Gauge], flood: &Flood) {
    let (first, last) = flood.span();
    let plot = Plot::new("depths")
        .legend(Legend::default().position(Corner::LeftTop).follow_insertion_order(true).background_alpha(0.6))
        .include_x(first)
        .include_x(last)
        .include_y(0.0)
        .y_axis_label("depth (m)")
        .x_axis_formatter(|mark, _| clock(mark.value))
        .x_grid_spacer(uniform_grid_spacer(|input| {
            let index = SPACES.iter().position(|space| *space >= input.base_step_size).unwrap_or(SPACES.len());
            match SPACES.get(index..index + 3) {
                Some(spaces) => [spaces[0], spaces[1], spaces[2]],
                // Farther away than years.
                None => [1.0, 10.0, 100.0].map(|factor| factor * input.base_step_size),
            }
        }))
        .label_formatter(|hover| {
            let (HoverPosition::NearDataPoint { position, .. } | HoverPosition::Elsewhere { position }) = hover;
            Some(format!("{}\n{:.2} m", clock(position.x), position.y))
        });
    plot.min_size(size(120.0, 80.0)).show(ui, |plot| {
        for (index, gauge) in gauges.iter().enumerate() {
            let points = if let Depths::Read(_, line) = &gauge.depths { &line[..] } else { &[] };
            let name = format!("{}: E {} N {}", index + 1, gauge.place.x, gauge.place.y);
            plot.line(Line::new(name, PlotPoints::Borrowed(points)).color(color(index)).width(2.0));
        }
        // Without a name it is not in the legend.
        plot.vline(VLine::new("", flood.usable_time()).color(Color32::WHITE).width(1.5).allow_hover(false));
    });
}
