//! One step of the whole domain: bands of rows side by side, in each band strips of columns, row after row.
use super::{
    edge::{self, DomainSide, EdgeCell},
    scheme::Flux,
    strip::{COLUMNS, Cells, Faces, Fluxes, HALO, Numbers, SPAN, StateRow, StateRowMut, Surroundings, Values, update},
};
use rayon::prelude::*;

/// Rows of a band. The same for every number of threads, so that sums over a band are too.
pub(super) const BAND: usize = 32;

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
    given: Values,
    cells: [Cells; 3],
    faces: [Faces; 2],
    x: [Fluxes; 2],
    z: [Fluxes; 2],
    tally: Tally,
}

impl Default for Rows {
    fn default() -> Self {
        Self {
            given: [0.0; SPAN],
            cells: Default::default(),
            faces: Default::default(),
            x: Default::default(),
            z: Default::default(),
            tally: Tally::default(),
        }
    }
}

impl State {
    pub fn dry(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self { depth: zeros(), carry: zeros(), discharge_x: zeros(), discharge_z: zeros() }
    }

    fn row(&self, from: usize, to: usize) -> StateRow<'_> {
        StateRow {
            depth: &self.depth[from..to],
            carry: &self.carry[from..to],
            discharge_x: &self.discharge_x[from..to],
            discharge_z: &self.discharge_z[from..to],
        }
    }
}

