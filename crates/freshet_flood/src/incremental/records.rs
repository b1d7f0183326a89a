//! The records of an incremental file, step by step.

use std::io::Read;

use freshet_hydro::grid::Grid;
use glam::UVec2;

use super::header::Header;
use crate::step::{Quantity, Step};
use crate::text::{Fault, Place, Words, float, natural};

/// An incremental file that is read from a stream: an iterator over its steps, one for each time, with all quantities
/// that had a record until then. It ends after the first error. Memory holds one step.
pub struct Incremental<R> {
    words: Words<R>,
    header: Header,
    rasters: [Option<Vec<f32>>; Quantity::ALL.len()],
    /// The record whose cells come next.
    record: Option<Record>,
}

/// The beginning of a record.
#[derive(Clone, Copy)]
struct Record {
    /// s.
    time: f64,
    /// Column of the quantity in the table of classes, from 0.
    column: usize,
    place: Place,
}

/// A line below the header.
enum Entry {
    Record(Record),
    Cell(Cell),
}

/// What a cell becomes: column, row and class, as they stand in the file.
struct Cell {
    numbers: [u32; 3],
    places: [Place; 3],
}

impl<R: Read> Incremental<R> {
    /// Reads the header and the beginning of the first record. Nothing is packed here: see [`crate::steps::Steps`] for files.
    ///
    /// # Errors
    /// [`Fault`] if the stream breaks off, is no incremental file, has more than one domain, cells that are not square or
    /// more than [`super::MOST_CELLS`] of them.
    pub fn new(source: R) -> Result<Self, Fault> {
        let mut words = Words::new(source);
        let header = Header::read(&mut words)?;
        let first = read_entry(&mut words, &header)?;
        let Some(Entry::Record(first)) = first else {
            let expected = "a record (hours, 0, quantity)";
            return Err(match first {
                Some(Entry::Cell(cell)) => cell.places[0].unexpected(expected, "a cell"),
                _ => words.unexpected(expected, "the end of the file"),
            });
        };
        Ok(Self { words, header, rasters: Default::default(), record: Some(first) })
    }

    /// What stands above the records.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Reads all records of the time of `record`, and the beginning of the next if there is one.
    fn read_step(&mut self, mut record: Record) -> Result<Step, Fault> {
        let time = record.time;
        while let Some(next) = self.read_cells(record)? {
            if next.time < time {
                let [expected, found] = [time, next.time].map(|seconds| seconds / self.header.time_unit);
                return Err(next.place.unexpected(format!("a time from {expected}"), found.to_string()));
            }
            if next.time > time {
                self.record = Some(next);
                break;
            }
            record = next;
        }
        self.step(time)
    }

    /// Reads the cells of `record`. Returns the beginning of the next.
    fn read_cells(&mut self, record: Record) -> Result<Option<Record>, Fault> {
        let Self { words, header, rasters, .. } = self;
        let size = header.georeference.size;
        let classes = &header.classes[record.column];
        let mut raster = header.quantities[record.column].map(|quantity| {
            rasters[quantity as usize].get_or_insert_with(|| vec![f32::NAN; size.x as usize * size.y as usize])
        });
        loop {
            let cell = match read_entry(words, header)? {
                None => return Ok(None),
                Some(Entry::Record(next)) => return Ok(Some(next)),
                Some(Entry::Cell(cell)) => cell,
            };
            let index = cell.index(size)?;
            let value = classes
                .get(cell.numbers[2] as usize)
                .ok_or_else(|| cell.unexpected(2, "a class", 0, classes.len() - 1))?;
            if let Some(raster) = &mut raster {
                raster[index] = *value;
            }
        }
    }

    fn step(&self, time: f64) -> Result<Step, Fault> {
        let georeference = &self.header.georeference;
        let mut step = Step::new(time);
        for quantity in Quantity::ALL {
            if let Some(values) = &self.rasters[quantity as usize] {
                let grid = Grid::new(georeference.size, georeference.cell_size as f32, values.clone())
                    .map_err(|error| self.words.unexpected("a grid", error.to_string()))?;
                step = step.with(quantity, grid);
            }
        }
        Ok(step)
    }
}

impl<R: Read> Iterator for Incremental<R> {
    type Item = Result<Step, Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        let record = self.record.take()?;
        Some(self.read_step(record))
    }
}

/// The next line below the header, or none at the end of the file.
#[inline]
fn read_entry<R: Read>(words: &mut Words<R>, header: &Header) -> Result<Option<Entry>, Fault> {
    let Some(first) = words.next()? else {
        return Ok(None);
    };
    let whole = natural(first);
    let hours = if whole.is_some() { None } else { float::<f64>(first) };
    if whole.is_none() && hours.is_none() {
        return Err(words.unexpected_word("a cell (column, row, class) or a record (hours, 0, quantity)"));
    }
    let mut places = [words.place(); 3];
    let line = places[0].line;
    let mut numbers = [whole.unwrap_or_default(), 0, 0];
    for count in 1..3 {
        numbers[count] = match words.next_on(line)?.map(natural) {
            Some(Some(number)) => number,
            Some(None) => return Err(words.unexpected_word("a whole number")),
            None => return Err(places[0].unexpected("three or four numbers on a line", count.to_string())),
        };
        places[count] = words.place();
    }
    let has_domain = words.next_on(line)?.is_some();
    if has_domain && words.next_on(line)?.is_some() {
        return Err(words.unexpected_word("at most four numbers on a line"));
    }
    let cell = Cell { numbers, places };
    if !has_domain && numbers[1] > 0 && whole.is_some() {
        return Ok(Some(Entry::Cell(cell)));
    }
    let hours = hours.unwrap_or(f64::from(numbers[0]));
    cell.record(hours, header).map(|record| Some(Entry::Record(record)))
}

impl Cell {
    /// The numbers as the beginning of a record at `hours`.
    #[cold]
    fn record(&self, hours: f64, header: &Header) -> Result<Record, Fault> {
        let count = header.classes.len();
        let column = (self.numbers[2] as usize).checked_sub(1).filter(|column| *column < count);
        let time = hours * header.time_unit;
        match column {
            None => Err(self.unexpected(2, "a quantity", 1, count)),
            Some(_) if !time.is_finite() => Err(self.places[0].unexpected("a finite time", hours.to_string())),
            Some(column) => Ok(Record { time, column, place: self.places[0] }),
        }
    }

    /// Place of the cell in a list row by row from the north.
    #[inline]
    fn index(&self, size: UVec2) -> Result<usize, Fault> {
        let [column, row, _] = self.numbers;
        if column == 0 || column > size.x {
            return Err(self.unexpected(0, "a column", 1, size.x as usize));
        }
        if row == 0 || row > size.y {
            return Err(self.unexpected(1, "a row", 1, size.y as usize));
        }
        Ok((size.y - row) as usize * size.x as usize + column as usize - 1)
    }

    /// That the number in this place is out of its range.
    #[cold]
    fn unexpected(&self, place: usize, what: &str, least: usize, most: usize) -> Fault {
        self.places[place].unexpected(format!("{what} from {least} to {most}"), self.numbers[place].to_string())
    }
}
