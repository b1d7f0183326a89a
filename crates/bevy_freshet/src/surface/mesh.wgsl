// The rings of the mesh; the Rust side is `nested_grid` in `mesh.rs`.
#define_import_path freshet::surface::mesh

#import freshet::surface::bindings::surface
#import freshet::surface::types

// Part of a ring's half width at which its spacing begins to turn into that of the next one.
const TURN: f32 = 0.75;

struct Ring {
    index: u32,
    outer: f32,     // half width, units: m
}

// The ring in which a place lies that is this far (Chebyshev) from the centre.
fn ring_at(distance: f32) -> Ring {
    let index = clamp(ceil(log2(max(distance / surface.mesh_reach, 1e-6))), 0.0, f32(types::RINGS - 1u));
    return Ring(u32(index), surface.mesh_reach * exp2(index));
}

// Size of the mesh's cells in metres at `from_center` (local xz, m).
fn cell_at(from_center: vec2<f32>) -> f32 {
    return surface.mesh_cells[ring_at(max(abs(from_center.x), abs(from_center.y))).index];
}

// The same, but continuous from ring to ring.
fn spacing_at(from_center: vec2<f32>) -> f32 {
    let distance = max(abs(from_center.x), abs(from_center.y));
    let ring = ring_at(distance);
    let next = min(ring.index + 1u, types::RINGS - 1u);
    let turned = clamp((distance / ring.outer - TURN) / (1.0 - TURN), 0.0, 1.0);
    return mix(surface.mesh_cells[ring.index], surface.mesh_cells[next], turned);
}
