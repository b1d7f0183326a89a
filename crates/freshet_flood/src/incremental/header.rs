//! What stands above the records of an incremental file.

use std::io::Read;

use glam::{DVec2, UVec2, dvec2};

use super::line::{Line, Word};
use crate::duration;
use crate::georeference::Georeference;
use crate::step::Quantity;
use crate::text::{Fault, Words};

/// The most cells of a domain. A file of a few lines can claim any number of them.
pub const MOST_CELLS: u64 = 100_000_000;

/// The most quantities that a file has classes of.
const MOST_QUANTITIES: usize = 6;

/// What marks that a quantity has no such class.
const NO_CLASS: f64 = -999.0;

/// What the columns are if their names say nothing.
const USUAL: [Quantity; 5] = [Quantity::Depth, Quantity::Speed, Quantity::Level, Quantity::East, Quantity::North];

/// The program that an incremental file was written by or for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// Sobek overland flow: begins with `INC1.0`.
    Sobek,
    /// Delft-FLS: begins with a comment or directly with the dimensions.
    DelftFls,
}

/// What stands above the records.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// The program.
    pub dialect: Dialect,
    /// Where the cells lie on the map.
    pub georeference: Georeference,
    /// Date and time at which the times are zero, as the file spells it.
    pub start: Option<String>,
    /// The quantity of each column of classes, none if it has a name that is not known here.
    pub quantities: Vec<Option<Quantity>>,
    /// For each of these columns the values of its classes, from class 0, which is 0. NaN where there is no such class.
    pub classes: Vec<Vec<f32>>,
    /// The length of the unit of time, s. Usually an hour.
    pub time_unit: f64,
}

/// Whether a file that begins with this word is an incremental file.
pub(crate) fn is_first_word(word: &[u8]) -> bool {
    let keywords: [&[u8]; 5] = [b"MAIN", b"DOMAIN", b"GRID", b"START", b"CLASSES"];
    is_sobek(word) || word.starts_with(b"/*") || keywords.iter().any(|keyword| word.eq_ignore_ascii_case(keyword))
}

/// Whether the word is that with which Sobek begins its files: `INC` and a version.
fn is_sobek(word: &[u8]) -> bool {
    word.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(b"INC"))
}

/// What the lines of a header tell, as far as they are read.
struct Draft {
    dialect: Dialect,
    size: Option<UVec2>,
    /// Side of a cell and place of the middle of the south-western one.
    grid: Option<(f64, DVec2)>,
    start: Option<String>,
    time_unit: f64,
}

impl Header {
    /// The quantities that are known here and have a class besides class 0.
    pub fn known_quantities(&self) -> Vec<Quantity> {
        let columns = self.quantities.iter().zip(&self.classes);
        let used = columns.filter(|(_, classes)| classes.iter().skip(1).any(|value| !value.is_nan()));
        used.filter_map(|(quantity, _)| *quantity).collect()
    }

    pub(super) fn read<R: Read>(words: &mut Words<R>) -> Result<Self, Fault> {
        let mut draft = Draft { dialect: Dialect::DelftFls, size: None, grid: None, start: None, time_unit: 3600.0 };
        let mut is_comment = false;
        loop {
            let line = Line::read(words, "CLASSES OF INCREMENTAL FILE")?;
            if line.begins(&["CLASSES"]) {
                let georeference = draft.georeference(&line)?;
                let (quantities, classes) = read_classes(words, &line)?;
                let Draft { dialect, start, time_unit, .. } = draft;
                return Ok(Self { dialect, georeference, start, quantities, classes, time_unit });
            }
            if draft.take(&line, words)? {
                is_comment = false;
            } else if line.words().iter().any(|word| word.text.contains("/*")) {
                is_comment = true;
            } else if !is_comment {
                return Err(line.unexpected("MAIN DIMENSIONS, GRID, DOMAIN, START TIME or CLASSES OF INCREMENTAL FILE"));
            }
        }
    }
}

