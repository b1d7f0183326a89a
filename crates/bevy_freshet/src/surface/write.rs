//! Fills the numbers and textures of every surface, every frame.
use super::{
    SurfaceView, WaterSurface,
    foam::PATTERNS,
    gpu::GpuSurface,
    ice::write_ice,
    material::SurfaceMaterial,
    ripples::Ripples,
    shape::SurfaceShape,
    sync::{GroundTextures, SurfaceOf},
    viewer::{ViewerData, Viewers},
};
use crate::{
    body::{Fresnel, ResolvedWater, WaterFlow, WaterFoam, WaterIce, WaterLighting, WaterOptics},
    reflection::{MirrorKey, Mirrors, WaterReflection},
    report::Reported,
    simulation::{FieldPictures, FieldWindow, Simulated},
};
use bevy::{
    asset::RenderAssetUsages,
    image::Image,
    math::{DMat2, DVec2},
    prelude::*,
    render::{
        render_resource::{Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension},
        storage::ShaderBuffer,
    },
};

/// The waters with everything that is written of them.
type Waters<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static ResolvedWater,
        &'static WaterSurface,
        &'static Ripples,
        &'static WaterOptics,
        &'static WaterReflection,
        (&'static WaterFoam, &'static FieldWindow, &'static FieldPictures),
        &'static WaterLighting,
        (Option<&'static WaterIce>, Option<&'static Simulated>),
    ),
>;

pub(super) fn write_surfaces(
    clear_color: Res<ClearColor>,
    assets: Res<AssetServer>,
    mirrors: Res<Mirrors>,
    mut ground: ResMut<GroundTextures>,
    mut images: ResMut<Assets<Image>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut materials: ResMut<Assets<SurfaceMaterial>>,
    mut reported: ResMut<Reported>,
    mut plain_sky: Local<Option<Handle<Image>>>,
    mut image_events: MessageReader<AssetEvent<Image>>,
    viewers: Viewers,
    waters: Waters,
    surfaces: Query<(&SurfaceOf, &SurfaceShape, &MeshMaterial3d<SurfaceMaterial>)>,
) {
    let replaced: Vec<AssetId<Image>> = image_events
        .read()
        .filter_map(|event| if let AssetEvent::Modified { id } = event { Some(*id) } else { None })
        .collect();
    let plain_sky = plain_sky.get_or_insert_with(|| images.add(white_cube())).clone();
    for (surface, shape, material_handle) in &surfaces {
        let (Ok(water), Some(viewer)) = (waters.get(surface.water), viewers.get(surface.viewer)) else { continue };
        let (
            entity,
            resolved,
            settings,
            ripples,
            optics,
            reflection,
            (foam, window, pictures),
            lighting,
            (ice, simulated),
        ) = water;
        let mut gpu = GpuSurface::default();
        let mut textures = Textures::default();
        write_frame(&mut gpu, resolved, shape, &viewer);
        write_optics(&mut gpu, entity, optics, &mut reported);
        write_detail(&mut gpu, entity, settings, ripples, &mut reported);
        (textures.bed, textures.flow) = write_ground(&mut gpu, resolved, &mut ground, &mut images);
        write_mirror(&mut gpu, &mut textures, entity, reflection, resolved, &viewer, &mirrors, &mut reported);
        write_field(&mut gpu, resolved, window, pictures);
        write_foam(&mut gpu, entity, foam, ripples, &mut reported);
        write_lighting(&mut gpu, entity, lighting, &mut reported);
        let ice = write_ice(&mut gpu, entity, ice, resolved, &mut ground, &mut images, &mut reported);
        write_sky(&mut gpu, &mut textures, &viewer, &clear_color, &plain_sky, &assets);

        let Some(material) = materials.get(material_handle) else { continue };
        let [level, slopes] =
            simulated.and_then(|simulated| simulated.pictures.clone()).map_or([None, None], |p| p.map(Some));
        let wanted = SurfaceMaterial {
            simulated: level,
            simulated_slopes: slopes,
            mirror: textures.mirror,
            sky: textures.sky,
            sky_light: textures.sky_light,
            bed: textures.bed,
            flow: textures.flow,
            field_rings: pictures.rings.clone(),
            field_matter: pictures.matter.clone(),
            ice_order: ice.as_ref().map(|ice| ice.order.clone()),
            ice_tile: ice.map(|ice| ice.tile),
            ..material.clone()
        };
        if let Some(mut buffer) = buffers.get_mut(&wanted.surface) {
            buffer.set_data(gpu);
        }
        // A touched material makes a new bind group: needed for new handles and for textures that were replaced.
        if (*material != wanted || wanted.uses(&replaced))
            && let Some(mut material) = materials.get_mut(material_handle)
        {
            *material = wanted;
        }
    }
}

