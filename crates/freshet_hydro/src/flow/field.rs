//! The velocities of a steady flow, and discharges measured in them.

use glam::Vec2;

use super::head::Head;
use super::network::Network;
use super::section::{Axis, Face};
use super::{End, Reach, Section};
use crate::grid::Grid;

/// A steady river flow on the cells of a grid.
#[derive(Clone, Debug)]
pub struct FlowField {
    velocity: Grid<Vec2>,
    head: Grid<f32>,
    head_drop: f32,
    reach_cells: usize,
    /// Discharge over the faces with flow in m³/s, positive to the east or south.
    discharges: Vec<(Face, f32)>,
}

impl FlowField {
    /// Scales the head of unit drop to the discharge of the reach and derives everything from it.
    pub(super) fn new(bed: &Grid<f32>, reach: &Reach, network: &Network, depths: &[f64], head: &Head) -> Self {
        let k = &head.conductivity;
        let mut slopes = vec![glam::DVec2::ZERO; depths.len()];
        let mut discharges = Vec::new();
        for ((slope, &[a, b]), &face) in head.inner_slopes(network).zip(&network.edges).zip(&network.inner) {
            let (a, b) = (a as usize, b as usize);
            slopes[a] += 0.5 * along(face.axis, slope);
            slopes[b] += 0.5 * along(face.axis, slope);
            discharges.push((face, 0.5 * (k[a] + k[b]) * slope));
        }
        let mut entering = 0.0;
        for (slope, open) in head.open_slopes(network).zip(&network.open) {
            let cell = open.cell as usize;
            slopes[cell] += 0.5 * along(open.face.axis, slope);
            discharges.push((open.face, k[cell] * slope));
            if open.end == End::Inflow {
                entering += k[cell] * slope.abs();
            }
        }

        // In the units of the head, discharge is n / √(drop · cell size) times that in m³/s: see the module `flow`.
        let cell_size = f64::from(bed.cell_size());
        let scale = f64::from(reach.discharge) / entering;
        let root_of_drop = scale * f64::from(reach.manning) / cell_size.sqrt();
        let head_drop = root_of_drop * root_of_drop;

        let mut velocity = bed.map(|_| Vec2::ZERO);
        let mut heads = bed.map(|_| f32::NAN);
        for (number, &cell) in network.cells.iter().enumerate() {
            let depth = depths[number];
            let discharge_per_width = k[number] * slopes[number] * scale / cell_size;
            velocity.values_mut()[cell] = (discharge_per_width / depth).as_vec2();
            heads.values_mut()[cell] = (head.values[number] * head_drop) as f32;
        }
        Self {
            velocity,
            head: heads,
            head_drop: head_drop as f32,
            reach_cells: depths.len(),
            discharges: discharges.into_iter().map(|(face, discharge)| (face, (discharge * scale) as f32)).collect(),
        }
    }

    /// Depth-averaged velocity (east, south) at cell centres in m/s; zero on land and outside the reach.
    pub fn velocity(&self) -> &Grid<Vec2> {
        &self.velocity
    }

    /// Head at cell centres in metres above that of the outflow section; NaN outside the reach.
    pub fn head(&self) -> &Grid<f32> {
        &self.head
    }

    /// Head of the inflow section above that of the outflow section in metres, above zero: what the surface of the
    /// real river would fall. Check that it is small against the depth, for the computation takes the surface as flat.
    pub fn head_drop(&self) -> f32 {
        self.head_drop
    }

    /// Water surface between the two sections in m², creeks included.
    pub fn area(&self) -> f32 {
        self.reach_cells as f32 * self.velocity.cell_size() * self.velocity.cell_size()
    }

    /// Greatest speed at a cell centre in m/s.
    pub fn max_speed(&self) -> f32 {
        self.speeds().fold(0.0, f32::max)
    }

    /// Mean speed over the water surface of the reach in m/s, creeks included.
    pub fn mean_speed(&self) -> f32 {
        self.speeds().sum::<f32>() / self.reach_cells as f32
    }

    fn speeds(&self) -> impl Iterator<Item = f32> {
        self.velocity.values().iter().map(|velocity| velocity.length())
    }

    /// Discharge through a section in m³/s, positive to the right-hand side of its direction.
    ///
    /// Summed over the cell faces it crosses, so every section that closes the channel has the discharge of the reach
    /// but for rounding.
    pub fn discharge_through(&self, section: &Section) -> f32 {
        self.discharges.iter().map(|(face, discharge)| face.crossing(&self.velocity, section) * discharge).sum()
    }

    /// Up to `count` sections across the river, evenly spaced in head between the two ends of the reach.
    ///
    /// Each passes through the fastest cell of its band of heads, at right angles to the flow there, and ends where the
    /// velocity does; its direction is such that the flow is positive.
    pub fn sections(&self, count: usize) -> Vec<Section> {
        let mut fastest = vec![None; count];
        let cells = self.head.iter().zip(self.velocity.values());
        for ((cell, head), &velocity) in cells.filter(|((_, head), _)| !head.is_nan()) {
            let band = ((1.0 - head / self.head_drop) * count as f32) as usize;
            if let Some(best) = fastest.get_mut(band)
                && best.is_none_or(|(_, other): (_, Vec2)| velocity.length() > other.length())
            {
                *best = Some((cell, velocity));
            }
        }
        let fastest = fastest.into_iter().flatten();
        fastest
            .map(|(cell, velocity)| {
                // The flow goes to the right of whoever walks along the section: `Section::normal`.
                let along = -velocity.normalize_or_zero().perp();
                let centre = self.velocity.position(cell);
                Section::new(self.edge_of_flow(centre, -along), self.edge_of_flow(centre, along))
            })
            .collect()
    }

    /// The first point without velocity on the way from `point` in `direction`, a unit vector.
    fn edge_of_flow(&self, mut point: Vec2, direction: Vec2) -> Vec2 {
        let step = 0.25 * self.velocity.cell_size() * direction;
        let flows = |point: Vec2| self.velocity.cell_at(point).is_some() && self.velocity.sample(point) != Vec2::ZERO;
        while step != Vec2::ZERO && flows(point) {
            point += step;
        }
        point
    }
}

/// Discharge in m³/s through a section, positive to the right-hand side of its direction, as a shader or a floating body
/// would see it: the integral along the section of bilinear `velocity` (m/s) times depth under `level` over the bilinear
/// `bed` (both in metres; where there are no data, and outside the grid, no depth). The section has finite ends.
///
/// `velocity` may come from [`steady_flow`](super::steady_flow) or from a painter; the two grids share their centre.
pub fn discharge_across(velocity: &Grid<Vec2>, bed: &Grid<f32>, level: f32, section: &Section) -> f32 {
    // A tenth of a cell is fine enough for the midpoint rule on pieces of parabolas.
    let steps = (section.length() / (0.1 * bed.cell_size())).ceil().max(1.0);
    let width = section.length() / steps;
    let normal = section.normal();
    (0..steps as usize)
        .map(|step| {
            let point = section.from.lerp(section.to, (step as f32 + 0.5) / steps);
            if bed.cell_at(point).is_none() {
                return 0.0;
            }
            let depth = (level - bed.sample(point)).max(0.0);
            velocity.sample(point).dot(normal) * depth * width
        })
        .sum()
}

fn along(axis: Axis, value: f64) -> glam::DVec2 {
    match axis {
        Axis::X => glam::DVec2::new(value, 0.0),
        Axis::Z => glam::DVec2::new(0.0, value),
    }
}
