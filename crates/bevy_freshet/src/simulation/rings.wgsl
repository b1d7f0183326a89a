// Stage: the rings spread for one step. The twin is `Rings::spread` in `freshet_hydro`.
#import freshet::simulation::numbers::{numbers, inside, index}

@group(0) @binding(1) var<storage, read> celerity: array<f32>;                  // c², m²/s²; 0 where it is dry
@group(0) @binding(2) var<storage, read> waves: array<vec2<f32>>;               // η (m), v (m/s)
@group(0) @binding(3) var<storage, read_write> waves_out: array<vec2<f32>>;

// c² ∇η through the face towards `to`, times the distance of the cells; nothing through the face of a dry cell.
fn flux(to: vec2<i32>, own: f32, height: f32) -> f32 {
    if !inside(to) {
        return 0.0;
    }
    let other = celerity[index(to)];
    return select(0.0, 0.5 * (own + other) * (waves[index(to)].x - height), other > 0.0);
}

// Share of η and v that is left after a step: less towards absorbing rims.
fn kept(at: vec2<i32>, own: f32) -> f32 {
    let near = vec2<f32>(at) + 0.5;
    let far = vec2<f32>(numbers.size) - near;
    let ways = mix(vec4(numbers.rim_width), vec4(near.x, far.x, near.y, far.y), numbers.absorbs);
    let way = min(min(ways.x, ways.y), min(ways.z, ways.w));
    let into = max(1.0 - way / numbers.rim_width, 0.0);
    return exp(-numbers.ring_step * (numbers.ring_decay + numbers.rim_decay * sqrt(own) * into * into));
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if !inside(at) {
        return;
    }
    let i = index(at);
    let own = celerity[i];
    if own <= 0.0 {
        waves_out[i] = vec2(0.0);
        return;
    }
    let height = waves[i].x;
    let sum = flux(at - vec2(1, 0), own, height) + flux(at + vec2(1, 0), own, height)
        + flux(at - vec2(0, 1), own, height) + flux(at + vec2(0, 1), own, height);
    let rate = waves[i].y + numbers.ring_step * sum / (numbers.cell * numbers.cell);
    waves_out[i] = vec2(height + numbers.ring_step * rate, rate) * kept(at, own);
}