#[derive(Default)]
struct Textures {
    mirror: Option<Handle<Image>>,
    sky: Option<Handle<Image>>,
    sky_light: Option<Handle<Image>>,
    bed: Option<Handle<Image>>,
    flow: Option<Handle<Image>>,
}

fn write_frame(gpu: &mut GpuSurface, water: &ResolvedWater, shape: &SurfaceShape, viewer: &ViewerData) {
    write_water(gpu, water);
    let eye = water.local_from_world.transform_point2(viewer.pose.translation().xz());
    gpu.mesh_center = shape.center(eye, water.half_size);
    gpu.mesh_cells = shape.spacings();
    gpu.mesh_reach = shape.reach();
}

/// Frame and waves of the water, whoever looks at it.
pub(crate) fn write_water(gpu: &mut GpuSurface, water: &ResolvedWater) {
    gpu.world_from_local = water.world_from_local.matrix2;
    gpu.world_origin = water.world_from_local.translation;
    gpu.half_size = water.half_size;
    gpu.level = water.level;
    gpu.fade_depth = water.fade_depth;
    gpu.wave_count = water.waves.trains.len() as u32;
    for (slot, train) in gpu.waves.iter_mut().zip(&water.waves.trains) {
        *slot = train.wave_vector.extend(train.amplitude).extend(train.phase);
    }
}

fn write_optics(gpu: &mut GpuSurface, entity: Entity, optics: &WaterOptics, reported: &mut Reported) {
    let usable = WaterOptics::default();
    let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
    gpu.index = clamp("WaterOptics::index", optics.index, 1.0..=3.0, usable.index);
    gpu.reflectivity = clamp("WaterOptics::reflectivity", optics.reflectivity, 0.0..=1.0, 1.0);
    gpu.refraction = clamp("WaterOptics::refraction", optics.refraction, 0.0..=1.0, 1.0);
    gpu.dispersion = clamp("WaterOptics::dispersion", optics.dispersion, 0.0..=0.2, 0.0);
    gpu.light_path = clamp("WaterOptics::light_path", optics.light_path, 0.0..=1.0, 1.0);
    gpu.dullness = clamp("WaterOptics::dullness", optics.dullness, 0.0..=1.0, 0.0);
    gpu.edge_depth = clamp("WaterOptics::edge_depth", optics.edge_depth, 0.0..=1e4, usable.edge_depth);
    (gpu.fresnel, gpu.fresnel_correction) = match optics.fresnel {
        Fresnel::Simple { correction } => (0, clamp("Fresnel::Simple::correction", correction, 0.0..=2.0, 1.8)),
        Fresnel::Schlick => (1, 0.0),
        Fresnel::Reciprocal => (2, 0.0),
        Fresnel::Exact => (3, 0.0),
        Fresnel::Constant { share } => (4, clamp("Fresnel::Constant::share", share, 0.0..=1.0, 0.5)),
    };
    let mut clamp3 = |field, value, fallback| reported.clamp3(entity, field, value, 0.0..=1e4, fallback);
    gpu.absorption = clamp3("WaterOptics::absorption", optics.absorption, usable.absorption);
    gpu.backscatter = clamp3("WaterOptics::backscatter", optics.backscatter, usable.backscatter);
    gpu.dull_color = clamp3("WaterOptics::dull_color", optics.dull_color.to_vec3(), Vec3::ZERO);
    gpu.flags |= if optics.fog { GpuSurface::FOG } else { 0 };
}

