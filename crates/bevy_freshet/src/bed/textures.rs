//! Mip levels for ground textures, and a colour for those that are missing.
use super::{BedDrawing, BedMaterial, BedShading};
use crate::report::Reported;
use bevy::{
    asset::{LoadState, RenderAssetUsages},
    image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor},
    platform::collections::{HashMap, HashSet},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

/// Which textures have their mip levels, and the plain ones that stand in for missing ones.
#[derive(Resource, Default)]
pub(super) struct PreparedTextures {
    done: HashSet<AssetId<Image>>,
    plain: HashMap<[u8; 4], Handle<Image>>,
}

/// sRGB colour and relief height of mud, sand and grass without a texture: the means of the project's own.
const PLAIN: [[u8; 4]; 3] = [[95, 87, 75, 128], [176, 165, 145, 128], [91, 98, 57, 128]];

/// Hands each bed's textures to its material as soon as they are loaded and have mip levels.
pub(super) fn prepare_textures(
    assets: Res<AssetServer>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<BedMaterial>>,
    mut prepared: ResMut<PreparedTextures>,
    mut reported: ResMut<Reported>,
    beds: Query<(Entity, &BedShading, &BedDrawing)>,
) {
    for (entity, shading, drawing) in &beds {
        let fields = ["BedShading::mud", "BedShading::sand", "BedShading::grass"];
        let textures = [&shading.mud, &shading.sand, &shading.grass];
        let layers: [Handle<Image>; 3] = core::array::from_fn(|i| {
            let texture = textures[i].as_ref();
            if let Some(LoadState::Failed(error)) = texture.map(|texture| assets.load_state(texture)) {
                reported.warn(entity, fields[i], format_args!("cannot be loaded ({error}); a plain colour is used"));
            }
            let ready = texture.filter(|texture| prepare(texture, &mut images, &mut prepared.done));
            ready.cloned().unwrap_or_else(|| prepared.plain(PLAIN[i], &mut images))
        });
        let Some(material) = materials.get(&drawing.0) else { continue };
        let now = [&material.extension.mud, &material.extension.sand, &material.extension.grass];
        if now.iter().zip(&layers).any(|(now, layer)| now.as_ref() != Some(layer))
            && let Some(mut material) = materials.get_mut(&drawing.0)
        {
            let [mud, sand, grass] = layers;
            let extension = &mut material.extension;
            (extension.mud, extension.sand, extension.grass) = (Some(mud), Some(sand), Some(grass));
        }
    }
}

/// Whether the texture is loaded; gives it mip levels and lets it tile the first time it is.
fn prepare(texture: &Handle<Image>, images: &mut Assets<Image>, done: &mut HashSet<AssetId<Image>>) -> bool {
    if done.contains(&texture.id()) {
        return true;
    }
    let Some(mut image) = images.get_mut(texture) else { return false };
    image.sampler = tiling();
    add_mip_levels(&mut image);
    done.insert(texture.id());
    true
}

impl PreparedTextures {
    fn plain(&mut self, texel: [u8; 4], images: &mut Assets<Image>) -> Handle<Image> {
        let make = || {
            let (extent, format) = (Extent3d::default(), TextureFormat::Rgba8UnormSrgb);
            let usage = RenderAssetUsages::RENDER_WORLD;
            let mut image = Image::new_fill(extent, TextureDimension::D2, &texel, format, usage);
            image.sampler = tiling();
            images.add(image)
        };
        self.plain.entry(texel).or_insert_with(make).clone()
    }
}

fn tiling() -> ImageSampler {
    ImageSampler::Descriptor(ImageSamplerDescriptor {
        label: Some("bed".into()),
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    })
}

/// Appends all mip levels to an 8-bit sRGB image that has one, averaging light rather than codes. Images of other
/// formats, or with levels already, stay as they are.
pub(crate) fn add_mip_levels(image: &mut Image) {
    let descriptor = &image.texture_descriptor;
    let (mut width, mut height) = (image.width() as usize, image.height() as usize);
    if descriptor.format != TextureFormat::Rgba8UnormSrgb || descriptor.mip_level_count > 1 {
        return;
    }
    let Some(data) = &mut image.data else { return };
    let mut level: Vec<Vec4> = data.chunks_exact(4).map(|t| linear([t[0], t[1], t[2], t[3]])).collect();
    let mut levels = 1;
    while width > 1 || height > 1 {
        level = halved(&level, width, height);
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
        data.extend(level.iter().flat_map(|&texel| encoded(texel)));
        levels += 1;
    }
    image.texture_descriptor.mip_level_count = levels;
}

fn linear([r, g, b, a]: [u8; 4]) -> Vec4 {
    let color = LinearRgba::from(Srgba::rgba_u8(r, g, b, a));
    color.to_vec4()
}

fn encoded(texel: Vec4) -> [u8; 4] {
    Srgba::from(LinearRgba::from_vec4(texel)).to_u8_array()
}

fn halved(level: &[Vec4], width: usize, height: usize) -> Vec<Vec4> {
    let (half_width, half_height) = ((width / 2).max(1), (height / 2).max(1));
    let texel = |x: usize, y: usize| level[y.min(height - 1) * width + x.min(width - 1)];
    (0..half_width * half_height)
        .map(|i| (2 * (i % half_width), 2 * (i / half_width)))
        .map(|(x, y)| (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)) * 0.25)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mip_levels_keep_the_mean_light() {
        let extent = Extent3d { width: 4, height: 2, depth_or_array_layers: 1 };
        let data = [[0, 0, 0, 0], [255, 255, 255, 255]].concat().repeat(4);
        let usage = RenderAssetUsages::default();
        let mut image = Image::new(extent, TextureDimension::D2, data, TextureFormat::Rgba8UnormSrgb, usage);
        add_mip_levels(&mut image);
        assert_eq!(image.texture_descriptor.mip_level_count, 3);
        let data = image.data.unwrap();
        assert_eq!(data.len(), 4 * (8 + 2 + 1));
        // Half of the light is the sRGB code 188, not 128; the height in alpha is averaged as it stands.
        assert_eq!(data[40..], [188, 188, 188, 128]);
    }
}
