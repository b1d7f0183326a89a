//! The mesh of a tile, with skirts that close the cracks to coarser and finer ones beside it.
use super::tree::{Tile, Tree};
use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

/// How far skirts reach below the edge of a tile, m.
///
/// No tile is off the ground by more than the e of the root. So a tile's edge is at most 2 e above that of any tile beside it,
/// and a skirt of 2 e leaves no crack, whichever levels meet.
pub fn skirt(tree: &Tree) -> f32 {
    2.01 * tree.bounds(tree.root()).most + 1e-3
}

/// The box around a tile with its skirts.
pub fn bounds(tree: &Tree, tile: Tile) -> Aabb {
    let ([low, high], heights) = (tree.area(tile), tree.bounds(tile).heights);
    Aabb::from_min_max(vec3(low.x, heights.x - skirt(tree), low.y), vec3(high.x, heights.y, high.y))
}

/// The triangles of a tile. Its normals point up: those of the ground are a texture, the same on all levels. uv go from 0
/// in the north-west of the terrain to 1 in its south-east.
pub fn mesh(tree: &Tree, tile: Tile) -> Mesh {
    let mut builder =
        Builder { extent: tree.levels.terrain().extent(), floor: tree.bounds(tree.root()).heights.x, ..default() };
    let [columns, rows] = lines(tree, tile);
    for row in &rows {
        for column in &columns {
            let height = tree.levels.height(tile.level, uvec2(column.vertex, row.vertex));
            builder.positions.push(vec3(column.place, height, row.place));
        }
    }
    let width = columns.len() as u16;
    for (y, row) in rows.iter().enumerate().take(rows.len() - 1) {
        for (x, column) in columns.iter().enumerate().take(columns.len() - 1) {
            let corner = y as u16 * width + x as u16;
            let quad = uvec2(column.vertex, row.vertex).min(tree.levels.quads(tile.level) - 1);
            let is_cut = tree.levels.is_cut_from_north_west(tile.level, quad);
            builder.quad([corner, corner + 1, corner + width + 1, corner + width], is_cut);
        }
    }
    builder.skirts(width, tree.rims(tile), skirt(tree));
    builder.mesh()
}

/// A column or row of vertices of a mesh.
struct Line {
    vertex: u32,
    /// x or z, m.
    place: f32,
}

/// Columns and rows of a tile. At the edge of the terrain one more lies at the edges of the cells.
fn lines(tree: &Tree, tile: Tile) -> [Vec<Line>; 2] {
    let ([first, last], [low, high]) = (tree.vertices(tile), tree.area(tile));
    let [west, north, east, south] = tree.rims(tile);
    let terrain = tree.levels.terrain();
    let place = |vertex: UVec2| terrain.position(tree.levels.cell(tile.level, vertex));
    let columns = (first.x..=last.x).map(|vertex| Line { vertex, place: place(uvec2(vertex, 0)).x });
    let rows = (first.y..=last.y).map(|vertex| Line { vertex, place: place(uvec2(0, vertex)).y });
    let edge = |is_there: bool, vertex, place| is_there.then_some(Line { vertex, place });
    [
        edge(west, first.x, low.x).into_iter().chain(columns).chain(edge(east, last.x, high.x)).collect(),
        edge(north, first.y, low.y).into_iter().chain(rows).chain(edge(south, last.y, high.y)).collect(),
    ]
}

#[derive(Default)]
struct Builder {
    extent: Vec2,
    /// Skirts reach no lower, m.
    floor: f32,
    positions: Vec<Vec3>,
    indices: Vec<u16>,
}

impl Builder {
    /// Two triangles between corners that go round as north-west, north-east, south-east, south-west.
    fn quad(&mut self, quad: [u16; 4], is_cut_from_north_west: bool) {
        let corners = if is_cut_from_north_west { [0, 2, 1, 0, 3, 2] } else { [0, 3, 1, 1, 3, 2] };
        self.indices.extend(corners.map(|corner: usize| quad[corner]));
    }

    /// Hangs a skirt on every side that is not at the edge of the terrain.
    fn skirts(&mut self, width: u16, [west, north, east, south]: [bool; 4], depth: f32) {
        let last = self.positions.len() as u16 - 1;
        let across = || 0..width;
        let along = || (0..=last / width).map(move |row| row * width);
        if !north {
            self.skirt(across().collect(), depth);
        }
        if !south {
            self.skirt(across().map(|column| last - column).collect(), depth);
        }
        if !west {
            self.skirt(along().rev().collect(), depth);
        }
        if !east {
            self.skirt(along().map(|row| row + width - 1).collect(), depth);
        }
    }