fn write_detail(
    gpu: &mut GpuSurface,
    entity: Entity,
    settings: &WaterSurface,
    ripples: &Ripples,
    reported: &mut Reported,
) {
    gpu.detail_slope = reported.clamp(entity, "WaterSurface::ripples", settings.ripples, 0.0..=1.0, 0.045);
    gpu.roughness = reported.clamp(entity, "WaterSurface::roughness", settings.roughness, 1e-4..=0.5, 0.002);
    gpu.detail_scale = ripples.size.recip();
    let [first, second] = ripples.shifts.map(|shift| shift.as_vec2());
    gpu.detail_drift = first.extend(second.x).extend(second.y);
    gpu.flow_cycle = ripples.cycle;
    gpu.flow_phase = ripples.phase as f32;
    gpu.flags |= if settings.sunlight { GpuSurface::SUNLIGHT } else { 0 };
    gpu.view = match settings.view {
        SurfaceView::Water => 0,
        SurfaceView::Reflection => 1,
        SurfaceView::Refraction => 2,
        SurfaceView::Fresnel => 3,
        SurfaceView::Normal => 4,
        SurfaceView::Height => 5,
        SurfaceView::Edge => 6,
        SurfaceView::Flow => 7,
        SurfaceView::Depth => 8,
        SurfaceView::Wireframe => 9,
        SurfaceView::Foam => 10,
        SurfaceView::Interaction => 11,
        SurfaceView::Dye => 12,
        SurfaceView::Ice => 13,
        SurfaceView::Level => 14,
        SurfaceView::Speed => 15,
        SurfaceView::Froude => 16,
        SurfaceView::Age => 17,
    };
    let factor = reported.clamp(entity, "WaterSurface::view_scale", settings.view_scale, 1e-3..=1e3, 1.0);
    if let Some(scale) = settings.view.scale().map(|scale| scale.times(factor)) {
        gpu.view_range = vec2(scale.low, (scale.high - scale.low).recip());
    }
}

/// Bed and current of the water, and their textures.
pub(crate) fn write_ground(
    gpu: &mut GpuSurface,
    water: &ResolvedWater,
    ground: &mut GroundTextures,
    images: &mut Assets<Image>,
) -> (Option<Handle<Image>>, Option<Handle<Image>>) {
    let (mut bed_texture, mut flow_texture) = (None, None);
    gpu.flat_depth = water.flat_ground.unwrap_or(1e6);
    if let Some(bed) = &water.bed {
        gpu.flags |= GpuSurface::BED;
        gpu.bed_from_local = bed.bed_from_local.matrix2;
        gpu.bed_origin = bed.bed_from_local.translation;
        gpu.bed_size = bed.elevations.size().as_vec2();
        gpu.bed_cell = bed.elevations.cell_size();
        gpu.bed_base = bed.base;
        bed_texture = Some(ground.bed(&bed.elevations, images));
    }
    gpu.current_drift = water.drift;
    let is_mapped = water.simulated.as_ref().is_none_or(|simulated| simulated.area.is_part());
    if let Some((map, scale)) = water.flow.as_ref().filter(|_| is_mapped) {
        gpu.flags |= GpuSurface::FLOW;
        gpu.flow_factor = *scale;
        gpu.flow_cell = map.cell_size();
        gpu.flow_size = map.size().as_vec2();
        gpu.bank_depth = WaterFlow::BANK_DEPTH;
        flow_texture = Some(ground.flow(map, images));
    }
    if let Some(simulated) = &water.simulated {
        gpu.flags |= GpuSurface::SIMULATED;
        if simulated.water.has_walls() {
            gpu.flags |= GpuSurface::WALLED;
        }
        gpu.simulated_age = simulated.age;
        gpu.simulated_size = simulated.water.size().as_vec2();
        gpu.simulated_cell = simulated.water.cell_size();
        gpu.simulated_center = simulated.area.center;
        gpu.simulated_half_size = simulated.area.half_size;
        gpu.simulated_per_blend = simulated.area.per_blend;
    }
    (bed_texture, flow_texture)
}

fn write_mirror(
    gpu: &mut GpuSurface,
    textures: &mut Textures,
    entity: Entity,
    reflection: &WaterReflection,
    water: &ResolvedWater,
    viewer: &ViewerData,
    mirrors: &Mirrors,
    reported: &mut Reported,
) {
    let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
    gpu.mirror_distance = clamp("WaterReflection::distance", reflection.distance, 0.01..=1e5, 3.0);
    gpu.mirror_distortion = clamp("WaterReflection::distortion", reflection.distortion, 0.0..=1.0, 1.0);
    let mirror = mirrors.0.get(&MirrorKey::new(viewer.entity, water.level)).filter(|_| reflection.planar);
    if let Some((mirror, clip_from_world)) = mirror.and_then(|mirror| Some((mirror, mirror.clip_from_world?))) {
        gpu.flags |= GpuSurface::MIRROR;
        gpu.mirror_clip_from_world = clip_from_world;
        textures.mirror = Some(mirror.image.clone());
    }
}

fn write_field(gpu: &mut GpuSurface, water: &ResolvedWater, window: &FieldWindow, pictures: &FieldPictures) {
    if pictures.rings.is_some() && pictures.matter.is_some() && window.size != UVec2::ZERO {
        gpu.flags |= GpuSurface::FIELD;
        gpu.field_origin = window.origin();
        gpu.field_scale = window.extent().recip();
        gpu.field_open = window.open_sides(water.half_size);
    }
}

