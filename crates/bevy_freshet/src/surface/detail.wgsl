// Fine ripples that run with the current: two layers of one slope tile.
#define_import_path freshet::surface::detail

#import freshet::surface::bindings::{surface, detail, detail_sampler}
#import freshet::surface::flow::{Drift, Footprint}
#import freshet::surface::types
#import freshet::surface::waves::Slope

// The second layer is turned and shrunk, so that the two never line up.
const SECOND: mat2x2<f32> = mat2x2<f32>(vec2(1.7321, 1.0), vec2(-1.0, 1.7321));

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

// Slope of the ripples where the current has carried them.
fn slope(drift: Drift, footprint: Footprint) -> Slope {
    if surface.detail_slope <= 0.0 {
        return Slope(vec2(0.0), 0.0);
    }
    var ripples = layers(drift.first, footprint);
    if (surface.flags & (types::FLAG_FLOW | types::FLAG_SIMULATED)) != 0u {
        let second = layers(drift.second, footprint);
        let weight = drift.weight;
        let mean_square = dot(vec2(ripples.z, second.z), weight * weight);
        ripples = vec3(ripples.xy * weight.x + second.xy * weight.y, mean_square);
    }
    let factor = surface.detail_slope;
    let hidden = max(ripples.z - dot(ripples.xy, ripples.xy), 0.0);
    return Slope(ripples.xy * factor, hidden * factor * factor);
}
