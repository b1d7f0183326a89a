//! What can go wrong with a flood in its folder.

use std::io;
use std::path::{Path, PathBuf};

use freshet_hydro::grid::GridError;
use glam::UVec2;
use thiserror::Error;

use super::VERSION;
use crate::flow_map::FlowMapError;

/// Why a flood cannot be read or written.
#[derive(Debug, Error)]
pub enum MapsError {
    /// A file or folder cannot be opened, read or written.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system reported.
        source: io::Error,
    },
    /// The manifest is not what it should be.
    #[error("{}: {reason}", .path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        reason: String,
    },
    /// The manifest is of another version.
    #[error("{}: expected version {VERSION}, found {found}: convert the flood anew", .path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// A picture is not what it should be.
    #[error("{}: {reason}", .path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A picture is of another size.
    #[error("{}: expected {} × {} pixels, found {} × {}", .path.display(), .expected.x, .expected.y, .found.x, .found.y)]
    Size {
        /// The file.
        path: PathBuf,
        /// Columns and rows that it has.
        found: UVec2,
        /// Columns and rows that the manifest says.
        expected: UVec2,
    },
    /// The flow map cannot be read or written.
    #[error(transparent)]
    Flow(#[from] FlowMapError),
    /// The size or the cells are no grid's.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The flood was converted without this.
    #[error("{}: this flood was converted without {what}", .folder.display())]
    Missing {
        /// The folder.
        folder: PathBuf,
        /// What was asked for.
        what: String,
    },
    /// There is no such step.
    #[error("there is no step {0}: this flood has {1}, counted from 0")]
    NoStep(usize, usize),
    /// Something else is where the flood should be written, or in a folder that it would replace.
    #[error("{}: is in the way and belongs to no flood; remove it or choose another folder", .0.display())]
    InTheWay(PathBuf),
}

impl MapsError {
    pub(super) fn io(path: &Path, source: io::Error) -> Self {
        Self::Io { path: path.into(), source }
    }
}
