// The terrain in the sun, or its wet cells in the colours of the legend.
#import bevy_pbr::forward_io::{VertexOutput, FragmentOutput}
#import bevy_pbr::pbr_fragment::pbr_input_from_standard_material
#import bevy_pbr::pbr_functions::{apply_pbr_lighting, main_pass_post_lighting_processing}

struct Scale {
    coloring: u32,
    low: f32,               // value of the first colour
    high: f32,              // value of the last colour
    exaggeration: f32,      // factor on the depths of the picture
    hazards: vec4<f32>,     // ratings from which on a class of danger begins
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> scale: Scale;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var water: texture_2d<f32>;    // level, depth (m) and velocity (m/s) of every cell
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var dry: texture_2d<f32>;      // colour of every cell without water
@group(#{MATERIAL_BIND_GROUP}) @binding(103) var arrival: texture_2d<f32>;  // time of the first water, units: min; NEVER without
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var ramp: texture_2d<f32>;     // colours from the first to the last

const SUN: u32 = 0u;
const DEPTH: u32 = 1u;
const SPEED: u32 = 2u;
const ARRIVAL: u32 = 3u;
const HAZARD: u32 = 4u;
const NEVER: f32 = 1e38;
// Depth from which on the picture has a velocity, units: m.
const WET: f32 = 1e-3;

fn color_at(share: f32) -> vec3<f32> {
    let last = f32(textureDimensions(ramp).x - 1u);
    return textureLoad(ramp, vec2(i32(clamp(share, 0.0, 1.0) * last + 0.5), 0), 0).xyz;
}

// Share of the way from the lightest to the darkest: the class of `hazard_rating` in `freshet_flood::maxima`.
fn danger(depth: f32, speed: f32) -> f32 {
    let debris = select(1.0, 0.5, depth <= 0.25 && speed <= 2.0);
    let rating = depth * (speed + 0.5) + debris;
    let classes = select(vec4(0.0), vec4(1.0), scale.hazards <= vec4(rating));
    return max(dot(classes, vec4(1.0)) - 1.0, 0.0) / 3.0;
}

fn painted(cell: vec2<i32>) -> vec3<f32> {
    let here = textureLoad(water, cell, 0);
    let first = textureLoad(arrival, cell, 0).x;
    if here.y <= WET || (scale.coloring == ARRIVAL && first >= NEVER) {
        return textureLoad(dry, cell, 0).xyz;
    }
    let depth = here.y / scale.exaggeration;
    let speed = length(here.zw);
    if scale.coloring == HAZARD {
        return color_at(1.0 - danger(depth, speed));
    }
    var value = depth;
    if scale.coloring == SPEED {
        value = speed;
    } else if scale.coloring == ARRIVAL {
        value = first;
    }
    return color_at((value - scale.low) / (scale.high - scale.low));
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var out: FragmentOutput;
    if scale.coloring != SUN {
        let size = vec2<i32>(textureDimensions(water));
        let cell = clamp(vec2<i32>(floor(in.uv * vec2<f32>(size))), vec2(0), size - 1);
        out.color = vec4(painted(cell), 1.0);
        return out;
    }
    var pbr = pbr_input_from_standard_material(in, is_front);
    out.color = main_pass_post_lighting_processing(pbr, apply_pbr_lighting(pbr));
    return out;
}
