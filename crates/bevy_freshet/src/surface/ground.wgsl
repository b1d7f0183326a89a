// Bed elevation and current on their grids, sampled as `freshet_hydro::grid::Grid::sample` does, and the simulated water, sampled
// as `freshet_hydro::shallow_water::Field` is.
#define_import_path freshet::surface::ground

#import freshet::surface::bindings::{surface, bed, flow, simulated, simulated_slopes}
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

// The simulated water at a place.
struct Simulated {
    level: f32,             // over the still level, units: m
    velocity: vec2<f32>,    // units: m/s
    is_wet: bool,
}

// Depth from which on a cell counts as wet, units: m.
const WET: f32 = 1e-3;
// How far under the ground the surface of a simulated water is put where it is dry, units: m.
const DRY: f32 = 0.5;

// Distance between those places that are looked up, units: m. Where it is more than a cell, coarser levels count.
var<private> spacing: f32 = 0.0;

// Shares of the four cells around a place: bilinear.
fn shares(t: vec2<f32>) -> vec4<f32> {
    return vec4((1.0 - t.x) * (1.0 - t.y), t.x * (1.0 - t.y), (1.0 - t.x) * t.y, t.x * t.y);
}

// Share of the simulated water at local `place`: 0 from the rim of its area on outwards.
fn simulated_share(place: vec2<f32>) -> f32 {
    let offset = place - surface.simulated_center;
    let inside = surface.simulated_half_size.xxyy + vec4(offset.x, -offset.x, offset.y, -offset.y);
    let t = select(vec4(1.0), inside * surface.simulated_per_blend, surface.simulated_per_blend > vec4(0.0));
    return smoothstep(0.0, 1.0, min(min(t.x, t.y), min(t.z, t.w)));
}

// The simulated water at local `place`, blended into the water outside its area.
fn simulated_at(place: vec2<f32>) -> Simulated {
    let share = simulated_share(place);
    if share >= 1.0 {
        return simulated_within(place);
    }
    let outside = mapped_current(place, ground_depth(place));
    if share <= 0.0 {
        return Simulated(0.0, outside, true);
    }
    let water = simulated_within(place);
    let level = level_or_under_ground(water, place);
    return Simulated(share * level, mix(outside, water.velocity, share), true);
}

// Where the surface of simulated water is put at local `place`, over the still level, units: m.
fn level_or_under_ground(water: Simulated, place: vec2<f32>) -> f32 {
    if water.is_wet {
        return water.level;
    }
    return -clamp(ground_depth(place), -1e5, 1e5) - DRY;
}

// The simulated water at local `place`, as finely as `spacing` asks for.
fn simulated_within(place: vec2<f32>) -> Simulated {
    let wanted = level_of_detail();
    let level = floor(wanted);
    let fine = simulated_in(place, i32(level));
    let share = wanted - level;
    if share < 1e-3 {
        return fine;
    }
    let coarse = simulated_in(place, i32(level) + 1);
    let height = mix(level_or_under_ground(fine, place), level_or_under_ground(coarse, place), share);
    let is_wet = select(fine.is_wet, coarse.is_wet, share > 0.5);
    return Simulated(height, mix(fine.velocity, coarse.velocity, share), is_wet);
}

// The level of the pictures whose texels are as far apart as the places that are looked up, no coarser than there is.
fn level_of_detail() -> f32 {
    let most = f32(textureNumLevels(simulated) - 1u);
    return clamp(log2(max(spacing, 1e-6) / surface.simulated_cell), 0.0, most);
}

