// Patterns that the current carries, in two phases half a cycle apart.
#define_import_path freshet::surface::flow

#import freshet::surface::bindings::surface
#import freshet::surface::types

// The footprint of a pixel in local xz, taken where control flow is uniform.
struct Footprint {
    x: vec2<f32>,
    y: vec2<f32>,
}

// Where a pattern is to be looked up. Each phase is carried for one cycle and has no weight where it jumps back.
struct Drift {
    first: vec2<f32>,    // local xz, units: m
    second: vec2<f32>,
    weight: vec2<f32>,   // the squares sum to one: the variance of two independent patterns stays
    current: vec2<f32>,  // of map or simulation, local xz, units: m/s
}

// Patterns at local `place` in this current, local xz, m/s.
fn drift(place: vec2<f32>, current: vec2<f32>) -> Drift {
    if (surface.flags & (types::FLAG_FLOW | types::FLAG_SIMULATED)) == 0u {
        return Drift(place, place, vec2(1.0, 0.0), vec2(0.0));
    }
    // The phase differs from place to place, so that the fades do not pulse in step.
    let offset = 0.25 * (sin(place.x * 0.213 + place.y * 0.079) + sin(place.y * 0.187 - place.x * 0.061));
    let phase = fract(vec2(surface.flow_phase + offset) + vec2(0.0, 0.5));
    let way = current * surface.flow_cycle;
    // The second phase shows another part of the pattern.
    return Drift(place - way * phase.x, place - way * phase.y + vec2(3.7, 1.9), sin(phase * 3.14159265), current);
}
