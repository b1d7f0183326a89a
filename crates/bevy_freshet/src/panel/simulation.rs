//! The simulation of a water: pause, step and reset, how it stands, its settings, and what is around it.
use super::{
    WaterPanel, around,
    group::{self, Group, Owner},
    rows::{choice, row},
    scale::shown,
};
use crate::body::{
    ResetSimulation, SimulationBackend, SimulationStart, SimulationState, StepSimulation, Water, WaterSimulation,
};
use bevy::prelude::*;
use bevy_egui::egui::{self, Button, ComboBox, DragValue, Ui};
use core::any::TypeId;

/// The settings that are one number or choice.
pub(super) const SETTINGS: Group = Group {
    title: "Simulation",
    owner: Owner::Water,
    component: TypeId::of::<WaterSimulation>,
    // Another size of the cells begins anew.
    on_release: true,
    rows: &[
        row("Cell size", "cell_size", [0.05, 50.0], "m", "Resolution. The water begins anew.").logarithmic(),
        row("Manning's n", "manning", [0.0, 0.2], "s/m^⅓", "Roughness of the bed; rivers have 0.025 to 0.05."),
        row("Ground", "ground", [-50.0, 50.0], "m", "Elevation where there is no bed, over the still level."),
        row("Rainfall", "rain", [0.0, 500.0], "mm/h", "Rain that adds to the water.").logarithmic(),
        row("Push of bodies", "push", [0.0, 10.0], "", "Drag coefficient of bodies as the water feels it."),
        row(
            "Blend",
            "blend",
            [0.0, 50.0],
            "m",
            "Width of the rim in which it passes into water that is not simulated.",
        ),
        row("Time factor", "speed", [0.0, 1e4], "", "Simulated seconds in a second.").logarithmic(),
        row("Most steps", "max_steps", [1.0, 4096.0], "", "In a frame; if more were needed the water runs late.")
            .logarithmic(),
        choice("Backend", "backend", "Where it is simulated. The water begins anew."),
    ],
};

/// Draws the section, and writes what is changed. Nothing for a water that is not simulated.
pub(super) fn draw(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, water: Entity) {
    if world.get::<WaterSimulation>(water).is_none() {
        return;
    }
    let header = egui::CollapsingHeader::new(SETTINGS.title).show(ui, |ui| {
        clock(ui, world, panel, water);
        let state = world.get::<SimulationState>(water).copied().unwrap_or_default();
        ui.label(progress(&state));
        balance(ui, panel, &state);
        start(ui, world, water);
        area(ui, world, water);
        group::draw_rows(ui, world, panel, water, &SETTINGS);
        around::draw(ui, world, panel, water);
    });
    panel.note(ui, SETTINGS.title, &header.header_response);
}

fn clock(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, water: Entity) {
    let Some(paused) = world.get::<WaterSimulation>(water).map(|simulation| simulation.paused) else { return };
    ui.horizontal(|ui| {
        let pause = ui.add(Button::new("Pause").selected(paused)).on_hover_text("Lets this water stand still.");
        panel.note(ui, "Pause simulation", &pause);
        if pause.clicked()
            && let Some(mut simulation) = world.get_mut::<WaterSimulation>(water)
        {
            simulation.paused = !paused;
        }
        let step = ui.add_enabled(paused, Button::new("Step"));
        panel.note(ui, "Step simulation", &step);
        if step.on_hover_text("Takes one step.").on_disabled_hover_text("Takes one step while it is paused.").clicked()
        {
            world.trigger(StepSimulation(water));
        }
        let reset = ui.button("Reset").on_hover_text("Begins anew.");
        panel.note(ui, "Reset simulation", &reset);
        if reset.clicked() {
            world.trigger(ResetSimulation(water));
        }
    });
}

/// How far it has come, in three lines.
fn progress(state: &SimulationState) -> String {
    let SimulationState { cells, cell_size, time, steps, step, late, age, .. } = state;
    let backend = match state.backend {
        SimulationBackend::Auto => return "It has not begun.".into(),
        SimulationBackend::Gpu => "GPU",
        SimulationBackend::Cpu => "CPU",
    };
    let (time, late) = (duration(*time), duration(*late));
    format!(
        "{} × {} cells of {} m, on the {backend}\n{time} simulated, {late} late\n\
         steps: {steps} of {step:.4} s, state {age:.2} s old",
        cells.x,
        cells.y,
        shown(*cell_size)
    )
}

/// A time in seconds, or in hours and minutes.
fn duration(seconds: f64) -> String {
    if seconds < 3600.0 {
        return format!("{seconds:.2} s");
    }
    let minutes = (seconds / 60.0).floor();
    format!("{:.0} h {:02.0} min", (minutes / 60.0).floor(), minutes.rem_euclid(60.0))
}

/// A volume in a form that is always as wide.
fn volume(cubic_metres: f64) -> String {
    let digits = if cubic_metres.abs() < 1e9 { format!("{cubic_metres:.2}") } else { format!("{cubic_metres:.6e}") };
    format!("{:>14}", if digits == "-0.00" { "0.00" } else { &digits })
}

