//! Why a preset cannot be read or written.
use std::{io, path::PathBuf};

/// Why a [`Preset`](super::Preset) cannot be read or written.
#[derive(thiserror::Error, Debug)]
pub enum PresetError {
    /// The file cannot be read.
    #[error("{path}: {source}", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The text is no preset.
    #[error("{path}:{line}:{column}: {message}", path = path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// What was expected, and what was found.
        message: String,
    },
    /// A setting has no text form.
    #[error("the settings cannot be written as text: {0}")]
    Settings(ron::Error),
    /// The file cannot be written.
    #[error("{path}: {source}", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}
