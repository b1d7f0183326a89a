//! ESRI ASCII grids: the plain-text rasters that hydraulic models and terrain services exchange.
//!
//! ```text
//! NCOLS 300
//! NROWS 452
//! XLLCORNER 131250
//! YLLCORNER 480400
//! CELLSIZE 2
//! NODATA_VALUE -9999
//! 7.19 7.27 7.40 …        rows from north to south, each from west to east
//! ```
//! Programs write many variants. Read here are: keys in any case and order, with leading blanks; the lower-left corner or
//! the centre of the lower-left cell (`XLLCENTER`, `YLLCENTER`), mixed too; `DX`, alone or with an equal `DY`, for
//! `CELLSIZE`; no `NODATA_VALUE` (then it is −9999); integers, decimals with point or comma, exponents, and `nan` for no
//! data; line ends of any system and anywhere among the values; a UTF-8 byte-order mark; files packed by gzip.

mod header;
mod parser;

use std::fmt;
use std::fs;
use std::io::Read;
use std::path::Path;

use freshet_hydro::grid::Grid;
use glam::{DVec2, Vec2};

use crate::raster::Raster;
use crate::text;

pub use crate::text::{Fault, ParseError, TextError as EsriError};

pub(crate) use header::is_key;
pub(crate) use parser::{read_georeference, read_raster};

/// The value that marks a cell without data if the file does not say.
const USUAL_NO_DATA: f32 = -9999.0;

/// A raster with its place on the map.
#[derive(Clone, Debug, PartialEq)]
pub struct EsriGrid {
    /// Lower-left (south-western) corner of the lower-left cell, (easting, northing) in the map's unit, by convention
    /// metres.
    pub corner: DVec2,
    /// The values; NaN in cells without data.
    pub grid: Grid<f32>,
}

impl EsriGrid {
    /// Reads a file, packed by gzip or not.
    ///
    /// # Errors
    /// [`EsriError`], with the file's name, if it cannot be opened or is not an ESRI ASCII grid.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, EsriError> {
        let path = path.as_ref();
        let read = text::plain(path).map_err(Fault::Io).and_then(Self::read_from);
        read.map_err(|fault| EsriError::new(path, fault))
    }

    /// Reads the contents of a file from wherever they come. Memory holds the grid and a small part of the text; room for
    /// the grid is made as its values come, whatever the header claims.
    ///
    /// # Errors
    /// [`Fault`] if the stream breaks off, or as for [`EsriGrid::parse`].
    pub fn read_from(source: impl Read) -> Result<Self, Fault> {
        Ok(read_raster(source)?.into())
    }

    /// Reads the contents of a file.
    ///
    /// # Errors
    /// [`ParseError`] if a key of the header is missing, unknown, doubled or out of range, if DX and DY differ, or if
    /// there are not exactly as many finite numbers as the header says.
    pub fn parse(text: &[u8]) -> Result<Self, ParseError> {
        Self::read_from(text).map_err(|fault| match fault {
            Fault::Parse(error) => error,
            Fault::Io(error) => {
                let expected = "a text in memory".into();
                ParseError { line: 1, column: 1, expected, found: error.to_string() }
            }
        })
    }

    /// Writes a file that [`EsriGrid::read`] turns into the same grid again.
    ///
    /// # Errors
    /// [`EsriError::Io`], with the file's name.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), EsriError> {
        let path = path.as_ref().to_path_buf();
        fs::write(&path, self.to_string()).map_err(|source| EsriError::Io { path, source })
    }

    /// The local point (x, z) of the centred grid at a place (easting, northing) on the map.
    pub fn local_from_map(&self, map: DVec2) -> Vec2 {
        let offset = map - self.centre();
        DVec2::new(offset.x, -offset.y).as_vec2()
    }

    /// The place (easting, northing) on the map of a local point (x, z) of the centred grid.
    pub fn map_from_local(&self, local: Vec2) -> DVec2 {
        let offset = local.as_dvec2();
        self.centre() + DVec2::new(offset.x, -offset.y)
    }

    fn centre(&self) -> DVec2 {
        self.corner + self.grid.size().as_dvec2() * f64::from(self.grid.cell_size()) / 2.0
    }
}

impl From<Raster> for EsriGrid {
    fn from(raster: Raster) -> Self {
        Self { corner: raster.georeference.corner, grid: raster.grid }
    }
}

/// The text of the file: one line per row, every number in the fewest digits that give it back. Infinite values, which
/// the format cannot hold, become cells without data.
impl fmt::Display for EsriGrid {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut no_data = USUAL_NO_DATA;
        while self.grid.values().contains(&no_data) {
            no_data = 10.0 * no_data - 9.0;
        }
        let size = self.grid.size();
        writeln!(f, "NCOLS {}\nNROWS {}", size.x, size.y)?;
        writeln!(f, "XLLCORNER {}\nYLLCORNER {}", self.corner.x, self.corner.y)?;
        writeln!(f, "CELLSIZE {}\nNODATA_VALUE {no_data}", self.grid.cell_size())?;
        for row in self.grid.values().chunks(size.x as usize) {
            for (column, value) in row.iter().enumerate() {
                let blank = if column == 0 { "" } else { " " };
                let value = if value.is_finite() { *value } else { no_data };
                write!(f, "{blank}{value}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
