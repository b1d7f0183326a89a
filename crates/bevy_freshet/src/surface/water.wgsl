// The water at a place without waves: still or simulated, as `freshet_hydro::shallow_water::Field` is sampled.
#define_import_path freshet::surface::water

#import freshet::surface::bindings::{surface, simulated, simulated_slopes}
#import freshet::surface::ground::{Cells, ground_depth, mapped_current, simulated_share}
#import freshet::surface::types

struct Water {
    depth: f32,             // negative on dry land; very deep without a bed or where it has no data, units: m
    risen: f32,             // of the surface over the still level: under the ground where it is dry, units: m
    current: vec2<f32>,     // of simulation or flow map, local xz, units: m/s
    is_wet: bool,           // as far as it is simulated
}

// Depth from which on a cell counts as wet, units: m.
const WET: f32 = 1e-3;
// How far under the ground the surface of a simulated water is put where it is dry, units: m.
const DRY: f32 = 0.5;

// Distance between those places that are looked up, units: m. Where it is more than a cell, coarser levels count.
var<private> spacing: f32 = 0.0;

// The water at local `place`.
fn at(place: vec2<f32>) -> Water {
    let ground = ground_depth(place);
    if (surface.flags & types::FLAG_SIMULATED) == 0u {
        return Water(ground, 0.0, mapped_current(place, ground), true);
    }
    // The simulated water is blended into the one around its area.
    let share = simulated_share(place);
    var water = Water(ground, 0.0, vec2(0.0), true);
    if share > 0.0 {
        water = simulated_at(place, ground);
    }
    if share < 1.0 {
        let risen = share * water.risen;
        water = Water(ground + risen, risen, mix(mapped_current(place, ground), water.current, share), true);
    }
    return water;
}

// The simulated water at local `place` over ground that lies `ground` below the still level, as finely as `spacing` asks for:
// between two levels of the pictures. It goes through all of them, as some renderers take one level for all vertices or pixels
// that they work on together.
fn simulated_at(place: vec2<f32>, ground: f32) -> Water {
    let wanted = level_of_detail();
    var water = Water(0.0, 0.0, vec2(0.0), false);
    for (var level = 0; level < i32(textureNumLevels(simulated)); level++) {
        let share = 1.0 - abs(wanted - f32(level));
        if share > 1e-3 {
            let found = simulated_in(place, ground, level);
            water.risen += share * found.risen;
            water.current += share * found.current;
            water.is_wet = select(water.is_wet, found.is_wet, share >= 0.5);
        }
    }
    water.depth = ground + water.risen;
    return water;
}

// The level of the pictures whose texels are as far apart as the places that are looked up, no coarser than there is.
fn level_of_detail() -> f32 {
    let most = f32(textureNumLevels(simulated) - 1u);
    return clamp(log2(max(spacing, 1e-6) / surface.simulated_cell), 0.0, most);
}

// Shares of the four cells around a place: bilinear.
fn shares(t: vec2<f32>) -> vec4<f32> {
    return vec4((1.0 - t.x) * (1.0 - t.y), t.x * (1.0 - t.y), (1.0 - t.x) * t.y, t.x * t.y);
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

// The same in one level of the pictures.
fn simulated_in(place: vec2<f32>, ground: f32, level: i32) -> Water {
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
        // Towards a bank the surface goes on beneath it, so that it is cut by the ground; elsewhere it lies under the ground.
        let elevation = -clamp(ground, -1e5, 1e5);
        let near = select(share * vec4(nw.w, ne.w, sw.w, se.w), vec4(0.0), is_wet);
        let known = dot(near, vec4(1.0));
        let level = dot(near, vec4(nw.z, ne.z, sw.z, se.z)) / max(known, 1e-4);
        let hidden = select(elevation - DRY, min(level, elevation), known > 1e-4);
        return Water(ground + hidden, hidden, vec2(0.0), false);
    }
    let levels = vec4(nw.x, ne.x, sw.x, se.x);
    let mean = dot(wet, levels) / sum;
    // A dry cell above the water is a bank, up which it does not climb; one below is ground towards which a front falls.
    let risen = dot(share, select(min(levels, vec4(mean)), levels, is_wet));
    let velocity = (wet.x * nw.zw + wet.y * ne.zw + wet.z * sw.zw + wet.w * se.zw) / sum;
    return Water(ground + risen, risen, velocity, true);
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
