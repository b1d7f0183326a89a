//! The sides of the terrain, as those of a model that was cut out.
use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use freshet_hydro::grid::Grid;

/// Four walls from the edge of the terrain down to `base` (m).
pub fn mesh(terrain: &Grid<f32>, base: f32) -> Mesh {
    let last = terrain.size() - 1;
    let half = 0.5 * terrain.extent();
    let columns = || (0..=last.x).map(|x| (x, terrain.position(uvec2(x, 0)).x));
    let rows = || (0..=last.y).map(|y| (y, terrain.position(uvec2(0, y)).y));
    let height = |x, y| terrain.get(uvec2(x, y)).copied().unwrap_or(base);
    // From left to right as they are seen, their corners at the edges of the cells.
    let south = columns().map(|(x, place)| vec3(place, height(x, last.y), half.y));
    let east = rows().rev().map(|(y, place)| vec3(half.x, height(last.x, y), place));
    let north = columns().rev().map(|(x, place)| vec3(place, height(x, 0), -half.y));
    let west = rows().map(|(y, place)| vec3(-half.x, height(0, y), place));
    let mut walls = Walls { base, ..default() };
    walls.add(south, Vec3::Z, half.x);
    walls.add(east, Vec3::X, half.y);
    walls.add(north, Vec3::NEG_Z, half.x);
    walls.add(west, Vec3::NEG_X, half.y);
    walls.mesh()
}

#[derive(Default)]
struct Walls {
    base: f32,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    indices: Vec<u32>,
}

impl Walls {
    /// A wall under `top`, which faces along `normal` and reaches `half` (m) to both sides of the middle.
    fn add(&mut self, top: impl Iterator<Item = Vec3>, normal: Vec3, half: f32) {
        let right = Vec3::Y.cross(normal) * half;
        let top: Vec<Vec3> = top.collect();
        let (Some(first), Some(last)) = (top.first().copied(), top.last().copied()) else { return };
        // Its ends reach half a cell further than the middles of the cells.
        let end = |place: Vec3, side: f32| place.reject_from(right) + side * right;
        let begin = self.positions.len() as u32;
        for place in [end(first, -1.0)].into_iter().chain(top).chain([end(last, 1.0)]) {
            self.positions.extend([place, place.with_y(self.base)]);
            self.normals.extend([normal; 2]);
        }
        let count = self.positions.len() as u32;
        for left in (begin..count - 2).step_by(2) {
            self.indices.extend([left, left + 1, left + 3, left, left + 3, left + 2]);
        }
    }

    fn mesh(self) -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
            .with_inserted_indices(Indices::U32(self.indices))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_face_outwards_and_close_the_block() {
        let terrain = Grid::from_fn(uvec2(5, 3), 2.0, |cell| 1.0 + 0.5 * cell.x as f32).unwrap();
        let mesh = mesh(&terrain, -1.0);
        let mut volume = 0.0;
        for triangle in mesh.triangles().unwrap() {
            let [a, b, c] = triangle.vertices;
            let normal = (b - a).cross(c - a);
            assert!(normal.y == 0.0 && normal.dot((a + b + c) / 3.0) >= 0.0, "{triangle:?}");
            // ∮ (x, 0, z) · dA = 2 V, of which top and base have no share.
            volume += 0.25 * normal.dot((a + b + c).with_y(0.0)) / 3.0;
        }
        // A mean height of 2 m over the base at −1 m, on 10 m × 6 m.
        assert!((volume - 3.0 * 60.0).abs() < 1e-3, "{volume} m³");
    }
}
