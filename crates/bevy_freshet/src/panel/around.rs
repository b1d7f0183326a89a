//! What is around a simulated water and in it: edges, sources and walls.
use super::WaterPanel;
use crate::body::{
    CLOSED, DomainSide, Edge, Series, WaterEdge, WaterEdges, WaterSource, WaterSources, WaterWall, WaterWalls,
};
use bevy::{ecs::component::Mutable, prelude::*};
use bevy_egui::egui::{self, ComboBox, DragValue, Response, Ui};

/// What can be outside of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Wall,
    Open,
    Still,
    Stream,
    Level,
    Discharge,
    Periodic,
}

impl Kind {
    const ALL: [(Self, &str, &str); 7] = [
        (Self::Wall, "wall", "Nothing passes."),
        (Self::Open, "open", "Water leaves as it comes; none enters."),
        (Self::Still, "still", "Still water goes on outside; waves leave. Level, m over the still level."),
        (
            Self::Stream,
            "stream",
            "Water goes on outside with a speed, m/s inwards; waves leave. Level, m over the still level.",
        ),
        (Self::Level, "level", "The level at the edge, m over the still level, whatever comes."),
        (Self::Discharge, "discharge", "This much enters, m³/s; negative: leaves."),
        (Self::Periodic, "periodic", "The water goes on at the other side."),
    ];

    fn of(edge: &Edge) -> Self {
        match edge {
            Edge::Wall => Self::Wall,
            Edge::Open => Self::Open,
            Edge::Still(_) => Self::Still,
            Edge::Stream { .. } => Self::Stream,
            Edge::Level(_) => Self::Level,
            Edge::Discharge(_) => Self::Discharge,
        }
    }

    /// An edge of this kind that keeps the level of the one before.
    fn edge(self, before: &Edge) -> Edge {
        let level = match before {
            Edge::Still(level) | Edge::Level(level) | Edge::Stream { level, .. } => level.clone(),
            _ => 0.0.into(),
        };
        match self {
            Self::Wall | Self::Periodic => Edge::Wall,
            Self::Open => Edge::Open,
            Self::Still => Edge::Still(level),
            Self::Stream => Edge::Stream { level, entering: 0.0.into() },
            Self::Level => Edge::Level(level),
            Self::Discharge => Edge::Discharge(0.0.into()),
        }
    }

    fn choose(&mut self, ui: &mut Ui, id: impl core::hash::Hash + core::fmt::Debug, with_periodic: bool) -> Response {
        let [_, name, tip] = Self::ALL.iter().find(|(kind, ..)| kind == self).map_or([""; 3], |k| ["", k.1, k.2]);
        let offered = Self::ALL.iter().filter(|(kind, ..)| with_periodic || *kind != Self::Periodic);
        let combo = ComboBox::from_id_salt(id).width(80.0).selected_text(name).show_ui(ui, |ui| {
            for (kind, name, tip) in offered {
                ui.selectable_value(self, *kind, *name).on_hover_text(*tip);
            }
        });
        combo.response.on_hover_text(tip)
    }
}

/// Draws the three lists, and writes what is changed.
pub(super) fn draw(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, water: Entity) {
    edit(world, water, |edges: &mut WaterEdges| {
        list(ui, panel, "Edges", |ui, panel| draw_edges(ui, panel, edges));
    });
    edit(world, water, |sources: &mut WaterSources| {
        list(ui, panel, "Sources", |ui, panel| draw_sources(ui, panel, &mut sources.sources));
    });
    edit(world, water, |walls: &mut WaterWalls| {
        if !walls.walls.is_empty() {
            list(ui, panel, "Walls", |ui, _| draw_walls(ui, &mut walls.walls));
        }
    });
}

/// Lets `change` change a component, which counts as changed only if it is another one afterwards.
fn edit<C: Component<Mutability = Mutable> + Clone + PartialEq>(
    world: &mut World,
    entity: Entity,
    change: impl FnOnce(&mut C),
) {
    let Some(mut component) = world.get_mut::<C>(entity) else { return };
    let mut wanted = component.clone();
    change(&mut wanted);
    component.set_if_neq(wanted);
}

