//! The steps of a flood, one after the other or any of them: a folder of rasters, an incremental file, or one raster.
//!
//! # Folders
//! A folder holds one raster for each step and quantity, as ESRI ASCII grids (`.asc`, `.txt`, `.grd`, `.agr`, each also
//! with `.gz`) and GeoTIFF files (`.tif`, `.tiff`), mixed at will. Steps come in the natural order of the numbers in the
//! names: 2 before 10, and `1h30` before `2h00`. What stands before the first number tells the quantity, in any case:
//!
//! | quantity | begins with |
//! |---|---|
//! | depth | `dm`, `d`, `depth`, `waterdepth`, `wd` |
//! | speed | `c`, `dc`, `speed`, `velocity`, `vel` |
//! | level | `h`, `dh`, `z`, `level`, `waterlevel`, `wl` |
//! | velocity to the east | `u`, `du`, `east` |
//! | velocity to the north | `v`, `dv`, `north` |
//!
//! Sobek numbers its domains: in `dm1d0004.asc`, step 4 of domain 1, the letter behind the domain's number counts: `d`,
//! `c`, `h`, `u` or `v` as above. [`Options::series`] says it for other names. Files of one unknown name are depths if
//! no other quantity is there; otherwise they are [left out](Steps::left_out). A step may lack some quantity of the others.

mod folder;
mod names;
mod times;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::georeference::Georeference;
use crate::incremental::{Header, Incremental};
use crate::raster::{Format, RasterError};
use crate::step::{Quantity, Step};
use crate::text::{self, Fault, TextError};
use folder::Folder;

/// Where the time of each step is known from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Times {
    /// The file of all steps. The default; a folder of several steps needs one of the others.
    #[default]
    OfFile,
    /// The steps follow each other in so many seconds, above zero, the first at 0. For folders.
    Every(f64),
    /// A table of comma- or semicolon-separated values, for folders: in each row the name of a file, with or without its
    /// ending, or the number of its step, and its time in seconds or with a unit as [`crate::duration::seconds`] reads it.
    /// A first row of titles is skipped; every step must be there, and times must grow from step to step.
    Table(PathBuf),
}

/// How steps are to be found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Where the time of each step is known from. Default: the file itself.
    pub times: Times,
    /// Quantities by what names of files begin with, in any case, before all names that are known. Default: none.
    pub series: Vec<(String, Quantity)>,
}

/// The steps of a flood, read when they are asked for.
#[derive(Debug)]
pub struct Steps {
    path: PathBuf,
    source: Source,
}

#[derive(Debug)]
enum Source {
    Folder(Folder),
    Incremental(Header),
}

/// Why steps cannot be found or read.
#[derive(Debug, Error)]
pub enum StepsError {
    /// A raster cannot be read.
    #[error(transparent)]
    Raster(#[from] RasterError),
    /// An incremental file or the table of times cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The folder cannot be listed.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// What the system reported.
        source: io::Error,
    },
    /// The folder has no raster.
    #[error("{}: expected rasters (.asc, .asc.gz, .tif …), found none", .0.display())]
    Empty(PathBuf),
    /// The names of rasters do not tell their quantity.
    #[error("{}: which quantities are these files of? {}", .path.display(), .series.join(", "))]
    Unknown {
        /// The folder.
        path: PathBuf,
        /// What the names are, with # for numbers.
        series: Vec<String>,
    },
    /// Two files are the same quantity of the same step.
    #[error("{} and {} are both {quantity} of one step", .first.display(), .second.display())]
    Twice {
        /// One of the files.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// What both are.
        quantity: Quantity,
    },
    /// Two rasters do not cover the same cells.
    #[error("{} has {}, but {} has {}", .second.display(), Cells(.found), .first.display(), Cells(.expected))]
    Different {
        /// The file of the first step.
        first: PathBuf,
        /// What it covers.
        expected: Georeference,
        /// The other file.
        second: PathBuf,
        /// What it covers.
        found: Georeference,
    },
    /// Nothing tells the times of the steps.
    #[error("{}: expected an interval or a table of times for the {count} steps of this folder", .path.display())]
    NoTimes {
        /// The folder.
        path: PathBuf,
        /// How many steps it has.
        count: usize,
    },
    /// Times are given for a file that tells them itself.
    #[error("{}: expected no interval and no table of times, for this file tells its times itself", .0.display())]
    TimesTwice(PathBuf),
    /// The interval is not above zero.
    #[error("the interval between steps must be a finite number of seconds above zero, not {0}")]
    Interval(f64),
    /// The table has no time for a step.
    #[error("{}: expected a time for {}, found none", .table.display(), .file.display())]
    NoTime {
        /// The table.
        table: PathBuf,
        /// A file of the step.
        file: PathBuf,
    },
    /// Times do not grow from step to step.
    #[error("{}: expected times that grow, found {before} s for {} and then {after} s for {}",
        .table.display(), .first.display(), .second.display())]
    Order {
        /// The table.
        table: PathBuf,
        /// A file of a step.
        first: PathBuf,
        /// Its time, s.
        before: f64,
        /// A file of the next step.
        second: PathBuf,
        /// Its time, s.
        after: f64,
    },
}

