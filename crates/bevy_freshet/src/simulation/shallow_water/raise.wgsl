// Stage: bodies raise the bed of the cells that they are in by what they displace, before the steps of a frame; cells that they have
// left fall back to the ground. The twin is `displaced.rs` in `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::Raised

@group(0) @binding(0) var<storage, read_write> bed: array<f32>;     // units: m
@group(0) @binding(1) var<storage, read> raised: array<Raised>;     // each cell at most once

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&raised) {
        bed[raised[id.x].cell] = raised[id.x].bed;
    }
}