fn list(ui: &mut Ui, panel: &mut WaterPanel, title: &'static str, add: impl FnOnce(&mut Ui, &mut WaterPanel)) {
    let header = egui::CollapsingHeader::new(title).show(ui, |ui| add(ui, panel));
    panel.note(ui, title, &header.header_response);
}

fn name(side: DomainSide) -> &'static str {
    match side {
        DomainSide::West => "West",
        DomainSide::East => "East",
        DomainSide::North => "North",
        DomainSide::South => "South",
    }
}

/// Whether a part is the whole of its side.
fn is_whole(part: &WaterEdge) -> bool {
    part.from.min(part.to) == f32::NEG_INFINITY && part.from.max(part.to) == f32::INFINITY
}

fn draw_edges(ui: &mut Ui, panel: &mut WaterPanel, edges: &mut WaterEdges) {
    egui::Grid::new("edges").num_columns(3).show(ui, |ui| {
        for side in DomainSide::ALL {
            ui.label(name(side));
            let whole = edges.parts.iter().rposition(|part| part.side == side && is_whole(part));
            let before = kind_of_side(edges, side);
            let mut kind = before;
            let combo = kind.choose(ui, name(side), true);
            panel.note(ui, name(side), &combo);
            if kind != before {
                set_side(edges, side, kind);
            } else if let Some(part) = whole.filter(|_| kind != Kind::Periodic) {
                edge_value(ui, &mut edges.parts[part].edge);
            }
            ui.end_row();
        }
    });
    let mut removed = None;
    for (i, part) in edges.parts.iter_mut().enumerate().filter(|(_, part)| !is_whole(part)) {
        ui.horizontal(|ui| {
            ui.label(format!("{} {:.0}…{:.0} m", name(part.side), part.from, part.to));
            let before = Kind::of(&part.edge);
            let mut kind = before;
            kind.choose(ui, i, false);
            if kind != before {
                part.edge = kind.edge(&part.edge);
            }
            if ui.small_button("Remove").clicked() {
                removed = Some(i);
            }
        });
        edge_value(ui, &mut part.edge);
    }
    if let Some(i) = removed {
        edges.parts.remove(i);
    }
}

/// What is outside a side, but for parts of it.
fn kind_of_side(edges: &WaterEdges, side: DomainSide) -> Kind {
    let wraps = match side {
        DomainSide::West | DomainSide::East => edges.periodic.x,
        DomainSide::North | DomainSide::South => edges.periodic.y,
    };
    let whole = edges.parts.iter().rfind(|part| part.side == side && is_whole(part));
    if wraps { Kind::Periodic } else { whole.map_or(Kind::Wall, |part| Kind::of(&part.edge)) }
}

fn set_side(edges: &mut WaterEdges, side: DomainSide, kind: Kind) {
    let wraps = match side {
        DomainSide::West | DomainSide::East => &mut edges.periodic.x,
        DomainSide::North | DomainSide::South => &mut edges.periodic.y,
    };
    *wraps = kind == Kind::Periodic;
    if kind == Kind::Periodic {
        return;
    }
    if let Some(part) = edges.parts.iter_mut().rfind(|part| part.side == side && is_whole(part)) {
        part.edge = kind.edge(&part.edge);
    } else {
        // Parts of the side come before the whole of it.
        edges.parts.insert(0, WaterEdge::all(side, kind.edge(&Edge::Wall)));
    }
}

fn edge_value(ui: &mut Ui, edge: &mut Edge) {
    match edge {
        Edge::Still(value) | Edge::Level(value) => series(ui, value, " m", 0.01),
        Edge::Discharge(value) => series(ui, value, " m³/s", 0.1),
        Edge::Stream { level, entering } => {
            ui.horizontal(|ui| {
                series(ui, level, " m", 0.01);
                series(ui, entering, " m/s", 0.01);
            });
        }
        Edge::Wall | Edge::Open => {}
    }
}

