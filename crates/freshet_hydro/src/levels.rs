//! Coarser surfaces of a terrain, for drawing it from far away, and how far they are off.
//!
//! A surface of level l has its vertices at every 2^l-th cell centre, the last row and column included, and two triangles
//! for each quad between them. Water over the terrain must neither be hidden by it nor flow out over it, be it as far away as
//! that its error is no pixel: where land is flat, little height is a long way for a shore. So
//!
//! - a vertex begins at the median of the cells nearest to it, which no ditch and no dike moves;
//! - it is sunk until **at most a quarter of the cells of each quad lie below the surface**:
//! ```text
//! z_v = median z_b − max e(q) over the quads q around v,    e(q) = the upper quartile of z_q − z_b over the cells of q, or 0
//! ```
//! which sinks all of q by e(q) at least.
use crate::grid::Grid;
use glam::{UVec2, Vec2, uvec2};
use rayon::prelude::*;
use std::sync::Arc;

/// A terrain and its coarser surfaces.
#[derive(Clone, Debug)]
pub struct Levels {
    terrain: Arc<Grid<f32>>,
    /// Those of level 1 and more.
    coarser: Vec<Level>,
}

/// How far a quad is off the terrain at the middles of cells, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Misses {
    /// At most.
    pub most: f32,
    /// At three of four cells, or less.
    pub usual: f32,
}

/// A surface whose vertices are several cells apart; lists are row by row.
#[derive(Clone, Debug)]
struct Level {
    /// Elevations of the vertices, m.
    heights: Vec<f32>,
    /// Whether quads are cut from north-west to south-east.
    cuts: Vec<bool>,
    misses: Vec<Misses>,
}

/// The corners of a quad, from its own place: north-west, north-east, south-east, south-west.
const CORNERS: [UVec2; 4] = [uvec2(0, 0), uvec2(1, 0), uvec2(1, 1), uvec2(0, 1)];

/// Cells that are looked at for a median, along each side and to each direction.
const MEDIAN: i32 = 4;

impl Levels {
    /// Levels from 0, the terrain itself, to `coarsest`. All elevations must be finite.
    pub fn new(terrain: Arc<Grid<f32>>, coarsest: u32) -> Self {
        let coarser = (1..=coarsest).map(|level| Level::new(&terrain, level)).collect();
        Self { terrain, coarser }
    }

    /// The terrain, level 0.
    pub fn terrain(&self) -> &Arc<Grid<f32>> {
        &self.terrain
    }

    /// Columns and rows of the quads of a level, at least 1 each.
    pub fn quads(&self, level: u32) -> UVec2 {
        quads(self.terrain.size(), level)
    }

    /// The cell in whose middle a vertex lies.
    pub fn cell(&self, level: u32, vertex: UVec2) -> UVec2 {
        cell(self.terrain.size(), level, vertex)
    }

    /// Elevation of a vertex, m; that of its cell on level 0.
    pub fn height(&self, level: u32, vertex: UVec2) -> f32 {
        match self.level(level) {
            Some(coarser) => coarser.heights[place(vertex, self.quads(level).x + 1)],
            None => height(&self.terrain, self.cell(level, vertex)),
        }
    }

    /// Whether a quad's triangles meet on the diagonal from north-west to south-east; on the other one otherwise.
    pub fn is_cut_from_north_west(&self, level: u32, quad: UVec2) -> bool {
        match self.level(level) {
            Some(coarser) => coarser.cuts[place(quad, self.quads(level).x)],
            None => is_cut_from_north_west(CORNERS.map(|corner| self.height(0, quad + corner))),
        }
    }

    /// How far a quad is off the terrain.
    pub fn misses(&self, level: u32, quad: UVec2) -> Misses {
        self.level(level).map_or(Misses::default(), |coarser| coarser.misses[place(quad, self.quads(level).x)])
    }

    fn level(&self, level: u32) -> Option<&Level> {
        self.coarser.get((level as usize).checked_sub(1)?)
    }
}

