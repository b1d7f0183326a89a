//! A section as shares of square cells.
use super::Section;
use glam::{UVec2, Vec2, uvec2};

/// Part of a row, in cells, by which an outline may miss closing in it before the row is dropped.
const GAP: f32 = 1e-3;
/// Covers below this are rounding errors.
const NOISE: f32 = 1e-5;

/// The exact share of each cell of a raster that a [`Section`] covers.
///
/// Exact area coverage by signed areas, as font rasterisers compute it (Levien 2016, *font-rs*): every piece of the outline
/// adds, in each row it crosses, the signed area to its right; a running sum along the row then gives the cover.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cover {
    first: UVec2,
    size: UVec2,
    shares: Vec<f32>,
}

impl Section {
    /// The cover of the cells of a raster of `size` (columns along x, rows along z), whose cells of `cell` (m, > 0) begin
    /// at `origin` (xz, m).
    ///
    /// Only cells in the bounding rectangle of the outline can be covered. A row in which the outline does not close, as
    /// with meshes that are open at the waterline, is dropped: it would cover everything to its right.
    pub fn cover(&self, origin: Vec2, cell: f32, size: UVec2) -> Cover {
        let outline = || self.outline().iter().map(|piece| piece.map(|point| (point - origin) / cell));
        let (mut min, mut max) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for point in outline().flatten().filter(|point| point.is_finite()) {
            (min, max) = (min.min(point), max.max(point));
        }
        let limit = size.as_vec2();
        let (min, max) = (min.floor().clamp(Vec2::ZERO, limit), max.ceil().clamp(Vec2::ZERO, limit));
        if !max.cmpgt(min).all() {
            return Cover::default();
        }
        let mut rows = Rows::new(min.as_uvec2(), (max - min).as_uvec2());
        for [from, to] in outline().filter(|[from, to]| from.is_finite() && to.is_finite()) {
            rows.add(from - min, to - min);
        }
        rows.sum()
    }
}

impl Cover {
    /// Covered cells (column, row) of the raster with their shares, usually 0…1; more where shells overlap.
    pub fn cells(&self) -> impl Iterator<Item = (UVec2, f32)> {
        let columns = self.size.x.max(1) as usize;
        self.shares
            .iter()
            .enumerate()
            .filter(|(_, share)| **share > NOISE)
            .map(move |(i, share)| (self.first + uvec2((i % columns) as u32, (i / columns) as u32), *share))
    }
}

/// Signed areas while they are collected.
struct Rows {
    cover: Cover,
    /// Sum of the directed heights of the outline in each row, wherever they stand: zero if it closes.
    gaps: Vec<f32>,
}

impl Rows {
    fn new(first: UVec2, size: UVec2) -> Self {
        let shares = vec![0.0; size.x as usize * size.y as usize];
        Self { cover: Cover { first, size, shares }, gaps: vec![0.0; size.y as usize] }
    }

    /// Adds a piece of outline, in cells from the first one, row by row.
    fn add(&mut self, from: Vec2, to: Vec2) {
        // Going up in z there is solid to the left, going down to the right.
        let (top, bottom, sign) = if from.y < to.y { (from, to, -1.0) } else { (to, from, 1.0) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let x_at = |y: f32| {
            // The ends are exact, so that neighbours meet.
            if y <= top.y {
                top.x
            } else if y >= bottom.y {
                bottom.x
            } else {
                top.x + (y - top.y) * slope
            }
        };
        let last_row = bottom.y.ceil().clamp(0.0, self.cover.size.y as f32) as usize;
        for row in top.y.max(0.0) as usize..last_row {
            let (y0, y1) = (top.y.max(row as f32), bottom.y.min(row as f32 + 1.0));
            if y1 > y0 {
                self.add_in_row(row, x_at(y0), x_at(y1), sign * (y1 - y0));
            }
        }
    }

    /// Adds a piece within a row, from x = `x0` to `x1`, of the directed `height`.
    fn add_in_row(&mut self, row: usize, x0: f32, x1: f32, height: f32) {
        self.gaps[row] += height;
        let columns = self.cover.size.x as usize;
        let shares = &mut self.cover.shares[row * columns..][..columns];
        let (left, right) = (x0.min(x1), x0.max(x1));
        let mut add = |from: f32, to: f32, column: usize| {
            let height = if right > left { height * (to - from) / (right - left) } else { height };
            let covered = (column as f32 + 1.0 - 0.5 * (from + to)).clamp(0.0, 1.0);
            if let Some(share) = shares.get_mut(column) {
                *share += height * covered;
            }
            if let Some(share) = shares.get_mut(column + 1) {
                *share += height * (1.0 - covered);
            }
        };
        // What stands to the left of the raster shades its whole row, what stands to the right nothing.
        if left < 0.0 {
            add(left, right.min(0.0), 0);
        }
        if right < 0.0 {
            return;
        }
        let first = left.max(0.0) as usize;
        for column in first..columns.min(right.min(columns as f32) as usize + 1) {
            let (from, to) = (left.max(column as f32), right.min(column as f32 + 1.0));
            if to > from || right == left {
                add(from, to, column);
            }
        }
    }

    /// Running sums along the rows.
    fn sum(mut self) -> Cover {
        let columns = self.cover.size.x as usize;
        for (shares, gap) in self.cover.shares.chunks_exact_mut(columns).zip(&self.gaps) {
            let mut sum = 0.0;
            for share in shares {
                sum += *share;
                *share = if gap.abs() < GAP { sum } else { 0.0 };
            }
        }
        self.cover
    }
}