/// A constant, or the mean and the amplitude of a tide. Tables are only told of.
fn series(ui: &mut Ui, series: &mut Series, unit: &str, speed: f64) {
    let number = |value| DragValue::new(value).speed(speed).suffix(unit).max_decimals(3);
    match series {
        Series::Constant(value) => _ = ui.add(number(value)),
        Series::Tide { mean, amplitude, period, .. } => {
            ui.horizontal(|ui| {
                ui.add(number(mean)).on_hover_text("Mean.");
                ui.add(number(amplitude).prefix("± ")).on_hover_text("Half of the range.");
                let mut hours = *period / 3600.0;
                let hours_edit = DragValue::new(&mut hours).speed(0.05).range(0.01..=1e4).suffix(" h");
                if ui.add(hours_edit).on_hover_text("Time between two high waters.").changed() {
                    *period = 3600.0 * hours;
                }
            });
        }
        Series::Table(pairs) => _ = ui.weak(format!("a table of {} values", pairs.len())),
    }
}

fn draw_sources(ui: &mut Ui, panel: &mut WaterPanel, sources: &mut Vec<WaterSource>) {
    let mut removed = None;
    // An empty grid would leave a gap.
    if !sources.is_empty() {
        egui::Grid::new("sources").num_columns(5).show(ui, |ui| {
            for (i, source) in sources.iter_mut().enumerate() {
                ui.add(DragValue::new(&mut source.at.x).prefix("x ").speed(0.1).max_decimals(2))
                    .on_hover_text("Place, m.");
                ui.add(DragValue::new(&mut source.at.y).prefix("z ").speed(0.1).max_decimals(2))
                    .on_hover_text("Place, m.");
                ui.add(DragValue::new(&mut source.radius).prefix("r ").speed(0.05).range(0.0..=1e4).max_decimals(2))
                    .on_hover_text("Radius over which it is spread, m.");
                series(ui, &mut source.rate, " m³/s", 0.05);
                if ui.small_button("Remove").clicked() {
                    removed = Some(i);
                }
                ui.end_row();
            }
        });
    }
    if let Some(i) = removed {
        sources.remove(i);
    }
    let add = ui.small_button("Add a source").on_hover_text("A spring; with a negative rate a drain.");
    panel.note(ui, "Add a source", &add);
    if add.clicked() {
        sources.push(WaterSource { at: Vec2::ZERO, radius: 2.0, rate: 1.0.into() });
    }
}

fn draw_walls(ui: &mut Ui, walls: &mut [WaterWall]) {
    egui::Grid::new("walls").num_columns(3).show(ui, |ui| {
        for (i, wall) in walls.iter_mut().enumerate() {
            let WaterWall { from, to, crest } = wall;
            ui.label(format!("Wall {}", i + 1)).on_hover_text(format!("From {from} to {to} m."));
            let mut closed = *crest == CLOSED;
            if ui.checkbox(&mut closed, "closed").on_hover_text("Lets nothing pass.").changed() {
                *crest = if closed { CLOSED } else { 0.0 };
            }
            if !closed {
                ui.add(DragValue::new(crest).prefix("crest ").suffix(" m").speed(0.01).max_decimals(3))
                    .on_hover_text("Elevation of its top over the still level.");
            }
            ui.end_row();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_is_what_it_was_set_to_and_its_parts_stay() {
        let gate = WaterEdge { side: DomainSide::West, from: -1.0, to: 2.0, edge: Edge::Open };
        let mut edges = WaterEdges { parts: vec![gate.clone()], ..default() };
        for (kind, ..) in Kind::ALL {
            set_side(&mut edges, DomainSide::West, kind);
            assert_eq!(kind_of_side(&edges, DomainSide::West), kind);
            assert_eq!(edges.periodic, BVec2::new(kind == Kind::Periodic, false));
            assert_eq!(kind_of_side(&edges, DomainSide::South), Kind::Wall);
        }
        assert_eq!((edges.parts.len(), edges.parts.last()), (2, Some(&gate)));
    }

    #[test]
    fn a_level_stays_a_tide_when_its_edge_lets_waves_out() {
        let tide = Series::Tide { mean: 0.1, amplitude: 1.0, period: 100.0, high_water: 0.0 };
        assert_eq!(Kind::Still.edge(&Edge::Level(tide.clone())), Edge::Still(tide.clone()));
        assert_eq!(Kind::Discharge.edge(&Edge::Level(tide)), Edge::Discharge(0.0.into()));
    }
}
