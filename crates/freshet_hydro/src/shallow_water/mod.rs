#![doc = include_str!("README.md")]

mod advance;
mod balance;
mod cells;
mod displaced;
mod edge;
mod edges;
mod exchange;
mod field;
mod push;
mod reaction;
mod rows;
mod scheme;
mod series;
mod source;
mod step;
mod strip;

pub use advance::Advance;
pub use balance::Balance;
pub use cells::{FieldSample, WET, WaterCells, sample, slope};
pub use displaced::{Displaced, Displacement, spread};
pub use edge::DomainSide;
pub use edges::{Edge, EdgePart};
pub use exchange::{Forcing, Restored};
pub use field::Field;
pub use push::Push;
pub use scheme::{CLOSED, FILM};
pub use series::Series;
pub use source::PointSource;

use crate::{grid::Grid, waves::GRAVITY};
use glam::{UVec2, Vec2};
use scheme::{DEEPEST, FASTEST, per_depth, sane};
use source::Footprint;
use std::ops::Range;
use step::{Crests, Rows, State};
use thiserror::Error;

/// Why a domain cannot be simulated, or a change to it was refused. Nothing has changed then.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ShallowWaterError {
    /// The bed has a cell without a usable elevation.
    #[error("the bed at column {column}, row {row} must be finite and within ±1000 km, not {found}")]
    Bed {
        /// Column of the first such cell.
        column: u32,
        /// Row of the first such cell.
        row: u32,
        /// Its elevation.
        found: f32,
    },
    /// A grid does not have the columns and rows of the domain.
    #[error("{what} must have {} × {} cells, not {} × {}", .expected.x, .expected.y, .found.x, .found.y)]
    Size {
        /// The grid.
        what: &'static str,
        /// Columns and rows of the domain.
        expected: UVec2,
        /// Columns and rows found.
        found: UVec2,
    },
    /// A number is outside its range.
    #[error("{what} must be {expected}, not {found}")]
    Number {
        /// The number.
        what: &'static str,
        /// Its range.
        expected: &'static str,
        /// What was given.
        found: f32,
    },
    /// A series has no value, a value that is not finite, or times that do not ascend.
    #[error("{0} needs finite values at ascending times")]
    Series(&'static str),
    /// An edge was given for cells that its side does not have.
    #[error("cells {} to {} were asked for on a side of {count}", .cells.start, .cells.end)]
    EdgeCells {
        /// Cells asked for.
        cells: Range<u32>,
        /// Cells of the side.
        count: u32,
    },
}

/// Water on a rectangle of square cells, moved by the shallow-water equations. See the [module](self).
///
/// Positions are local: x east, z south, the origin in the middle, as in [`Grid`]. It starts dry, between walls, without
/// friction, rain or sources.
#[derive(Clone)]
pub struct ShallowWater {
    size: (usize, usize),
    cell_size: f32,
    bed: Vec<f32>,
    now: State,
    next: State,
    crests: Option<Crests>,
    edges: edges::Edges,
    manning: f32,
    courant: f32,
    rain: Series,
    sources: Vec<(PointSource, Footprint)>,
    rates: Vec<f32>,
    pushes: Vec<Push>,
    /// Cells whose `bed` bodies raise.
    raised: Vec<displaced::Raised>,
    /// Room for what bodies do.
    window: reaction::Window,
    rows: Vec<Rows>,
    /// Greatest |u| + c of `now`, m/s.
    fastest: f32,
    time: f64,
    balance: Balance,
}

impl std::fmt::Debug for ShallowWater {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter
            .debug_struct("ShallowWater")
            .field("size", &self.size)
            .field("cell_size", &self.cell_size)
            .field("time", &self.time)
            .finish_non_exhaustive()
    }
}

impl ShallowWater {
    /// Dry land whose elevation (m) is `bed`.
    ///
    /// # Errors
    /// [`ShallowWaterError::Bed`] if an elevation is not finite, or beyond ±1000 km.
    pub fn new(bed: &Grid<f32>) -> Result<Self, ShallowWaterError> {
        check_bed(bed)?;
        let (columns, rows) = (bed.size().x as usize, bed.size().y as usize);
        let count = columns * rows;
        Ok(Self {
            size: (columns, rows),
            cell_size: bed.cell_size(),
            bed: bed.values().iter().map(|&elevation| rounded(elevation)).collect(),
            now: State::dry(count),
            next: State::dry(count),
            crests: None,
            edges: edges::Edges::walls(columns, rows),
            manning: 0.0,
            courant: 0.45,
            rain: 0.0.into(),
            sources: Vec::new(),
            rates: Vec::new(),
            pushes: Vec::new(),
            raised: Vec::new(),
            window: reaction::Window::default(),
            rows: vec![Rows::default(); rows.div_ceil(step::band(rows))],
            fastest: 0.0,
            time: 0.0,
            balance: Balance::default(),
        })
    }

    /// Columns and rows.
    pub fn size(&self) -> UVec2 {
        UVec2::new(self.size.0 as u32, self.size.1 as u32)
    }

