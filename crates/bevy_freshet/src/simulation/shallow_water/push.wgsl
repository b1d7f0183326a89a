// Stage: bodies push the water of the cells that they cover, after the step. The twin is `push.rs` in
// `freshet_hydro::shallow_water`.
#import freshet::simulation::shallow_water::bindings::{Clock, Push}
#import freshet::simulation::shallow_water::scheme::{GRAVITY, FILM, DEEPEST, FASTEST, sane, per_depth}

@group(0) @binding(0) var<uniform> parity: vec4<u32>;
@group(0) @binding(1) var<storage, read_write> clock: Clock;
@group(0) @binding(2) var<storage, read_write> state: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> pushes: array<Push>;       // each cell at most once

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let dt = clock.dt;
    if id.x >= arrayLength(&pushes) || dt <= 0.0 {
        return;
    }
    let body = pushes[id.x];
    let before = state[body.cell];
    let depth = max(sane(before.x, DEEPEST), 0.0);
    if depth < FILM {
        return;
    }
    let factor = per_depth(depth);
    let difference = vec2(sane(before.y * factor, FASTEST), sane(before.z * factor, FASTEST)) - body.velocity;
    // What is left of it after a quadratic drag, fully implicit.
    let rate = body.strength * factor * dt;
    let size = sqrt(difference.x * difference.x + difference.y * difference.y);
    let kept = 2.0 / (1.0 + sqrt(1.0 + 4.0 * rate * size));
    let pushed = body.velocity + difference * kept + body.force * (factor * dt);
    let velocity = vec2(sane(pushed.x, FASTEST), sane(pushed.y, FASTEST));
    state[body.cell] = vec4(before.x, depth * velocity, before.w);
    let signal = max(abs(velocity.x), abs(velocity.y)) + sqrt(GRAVITY * depth);
    atomicMax(&clock.fastest[1u - parity.x], bitcast<u32>(signal));
}
