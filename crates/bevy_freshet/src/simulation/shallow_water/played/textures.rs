//! What is known of the steps of a flood, in textures.
use bevy::{
    prelude::*,
    render::{
        render_resource::{
            Extent3d, Origin3d, TexelCopyBufferLayout, Texture, TextureDescriptor, TextureDimension, TextureFormat,
            TextureUsages, TextureView,
        },
        renderer::{RenderDevice, RenderQueue},
    },
};
use freshet_flood::playback::{Ground, PlayedInterval, PlayedStep};
use std::sync::Arc;

/// What a texture is filled with, row by row.
pub(super) trait Texels {
    const LABEL: &'static str;
    const FORMAT: TextureFormat;
    /// All texels.
    fn bytes(&self) -> &[u8];
}

impl Texels for Ground {
    const LABEL: &'static str = "water_flood_ground";
    const FORMAT: TextureFormat = TextureFormat::R32Float;

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.elevations)
    }
}

impl Texels for PlayedStep {
    const LABEL: &'static str = "water_flood_step";
    const FORMAT: TextureFormat = TextureFormat::Rg32Uint;

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.cells)
    }
}

impl Texels for PlayedInterval {
    const LABEL: &'static str = "water_flood_turns";
    const FORMAT: TextureFormat = TextureFormat::R32Float;

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.turn)
    }
}

/// Textures of one size, each filled with something.
pub(super) struct Textures<T> {
    size: UVec2,
    textures: Vec<Filled<T>>,
}

struct Filled<T> {
    texture: Texture,
    view: TextureView,
    source: Arc<T>,
    /// Rows that are there.
    rows: u32,
}

impl<T: Texels> Textures<T> {
    pub fn new(size: UVec2) -> Self {
        Self { size, textures: Vec::new() }
    }

    /// Makes room for what is `wanted` in place of what is not.
    pub fn keep(&mut self, wanted: &[&Arc<T>], device: &RenderDevice) {
        let is_wanted = |source: &Arc<T>| wanted.iter().any(|wanted| Arc::ptr_eq(wanted, source));
        for &source in wanted {
            if self.textures.iter().any(|filled| Arc::ptr_eq(&filled.source, source)) {
                continue;
            }
            match self.textures.iter_mut().find(|filled| !is_wanted(&filled.source)) {
                Some(filled) => (filled.source, filled.rows) = (source.clone(), 0),
                None => self.textures.push(Filled::new(source.clone(), self.size, device)),
            }
        }
    }

    /// The texture of `source`, all of it there.
    pub fn view(&mut self, source: &Arc<T>, queue: &RenderQueue) -> Option<&TextureView> {
        let mut all = usize::MAX;
        self.fill(source, &mut all, queue);
        self.textures.iter().find(|filled| Arc::ptr_eq(&filled.source, source)).map(|filled| &filled.view)
    }

    /// Rows of `source` that are there.
    #[cfg(test)]
    pub fn rows(&self, source: &Arc<T>) -> u32 {
        self.textures.iter().find(|filled| Arc::ptr_eq(&filled.source, source)).map_or(0, |filled| filled.rows)
    }

    /// Fills the texture of `source` as far as so many bytes go.
    pub fn fill(&mut self, source: &Arc<T>, bytes: &mut usize, queue: &RenderQueue) {
        if let Some(filled) = self.textures.iter_mut().find(|filled| Arc::ptr_eq(&filled.source, source)) {
            filled.fill(self.size, bytes, queue);
        }
    }
}

impl<T: Texels> Filled<T> {
    fn new(source: Arc<T>, size: UVec2, device: &RenderDevice) -> Self {
        let texture = device.create_texture(&TextureDescriptor {
            label: Some(T::LABEL),
            size: Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: T::FORMAT,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
            view_formats: &[],
        });
        Self { view: texture.create_view(&default()), texture, source, rows: 0 }
    }

    fn fill(&mut self, size: UVec2, budget: &mut usize, queue: &RenderQueue) {
        let bytes = self.source.bytes();
        let row = bytes.len() / size.y as usize;
        let rows = (size.y - self.rows).min(u32::try_from(*budget / row.max(1)).unwrap_or(u32::MAX));
        if rows == 0 || row == 0 {
            return;
        }
        let start = self.rows as usize * row;
        let mut place = self.texture.as_image_copy();
        place.origin = Origin3d { y: self.rows, ..default() };
        queue.write_texture(
            place,
            &bytes[start..start + rows as usize * row],
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None },
            Extent3d { width: size.x, height: rows, depth_or_array_layers: 1 },
        );
        self.rows += rows;
        *budget -= rows as usize * row;
    }
}
