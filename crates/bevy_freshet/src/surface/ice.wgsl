// How ice looks: snow over clear ice over water.
#define_import_path freshet::surface::ice

#import freshet::surface::bindings::{surface, ice_tile, detail_sampler}
#import freshet::surface::flow::Footprint
#import freshet::surface::frozen::Felt
#import freshet::surface::ice_growth as growth
#import freshet::surface::light::Light
#import freshet::surface::mirror
#import freshet::surface::optics
#import freshet::surface::scene
#import freshet::surface::types

// Refractive index of ice (Warren and Brandt 2008, 550 nm).
const INDEX: f32 = 1.311;
// Slope that a full byte of the tile stands for, heights per tile.
const STEEPEST: f32 = 48.0;
// Height of the snow's relief, patterns: a drift of a hand's breadth on a pattern of 9 m.
const RELIEF: f32 = 0.017;
// The coarse copy of the pattern is turned by some angle and larger by no simple number, so that the two never line up.
const COARSE: mat2x2<f32> = mat2x2<f32>(vec2(0.2165, 0.1563), vec2(-0.1563, 0.2165));
// How far the pattern pushes the front of the ice to and fro, in order of freezing.
const RAGGED: f32 = 0.16;

// How far the surface has sunk under ice of `thickness`, m.
fn drop(thickness: f32) -> f32 {
    return surface.ice_level_drop * thickness;
}

// Ice with its pattern, as drawn.
struct Sheet {
    thickness: f32,      // units: m
    cover: f32,
    snow: f32,           // cover of snow
    frost: f32,          // crystals on the bare ice
    slope: vec2<f32>,    // of the relief, world
    cracks: f32,
    uv: vec2<f32>,
}

struct Pattern {
    slope: vec2<f32>,    // heights per metre, local
    height: f32,         // 0…1
    cracks: f32,
}

fn tile(uv: vec2<f32>, footprint: Footprint, turn: mat2x2<f32>) -> Pattern {
    let to_uv = turn * surface.ice_scale;
    let texel = textureSampleGrad(ice_tile, detail_sampler, to_uv * uv, to_uv * footprint.x, to_uv * footprint.y);
    // A slope turns back with the transpose.
    let slope = transpose(to_uv) * ((texel.xy * 2.0 - 1.0) * STEEPEST);
    return Pattern(slope, texel.w, texel.z);
}

// The drawn ice at local `place`; its pattern lies still, whatever flows below.
fn sheet(place: vec2<f32>, felt: Felt, footprint: Footprint) -> Sheet {
    var sheet = Sheet(0.0, 0.0, 0.0, 0.0, vec2(0.0), 0.0, place);
    if (surface.flags & types::FLAG_ICE) == 0u {
        return sheet;
    }
    // No pattern brings ice to where the order is this much later than the winter.
    if growth::LAST * (felt.order - RAGGED) > surface.ice_freezing {
        return sheet;
    }
    let fine = tile(place, footprint, mat2x2<f32>(vec2(1.0, 0.0), vec2(0.0, 1.0)));
    let coarse = tile(place, footprint, COARSE);
    // Vanishes for the first and the last place, so that winter still begins and ends with open water and solid ice.
    let ragged = RAGGED * 4.0 * felt.order * (1.0 - felt.order) * (0.6 * coarse.height + 0.4 * fine.height - 0.5);
    sheet.thickness = growth::thickness(felt.order + ragged, surface.ice_freezing, surface.ice_thickest);
    sheet.cover = growth::cover(sheet.thickness);
    let settled = growth::settled(sheet.thickness) * surface.ice_snow;
    // Drifts: what stands above a level that sinks as snow settles, once sharp and once soft for the thin veil between.
    // The sum of two even distributions is humped; this makes it even again, so that `settled` is the covered share.
    let heap = smoothstep(0.0, 1.0, 0.55 * coarse.height + 0.45 * fine.height);
    let bare = 1.0 - settled * 1.06;
    sheet.snow = smoothstep(bare - 0.03, bare + 0.03, heap) * smoothstep(0.0, 0.02, settled);
    sheet.frost = smoothstep(bare - 0.6, bare + 0.1, heap) * settled;
    // The rim of a drift is as steep as the sharp edge; there it is seen against the light.
    let rim = 1.0 + 3.0 * sheet.snow * (1.0 - sheet.snow);
    let height = RELIEF / surface.ice_scale * mix(0.12, rim, sheet.snow);
    sheet.slope = surface.world_from_local * ((0.55 * coarse.slope * 2.0 + 0.45 * fine.slope) * height);
    sheet.cracks = fine.cracks;
    return sheet;
}

