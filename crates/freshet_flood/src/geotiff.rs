//! GeoTIFF rasters of one band: what GIS programs write terrain and results of models to.
//!
//! Read are integers of 8 to 64 bits and floats, in strips or tiles, plain or packed by deflate, LZW or PackBits, BigTIFF
//! too. The place on the map is that of GeoTIFF 1.1 (OGC 19-008r4): `ModelPixelScale` with one `ModelTiepoint`, or a
//! `ModelTransformation` without rotation, of pixels that are areas or points (section 7.1.2.2). Cells without data are
//! those of the tag `GDAL_NODATA` (42113), NaN, and infinite ones.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use freshet_hydro::grid::Grid;
use glam::{DVec2, UVec2, dvec2};
use thiserror::Error;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use crate::georeference::Georeference;
use crate::raster::Raster;
use crate::text::float;

/// The most bytes that one byte of a file can unpack to: more than LZW's longest string of 12 bits.
const MOST_UNPACKED: u64 = 4096;

/// Key of the directory of keys that says what a pixel is (GeoTIFF 1.1, `GTRasterTypeGeoKey`).
const RASTER_TYPE: u16 = 1025;
/// Its value if the place of a pixel is its middle.
const PIXEL_IS_POINT: u16 = 2;

/// Why a GeoTIFF file cannot be read.
#[derive(Debug, Error)]
#[error("{}: {source}", .path.display())]
pub struct GeoTiffError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub source: GeoTiffFault,
}

/// Why the contents of a GeoTIFF file cannot be read.
#[derive(Debug, Error)]
pub enum GeoTiffFault {
    /// The file cannot be opened or breaks off.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The file is no intact TIFF file, or of a kind that is not read here.
    #[error("not a TIFF file that can be read: {0}")]
    Tiff(TiffError),
    /// The file is a TIFF file but no raster as is needed here.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// What is needed.
        expected: &'static str,
        /// What the file has.
        found: String,
    },
}

impl From<TiffError> for GeoTiffFault {
    fn from(error: TiffError) -> Self {
        match error {
            TiffError::IoError(error) => Self::Io(error),
            error => Self::Tiff(error),
        }
    }
}

fn unexpected(expected: &'static str, found: impl ToString) -> GeoTiffFault {
    GeoTiffFault::Unexpected { expected, found: found.to_string() }
}

/// Reads a file.
///
/// # Errors
/// [`GeoTiffError`], with the file's name, if it cannot be opened or is no GeoTIFF raster of one band with square cells
/// that lie along the axes of the map, north up.
pub fn read(path: impl AsRef<Path>) -> Result<Raster, GeoTiffError> {
    named(path.as_ref(), read_raster)
}

/// Reads where a file lies on the map, without its values.
///
/// # Errors
/// As for [`read`].
pub fn read_georeference(path: impl AsRef<Path>) -> Result<Georeference, GeoTiffError> {
    named(path.as_ref(), |source| georeference(&mut decoder(source)?))
}

fn named<T>(path: &Path, read: impl FnOnce(BufReader<File>) -> Result<T, GeoTiffFault>) -> Result<T, GeoTiffError> {
    let file = File::open(path).map_err(GeoTiffFault::Io);
    file.and_then(|file| read(BufReader::new(file))).map_err(|source| GeoTiffError { path: path.into(), source })
}

/// Reads the contents of a file. Memory holds no more than what a file of that length can hold, whatever it claims.
///
/// # Errors
/// [`GeoTiffFault`] as for [`read`].
pub fn read_raster(source: impl Read + Seek) -> Result<Raster, GeoTiffFault> {
    let mut decoder = decoder(source)?;
    let georeference = georeference(&mut decoder)?;
    let no_data = no_data(&mut decoder)?;
    let mut values = values(decoder.read_image()?);
    for value in &mut values {
        if Some(*value) == no_data || !value.is_finite() {
            *value = f32::NAN;
        }
    }
    let grid = Grid::new(georeference.size, georeference.cell_size as f32, values)
        .map_err(|error| unexpected("a grid", error))?;
    Ok(Raster { georeference, grid })
}

/// The first picture of the file, if it is one band that the file can hold. Later pictures are smaller copies of it.
fn decoder<R: Read + Seek>(mut source: R) -> Result<Decoder<R>, GeoTiffFault> {
    let length = source.seek(SeekFrom::End(0))?;
    source.rewind()?;
    let most = length.saturating_mul(MOST_UNPACKED);
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(most).unwrap_or(usize::MAX);
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let mut decoder = Decoder::new(source)?.with_limits(limits);

    let bits = match decoder.colortype()? {
        ColorType::Gray(bits @ (8 | 16 | 32 | 64)) => bits,
        ColorType::Gray(bits) => return Err(unexpected("values of 8, 16, 32 or 64 bits", format!("{bits} bits"))),
        other => return Err(unexpected("a raster of one band", format!("{other:?}"))),
    };
    let (columns, rows) = decoder.dimensions()?;
    let bytes = u128::from(columns) * u128::from(rows) * u128::from(bits / 8);
    if bytes > u128::from(most) {
        let found = format!("{columns} × {rows} values of {bits} bits in {length} bytes");
        return Err(unexpected("no more values than the file can hold", found));
    }
    Ok(decoder)
}

