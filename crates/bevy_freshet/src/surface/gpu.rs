//! The numbers of a surface as the shader reads them.
use super::shape::SurfaceShape;
use crate::body::WaterWaves;
use bevy::{prelude::*, render::render_resource::ShaderType};

/// The Rust twin of `Surface` in `types.wgsl`, where each member is explained.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuSurface {
    pub world_from_local: Mat2,
    pub world_origin: Vec2,
    pub half_size: Vec2,
    pub level: f32,
    pub mesh_cells: [f32; SurfaceShape::MOST_RINGS],
    pub mesh_center: Vec2,
    pub mesh_reach: f32,
    pub flags: u32,
    pub view: u32,
    pub wave_count: u32,
    pub waves: [Vec4; WaterWaves::MAX],

    pub bed_from_local: Mat2,
    pub bed_origin: Vec2,
    pub bed_size: Vec2,
    pub bed_cell: f32,
    pub bed_base: f32,
    pub fade_depth: f32,

    pub flow_cell: f32,
    pub flow_size: Vec2,
    pub flow_cycle: f32,
    pub flow_phase: f32,
    pub bank_depth: f32,

    pub detail_slope: f32,
    pub detail_scale: f32,
    pub detail_drift: Vec4,
    pub roughness: f32,

    pub index: f32,
    pub absorption: Vec3,
    pub reflectivity: f32,
    pub backscatter: Vec3,
    pub refraction: f32,
    pub dull_color: Vec3,
    pub dullness: f32,
    pub dispersion: f32,
    pub light_path: f32,
    pub edge_depth: f32,
    pub fresnel: u32,
    pub fresnel_correction: f32,

    pub mirror_distance: f32,
    pub mirror_distortion: f32,
    pub mirror_clip_from_world: Mat4,
    pub sky_from_world: Mat3,
    pub sky_tint: Vec3,

    pub field_origin: Vec2,
    pub field_scale: Vec2,
    pub field_open: Vec4,

    pub foam_albedo: Vec3,
    pub foam_amount: f32,
    pub foam_scale: f32,
    pub foam_drift: Vec4,

    // Stylised light.
    pub tint: Vec3,
    pub tint_exponent: f32,
    pub translucent_color: Vec3,
    pub diffuse: f32,
    pub wave_shadow: f32,
    pub highlight: f32,
    pub flatness: f32,
    pub sharpness: f32,
    pub shininess: f32,

    // For SurfaceView.
    pub current_drift: Vec2,
    pub flow_factor: f32,
    pub view_range: Vec2,
    pub simulated_age: f32,

    // Ice
    pub ice_order_size: Vec2,
    pub ice_order_cell: f32,
    pub ice_freezing: f32,
    pub ice_thickest: f32,
    pub ice_level_drop: f32,
    pub ice_snow: f32,
    pub ice_cracks: f32,
    pub ice_absorption: Vec3,
    pub ice_scattering: f32,
    pub ice_snow_albedo: Vec3,
    pub ice_roughness: f32,
    pub ice_scale: f32,

    pub simulated_size: Vec2,
    pub simulated_cell: f32,
    pub simulated_center: Vec2,
    pub simulated_half_size: Vec2,
    pub simulated_per_blend: Vec4,
    pub flat_depth: f32,
}

impl GpuSurface {
    pub const MIRROR: u32 = 1;
    pub const BED: u32 = 2;
    pub const FLOW: u32 = 4;
    pub const FOG: u32 = 8;
    pub const SUNLIGHT: u32 = 16;
    pub const FIELD: u32 = 32;
    pub const ICE: u32 = 4096;
    pub const SIMULATED: u32 = 8192;
    pub const WALLED: u32 = 16384;
}

#[cfg(test)]
mod tests {
    use super::*;

    const WGSL: &str = include_str!("types.wgsl");

    #[test]
    fn the_shader_reads_what_is_written() {
        let rings = SurfaceShape::MOST_RINGS;
        assert!(WGSL.contains(&format!("const RINGS: u32 = {rings}u;")));
        let wgsl = WGSL.replace("#{MAX_WAVES}", &WaterWaves::MAX.to_string()).replace("RINGS>", &format!("{rings}>"));
        crate::layout::assert_same_layout::<GpuSurface, _>(&wgsl, "Surface");
    }

    #[test]
    fn the_shader_knows_the_flags() {
        let flags = [
            ("MIRROR", GpuSurface::MIRROR),
            ("BED", GpuSurface::BED),
            ("FLOW", GpuSurface::FLOW),
            ("FOG", GpuSurface::FOG),
            ("SUNLIGHT", GpuSurface::SUNLIGHT),
            ("FIELD", GpuSurface::FIELD),
            ("ICE", GpuSurface::ICE),
            ("SIMULATED", GpuSurface::SIMULATED),
            ("WALLED", GpuSurface::WALLED),
        ];
        for (name, value) in flags {
            assert!(WGSL.contains(&format!("const FLAG_{name}: u32 = {value}u;")), "{name}");
        }
    }
}