// The cells around local `place` in a level of the pictures.
fn simulated_cells(place: vec2<f32>, level: i32) -> Cells {
    let texel = surface.simulated_cell * exp2(f32(level));
    let corner = place - surface.simulated_center + 0.5 * surface.simulated_cell * surface.simulated_size;
    let last = vec2<f32>(textureDimensions(simulated, level)) - 1.0;
    let p = clamp(corner / texel - 0.5, vec2(0.0), last);
    let low = floor(p);
    var cells = Cells(vec2<i32>(low), vec2<i32>(min(low + 1.0, last)), p - low);
    // Nothing is seen through a wall: the water before it is as it is at its own cells.
    if level == 0 && (surface.flags & types::FLAG_WALLED) != 0u {
        let nw = textureLoad(simulated_slopes, cells.low, 0).zw;
        let ne = textureLoad(simulated_slopes, vec2(cells.high.x, cells.low.y), 0).w;
        let sw = textureLoad(simulated_slopes, vec2(cells.low.x, cells.high.y), 0).z;
        let stands = vec2(nw.x + sw, nw.y + ne) > vec2(0.5);
        cells.t = select(cells.t, floor(cells.t + 0.5), stands);
    }
    return cells;
}

fn simulated_in(place: vec2<f32>, level: i32) -> Simulated {
    let c = simulated_cells(place, level);
    let nw = textureLoad(simulated, c.low, level);
    let ne = textureLoad(simulated, vec2(c.high.x, c.low.y), level);
    let sw = textureLoad(simulated, vec2(c.low.x, c.high.y), level);
    let se = textureLoad(simulated, c.high, level);
    let share = shares(c.t);
    let is_wet = vec4(nw.y, ne.y, sw.y, se.y) > vec4(WET);
    let wet = select(vec4(0.0), share, is_wet);
    let sum = dot(wet, vec4(1.0));
    if sum <= 1e-4 {
        return Simulated(0.0, vec2(0.0), false);
    }
    let levels = vec4(nw.x, ne.x, sw.x, se.x);
    let mean = dot(wet, levels) / sum;
    // A dry cell above the water is a bank, up which it does not climb; one below is ground towards which a front falls.
    let height = dot(share, select(min(levels, vec4(mean)), levels, is_wet));
    let velocity = (wet.x * nw.zw + wet.y * ne.zw + wet.z * sw.zw + wet.w * se.zw) / sum;
    return Simulated(height, velocity, true);
}

// Slope of the simulated level at local `place`, local xz.
fn simulated_slope(place: vec2<f32>) -> vec2<f32> {
    if (surface.flags & types::FLAG_SIMULATED) == 0u {
        return vec2(0.0);
    }
    let level = i32(level_of_detail() + 0.5);
    let c = simulated_cells(place, level);
    var corners = array(c.low, vec2(c.high.x, c.low.y), vec2(c.low.x, c.high.y), c.high);
    var share = shares(c.t);
    var slope = vec2(0.0);
    var sum = 0.0;
    for (var k = 0; k < 4; k++) {
        let wet = select(0.0, share[k], textureLoad(simulated, corners[k], level).y > WET);
        slope += wet * textureLoad(simulated_slopes, corners[k], level).xy;
        sum += wet;
    }
    return slope / max(sum, 1e-4) * simulated_share(place);
}

// Depth at local `rest` without waves, m: negative on dry land, very deep without a bed or where it has no data.
fn still_depth(rest: vec2<f32>) -> f32 {
    return ground_depth(rest) + risen(rest);
}

// How far simulation has raised the surface at local `rest` over the still level, m: under the ground where it is dry.
fn risen(rest: vec2<f32>) -> f32 {
    if (surface.flags & types::FLAG_SIMULATED) == 0u {
        return 0.0;
    }
    return level_or_under_ground(simulated_at(rest), rest);
}

// Whether there is water at local `place`, as far as it is simulated.
fn is_wet(place: vec2<f32>) -> bool {
    return (surface.flags & types::FLAG_SIMULATED) == 0u || simulated_at(place).is_wet;
}

// Current at local `place` in water of `depth`, local xz, m/s: that of the simulation, or that of the flow map.
fn current(place: vec2<f32>, depth: f32) -> vec2<f32> {
    if (surface.flags & types::FLAG_SIMULATED) != 0u {
        return simulated_at(place).velocity;
    }
    return mapped_current(place, depth);
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
