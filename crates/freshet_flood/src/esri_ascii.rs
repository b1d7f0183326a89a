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
//! the centre of the lower-left cell (`XLLCENTER`, `YLLCENTER`), mixed too; `DX` and `DY`, if equal, for `CELLSIZE`; no
//! `NODATA_VALUE` (then it is −9999); integers, decimals with point or comma, exponents, and `nan` for no data; line
//! ends of any system and anywhere among the values; a UTF-8 byte-order mark.

mod parser;

use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use freshet_hydro::grid::Grid;
use glam::{DVec2, Vec2};
use thiserror::Error;

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

/// Why an ESRI ASCII grid cannot be read or written.
#[derive(Debug, Error)]
pub enum EsriError {
    /// The file cannot be opened, read or written.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system reported.
        source: io::Error,
    },
    /// The text is not an ESRI ASCII grid.
    #[error("{}, {source}", .path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// What is wrong where.
        source: ParseError,
    },
}

/// Where a text stops being an ESRI ASCII grid.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}: expected {expected}, found {found}")]
pub struct ParseError {
    /// The line, counted from 1.
    pub line: usize,
    /// What should stand there.
    pub expected: String,
    /// What stands there.
    pub found: String,
}

impl EsriGrid {
    /// Reads a file.
    ///
    /// # Errors
    /// [`EsriError`], with the file's name, if it cannot be opened or is not an ESRI ASCII grid.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, EsriError> {
        let path = path.as_ref().to_path_buf();
        match fs::read(&path) {
            Err(source) => Err(EsriError::Io { path, source }),
            Ok(text) => Self::parse(&text).map_err(|source| EsriError::Parse { path, source }),
        }
    }

    /// Reads the contents of a file.
    ///
    /// # Errors
    /// [`ParseError`] if a key of the header is missing, unknown, doubled or out of range, if DX and DY differ, or if
    /// there are not exactly as many finite numbers as the header says.
    pub fn parse(text: &[u8]) -> Result<Self, ParseError> {
        parser::parse(text)
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
