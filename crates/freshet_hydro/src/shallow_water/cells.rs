//! Looking up water that is known in cells at any place, smooth over the wet ones.
use glam::{UVec2, Vec2, Vec4, Vec4Swizzles};

/// Depth, m, from which on a cell counts as wet for those who look at the water.
pub const WET: f32 = 1e-3;

/// Water in cells, row by row from the north.
pub trait WaterCells {
    /// Columns and rows.
    fn size(&self) -> UVec2;

    /// Side of a cell, m.
    fn cell_size(&self) -> f32;

    /// Level (m), depth (m) and velocity (m/s) of a cell.
    fn cell(&self, index: usize) -> Vec4;

    /// ∂η/∂t of a cell, m/s.
    fn rising(&self, index: usize) -> f32;

    /// Slope of the level in a cell, 0 where it is dry: [`slope`], unless it is known.
    fn slope(&self, index: usize) -> Vec2 {
        slope(self, index)
    }

    /// Whether a wall stands above the water at the `axis` face (0 eastern, 1 southern) of a cell.
    fn has_wall(&self, _index: usize, _axis: usize) -> bool {
        false
    }
}

/// Water at one place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldSample {
    /// Level, m.
    pub level: f32,
    /// Slope of the level along x and z.
    pub slope: Vec2,
    /// Velocity, m/s.
    pub velocity: Vec2,
    /// ∂η/∂t, m/s.
    pub rising: f32,
}

/// The shares of four cells around a place: bilinear, of wet cells only, summing to one; nothing if all are dry.
fn wet_shares(cells: [Vec4; 4], shares: [f32; 4]) -> Option<[f32; 4]> {
    let mut wet = shares;
    for (share, cell) in wet.iter_mut().zip(cells) {
        *share = if cell.y > WET { *share } else { 0.0 };
    }
    let sum = wet[0] + wet[1] + wet[2] + wet[3];
    (sum > 1e-4).then(|| wet.map(|share| share / sum))
}

/// Level that a cell counts with beside water at `level`: a dry cell above it is a bank, up which water does not climb; one
/// below it is ground towards which a front falls.
fn beside(cell: Vec4, level: f32) -> f32 {
    if cell.y > WET { cell.x } else { cell.x.min(level) }
}

/// Slope of the level along x and z in a cell, from the cells beside it; 0 where it is dry.
pub fn slope<C: WaterCells + ?Sized>(water: &C, index: usize) -> Vec2 {
    let (columns, rows) = (water.size().x as usize, water.size().y as usize);
    let (column, row) = (index % columns, index / columns);
    let here = water.cell(index);
    if here.y <= WET {
        return Vec2::ZERO;
    }
    // The level across the `axis` face of the cell `of`, if there is one without a wall.
    let level = |exists: bool, at: usize, of: usize, axis: usize| {
        if exists && !water.has_wall(of, axis) { beside(water.cell(at), here.x) } else { here.x }
    };
    let (west, north) = (index.wrapping_sub(1), index.wrapping_sub(columns));
    let x = level(column + 1 < columns, index + 1, index, 0) - level(column > 0, west, west, 0);
    let z = level(row + 1 < rows, index + columns, index, 1) - level(row > 0, north, north, 1);
    Vec2::new(x, z) / (2.0 * water.cell_size())
}

/// The water at local (x, z) in metres from its middle, `age` (s) later than it is: `None` where all cells around are dry.
///
/// Outside the outermost cell centres the nearest point on their rectangle counts.
pub fn sample<C: WaterCells + ?Sized>(water: &C, place: Vec2, age: f32) -> Option<FieldSample> {
    let last = water.size() - 1;
    let p = (place / water.cell_size() + (water.size().as_vec2() / 2.0 - 0.5)).clamp(Vec2::ZERO, last.as_vec2());
    let low = p.floor().as_uvec2();
    let high = (low + 1).min(last);
    let index = |x: u32, z: u32| (z * water.size().x + x) as usize;
    let around = [index(low.x, low.y), index(high.x, low.y), index(low.x, high.y), index(high.x, high.y)];
    let mut t = p - p.floor();
    // Nothing is seen through a wall: the water before it is as it is at its own cells.
    if water.has_wall(around[0], 0) || water.has_wall(around[2], 0) {
        t.x = (t.x + 0.5).floor();
    }
    if water.has_wall(around[0], 1) || water.has_wall(around[1], 1) {
        t.y = (t.y + 0.5).floor();
    }
    let shares = [(1.0 - t.x) * (1.0 - t.y), t.x * (1.0 - t.y), (1.0 - t.x) * t.y, t.x * t.y];
    let cells = around.map(|index| water.cell(index));
    let wet = wet_shares(cells, shares)?;
    let mut sample = FieldSample::default();
    let mut mean = 0.0;
    for k in (0..4).filter(|k| wet[*k] > 0.0) {
        mean += wet[k] * cells[k].x;
        sample.slope += wet[k] * water.slope(around[k]);
        sample.velocity += wet[k] * cells[k].zw();
        sample.rising += wet[k] * water.rising(around[k]);
    }
    for k in 0..4 {
        sample.level += shares[k] * beside(cells[k], mean);
    }
    sample.level += age * sample.rising;
    Some(sample)
}
