// Gerstner waves; the Rust twin is `freshet_hydro::waves`.
//
//   x = x₀ − Σ f k̂ A sin θ     y = Σ f A cos θ     θ = k·x₀ + phase
#define_import_path freshet::surface::waves

#import freshet::surface::bindings::surface

// Share of the waves' height that is left where the still water is `depth` metres deep.
fn shallow_fade(depth: f32) -> f32 {
    if surface.fade_depth <= 0.0 {
        return 1.0;
    }
    let t = clamp(depth / surface.fade_depth, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Share of a wave train that samples `spacing` metres apart can carry: all above four samples a wave, none below two.
fn resolved(wavenumber: f32, spacing: f32) -> f32 {
    let samples = 6.2831853 / max(wavenumber * spacing, 1e-6);
    return smoothstep(2.0, 4.0, samples);
}

// Displacement of the particle that rests at local `rest`, m, on a mesh of `spacing` (m).
fn displacement(rest: vec2<f32>, fade: f32, spacing: f32) -> vec3<f32> {
    var sum = vec3(0.0);
    for (var i = 0u; i < surface.wave_count; i++) {
        let wave = surface.waves[i];
        let wavenumber = length(wave.xy);
        let amplitude = wave.z * resolved(wavenumber, spacing);
        if amplitude <= 0.0 {
            continue;
        }
        let theta = dot(wave.xy, rest) + wave.w;
        let horizontal = wave.xy / wavenumber * (-amplitude * sin(theta));
        sum += vec3(horizontal.x, amplitude * cos(theta), horizontal.y);
    }
    return sum * fade;
}

struct Slope {
    slope: vec2<f32>,    // ∂height/∂xz, local
    variance: f32,       // mean square of the slope that `spacing` hides
}

// Slope of the surface at the particle that rests at local `rest`, seen with samples `spacing` metres apart.
//
// s = Σ f k A sin θ, J = 1 − Σ f k̂k̂ᵀ k A cos θ, slope = −J⁻¹ s.
fn slope(rest: vec2<f32>, fade: f32, spacing: f32) -> Slope {
    var s = vec2(0.0);
    var j = vec3(1.0, 0.0, 1.0); // xx, xz, zz
    var variance = 0.0;
    for (var i = 0u; i < surface.wave_count; i++) {
        let wave = surface.waves[i];
        let k = wave.xy;
        let wavenumber = length(k);
        let share = resolved(wavenumber, spacing);
        let amplitude = fade * wave.z;
        let steepness = amplitude * wavenumber;
        variance += 0.5 * steepness * steepness * (1.0 - share * share);
        if share <= 0.0 {
            continue;
        }
        let theta = dot(k, rest) + wave.w;
        s -= k * (amplitude * share * sin(theta));
        j -= vec3(k.x * k.x, k.x * k.y, k.y * k.y) * (amplitude * share * cos(theta) / wavenumber);
    }
    // The determinant stays above zero while the steepnesses sum to less than one.
    let determinant = max(j.x * j.z - j.y * j.y, 0.05);
    return Slope(vec2(j.z * s.x - j.y * s.y, j.x * s.y - j.y * s.x) / determinant, variance);
}
