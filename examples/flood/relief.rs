//! Normals of the ground in a texture: tiles of all levels are lit alike, so that none is seen to change.
use crate::{paint::TerrainMaterial, texture, viewer::Viewer};
use bevy::{
    prelude::*,
    render::render_resource::TextureFormat,
    tasks::{AsyncComputeTaskPool, Task, block_on},
};
use freshet_flood::terrain::normals;
use freshet_hydro::grid::Grid;
use std::sync::Arc;

/// The texture of normals, and for which exaggeration it is.
#[derive(Resource)]
pub struct Relief {
    texture: Handle<Image>,
    exaggeration: f32,
    making: Option<(f32, Task<Image>)>,
}

/// A unit vector, each of x, y and z as ½ + ½ n on 10 bits: a slope of 0.2 % is a step.
#[derive(Clone, Copy)]
struct Packed(u32);

impl Packed {
    fn new(normal: Vec3) -> Self {
        let bits = (normal * 0.5 + 0.5).clamp(Vec3::ZERO, Vec3::ONE) * 1023.0 + 0.5;
        let [x, y, z] = [bits.x as u32, bits.y as u32, bits.z as u32];
        Self(x | y << 10 | z << 20 | 3 << 30)
    }
}

impl texture::Pixel for Packed {
    const FORMAT: TextureFormat = TextureFormat::Rgb10a2Unorm;

    fn mean(pixels: [Self; 4]) -> Self {
        let channel = |shift: u32| pixels.iter().map(|pixel| pixel.0 >> shift & 1023).sum::<u32>() / 4;
        Self(channel(0) | channel(10) << 10 | channel(20) << 20 | 3 << 30)
    }

    fn bytes(self) -> [u8; 4] {
        self.0.to_le_bytes()
    }
}

impl Relief {
    /// `normals` are those of the terrain.
    pub fn new(viewer: &Viewer, normals: &Grid<Vec3>, step: u32, images: &mut Assets<Image>) -> Self {
        let texture = images.add(texture_of(normals, step, viewer.exaggeration));
        Self { texture, exaggeration: viewer.exaggeration, making: None }
    }

    pub fn texture(&self) -> &Handle<Image> {
        &self.texture
    }
}

/// Normals of every `step`-th cell of a terrain that is `exaggeration` times as high: east, south and up, as the tangents of tiles point.
fn texture_of(normals: &Grid<Vec3>, step: u32, exaggeration: f32) -> Image {
    let size = (normals.size() + (step - 1)) / step;
    let pixel = |at: UVec2| {
        let normal = normals.get(at * step).copied().unwrap_or(Vec3::Y);
        Packed::new(vec3(normal.x * exaggeration, normal.z * exaggeration, normal.y).normalize())
    };
    texture::smooth(size, texture::by_row(size, pixel))
}

/// Follows the exaggeration: the normals of another one are made in the background.
pub fn follow(
    viewer: Res<Viewer>,
    mut relief: ResMut<Relief>,
    land: Res<crate::land::Land>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<TerrainMaterial>>,
) {
    if let Some((exaggeration, task)) = relief.making.take_if(|(_, task)| task.is_finished()) {
        relief.exaggeration = exaggeration;
        if images.insert(relief.texture.id(), block_on(task)).is_ok()
            && let Some(mut material) = materials.get_mut(&land.lit)
        {
            // A new texture wants a new bind group.
            material.base.normal_map_texture = Some(relief.texture.clone());
        }
    }
    if relief.making.is_none() && relief.exaggeration != viewer.exaggeration {
        let (terrain, step, exaggeration): (Arc<_>, _, _) = (viewer.terrain.clone(), land.step, viewer.exaggeration);
        let task = AsyncComputeTaskPool::get().spawn(async move { texture_of(&normals(&terrain), step, exaggeration) });
        relief.making = Some((exaggeration, task));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use texture::Pixel;

    #[test]
    fn normals_come_back_as_the_shader_reads_them() {
        for normal in [vec3(0.0, 0.0, 1.0), vec3(0.3, -0.2, 0.9).normalize(), vec3(-0.7, 0.1, 0.4).normalize()] {
            let Packed(bits) = Packed::new(normal);
            let read = [0, 10, 20].map(|shift| (bits >> shift & 1023) as f32 / 1023.0 * 2.0 - 1.0);
            assert!(Vec3::from_array(read).distance(normal) < 2e-3, "{normal}: {read:?}");
        }
        let mean = Packed::mean([Packed::new(Vec3::Z); 4]);
        assert_eq!(mean.bytes(), Packed::new(Vec3::Z).bytes());
    }
}
