// The simulated fields of the water: rings, foam and dye on the cells of a window.
#define_import_path freshet::surface::field

#import freshet::surface::bindings::{surface, field_rings, field_sampler, field_matter}
#import freshet::surface::types

struct Field {
    slope: vec2<f32>,   // slope of the rings, local
    height: f32,        // height of the rings, units: m
    cover: f32,         // share that bodies cover at the waterline
    foam: f32,          // cover of foam
    dye: vec3<f32>,     // absorption of dye, units: 1/m
}

// The fields at local `place`; nothing beyond the window, towards whose rim they fade where the water goes on.
fn at(place: vec2<f32>) -> Field {
    var field = Field(vec2(0.0), 0.0, 0.0, 0.0, vec3(0.0));
    if (surface.flags & types::FLAG_FIELD) == 0u {
        return field;
    }
    let uv = (place - surface.field_origin) * surface.field_scale;
    let ways = mix(vec4(1.0), vec4(uv.x, 1.0 - uv.x, uv.y, 1.0 - uv.y), surface.field_open);
    let share = smoothstep(0.0, 0.04, min(min(ways.x, ways.y), min(ways.z, ways.w)));
    if share <= 0.0 {
        return field;
    }
    let rings = textureSampleLevel(field_rings, field_sampler, uv, 0.0);
    let matter = textureSampleLevel(field_matter, field_sampler, uv, 0.0);
    return Field(rings.xy * share, rings.z * share, rings.w * share, matter.x * share, matter.yzw * share);
}
