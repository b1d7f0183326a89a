// Stage: the current carries the rings along an axis, for one step. The twin is `Rings::carry` in `freshet_hydro`.
#import freshet::simulation::numbers::{numbers, inside, index}

@group(0) @binding(1) var<storage, read> ground: array<vec4<f32>>;              // current (m/s), depth (m), foam born by deformation (1/s)
@group(0) @binding(2) var<storage, read> celerity: array<f32>;                  // m²/s²; 0 where it is dry
@group(0) @binding(3) var<storage, read> waves: array<vec2<f32>>;               // η (m), v (m/s)
@group(0) @binding(4) var<storage, read_write> waves_out: array<vec2<f32>>;

fn wet(at: vec2<i32>) -> bool {
    return inside(at) && celerity[index(at)] > 0.0;
}

struct Tap {
    wave: vec2<f32>,
    wet: bool,
}

// The cell `at`; from the first dry one on, the last wet one is repeated.
fn next(last: Tap, at: vec2<i32>) -> Tap {
    if last.wet && wet(at) {
        return Tap(waves[index(at)], true);
    }
    return Tap(last.wave, false);
}

// Semi-Lagrangian: the quintic Lagrange polynomial through the six cells around the point of departure.
fn carry(at: vec2<i32>, axis: vec2<i32>) {
    if !inside(at) {
        return;
    }
    let i = index(at);
    let here = waves[i];
    let cells = clamp(dot(ground[i].xy, vec2<f32>(axis)) * numbers.ring_step / numbers.cell, -1.0, 1.0);
    if cells == 0.0 || celerity[i] <= 0.0 {
        waves_out[i] = here;
        return;
    }
    let up = select(axis, -axis, cells > 0.0);
    let u1 = next(Tap(here, true), at + up);
    let u2 = next(u1, at + 2 * up);
    let u3 = next(u2, at + 3 * up);
    let d1 = next(Tap(here, true), at - up);
    let d2 = next(d1, at - 2 * up);
    let t = abs(cells);
    let a = t + 2.0;
    let b = t + 1.0;
    let c = t - 1.0;
    let d = t - 2.0;
    let e = t - 3.0;
    waves_out[i] = d2.wave * (b * t * c * d * e / -120.0)
        + d1.wave * (a * t * c * d * e / 24.0)
        + here * (a * b * c * d * e / -12.0)
        + u1.wave * (a * b * t * d * e / 12.0)
        + u2.wave * (a * b * t * c * e / -24.0)
        + u3.wave * (a * b * t * c * d / 120.0);
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn along_x(@builtin(global_invocation_id) id: vec3<u32>) {
    carry(vec2<i32>(id.xy), vec2(1, 0));
}

@compute @workgroup_size(#{GROUP}, #{GROUP})
fn along_z(@builtin(global_invocation_id) id: vec3<u32>) {
    carry(vec2<i32>(id.xy), vec2(0, 1));
}
