//! Numbers as pixels of 16 bits.

use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use freshet_hydro::grid::Grid;
use glam::{UVec2, Vec3};
use png::{BitDepth, ColorType};
use rayon::prelude::*;

use super::MapsError;

/// What pixels mean: offset + scale · pixel, 0 being empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub scale: f64,
    pub offset: f64,
}

/// The greatest depth in metres that 16 bits hold at a precision, which is used no coarser than the threshold.
pub(crate) fn deepest(precision: f64, threshold: f32) -> f64 {
    (f64::from(u16::MAX) - 0.5) * Scale::of_depth(precision, threshold).scale
}

impl Scale {
    /// Pixels for depths: (q − ½) p for the pixel q, with p the greatest quantum up to `precision` that divides the
    /// threshold, which is above 0.
    ///
    /// A depth in [(q − 1) p, q p) becomes q: it errs by at most p / 2, only 0 becomes 0, and no depth passes the threshold,
    /// which is a limit between pixels.
    pub fn of_depth(precision: f64, threshold: f32) -> Self {
        let threshold = f64::from(threshold);
        let parts = (threshold / precision - 1e-6).ceil().max(1.0);
        let scale = threshold / parts;
        Self { scale, offset: -scale / 2.0 }
    }

    /// Pixels for values between the least and the greatest of a raster; `empty` values are left out.
    pub fn of_range(values: &[f32], is_empty: impl Fn(f32) -> bool) -> Self {
        let known = values.iter().copied().filter(|value| value.is_finite() && !is_empty(*value));
        let range = known.fold(None, |range: Option<(f32, f32)>, value| {
            Some(range.map_or((value, value), |(least, most)| (least.min(value), most.max(value))))
        });
        let (least, most) = range.map_or((0.0, 0.0), |(least, most)| (f64::from(least), f64::from(most)));
        let scale = if most > least { (most - least) / f64::from(u16::MAX - 1) } else { 1.0 };
        Self { scale, offset: least - scale }
    }

    /// Pixels of depths, m, none above [`deepest`]. What is not above zero is empty.
    pub fn depths(&self, depths: &[f32], threshold: f32) -> Vec<u16> {
        let limit = f64::from(threshold) / self.scale;
        let pixel = |depth: &f32| {
            if depth.is_nan() || *depth <= 0.0 {
                return 0;
            }
            let pixel = ((f64::from(*depth) / self.scale).floor() + 1.0).min(f64::from(u16::MAX));
            // Division rounds: what is decided is decided by the depth itself.
            let pixel = if *depth >= threshold { pixel.max(limit.round() + 1.0) } else { pixel.min(limit.round()) };
            pixel as u16
        };
        depths.par_iter().map(pixel).collect()
    }

    /// Pixels of other values, rounded by `round` to whole numbers.
    pub fn values(&self, values: &[f32], is_empty: impl Fn(f32) -> bool + Sync, round: fn(f64) -> f64) -> Vec<u16> {
        let pixel = |value: &f32| {
            let pixel = round(((f64::from(*value) - self.offset) / self.scale * 1e6).round() / 1e6);
            if value.is_nan() || is_empty(*value) { 0 } else { pixel.clamp(1.0, f64::from(u16::MAX)) as u16 }
        };
        values.par_iter().map(pixel).collect()
    }

    /// The value of a pixel.
    pub fn value(&self, pixel: u16, empty: f32) -> f32 {
        if pixel == 0 { empty } else { (self.offset + self.scale * f64::from(pixel)) as f32 }
    }
}

/// Writes a 16-bit grey picture.
pub(super) fn write(path: &Path, size: UVec2, pixels: &[u16]) -> Result<(), MapsError> {
    write_samples(path, size, ColorType::Grayscale, pixels.iter().copied())
}

/// Writes normals: see [`super::Manifest::normals`].
pub(super) fn write_normals(path: &Path, normals: &Grid<Vec3>) -> Result<(), MapsError> {
    let sample = |component: f32| (32768.0 + (32767.0 * component).round()) as u16;
    let samples = normals.values().iter().flat_map(|normal| normal.to_array().map(sample));
    write_samples(path, normals.size(), ColorType::Rgb, samples)
}