impl Draft {
    /// Takes in what a line tells, and says whether it is a line that tells something.
    fn take<R: Read>(&mut self, line: &Line, words: &mut Words<R>) -> Result<bool, Fault> {
        if line.begins(&["MAIN"]) {
            if self.size.is_some() {
                return Err(line.unexpected("one domain, for files of several are not read here"));
            }
            self.size = Some(read_size(words)?);
        } else if line.begins(&["GRID"]) {
            self.grid = Some(read_grid(words)?);
        } else if line.begins(&["DOMAIN", "END"]) {
            // What the domain is has been told above.
        } else if line.begins(&["DOMAIN"]) {
            Line::read(words, "number and name of the domain")?;
        } else if line.begins(&["START"]) {
            let skipped = |word: &&Word| {
                ["START", "TIME", "T0", "T0:", ":"].iter().any(|skip| word.text.eq_ignore_ascii_case(skip))
            };
            let texts: Vec<&str> = line.words().iter().skip_while(skipped).map(|word| word.text.as_str()).collect();
            self.start = Some(texts.join(" "));
        } else if let ([_, _, unit], true) = (line.words(), line.begins(&["TIME", "UNIT"])) {
            let length = duration::seconds(&format!("1{}", unit.text));
            self.time_unit = length.map_err(|_| unit.unexpected("a unit from seconds to days"))?;
        } else if line.words().iter().take(1).any(|word| is_sobek(word.text.as_bytes())) {
            self.dialect = Dialect::Sobek;
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    fn georeference(&self, classes: &Line) -> Result<Georeference, Fault> {
        let size = self.size.ok_or_else(|| classes.unexpected("MAIN DIMENSIONS before the classes"))?;
        let (cell_size, middle) = self.grid.ok_or_else(|| classes.unexpected("GRID before the classes"))?;
        Ok(Georeference { corner: middle - cell_size / 2.0, cell_size, size })
    }
}

fn read_size<R: Read>(words: &mut Words<R>) -> Result<UVec2, Fault> {
    let expected = "two numbers of columns and rows, MMAX NMAX";
    let line = Line::read(words, expected)?;
    let is_count = |number: &f64| number.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(number);
    let size = match line.numbers(expected)?.as_slice() {
        [columns, rows] if is_count(columns) && is_count(rows) => UVec2::new(*columns as u32, *rows as u32),
        _ => return Err(line.unexpected(expected)),
    };
    if u64::from(size.x) * u64::from(size.y) > MOST_CELLS {
        return Err(line.unexpected(format!("at most {MOST_CELLS} cells")));
    }
    Ok(size)
}

/// Side of a cell and place of the middle of the south-western one.
fn read_grid<R: Read>(words: &mut Words<R>) -> Result<(f64, DVec2), Fault> {
    let expected = "three or four numbers, DX X0 Y0 or DX DY X0 Y0";
    let line = Line::read(words, expected)?;
    let (dx, dy, middle) = match *line.numbers(expected)?.as_slice() {
        [dx, x, y] => (dx, dx, dvec2(x, y)),
        [dx, dy, x, y] => (dx, dy, dvec2(x, y)),
        _ => return Err(line.unexpected(expected)),
    };
    if dx != dy {
        return Err(line.unexpected("DY equal to DX, for cells are squares here"));
    }
    let is_valid = dx > 0.0 && (dx as f32).is_normal();
    is_valid.then_some((dx, middle)).ok_or_else(|| line.unexpected("a cell size above zero"))
}

/// The table of classes under its first line `names`: quantities and values of each column.
fn read_classes<R: Read>(words: &mut Words<R>, names: &Line) -> Result<(Vec<Option<Quantity>>, Vec<Vec<f32>>), Fault> {
    let expected = "a row of class values or ENDCLASSES";
    let mut quantities = quantities(names);
    let mut classes: Vec<Vec<f32>> = Vec::new();
    loop {
        let line = Line::read(words, expected)?;
        if line.begins(&["ENDCLASSES"]) {
            break;
        }
        let row = line.numbers(expected)?;
        if classes.is_empty() && row.len() <= MOST_QUANTITIES {
            classes = vec![vec![0.0]; row.len()];
        }
        if row.len() != classes.len() {
            let most = if classes.is_empty() { MOST_QUANTITIES } else { classes.len() };
            return Err(line.unexpected(format!("{most} class values, one for each quantity")));
        }
        for (column, value) in classes.iter_mut().zip(row) {
            column.push(if value == NO_CLASS { f32::NAN } else { value as f32 });
        }
    }
    if classes.is_empty() {
        classes = vec![vec![0.0]; quantities.len()];
    }
    quantities.resize(classes.len(), None);
    Ok((quantities, classes))
}

/// The quantities that the first line of the table of classes names.
fn quantities(line: &Line) -> Vec<Option<Quantity>> {
    let mut names: Vec<String> = Vec::new();
    for word in line.words().iter().skip_while(|word| !word.text.eq_ignore_ascii_case("FILE")).skip(1) {
        let name = word.text.split('(').next().unwrap_or_default();
        let name: String = name.chars().filter(|letter| letter.is_alphanumeric()).collect();
        let name = name.to_ascii_lowercase();
        match names.last_mut() {
            // Names of two words.
            Some(last) if last == "water" || (name == "velocity" && ["u", "v"].contains(&last.as_str())) => {
                last.push_str(&name)
            }
            _ if name.is_empty() => {}
            _ => names.push(name),
        }
    }
    let known: Vec<Option<Quantity>> = names.iter().map(|name| quantity(name)).collect();
    match known.iter().flatten().next() {
        Some(_) => known,
        None => USUAL.map(Some).to_vec(),
    }
}

/// The quantity of a name in lower case without its unit.
fn quantity(name: &str) -> Option<Quantity> {
    match name {
        "waterdepth" | "depth" | "h" => Some(Quantity::Depth),
        "velocity" | "speed" | "c" => Some(Quantity::Speed),
        "waterlevel" | "level" | "z" => Some(Quantity::Level),
        "uvelocity" | "u" => Some(Quantity::East),
        "vvelocity" | "v" => Some(Quantity::North),
        _ => None,
    }
}
