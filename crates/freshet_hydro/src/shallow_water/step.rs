//! One step of the whole domain: bands of rows side by side, in each band strips of columns, row after row.
use super::{
    edge::{self, DomainSide, EdgeCell},
    rows::{COLUMNS, Cells, FIRST, Faces, Fluxes, Kept, LANES, SPAN, Values},
    scheme::Flux,
    strip::{Beside, Met, Numbers, Surroundings},
};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of a band of a domain with so many. They do not depend on the number of threads, so that sums over a band do not either.
/// Small domains have lower bands, so that they have more than one.
pub(super) fn band(rows: usize) -> usize {
    if rows <= 128 { 32 } else { 64 }
}

/// The conserved numbers of all cells, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct State {
    pub depth: Vec<f32>,
    pub carry: Vec<f32>,
    pub discharge_x: Vec<f32>,
    pub discharge_z: Vec<f32>,
}

/// Crests of the faces between cells, m: that of a cell's eastern and southern face.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Crests {
    pub east: Vec<f32>,
    pub south: Vec<f32>,
}

/// What a step reads beside the state.
pub(super) struct Surround<'a> {
    /// Columns and rows.
    pub size: (usize, usize),
    pub bed: &'a [f32],
    pub crests: Option<&'a Crests>,
    /// Cells of the western, eastern, northern and southern side.
    pub edges: &'a [Vec<EdgeCell>; 4],
    /// Whether x and z wrap around.
    pub periodic: (bool, bool),
    /// Point sources, m/s, of every cell, or nothing.
    pub sources: &'a [f32],
}

/// What a band has met in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    /// Greatest |u| + c, m/s.
    pub fastest: f32,
    /// Volume that left through each side, as a sum of discharges per width, m²/s.
    pub left: [f64; 4],
    /// What fell and sprang, as a sum of depths, m. Counted only if there are point sources.
    pub given: f64,
}

/// Rows that a band works on, as many of each as are needed at once. They begin at cache lines, and so do their blocks.
#[derive(Clone)]
#[repr(align(64))]
pub(super) struct Rows {
    cells: [Cells; 3],
    faces: Faces,
    kept: [Kept; 2],
    x: Fluxes,
    z: [Fluxes; 2],
    /// The point sources of the row at hand, m/s.
    sources: Values,
    tally: Tally,
}

impl Default for Rows {
    fn default() -> Self {
        Self {
            cells: Default::default(),
            faces: Faces::default(),
            kept: Default::default(),
            x: Fluxes::default(),
            z: Default::default(),
            sources: [0.0; SPAN],
            tally: Tally::default(),
        }
    }
}

impl State {
    pub fn dry(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self { depth: zeros(), carry: zeros(), discharge_x: zeros(), discharge_z: zeros() }
    }
}

/// Part of a state that a band writes.
pub(super) struct StateMut<'a> {
    pub depth: &'a mut [f32],
    pub carry: &'a mut [f32],
    pub discharge_x: &'a mut [f32],
    pub discharge_z: &'a mut [f32],
}

/// Takes the step `numbers` from `old` to `new`.
pub(super) fn step(new: &mut State, old: &State, around: &Surround, numbers: Numbers, rows: &mut [Rows]) -> Tally {
    let arch = Arch::new();
    let band = band(around.size.1);
    let chunk = band * around.size.0;
    let bands = (
        new.depth.par_chunks_mut(chunk),
        new.carry.par_chunks_mut(chunk),
        new.discharge_x.par_chunks_mut(chunk),
        new.discharge_z.par_chunks_mut(chunk),
        rows.par_iter_mut(),
    );
    bands.into_par_iter().enumerate().for_each(|(n, (depth, carry, discharge_x, discharge_z, rows))| {
        let new = StateMut { depth, carry, discharge_x, discharge_z };
        arch.dispatch(Band { rows, new, old, around, numbers, first: n * band });
    });
    let mut total = Tally::default();
    for rows in rows.iter() {
        total.fastest = total.fastest.max(rows.tally.fastest);
        for (sum, left) in total.left.iter_mut().zip(rows.tally.left) {
            *sum += left;
        }
        total.given += rows.tally.given;
    }
    total
}