// Radiance of the ice towards the eye, with what is seen of the water `below` it.
fn color(sheet: Sheet, at: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, lit: Light, below: vec3<f32>, fog: scene::Fog) -> vec3<f32> {
    let snow = surface.ice_snow_albedo * lit.above;
    if sheet.snow >= 1.0 {
        return snow;
    }
    let cos_eye = max(dot(normal, to_eye), 0.02);
    let share = optics::fresnel_exact(cos_eye, INDEX);
    let inside = through(sheet, to_eye, cos_eye, lit, below);
    var bare = mix(inside, mirrored(at, normal, to_eye, fog), share);
    if (surface.flags & types::FLAG_SUNLIGHT) != 0u {
        bare += lit.glitter;
    }
    return mix(mix(bare, snow, 0.45 * sheet.frost), snow, sheet.snow);
}

// Whether enough light comes through to look for what lies below.
fn is_clear(sheet: Sheet) -> bool {
    return sheet.cover < 1.0 || (sheet.snow < 1.0 && unscattered(sheet, 1.0).g > 0.01);
}

fn scattering(sheet: Sheet) -> f32 {
    // Ice that is only just forming is a slush of crystals.
    return surface.ice_scattering + 60.0 * exp(-sheet.thickness / 0.012);
}

// Share of a beam that passes the ice at the cosine `cos_inside`.
fn unscattered(sheet: Sheet, cos_inside: f32) -> vec3<f32> {
    return exp(-(surface.ice_absorption + scattering(sheet)) * (sheet.thickness / cos_inside));
}

// Light from within and below the ice.
fn through(sheet: Sheet, to_eye: vec3<f32>, cos_eye: f32, lit: Light, below: vec3<f32>) -> vec3<f32> {
    let cos_inside = sqrt(1.0 - (1.0 - cos_eye * cos_eye) / (INDEX * INDEX));
    let layer = growth::layer(surface.ice_absorption, scattering(sheet), sheet.thickness);
    let beam = unscattered(sheet, cos_inside);
    // What is scattered on its way up shows the water without its picture.
    let blurred = max(layer.transmittance - beam, vec3(0.0)) * optics::scattered(lit.below, 1e3, 1e3, 1.0);
    let body = lit.below * layer.reflectance + layer.transmittance * (below * beam + blurred);
    return mix(body, 0.75 * lit.below, crack(sheet, to_eye, cos_inside));
}

// Opacity of the cracks: planes that stand in the ice, seen at the surface and, shifted by the slanting view, below.
fn crack(sheet: Sheet, to_eye: vec3<f32>, cos_inside: f32) -> f32 {
    let strength = surface.ice_cracks * smoothstep(0.03, 0.1, sheet.thickness);
    if strength <= 0.0 {
        return 0.0;
    }
    let slant = to_eye.xz / (INDEX * cos_inside) * surface.world_from_local;
    var sum = sheet.cracks;
    for (var i = 1; i <= 2; i++) {
        let uv = (sheet.uv - slant * (sheet.thickness * 0.3 * f32(i))) * surface.ice_scale;
        sum = max(sum, textureSampleLevel(ice_tile, detail_sampler, uv, 0.0).z * (1.0 - 0.35 * f32(i)));
    }
    return strength * sum;
}

// What bare ice mirrors: the sky blurred by its roughness, and of things beside it only a dim picture.
fn mirrored(at: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, fog: scene::Fog) -> vec3<f32> {
    var direction = reflect(-to_eye, normal);
    direction.y = max(abs(direction.y), 0.005);
    direction = normalize(direction);
    let foot = vec3(at.x, surface.level, at.z);
    let width = 2.0 * sqrt(surface.ice_roughness);
    let sky = mirror::sky_radiance(direction, sqrt(clamp(width, 0.0, 1.0)));
    let picture = mirror::mirrored(foot, direction) * exp(-8.0 * width);
    return mirror::freed_of_fog(picture, fog) + sky * (1.0 - picture.a);
}
