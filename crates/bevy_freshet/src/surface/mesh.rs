//! The mesh of the surface: nested rings of squares, fine at its centre and coarse far away.
use bevy::{
    asset::RenderAssetUsages,
    math::I64Vec2,
    mesh::{Indices, PrimitiveTopology},
    platform::collections::HashMap,
    prelude::*,
};

/// Rings around the finest part so that the mesh reaches at least `reach` metres from its centre.
pub(super) fn rings_for(cell: f32, cells: u32, reach: f32) -> u32 {
    let inner = cell * cells as f32 * 0.5;
    ((reach / inner).max(1.0).log2().ceil() as u32).min(MAX_RINGS)
}

/// Enough for the largest water with the finest mesh.
const MAX_RINGS: u32 = 32;

/// A square of `cells` × `cells` with the spacing `cell` (m), surrounded by `rings` rings, each twice as large as what it
/// surrounds with twice its spacing. Centred on the origin in the xz plane; `cells` must be a multiple of 4.
///
/// Where a ring meets the next one, every other vertex of its rim is moved onto its neighbour: the finer side then has
/// the very edges of the coarser one, and no crack can open.
pub(super) fn nested_grid(cell: f32, cells: u32, rings: u32) -> Mesh {
    debug_assert!(cells.is_multiple_of(4) && cells > 0, "rings must meet in whole cells");
    let half = cells as i32 / 2;
    let mut builder = Builder::default();
    for ring in 0..=rings {
        let is_hole =
            |x: i32, z: i32| ring > 0 && (-half / 2..half / 2).contains(&x) && (-half / 2..half / 2).contains(&z);
        for z in -half..half {
            for x in -half..half {
                if !is_hole(x, z) {
                    let corners = [(x, z), (x, z + 1), (x + 1, z + 1), (x + 1, z)];
                    builder.quad(corners.map(|corner| builder_vertex(corner, half, ring, ring < rings)));
                }
            }
        }
    }
    builder.mesh(cell)
}

/// Position of a ring's vertex in finest cells; on the rim, odd vertices fall onto the even one before.
fn builder_vertex((x, z): (i32, i32), half: i32, ring: u32, joins_coarser: bool) -> I64Vec2 {
    let even = |along: i32| along - along.rem_euclid(2);
    let on_rim = |across: i32| joins_coarser && across.abs() == half;
    let x_joined = if on_rim(z) { even(x) } else { x };
    let z_joined = if on_rim(x) { even(z) } else { z };
    ivec2(x_joined, z_joined).as_i64vec2() << i64::from(ring)
}

#[derive(Default)]
struct Builder {
    vertices: HashMap<I64Vec2, u32>,
    positions: Vec<I64Vec2>,
    indices: Vec<u32>,
}

impl Builder {
    fn vertex(&mut self, position: I64Vec2) -> u32 {
        *self.vertices.entry(position).or_insert_with(|| {
            self.positions.push(position);
            self.positions.len() as u32 - 1
        })
    }

    /// Two triangles, or what is left of them when corners coincide.
    fn quad(&mut self, corners: [I64Vec2; 4]) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]].map(|triangle: [usize; 3]| triangle.map(|i| corners[i])) {
            if (b - a).perp_dot(c - a) != 0 {
                let triangle = [a, b, c].map(|position| self.vertex(position));
                self.indices.extend(triangle);
            }
        }
    }

    fn mesh(self, cell: f32) -> Mesh {
        let position = |p: &I64Vec2| vec3(p.x as f32 * cell, 0.0, p.y as f32 * cell);
        let positions: Vec<Vec3> = self.positions.iter().map(position).collect();
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
            .with_inserted_indices(Indices::U32(self.indices))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(mesh: &Mesh) -> Vec<[Vec3; 3]> {
        mesh.triangles().unwrap().map(|triangle| triangle.vertices).collect()
    }

    #[test]
    fn rings_tile_the_square_without_gap_or_overlap() {
        let mesh = nested_grid(0.5, 8, 3);
        let area: f32 = triangles(&mesh).iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).y * 0.5).sum();
        // 8 cells of 0.5 m, doubled three times: 32 m.
        assert!((area - 32.0 * 32.0).abs() < 1e-2, "{area}");
        assert!(triangles(&mesh).iter().all(|[a, b, c]| (*b - *a).cross(*c - *a).y > 0.0), "all face up");
    }

    #[test]
    fn every_inner_edge_is_shared_by_two_triangles() {
        let mesh = nested_grid(1.0, 8, 2);
        let mut edges = HashMap::<(IVec2, IVec2), i32>::default();
        for triangle in triangles(&mesh) {
            for i in 0..3 {
                let [a, b] = [triangle[i], triangle[(i + 1) % 3]].map(|p| p.xz().as_ivec2());
                *edges.entry((a, b)).or_default() += 1;
                *edges.entry((b, a)).or_default() -= 1;
            }
        }
        let rim = 16;
        for ((a, b), balance) in edges {
            let outer = |p: IVec2| p.abs().max_element() == rim;
            assert!(balance == 0 || outer(a) && outer(b), "crack between {a} and {b}");
        }
    }

    #[test]
    fn rings_reach_as_far_as_asked() {
        assert_eq!(rings_for(0.25, 64, 5.0), 0);
        assert_eq!(rings_for(0.25, 64, 8.1), 1);
        assert_eq!(rings_for(0.25, 64, 1000.0), 7);
        // The finest mesh on the largest water: no overflow, no hole.
        let mesh = nested_grid(0.005, 8, rings_for(0.005, 8, 2e6));
        assert!(triangles(&mesh).iter().flatten().any(|p| p.x > 1e6));
    }
}