    /// A skirt that is seen from the left of `edge`.
    fn skirt(&mut self, edge: Vec<u16>, depth: f32) {
        let below = self.positions.len() as u16;
        let sunk: Vec<Vec3> = edge
            .iter()
            .map(|vertex| self.positions[usize::from(*vertex)])
            // No tile is lower than the floor.
            .map(|place| place.with_y((place.y - depth).max(self.floor)))
            .collect();
        self.positions.extend(sunk);
        for (index, pair) in edge.windows(2).enumerate() {
            let (a, b) = (below + index as u16, below + index as u16 + 1);
            self.indices.extend([pair[0], pair[1], b, pair[0], b, a]);
        }
    }

    fn mesh(self) -> Mesh {
        let count = self.positions.len();
        let uvs: Vec<Vec2> = self.positions.iter().map(|place| place.xz() / self.extent + 0.5).collect();
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Y; count])
            // The second tangent points south, as v grows.
            .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![Vec3::X.extend(-1.0); count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
            .with_inserted_indices(Indices::U16(self.indices))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::tree::{TILE, tests::tree};

    fn positions(mesh: &Mesh) -> Vec<Vec3> {
        let values = mesh.attribute(Mesh::ATTRIBUTE_POSITION).and_then(|values| values.as_float3());
        values.unwrap().iter().copied().map(Vec3::from_array).collect()
    }

    /// Triangles by what they face: up, or to a side.
    fn triangles(mesh: &Mesh) -> (Vec<[Vec3; 3]>, Vec<[Vec3; 3]>) {
        let all = mesh.triangles().unwrap().map(|triangle| triangle.vertices);
        all.filter(|[a, b, c]| (*b - *a).cross(*c - *a).length() > 1e-6)
            .partition(|[a, b, c]| (*b - *a).cross(*c - *a).y > 1e-3)
    }

    #[test]
    fn a_tile_faces_up_over_all_of_its_area() {
        let tree = tree(uvec2(300, 170));
        for tile in [
            tree.root(),
            Tile { level: 0, at: uvec2(0, 0) },
            Tile { level: 0, at: uvec2(4, 2) },
            Tile { level: 1, at: uvec2(1, 1) },
        ] {
            let [low, high] = tree.area(tile);
            let (up, sides) = triangles(&mesh(&tree, tile));
            let area: f32 = up.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).y).sum();
            assert!((area - (high - low).element_product()).abs() < 0.1, "{tile:?}: {area} m²");
            // Those that do not face up face away from the middle of the tile.
            let middle = 0.5 * (low + high);
            for [a, b, c] in sides {
                let normal = (b - a).cross(c - a);
                assert!(normal.y.abs() < 1e-3 && normal.xz().dot((a + b + c).xz() / 3.0 - middle) > 0.0, "{tile:?}");
            }
        }
    }

    #[test]
    fn skirts_reach_below_every_tile_beside() {
        let tree = tree(uvec2(700, 430));
        let levels = &tree.levels;
        // Edges between tiles lie on vertices of every level that has such an edge: compare them all at each cell there.
        for column in (TILE..levels.quads(0).x).step_by(TILE as usize) {
            for row in 0..levels.terrain().size().y {
                let coarsest = (column / TILE).trailing_zeros().min(tree.root().level - 1);
                let heights = (0..=coarsest).map(|level| {
                    let quad = uvec2(column, row) >> level;
                    let [low, high] = [quad, quad + UVec2::Y].map(|vertex| vertex.min(levels.quads(level)));
                    let [north, south] = [low, high].map(|vertex| levels.cell(level, vertex).y);
                    let share = (row - north) as f32 / (south - north).max(1) as f32;
                    levels.height(level, low).lerp(levels.height(level, high), share)
                });
                let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), z| (low.min(z), high.max(z)));
                assert!(high - low <= skirt(&tree), "column {column}, row {row}: {} m", high - low);
            }
        }
    }

    #[test]
    fn tiles_of_a_level_share_their_edges() {
        let tree = tree(uvec2(300, 170));
        let [west, east] = [0, 1].map(|x| positions(&mesh(&tree, Tile { level: 0, at: uvec2(x, 1) })));
        let edge = tree.area(Tile { level: 0, at: uvec2(1, 1) })[0].x;
        let on_edge = |places: &[Vec3]| {
            let mut found: Vec<_> =
                places.iter().filter(|place| place.x == edge).map(|place| place.to_array()).collect();
            found.sort_by(|a, b| a[2].total_cmp(&b[2]).then(a[1].total_cmp(&b[1])));
            found
        };
        assert_eq!(on_edge(&west), on_edge(&east));
        // Vertices and their skirts, and the corners' skirts of the sides that meet the edge.
        assert_eq!(on_edge(&west).len() as u32, 2 * (TILE + 1) + 2);
    }
}