fn write_samples(
    path: &Path,
    size: UVec2,
    color: ColorType,
    samples: impl Iterator<Item = u16>,
) -> Result<(), MapsError> {
    let bytes: Vec<u8> = samples.flat_map(u16::to_be_bytes).collect();
    let encode = || {
        let mut file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(&mut file, size.x, size.y);
        encoder.set_color(color);
        encoder.set_depth(BitDepth::Sixteen);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        writer.finish()?;
        file.flush()?;
        Ok(())
    };
    encode().map_err(|error| match error {
        png::EncodingError::IoError(source) => MapsError::io(path, source),
        error => MapsError::Picture { path: path.into(), reason: error.to_string() },
    })
}

/// Reads a 16-bit grey picture of `size`.
pub(super) fn read(path: &Path, size: UVec2) -> Result<Vec<u16>, MapsError> {
    read_samples(path, size, ColorType::Grayscale)
}

/// Reads normals: see [`super::Manifest::normals`].
pub(super) fn read_normals(path: &Path, size: UVec2) -> Result<Vec<Vec3>, MapsError> {
    let component = |sample: u16| (f32::from(sample) - 32768.0) / 32767.0;
    let samples = read_samples(path, size, ColorType::Rgb)?;
    let normal = |rgb: &[u16]| Vec3::new(component(rgb[0]), component(rgb[1]), component(rgb[2]));
    Ok(samples.chunks_exact(3).map(|rgb| normal(rgb).normalize_or(Vec3::Y)).collect())
}

fn read_samples(path: &Path, size: UVec2, color: ColorType) -> Result<Vec<u16>, MapsError> {
    let file = File::open(path).map_err(|source| MapsError::io(path, source))?;
    let wrong = |reason: String| MapsError::Picture { path: path.into(), reason };
    let decoding = |error: png::DecodingError| wrong(error.to_string());
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().map_err(decoding)?;
    let found = UVec2::from(reader.info().size());
    if found != size {
        return Err(MapsError::Size { path: path.into(), found, expected: size });
    }
    if reader.output_color_type() != (color, BitDepth::Sixteen) {
        let color = if color == ColorType::Rgb { "RGB" } else { "grey" };
        return Err(wrong(format!("expected 16-bit {color}")));
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    reader.next_frame(&mut bytes).map_err(decoding)?;
    Ok(bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn depths_err_by_half_a_quantum_and_stay_on_their_side(
            depth in prop_oneof![0.0_f32..0.05, 0.0_f32..30.0, Just(0.02_f32), Just(0.0), Just(f32::NAN)],
            precision in prop_oneof![Just(0.001), 0.0006_f64..0.3],
            threshold in prop_oneof![Just(0.02_f32), 0.001_f32..0.2],
        ) {
            let scale = Scale::of_depth(precision, threshold);
            let back = scale.value(scale.depths(&[depth], threshold)[0], 0.0);
            prop_assert!(scale.scale <= precision * 1.000_01);
            if depth > 0.0 {
                prop_assert!(f64::from((back - depth).abs()) <= scale.scale / 2.0 + 2e-6, "{depth} {back}");
                prop_assert!(back > 0.0 && (back >= threshold) == (depth >= threshold), "{depth} {back}");
            } else {
                prop_assert_eq!(back, 0.0);
            }
        }

        #[test]
        fn ranges_hold_their_ends(least in -100.0_f32..100.0, width in 0.0_f32..500.0, share in 0.0_f32..=1.0) {
            let values = [least, least + width, least + share * width, f32::NAN];
            let scale = Scale::of_range(&values, |_| false);
            let pixels = scale.values(&values, |_| false, f64::round);
            for (value, pixel) in values.iter().zip(&pixels).take(3) {
                let error = f64::from((scale.value(*pixel, f32::NAN) - value).abs());
                prop_assert!(error <= 0.5 * scale.scale.min(f64::from(width)) + 1e-4, "{value} {pixel}");
            }
            prop_assert_eq!(pixels[3], 0);
        }
    }
}
