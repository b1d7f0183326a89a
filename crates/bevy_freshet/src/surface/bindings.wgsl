// The bindings of the surface material; an index means one thing everywhere.
#define_import_path freshet::surface::bindings

#import freshet::surface::types::Surface

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> surface: Surface;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var mirror: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var mirror_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var sky: texture_cube<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var sky_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(5) var sky_light: texture_cube<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(6) var detail: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(7) var detail_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(8) var bed: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(9) var flow: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(10) var field_rings: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(11) var field_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(12) var field_matter: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(13) var foam: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(14) var ice_order: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(15) var ice_tile: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(16) var simulated: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(17) var simulated_slopes: texture_2d<f32>;
