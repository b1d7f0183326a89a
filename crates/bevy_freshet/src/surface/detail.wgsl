// Fine ripples that run with the current: two layers of one slope tile.
#define_import_path freshet::surface::detail

#import freshet::surface::bindings::{surface, detail, detail_sampler}
#import freshet::surface::ground
#import freshet::surface::types
#import freshet::surface::waves::Slope

// The second layer is turned and shrunk, so that the two never line up.
const SECOND: mat2x2<f32> = mat2x2<f32>(vec2(1.7321, 1.0), vec2(-1.0, 1.7321));

// The footprint of a pixel in local xz, taken where control flow is uniform.
struct Footprint {
    x: vec2<f32>,
    y: vec2<f32>,
}

// Slopes in xy and their mean square in z.
fn tile(place: vec2<f32>, drift: vec2<f32>, footprint: Footprint) -> vec3<f32> {
    let scale = surface.detail_scale;
    return textureSampleGrad(detail, detail_sampler, place * scale - drift, footprint.x * scale, footprint.y * scale).xyz;
}

fn layers(place: vec2<f32>, footprint: Footprint) -> vec3<f32> {
    let first = tile(place, surface.detail_drift.xy, footprint);
    let turned = Footprint(SECOND * footprint.x, SECOND * footprint.y);
    let second = tile(SECOND * place, surface.detail_drift.zw, turned);
    // A slope turns back with the transpose; the layers are independent, so their mean squares add.
    let back = transpose(SECOND) * second.xy * 0.5;
    return vec3((first.xy + back) * 0.7071, (first.z + second.z) * 0.5);
}

// Two phases half a cycle apart, each carried by the current for one cycle and faded out where it jumps back.
fn flowing(place: vec2<f32>, depth: f32, footprint: Footprint) -> vec3<f32> {
    let current = ground::mapped_current(place) * smoothstep(0.0, surface.bank_depth, depth);
    // The phase differs from place to place, so that the fades do not pulse in step.
    let offset = 0.25 * (sin(place.x * 0.213 + place.y * 0.079) + sin(place.y * 0.187 - place.x * 0.061));
    let phase = fract(vec2(surface.flow_phase + offset) + vec2(0.0, 0.5));
    let a = layers(place - current * (phase.x * surface.flow_cycle), footprint);
    let b = layers(place - current * (phase.y * surface.flow_cycle) + vec2(3.7, 1.9), footprint);
    // Weights whose squares sum to one keep the variance of two independent patterns.
    let weight = sin(phase * 3.14159265);
    return vec3(a.xy * weight.x + b.xy * weight.y, a.z * weight.x * weight.x + b.z * weight.y * weight.y);
}

// Slope of the ripples at local `place` in water of `depth` metres.
fn slope(place: vec2<f32>, depth: f32, footprint: Footprint) -> Slope {
    if surface.detail_slope <= 0.0 {
        return Slope(vec2(0.0), 0.0);
    }
    var ripples: vec3<f32>;
    if (surface.flags & types::FLAG_FLOW) != 0u {
        ripples = flowing(place, depth, footprint);
    } else {
        ripples = layers(place, footprint);
    }
    let factor = surface.detail_slope;
    let hidden = max(ripples.z - dot(ripples.xy, ripples.xy), 0.0);
    return Slope(ripples.xy * factor, hidden * factor * factor);
}