/// Patterns of foam's patches from those of its bubbles, as in `foam.wgsl`.
const FOAM_PATCH: DMat2 = DMat2::from_cols(DVec2::new(0.4684, 0.2412), DVec2::new(-0.2412, 0.4684));

fn write_foam(gpu: &mut GpuSurface, entity: Entity, foam: &WaterFoam, ripples: &Ripples, reported: &mut Reported) {
    let usable = WaterFoam::default();
    gpu.foam_amount = reported.clamp(entity, "WaterFoam::amount", foam.amount, 0.0..=1.0, usable.amount);
    let size = reported.clamp(entity, "WaterFoam::pattern_size", foam.pattern_size, 0.05..=100.0, usable.pattern_size);
    let tile = size * PATTERNS;
    gpu.foam_scale = tile.recip();
    let drift = ripples.carried / f64::from(tile);
    let [bubbles, patches] = [drift, FOAM_PATCH * drift].map(|shift| shift.fract_gl().as_vec2());
    gpu.foam_drift = bubbles.extend(patches.x).extend(patches.y);
    let (albedo, fallback) = (foam.albedo.to_vec3(), usable.albedo.to_vec3());
    gpu.foam_albedo = reported.clamp3(entity, "WaterFoam::albedo", albedo, 0.0..=1.0, fallback);
}

fn write_lighting(gpu: &mut GpuSurface, entity: Entity, lighting: &WaterLighting, reported: &mut Reported) {
    let lighting = lighting.usable(entity, reported);
    gpu.diffuse = lighting.diffuse;
    gpu.wave_shadow = lighting.wave_shadow;
    gpu.highlight = lighting.highlight;
    gpu.flatness = lighting.flatness;
    gpu.sharpness = lighting.sharpness;
    gpu.shininess = lighting.shininess;
    gpu.tint = lighting.tinted_highlight * lighting.tint.to_vec3();
    gpu.tint_exponent = lighting.tint_exponent;
    gpu.translucent_color = lighting.translucence * lighting.translucent_color.to_vec3();
}

/// What is reflected where nothing is mirrored: the camera's environment map, else its skybox, else its clear colour.
fn write_sky(
    gpu: &mut GpuSurface,
    textures: &mut Textures,
    viewer: &ViewerData,
    clear_color: &ClearColor,
    plain_sky: &Handle<Image>,
    assets: &AssetServer,
) {
    // A material whose texture is not there is not drawn at all. Images that were made and not loaded have no state.
    let is_there = |image: &Handle<Image>| assets.get_load_state(image).is_none_or(|state| state.is_loaded());
    let exposure = viewer.exposure.copied().unwrap_or_default().exposure();
    let (sky, light, tint, rotation) =
        if let Some(map) = viewer.environment.filter(|map| is_there(&map.specular_map) && is_there(&map.diffuse_map)) {
            (map.specular_map.clone(), map.diffuse_map.clone(), Vec3::splat(map.intensity * exposure), map.rotation)
        } else if let Some((skybox, image)) =
            viewer.skybox.and_then(|skybox| Some((skybox, skybox.image.clone().filter(is_there)?)))
        {
            (image.clone(), image, Vec3::splat(skybox.brightness * exposure), skybox.rotation)
        } else {
            let color = match viewer.camera.clear_color {
                ClearColorConfig::Custom(color) => color,
                ClearColorConfig::Default | ClearColorConfig::None => clear_color.0,
            };
            (plain_sky.clone(), plain_sky.clone(), color.to_linear().to_vec3(), Quat::IDENTITY)
        };
    gpu.sky_from_world = Mat3::from_quat(rotation.inverse());
    gpu.sky_tint = tint;
    textures.sky = Some(sky);
    textures.sky_light = Some(light);
}

/// A sky of one colour, to be tinted.
fn white_cube() -> Image {
    let extent = Extent3d { width: 1, height: 1, depth_or_array_layers: 6 };
    let format = TextureFormat::Rgba8Unorm;
    let mut image = Image::new_fill(extent, TextureDimension::D2, &[255; 4], format, RenderAssetUsages::default());
    image.texture_descriptor.label = Some("water_plain_sky");
    image.texture_view_descriptor =
        Some(TextureViewDescriptor { dimension: Some(TextureViewDimension::Cube), ..default() });
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_knows_the_patches_of_foam() {
        let [x, y] = [FOAM_PATCH.x_axis, FOAM_PATCH.y_axis].map(|axis| format!("vec2({}, {})", axis.x, axis.y));
        assert!(include_str!("foam.wgsl").contains(&format!("const PATCH: mat2x2<f32> = mat2x2<f32>({x}, {y});")));
    }
}
