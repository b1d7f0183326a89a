//! What the terrain is covered with: an image where there is one, else tints by height.
use crate::{land::Tints, texture, world_file::Place};
use bevy::{
    math::{DVec2, dvec2},
    prelude::*,
};
use freshet_flood::georeference::Georeference;
use freshet_hydro::grid::Grid;
use image::{RgbaImage, imageops};
use std::{path::Path, sync::Arc};
use zune_jpeg::{
    JpegDecoder,
    zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions},
};

/// An image and where it lies.
pub struct Georeferenced {
    pixels: RgbaImage,
    place: Place,
}

impl Georeferenced {
    /// Reads a PNG or JPEG, and the world file beside it; without one the image lies over all of the map.
    ///
    /// # Errors
    /// The file, what was expected and found.
    pub fn read(path: &Path, map: &Georeference) -> Result<Self, String> {
        let named = |path: &Path, problem: &dyn core::fmt::Display| format!("{}: {problem}", path.display());
        let bytes = std::fs::read(path).map_err(|problem| named(path, &problem))?;
        let pixels = decode(&bytes).map_err(|problem| named(path, &problem))?;
        let size = uvec2(pixels.width(), pixels.height());
        let Some(file) = Place::file(path) else { return Ok(Self { pixels, place: Place::over(map, size) }) };
        let text = std::fs::read_to_string(&file).map_err(|problem| named(&file, &problem))?;
        let place = Place::parse(&text).map_err(|problem| named(&file, &problem))?;
        // The north-western corners of flood and image, then the south-eastern ones.
        let [here, there] = [Place::over(map, UVec2::ONE), place].map(|place| place.north_west);
        let ends = [
            here + map.size.as_dvec2() * map.cell_size * dvec2(1.0, -1.0),
            there + size.as_dvec2() * place.pixel * dvec2(1.0, -1.0),
        ];
        if there.x >= ends[0].x || ends[1].x <= here.x || there.y <= ends[0].y || ends[1].y >= here.y {
            let problem = format!(
                "expected an image that meets the flood from ({}, {}) to ({}, {}), found one from ({}, {}) to ({}, {})",
                here.x, ends[0].y, ends[0].x, here.y, there.x, ends[1].y, ends[1].x, there.y
            );
            return Err(named(&file, &problem));
        }
        Ok(Self { pixels, place })
    }
}

fn decode(bytes: &[u8]) -> Result<RgbaImage, String> {
    if bytes.starts_with(&[0xff, 0xd8]) {
        let options = DecoderOptions::default().jpeg_set_out_colorspace(ColorSpace::RGBA);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
        let pixels = decoder.decode().map_err(|problem| format!("is no readable JPEG: {problem}"))?;
        let size = decoder.dimensions().map(|(width, height)| (width as u32, height as u32));
        let image = size.and_then(|(width, height)| RgbaImage::from_raw(width, height, pixels));
        return image.ok_or_else(|| "is no readable JPEG: its size is not that of its pixels".into());
    }
    if !bytes.starts_with(b"\x89PNG") {
        return Err("expected a PNG or a JPEG, found neither".into());
    }
    let image = image::load_from_memory(bytes).map_err(|problem| format!("is no readable PNG: {problem}"))?;
    Ok(image.to_rgba8())
}

/// What covers the terrain.
pub struct Drape {
    terrain: Arc<Grid<f32>>,
    map: Georeference,
    image: Option<Georeferenced>,
    /// Columns and rows of the texture.
    size: UVec2,
}

impl Drape {
    /// A texture of pixels as small as cells, or those of the image if these are smaller, but of no more than `largest` along a side.
    pub fn new(terrain: &Arc<Grid<f32>>, map: &Georeference, image: Option<Georeferenced>, largest: u32) -> Self {
        let mut drape =
            Self { terrain: terrain.clone(), map: *map, image, size: terrain.size().min(UVec2::splat(largest)) };
        let extent = map.size.as_dvec2() * map.cell_size;
        if let Some(image) = &mut drape.image {
            let wanted = (extent / image.place.pixel).round().as_uvec2().max(terrain.size());
            drape.size = wanted.min(UVec2::splat(largest));
            if drape.size != wanted {
                let pixel = extent / drape.size.as_dvec2();
                warn!(
                    "the image would make a texture of {} × {} pixels; it is drawn with pixels of {:.2} m, not {:.2} m",
                    wanted.x,
                    wanted.y,
                    pixel.max_element(),
                    image.place.pixel.max_element()
                );
                image.shrink((pixel / image.place.pixel).max(DVec2::ONE));
            }
        }
        drape
    }

    /// The texture of the ground in the sun: tints are shaded, images are as they are.
    pub fn texture(&self, tints: &Tints) -> Image {
        let color = |at: UVec2| {
            let share = (at.as_dvec2() + 0.5) / self.size.as_dvec2();
            let image = self.image_at(share);
            image.unwrap_or_else(|| self.tint(share, tints)).extend(1.0)
        };
        let pixels = texture::by_row(self.size, |at| bytes(color(at)));
        texture::smooth(self.size, pixels)
    }

    /// The colours of all cells, shaded.
    pub fn cells(&self, tints: &Tints) -> Vec<[u8; 4]> {
        let size = self.terrain.size();
        texture::by_row(size, |cell| {
            let share = (cell.as_dvec2() + 0.5) / size.as_dvec2();
            let image = self.image_at(share).map(|color| color * tints.shade(cell));
            bytes(image.unwrap_or_else(|| self.tint(share, tints)).extend(1.0))
        })
    }

