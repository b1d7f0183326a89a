//! What is read as an ESRI ASCII grid is written and read back alike; anything else is an error. Either is the same
//! whether the text comes whole or in pieces.

#![no_main]

use std::io::{self, Read};

use freshet_flood::esri_ascii::EsriGrid;
use libfuzzer_sys::fuzz_target;

/// A stream that gives a few bytes at a time.
struct Pieces<'a>(&'a [u8]);

impl Read for Pieces<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let most = buffer.len().min(7);
        self.0.read(&mut buffer[..most])
    }
}

fuzz_target!(|text: &[u8]| {
    let whole = EsriGrid::parse(text).map(|esri| esri.to_string()).map_err(|error| error.to_string());
    let pieces = EsriGrid::read_from(Pieces(text)).map(|esri| esri.to_string()).map_err(|error| error.to_string());
    assert_eq!(whole, pieces);
    if let Ok(written) = whole {
        let again = EsriGrid::parse(written.as_bytes()).expect("what was written is read");
        assert_eq!(again.to_string(), written);
    }
});
