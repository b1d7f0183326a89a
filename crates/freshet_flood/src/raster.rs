//! Rasters on the map, whatever format they are stored in.

use std::io::Read;
use std::path::{Path, PathBuf};

use freshet_hydro::grid::Grid;
use thiserror::Error;

use crate::esri_ascii;
use crate::georeference::Georeference;
use crate::geotiff::{self, GeoTiffError};
use crate::incremental;
use crate::text::{self, Fault, TextError, Words, quote};

/// So much of a file is looked at to tell its format, in bytes.
const LOOKED_AT: usize = 4096;

/// What TIFF files begin with: the order of bytes, and 42 or for BigTIFF 43 in that order.
const TIFF: [&[u8]; 4] = [b"II\x2a\0", b"MM\0\x2a", b"II\x2b\0", b"MM\0\x2b"];

/// Values of square cells with their place on the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Where it lies, and how large its cells are.
    pub georeference: Georeference,
    /// The values; NaN in cells without data.
    pub grid: Grid<f32>,
}

/// How a file stores what a hydraulic model computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One raster as text, packed by gzip or not: [`crate::esri_ascii`].
    EsriAscii,
    /// One raster: [`crate::geotiff`].
    GeoTiff,
    /// All steps of a flood as text, packed by gzip or not: [`crate::incremental`].
    Incremental,
}

/// Why a raster cannot be read.
#[derive(Debug, Error)]
pub enum RasterError {
    /// The text cannot be read or is not what it should be.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The GeoTIFF file cannot be read or is not what it should be.
    #[error(transparent)]
    GeoTiff(#[from] GeoTiffError),
    /// The file is of another format.
    #[error("{}: expected {expected}, found {found}", .path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The formats that are read.
        expected: &'static str,
        /// What the file begins with.
        found: String,
    },
}

impl Format {
    /// The format of a file, by what it begins with and not by its name.
    ///
    /// # Errors
    /// [`RasterError`] if the file cannot be read, is empty or of none of these formats.
    pub fn of(path: impl AsRef<Path>) -> Result<Self, RasterError> {
        let path = path.as_ref();
        let text_error = |fault| TextError::new(path, fault);
        let start = text::start(path, LOOKED_AT).map_err(|error| text_error(Fault::Io(error)))?;
        if TIFF.iter().any(|magic| start.starts_with(magic)) {
            return Ok(Self::GeoTiff);
        }
        let mut words = Words::new(start.as_slice());
        let found = match words.next().map_err(text_error)? {
            Some(word) if incremental::is_first_word(word) => return Ok(Self::Incremental),
            Some(word) if esri_ascii::is_key(word) => return Ok(Self::EsriAscii),
            Some(word) => quote(word),
            None => "an empty file".into(),
        };
        let expected = "an ESRI ASCII grid, a GeoTIFF or an incremental file";
        Err(RasterError::Format { path: path.into(), expected, found })
    }
}

impl Raster {
    /// Reads an ESRI ASCII grid, packed by gzip or not, or a GeoTIFF file.
    ///
    /// # Errors
    /// [`RasterError`], with the file's name, if it cannot be opened or is no such raster.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, RasterError> {
        read_as(path.as_ref(), esri_ascii::read_raster, |path| geotiff::read(path))
    }
}

impl Georeference {
    /// Reads where an ESRI ASCII grid, packed by gzip or not, or a GeoTIFF file lies on the map, without its values.
    ///
    /// # Errors
    /// [`RasterError`], with the file's name, if it cannot be opened or does not begin as such a raster.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, RasterError> {
        read_as(path.as_ref(), esri_ascii::read_georeference, |path| geotiff::read_georeference(path))
    }

    /// Whether the other raster covers the same cells, up to what writers round: a millionth of a cell's side, and a
    /// thousandth of it for the place.
    pub fn is_same(&self, other: &Self) -> bool {
        let same_size = self.size == other.size;
        let same_cells = (self.cell_size - other.cell_size).abs() <= 1e-6 * self.cell_size;
        same_size && same_cells && (self.corner - other.corner).abs().max_element() <= 1e-3 * self.cell_size
    }
}

/// Reads one raster by the reader of its format.
fn read_as<T>(
    path: &Path,
    esri_ascii: impl FnOnce(Box<dyn Read + Send>) -> Result<T, Fault>,
    geotiff: impl FnOnce(&Path) -> Result<T, GeoTiffError>,
) -> Result<T, RasterError> {
    match Format::of(path)? {
        Format::GeoTiff => Ok(geotiff(path)?),
        Format::EsriAscii => {
            let read = text::plain(path).map_err(Fault::Io).and_then(esri_ascii);
            Ok(read.map_err(|fault| TextError::new(path, fault))?)
        }
        Format::Incremental => {
            let found = "an incremental file, which holds many".into();
            Err(RasterError::Format { path: path.into(), expected: "one raster", found })
        }
    }
}
