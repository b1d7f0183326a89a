//! Stones of a bank: balls worn by the stream, about 1 m across, flattened.

use super::shape::Shape;
use bevy::prelude::*;
use noise::{NoiseFn, Perlin};

/// A stone of `detail` subdivisions of an icosahedron (2: 180 triangles) with flat and rounded places.
pub fn stone(seed: u32, detail: u32) -> Shape {
    let noise = Perlin::new(seed);
    let at = |p: Vec3, frequency: f32| noise.get((p * frequency).as_dvec3().to_array()) as f32;
    let surface = |d: Vec3| {
        let radius = 0.5 + 0.16 * at(d, 1.3) + 0.07 * at(d, 2.9) - 0.05 * at(d, 5.3).abs();
        // Broken faces: the radius ends at planes in a few directions.
        let cut = [vec3(0.3, 0.9, 0.2), vec3(-0.8, 0.5, 0.4), vec3(0.5, 0.4, -0.8)]
            .iter()
            .map(|face| 0.40 / d.dot(face.normalize()).max(0.2))
            .fold(radius, f32::min);
        d * cut * vec3(1.0, 0.62, 0.8)
    };
    let mut shape = Shape::default();
    let Ok(ball) = Sphere::new(1.0).mesh().ico(detail) else {
        return shape;
    };
    let Some(directions) = ball.attribute(Mesh::ATTRIBUTE_POSITION).and_then(|a| a.as_float3()) else {
        return shape;
    };
    for direction in directions {
        let d = Vec3::from_array(*direction);
        let (right, up) = d.any_orthonormal_pair();
        let near = |offset: Vec3| surface((d + offset * 0.12).normalize());
        let normal = (near(right) - near(-right)).cross(near(up) - near(-up));
        let grey = vec3(0.135, 0.125, 0.110) * (0.9 + 0.6 * at(d, 2.3) + 0.5 * at(d, 6.1));
        let lichen = vec3(0.090, 0.100, 0.050);
        let mossy = ((normal.normalize_or_zero().y - 0.6) + 1.4 * at(d, 3.0)).clamp(0.0, 0.8);
        shape.vertex(surface(d), normal, Vec2::ZERO, grey.lerp(lichen, mossy));
    }
    let corners: Vec<u32> = ball.indices().map(|i| i.iter().map(|i| i as u32).collect()).unwrap_or_default();
    for corner in corners.as_chunks::<3>().0 {
        shape.triangle(corner[0], corner[1], corner[2]);
    }
    shape
}
