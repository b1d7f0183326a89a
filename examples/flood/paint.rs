//! The terrain's material: as it is in the sun, or with its wet cells in the colours of the legend.
use crate::{
    texture,
    viewer::{Coloring, HAZARDS, Viewer},
};
use bevy::{
    asset::{RenderAssetUsages, uuid_handle},
    pbr::{ExtendedMaterial, MaterialExtension},
    prelude::*,
    render::render_resource::{AsBindGroup, Extent3d, ShaderType, TextureDimension, TextureFormat},
    shader::{Shader, ShaderRef},
};
use bevy_freshet::{flood::FloodState, surface::ViewScale};

/// What the terrain is drawn with.
pub type TerrainMaterial = ExtendedMaterial<StandardMaterial, Paint>;

const SHADER: Handle<Shader> = uuid_handle!("5f1b6c1e-96a3-4f0e-8f5c-6d3f0f6c2a51");

/// Colours between the first and the last of the legend.
const RAMP: u32 = 1024;

/// What cells have as the time of the first water that never came, min; `NEVER` in `paint.wgsl` is less.
const NEVER: f32 = f32::MAX;

/// The colours of wet cells.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
pub struct Paint {
    #[uniform(100)]
    scale: Scale,
    /// The flood, as the GPU draws it.
    #[texture(101, sample_type = "float", filterable = false)]
    water: Option<Handle<Image>>,
    /// Colours of all cells without water.
    #[texture(102, sample_type = "float", filterable = false)]
    dry: Handle<Image>,
    #[texture(103, sample_type = "float", filterable = false)]
    arrival: Handle<Image>,
    #[texture(104, sample_type = "float", filterable = false)]
    ramp: Handle<Image>,
}

#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default, PartialEq)]
struct Scale {
    coloring: u32,
    low: f32,
    high: f32,
    exaggeration: f32,
    hazards: Vec4,
}

impl MaterialExtension for Paint {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }
}

/// Draws terrain with [`TerrainMaterial`].
pub struct PaintPlugin;

impl Plugin for PaintPlugin {
    fn build(&self, app: &mut App) {
        let shader = Shader::from_wgsl(include_str!("paint.wgsl"), "paint.wgsl");
        if let Err(problem) = app.world_mut().resource_mut::<Assets<Shader>>().insert(&SHADER, shader) {
            error!("the terrain's shader: {problem}");
        }
        app.add_plugins(MaterialPlugin::<TerrainMaterial>::default()).add_systems(PostUpdate, paint);
    }
}

impl Paint {
    /// In the sun at first. `dry` has the colours of all cells without water.
    pub fn new(viewer: &Viewer, dry: &[[u8; 4]], images: &mut Assets<Image>) -> Self {
        let size = viewer.terrain.size();
        let minutes = |index| viewer.arrival_of(index).map_or(NEVER, |time| (time / 60.0) as f32);
        let arrival = (0..viewer.terrain.values().len()).map(minutes);
        let ramp = (0..RAMP).map(|k| ViewScale::color(k as f32 / (RAMP - 1) as f32).to_f32_array());
        Self {
            scale: Scale::default(),
            water: None,
            dry: images.add(texture::cells(size, dry)),
            arrival: images.add(numbers(size, TextureFormat::R32Float, arrival)),
            ramp: images.add(numbers(uvec2(RAMP, 1), TextureFormat::Rgba32Float, ramp.flatten())),
        }
    }
}

/// A texture of numbers that are read texel by texel.
fn numbers(size: UVec2, format: TextureFormat, numbers: impl Iterator<Item = f32>) -> Image {
    let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    let data = numbers.flat_map(f32::to_le_bytes).collect();
    Image::new(extent, TextureDimension::D2, data, format, RenderAssetUsages::RENDER_WORLD)
}

impl Scale {
    fn of(viewer: &Viewer) -> Self {
        let coloring = match viewer.coloring {
            Coloring::Water => 0,
            Coloring::Depth => 1,
            Coloring::Speed => 2,
            Coloring::Arrival => 3,
            Coloring::Hazard => 4,
        };
        let (low, high) = viewer.scale().map_or((0.0, 1.0), |scale| (scale.low, scale.high));
        let hazards = Vec4::from_array(HAZARDS.map(|(from, _)| from));
        Self { coloring, low, high: high.max(low + f32::MIN_POSITIVE), exaggeration: viewer.exaggeration, hazards }
    }
}

/// Follows the viewer, and the flood's picture.
fn paint(viewer: Res<Viewer>, mut materials: ResMut<Assets<TerrainMaterial>>, state: Single<&FloodState>) {
    let water = state.picture().cloned();
    let scale = if water.is_some() { Scale::of(&viewer) } else { Scale::default() };
    let is_old = |paint: &Paint| (paint.scale, &paint.water) != (scale, &water);
    let old: Vec<_> = materials.iter().filter(|(_, it)| is_old(&it.extension)).map(|(id, _)| id).collect();
    for id in old {
        if let Some(mut material) = materials.get_mut(id) {
            (material.extension.scale, material.extension.water) = (scale, water.clone());
        }
    }
}
