//! The terrain as a quadtree of tiles: where each lies, and by how much it is off.
use bevy::prelude::*;
use freshet_hydro::{grid::Grid, levels::Levels};
use std::sync::Arc;

/// Quads along a side of a tile.
pub const TILE: u32 = 64;

/// How much more an error counts that cells usually have: where the ground slopes by s, it moves a shore by 1 / s times as much.
const SHORE: f32 = 30.0;

/// A tile: all tiles have as many quads, those of level l with sides of 2^l cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tile {
    pub level: u32,
    /// Column and row among the tiles of its level.
    pub at: UVec2,
}

impl Tile {
    /// A number that no other tile has.
    pub fn number(self) -> (u32, u32, u32) {
        (self.level, self.at.y, self.at.x)
    }
}

/// What is known of a tile before it is built.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// How far it is off the ground, m: at most, or [`SHORE`] times that of usual cells; no less than for any tile of its area.
    pub error: f32,
    /// How far it is off the ground at most, likewise, m.
    pub most: f32,
    /// Lowest and highest place, m.
    pub heights: Vec2,
}

/// All tiles of a terrain, from the one that is all of it.
pub struct Tree {
    pub levels: Levels,
    /// By level, row by row.
    tiles: Vec<Vec<Bounds>>,
}

impl Tree {
    /// The tiles of a terrain whose elevations are all finite.
    pub fn new(terrain: Arc<Grid<f32>>) -> Self {
        let quads = (terrain.size().max_element() - 1).max(1);
        let root = quads.div_ceil(TILE).next_power_of_two().ilog2();
        let mut tree = Self { levels: Levels::new(terrain, root), tiles: Vec::new() };
        for level in 0..=root {
            let size = tree.size(level);
            let all = (0..size.y).flat_map(|y| (0..size.x).map(move |x| Tile { level, at: uvec2(x, y) }));
            let bounds = all.map(|tile| tree.measured(tile)).collect();
            tree.tiles.push(bounds);
        }
        tree
    }

    pub fn root(&self) -> Tile {
        Tile { level: self.tiles.len() as u32 - 1, at: UVec2::ZERO }
    }

    /// Columns and rows of the tiles of a level.
    fn size(&self, level: u32) -> UVec2 {
        (self.levels.quads(level) + (TILE - 1)) / TILE
    }

    pub fn bounds(&self, tile: Tile) -> Bounds {
        self.tiles[tile.level as usize][(tile.at.y * self.size(tile.level).x + tile.at.x) as usize]
    }

    /// The up to four tiles of the next finer level in the area of one; none of the finest.
    pub fn children(&self, tile: Tile) -> impl Iterator<Item = Tile> + use<> {
        let level = tile.level.checked_sub(1);
        let size = level.map_or(UVec2::ZERO, |level| self.size(level));
        let steps = [uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(1, 1)];
        let children = steps.into_iter().map(move |step| tile.at * 2 + step).filter(move |at| at.cmplt(size).all());
        children.map(move |at| Tile { level: level.unwrap_or_default(), at })
    }

    /// First and last vertex of a tile on its level.
    pub fn vertices(&self, tile: Tile) -> [UVec2; 2] {
        [tile.at * TILE, ((tile.at + 1) * TILE).min(self.levels.quads(tile.level))]
    }

    /// Whether a tile lies at the edge of the terrain: in the west, north, east and south.
    pub fn rims(&self, tile: Tile) -> [bool; 4] {
        let last = self.size(tile.level) - 1;
        [tile.at.x == 0, tile.at.y == 0, tile.at.x == last.x, tile.at.y == last.y]
    }

    /// The least and greatest place of a tile (x, z), m. Tiles at the edge reach to the edges of their cells.
    pub fn area(&self, tile: Tile) -> [Vec2; 2] {
        let terrain = self.levels.terrain();
        let [first, last] = self.vertices(tile).map(|vertex| terrain.position(self.levels.cell(tile.level, vertex)));
        let [west, north, east, south] = self.rims(tile);
        let half = 0.5 * terrain.extent();
        let low = vec2(if west { -half.x } else { first.x }, if north { -half.y } else { first.y });
        let high = vec2(if east { half.x } else { last.x }, if south { half.y } else { last.y });
        [low, high]
    }

    /// The bounds of a tile whose children's are known.
    fn measured(&self, tile: Tile) -> Bounds {
        let [first, last] = self.vertices(tile);
        let places = |last: UVec2| (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| uvec2(x, y)));
        let (mut most, mut usual, mut heights) = (0.0_f32, 0.0_f32, vec2(f32::MAX, f32::MIN));
        for quad in places(last - 1) {
            let misses = self.levels.misses(tile.level, quad);
            most = most.max(misses.most);
            usual += misses.usual;
        }
        for vertex in places(last) {
            let height = self.levels.height(tile.level, vertex);
            heights = vec2(heights.x.min(height), heights.y.max(height));
        }
        let error = most.max(SHORE * usual / (last - first).element_product() as f32);
        self.children(tile).map(|child| self.bounds(child)).fold(Bounds { error, most, heights }, |all, child| Bounds {
            error: all.error.max(child.error),
            most: all.most.max(child.most),
            heights: vec2(all.heights.x.min(child.heights.x), all.heights.y.max(child.heights.y)),
        })
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use freshet_hydro::noise::fractal_noise;

    /// Rolling land of cells of 2 m.
    pub fn tree(size: UVec2) -> Tree {
        let height = |cell: UVec2| 8.0 * fractal_noise(cell.as_vec2() / 20.0, UVec2::splat(64), 5, 1);
        Tree::new(Grid::from_fn(size, 2.0, height).unwrap().into())
    }

    /// All tiles under one, and itself.
    fn under(tree: &Tree, tile: Tile) -> Vec<Tile> {
        core::iter::once(tile).chain(tree.children(tile).flat_map(|child| under(tree, child))).collect()
    }

    #[test]
    fn children_cover_their_parent_once_and_are_off_by_no_more() {
        for size in [uvec2(300, 170), uvec2(257, 65), uvec2(66, 400), uvec2(1, 1), uvec2(1, 90)] {
            let tree = tree(size);
            let area = |tile| tree.area(tile)[1] - tree.area(tile)[0];
            assert_eq!(area(tree.root()), size.as_vec2() * 2.0);
            for tile in under(&tree, tree.root()).into_iter().filter(|tile| tile.level > 0) {
                let [low, high] = tree.area(tile);
                let mut sum = 0.0;
                for child in tree.children(tile) {
                    assert!(tree.area(child)[0].cmpge(low).all() && tree.area(child)[1].cmple(high).all());
                    let [above, below] = [tile, child].map(|tile| tree.bounds(tile));
                    assert!(below.error <= above.error && below.most <= above.most, "{tile:?}, {child:?}");
                    sum += area(child).element_product();
                }
                assert!((sum - area(tile).element_product()).abs() < 1e-3 * sum, "{size}, {tile:?}: {sum}");
            }
        }
    }
}
