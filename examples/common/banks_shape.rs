//! A mesh in the making: tubes, blades and cards with colours, and normals bent for soft light.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use std::f32::consts::TAU;

/// Vertices and triangles of one mesh.
#[derive(Default)]
pub struct Shape {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<[f32; 4]>,
    indices: Vec<u32>,
}

impl Shape {
    /// Adds a vertex and returns its number. The colour is linear and multiplies the material's.
    pub fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2, color: Vec3) -> u32 {
        self.positions.push(position);
        self.normals.push(normal.normalize_or(Vec3::Y));
        self.uvs.push(uv);
        self.colors.push(color.extend(1.0).to_array());
        self.positions.len() as u32 - 1
    }

    pub fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.indices.extend([a, b, c]);
    }

    /// A tube through points with radii, `sides` ≥ 3; the texture goes around it once and along it once a metre.
    pub fn tube(&mut self, points: &[(Vec3, f32)], sides: u32, color: Vec3) {
        let first = self.positions.len() as u32;
        let mut along = 0.0;
        for (i, (center, radius)) in points.iter().enumerate() {
            let (before, after) = (points[i.saturating_sub(1)].0, points[(i + 1).min(points.len() - 1)].0);
            along += before.distance(*center);
            let (right, up) = (after - before).normalize_or(Vec3::Y).any_orthonormal_pair();
            for side in 0..=sides {
                let turn = side as f32 / sides as f32;
                let out = right * (turn * TAU).cos() + up * (turn * TAU).sin();
                self.vertex(center + out * *radius, out, vec2(turn, -along), color);
            }
        }
        for ring in 0..points.len() as u32 - 1 {
            for side in 0..sides {
                let a = first + ring * (sides + 1) + side;
                let b = a + sides + 1;
                self.indices.extend([a, a + 1, b, a + 1, b + 1, b]);
            }
        }
    }

    /// A blade that starts at `base`, bends over by `bend` and ends in a point; its colour goes from dark to light.
    pub fn blade(&mut self, base: Vec3, rise: Vec3, bend: Vec3, width: f32, colors: [Vec3; 2]) {
        let side = rise.cross(bend).normalize_or(Vec3::X) * width * 0.5;
        let normal = (rise.normalize_or(Vec3::Y) + bend.normalize_or_zero() * 0.4).normalize();
        let point = |t: f32| base + rise * t + bend * t * t;
        let rows = [(0.0, 0.8), (0.55, 1.0)].map(|(t, wide): (f32, f32)| {
            let color = colors[0].lerp(colors[1], t);
            [-1.0, 1.0].map(|s| self.vertex(point(t) + side * s * wide, normal, vec2(0.5, 1.0 - t), color))
        });
        let tip = self.vertex(point(1.0), normal, vec2(0.5, 0.0), colors[1]);
        let [[a, b], [c, d]] = rows;
        self.indices.extend([a, b, c, b, d, c, c, d, tip]);
    }

    /// A whole texture on a rectangle that stands on the middle of its lower edge; `normal` is for the light only.
    pub fn card(&mut self, foot: Vec3, right: Vec3, up: Vec3, normal: Vec3, color: Vec3) {
        let corner = |x: f32, y: f32| (foot + right * x + up * y, vec2(x + 0.5, 1.0 - y));
        let [a, b, c, d] = [(-0.5, 0.0), (0.5, 0.0), (0.5, 1.0), (-0.5, 1.0)].map(|(x, y)| {
            let (position, uv) = corner(x, y);
            self.vertex(position, normal, uv, color)
        });
        self.indices.extend([a, b, c, a, c, d]);
    }

    /// Multiplies every colour.
    pub fn tint(&mut self, tint: Vec3) {
        for color in &mut self.colors {
            for (channel, factor) in color.iter_mut().zip(tint.to_array()) {
                *channel *= factor;
            }
        }
    }

    pub fn into_mesh(self) -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, self.uvs)
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, self.colors)
            .with_inserted_indices(Indices::U32(self.indices))
    }
}

/// A direction of even likelihood.
pub fn any_direction(random: &mut fastrand::Rng) -> Vec3 {
    let (y, turn) = (random.f32() * 2.0 - 1.0, random.f32() * TAU);
    let level = (1.0 - y * y).sqrt();
    vec3(level * turn.cos(), y, level * turn.sin())
}

/// A number between two.
pub fn between(random: &mut fastrand::Rng, low: f32, high: f32) -> f32 {
    low + random.f32() * (high - low)
}