    /// Side of a cell, m.
    pub fn cell_size(&self) -> f32 {
        self.cell_size
    }

    /// Time that has been simulated, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Elevation of every cell's bed, m, row by row from the north; rounded to 2⁻¹⁶ m. Where bodies are it is higher by what they
    /// [displace](ShallowWater::set_displaced).
    pub fn bed(&self) -> &[f32] {
        &self.bed
    }

    /// Depth of every cell, m, ≥ 0.
    pub fn depths(&self) -> &[f32] {
        &self.now.depth
    }

    /// Surface elevation of cell `index`, m; that of the bed where it is dry.
    pub fn level(&self, index: usize) -> f32 {
        self.bed[index] + self.now.depth[index]
    }

    /// Depth-averaged velocity (x, z) of cell `index`, m/s; 0 where it is dry.
    pub fn velocity(&self, index: usize) -> Vec2 {
        let factor = per_depth(self.now.depth[index]);
        let speed = |discharge: f32| sane(discharge * factor, FASTEST);
        Vec2::new(speed(self.now.discharge_x[index]), speed(self.now.discharge_z[index]))
    }

    /// Greatest |u| + √(g h) of any cell, m/s, taken by component.
    pub fn fastest_signal(&self) -> f32 {
        self.fastest
    }

    /// Volume of all water, m³.
    pub fn volume(&self) -> f64 {
        let sum: f64 = self.now.depth.iter().zip(&self.now.carry).map(|(&h, &c)| f64::from(h) + f64::from(c)).sum();
        sum * f64::from(self.cell_size) * f64::from(self.cell_size)
    }

    /// What entered and left since the last call of [`ShallowWater::set_water`] or the start.
    pub fn balance(&self) -> Balance {
        self.balance
    }

    /// Replaces all water: depth (m, ≥ 0) and velocity (m/s) of every cell (column, row) whose centre in local (x, z) metres
    /// and bed (m) are given. The balance starts anew.
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if a depth or a velocity is not finite, or a depth is negative.
    pub fn set_water(&mut self, mut water: impl FnMut(Vec2, f32) -> (f32, Vec2)) -> Result<(), ShallowWaterError> {
        let (columns, rows) = self.size;
        let middle = Vec2::new(columns as f32, rows as f32) / 2.0;
        let mut state = State::dry(columns * rows);
        for (index, &bed) in self.bed.iter().enumerate() {
            let cell = Vec2::new((index % columns) as f32, (index / columns) as f32);
            let (depth, velocity) = water((cell + 0.5 - middle) * self.cell_size, bed);
            if !(0.0..DEEPEST).contains(&depth) {
                return Err(number("a depth", "from 0 to 1000 km", depth));
            }
            if !(velocity.is_finite() && velocity.abs().max_element() < FASTEST) {
                return Err(number("a speed", "finite and below 10 km/s", velocity.length()));
            }
            state.depth[index] = depth;
            state.discharge_x[index] = depth * velocity.x;
            state.discharge_z[index] = depth * velocity.y;
        }
        self.now = state;
        self.fastest = self.find_fastest();
        self.balance = Balance { before: self.volume(), ..Balance::default() };
        Ok(())
    }

    /// Fills every place below `level` (m, rounded to 2⁻¹⁶ as beds are) with still water, and takes all other water away.
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if a depth would not be finite.
    pub fn fill(&mut self, level: f32) -> Result<(), ShallowWaterError> {
        let level = rounded(level);
        self.set_water(|_, bed| (if level < bed { 0.0 } else { level - bed }, Vec2::ZERO))
    }

    /// Changes the bed under the water: every depth stays, so no water is made or lost.
    ///
    /// # Errors
    /// As [`ShallowWater::new`], and [`ShallowWaterError::Size`] if the grid is another one.
    pub fn set_bed(&mut self, bed: &Grid<f32>) -> Result<(), ShallowWaterError> {
        self.check_size("the bed", bed.size())?;
        check_bed(bed)?;
        for (own, &elevation) in self.bed.iter_mut().zip(bed.values()) {
            *own = rounded(elevation);
        }
        self.raise_again();
        Ok(())
    }

    /// Puts a wall on a face between two cells whose `crest` is at this elevation, m: water passes above it.
    /// [`CLOSED`] lets none pass, `f32::NEG_INFINITY` takes the wall away. The face is the one on the `side` of the cell (column,
    /// row). At the rim of the domain there are [edges](ShallowWater::set_edge) instead, unless it wraps around.
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if the crest is NaN or the cell is outside.
    pub fn set_wall(&mut self, cell: UVec2, side: DomainSide, crest: f32) -> Result<(), ShallowWaterError> {
        if crest.is_nan() {
            return Err(number("the crest of a wall", "a number", crest));
        }
        if cell.cmpge(self.size()).any() {
            return Err(number("the cell of a wall", "inside the domain", cell.max_element() as f32));
        }
        let count = self.bed.len();
        let none = || vec![f32::NEG_INFINITY; count];
        let crests = self.crests.get_or_insert_with(|| Crests { east: none(), south: none() });
        let index = cell.y as usize * self.size.0 + cell.x as usize;
        match side {
            DomainSide::East => crests.east[index] = crest,
            DomainSide::South => crests.south[index] = crest,
            DomainSide::West if cell.x > 0 => crests.east[index - 1] = crest,
            DomainSide::West => crests.east[index + self.size.0 - 1] = crest,
            DomainSide::North if cell.y > 0 => crests.south[index - self.size.0] = crest,
            DomainSide::North => crests.south[index + count - self.size.0] = crest,
        }
        Ok(())
    }

