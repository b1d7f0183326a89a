// How foam looks: a lace where it is thin, closed where it is dense, drawn out along the current.
#define_import_path freshet::surface::foam

#import freshet::surface::bindings::{surface, foam, detail_sampler}
#import freshet::surface::flow::{Drift, Footprint}
#import freshet::surface::types

// Time over which the current draws foam out to streaks, s.
const STREAK: f32 = 0.22;
// Deviation of the variate over which foam turns from none to closed at a wall of bubbles.
const SOFTNESS: f32 = 0.35;

// Share of the variance of patches that foam gathers to. They are larger than bubbles and turned, and so hide that the tile
// repeats. The same matrix is in `write.rs`.
const PATCHES: f32 = 0.4;
const PATCH: mat2x2<f32> = mat2x2<f32>(vec2(0.1171, 0.0603), vec2(-0.0603, 0.1171));

fn texel(at: vec2<f32>, footprint: Footprint) -> vec4<f32> {
    return textureSampleGrad(foam, detail_sampler, at, footprint.x, footprint.y);
}

// The variate of the foam tile and what a pixel hides of its variance, at `place` (local xz, m) and drawn out along
// `streak` (m).
fn froth(place: vec2<f32>, streak: vec2<f32>, footprint: Footprint) -> vec2<f32> {
    let scale = surface.foam_scale;
    let within = Footprint(footprint.x * scale, footprint.y * scale);
    let middle = place * scale - surface.foam_drift.xy;
    var mean = 0.0;
    var hidden = 0.0;
    for (var i = 0; i < 4; i++) {
        let bubbles = texel(middle + streak * (scale * (f32(i) - 1.5)), within).xy;
        mean += 0.25 * bubbles.x;
        hidden += 0.25 * max(bubbles.y - bubbles.x * bubbles.x, 0.0);
    }
    // Four samples that know nothing of each other have half the deviation of one.
    mean *= 1.0 + smoothstep(0.0, 0.08, length(streak) * scale);
    let patches = texel(PATCH * place * scale - surface.foam_drift.zw, Footprint(PATCH * within.x, PATCH * within.y)).zw;
    hidden = mix(hidden, max(patches.y - patches.x * patches.x, 0.0), PATCHES);
    return vec2(sqrt(1.0 - PATCHES) * mean + sqrt(PATCHES) * patches.x, hidden);
}

// Φ of the normal distribution (Page 1977).
fn normal_share(x: f32) -> f32 {
    return 0.5 + 0.5 * tanh(0.7978846 * clamp(x, -6.0, 6.0) * (1.0 + 0.044715 * x * x));
}

// Φ⁻¹ (Shore 1982): the share of its value is off by 0.003 at most.
fn normal_quantile(share: f32) -> f32 {
    let p = max(share, 1.0 - share);
    let x = 5.5556 * (1.0 - pow((1.0 - p) / p, 0.1186));
    return select(-x, x, share >= 0.5);
}

// Share of a pixel that foam of mean cover `density` hides.
fn cover(drift: Drift, density: f32, footprint: Footprint) -> f32 {
    let share = clamp(density, 0.0, 0.999);
    if share * surface.foam_amount < 0.004 {
        return 0.0;
    }
    let streak = drift.current * (STREAK / 3.0);
    var variate = froth(drift.first, streak, footprint);
    if (surface.flags & types::FLAG_FLOW) != 0u {
        let second = froth(drift.second, streak, footprint);
        let weight = drift.weight;
        variate = vec2(dot(vec2(variate.x, second.x), weight), dot(vec2(variate.y, second.y), weight * weight));
    }
    // What is hidden or soft spreads the variate: a wider threshold, shifted so that the mean cover stays.
    let spread = variate.y + SOFTNESS * SOFTNESS;
    let threshold = -normal_quantile(share) * sqrt(1.0 + SOFTNESS * SOFTNESS);
    return surface.foam_amount * normal_share((variate.x - threshold) * inverseSqrt(spread));
}

// Light that foam scatters, for irradiance E = π `lit` falling on it.
fn color(lit: vec3<f32>) -> vec3<f32> {
    return surface.foam_albedo * lit;
}
