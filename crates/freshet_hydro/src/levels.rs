//! Coarser surfaces of a terrain, for drawing it from far away, and how far they are off.
//!
//! A surface of level l has its vertices at every 2^l-th cell centre, the last row and column included, and two triangles
//! for each quad between them. **No coarser surface lies above the terrain at a cell centre**: water over the terrain
//! would be hidden by it, and be it as far away as that its error is no pixel. So every vertex is sunk by the
//! greatest height e of the triangles around it over the terrain,
//! ```text
//! z_v = z_b(v) − max e(q)  over the quads q around v,    e(q) = max (z_q − z_b, 0)  over the cells of q,
//! ```
//! which sinks all of q by e(q) at least. A dike narrower than a quad is lost thereby, and counts in the error.
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

/// A surface whose vertices are several cells apart.
#[derive(Clone, Debug)]
struct Level {
    /// Elevations of the vertices, m, row by row.
    heights: Vec<f32>,
    /// How far the terrain rises above each quad at most, m, row by row.
    errors: Vec<f32>,
}

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

    /// Elevation of a vertex, m: that of its cell on level 0, at most that on others.
    pub fn height(&self, level: u32, vertex: UVec2) -> f32 {
        match self.level(level) {
            Some(coarser) => coarser.heights[place(vertex, self.quads(level).x + 1)],
            None => height(&self.terrain, self.cell(level, vertex)),
        }
    }

    /// Whether a quad's triangles meet on the diagonal from north-west to south-east; on the other one otherwise.
    pub fn is_cut_from_north_west(&self, level: u32, quad: UVec2) -> bool {
        is_cut_from_north_west(corners(&self.terrain, level, quad))
    }

    /// How far the terrain rises above a quad at most, at the middle of a cell, m.
    pub fn error(&self, level: u32, quad: UVec2) -> f32 {
        self.level(level).map_or(0.0, |coarser| coarser.errors[place(quad, self.quads(level).x)])
    }

    fn level(&self, level: u32) -> Option<&Level> {
        self.coarser.get((level as usize).checked_sub(1)?)
    }
}

