//! Files as the readers see them: text, whether it is packed by gzip or not.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

/// What every gzip file starts with (RFC 1952, section 2.3.1).
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// The text of a file, unpacked if it is gzip: by what the file says, not by its name.
///
/// # Errors
/// What the system reports.
pub(crate) fn plain(path: &Path) -> io::Result<Box<dyn Read + Send>> {
    let mut file = File::open(path)?;
    let start = first(&mut file, GZIP.len())?;
    let is_packed = start == GZIP;
    let whole = Cursor::new(start).chain(file);
    Ok(if is_packed { Box::new(MultiGzDecoder::new(whole)) } else { Box::new(whole) })
}

/// The first bytes of a file's text, `most` of them or all there are.
///
/// # Errors
/// What the system reports, or that the file is no intact gzip file.
pub(crate) fn start(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    first(&mut plain(path)?, most)
}

fn first(source: &mut impl Read, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(most);
    source.take(most as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}