/// Takes the step `numbers` from `old` to `new`.
pub(super) fn step(new: &mut State, old: &State, around: &Surround, numbers: Numbers, rows: &mut [Rows]) -> Tally {
    let arch = pulp::Arch::new();
    let chunk = BAND * around.size.0;
    let bands = (
        new.depth.par_chunks_mut(chunk),
        new.carry.par_chunks_mut(chunk),
        new.discharge_x.par_chunks_mut(chunk),
        new.discharge_z.par_chunks_mut(chunk),
        rows.par_iter_mut(),
    );
    bands.into_par_iter().enumerate().for_each(|(band, (depth, carry, discharge_x, discharge_z, rows))| {
        let mut new = StateRowMut { depth, carry, discharge_x, discharge_z };
        arch.dispatch(|| rows.step(&mut new, old, around, numbers, band * BAND));
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

impl Rows {
    #[inline(always)]
    fn step(&mut self, new: &mut StateRowMut, old: &State, around: &Surround, numbers: Numbers, first: usize) {
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
    fn step_strip(&mut self, new: &mut StateRowMut, strip: &Strip, numbers: Numbers, first: usize) {
        let columns = strip.around.size.0;
        let (start, count) = (first as isize, (new.depth.len() / columns) as isize);
        let halo = HALO as isize;
        for read in start - halo..start + count + halo {
            strip.load(&mut self.cells[slot(read, 3)], read);
            let row = read - 1;
            if row < start - 1 {
                continue;
            }
            self.faces[slot(row, 2)].reconstruct(
                &self.cells[slot(row - 1, 3)],
                &self.cells[slot(row, 3)],
                &self.cells[slot(row + 1, 3)],
                (1, strip.width + 2 * HALO - 1),
                0.5 * numbers.ratio,
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
    fn update(&mut self, new: &mut StateRowMut, strip: &Strip, numbers: Numbers, row: isize, at: usize) {
        let columns = strip.around.size.0;
        let (here, to) = (at * columns + strip.west, at * columns + strip.west + strip.width);
        let from = row as usize * columns + strip.west;
        let sources = strip.around.sources;
        let (x, north, south) = (&self.x[slot(row, 2)], &self.z[slot(row, 2)], &self.z[slot(row + 1, 2)]);
        let faces = &self.faces[slot(row, 2)];
        let surroundings = Surroundings {
            x,
            north,
            south,
            push_x: &faces.push_x,
            push_z: &faces.push_z,
            sources: if sources.is_empty() { &[] } else { &sources[from..from + strip.width] },
        };
        let mut row_new = StateRowMut {
            depth: &mut new.depth[here..to],
            carry: &mut new.carry[here..to],
            discharge_x: &mut new.discharge_x[here..to],
            discharge_z: &mut new.discharge_z[here..to],
        };
        let old = strip.old.row(from, from + strip.width);
        let fastest = update(&mut row_new, old, &surroundings, numbers, &mut self.given);
        self.tally.fastest = self.tally.fastest.max(fastest);
        if !sources.is_empty() {
            self.tally.given += self.given[..strip.width].iter().map(|&given| f64::from(given)).sum::<f64>();
        }
        strip.tally(&mut self.tally.left, x, north, south, row);
    }
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
    fn load(&self, cells: &mut Cells, row: isize) {
        let (columns, rows) = self.around.size;
        let inside = within(row, rows, self.around.periodic.1);
        let base = inside * columns;
        let west = self.west.saturating_sub(HALO);
        let east = (self.west + self.width + HALO).min(columns);
        let at = HALO + west - self.west;
        cells.load(at, self.old.row(base + west, base + east), &self.around.bed[base + west..base + east]);
        self.load_beyond(cells, base, inside);
        if !self.around.periodic.1 && (row < 0 || row >= rows as isize) {
            let side = if row < 0 { DomainSide::North } else { DomainSide::South };
            let edge = &self.around.edges[side as usize];
            for column in west..east {
                if edge[column] == EdgeCell::Wall {
                    cells.v[HALO + column - self.west] *= -1.0;
                }
            }
        }
    }

    /// Fills the halo cells west and east of the domain.
    #[inline(always)]
    fn load_beyond(&self, cells: &mut Cells, base: usize, row: usize) {
        let columns = self.around.size.0;
        let from = self.west as isize - HALO as isize;
        for k in 0..self.width + 2 * HALO {
            let column = from + k as isize;
            if (0..columns as isize).contains(&column) {
                continue;
            }
            let inside = within(column, columns, self.around.periodic.0);
            let cell = base + inside;
            cells.load(k, self.old.row(cell, cell + 1), &self.around.bed[cell..cell + 1]);
            let side = if column < 0 { DomainSide::West } else { DomainSide::East };
            if !self.around.periodic.0 && self.around.edges[side as usize][row] == EdgeCell::Wall {
                cells.u[k] *= -1.0;
            }
        }
    }

    /// Fluxes through the eastern faces of the row, from the one west of the strip on.
    #[inline(always)]
    fn solve_x(&self, x: &mut Fluxes, faces: &Faces, row: isize) {
        let range = (HALO - 1, HALO + self.width);
        let (columns, rows) = self.around.size;
        let row = within(row, rows, self.around.periodic.1);
        match self.around.crests {
            None => x.solve(&faces.east, &faces.west, 1, range, None),
            Some(crests) => {
                let mut own = [f32::NEG_INFINITY; SPAN];
                for k in range.0..range.1 {
                    let column = (self.west + k) as isize - HALO as isize;
                    own[k] = crests.east[row * columns + within(column, columns, self.around.periodic.0)];
                }
                x.solve(&faces.east, &faces.west, 1, range, Some(&own));
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
        match self.around.crests {
            None => z.solve(&before.south, &after.north, 0, range, None),
            Some(crests) => {
                let from = within(row - 1, rows, wraps) * columns + self.west;
                let mut own = [f32::NEG_INFINITY; SPAN];
                own[HALO..HALO + self.width].copy_from_slice(&crests.south[from..from + self.width]);
                z.solve(&before.south, &after.north, 0, range, Some(&own));
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
            let sum = |fluxes: &Fluxes| fluxes.mass[HALO..HALO + self.width].iter().map(|&mass| f64::from(mass)).sum::<f64>();
            if row == 0 {
                left[DomainSide::North as usize] -= sum(north);
            }
            if row + 1 == rows as isize {
                left[DomainSide::South as usize] += sum(south);
            }
        }
    }
}

/// The column or row inside the domain that stands for one that may be outside: across the domain, or mirrored at its edge.
#[inline(always)]
fn within(at: isize, count: usize, wraps: bool) -> usize {
    let count = count as isize;
    let inside = if (0..count).contains(&at) {
        at
    } else if wraps {
        at.rem_euclid(count)
    } else if at < 0 {
        (-1 - at).min(count - 1)
    } else {
        (2 * count - 1 - at).max(0)
    };
    inside as usize
}

fn flipped(side: super::scheme::Side) -> super::scheme::Side {
    super::scheme::Side { normal: -side.normal, ..side }
}

/// A flux out of the domain at its western or northern side, as a flux along the axis.
fn backwards(flux: Flux) -> Flux {
    Flux { mass: -flux.mass, before: 0.0, after: flux.before, tangential: -flux.tangential }
}
