// Bed elevation and current on their grids, sampled as `freshet_hydro::grid::Grid::sample` does.
#define_import_path freshet::surface::ground

#import freshet::surface::bindings::{surface, bed, flow}
#import freshet::surface::types

// The four cells around a place and the weights between them.
struct Cells {
    low: vec2<i32>,
    high: vec2<i32>,
    t: vec2<f32>,
}

fn cells_around(place: vec2<f32>, cell: f32, size: vec2<f32>) -> Cells {
    let p = clamp(place / cell + size / 2.0 - 0.5, vec2(0.0), size - 1.0);
    let low = floor(p);
    return Cells(vec2<i32>(low), vec2<i32>(min(low + 1.0, size - 1.0)), p - low);
}

fn lerp(a: vec2<f32>, b: vec2<f32>, t: f32) -> vec2<f32> {
    return a + (b - a) * t;
}

// Share of the simulated water at local `place`: 0 from the rim of its area on outwards.
fn simulated_share(place: vec2<f32>) -> f32 {
    let offset = place - surface.simulated_center;
    let inside = surface.simulated_half_size.xxyy + vec4(offset.x, -offset.x, offset.y, -offset.y);
    let t = select(vec4(1.0), inside * surface.simulated_per_blend, surface.simulated_per_blend > vec4(0.0));
    return smoothstep(0.0, 1.0, min(min(t.x, t.y), min(t.z, t.w)));
}

// How far the ground at local `rest` lies below the still level, m: very far without a bed if it is not simulated, far above where it has no data.
fn ground_depth(rest: vec2<f32>) -> f32 {
    if (surface.flags & types::FLAG_BED) == 0u {
        return select(1e6, surface.flat_depth, simulated_share(rest) > 0.0);
    }
    let place = surface.bed_from_local * rest + surface.bed_origin;
    let c = cells_around(place, surface.bed_cell, surface.bed_size);
    let north = lerp(textureLoad(bed, c.low, 0).xx, textureLoad(bed, vec2(c.high.x, c.low.y), 0).xx, c.t.x);
    let south = lerp(textureLoad(bed, vec2(c.low.x, c.high.y), 0).xx, textureLoad(bed, c.high, 0).xx, c.t.x);
    let elevation = lerp(north, south, c.t.y).x;
    return surface.level - (surface.bed_base + elevation);
}

// Current of the flow map at local `place` in still water of `depth`, local xz, m/s: less over the last decimetre.
fn mapped_current(place: vec2<f32>, depth: f32) -> vec2<f32> {
    if (surface.flags & types::FLAG_FLOW) == 0u {
        return vec2(0.0);
    }
    let c = cells_around(place, surface.flow_cell, surface.flow_size);
    let north = lerp(textureLoad(flow, c.low, 0).xy, textureLoad(flow, vec2(c.high.x, c.low.y), 0).xy, c.t.x);
    let south = lerp(textureLoad(flow, vec2(c.low.x, c.high.y), 0).xy, textureLoad(flow, c.high, 0).xy, c.t.x);
    return lerp(north, south, c.t.y) * (surface.flow_factor * smoothstep(0.0, surface.bank_depth, depth));
}