    /// The shaded tint at a share of the terrain, from its north-west.
    fn tint(&self, share: DVec2, tints: &Tints) -> Vec3 {
        let cell = (share * self.terrain.size().as_dvec2()).as_uvec2();
        let elevation = self.terrain.get(cell).copied().unwrap_or_default();
        tints.tint(elevation) * tints.shade(cell)
    }

    /// The image there, if it is not transparent.
    fn image_at(&self, share: DVec2) -> Option<Vec3> {
        let image = self.image.as_ref()?;
        let extent = self.map.size.as_dvec2() * self.map.cell_size;
        let corner = Place::over(&self.map, UVec2::ONE).north_west;
        let from = (corner - image.place.north_west) * dvec2(1.0, -1.0);
        image.sample((from + share * extent) / image.place.pixel)
    }
}

impl Georeferenced {
    /// The colour at a place in pixels from the north-western corner, bilinear; `None` outside, and where most of it is transparent.
    fn sample(&self, place: DVec2) -> Option<Vec3> {
        let size = uvec2(self.pixels.width(), self.pixels.height());
        if place.cmplt(DVec2::ZERO).any() || place.cmpge(size.as_dvec2()).any() {
            return None;
        }
        let last = size - 1;
        let at = (place - 0.5).clamp(DVec2::ZERO, last.as_dvec2());
        let low = at.as_uvec2();
        let (high, share) = ((low + 1).min(last), (at - low.as_dvec2()).as_vec2());
        let pixel = |x: u32, y: u32| Vec4::from_array(self.pixels.get_pixel(x, y).0.map(f32::from)) / 255.0;
        let north = pixel(low.x, low.y).lerp(pixel(high.x, low.y), share.x);
        let south = pixel(low.x, high.y).lerp(pixel(high.x, high.y), share.x);
        let color = north.lerp(south, share.y);
        (color.w >= 0.5).then(|| color.xyz())
    }

    /// Makes pixels `factor` times as large.
    fn shrink(&mut self, factor: DVec2) {
        let size = uvec2(self.pixels.width(), self.pixels.height()).as_dvec2();
        let fewer = (size / factor).round().as_uvec2().max(UVec2::ONE);
        self.pixels = imageops::resize(&self.pixels, fewer.x, fewer.y, imageops::FilterType::Triangle);
        self.place.pixel *= size / fewer.as_dvec2();
    }
}

fn bytes(color: Vec4) -> [u8; 4] {
    (color.clamp(Vec4::ZERO, Vec4::ONE) * 255.0 + 0.5).to_array().map(|channel| channel as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red in the west and blue in the east, 4 × 2 pixels, the last of which is transparent.
    fn image() -> RgbaImage {
        let mut image =
            RgbaImage::from_fn(4, 2, |x, _| image::Rgba(if x < 2 { [255, 0, 0, 255] } else { [0, 0, 255, 255] }));
        image.put_pixel(3, 1, image::Rgba([0; 4]));
        image
    }

    #[test]
    fn an_image_is_where_its_world_file_says() {
        let terrain = Arc::new(Grid::new(uvec2(4, 4), 2.0, vec![1.0; 16]).unwrap());
        let map = Georeference { corner: dvec2(100.0, 50.0), cell_size: 2.0, size: uvec2(4, 4) };
        // Its pixels are those of the two southern rows.
        let place = Place { north_west: dvec2(100.0, 54.0), pixel: dvec2(2.0, 2.0) };
        let drape = Drape::new(&terrain, &map, Some(Georeferenced { pixels: image(), place }), 64);
        let at = |x: f64, y: f64| drape.image_at(dvec2(x, y));
        assert_eq!(at(0.1, 0.3), None);
        assert_eq!((at(0.125, 0.625), at(0.875, 0.625)), (Some(Vec3::X), Some(Vec3::Z)));
        assert_eq!(at(0.9, 0.9), None);
    }

    #[test]
    fn large_images_are_shrunk() {
        let terrain = Arc::new(Grid::new(uvec2(2, 2), 2.0, vec![1.0; 4]).unwrap());
        let map = Georeference { corner: dvec2(0.0, 0.0), cell_size: 2.0, size: uvec2(2, 2) };
        let pixels = RgbaImage::from_pixel(64, 32, image::Rgba([255, 0, 0, 255]));
        let place = Place::over(&map, uvec2(64, 32));
        let drape = Drape::new(&terrain, &map, Some(Georeferenced { pixels, place }), 16);
        assert_eq!(drape.size, uvec2(16, 16));
        let image = drape.image.as_ref().unwrap();
        assert_eq!((image.pixels.dimensions(), image.place.pixel), ((16, 16), dvec2(0.25, 0.25)));
        assert_eq!(drape.image_at(dvec2(0.99, 0.99)), Some(Vec3::X));
    }

    #[test]
    fn other_files_are_refused() {
        assert_eq!(decode(b"GIF89a").unwrap_err(), "expected a PNG or a JPEG, found neither");
        assert!(decode(b"\x89PNG\r\n\x1a\n").unwrap_err().contains("no readable PNG"));
        assert!(decode(&[0xff, 0xd8, 0xff]).unwrap_err().contains("no readable JPEG"));
    }
}
