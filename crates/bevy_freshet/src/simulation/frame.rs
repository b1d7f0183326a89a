//! What is to be done for the fields of a water in a frame, as the render world gets it.
use super::{FieldWindow, numbers::GpuNumbers, tiles::GpuDeposits};
use crate::surface::GpuSurface;
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
use std::sync::{Arc, atomic::AtomicU64};

/// What is to be done in a frame.
#[derive(Component, Clone, Debug, Default)]
pub(crate) enum FieldFrame {
    /// Nothing.
    #[default]
    Idle,
    /// Nothing, and nothing is kept.
    Off,
    /// The stages run.
    Work(Box<FieldWork>),
}

/// Input of the stages for a frame; in the render world it is there only while there is something to do.
#[derive(Clone, Debug)]
pub(crate) struct FieldWork {
    pub window: FieldWindow,
    pub numbers: GpuNumbers,
    pub surface: GpuSurface,
    pub bed: Option<AssetId<Image>>,
    pub flow: Option<AssetId<Image>>,
    pub ice_order: Option<AssetId<Image>>,
    pub simulated: [Option<AssetId<Image>>; 2],
    /// Rings and matter.
    pub pictures: [AssetId<Image>; 2],
    pub deposits: GpuDeposits,
    pub ground: u64,
    pub ring_steps: u32,
    pub transport_steps: u32,
    /// Whether a current carries the rings.
    pub drifts: bool,
    /// Whether there is dye.
    pub is_dyed: bool,
    pub generation: u64,
    /// Where the render world writes the generation that it draws.
    pub drawn: Arc<AtomicU64>,
}

impl SyncComponent for FieldFrame {
    type Target = FieldFrame;
}

impl ExtractComponent for FieldFrame {
    type QueryData = &'static FieldFrame;
    type QueryFilter = ();
    type Out = FieldFrame;

    fn extract_component(frame: &FieldFrame) -> Option<FieldFrame> {
        (!matches!(frame, FieldFrame::Idle)).then(|| frame.clone())
    }
}

/// A picture that the stages draw and the surface's shader reads.
pub(super) fn picture(label: &'static str, size: UVec2) -> Image {
    let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    let usages = RenderAssetUsages::all();
    let mut image = Image::new_uninit(extent, TextureDimension::D2, TextureFormat::Rgba16Float, usages);
    image.texture_descriptor.label = Some(label);
    image.texture_descriptor.usage =
        TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    image.sampler = ImageSampler::linear();
    image
}
