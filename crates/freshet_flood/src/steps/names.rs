//! What names of files tell: which step, and which quantity.

use std::path::Path;

use crate::step::Quantity;

/// Endings of rasters, in lower case.
const ENDINGS: [&str; 6] = ["asc", "txt", "grd", "agr", "tif", "tiff"];

/// What the names of known series begin with.
const SERIES: [(Quantity, &[&str]); 5] = [
    (Quantity::Depth, &["dm", "d", "depth", "waterdepth", "wd"]),
    (Quantity::Speed, &["c", "dc", "speed", "velocity", "vel"]),
    (Quantity::Level, &["h", "dh", "z", "level", "waterlevel", "wl"]),
    (Quantity::East, &["u", "du", "east"]),
    (Quantity::North, &["v", "dv", "north"]),
];

/// The longest text between two numbers of a step, as the unit in `depth_30min00s`. `dm1maxd0` is no step.
const LONGEST_UNIT: usize = 3;

/// A natural number of any length: its count of digits and its digits, without leading zeros. In this order, 2 is before 10.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Number(usize, String);

impl Number {
    pub(super) fn new(digits: &str) -> Self {
        let digits = digits.trim_start_matches('0');
        Self(digits.len(), digits.into())
    }
}

/// The name of a raster, taken apart.
pub(super) struct Name {
    /// The name in lower case without its endings.
    pub(super) stem: String,
    /// The texts before, between and behind the numbers, without punctuation.
    texts: Vec<String>,
    /// The numbers.
    pub(super) numbers: Vec<Number>,
}

impl Name {
    /// Takes the name of a file apart, if its ending is that of a raster.
    pub(super) fn of_raster(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let plain = name.strip_suffix(".gz").unwrap_or(&name);
        let (stem, ending) = plain.rsplit_once('.')?;
        (ENDINGS.contains(&ending) && !stem.is_empty()).then(|| Self::new(stem))
    }

    /// Takes a name without endings apart.
    pub(super) fn new(stem: &str) -> Self {
        let stem = stem.to_ascii_lowercase();
        let is_digit = |letter: char| letter.is_ascii_digit();
        let runs = stem.split(|letter| !is_digit(letter)).filter(|digits| !digits.is_empty());
        let numbers: Vec<Number> = runs.map(Number::new).collect();
        let mut texts = vec![String::new()];
        let mut was_digit = false;
        for letter in stem.chars() {
            if is_digit(letter) && !was_digit {
                texts.push(String::new());
            } else if let (Some(text), true) = (texts.last_mut(), letter.is_alphanumeric() && !is_digit(letter)) {
                text.push(letter);
            }
            was_digit = is_digit(letter);
        }
        Self { stem, texts, numbers }
    }

    /// What is the same in all names of a series, with # for numbers.
    pub(super) fn series(&self) -> String {
        self.texts.join("#")
    }

    /// The quantity, by what is `given` of names' beginnings, and else by the names that are known.
    pub(super) fn quantity(&self, given: &[(String, Quantity)]) -> Option<Quantity> {
        let begins = |(beginning, _): &&(String, Quantity)| self.stem.starts_with(&beginning.to_lowercase());
        if let Some((_, quantity)) = given.iter().filter(begins).max_by_key(|(beginning, _)| beginning.len()) {
            return Some(*quantity);
        }
        let texts: Vec<&str> = self.texts.iter().map(String::as_str).collect();
        let word = match texts.as_slice() {
            // Sobek: domain, quantity and step.
            ["dm", letter @ ("d" | "c" | "h" | "u" | "v"), ""] => letter,
            [first, units @ ..] if units.iter().all(|unit| unit.len() <= LONGEST_UNIT) => first,
            _ => return None,
        };
        SERIES.into_iter().find(|(_, words)| words.contains(word)).map(|(quantity, _)| quantity)
    }
}