fn balance(ui: &mut Ui, panel: &mut WaterPanel, state: &SimulationState) {
    let [west, east, north, south] = state.balance.left.map(|left| volume(-left));
    let rows = [
        ("Start", volume(state.balance.before), "What there was at the start."),
        ("Rain", volume(state.balance.rain), "What fell as rain."),
        ("Sources", volume(state.balance.sources), "What springs gave, less what drains took."),
        ("West", west, "What entered from the west, less what left there."),
        ("East", east, "What entered from the east, less what left there."),
        ("North", north, "What entered from the north, less what left there."),
        ("South", south, "What entered from the south, less what left there."),
        ("Now", volume(state.volume), "What there is now."),
        ("Error", format!("{:>14.1e}", state.error()), "What is there now and none of the above explains."),
    ];
    let header = egui::CollapsingHeader::new("Volumes, m³").default_open(true).show(ui, |ui| {
        egui::Grid::new("volumes").num_columns(2).striped(true).min_col_width(90.0).show(ui, |ui| {
            for (name, value, tip) in rows {
                ui.label(name).on_hover_text(tip);
                ui.monospace(value).on_hover_text(tip);
                ui.end_row();
            }
        });
    });
    panel.note(ui, "Volumes", &header.header_response);
}

/// What there is at the beginning. Another start begins anew.
fn start(ui: &mut Ui, world: &mut World, water: Entity) {
    const COLUMN: SimulationStart = SimulationStart::Column { at: Vec2::ZERO, half_size: Vec2::splat(5.0), level: 2.0 };
    let Some(before) = world.get::<WaterSimulation>(water).map(|simulation| simulation.start) else { return };
    let mut now = before;
    let is_column = matches!(before, SimulationStart::Column { .. });
    let name = match before {
        SimulationStart::Still => "still water",
        SimulationStart::Dry => "nothing",
        SimulationStart::Column { .. } => "a column",
    };
    let combo = ComboBox::from_label("Start").selected_text(name).show_ui(ui, |ui| {
        ui.selectable_value(&mut now, SimulationStart::Still, "still water");
        ui.selectable_value(&mut now, SimulationStart::Dry, "nothing");
        ui.selectable_value(&mut now, if is_column { before } else { COLUMN }, "a column");
    });
    combo.response.on_hover_text("What there is at the beginning. The water begins anew.");
    if let SimulationStart::Column { at, half_size, level } = &mut now {
        ui.horizontal(|ui| {
            ui.add(DragValue::new(&mut at.x).prefix("x ").speed(0.1)).on_hover_text("Middle of the column, m.");
            ui.add(DragValue::new(&mut at.y).prefix("z ").speed(0.1)).on_hover_text("Middle of the column, m.");
            for (half, name) in [(&mut half_size.x, "± "), (&mut half_size.y, "± ")] {
                ui.add(DragValue::new(half).prefix(name).speed(0.1).range(0.0..=1e5))
                    .on_hover_text("Half of its side along x and z, m.");
            }
            ui.add(DragValue::new(level).suffix(" m").speed(0.02)).on_hover_text("Level over the still level, m.");
        });
    }
    if now != before
        && let Some(mut simulation) = world.get_mut::<WaterSimulation>(water)
    {
        simulation.start = now;
    }
}

fn area(ui: &mut Ui, world: &mut World, water: Entity) {
    let Some(before) = world.get::<WaterSimulation>(water).map(|simulation| simulation.area) else { return };
    let size = world.get::<Water>(water).map_or(Vec2::ONE, |water| water.size);
    let mut now = before;
    let mut is_part = before.is_some();
    ui.checkbox(&mut is_part, "Only a part").on_hover_text("Simulates a part of the water. It begins anew.");
    if is_part != before.is_some() {
        now = is_part.then(|| Rect::from_center_size(Vec2::ZERO, 0.5 * size));
    }
    if let Some(area) = &mut now {
        ui.horizontal(|ui| {
            for (side, name) in
                [(&mut area.min.x, "x "), (&mut area.max.x, "… "), (&mut area.min.y, "z "), (&mut area.max.y, "… ")]
            {
                ui.add(DragValue::new(side).prefix(name).speed(0.5)).on_hover_text("From the middle of the water, m.");
            }
        });
    }
    if now != before
        && let Some(mut simulation) = world.get_mut::<WaterSimulation>(water)
    {
        simulation.area = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_volumes_are_readable() {
        assert_eq!([0.5, 3599.0, 3600.0, 45_296.0].map(duration), ["0.50 s", "3599.00 s", "1 h 00 min", "12 h 34 min"]);
        let volumes = [-12.346, -1e-9, 1.234_567_8e9].map(volume);
        assert_eq!(volumes, ["        -12.35", "          0.00", "    1.234568e9"]);
    }
}
