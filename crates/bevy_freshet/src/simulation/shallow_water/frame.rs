//! What is to be done for a shallow water in a frame, as the render world gets it.
use super::{GpuEdge, GpuPush, GpuShallow, Held};
use bevy::{
    asset::RenderAssetUsages,
    image::ImageSampler,
    prelude::*,
    render::{
        extract_component::ExtractComponent,
        render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages},
        sync_component::SyncComponent,
    },
};
use freshet_flood::playback::{Moment, PlayedInterval};
use freshet_hydro::shallow_water::Field;
use std::sync::Arc;

/// What is to be done in a frame.
#[derive(Component, Clone, Debug)]
pub(crate) struct ShallowFrame {
    pub work: ShallowWork,
    /// Level (m), depth (m) and velocity (m/s) of every cell; and the slope of the level, and where walls stand above it.
    pub pictures: [AssetId<Image>; 2],
}

/// Who works out the water.
#[derive(Clone, Debug)]
pub(crate) enum ShallowWork {
    /// The stages, which also draw the pictures.
    Gpu(Box<GpuWork>),
    /// The CPU, which has come to this.
    Cpu(Arc<Field>),
    /// Nobody: a stage draws a moment of a flood. The interval is the one that is shown after it, if it is known.
    Played(Arc<Moment>, Option<Arc<PlayedInterval>>),
}

/// Input of the stages.
#[derive(Clone, Debug)]
pub(crate) struct GpuWork {
    pub numbers: GpuShallow,
    /// Time asked for since the state was set, with that of this frame, s.
    pub asked: f64,
    /// Edges of the western, eastern, northern and southern side.
    pub edges: Vec<GpuEdge>,
    /// What bodies do to the water, each cell at most once.
    pub pushes: Vec<GpuPush>,
    /// Cells that bodies are in, by ascending index, with the elevation of the bed itself and of what counts, m.
    pub raised: Vec<(u32, [f32; 2])>,
    /// The state that replaces what the GPU has, unless it has it already.
    pub start: Option<Arc<StartState>>,
    /// Bed, walls and sources that replace what the GPU has.
    pub ground: Option<Arc<Ground>>,
    /// Whether faces have crests.
    pub has_walls: bool,
    /// Whether there are point sources.
    pub has_sources: bool,
    /// Most steps, an even number; 0 if nothing is to be done.
    pub steps: u32,
    /// Where the render world says what it has and hands back what it came to.
    pub held: Arc<Held>,
}

/// A state to begin with.
#[derive(Debug)]
pub(crate) struct StartState {
    /// Counts the states that were set; above 0.
    pub version: u64,
    /// Depth, discharge and carry of every cell.
    pub cells: Vec<Vec4>,
    /// The fastest signal in it, m/s.
    pub fastest: f32,
}

/// What is under and beside the water.
#[derive(Debug)]
pub(crate) struct Ground {
    /// Counts the grounds; above 0.
    pub version: u64,
    /// Elevation of every cell's bed without bodies, m.
    pub bed: Vec<f32>,
    /// Crests of the eastern and southern face (m) and the point sources (m/s) of every cell; empty if there are neither.
    pub extras: Vec<Vec4>,
}

impl SyncComponent for ShallowFrame {
    type Target = ShallowFrame;
}

impl ExtractComponent for ShallowFrame {
    type QueryData = &'static ShallowFrame;
    type QueryFilter = ();
    type Out = ShallowFrame;

    fn extract_component(frame: &ShallowFrame) -> Option<ShallowFrame> {
        Some(frame.clone())
    }
}

/// Most levels of a picture.
const MOST_LEVELS: u32 = 6;

/// The pictures of a simulation of so many cells, each with coarser levels.
pub(super) fn pictures(size: UVec2) -> [Image; 2] {
    let picture = |label, format| {
        let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
        let mut image = Image::new_uninit(extent, TextureDimension::D2, format, RenderAssetUsages::all());
        image.texture_descriptor.label = Some(label);
        image.texture_descriptor.mip_level_count = (size.min_element().max(1).ilog2() + 1).min(MOST_LEVELS);
        image.texture_descriptor.usage = TextureUsages::STORAGE_BINDING
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_DST
            | TextureUsages::COPY_SRC;
        image.sampler = ImageSampler::linear();
        image
    };
    [
        picture("water_simulated", TextureFormat::Rgba32Float),
        picture("water_simulated_slopes", TextureFormat::Rgba16Float),
    ]
}