impl Level {
    fn new(terrain: &Grid<f32>, level: u32) -> Self {
        let quads = quads(terrain.size(), level);
        let misses = by_row(quads, |quad| misses(terrain, level, quad));
        let sunk = by_row(quads + 1, |vertex| {
            let around = [uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(1, 1)]
                .map(|step| (vertex + step).checked_sub(UVec2::ONE));
            let inside = around.into_iter().flatten().filter(|quad| quad.cmplt(quads).all());
            inside.map(|quad| misses[place(quad, quads.x)][0]).fold(0.0, f32::max)
        });
        let heights = by_row(quads + 1, |vertex| {
            height(terrain, cell(terrain.size(), level, vertex)) - sunk[place(vertex, quads.x + 1)]
        });
        // No point of a quad is sunk by more than its lowest corner is.
        let errors = by_row(quads, |quad| {
            let corners = [uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(1, 1)];
            let sunk = corners.map(|step| sunk[place(quad + step, quads.x + 1)]).into_iter().fold(0.0, f32::max);
            misses[place(quad, quads.x)][1] + sunk
        });
        Self { heights, errors }
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

/// Elevations of the terrain at the corners of a quad: north-west, north-east, south-east, south-west.
fn corners(terrain: &Grid<f32>, level: u32, quad: UVec2) -> [f32; 4] {
    let [first, last] = [quad, quad + 1].map(|vertex| cell(terrain.size(), level, vertex));
    [first, uvec2(last.x, first.y), last, uvec2(first.x, last.y)].map(|corner| height(terrain, corner))
}

/// The smaller difference in height is cut along, so that narrow channels and dikes stay whole.
fn is_cut_from_north_west([nw, ne, se, sw]: [f32; 4]) -> bool {
    (nw - se).abs() <= (ne - sw).abs()
}

/// How far the triangles between the terrain's own corners rise over the cells of a quad at most, and fall below them.
fn misses(terrain: &Grid<f32>, level: u32, quad: UVec2) -> [f32; 2] {
    let [first, last] = [quad, quad + 1].map(|vertex| cell(terrain.size(), level, vertex));
    let heights = corners(terrain, level, quad);
    let scale = (last - first).max(UVec2::ONE).as_vec2().recip();
    let (mut above, mut below) = (0.0_f32, 0.0_f32);
    for y in first.y..=last.y {
        let row = place(uvec2(0, y), terrain.size().x);
        for x in first.x..=last.x {
            let share = (uvec2(x, y) - first).as_vec2() * scale;
            let over = in_quad(heights, share) - terrain.values()[row + x as usize];
            above = above.max(over);
            below = below.max(-over);
        }
    }
    [above, below]
}

/// Elevation of the two triangles of a quad, at `share` of its sides from the north-west.
fn in_quad(corners: [f32; 4], share: Vec2) -> f32 {
    let [nw, ne, se, sw] = corners;
    let (east, south) = (share.x, share.y);
    match (is_cut_from_north_west(corners), east >= south, east + south <= 1.0) {
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

    /// How far the terrain rises over the drawn triangles of a quad at its cells, least and most.
    fn rise(levels: &Levels, level: u32, quad: UVec2) -> [f32; 2] {
        let terrain = levels.terrain();
        let corner = |x, y| levels.height(level, quad + uvec2(x, y));
        let drawn = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        let [first, last] = [quad, quad + 1].map(|vertex| levels.cell(level, vertex));
        let mut range = [f32::MAX, f32::MIN];
        for (x, y) in (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| (x, y))) {
            let share = (uvec2(x, y) - first).as_vec2() / (last - first).max(UVec2::ONE).as_vec2();
            // The diagonal is that of the terrain, whatever the drawn corners are.
            let [nw, ne, se, sw] = drawn;
            let (u, v) = (share.x, share.y);
            let z = match levels.is_cut_from_north_west(level, quad) {
                true if u >= v => nw + u * (ne - nw) + v * (se - ne),
                true => nw + u * (se - sw) + v * (sw - nw),
                false if u + v <= 1.0 => nw + u * (ne - nw) + v * (sw - nw),
                false => se + (1.0 - u) * (sw - se) + (1.0 - v) * (ne - se),
            };
            let rise = height(terrain, uvec2(x, y)) - z;
            range = [range[0].min(rise), range[1].max(rise)];
        }
        range
    }

    #[test]
    fn no_coarser_surface_hides_the_terrain_and_none_is_off_by_more_than_it_says() {
        for size in [uvec2(97, 61), uvec2(64, 65), uvec2(3, 40), uvec2(1, 1), uvec2(1, 7)] {
            let levels = rolling(size);
            for level in 0..=5 {
                let quads = levels.quads(level);
                for quad in (0..quads.y).flat_map(|y| (0..quads.x).map(move |x| uvec2(x, y))) {
                    let [least, most] = rise(&levels, level, quad);
                    assert!(least > -1e-4, "{size}, level {level}, {quad}: {least} m above the terrain");
                    let error = levels.error(level, quad);
                    assert!(most <= error + 1e-4, "{size}, level {level}, {quad}: {most} m, more than {error} m");
                }
            }
        }
    }

    #[test]
    fn a_plane_is_the_same_on_all_levels() {
        let plane = Grid::from_fn(uvec2(50, 33), 1.0, |cell| 0.5 * cell.x as f32 - 0.25 * cell.y as f32).unwrap();
        let levels = Levels::new(Arc::new(plane), 5);
        for level in 0..=5 {
            let quads = levels.quads(level);
            for vertex in (0..=quads.y).flat_map(|y| (0..=quads.x).map(move |x| uvec2(x, y))) {
                let cell = levels.cell(level, vertex).as_vec2();
                assert!((levels.height(level, vertex) - (0.5 * cell.x - 0.25 * cell.y)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn a_dike_between_the_vertices_counts() {
        let dike = Grid::from_fn(uvec2(33, 33), 1.0, |cell| if cell.x == 5 { 3.0 } else { 1.0 }).unwrap();
        let levels = Levels::new(Arc::new(dike), 3);
        assert_eq!(levels.error(0, uvec2(5, 3)), 0.0);
        assert_eq!(levels.error(3, uvec2(0, 0)), 2.0);
        assert_eq!(levels.error(3, uvec2(2, 0)), 0.0);
        assert_eq!(levels.quads(3), uvec2(4, 4));
    }
}
