// The ground: mud, sand and grass by height over the water and by slope, wet near the waterline.
#import bevy_pbr::{
    forward_io::{FragmentOutput, VertexOutput},
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{apply_pbr_lighting, main_pass_post_lighting_processing},
}

struct Bed {
    level: f32,  // world height of the water, units: m
    tile: f32,   // size of a tile, units: m
    relief: f32, // height of the textures' relief, units: m
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> bed: Bed;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var mud: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var layer_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(103) var sand: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var grass: texture_2d<f32>;

// Hash of a lattice point to 0…1 (integer finaliser in the manner of Wang 2007).
fn hash(p: vec2<f32>) -> f32 {
    let i = vec2<u32>(vec2<i32>(p));
    var h = i.x * 0x8da6b343u ^ i.y * 0xd8163841u;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    return f32((h ^ (h >> 15u)) >> 8u) / 16777216.0;
}

// Smooth value noise, 0…1, of feature size 1.
fn noise(p: vec2<f32>) -> f32 {
    let i = floor(p);
    let f = p - i;
    let t = f * f * (3.0 - 2.0 * f);
    let north = mix(hash(i), hash(i + vec2(1.0, 0.0)), t.x);
    let south = mix(hash(i + vec2(0.0, 1.0)), hash(i + vec2(1.0, 1.0)), t.x);
    return mix(north, south, t.y);
}

// Where a fragment lies in the tiles, with what it takes to sample them anywhere in the shader.
struct Place {
    uv: vec2<f32>,
    dx: vec2<f32>,
    dy: vec2<f32>,
    variant: f32, // slow noise that picks one of the shifted copies
}

// A tile without visible repetition: noise chooses between shifted copies of it, and neighbours blend.
fn untiled(layer: texture_2d<f32>, place: Place) -> vec4<f32> {
    let copy = floor(place.variant);
    let shift_a = sin(vec2(3.0, 7.0) * copy);
    let shift_b = sin(vec2(3.0, 7.0) * (copy + 1.0));
    let a = textureSampleGrad(layer, layer_sampler, place.uv + shift_a, place.dx, place.dy);
    let b = textureSampleGrad(layer, layer_sampler, place.uv + shift_b, place.dx, place.dy);
    // The higher relief stays on top.
    return mix(a, b, smoothstep(0.25, 0.75, place.variant - copy + 0.4 * (b.a - a.a)));
}

struct Ground {
    color: vec3<f32>,
    height: f32, // of the relief, units: m
    wet: f32,
}

fn ground(position: vec3<f32>, up: f32, place: Place) -> Ground {
    let patchy = noise(position.xz * 0.11) * 0.6 + noise(position.xz * 0.43) * 0.4;
    let height = position.y - bed.level + (patchy - 0.5) * 0.3;
    let steep = 1.0 - smoothstep(0.80, 0.93, up);
    var weights = vec3(
        1.0 - smoothstep(-1.5, -0.4, height),
        0.55,
        smoothstep(0.15, 0.40, height) * (1.0 - steep) * 2.0,
    );
    // Patches of mud on the shore and of sand in the deep: the bed is readable, and no band is even.
    let patches = smoothstep(0.3, 0.85, noise(position.xz * 0.07 + 9.0) * 0.7 + patchy * 0.3);
    weights.x += patches * (1.0 - smoothstep(0.0, 0.15, height));
    weights.y += (1.0 - patches) * 0.6 * (1.0 - smoothstep(-0.2, 0.0, height));

    // Only what weighs something is sampled.
    var layers = array<vec4<f32>, 3>(vec4(0.0), vec4(0.0), vec4(0.0));
    if weights.x > 0.0 {
        layers[0] = untiled(mud, place);
    }
    layers[1] = untiled(sand, place);
    if weights.z > 0.0 {
        layers[2] = untiled(grass, place);
    }
    // What stands out of its layer shows first where two meet.
    let heights = weights + vec3(layers[0].a, layers[1].a, layers[2].a) * 0.5;
    let top = max(heights.x, max(heights.y, heights.z)) - 0.25;
    var share = max(heights - top, vec3(0.0)) * step(vec3(1e-4), weights);
    share /= share.x + share.y + share.z;
    let blended = layers[0] * share.x + layers[1] * share.y + layers[2] * share.z;

    // Slow changes of tone over many metres hide what repetition is left.
    let tone = 0.82 + 0.36 * (noise(position.xz * 0.031) * 0.6 + noise(position.xz * 0.17 + 31.0) * 0.4);
    let wet = 1.0 - smoothstep(0.02, 0.22, position.y - bed.level + (patchy - 0.5) * 0.08);
    return Ground(blended.rgb * tone, blended.a * bed.relief, wet);
}

// Normal of a surface raised by `height` (Mikkelsen 2010, eq. 5).
fn raised(normal: vec3<f32>, position: vec3<f32>, height: f32) -> vec3<f32> {
    let across = dpdx(position);
    let down = dpdy(position);
    let r1 = cross(down, normal);
    let r2 = cross(normal, across);
    let determinant = dot(across, r1);
    let gradient = sign(determinant) * (dpdx(height) * r1 + dpdy(height) * r2);
    return normalize(abs(determinant) * normal - gradient);
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var pbr = pbr_input_from_standard_material(in, is_front);
    let uv = in.world_position.xz / bed.tile;
    let place = Place(uv, dpdx(uv), dpdy(uv), noise(uv * 0.55) * 8.0);
    let here = ground(in.world_position.xyz, pbr.world_normal.y, place);
    let dimmed = here.color * mix(1.0, 0.55, here.wet);
    pbr.material.base_color = vec4(dimmed, 1.0);
    pbr.material.perceptual_roughness = mix(0.95, 0.5, here.wet);
    // Under water the ground refracts hardly more than what is around it, and does not glint.
    pbr.material.reflectance *= smoothstep(-0.03, 0.0, in.world_position.y - bed.level);
    pbr.N = raised(pbr.N, in.world_position.xyz, here.height);

    var out: FragmentOutput;
    out.color = apply_pbr_lighting(pbr);
    out.color = main_pass_post_lighting_processing(pbr, out.color);
    return out;
}
