//! GeoTIFF files as GIS programs write them, as they should not be, and as noise.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::io::Cursor;
use std::path::Path;

use freshet_flood::geotiff::{self, GeoTiffFault};
use freshet_flood::raster::{Format, Raster};
use glam::{UVec2, dvec2, uvec2};
use proptest::prelude::*;
use tiff::encoder::colortype::{
    ColorType, Gray8, Gray16, Gray32, Gray32Float, Gray64Float, GrayI8, GrayI16, GrayI32, RGB8,
};
use tiff::encoder::{Compression, TiffEncoder, TiffValue};
use tiff::tags::Tag;

/// Cells of 5 m whose north-western corner is at (100, 220).
const SCALE: [f64; 3] = [5.0, 5.0, 0.0];
const TIE_POINT: [f64; 6] = [0.0, 0.0, 0.0, 100.0, 220.0, 0.0];

/// A file with tags of doubles, `GDAL_NODATA` and a directory of keys.
#[derive(Clone, Default)]
struct File<'a> {
    doubles: Vec<(Tag, &'a [f64])>,
    no_data: Option<&'a str>,
    keys: &'a [u16],
    compression: Compression,
    is_big: bool,
}

impl File<'_> {
    fn of<C: ColorType>(&self, size: UVec2, values: &[C::Inner]) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        macro_rules! write {
            ($encoder:expr) => {{
                let mut encoder = $encoder.unwrap().with_compression(self.compression);
                let mut image = encoder.new_image::<C>(size.x, size.y).unwrap();
                for (tag, doubles) in &self.doubles {
                    image.encoder().write_tag(*tag, *doubles).unwrap();
                }
                if let Some(no_data) = self.no_data {
                    image.encoder().write_tag(Tag::GdalNodata, no_data).unwrap();
                }
                if !self.keys.is_empty() {
                    image.encoder().write_tag(Tag::GeoKeyDirectoryTag, self.keys).unwrap();
                }
                image.write_data(values).unwrap();
            }};
        }
        let mut bytes = Cursor::new(Vec::new());
        match self.is_big {
            true => write!(TiffEncoder::new_big(&mut bytes)),
            false => write!(TiffEncoder::new(&mut bytes)),
        }
        bytes.into_inner()
    }
}

fn placed() -> File<'static> {
    let doubles: Vec<(Tag, &[f64])> = vec![(Tag::ModelPixelScaleTag, &SCALE), (Tag::ModelTiepointTag, &TIE_POINT)];
    File { doubles, ..Default::default() }
}

fn read(bytes: &[u8]) -> Raster {
    geotiff::read_raster(Cursor::new(bytes)).unwrap()
}

fn message(bytes: &[u8]) -> String {
    geotiff::read_raster(Cursor::new(bytes)).unwrap_err().to_string()
}

const SIZE: UVec2 = uvec2(3, 2);
const VALUES: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

#[test]
fn the_north_western_row_is_first_and_the_corner_is_south_western() {
    let raster = read(&placed().of::<Gray32Float>(SIZE, &VALUES));
    let place = raster.georeference;
    assert_eq!((place.corner, place.cell_size, place.size), (dvec2(100.0, 210.0), 5.0, SIZE));
    assert_eq!((raster.grid.values(), raster.grid.cell_size()), (&VALUES[..], 5.0));
}

#[test]
fn values_of_every_kind_are_read() {
    let file = placed();
    for bytes in [
        file.of::<Gray64Float>(SIZE, &VALUES.map(f64::from)),
        file.of::<Gray8>(SIZE, &VALUES.map(|value| value as u8)),
        file.of::<Gray16>(SIZE, &VALUES.map(|value| value as u16)),
        file.of::<Gray32>(SIZE, &VALUES.map(|value| value as u32)),
        file.of::<GrayI8>(SIZE, &VALUES.map(|value| value as i8)),
        file.of::<GrayI16>(SIZE, &VALUES.map(|value| value as i16)),
        file.of::<GrayI32>(SIZE, &VALUES.map(|value| value as i32)),
        File { is_big: true, ..placed() }.of::<Gray32Float>(SIZE, &VALUES),
        File { compression: Compression::Lzw, ..placed() }.of::<Gray32Float>(SIZE, &VALUES),
        File { compression: Compression::Packbits, ..placed() }.of::<Gray32Float>(SIZE, &VALUES),
        File { compression: Compression::Deflate(Default::default()), ..placed() }.of::<Gray32Float>(SIZE, &VALUES),
    ] {
        assert_eq!(read(&bytes).grid.values(), VALUES);
    }
    let below_zero = read(&file.of::<GrayI16>(SIZE, &[-1, -300, 0, 1, 2, 3]));
    assert_eq!(below_zero.grid.values()[..2], [-1.0, -300.0]);
}

