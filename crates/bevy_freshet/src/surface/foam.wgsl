// How foam looks: a lace where it is thin, closed where it is dense, drawn out along the current.
#define_import_path freshet::surface::foam

#import freshet::surface::bindings::{surface, foam, detail_sampler}
#import freshet::surface::flow::{Drift, Footprint}
#import freshet::surface::types

// Time over which the current draws bubbles out to streaks, and patches to bands, s.
const STREAK: f32 = 0.13;
const BAND: f32 = 4.5;
// Deviation of the variate over which foam turns from none to closed at a wall of bubbles.
const SOFTNESS: f32 = 0.35;

// Share of the variance of patches that foam gathers to. They are larger than bubbles and turned, and so hide that the tile
// repeats. The same matrix is in `write.rs`.
const PATCHES: f32 = 0.4;
const PATCH: mat2x2<f32> = mat2x2<f32>(vec2(0.4684, 0.2412), vec2(-0.2412, 0.4684));

fn texel(at: vec2<f32>, footprint: Footprint) -> vec4<f32> {
    return textureSampleGrad(foam, detail_sampler, at, footprint.x, footprint.y);
}

// Both variates of the tile, each with what a pixel hides of its variance, as means of four samples `step` apart.
fn drawn_out(middle: vec2<f32>, step: vec2<f32>, footprint: Footprint) -> vec4<f32> {
    var sum = vec4(0.0);
    for (var i = 0; i < 4; i++) {
        let here = texel(middle + step * (f32(i) - 1.5), footprint);
        sum += vec4(here.x, max(here.y - here.x * here.x, 0.0), here.z, max(here.w - here.z * here.z, 0.0));
    }
    return 0.25 * sum;
}

// The variate of foam and what a pixel hides of its variance, at `place` (local xz, m) on a `current` (m/s).
fn froth(place: vec2<f32>, current: vec2<f32>, footprint: Footprint) -> vec2<f32> {
    let scale = surface.foam_scale;
    let within = Footprint(footprint.x * scale, footprint.y * scale);
    let streak = current * (scale * STREAK / 3.0);
    var band = PATCH * current * (scale * BAND / 3.0);
    band *= min(1.0, 0.22 / max(length(band), 1e-6));
    let bubbles = drawn_out(place * scale - surface.foam_drift.xy, streak, within).xy;
    let turned = Footprint(PATCH * within.x, PATCH * within.y);
    let patches = drawn_out(PATCH * place * scale - surface.foam_drift.zw, band, turned).zw;
    // The mean of four samples deviates less the less they know of each other: half as much at last, and patches, which are
    // waves, less still. `foam.rs` measures it.
    let bubble = bubbles.x * (1.0 + min(length(streak) / 0.014, 1.0));
    let gathered = patches.x * (1.0 + 1.25 * smoothstep(0.0, 0.16, length(band)));
    return vec2(
        sqrt(1.0 - PATCHES) * bubble + sqrt(PATCHES) * gathered,
        mix(bubbles.y, patches.y, PATCHES),
    );
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
    let current = drift.current + surface.current_drift;
    var variate = froth(drift.first, current, footprint);
    if (surface.flags & (types::FLAG_FLOW | types::FLAG_SIMULATED)) != 0u {
        let second = froth(drift.second, current, footprint);
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
