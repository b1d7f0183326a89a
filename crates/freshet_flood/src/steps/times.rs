//! Tables of times.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::StepsError;
use super::folder::Files;
use super::names::{Name, Number};
use crate::duration;
use crate::text::{self, Fault, Place, TextError, quote};

/// Times by names of files or numbers of steps.
pub(super) struct Table {
    path: PathBuf,
    rows: Vec<Row>,
}

struct Row {
    /// Name of a file in lower case, or number of a step.
    key: String,
    /// s.
    time: f64,
}

impl Table {
    pub(super) fn read(path: &Path) -> Result<Self, TextError> {
        let error = |fault| TextError::new(path, fault);
        let mut bytes = Vec::new();
        let read = text::plain(path).and_then(|mut source| source.read_to_end(&mut bytes));
        read.map_err(|source| error(Fault::Io(source)))?;
        let text = String::from_utf8_lossy(&bytes);
        let mut rows = Vec::new();
        let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
            match row(line) {
                Ok(row) => rows.push(row),
                // Titles.
                Err(_) if index == 0 => {}
                Err((column, expected)) => {
                    let place = Place { line: index + 1, column };
                    return Err(error(place.unexpected(expected, quote(line.as_bytes()))));
                }
            }
        }
        Ok(Self { path: path.into(), rows })
    }

    /// The time of each step in seconds.
    pub(super) fn times(&self, steps: &[Files]) -> Result<Vec<f64>, StepsError> {
        let mut times: Vec<f64> = Vec::with_capacity(steps.len());
        let mut last: Option<&PathBuf> = None;
        for files in steps {
            let file = || files.values().next().cloned().unwrap_or_default();
            let row = self.rows.iter().find(|row| files.values().any(|path| row.is_of(path)));
            let Some(Row { time, .. }) = row else {
                return Err(StepsError::NoTime { table: self.path.clone(), file: file() });
            };
            if let (Some(first), Some(&before)) = (last, times.last())
                && *time <= before
            {
                let (table, first, second, after) = (self.path.clone(), first.clone(), file(), *time);
                return Err(StepsError::Order { table, first, before, second, after });
            }
            times.push(*time);
            last = files.values().next();
        }
        Ok(times)
    }
}

/// Reads a row, or tells the column where something else is expected.
fn row(line: &str) -> Result<Row, (usize, &'static str)> {
    // With semicolons, commas are decimal.
    let separator = if line.contains(';') { ';' } else { ',' };
    let (key, time) = line.rsplit_once(separator).ok_or((1, "a file or step and its time, with a comma between"))?;
    let [key, text] = [key, time].map(|field| field.trim().trim_matches('"').trim());
    let time = duration::time(text).map_err(|_| (key.len() + 2, "a time such as 90, 90s, 30min, 1.5h or 1d"))?;
    Ok(Row { key: key.to_lowercase(), time })
}

impl Row {
    /// Whether the row is about a file: names it, with or without endings, or its step.
    fn is_of(&self, path: &Path) -> bool {
        let file = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let Some(name) = Name::of_raster(path) else {
            return file.eq_ignore_ascii_case(&self.key);
        };
        let is_number = !self.key.is_empty() && self.key.bytes().all(|byte| byte.is_ascii_digit());
        file.eq_ignore_ascii_case(&self.key)
            || name.stem == self.key
            || is_number && name.numbers.last() == Some(&Number::new(&self.key))
    }
}
