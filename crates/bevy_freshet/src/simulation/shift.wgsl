// Stage: follows the window. What is in a cell stays at its place on the water; cells that are met for the first time are
// without rings and dye, and have the foam that balances their births. Runs when the window moved.
#import freshet::simulation::numbers::{numbers, inside, index}

@group(0) @binding(1) var<storage, read> stream: array<vec4<f32>>;              // velocity (m/s), depth (m), births (1/s)
@group(0) @binding(2) var<storage, read> waves: array<vec2<f32>>;               // η (m), v (m/s)
@group(0) @binding(3) var<storage, read_write> waves_out: array<vec2<f32>>;
@group(0) @binding(4) var<storage, read> matter: array<vec4<f32>>;              // foam, dye
@group(0) @binding(5) var<storage, read_write> matter_out: array<vec4<f32>>;

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if !inside(at) {
        return;
    }
    let to = index(at);
    let before = at + numbers.shift;
    if inside(before) {
        waves_out[to] = waves[index(before)];
        matter_out[to] = matter[index(before)];
    } else {
        let fed = stream[to].w * numbers.foam_life;
        waves_out[to] = vec2(0.0);
        matter_out[to] = vec4(fed / (1.0 + fed), 0.0, 0.0, 0.0);
    }
}
