//! Reading the text of an ESRI ASCII grid.

use freshet_hydro::grid::Grid;
use glam::{DVec2, UVec2};

use super::{EsriGrid, ParseError, USUAL_NO_DATA};

/// The longest piece of a file that a message repeats, in characters.
const LONGEST_QUOTE: usize = 40;

pub(super) fn parse(text: &[u8]) -> Result<EsriGrid, ParseError> {
    let mut words = Words::new(text);
    let header = Header::parse(&mut words)?;
    let values = parse_values(&mut words, &header)?;
    let grid = Grid::new(header.size, header.cell_size, values)
        .map_err(|error| words.unexpected("a grid", error.to_string()))?;
    Ok(EsriGrid { corner: header.corner, grid })
}

fn parse_values(words: &mut Words, header: &Header) -> Result<Vec<f32>, ParseError> {
    let UVec2 { x, y } = header.size;
    let count = u64::from(x) * u64::from(y);
    // A value takes at least a digit and a blank, so a header cannot claim more memory than the file deserves.
    let most = (words.rest.len() / 2 + 1) as u64;
    let mut values = Vec::with_capacity(count.min(most) as usize);
    while (values.len() as u64) < count {
        let Some(word) = words.next() else {
            let found = format!("the end of the file after {}", values.len());
            return Err(words.unexpected(format!("{count} values ({x} columns × {y} rows)"), found));
        };
        let value = number::<f32>(word).ok_or_else(|| words.unexpected("a number", quote(word)))?;
        // Compared before the range is checked, because some programs mark no data by a number beyond that of f32.
        if value == header.no_data || value.is_nan() {
            values.push(f32::NAN);
        } else if value.is_finite() {
            values.push(value);
        } else {
            return Err(words.unexpected("a finite number", quote(word)));
        }
    }
    match words.next() {
        None => Ok(values),
        Some(word) => {
            let expected = format!("the end of the file after {count} values ({x} × {y})");
            Err(words.unexpected(expected, quote(word)))
        }
    }
}

/// What stands above the values.
struct Header {
    size: UVec2,
    corner: DVec2,
    cell_size: f32,
    no_data: f32,
}

/// The keys, in lower case.
const KEYS: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "dx", "dy", "nodata_value"];

impl Header {
    fn parse(words: &mut Words) -> Result<Self, ParseError> {
        let entries = Entries::parse(words)?;
        let cell_size = match (entries.get("cellsize"), entries.get("dx"), entries.get("dy")) {
            (Some(size), None, None) => size,
            (None, Some(dx), Some(dy)) if dx.value == dy.value => dx,
            (None, Some(_), Some(dy)) => {
                return Err(dy.unexpected("dy equal to dx, for cells are squares here"));
            }
            (Some(_), Some(other), _) | (Some(_), _, Some(other)) => {
                return Err(other.unexpected("either cellsize or dx and dy, not both"));
            }
            (None, ..) => return Err(words.missing("cellsize (or dx and dy)")),
        };
        if !(cell_size.value > 0.0 && (cell_size.value as f32).is_normal()) {
            return Err(cell_size.unexpected("a cell size above zero"));
        }
        let corner = |corner: &str, centre: &str| match (entries.get(corner), entries.get(centre)) {
            (Some(corner), None) => Ok(corner.value),
            (None, Some(centre)) => Ok(centre.value - cell_size.value / 2.0),
            (Some(_), Some(also)) => Err(also.unexpected(format!("{corner} or {centre}, not both"))),
            (None, None) => Err(words.missing(format!("{corner} (or {centre})"))),
        };
        let count = |key: &str| entries.get(key).ok_or_else(|| words.missing(key))?.count();
        Ok(Self {
            size: UVec2::new(count("ncols")?, count("nrows")?),
            corner: DVec2::new(corner("xllcorner", "xllcenter")?, corner("yllcorner", "yllcenter")?),
            cell_size: cell_size.value as f32,
            no_data: entries.get("nodata_value").and_then(|entry| number(entry.word)).unwrap_or(USUAL_NO_DATA),
        })
    }
}

/// One key of the header with its value.
#[derive(Clone, Copy)]
struct Entry<'a> {
    line: usize,
    word: &'a [u8],
    value: f64,
}