fn georeference<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<Georeference, GeoTiffFault> {
    let size = UVec2::from(decoder.dimensions()?);
    let (cell, mut north_west) = cell_and_north_west(decoder)?;
    let cell_size = cell.x;
    // Writers round the sides of a cell.
    if (cell.x - cell.y).abs() > 1e-6 * cell_size.abs() {
        return Err(unexpected("square cells", format!("cells of {} × {}", cell.x, cell.y)));
    }
    let is_valid = cell_size > 0.0 && (cell_size as f32).is_normal() && north_west.is_finite();
    if !is_valid {
        let found = format!("cells of {} × {} from {north_west}", cell.x, cell.y);
        return Err(unexpected("cells above zero in size, north up", found));
    }
    if is_point(decoder)? {
        north_west += dvec2(-cell_size, cell_size) / 2.0;
    }
    let corner = north_west - dvec2(0.0, f64::from(size.y) * cell_size);
    Ok(Georeference { corner, cell_size, size })
}

/// The sides of a cell, above zero if north is up, and the place of the first pixel.
fn cell_and_north_west<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<(DVec2, DVec2), GeoTiffFault> {
    let mut numbers = |tag| decoder.find_tag(tag)?.map(|value| value.into_f64_vec()).transpose();
    let scale = numbers(Tag::ModelPixelScaleTag)?;
    let tie_points = numbers(Tag::ModelTiepointTag)?;
    let matrix = numbers(Tag::ModelTransformationTag)?;
    match (scale.as_deref(), tie_points.as_deref(), matrix.as_deref()) {
        (Some(&[x, y, ..]), Some(&[column, row, _, easting, northing, _]), _) => {
            Ok((dvec2(x, y), dvec2(easting - column * x, northing + row * y)))
        }
        (_, _, Some(&[x, b, _, easting, d, y, _, northing, ..])) if b == 0.0 && d == 0.0 => {
            Ok((dvec2(x, -y), dvec2(easting, northing)))
        }
        (_, _, Some(&[_, b, _, _, d, ..])) => Err(unexpected(
            "a raster along the axes of the map",
            format!("one turned by the matrix entries {b} and {d}"),
        )),
        (Some(_), Some(several), _) => {
            Err(unexpected("one tie point of 6 numbers", format!("{} numbers", several.len())))
        }
        _ => Err(unexpected(
            "a place on the map (ModelPixelScale and ModelTiepoint, or ModelTransformation)",
            "none: this is a TIFF file but no GeoTIFF file",
        )),
    }
}

/// Whether the place of a pixel is that of its middle.
fn is_point<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<bool, GeoTiffFault> {
    let keys = decoder.find_tag_unsigned_vec::<u16>(Tag::GeoKeyDirectoryTag)?.unwrap_or_default();
    // Entries of key, where its value stands (0 for here), count and value, after a head of the same length.
    Ok(keys.chunks_exact(4).skip(1).any(|entry| entry == [RASTER_TYPE, 0, 1, PIXEL_IS_POINT]))
}

/// What marks cells without data.
fn no_data<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<Option<f32>, GeoTiffFault> {
    let Some(value) = decoder.find_tag(Tag::GdalNodata)? else {
        return Ok(None);
    };
    let text = value.into_string()?;
    let word = text.trim_matches(|letter: char| letter.is_whitespace() || letter == '\0');
    match float::<f64>(word.as_bytes()) {
        Some(value) => Ok(Some(value as f32)),
        None => Err(unexpected("a number in GDAL_NODATA", format!("“{}”", word.escape_debug()))),
    }
}

fn values(decoded: DecodingResult) -> Vec<f32> {
    fn cast<T>(values: Vec<T>, cast: impl FnMut(T) -> f32) -> Vec<f32> {
        values.into_iter().map(cast).collect()
    }
    match decoded {
        DecodingResult::F32(values) => values,
        DecodingResult::F64(values) => cast(values, |value| value as f32),
        DecodingResult::F16(values) => cast(values, |value| value.to_f32()),
        DecodingResult::U8(values) => cast(values, f32::from),
        DecodingResult::U16(values) => cast(values, f32::from),
        DecodingResult::U32(values) => cast(values, |value| value as f32),
        DecodingResult::U64(values) => cast(values, |value| value as f32),
        DecodingResult::I8(values) => cast(values, f32::from),
        DecodingResult::I16(values) => cast(values, f32::from),
        DecodingResult::I32(values) => cast(values, |value| value as f32),
        DecodingResult::I64(values) => cast(values, |value| value as f32),
    }
}