/// A georeference for messages.
struct Cells<'a>(&'a Georeference);

impl fmt::Display for Cells<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Georeference { corner, cell_size, size } = self.0;
        write!(f, "{} × {} cells of {cell_size} from ({}, {})", size.x, size.y, corner.x, corner.y)
    }
}

impl Steps {
    /// Finds the steps of a folder or a file, and reads what stands above their values.
    ///
    /// # Errors
    /// [`StepsError`] if `path` cannot be read, has no step, has rasters that do not cover the same cells, or times that
    /// are unknown or do not grow.
    pub fn open(path: impl Into<PathBuf>, options: &Options) -> Result<Self, StepsError> {
        let path = path.into();
        let source = if path.is_dir() {
            Source::Folder(Folder::open(&path, options)?)
        } else if Format::of(&path)? == Format::Incremental {
            if options.times != Times::OfFile {
                return Err(StepsError::TimesTwice(path));
            }
            Source::Incremental(incremental(&path)?.header().clone())
        } else {
            Source::Folder(Folder::of_file(&path, options)?)
        };
        Ok(Self { path, source })
    }

    /// The folder or file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where the cells of all steps lie on the map.
    pub fn georeference(&self) -> Georeference {
        match &self.source {
            Source::Folder(folder) => folder.georeference(),
            Source::Incremental(header) => header.georeference,
        }
    }

    /// What the steps tell of: each of these has a raster in some step, or may have one in an incremental file.
    pub fn quantities(&self) -> Vec<Quantity> {
        match &self.source {
            Source::Folder(folder) => folder.quantities(),
            Source::Incremental(header) => header.known_quantities(),
        }
    }

    /// The times of all steps in seconds, which grow. None if only reading the whole file would tell.
    pub fn times(&self) -> Option<&[f64]> {
        match &self.source {
            Source::Folder(folder) => Some(folder.times()),
            Source::Incremental(_) => None,
        }
    }

    /// The number of steps. None if only reading the whole file would tell.
    pub fn count(&self) -> Option<usize> {
        Some(self.times()?.len())
    }

    /// What stands above the records, if this is an incremental file.
    pub fn header(&self) -> Option<&Header> {
        match &self.source {
            Source::Folder(_) => None,
            Source::Incremental(header) => Some(header),
        }
    }

    /// Rasters of the folder that are no step: their names are unknown, or have no number.
    pub fn left_out(&self) -> &[PathBuf] {
        match &self.source {
            Source::Folder(folder) => folder.left_out(),
            Source::Incremental(_) => &[],
        }
    }

    /// All steps in order of time. Each is read when it is asked for, and memory holds no other.
    pub fn iter(&self) -> Box<dyn Iterator<Item = Result<Step, StepsError>> + Send + '_> {
        match &self.source {
            Source::Folder(folder) => Box::new((0..folder.times().len()).filter_map(|index| folder.at(index))),
            Source::Incremental(_) => match incremental(&self.path) {
                Ok(steps) => Box::new(steps.map(|step| Ok(step.map_err(|fault| TextError::new(&self.path, fault))?))),
                Err(error) => Box::new(std::iter::once(Err(error.into()))),
            },
        }
    }

    /// The step at a place in the order of time, from 0, or none behind the last. Quick in folders; an incremental file
    /// is read from its beginning.
    pub fn at(&self, index: usize) -> Option<Result<Step, StepsError>> {
        match &self.source {
            Source::Folder(folder) => folder.at(index),
            Source::Incremental(_) => self.iter().nth(index),
        }
    }
}

fn incremental(path: &Path) -> Result<Incremental<Box<dyn io::Read + Send>>, TextError> {
    text::plain(path).map_err(Fault::Io).and_then(Incremental::new).map_err(|fault| TextError::new(path, fault))
}
