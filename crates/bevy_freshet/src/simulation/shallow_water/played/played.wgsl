// A flood between two steps. The twins are `depth_between` and `Moment` in `freshet_flood`.
#define_import_path freshet::simulation::shallow_water::played

struct Numbers {
    size: vec2<i32>,    // columns and rows
    cell: f32,          // units: m
    share: f32,         // of the way from the first step to the second
    threshold: f32,     // depth from which on a cell is wet, units: m
    factor: f32,        // on elevations and depths
}

@group(0) @binding(0) var<uniform> numbers: Numbers;
@group(0) @binding(1) var ground: texture_2d<f32>;  // elevation, units: m
@group(0) @binding(2) var before: texture_2d<u32>;  // depth (m) as bits and two halves of velocity (m/s) at the first step
@group(0) @binding(3) var after: texture_2d<u32>;   // and at the second
@group(0) @binding(4) var turns: texture_2d<f32>;   // when a cell turns dry or wet, as a share of the way

// The depth at a share of the way from `first` to `second`; see `freshet_flood::interpolation`.
fn depth_between(first: f32, second: f32, turn: f32) -> f32 {
    let share = numbers.share;
    let threshold = numbers.threshold;
    if share <= 0.0 {
        return first;
    }
    if share >= 1.0 {
        return second;
    }
    if first < threshold && second >= threshold {
        let part = clamp((share - turn) / max(1.0 - turn, 1e-37), 0.0, 1.0);
        return select(threshold + (second - threshold) * sqrt(part), first, share < turn);
    }
    if first >= threshold && second < threshold {
        let part = clamp((turn - share) / max(turn, 1e-37), 0.0, 1.0);
        return select(threshold + (first - threshold) * sqrt(part), second, share > turn);
    }
    return first + (second - first) * share;
}

// Depth, level and velocity of the cell `at`.
fn primitive(at: vec2<i32>) -> vec4<f32> {
    let first = textureLoad(before, at, 0).xy;
    let second = textureLoad(after, at, 0).xy;
    let depths = bitcast<vec2<f32>>(vec2(first.x, second.x));
    let bed = textureLoad(ground, at, 0).x;
    let depth = depth_between(depths.x, depths.y, textureLoad(turns, at, 0).x);
    if depth < numbers.threshold {
        return vec4(0.0, numbers.factor * bed, 0.0, 0.0);
    }
    let speeds = vec4(unpack2x16float(first.y), unpack2x16float(second.y));
    let is_wet = depths >= vec2(numbers.threshold);
    var velocity = mix(speeds.xy, speeds.zw, numbers.share);
    if !all(is_wet) {
        velocity = select(speeds.zw, speeds.xy, is_wet.x);
    }
    return vec4(numbers.factor * depth, numbers.factor * (bed + depth), velocity);
}
