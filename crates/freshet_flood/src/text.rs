//! What the readers of text share: words, numbers, and where a text stops being what it should be.

mod input;
mod number;
mod words;

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

pub(crate) use input::{plain, start};
pub(crate) use number::{float, natural};
pub(crate) use words::Words;

/// The longest piece of a file that a message repeats, in characters.
const LONGEST_QUOTE: usize = 40;

/// Where a text stops being what it should be.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}, column {column}: expected {expected}, found {found}")]
pub struct ParseError {
    /// The line, counted from 1.
    pub line: usize,
    /// The byte of the line, counted from 1.
    pub column: usize,
    /// What should stand there.
    pub expected: String,
    /// What stands there.
    pub found: String,
}

/// Why a file of text cannot be read or written.
#[derive(Debug, Error)]
pub enum TextError {
    /// The file cannot be opened, read or written.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system reported.
        source: io::Error,
    },
    /// The text is not what it should be.
    #[error("{}, {source}", .path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// What is wrong where.
        source: ParseError,
    },
}

impl TextError {
    /// The fault of a stream, with the file it comes from.
    pub(crate) fn new(path: &Path, fault: Fault) -> Self {
        let path = path.to_path_buf();
        match fault {
            Fault::Io(source) => Self::Io { path, source },
            Fault::Parse(source) => Self::Parse { path, source },
        }
    }
}

/// Why a stream of text cannot be read.
#[derive(Debug, Error)]
pub enum Fault {
    /// The stream breaks off.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The text is not what it should be.
    #[error(transparent)]
    Parse(#[from] ParseError),
}

/// Where a word stands.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The line, counted from 1.
    pub(crate) line: usize,
    /// The byte of the line, counted from 1.
    pub(crate) column: usize,
}

impl Place {
    /// That something else should stand here.
    pub(crate) fn unexpected(self, expected: impl Into<String>, found: impl Into<String>) -> Fault {
        let Self { line, column } = self;
        Fault::Parse(ParseError { line, column, expected: expected.into(), found: found.into() })
    }
}

/// A word of a file for a message, shortened and printable.
pub(crate) fn quote(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(word);
    let short: String = text.chars().take(LONGEST_QUOTE).collect();
    let dots = if short.len() < text.len() { "…" } else { "" };
    format!("“{}{dots}”", short.escape_debug())
}
