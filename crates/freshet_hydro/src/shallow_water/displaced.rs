//! Room that bodies take up in the water.
use super::{DEEPEST, ShallowWater, ShallowWaterError, number, rounded};
use glam::{IVec2, UVec2};

/// What bodies displace in one cell.
///
/// For the water the bed is higher by that much: it keeps its volume and its momentum, its level rises, and it flows around. So
///
/// * all water that there is stays in the book, and the level of a closed basin rises by V/A;
/// * a body that moves along with the water disturbs nothing, but for what its sides do to the cells: 2 % of its draft;
/// * the water is pushed by −ρ g ∫ h ∇D, and a body by −ρ g ∫ D ∇η. Over a level bed η = h + D + const, and the sum is
///   −ρ g ∫ ∇(h D + D²/2) = 0: what one gets the other gives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displaced {
    /// Column and row of the cell; each at most once.
    pub cell: UVec2,
    /// Displaced volume per area D, m, ≥ 0.
    pub depth: f32,
}

/// Share of what a body does to it that a cell keeps along an axis; its two neighbours have the rest.
const KEPT: f32 = 0.5;

/// Offsets of the nine cells over which is spread what a body does to one, with their shares; the cell itself comes last.
///
/// Upright sides of a body that goes from cell to cell would shake the water otherwise: a ferry that drifts is followed by a third of
/// the ripples, and has half the resistance.
pub fn spread() -> impl Iterator<Item = (IVec2, f32)> {
    let along = |offset: i32| if offset == 0 { KEPT } else { 0.5 * (1.0 - KEPT) };
    let around = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1), (0, 0)];
    around.into_iter().map(move |(x, z)| (IVec2::new(x, z), along(x) * along(z)))
}

/// What bodies displace, put together cell by cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Displacement {
    cells: Vec<Displaced>,
}

impl Displacement {
    /// Forgets all bodies.
    pub fn clear(&mut self) {
        self.cells.clear();
    }

    /// Adds the columns of a body: cells and displaced volume per area, m. Each is shared with its neighbours, as far as they have
    /// `room`: how deep the ground of a cell lies below the surface, m, and nothing outside the domain. No column is higher than that.
    /// Gives what was added; a cell may be there several times.
    pub fn add(
        &mut self,
        columns: impl Iterator<Item = (UVec2, f32)>,
        room: impl Fn(IVec2) -> Option<f32>,
    ) -> &[Displaced] {
        let first = self.cells.len();
        for (cell, depth) in columns {
            let Some(most) = room(cell.as_ivec2()) else { continue };
            let depth = depth.min(most);
            let mut own = depth;
            for (offset, share) in spread().filter(|(offset, _)| *offset != IVec2::ZERO) {
                let beside = cell.as_ivec2() + offset;
                if room(beside).is_some_and(|most| most >= depth) {
                    own -= share * depth;
                    self.cells.push(Displaced { cell: beside.as_uvec2(), depth: share * depth });
                }
            }
            self.cells.push(Displaced { cell, depth: own });
        }
        &self.cells[first..]
    }

    /// Every cell once, row by row, with what all bodies displace in it.
    pub fn cells(&mut self) -> &[Displaced] {
        self.cells.retain(|displaced| displaced.depth > 0.0 && displaced.depth < DEEPEST);
        self.cells.sort_by_key(|displaced| (displaced.cell.y, displaced.cell.x));
        self.cells.dedup_by(|next, kept| {
            let same = next.cell == kept.cell;
            kept.depth += if same { next.depth } else { 0.0 };
            same
        });
        &self.cells
    }
}

/// A cell that bodies are in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Raised {
    index: usize,
    /// Elevation of the bed itself, m.
    ground: f32,
    /// By how much it counts as higher, m.
    by: f32,
}

impl ShallowWater {
    /// Replaces what bodies displace. All other cells are free of them.
    ///
    /// Depths are rounded to 2⁻¹⁶ m as beds are, and what one cell loses by that the next one gets: the sum is kept.
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if a cell is outside, or a depth is negative or not below 1000 km. Nothing has changed then.
    pub fn set_displaced(&mut self, displaced: &[Displaced]) -> Result<(), ShallowWaterError> {
        for Displaced { cell, depth } in displaced {
            if cell.cmpge(self.size()).any() {
                return Err(number("the cell of a body", "inside the domain", cell.max_element() as f32));
            }
            if !(0.0..DEEPEST).contains(depth) {
                return Err(number("a displaced depth", "from 0 to 1000 km", *depth));
            }
        }
        for Raised { index, ground, .. } in self.raised.drain(..).rev() {
            self.bed[index] = ground;
        }
        let mut lost = 0.0;
        for Displaced { cell, depth } in displaced {
            let index = cell.y as usize * self.size.0 + cell.x as usize;
            let by = rounded(depth + lost).max(0.0);
            lost += depth - by;
            self.raised.push(Raised { index, ground: self.bed[index], by });
            self.bed[index] += by;
        }
        Ok(())
    }

    /// The cells that bodies are in, by index, with the elevation of the bed itself and of what counts for the water, m.
    pub fn raised(&self) -> impl Iterator<Item = (usize, [f32; 2])> {
        self.raised.iter().map(|raised| (raised.index, [raised.ground, self.bed[raised.index]]))
    }

    /// Elevation of the bed of every cell without bodies, m.
    pub fn ground(&self) -> Vec<f32> {
        let mut ground = self.bed.clone();
        self.raised.iter().for_each(|raised| ground[raised.index] = raised.ground);
        ground
    }

    /// What all bodies displace, m³.
    pub fn displaced_volume(&self) -> f64 {
        let depths: f64 = self.raised.iter().map(|raised| f64::from(raised.by)).sum();
        depths * f64::from(self.cell_size) * f64::from(self.cell_size)
    }

    /// Puts bodies onto a bed that has been replaced.
    pub(super) fn raise_again(&mut self) {
        for raised in &mut self.raised {
            raised.ground = self.bed[raised.index];
            self.bed[raised.index] += raised.by;
        }
    }
}
