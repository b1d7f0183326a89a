//! What another machine needs to take the same steps, and what it brings back.
use super::{Balance, ShallowWater, edge::EdgeCell};
use crate::waves::GRAVITY;

/// What acts on the water at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Forcing<'a> {
    /// Rain, m/s.
    pub rain: f32,
    /// What point sources add to every cell, m/s; empty if there are none.
    pub sources: &'a [f32],
    /// The fastest signal that may enter at the edges, m/s.
    pub entering: f32,
    /// The longest step that the sources allow, s.
    pub longest_step: f32,
}

/// What [`ShallowWater::restore`] takes over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restored {
    /// Time that has been simulated, s.
    pub time: f64,
    /// Greatest |u| + √(g h), m/s.
    pub fastest_signal: f32,
    /// The book of volumes.
    pub balance: Balance,
}

impl ShallowWater {
    /// Depth (m), carry (m) and discharge along x and z (m²/s) of every cell.
    ///
    /// The carry is what the depth cannot hold: rounding, and water that left twice.
    pub fn conserved(&self) -> impl Iterator<Item = [f32; 4]> {
        let state = &self.now;
        (0..self.bed.len()).map(|i| [state.depth[i], state.discharge_x[i], state.discharge_z[i], state.carry[i]])
    }

    /// Takes over a state that another machine has come to, in the form of [`ShallowWater::conserved`].
    ///
    /// Cells for which `cells` has nothing stay as they are.
    pub fn restore(&mut self, cells: impl Iterator<Item = [f32; 4]>, restored: Restored) {
        for (i, cell) in cells.enumerate().take(self.bed.len()) {
            [self.now.depth[i], self.now.discharge_x[i], self.now.discharge_z[i], self.now.carry[i]] = cell;
        }
        self.time = restored.time;
        self.fastest = restored.fastest_signal;
        self.balance = restored.balance;
    }

    /// What acts on the water at its time.
    pub fn forcing(&mut self) -> Forcing<'_> {
        let entering = self.edges.update(&self.bed, self.cell_size, self.time);
        let rain = self.rain.at(self.time).max(0.0);
        self.update_rates();
        // Water that is added makes waves: of speed √(g s Δt) after Δt at the rate s.
        let rate = self.rates.iter().fold(rain, |most, &rate| most.max(rate + rain));
        let reach = self.courant * self.cell_size;
        let longest_step = libm::cbrtf(reach * reach / (GRAVITY * rate.max(1e-20)));
        Forcing { rain, sources: &self.rates, entering, longest_step }
    }

    /// The kind and the value of every cell's edge as [`ShallowWater::forcing`] has found them, of the western, eastern,
    /// northern and southern side: 0 wall, 1 open, 2 water at a level (m) that goes on with a speed inwards (m/s), 3 a level (m), 4 a
    /// discharge that enters (m²/s).
    pub fn edge_cells(&self) -> impl Iterator<Item = (u32, [f32; 2])> {
        self.edges.cells.iter().flatten().map(|edge| match *edge {
            EdgeCell::Wall => (0, [0.0; 2]),
            EdgeCell::Open => (1, [0.0; 2]),
            EdgeCell::Far { level, entering } => (2, [level, entering]),
            EdgeCell::Level(level) => (3, [level, 0.0]),
            EdgeCell::Discharge(entering) => (4, [entering, 0.0]),
        })
    }

    /// Crests of the eastern and southern face of every cell, m, or `None` if there are no walls. See [`ShallowWater::set_wall`].
    pub fn crests(&self) -> Option<impl Iterator<Item = [f32; 2]>> {
        let crests = self.crests.as_ref()?;
        Some(crests.east.iter().zip(&crests.south).map(|(&east, &south)| [east, south]))
    }

    /// Manning's n, s/m^⅓.
    pub fn manning(&self) -> f32 {
        self.manning
    }

    /// Courant number of a step.
    pub fn courant(&self) -> f32 {
        self.courant
    }

    /// Whether x and z wrap around.
    pub fn periodic(&self) -> (bool, bool) {
        self.edges.periodic
    }

    /// Whether there are point sources.
    pub fn has_sources(&self) -> bool {
        !self.sources.is_empty()
    }
}