impl Level {
    fn new(terrain: &Grid<f32>, level: u32) -> Self {
        let quads = quads(terrain.size(), level);
        let corners = |heights: &[f32], quad| CORNERS.map(|corner| heights[place(quad + corner, quads.x + 1)]);
        let medians = by_row(quads + 1, |vertex| median(terrain, level, vertex));
        let cuts = by_row(quads, |quad| is_cut_from_north_west(corners(&medians, quad)));
        let differences = |heights: &[f32], quad| {
            differences(terrain, level, quad, corners(heights, quad), cuts[place(quad, quads.x)])
        };
        let rises = by_row(quads, |quad| upper_quartile(&mut differences(&medians, quad)).max(0.0));
        let heights = by_row(quads + 1, |vertex| {
            let around = CORNERS.map(|step| (vertex + step).checked_sub(UVec2::ONE));
            let inside = around.into_iter().flatten().filter(|quad| quad.cmplt(quads).all());
            let sunk = inside.map(|quad| rises[place(quad, quads.x)]).fold(0.0, f32::max);
            medians[place(vertex, quads.x + 1)] - sunk
        });
        let misses = by_row(quads, |quad| {
            let mut misses = differences(&heights, quad);
            misses.iter_mut().for_each(|miss| *miss = miss.abs());
            Misses { most: misses.iter().copied().fold(0.0, f32::max), usual: upper_quartile(&mut misses) }
        });
        Self { heights, cuts, misses }
    }
}

/// A value for each place of a raster, row by row, computed by all threads.
fn by_row<T: Send>(size: UVec2, value: impl Fn(UVec2) -> T + Sync) -> Vec<T> {
    let row = |y: u32| (0..size.x).map(move |x| uvec2(x, y));
    (0..size.y).into_par_iter().flat_map_iter(|y| row(y).map(&value)).collect()
}

fn place(at: UVec2, columns: u32) -> usize {
    at.y as usize * columns as usize + at.x as usize
}

fn quads(size: UVec2, level: u32) -> UVec2 {
    ((size - 1 + ((1 << level) - 1)) >> level).max(UVec2::ONE)
}

fn cell(size: UVec2, level: u32, vertex: UVec2) -> UVec2 {
    (vertex << level).min(size - 1)
}

fn height(terrain: &Grid<f32>, cell: UVec2) -> f32 {
    terrain.values()[place(cell, terrain.size().x)]
}

/// The median of the cells around a vertex, as many on each side, so that a slope stays where it is.
fn median(terrain: &Grid<f32>, level: u32, vertex: UVec2) -> f32 {
    let middle = cell(terrain.size(), level, vertex);
    let reach = middle.min(terrain.size() - 1 - middle).min(UVec2::splat(1 << level >> 1)).as_ivec2();
    let step = ((1 << level >> 1) / MEDIAN).max(1);
    let [columns, rows] = [reach.x, reach.y].map(|reach| -(reach / step)..=reach / step);
    let mut around: Vec<f32> = Vec::with_capacity(((2 * MEDIAN + 1) * (2 * MEDIAN + 1)) as usize);
    for y in rows {
        let row = columns.clone().map(|x| middle.wrapping_add_signed(glam::ivec2(x, y) * step));
        around.extend(row.map(|cell| height(terrain, cell)));
    }
    let half = around.len() / 2;
    *around.select_nth_unstable_by(half, f32::total_cmp).1
}

/// The value that three quarters of all are no larger than; there must be one.
fn upper_quartile(values: &mut [f32]) -> f32 {
    let index = (values.len() * 3).div_ceil(4) - 1;
    *values.select_nth_unstable_by(index, f32::total_cmp).1
}

/// The smaller difference in height is cut along, so that narrow channels and dikes stay whole.
fn is_cut_from_north_west([nw, ne, se, sw]: [f32; 4]) -> bool {
    (nw - se).abs() <= (ne - sw).abs()
}

/// How far a quad with these corners lies above the terrain, at each of its cells.
fn differences(terrain: &Grid<f32>, level: u32, quad: UVec2, corners: [f32; 4], is_cut: bool) -> Vec<f32> {
    let [first, last] = [quad, quad + 1].map(|vertex| cell(terrain.size(), level, vertex));
    let scale = (last - first).max(UVec2::ONE).as_vec2().recip();
    let mut differences = Vec::with_capacity((last - first + 1).element_product() as usize);
    for y in first.y..=last.y {
        let row = place(uvec2(0, y), terrain.size().x);
        for x in first.x..=last.x {
            let share = (uvec2(x, y) - first).as_vec2() * scale;
            differences.push(in_quad(corners, is_cut, share) - terrain.values()[row + x as usize]);
        }
    }
    differences
}

