//! What the shader knows of the ice.
use super::{gpu::GpuSurface, sync::GroundTextures};
use crate::{
    body::{ResolvedWater, WaterIce},
    report::Reported,
};
use bevy::{image::Image, prelude::*};

/// The textures of ice.
pub(super) struct IceTextures {
    pub order: Handle<Image>,
    pub tile: Handle<Image>,
}

/// Writes the ice of a water; `None` where nothing is frozen.
pub(super) fn write_ice(
    gpu: &mut GpuSurface,
    entity: Entity,
    settings: Option<&WaterIce>,
    water: &ResolvedWater,
    ground: &mut GroundTextures,
    images: &mut Assets<Image>,
    reported: &mut Reported,
) -> Option<IceTextures> {
    let settings = settings?;
    ground.ice_tile.want();
    let usable = WaterIce::default();
    let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
    gpu.ice_snow = clamp("WaterIce::snow", settings.snow, 0.0..=1.0, usable.snow);
    gpu.ice_cracks = clamp("WaterIce::cracks", settings.cracks, 0.0..=1.0, usable.cracks);
    gpu.ice_scale = clamp("WaterIce::pattern_size", settings.pattern_size, 0.5..=1e3, usable.pattern_size).recip();
    gpu.ice_scattering = clamp("WaterIce::scattering", settings.scattering, 0.0..=1e3, usable.scattering);
    gpu.ice_roughness = clamp("WaterIce::roughness", settings.roughness, 1e-4..=0.5, usable.roughness);
    let mut clamp3 = |field, value, most, fallback| reported.clamp3(entity, field, value, 0.0..=most, fallback);
    gpu.ice_absorption = clamp3("WaterIce::absorption", settings.absorption, 100.0, usable.absorption);
    let (albedo, fallback) = (settings.snow_albedo.to_vec3(), usable.snow_albedo.to_vec3());
    gpu.ice_snow_albedo = clamp3("WaterIce::snow_albedo", albedo, 1.0, fallback);

    let order = write_frozen(gpu, water, ground, images)?;
    Some(IceTextures { order, tile: ground.ice_tile.get(images) })
}

/// Writes where a water is frozen, and gives the order of freezing; `None` where nothing is.
pub(crate) fn write_frozen(
    gpu: &mut GpuSurface,
    water: &ResolvedWater,
    ground: &mut GroundTextures,
    images: &mut Assets<Image>,
) -> Option<Handle<Image>> {
    let ice = water.ice.as_ref()?;
    gpu.flags |= GpuSurface::ICE;
    gpu.ice_freezing = ice.winter.freezing;
    gpu.ice_thickest = ice.winter.thickest;
    gpu.ice_level_drop = ice.level_drop;
    gpu.ice_order_size = ice.order.size().as_vec2();
    gpu.ice_order_cell = ice.order.cell_size();
    Some(ground.ice_order(&ice.order, images))
}