/// Files that GDAL 3 wrote: 40 × 24 cells with the value ¼ column − 1½ row, of which one has no data. Whole numbers are four times that.
#[test]
fn files_with_tiles_and_predictors_are_read_as_gdal_writes_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/geotiffs");
    for (name, factor) in [
        ("tiles_deflate_predictor_3.tif", 1.0),
        ("tiles_lzw_predictor_3.tif", 1.0),
        ("strips_deflate_predictor_2_i16.tif", 4.0),
        ("cog.tif", 1.0),
    ] {
        let raster = geotiff::read(folder.join(name)).unwrap();
        let place = raster.georeference;
        assert_eq!((place.corner, place.cell_size, place.size), (dvec2(100.0, 100.0), 5.0, uvec2(40, 24)), "{name}");
        for (cell, value) in raster.grid.cells().zip(raster.grid.values()) {
            let expected = factor * (0.25 * cell.x as f32 - 1.5 * cell.y as f32);
            match cell == uvec2(5, 3) {
                true => assert!(value.is_nan(), "{name}"),
                false => assert_eq!(*value, expected, "{name}: {cell}"),
            }
        }
    }
}

#[test]
fn every_spelling_of_a_place_is_the_same() {
    let expected = read(&placed().of::<Gray32Float>(SIZE, &VALUES)).georeference;
    let matrix = [5.0, 0.0, 0.0, 100.0, 0.0, -5.0, 0.0, 220.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    // The same place by another pixel, and by the middle of a pixel.
    let other = [2.0, 1.0, 0.0, 110.0, 215.0, 0.0];
    let middle = [0.0, 0.0, 0.0, 102.5, 217.5, 0.0];
    let point = [1, 1, 0, 2, 1024, 0, 1, 1, 1025, 0, 1, 2];
    let area = [1, 1, 0, 1, 1025, 0, 1, 1];
    let scaled = |tie_point| vec![(Tag::ModelPixelScaleTag, &SCALE[..]), (Tag::ModelTiepointTag, tie_point)];
    for file in [
        File { doubles: vec![(Tag::ModelTransformationTag, &matrix)], ..Default::default() },
        File { doubles: scaled(&other), ..Default::default() },
        File { doubles: scaled(&middle), keys: &point, ..Default::default() },
        File { keys: &area, ..placed() },
    ] {
        assert_eq!(read(&file.of::<Gray32Float>(SIZE, &VALUES)).georeference, expected);
    }
}

#[test]
fn cells_without_data_are_nan() {
    let is_nan = |file: File, values: [f32; 6]| {
        let raster = read(&file.of::<Gray32Float>(SIZE, &values));
        raster.grid.values().iter().map(|value| value.is_nan()).collect::<Vec<_>>()
    };
    let values = [1.0, -9999.0, f32::NAN, f32::INFINITY, f32::MIN, 0.0];
    assert_eq!(is_nan(placed(), values), [false, false, true, true, false, false]);
    let no_data = |text| File { no_data: Some(text), ..placed() };
    assert_eq!(is_nan(no_data("-9999"), values), [false, true, true, true, false, false]);
    assert_eq!(is_nan(no_data("-9999.0 "), values), [false, true, true, true, false, false]);
    assert_eq!(is_nan(no_data("-3.4028234663852886e+38"), values), [false, false, true, true, true, false]);
    assert_eq!(is_nan(no_data("nan"), values), [false, false, true, true, false, false]);
    let raster = read(&no_data("0").of::<Gray8>(uvec2(2, 1), &[0, 7]));
    assert!(raster.grid.values()[0].is_nan() && raster.grid.values()[1] == 7.0);
}

#[test]
fn errors_say_what_is_needed_and_what_was_found() {
    let file = |doubles| File { doubles, ..Default::default() }.of::<Gray32Float>(SIZE, &VALUES);
    let turned = [4.0, 3.0, 0.0, 100.0, 3.0, -4.0, 0.0, 220.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let south_up = [5.0, 0.0, 0.0, 100.0, 0.0, 5.0, 0.0, 220.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let scale = |scale| vec![(Tag::ModelPixelScaleTag, scale), (Tag::ModelTiepointTag, &TIE_POINT[..])];
    let several = TIE_POINT.repeat(4);
    let plain = placed().of::<Gray32Float>(SIZE, &VALUES);
    for (bytes, expected) in [
        (placed().of::<RGB8>(uvec2(1, 1), &[1, 2, 3]), "expected a raster of one band, found RGB(8)"),
        (file(vec![]), "none: this is a TIFF file but no GeoTIFF file"),
        (file(scale(&[5.0, 4.0, 0.0])), "expected square cells, found cells of 5 × 4"),
        (file(scale(&[0.0, 0.0, 0.0])), "expected cells above zero in size, north up, found cells of 0 × 0"),
        (file(scale(&[f64::NAN, 1.0, 0.0])), "expected cells above zero in size, north up, found cells of NaN × 1"),
        (
            file(vec![(Tag::ModelTransformationTag, &turned)]),
            "expected a raster along the axes of the map, found one turned",
        ),
        (file(vec![(Tag::ModelTransformationTag, &south_up)]), "expected square cells, found cells of 5 × -5"),
        (
            file(vec![(Tag::ModelPixelScaleTag, &SCALE), (Tag::ModelTiepointTag, &several)]),
            "expected one tie point of 6 numbers, found 24 numbers",
        ),
        (
            File { no_data: Some("none"), ..placed() }.of::<Gray32Float>(SIZE, &VALUES),
            "expected a number in GDAL_NODATA, found “none”",
        ),
        (b"GIF89a".to_vec(), "not a TIFF file that can be read: "),
        (Vec::new(), "not a TIFF file that can be read: "),
        (plain[..plain.len() / 2].to_vec(), ""),
    ] {
        let message = message(&bytes);
        assert!(message.contains(expected), "{message}");
    }
}

/// The place in a little-endian file of the value of a tag of one short or long number.
fn value_of(tag: Tag, bytes: &[u8]) -> usize {
    let start = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let count = usize::from(u16::from_le_bytes(bytes[start..start + 2].try_into().unwrap()));
    let entries = (0..count).map(|entry| start + 2 + 12 * entry);
    let tag = tag.to_u16().to_le_bytes();
    entries.into_iter().find(|entry| bytes[*entry..entry + 2] == tag).unwrap() + 8
}

#[test]
fn a_huge_claim_costs_no_memory() {
    let mut bytes = placed().of::<Gray32Float>(SIZE, &VALUES);
    for tag in [Tag::ImageWidth, Tag::ImageLength] {
        let place = value_of(tag, &bytes);
        bytes[place..place + 4].copy_from_slice(&40_000_u32.to_le_bytes());
    }
    let error = geotiff::read_raster(Cursor::new(&bytes)).unwrap_err();
    assert!(matches!(error, GeoTiffFault::Unexpected { .. }), "{error}");
    let expected = format!("found 40000 × 40000 values of 32 bits in {} bytes", bytes.len());
    assert!(error.to_string().contains(&expected), "{error}");
}

#[test]
fn files_are_named_in_errors() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("geotiff.anything");
    std::fs::write(&path, placed().of::<Gray32Float>(SIZE, &VALUES)).unwrap();
    assert_eq!(Format::of(&path).unwrap(), Format::GeoTiff);
    assert_eq!(Raster::read(&path).unwrap(), geotiff::read(&path).unwrap());
    std::fs::write(&path, File::default().of::<Gray32Float>(SIZE, &VALUES)).unwrap();
    assert!(Raster::read(&path).unwrap_err().to_string().contains("geotiff.anything: expected a place on the map"));
    assert!(geotiff::read(folder.join("no_such.tif")).unwrap_err().to_string().contains("no_such.tif: No such file"));
}

fn value() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -100.0_f32..100.0,
        1 => any::<f32>().prop_filter("infinite is no data", |value| !value.is_infinite()),
        1 => Just(f32::NAN),
    ]
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(
        (size, values) in (1_u32..40, 1_u32..40).prop_flat_map(|(x, y)| {
            (Just(uvec2(x, y)), prop::collection::vec(value(), (x * y) as usize))
        }),
        cell_size in 0.01_f64..1000.0,
        (x, y) in (-1e7..1e7_f64, -1e7..1e7_f64),
        packing in 0..4,
    ) {
        let compression = match packing {
            0 => Compression::Uncompressed,
            1 => Compression::Lzw,
            2 => Compression::Packbits,
            _ => Compression::Deflate(Default::default()),
        };
        let scale = [cell_size, cell_size, 0.0];
        let tie_point = [0.0, 0.0, 0.0, x, y, 0.0];
        let doubles: Vec<(Tag, &[f64])> = vec![(Tag::ModelPixelScaleTag, &scale), (Tag::ModelTiepointTag, &tie_point)];
        let raster = read(&File { doubles, compression, ..Default::default() }.of::<Gray32Float>(size, &values));
        let place = raster.georeference;
        prop_assert_eq!((place.size, place.cell_size), (size, cell_size));
        prop_assert_eq!(place.corner, dvec2(x, y - cell_size * f64::from(size.y)));
        for (read, value) in raster.grid.values().iter().zip(&values) {
            prop_assert!(read == value || read.is_nan() && value.is_nan());
        }
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 1..20), at in 0_usize..400) {
        let file = File { compression: Compression::Lzw, no_data: Some("-9999"), ..placed() };
        let mut spoilt = file.of::<Gray32Float>(SIZE, &VALUES);
        for (spoilt, noise) in spoilt.iter_mut().skip(at).zip(&bytes) {
            *spoilt = *noise;
        }
        let _ = geotiff::read_raster(Cursor::new(&spoilt));
        let _ = geotiff::read_raster(Cursor::new(&bytes));
    }
}