    /// Takes all walls away.
    pub fn clear_walls(&mut self) {
        self.crests = None;
    }

    /// Sets Manning's n of the bed, s/m^⅓, ≥ 0 (default 0). Earth rivers have 0.025…0.05 (Chow 1959).
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if it is negative or not finite.
    pub fn set_manning(&mut self, manning: f32) -> Result<(), ShallowWaterError> {
        if !(manning.is_finite() && manning >= 0.0) {
            return Err(number("Manning's n", "finite and not negative", manning));
        }
        self.manning = manning;
        Ok(())
    }

    /// Sets the Courant number of a step, above 0 and at most 0.5 (default 0.45): the share of a cell that the fastest signal
    /// crosses. In flows along one axis up to 0.9 is stable, and is allowed for that.
    ///
    /// # Errors
    /// [`ShallowWaterError::Number`] if it is outside 0…0.9.
    pub fn set_courant(&mut self, courant: f32) -> Result<(), ShallowWaterError> {
        if !(courant > 0.0 && courant <= 0.9) {
            return Err(number("the Courant number", "above 0 and at most 0.9", courant));
        }
        self.courant = courant;
        Ok(())
    }

    /// Sets the rain everywhere, m/s, ≥ 0: 10 mm/h are 2.8e-6.
    ///
    /// # Errors
    /// [`ShallowWaterError::Series`] if a value is not finite. Values below 0 count as 0.
    pub fn set_rain(&mut self, rain: impl Into<Series>) -> Result<(), ShallowWaterError> {
        let rain = rain.into();
        if !rain.is_valid() {
            return Err(ShallowWaterError::Series("the rain"));
        }
        self.rain = rain;
        Ok(())
    }

    /// Replaces all point sources.
    ///
    /// # Errors
    /// [`ShallowWaterError`] if a place or radius is not finite, a radius is negative or a rate is not valid.
    pub fn set_sources(&mut self, sources: Vec<PointSource>) -> Result<(), ShallowWaterError> {
        for source in &sources {
            if !source.at.is_finite() {
                return Err(number("the place of a source", "finite", source.at.length()));
            }
            if !(source.radius.is_finite() && source.radius >= 0.0) {
                return Err(number("the radius of a source", "finite and not negative", source.radius));
            }
            if !source.rate.is_valid() {
                return Err(ShallowWaterError::Series("the rate of a source"));
            }
        }
        let footprint = |source: &PointSource| Footprint::new(source, self.size, self.cell_size);
        self.sources = sources.into_iter().map(|source| (source.clone(), footprint(&source))).collect();
        self.rates = if self.sources.is_empty() { Vec::new() } else { vec![0.0; self.bed.len()] };
        Ok(())
    }

    /// Makes x, z or both wrap around; their sides have no edge then.
    pub fn set_periodic(&mut self, x: bool, z: bool) {
        self.edges.periodic = (x, z);
    }

    /// Sets what is outside a part of a side. Parts set later come before parts set earlier.
    ///
    /// # Errors
    /// [`ShallowWaterError::EdgeCells`] if the side has no such cells, [`ShallowWaterError::Series`] if a value is not finite.
    pub fn set_edge(&mut self, side: DomainSide, part: EdgePart, edge: Edge) -> Result<(), ShallowWaterError> {
        self.edges.set(side, part, edge)
    }

    fn check_size(&self, what: &'static str, found: UVec2) -> Result<(), ShallowWaterError> {
        if found == self.size() { Ok(()) } else { Err(ShallowWaterError::Size { what, expected: self.size(), found }) }
    }

    fn find_fastest(&self) -> f32 {
        let signal = |index| self.velocity(index).abs().max_element() + (GRAVITY * self.now.depth[index]).sqrt();
        (0..self.bed.len()).map(signal).fold(0.0, f32::max)
    }
}

fn number(what: &'static str, expected: &'static str, found: f32) -> ShallowWaterError {
    ShallowWaterError::Number { what, expected, found }
}

/// An elevation in whole parts of 2⁻¹⁶ m (15 µm): up to 256 m the sum of bed and depth is then exact for water at such a level,
/// which lies still to the last bit.
fn rounded(elevation: f32) -> f32 {
    (elevation * 65_536.0).round() / 65_536.0
}

fn check_bed(bed: &Grid<f32>) -> Result<(), ShallowWaterError> {
    let wrong = bed.iter().find(|(_, elevation)| elevation.is_nan() || elevation.abs() >= DEEPEST);
    match wrong {
        Some((cell, &found)) => Err(ShallowWaterError::Bed { column: cell.x, row: cell.y, found }),
        None => Ok(()),
    }
}
