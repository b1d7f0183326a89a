// Stage: pictures of the water for the surface's shader. The twin is `Field` in `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::{numbers, state, bed}
#import freshet::simulation::shallow_water::cells::primitive

@group(1) @binding(0) var picture: texture_storage_2d<rgba32float, write>;  // level, depth (m), velocity (m/s)
@group(1) @binding(1) var slopes: texture_storage_2d<rgba16float, write>;   // slope of the level

const WET: f32 = 1e-3; // units: m

// The level of a cell as it counts beside water at `level`: a dry cell above it is a bank, one below it is ground towards which
// a front falls.
fn beside(level: f32, at: vec2<i32>) -> f32 {
    if any(at < vec2(0)) || any(at >= numbers.size) {
        return level;
    }
    let there = primitive(at.y * numbers.size.x + at.x);
    return select(min(there.y, level), there.y, there.x > WET);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if any(at >= numbers.size) {
        return;
    }
    let here = primitive(at.y * numbers.size.x + at.x);
    textureStore(picture, at, vec4(here.y, here.x, here.zw));
    var steep = vec2(0.0);
    if here.x > WET {
        let x = beside(here.y, at + vec2(1, 0)) - beside(here.y, at - vec2(1, 0));
        let z = beside(here.y, at + vec2(0, 1)) - beside(here.y, at - vec2(0, 1));
        steep = vec2(x, z) / (2.0 * numbers.cell);
    }
    textureStore(slopes, at, vec4(steep, 0.0, 0.0));
}
