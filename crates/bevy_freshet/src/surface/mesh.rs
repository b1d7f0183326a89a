//! The mesh of the surface: nested rings of squares, fine at its centre and coarse far away.
use bevy::{
    asset::RenderAssetUsages,
    math::I64Vec2,
    mesh::{Indices, PrimitiveTopology},
    platform::collections::HashMap,
    prelude::*,
};

/// A square of `cells` × `cells` with the spacing `cell` (m), surrounded by rings, each twice as large as what it surrounds
/// with twice its spacing. For each of them, the square first, `coarser` is a power of two by which its cells are larger and fewer.
/// Centred on the origin in the xz plane; the cells left must be a multiple of 4.
///
/// Where a ring meets a coarser one, the vertices of its rim are moved onto those of its neighbour: the finer side then has
/// the very edges of the coarser one, and no crack can open.
pub(super) fn nested_grid(cell: f32, cells: u32, coarser: &[u8]) -> Mesh {
    let mut builder = Builder::default();
    for (ring, &power) in coarser.iter().enumerate() {
        let across = cells >> power;
        debug_assert!(across.is_multiple_of(4) && across > 0, "rings must meet in whole cells");
        let half = across as i32 / 2;
        let next = coarser.get(ring + 1);
        // Cells of the next ring over those of this one.
        let joint = next.map_or(1, |next| 2 << next >> power);
        let is_hole =
            |x: i32, z: i32| ring > 0 && (-half / 2..half / 2).contains(&x) && (-half / 2..half / 2).contains(&z);
        let vertex = |corner| joined(corner, half, joint).as_i64vec2() << (ring as i64 + i64::from(power));
        for z in -half..half {
            for x in -half..half {
                if !is_hole(x, z) {
                    let corners = [(x, z), (x, z + 1), (x + 1, z + 1), (x + 1, z)];
                    builder.quad(corners.map(vertex));
                }
            }
        }
    }
    builder.mesh(cell)
}

/// A vertex of a ring that is `half` cells wide to each side; on the rim it falls onto the one before that the neighbour has,
/// whose cells are `joint` times as large.
fn joined((x, z): (i32, i32), half: i32, joint: i32) -> IVec2 {
    let on_joint = |along: i32| along - along.rem_euclid(joint);
    let on_rim = |across: i32| across.abs() == half;
    ivec2(if on_rim(z) { on_joint(x) } else { x }, if on_rim(x) { on_joint(z) } else { z })
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
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
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

    /// Rings of which some have fewer cells than others.
    const COARSER: [&[u8]; 4] = [&[0, 0, 0, 0], &[0, 1, 1, 1], &[0, 2, 1, 0], &[1, 1, 2, 2]];

    #[test]
    fn rings_tile_the_square_without_gap_or_overlap() {
        for coarser in COARSER {
            let mesh = nested_grid(0.5, 16, coarser);
            let area: f32 = triangles(&mesh).iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).y * 0.5).sum();
            // 16 cells of 0.5 m, doubled three times: 64 m.
            assert!((area - 64.0 * 64.0).abs() < 1e-2, "{coarser:?}: {area}");
            assert!(triangles(&mesh).iter().all(|[a, b, c]| (*b - *a).cross(*c - *a).y > 0.0), "all face up");
        }
    }

    #[test]
    fn every_inner_edge_is_shared_by_two_triangles() {
        for coarser in COARSER {
            let mesh = nested_grid(1.0, 16, coarser);
            let mut edges = HashMap::<(IVec2, IVec2), i32>::default();
            for triangle in triangles(&mesh) {
                for i in 0..3 {
                    let [a, b] = [triangle[i], triangle[(i + 1) % 3]].map(|p| p.xz().as_ivec2());
                    *edges.entry((a, b)).or_default() += 1;
                    *edges.entry((b, a)).or_default() -= 1;
                }
            }
            let rim = 64;
            for ((a, b), balance) in edges {
                let outer = |p: IVec2| p.abs().max_element() == rim;
                assert!(balance == 0 || outer(a) && outer(b), "{coarser:?}: crack between {a} and {b}");
            }
        }
    }

    #[test]
    fn coarser_rings_have_fewer_triangles() {
        let count = |coarser| triangles(&nested_grid(0.15, 64, coarser)).len();
        // 2 · 64² in the middle and three quarters of that in each ring, less what vanishes where rims are joined: half of the
        // edges at a rim, or all but one in eight.
        assert_eq!(count(&[0; 4]), 8192 + 3 * (6144 - 4 * 32));
        assert_eq!(count(&[0, 2, 3, 3]), (8192 - 4 * 56) + (384 - 4 * 12) + (96 - 4 * 4) + 96);
    }

    #[test]
    fn the_finest_mesh_covers_the_largest_water() {
        let mesh = nested_grid(0.005, 8, &[0; 30]);
        assert!(triangles(&mesh).iter().flatten().any(|p| p.x > 1e6));
    }
}
