// What the surface of one water needs to know in one view. The Rust twin is `GpuSurface` in `gpu.rs`.
#define_import_path freshet::surface::types

// Most rings of the mesh.
const RINGS: u32 = 32u;

struct Surface {
    // World xz from local xz: turn, then shift.
    world_from_local: mat2x2<f32>,
    world_origin: vec2<f32>,        // units: m
    half_size: vec2<f32>,           // units: m
    level: f32,                     // world height of the still surface, units: m
    mesh_cells: array<f32, RINGS>,  // size of the cells of each ring of the mesh, units: m
    mesh_center: vec2<f32>,         // local xz, units: m
    mesh_reach: f32,                // half width of the finest part of the mesh, units: m
    flags: u32,
    view: u32,                      // what is drawn instead of water, see VIEW_*
    wave_count: u32,
    waves: array<vec4<f32>, #{MAX_WAVES}>, // wave vector (rad/m), amplitude (m), phase (rad)

    bed_from_local: mat2x2<f32>,
    bed_origin: vec2<f32>,          // units: m
    bed_size: vec2<f32>,            // cells
    bed_cell: f32,                  // units: m
    bed_base: f32,                  // world height of elevation zero, units: m
    fade_depth: f32,                // units: m

    flow_cell: f32,                 // units: m
    flow_size: vec2<f32>,           // cells
    flow_cycle: f32,                // period of the two-phase drift, units: s
    flow_phase: f32,                // 0…1
    bank_depth: f32,                // depth from which on the flow map counts in full, units: m

    detail_slope: f32,              // factor on the slopes of the detail tile
    detail_scale: f32,              // tiles per metre
    detail_drift: vec4<f32>,        // shift of the two layers, tiles
    roughness: f32,                 // slope variance of what no texture shows

    index: f32,
    absorption: vec3<f32>,          // units: 1/m
    reflectivity: f32,
    backscatter: vec3<f32>,         // units: 1/m
    refraction: f32,
    dull_color: vec3<f32>,
    dullness: f32,
    dispersion: f32,
    light_path: f32,
    edge_depth: f32,                // units: m
    fresnel: u32,
    fresnel_correction: f32,

    mirror_distance: f32,           // assumed distance of mirrored things, units: m
    mirror_distortion: f32,
    mirror_clip_from_world: mat4x4<f32>,
    sky_from_world: mat3x3<f32>,
    sky_tint: vec3<f32>,            // factor that makes the sky's texels radiance as drawn

    field_origin: vec2<f32>,        // north-west corner of the simulated window, local xz, units: m
    field_scale: vec2<f32>,         // windows per metre
    field_open: vec4<f32>,          // 1 where the water goes on beyond the window: at low x, high x, low z, high z

    foam_albedo: vec3<f32>,
    foam_amount: f32,
    foam_scale: f32,                // tiles per metre
    foam_drift: vec4<f32>,          // shift of bubbles (xy) and patches (zw) by the uniform current, tiles

    // Stylised light.
    tint: vec3<f32>,                // strength times colour of the tinted highlight, units: 1/sr
    tint_exponent: f32,
    translucent_color: vec3<f32>,   // strength times colour
    diffuse: f32,
    wave_shadow: f32,
    highlight: f32,                 // units: 1/sr
    flatness: f32,
    sharpness: f32,
    shininess: f32,

    current_drift: vec2<f32>,       // uniform part of the current, local xz, units: m/s
    flow_factor: f32,               // factor on the flow map
    view_range: vec2<f32>,          // value of the first colour of a view, and colours per unit
    simulated_age: f32,             // of the state that bodies and queries know, units: s

    // Ice
    ice_order_size: vec2<f32>,      // cells
    ice_order_cell: f32,            // units: m
    ice_freezing: f32,              // part of the winter that has passed, 0…1
    ice_thickest: f32,              // thickness of the oldest ice at its end, units: m
    ice_level_drop: f32,            // per thickness
    ice_snow: f32,                  // share that snow covers in the end
    ice_cracks: f32,
    ice_absorption: vec3<f32>,      // units: 1/m
    ice_scattering: f32,            // units: 1/m
    ice_snow_albedo: vec3<f32>,
    ice_roughness: f32,             // slope variance of bare ice
    ice_scale: f32,                 // patterns per metre

    simulated_size: vec2<f32>,      // cells of the simulated water
    simulated_cell: f32,            // units: m
    simulated_center: vec2<f32>,    // local xz, units: m
    simulated_half_size: vec2<f32>, // units: m
    simulated_per_blend: vec4<f32>, // per width of the strip along which it passes into the water outside, at low x, high x, low z, high z; units: 1/m
    flat_depth: f32,                // depth of the ground under the still level where there is no bed, units: m
}

const FLAG_MIRROR: u32 = 1u;
const FLAG_BED: u32 = 2u;
const FLAG_FLOW: u32 = 4u;
const FLAG_FOG: u32 = 8u;
const FLAG_SUNLIGHT: u32 = 16u;
const FLAG_FIELD: u32 = 32u;
const FLAG_ICE: u32 = 4096u;
const FLAG_SIMULATED: u32 = 8192u;
const FLAG_WALLED: u32 = 16384u;

const VIEW_WATER: u32 = 0u;
const VIEW_REFLECTION: u32 = 1u;
const VIEW_REFRACTION: u32 = 2u;
const VIEW_FRESNEL: u32 = 3u;
const VIEW_NORMAL: u32 = 4u;
const VIEW_HEIGHT: u32 = 5u;
const VIEW_EDGE: u32 = 6u;
const VIEW_FLOW: u32 = 7u;
const VIEW_DEPTH: u32 = 8u;
const VIEW_WIREFRAME: u32 = 9u;
const VIEW_FOAM: u32 = 10u;
const VIEW_INTERACTION: u32 = 11u;
const VIEW_DYE: u32 = 12u;
const VIEW_ICE: u32 = 13u;
const VIEW_LEVEL: u32 = 14u;
const VIEW_SPEED: u32 = 15u;
const VIEW_FROUDE: u32 = 16u;
const VIEW_AGE: u32 = 17u;

const FRESNEL_SIMPLE: u32 = 0u;
const FRESNEL_SCHLICK: u32 = 1u;
const FRESNEL_RECIPROCAL: u32 = 2u;
const FRESNEL_CONSTANT: u32 = 4u;