impl Entry<'_> {
    /// The value as a number of rows or columns.
    fn count(&self) -> Result<u32, ParseError> {
        let fits = self.value.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&self.value);
        fits.then_some(self.value as u32).ok_or_else(|| self.unexpected("a whole number from 1 to 4294967295"))
    }

    fn unexpected(&self, expected: impl Into<String>) -> ParseError {
        ParseError { line: self.line, expected: expected.into(), found: quote(self.word) }
    }
}

/// All keys of the header that are present.
struct Entries<'a>([Option<Entry<'a>>; KEYS.len()]);

impl<'a> Entries<'a> {
    /// Reads keys and their values up to the first word that is a number.
    fn parse(words: &mut Words<'a>) -> Result<Self, ParseError> {
        let mut entries = Self([None; KEYS.len()]);
        while let Some(key) = words.next_if(|word| number::<f32>(word).is_none()) {
            let Some(index) = KEYS.iter().position(|name| key.eq_ignore_ascii_case(name.as_bytes())) else {
                let expected = format!("a number or one of the keys {}", KEYS.join(", "));
                return Err(words.unexpected(expected, quote(key)));
            };
            if entries.0[index].is_some() {
                return Err(words.unexpected(format!("{} only once", KEYS[index]), quote(key)));
            }
            let expected = || format!("a finite number for {}", KEYS[index]);
            let Some(word) = words.next() else {
                return Err(words.unexpected(expected(), "the end of the file"));
            };
            let value = number::<f64>(word)
                .filter(|value| value.is_finite() || KEYS[index] == "nodata_value")
                .ok_or_else(|| words.unexpected(expected(), quote(word)))?;
            let line = words.line;
            entries.0[index] = Some(Entry { line, word, value });
        }
        Ok(entries)
    }

    fn get(&self, key: &str) -> Option<Entry<'a>> {
        let index = KEYS.iter().position(|name| *name == key)?;
        self.0[index]
    }
}

/// A number as the many writers of these files spell it: with point or comma; NaN also as C runtimes print it.
fn number<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    let text = std::str::from_utf8(word).ok()?;
    let lower = text.trim_start_matches(['-', '+']).to_ascii_lowercase();
    match lower.as_str() {
        "nan" | "nan(ind)" | "1.#qnan" | "1.#ind" => "nan".parse().ok(),
        _ if text.contains(',') => text.replace(',', ".").parse().ok(),
        _ => text.parse().ok(),
    }
}

/// A word of the file for a message, shortened and printable.
fn quote(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(word);
    let short: String = text.chars().take(LONGEST_QUOTE).collect();
    let dots = if short.len() < text.len() { "…" } else { "" };
    format!("“{}{dots}”", short.escape_debug())
}

/// The words of a text one after the other, with the line each stands on.
struct Words<'a> {
    rest: &'a [u8],
    /// The line of the last word, counted from 1.
    line: usize,
}

impl<'a> Words<'a> {
    fn new(text: &'a [u8]) -> Self {
        let byte_order_mark = "\u{feff}".as_bytes();
        Self { rest: text.strip_prefix(byte_order_mark).unwrap_or(text), line: 1 }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        self.next_if(|_| true)
    }

    /// The next word, if there is one and it pleases `wanted`.
    fn next_if(&mut self, wanted: impl FnOnce(&[u8]) -> bool) -> Option<&'a [u8]> {
        let is_blank = |byte: &u8| byte.is_ascii_whitespace();
        let blanks = self.rest.iter().take_while(|byte| is_blank(byte)).count();
        let (blanks, rest) = self.rest.split_at(blanks);
        self.line += blanks.iter().filter(|&&byte| byte == b'\n').count();
        self.rest = rest;
        let length = rest.iter().position(is_blank).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(length);
        if word.is_empty() || !wanted(word) {
            return None;
        }
        self.rest = rest;
        Some(word)
    }

    fn missing(&self, key: impl Into<String>) -> ParseError {
        let expected = format!("the header to give {}", key.into());
        self.unexpected(expected, "none before the first value")
    }

    fn unexpected(&self, expected: impl Into<String>, found: impl Into<String>) -> ParseError {
        ParseError { line: self.line, expected: expected.into(), found: found.into() }
    }
}
