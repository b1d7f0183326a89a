//! One step of the whole domain: bands of rows side by side, in each band strips of columns, row after row.
use super::{
    edge::{self, DomainSide, EdgeCell},
    scheme::Flux,
    strip::{Beside, COLUMNS, Cells, Faces, Fluxes, HALO, Numbers, SPAN, StateRows, Surroundings, Updated, Values},
};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of a band. The same for every number of threads, so that sums over a band are too.
pub(super) const BAND: usize = 64;

/// The conserved numbers of all cells, row by row.
#[derive(Clone, Debug, PartialEq)]
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

/// Rows that a band works on.
#[derive(Clone)]
pub(super) struct Rows {
    /// The old state, the bed and the sources of the row at hand.
    old: StateRows,
    bed: Values,
    sources: Values,
    cells: [Cells; 3],
    faces: [Faces; 2],
    x: [Fluxes; 2],
    z: [Fluxes; 2],
    updated: Updated,
    tally: Tally,
}

impl Default for Rows {
    fn default() -> Self {
        Self {
            old: StateRows::default(),
            bed: [0.0; SPAN],
            sources: [0.0; SPAN],
            cells: Default::default(),
            faces: Default::default(),
            x: Default::default(),
            z: Default::default(),
            updated: Updated::default(),
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
struct StateMut<'a> {
    depth: &'a mut [f32],
    carry: &'a mut [f32],
    discharge_x: &'a mut [f32],
    discharge_z: &'a mut [f32],
}

impl StateRows {
    /// Reads a part of a row of `state`, to cell `at` and following.
    #[inline(always)]
    fn read(&mut self, state: &State, part: Range<usize>, at: usize) {
        let to = at..at + part.len();
        self.depth[to.clone()].copy_from_slice(&state.depth[part.clone()]);
        self.carry[to.clone()].copy_from_slice(&state.carry[part.clone()]);
        self.discharge_x[to.clone()].copy_from_slice(&state.discharge_x[part.clone()]);
        self.discharge_z[to].copy_from_slice(&state.discharge_z[part]);
    }

    /// Writes the strip to a part of a row of `state`.
    #[inline(always)]
    fn write(&self, state: &mut StateMut, part: Range<usize>) {
        let from = HALO..HALO + part.len();
        state.depth[part.clone()].copy_from_slice(&self.depth[from.clone()]);
        state.carry[part.clone()].copy_from_slice(&self.carry[from.clone()]);
        state.discharge_x[part.clone()].copy_from_slice(&self.discharge_x[from.clone()]);
        state.discharge_z[part].copy_from_slice(&self.discharge_z[from]);
    }
}

/// Takes the step `numbers` from `old` to `new`.
pub(super) fn step(new: &mut State, old: &State, around: &Surround, numbers: Numbers, rows: &mut [Rows]) -> Tally {
    let arch = Arch::new();
    let chunk = BAND * around.size.0;
    let bands = (
        new.depth.par_chunks_mut(chunk),
        new.carry.par_chunks_mut(chunk),
        new.discharge_x.par_chunks_mut(chunk),
        new.discharge_z.par_chunks_mut(chunk),
        rows.par_iter_mut(),
    );
    bands.into_par_iter().enumerate().for_each(|(band, (depth, carry, discharge_x, discharge_z, rows))| {
        let new = StateMut { depth, carry, discharge_x, discharge_z };
        arch.dispatch(Band { rows, new, old, around, numbers, first: band * BAND });
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
        let (start, count) = (first as isize, (new.depth.len() / columns) as isize);
        let halo = HALO as isize;
        for read in start - halo..start + count + halo {
            strip.load(&mut self.cells[slot(read, 3)], &mut self.old, &mut self.bed, read);
            let row = read - 1;
            if row < start - 1 {
                continue;
            }
            self.faces[slot(row, 2)].reconstruct(
                &self.cells[slot(row - 1, 3)],
                &self.cells[slot(row, 3)],
                &self.cells[slot(row + 1, 3)],
                (1, strip.width + 2 * HALO - 1),
                numbers,
            );
            if row < start {
                continue;
            }
            strip.solve_x(&mut self.x[slot(row, 2)], &self.faces[slot(row, 2)], row);
            strip.solve_z(&mut self.z[slot(row, 2)], &self.faces[slot(row - 1, 2)], &self.faces[slot(row, 2)], row);
            if row > start {
                self.update(new, strip, numbers, row - 1, (row - 1 - start) as usize);
            }
        }
    }

    /// Writes row `row` of the domain, row `at` of the band.
    #[inline(always)]
    fn update(&mut self, new: &mut StateMut, strip: &Strip, numbers: Numbers, row: isize, at: usize) {
        let columns = strip.around.size.0;
        let from = row as usize * columns + strip.west;
        let here = from..from + strip.width;
        self.old.read(strip.old, here.clone(), HALO);
        let sources = (!strip.around.sources.is_empty()).then(|| {
            self.sources[HALO..HALO + strip.width].copy_from_slice(&strip.around.sources[here]);
            &self.sources
        });
        let (x, north, south) = (&self.x[slot(row, 2)], &self.z[slot(row, 2)], &self.z[slot(row + 1, 2)]);
        let around = Surroundings { x, north, south, faces: &self.faces[slot(row, 2)], sources };
        self.updated.update(&self.old, &around, numbers, strip.width);
        let to = at * columns + strip.west;
        self.updated.state.write(new, to..to + strip.width);
        self.tally.fastest = self.tally.fastest.max(self.updated.fastest(strip.width));
        if sources.is_some() {
            self.tally.given += total(&self.updated.given[HALO..HALO + strip.width]);
        }
        strip.tally(&mut self.tally.left, x, north, south, row);
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
    /// Reads the row `row`, which may lie outside the domain, with its halos.
    #[inline(always)]
    fn load(&self, cells: &mut Cells, state: &mut StateRows, bed: &mut Values, row: isize) {
        let (columns, rows) = self.around.size;
        let inside = within(row, rows, self.around.periodic.1);
        let base = inside * columns;
        let (west, east) = (self.west.saturating_sub(HALO), (self.west + self.width + HALO).min(columns));
        let at = HALO + west - self.west;
        state.read(self.old, base + west..base + east, at);
        bed[at..at + east - west].copy_from_slice(&self.around.bed[base + west..base + east]);
        let last = self.width + 2 * HALO;
        for k in (0..at).chain(at + east - west..last) {
            let column = within((self.west + k) as isize - HALO as isize, columns, self.around.periodic.0);
            state.read(self.old, base + column..base + column + 1, k);
            bed[k] = self.around.bed[base + column];
        }
        self.continue_bed(bed, row, inside);
        cells.load(state, bed, (0, last));
    }

    /// Beyond its sides the bed goes on with the slope that it has there, so that a river flows out as if it went on; but not
    /// from a bank, where still water would be drawn up.
    #[inline(always)]
    fn continue_bed(&self, bed: &mut Values, row: isize, inside: usize) {
        let (columns, rows) = self.around.size;
        let beyond = |cell: usize, next: usize| {
            let here = self.around.bed[cell];
            if self.old.depth[next] > 0.0 { here + (here - self.around.bed[next]) } else { here }
        };
        if !self.around.periodic.1 && rows > 1 && inside as isize != row {
            let next = if row < 0 { columns } else { (rows - 2) * columns };
            let part = HALO..HALO + self.width;
            for (k, bed) in bed[part].iter_mut().enumerate() {
                *bed = beyond(inside * columns + self.west + k, next + self.west + k);
            }
        }
        if self.around.periodic.0 || columns < 2 {
            return;
        }
        let (first, last) = (inside * columns, (inside + 1) * columns - 1);
        if self.west == 0 {
            bed[HALO - 1] = beyond(first, first + 1);
        }
        if self.west + self.width == columns {
            bed[HALO + self.width] = beyond(last, last - 1);
        }
    }

    /// Fluxes through the eastern faces of the row, from the one west of the strip on.
    #[inline(always)]
    fn solve_x(&self, x: &mut Fluxes, faces: &Faces, row: isize) {
        let range = (HALO - 1, HALO + self.width);
        let (columns, rows) = self.around.size;
        let row = within(row, rows, self.around.periodic.1);
        let before = Beside { sides: &faces.east, broken: &faces.broken };
        let after = Beside { sides: &faces.west, broken: &faces.broken };
        match self.around.crests {
            None => x.solve(before, after, 1, range, None),
            Some(crests) => {
                let mut own = [f32::NEG_INFINITY; SPAN];
                for (k, crest) in own.iter_mut().enumerate().take(range.1).skip(range.0) {
                    let column = (self.west + k) as isize - HALO as isize;
                    *crest = crests.east[row * columns + within(column, columns, self.around.periodic.0)];
                }
                x.solve(before, after, 1, range, Some(&own));
            }
        }
        if self.around.periodic.0 {
            return;
        }
        if self.west == 0 {
            let flux = edge::flux(flipped(faces.west.get(HALO)), self.around.edges[DomainSide::West as usize][row]);
            x.set(HALO - 1, backwards(flux));
        }
        if self.west + self.width == columns {
            let last = HALO + self.width - 1;
            x.set(last, edge::flux(faces.east.get(last), self.around.edges[DomainSide::East as usize][row]));
        }
    }

    /// Fluxes through the northern faces of the row.
    #[inline(always)]
    fn solve_z(&self, z: &mut Fluxes, before: &Faces, after: &Faces, row: isize) {
        let range = (HALO, HALO + self.width);
        let (columns, rows) = self.around.size;
        let wraps = self.around.periodic.1;
        let north = Beside { sides: &before.south, broken: &before.broken };
        let south = Beside { sides: &after.north, broken: &after.broken };
        match self.around.crests {
            None => z.solve(north, south, 0, range, None),
            Some(crests) => {
                let from = within(row - 1, rows, wraps) * columns + self.west;
                let mut own = [f32::NEG_INFINITY; SPAN];
                own[HALO..HALO + self.width].copy_from_slice(&crests.south[from..from + self.width]);
                z.solve(north, south, 0, range, Some(&own));
            }
        }
        if wraps {
            return;
        }
        for k in range.0..range.1 {
            let column = self.west + k - HALO;
            if row == 0 {
                let edge = self.around.edges[DomainSide::North as usize][column];
                z.set(k, backwards(edge::flux(flipped(after.north.get(k)), edge)));
            } else if row == rows as isize {
                z.set(k, edge::flux(before.south.get(k), self.around.edges[DomainSide::South as usize][column]));
            }
        }
    }

    /// Adds what left through the sides of the domain next to the row.
    #[inline(always)]
    fn tally(&self, left: &mut [f64; 4], x: &Fluxes, north: &Fluxes, south: &Fluxes, row: isize) {
        let (columns, rows) = self.around.size;
        if !self.around.periodic.0 {
            if self.west == 0 {
                left[DomainSide::West as usize] -= f64::from(x.mass[HALO - 1]);
            }
            if self.west + self.width == columns {
                left[DomainSide::East as usize] += f64::from(x.mass[HALO + self.width - 1]);
            }
        }
        if !self.around.periodic.1 {
            let sum = |fluxes: &Fluxes| total(&fluxes.mass[HALO..HALO + self.width]);
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
