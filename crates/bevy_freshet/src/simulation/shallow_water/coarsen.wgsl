// Stage: a coarser level of the pictures, for those who look from far away. A texel is wet if half of the four that it stands for
// are, and then it is the mean of the wet ones; else it knows the level of those around it, as in `show.wgsl`.

// Depth from which on a cell counts as wet, as in `freshet::surface::water`, units: m.
const WET: f32 = 1e-3;

@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var finer_slopes: texture_2d<f32>;
@group(0) @binding(2) var coarser: texture_storage_2d<rgba32float, write>;
@group(0) @binding(3) var coarser_slopes: texture_storage_2d<rgba16float, write>;

// The mean level of the wet texels in and around a coarser one, as far as it is known, and 1 if it is.
fn level_around(at: vec2<i32>, last: vec2<i32>) -> vec2<f32> {
    var level = 0.0;
    var count = 0.0;
    for (var k = 0; k < 16; k++) {
        let cell = textureLoad(finer, clamp(2 * at + vec2(k % 4, k / 4) - 1, vec2(0), last), 0);
        if cell.y > WET {
            level += cell.x;
            count += 1.0;
        } else {
            level += cell.z * cell.w;
            count += cell.w;
        }
    }
    return vec2(level / max(count, 1.0), min(count, 1.0));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = vec2<i32>(id.xy);
    if any(at >= vec2<i32>(textureDimensions(coarser))) {
        return;
    }
    let last = vec2<i32>(textureDimensions(finer)) - 1;
    var wet = vec4(0.0);
    var dry = vec4(0.0);
    var slope = vec2(0.0);
    var count = 0.0;
    for (var k = 0; k < 4; k++) {
        let child = min(2 * at + vec2(k & 1, k >> 1), last);
        let cell = textureLoad(finer, child, 0);
        if cell.y > WET {
            wet += cell;
            slope += textureLoad(finer_slopes, child, 0).xy;
            count += 1.0;
        } else {
            dry += cell;
        }
    }
    if count >= 2.0 {
        textureStore(coarser, at, wet / count);
        textureStore(coarser_slopes, at, vec4(slope / count, 0.0, 0.0));
    } else {
        textureStore(coarser, at, vec4(dry.x / (4.0 - count), 0.0, level_around(at, last)));
        textureStore(coarser_slopes, at, vec4(0.0));
    }
}
