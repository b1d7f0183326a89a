//! Reading the text of an ESRI ASCII grid.

use std::io::Read;

use freshet_hydro::grid::Grid;
use glam::UVec2;

use super::header::Header;
use crate::georeference::Georeference;
use crate::raster::Raster;
use crate::text::{Fault, Words, float};

/// Room for so many values is made before the first is read. A header may claim any number of them.
const FIRST_VALUES: u64 = 1 << 16;

pub(crate) fn read_raster(source: impl Read) -> Result<Raster, Fault> {
    let mut words = Words::new(source);
    let header = Header::read(&mut words)?;
    let values = read_values(&mut words, &header)?;
    let georeference = header.georeference;
    let grid = Grid::new(georeference.size, georeference.cell_size as f32, values)
        .map_err(|error| words.unexpected("a grid", error.to_string()))?;
    Ok(Raster { georeference, grid })
}

pub(crate) fn read_georeference(source: impl Read) -> Result<Georeference, Fault> {
    Ok(Header::read(&mut Words::new(source))?.georeference)
}

fn read_values<R: Read>(words: &mut Words<R>, header: &Header) -> Result<Vec<f32>, Fault> {
    let UVec2 { x, y } = header.georeference.size;
    let count = u64::from(x) * u64::from(y);
    let mut values = Vec::with_capacity(count.min(FIRST_VALUES) as usize);
    while (values.len() as u64) < count {
        let Some(word) = words.next()? else {
            let found = format!("the end of the file after {}", values.len());
            return Err(words.unexpected(format!("{count} values ({x} columns × {y} rows)"), found));
        };
        let Some(value) = float::<f32>(word) else {
            return Err(words.unexpected_word("a number"));
        };
        // Compared before the range is checked, because some programs mark no data by a number beyond that of f32.
        if value == header.no_data || value.is_nan() {
            values.push(f32::NAN);
        } else if value.is_finite() {
            values.push(value);
        } else {
            return Err(words.unexpected_word("a finite number"));
        }
    }
    match words.next()? {
        None => Ok(values),
        Some(_) => Err(words.unexpected_word(format!("the end of the file after {count} values ({x} × {y})"))),
    }
}
