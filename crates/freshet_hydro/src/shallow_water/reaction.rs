//! What a body does to the water by the room that it takes up, as the scheme has it.
use super::{
    Displaced, ShallowWater,
    step::{self, Crests, Rows, State, Surround},
    strip::Numbers,
};
use glam::{DVec2, UVec2, Vec2};

/// Cells around a body that its faces are reconstructed from, and one more.
const MARGIN: u32 = 3;

/// A few cells of the water, around which it goes on at the other side.
#[derive(Clone, Default)]
pub(super) struct Window {
    size: (usize, usize),
    state: State,
    new: State,
    bed: Vec<f32>,
    crests: Option<Crests>,
    rows: Box<Rows>,
}

impl ShallowWater {
    /// Force on the water, per density (x, z), m⁴/s², that a body exerts which displaces `own` among all that is displaced: what the
    /// momentum of a step of `dt` (s) would be less without it, if the same level had been water throughout.
    ///
    /// It is −g ∫ h ∇D + g ∫ D ∇b, of which the opposite is the horizontal force of the pressure on the body; but summed as the scheme
    /// does it: a copy of the cells around the body takes the step with and without it.
    pub fn reaction(&mut self, own: &[Displaced], dt: f64) -> Vec2 {
        let cells = || own.iter().map(|displaced| displaced.cell).filter(|cell| cell.cmplt(self.size()).all());
        let Some((least, most)) = cells().map(|cell| (cell, cell)).reduce(|(a, b), (c, d)| (a.min(c), b.max(d))) else {
            return Vec2::ZERO;
        };
        let least = least.saturating_sub(UVec2::splat(MARGIN));
        let size = (most + MARGIN + 1).min(self.size()) - least;
        let dt = (dt as f32).min(self.courant * self.cell_size / self.fastest.max(1e-20));
        let mut window = std::mem::take(&mut self.window);
        window.copy(self, least, size);
        let with = window.gain(self.cell_size, dt);
        window.copy(self, least, size);
        for Displaced { cell, depth } in own.iter().filter(|displaced| displaced.cell.cmplt(self.size()).all()) {
            let place = *cell - least;
            let index = place.y as usize * window.size.0 + place.x as usize;
            window.bed[index] -= depth;
            window.state.depth[index] += depth;
        }
        let without = window.gain(self.cell_size, dt);
        self.window = window;
        let force = (with - without) / f64::from(dt) * f64::from(self.cell_size).powi(2);
        if force.is_finite() { force.as_vec2() } else { Vec2::ZERO }
    }
}

impl Window {
    /// Copies so many cells of the water from the cell `first` on.
    fn copy(&mut self, water: &ShallowWater, first: UVec2, size: UVec2) {
        self.size = (size.x as usize, size.y as usize);
        let columns = water.size.0;
        let copy = |to: &mut Vec<f32>, from: &[f32]| {
            to.clear();
            for row in first.y as usize..(first.y + size.y) as usize {
                let start = row * columns + first.x as usize;
                to.extend_from_slice(&from[start..start + size.x as usize]);
            }
        };
        copy(&mut self.bed, &water.bed);
        copy(&mut self.state.depth, &water.now.depth);
        copy(&mut self.state.carry, &water.now.carry);
        copy(&mut self.state.discharge_x, &water.now.discharge_x);
        copy(&mut self.state.discharge_z, &water.now.discharge_z);
        self.new.clone_from(&self.state);
        self.crests = water.crests.as_ref().map(|crests| {
            let mut own = Crests { east: Vec::new(), south: Vec::new() };
            copy(&mut own.east, &crests.east);
            copy(&mut own.south, &crests.south);
            own
        });
    }

    /// What a step of `dt` (s) adds to the sum of all discharges (x, z), m²/s. The window wraps around, so that nothing enters or leaves.
    fn gain(&mut self, cell_size: f32, dt: f32) -> DVec2 {
        let no_edges = [const { Vec::new() }; 4];
        let around = Surround {
            size: self.size,
            bed: &self.bed,
            crests: self.crests.as_ref(),
            edges: &no_edges,
            periodic: (true, true),
            sources: &[],
        };
        let numbers = Numbers { dt, ratio: dt / cell_size, drag: 0.0, rain: 0.0 };
        step::step_alone(&mut self.new, &self.state, &around, numbers, &mut self.rows);
        let sum = |values: &[f32]| values.iter().map(|&value| f64::from(value)).sum::<f64>();
        let total = |state: &State| DVec2::new(sum(&state.discharge_x), sum(&state.discharge_z));
        total(&self.new) - total(&self.state)
    }
}
