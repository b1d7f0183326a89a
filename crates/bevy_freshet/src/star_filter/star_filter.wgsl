// Stars around what is brighter than a threshold (Kawase 2003).

struct Pass {
    origin: vec2<f32>,  // first pixel of the viewport
    extent: vec2<f32>,  // size of the viewport, pixels
    step: vec2<f32>,    // uv from one tap to the next, against the arm
    decay: f32,         // weight of a tap, relative to the one before it
    gain: f32,          // factor on the sum
    threshold: f32,     // brightness
    limit: f32,         // brightness
}

@group(0) @binding(0) var input: texture_2d<f32>;
@group(0) @binding(1) var input_sampler: sampler;
@group(0) @binding(2) var<uniform> settings: Pass;

// What is brighter than the threshold, in the colour that it has.
fn excess(color: vec3<f32>) -> vec3<f32> {
    let brightness = max(color.r, max(color.g, color.b));
    // Not a number fails every comparison.
    if !(brightness > settings.threshold) {
        return vec3(0.0);
    }
    let counted = min(brightness, settings.limit) - settings.threshold;
    return max(color, vec3(0.0)) * (counted / brightness);
}

// A texel of half resolution is the mean of four pixels, each measured against the threshold by itself; pixels beyond the
// viewport are black.
@fragment
fn bright(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let corner = 2.0 * floor(position.xy);
    var sum = vec3(0.0);
    for (var i = 0; i < 4; i++) {
        let pixel = corner + vec2(f32(i & 1), f32(i >> 1));
        if all(pixel < settings.extent) {
            sum += excess(textureLoad(input, vec2<i32>(settings.origin + pixel), 0).rgb);
        }
    }
    return vec4(0.25 * sum, 1.0);
}

// Four taps against the direction of an arm: Σ decayˢ in(x − s step).
@fragment
fn streak(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let uv = position.xy / vec2<f32>(textureDimensions(input));
    var sum = vec3(0.0);
    var weight = settings.gain;
    for (var s = 0; s < 4; s++) {
        let tap = uv - settings.step * f32(s);
        // Nothing comes in from beyond the picture.
        if all(tap >= vec2(0.0)) && all(tap <= vec2(1.0)) {
            sum += weight * textureSampleLevel(input, input_sampler, tap, 0.0).rgb;
        }
        weight *= settings.decay;
    }
    return vec4(sum, 1.0);
}

@fragment
fn composite(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let place = 0.5 * (position.xy - settings.origin);
    let uv = place / vec2<f32>(textureDimensions(input));
    return vec4(settings.gain * textureSampleLevel(input, input_sampler, uv, 0.0).rgb, 1.0);
}