/// The same on this thread, as one band.
pub(super) fn step_alone(new: &mut State, old: &State, around: &Surround, numbers: Numbers, rows: &mut Rows) {
    let State { depth, carry, discharge_x, discharge_z } = new;
    let new = StateMut { depth, carry, discharge_x, discharge_z };
    Arch::new().dispatch(Band { rows, new, old, around, numbers, first: 0 });
}

/// The work on one band, compiled once for every set of vector instructions.
struct Band<'a> {
    rows: &'a mut Rows,
    new: StateMut<'a>,
    old: &'a State,
    around: &'a Surround<'a>,
    numbers: Numbers,
    first: usize,
}

impl WithSimd for Band<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        self.rows.step(&mut self.new, self.old, self.around, self.numbers, self.first);
    }
}

impl Rows {
    #[inline(always)]
    fn step(&mut self, new: &mut StateMut, old: &State, around: &Surround, numbers: Numbers, first: usize) {
        self.tally = Tally::default();
        let columns = around.size.0;
        for west in (0..columns).step_by(COLUMNS) {
            let strip = Strip { around, old, west, width: COLUMNS.min(columns - west) };
            self.step_strip(new, &strip, numbers, first);
        }
    }

    /// The rows `first` and following of one strip. Each row of cells that is read makes one more row of fluxes and one more
    /// row of the new state.
    #[inline(always)]
    fn step_strip(&mut self, new: &mut StateMut, strip: &Strip, numbers: Numbers, first: usize) {
        let columns = strip.around.size.0;
        let (start, end) = (first as isize, (first + new.depth.len() / columns) as isize);
        let mut met = Met::default();
        strip.load(&mut self.cells[slot(start - 2, 3)], start - 2, numbers);
        strip.load(&mut self.cells[slot(start - 1, 3)], start - 1, numbers);
        for row in start - 1..=end {
            strip.load(&mut self.cells[slot(row + 1, 3)], row + 1, numbers);
            if strip.shows(row) {
                self.reconstruct(strip, numbers, row);
            }
            if row < start {
                continue;
            }
            strip.solve_z(
                &mut self.z[slot(row, 2)],
                &self.kept[slot(row - 1, 2)],
                &self.faces,
                &self.kept[slot(row, 2)],
                row,
            );
            if row > start {
                self.update(&mut met, new, strip, numbers, row - 1, (row - 1 - start) as usize);
            }
            if row < end {
                strip.solve_x(&mut self.x, &self.faces, &self.kept[slot(row, 2)], row);
            }
        }
        self.tally.fastest = self.tally.fastest.max(met.fastest());
        self.tally.given += met.given;
    }

    #[inline(always)]
    fn reconstruct(&mut self, strip: &Strip, numbers: Numbers, row: isize) {
        let cells = [row - 1, row, row + 1].map(|row| &self.cells[slot(row, 3)]);
        let kept = &mut self.kept[slot(row, 2)];
        self.faces.reconstruct(kept, (cells[0], cells[1], cells[2]), strip.shown(), numbers);
    }

    /// Writes row `row` of the domain, row `at` of the band.
    #[inline(always)]
    fn update(&mut self, met: &mut Met, new: &mut StateMut, strip: &Strip, numbers: Numbers, row: isize, at: usize) {
        let columns = strip.around.size.0;
        let (from, to) = (row as usize * columns + strip.west, at * columns + strip.west);
        let (north, south) = (&self.z[slot(row, 2)], &self.z[slot(row + 1, 2)]);
        let kept = &self.kept[slot(row, 2)];
        let sources = (!strip.around.sources.is_empty()).then(|| {
            self.sources[FIRST..FIRST + strip.width].copy_from_slice(&strip.around.sources[from..from + strip.width]);
            &self.sources
        });
        let around = Surroundings { x: &self.x, north, south, kept, sources };
        met.update((new, to), (strip.old, from), &around, numbers, strip.width);
        strip.tally(&mut self.tally.left, &self.x, north, south, row);
    }
}

