//! What stands above the values of an ESRI ASCII grid.

use std::io::Read;

use glam::{DVec2, UVec2};

use super::USUAL_NO_DATA;
use crate::georeference::Georeference;
use crate::text::{Fault, Place, Words, float, quote};

/// The keys, in lower case.
const KEYS: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "dx", "dy", "nodata_value"];

/// Whether a word is a key, in any case.
pub(crate) fn is_key(word: &[u8]) -> bool {
    index(word).is_some()
}

fn index(word: &[u8]) -> Option<usize> {
    KEYS.iter().position(|key| word.eq_ignore_ascii_case(key.as_bytes()))
}

pub(super) struct Header {
    pub(super) georeference: Georeference,
    pub(super) no_data: f32,
}

impl Header {
    pub(super) fn read<R: Read>(words: &mut Words<R>) -> Result<Self, Fault> {
        let entries = Entries::read(words)?;
        let missing = |key: &str| {
            let expected = format!("the header to give {key}");
            words.unexpected(expected, "none before the first value")
        };
        let cell_size = entries.cell_size()?.ok_or_else(|| missing("cellsize (or dx and dy)"))?;
        let corner = |corner: &str, centre: &str| match (entries.get(corner), entries.get(centre)) {
            (Some(corner), None) => Ok(corner.value),
            (None, Some(centre)) => Ok(centre.value - cell_size / 2.0),
            (Some(_), Some(also)) => Err(also.unexpected(format!("{corner} or {centre}, not both"))),
            (None, None) => Err(missing(&format!("{corner} (or {centre})"))),
        };
        let count = |key: &str| entries.get(key).ok_or_else(|| missing(key))?.count();
        let georeference = Georeference {
            size: UVec2::new(count("ncols")?, count("nrows")?),
            corner: DVec2::new(corner("xllcorner", "xllcenter")?, corner("yllcorner", "yllcenter")?),
            cell_size,
        };
        let no_data = entries.get("nodata_value").and_then(|entry| float(&entry.word));
        Ok(Self { georeference, no_data: no_data.unwrap_or(USUAL_NO_DATA) })
    }
}

/// One key of the header with its value.
struct Entry {
    place: Place,
    word: Vec<u8>,
    value: f64,
}

impl Entry {
    /// The value as a number of rows or columns.
    fn count(&self) -> Result<u32, Fault> {
        let fits = self.value.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&self.value);
        fits.then_some(self.value as u32).ok_or_else(|| self.unexpected("a whole number from 1 to 4294967295"))
    }

    fn unexpected(&self, expected: impl Into<String>) -> Fault {
        self.place.unexpected(expected, quote(&self.word))
    }
}

/// All keys of the header that are present.
struct Entries([Option<Entry>; KEYS.len()]);

impl Entries {
    /// Reads keys and their values up to the first word that is a number.
    fn read<R: Read>(words: &mut Words<R>) -> Result<Self, Fault> {
        let mut entries = Self(Default::default());
        while let Some(key) = words.peek()?.filter(|word| float::<f32>(word).is_none()) {
            let Some(index) = index(key) else {
                return Err(words.unexpected_word(format!("a number or one of the keys {}", KEYS.join(", "))));
            };
            if entries.0[index].is_some() {
                return Err(words.unexpected_word(format!("{} only once", KEYS[index])));
            }
            words.next()?;
            entries.0[index] = Some(Self::entry(words, KEYS[index])?);
        }
        Ok(entries)
    }

    /// Reads the value of `key`.
    fn entry<R: Read>(words: &mut Words<R>, key: &str) -> Result<Entry, Fault> {
        let expected = || format!("a finite number for {key}");
        let Some(word) = words.next()?.map(<[u8]>::to_vec) else {
            return Err(words.unexpected(expected(), "the end of the file"));
        };
        let value = float::<f64>(&word)
            .filter(|value| value.is_finite() || key == "nodata_value")
            .ok_or_else(|| words.unexpected_word(expected()))?;
        Ok(Entry { place: words.place(), word, value })
    }

    fn get(&self, key: &str) -> Option<&Entry> {
        self.0[index(key.as_bytes())?].as_ref()
    }

    /// The side of a cell, if the header gives one.
    fn cell_size(&self) -> Result<Option<f64>, Fault> {
        let size = match (self.get("cellsize"), self.get("dx"), self.get("dy")) {
            (Some(_), Some(other), _) | (Some(_), _, Some(other)) => {
                return Err(other.unexpected("either cellsize or dx and dy, not both"));
            }
            (None, Some(dx), Some(dy)) if dx.value != dy.value => {
                return Err(dy.unexpected("dy equal to dx, for cells are squares here"));
            }
            (Some(size), None, None) | (None, Some(size), _) => size,
            (None, None, _) => return Ok(None),
        };
        let is_valid = size.value > 0.0 && (size.value as f32).is_normal();
        is_valid.then_some(Some(size.value)).ok_or_else(|| size.unexpected("a cell size above zero"))
    }
}