/// Elevation of the two triangles of a quad, at `share` of its sides from the north-west.
fn in_quad([nw, ne, se, sw]: [f32; 4], is_cut_from_north_west: bool, share: Vec2) -> f32 {
    let (east, south) = (share.x, share.y);
    match (is_cut_from_north_west, east >= south, east + south <= 1.0) {
        (true, true, _) => nw + east * (ne - nw) + south * (se - ne),
        (true, false, _) => nw + east * (se - sw) + south * (sw - nw),
        (false, _, true) => nw + east * (ne - nw) + south * (sw - nw),
        (false, _, false) => se + (1.0 - east) * (sw - se) + (1.0 - south) * (ne - se),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::fractal_noise;

    fn rolling(size: UVec2) -> Levels {
        let height = |cell: UVec2| 5.0 * fractal_noise(cell.as_vec2() / 9.0, UVec2::splat(64), 4, 1);
        Levels::new(Arc::new(Grid::from_fn(size, 2.0, height).unwrap()), 5)
    }

    fn all(size: UVec2) -> impl Iterator<Item = UVec2> {
        (0..size.y).flat_map(move |y| (0..size.x).map(move |x| uvec2(x, y)))
    }

    /// How far the drawn triangles of a quad lie above the terrain at its cells, in order.
    fn drawn(levels: &Levels, level: u32, quad: UVec2) -> Vec<f32> {
        let corners = CORNERS.map(|corner| levels.height(level, quad + corner));
        let is_cut = levels.is_cut_from_north_west(level, quad);
        let mut above = differences(levels.terrain(), level, quad, corners, is_cut);
        above.sort_by(f32::total_cmp);
        above
    }

    #[test]
    fn at_most_a_quarter_of_a_quad_is_hidden_and_none_is_off_by_more_than_it_says() {
        for size in [uvec2(97, 61), uvec2(64, 65), uvec2(3, 40), uvec2(1, 1), uvec2(1, 7)] {
            let levels = rolling(size);
            for level in 0..=5 {
                for quad in all(levels.quads(level)) {
                    let above = drawn(&levels, level, quad);
                    let hidden = above.iter().filter(|above| **above > 1e-4).count();
                    assert!(4 * hidden <= above.len(), "{size}, level {level}, {quad}: {hidden} of {}", above.len());
                    let most = above[0].abs().max(above[above.len() - 1].abs());
                    let said = levels.misses(level, quad);
                    assert!((most - said.most).abs() < 1e-4, "{size}, level {level}, {quad}: {most} m, {said:?}");
                    assert!(said.usual <= said.most);
                }
            }
        }
    }

    #[test]
    fn a_plane_is_the_same_on_all_levels() {
        let plane = Grid::from_fn(uvec2(50, 33), 1.0, |cell| 0.5 * cell.x as f32 - 0.25 * cell.y as f32).unwrap();
        let levels = Levels::new(Arc::new(plane), 5);
        for level in 0..=5 {
            for vertex in all(levels.quads(level) + 1) {
                let cell = levels.cell(level, vertex).as_vec2();
                assert!((levels.height(level, vertex) - (0.5 * cell.x - 0.25 * cell.y)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn ditches_and_dikes_move_no_coarser_surface_but_count() {
        let height = |cell: UVec2| match cell.x {
            8 => 0.0,
            21 => 4.0,
            _ => 1.0,
        };
        let levels = Levels::new(Arc::new(Grid::from_fn(uvec2(33, 33), 1.0, height).unwrap()), 3);
        for vertex in all(levels.quads(3) + 1) {
            assert_eq!(levels.height(3, vertex), 1.0, "{vertex}");
        }
        assert_eq!(levels.misses(3, uvec2(0, 0)), Misses { most: 1.0, usual: 0.0 });
        assert_eq!(levels.misses(3, uvec2(2, 0)), Misses { most: 3.0, usual: 0.0 });
        assert_eq!(levels.misses(0, uvec2(8, 0)), Misses::default());
        assert_eq!(levels.quads(3), uvec2(4, 4));
    }
}