fn total(values: &[f32]) -> f64 {
    values.iter().map(|&value| f64::from(value)).sum()
}

fn slot(row: isize, slots: isize) -> usize {
    row.rem_euclid(slots) as usize
}

/// A strip of columns of the old state.
struct Strip<'a> {
    around: &'a Surround<'a>,
    old: &'a State,
    west: usize,
    width: usize,
}

impl Strip<'_> {
    /// Whether there are cells west and east of the strip.
    fn goes_on(&self) -> (bool, bool) {
        let wraps = self.around.periodic.0;
        (wraps || self.west > 0, wraps || self.west + self.width < self.around.size.0)
    }

    /// Whether there are cells in this row, which may be outside the domain.
    fn shows(&self, row: isize) -> bool {
        self.around.periodic.1 || (row >= 0 && row < self.around.size.1 as isize)
    }

    /// Places of the cells whose faces are needed: its own and their neighbours, if there are any.
    fn shown(&self) -> Range<usize> {
        let (west, east) = self.goes_on();
        FIRST - if west { LANES } else { 0 }..FIRST + self.width + usize::from(east)
    }

    /// Index of the cell at place `k` in the row `inside` the domain, or of the one that stands for it.
    #[inline(always)]
    fn index(&self, k: usize, inside: usize) -> usize {
        let columns = self.around.size.0;
        inside * columns + within((self.west + k) as isize - FIRST as isize, columns, self.around.periodic.0)
    }

    /// Reads the row `row`, which may lie outside the domain, with the cells beyond its ends that its faces need.
    #[inline(always)]
    fn load(&self, cells: &mut Cells, row: isize, numbers: Numbers) {
        let (columns, rows) = self.around.size;
        let (old, bed) = (self.old, self.around.bed);
        let inside = within(row, rows, self.around.periodic.1);
        cells.load(old, bed, inside * columns + self.west, self.width);
        let (west, east) = self.goes_on();
        let end = FIRST + self.width;
        if west {
            [FIRST - 2, FIRST - 1].into_iter().for_each(|k| cells.load_one(old, bed, self.index(k, inside), k));
        }
        if east {
            [end, end + 1].into_iter().for_each(|k| cells.load_one(old, bed, self.index(k, inside), k));
        }
        self.continue_bed(cells, row, inside);
        cells.slow(self.shown(), numbers);
    }

    /// Beyond its sides the bed goes on with the slope that it has there, so that a river flows out as if it went on; but not
    /// from a bank, where still water would be drawn up.
    #[inline(always)]
    fn continue_bed(&self, cells: &mut Cells, row: isize, inside: usize) {
        let (columns, rows) = self.around.size;
        let beyond = |cell: usize, next: usize| {
            let here = self.around.bed[cell];
            if self.old.depth[next] > 0.0 { here + (here - self.around.bed[next]) } else { here }
        };
        let (west, east) = self.goes_on();
        let end = FIRST + self.width;
        if inside as isize != row && !self.around.periodic.1 && rows > 1 {
            let next = if row < 0 { 1 } else { rows - 2 };
            for k in FIRST - usize::from(west)..end + usize::from(east) {
                cells.repeat(k, k, beyond(self.index(k, inside), self.index(k, next)));
            }
        }
        let (first, last) = (inside * columns, (inside + 1) * columns - 1);
        if !west {
            cells.repeat(FIRST, FIRST - 1, beyond(first, (first + 1).min(last)));
        }
        if !east {
            cells.repeat(end - 1, end, beyond(last, last.saturating_sub(1).max(first)));
        }
    }

    /// Fluxes through the western faces of the row, and of the cell east of the strip.
    #[inline(always)]
    fn solve_x(&self, x: &mut Fluxes, faces: &Faces, kept: &Kept, row: isize) {
        let end = FIRST + self.width;
        let (west, east) = self.goes_on();
        let range = FIRST..end + usize::from(east);
        let row = row as usize;
        let before = Beside { sides: &faces.east, broken: &kept.broken };
        let after = Beside { sides: &faces.west, broken: &kept.broken };
        match self.around.crests {
            None => x.solve(before, after, 1, range, None),
            Some(crests) => {
                let mut own = [f32::NEG_INFINITY; SPAN];
                for k in range.clone() {
                    own[k] = crests.east[self.index(k - 1, row)];
                }
                x.solve(before, after, 1, range, Some(&own));
            }
        }
        if !west {
            let flux = edge::flux(flipped(faces.west.get(FIRST)), self.around.edges[DomainSide::West as usize][row]);
            x.set(FIRST, backwards(flux));
        }
        if !east {
            x.set(end, edge::flux(faces.east.get(end - 1), self.around.edges[DomainSide::East as usize][row]));
        }
    }

    /// Fluxes through the northern faces of the row.
    #[inline(always)]
    fn solve_z(&self, z: &mut Fluxes, above: &Kept, faces: &Faces, kept: &Kept, row: isize) {
        let range = FIRST..FIRST + self.width;
        let (columns, rows) = self.around.size;
        let wraps = self.around.periodic.1;
        let column = |k: usize| self.west + k - FIRST;
        if !self.shows(row - 1) {
            let edges = &self.around.edges[DomainSide::North as usize];
            range.for_each(|k| z.set(k, backwards(edge::flux(flipped(faces.north.get(k)), edges[column(k)]))));
            return;
        }
        if !self.shows(row) {
            let edges = &self.around.edges[DomainSide::South as usize];
            range.for_each(|k| z.set(k, edge::flux(above.south.get(k), edges[column(k)])));
            return;
        }
        let before = Beside { sides: &above.south, broken: &above.broken };
        let after = Beside { sides: &faces.north, broken: &kept.broken };
        match self.around.crests {
            None => z.solve(before, after, 0, range, None),
            Some(crests) => {
                let from = within(row - 1, rows, wraps) * columns + self.west;
                let mut own = [f32::NEG_INFINITY; SPAN];
                own[range.clone()].copy_from_slice(&crests.south[from..from + self.width]);
                z.solve(before, after, 0, range, Some(&own));
            }
        }
    }

    /// Adds what left through the sides of the domain next to the row.
    #[inline(always)]
    fn tally(&self, left: &mut [f64; 4], x: &Fluxes, north: &Fluxes, south: &Fluxes, row: isize) {
        let (columns, rows) = self.around.size;
        if !self.around.periodic.0 {
            if self.west == 0 {
                left[DomainSide::West as usize] -= f64::from(x.mass[FIRST]);
            }
            if self.west + self.width == columns {
                left[DomainSide::East as usize] += f64::from(x.mass[FIRST + self.width]);
            }
        }
        if !self.around.periodic.1 {
            let sum = |fluxes: &Fluxes| total(&fluxes.mass[FIRST..FIRST + self.width]);
            if row == 0 {
                left[DomainSide::North as usize] -= sum(north);
            }
            if row + 1 == rows as isize {
                left[DomainSide::South as usize] += sum(south);
            }
        }
    }
}

/// The column or row inside the domain that stands for one that may be outside: across the domain, or the one at its edge.
#[inline(always)]
fn within(at: isize, count: usize, wraps: bool) -> usize {
    let count = count as isize;
    let inside = if wraps { at.rem_euclid(count) } else { at.clamp(0, count - 1) };
    inside as usize
}

fn flipped(side: super::scheme::Side) -> super::scheme::Side {
    super::scheme::Side { normal: -side.normal, ..side }
}

/// A flux out of the domain at its western or northern side, as a flux along the axis.
fn backwards(flux: Flux) -> Flux {
    Flux { mass: -flux.mass, before: 0.0, after: flux.before, tangential: -flux.tangential }
}
