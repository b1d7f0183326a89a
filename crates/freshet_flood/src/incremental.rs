//! Incremental files: all steps of a flood in one text that tells only what changes, as Sobek and Delft-FLS write them.
//!
//! ```text
//! INC1.0                                              Sobek; Delft-FLS has a comment /* … or nothing here
//! DOMAIN                 NUMBER   ID                  Sobek may have this block
//!                             1   'RIVER'
//! MAIN DIMENSIONS        MMAX  NMAX                   columns and rows
//!                         150   226
//! GRID                   DX    DY    X0    Y0         Delft-FLS: DX X0 Y0
//!                      4.00  4.00  2.00  2.00
//! domain                  END
//! START TIME T0: 2011.01.01 00:00:00
//! CLASSES OF INCREMENTAL FILE  Waterdepth(m) Velocity(m/s)     Delft-FLS: H C Z U V
//!                              0.020         0.100
//!                              0.100         -999
//! ENDCLASSES
//! 0.000000 0 1 1                                      hours, 0, quantity; Sobek: and the domain
//! 66 208 2                                            column from the west, row from the south, class
//! ```
//! X0 and Y0 are the *middle* of the south-western cell. Each row of classes has one value per quantity, −999 where that
//! quantity has no such class. Columns, rows, classes and quantities are counted from 1; class 0 is the value 0. A record
//! lists the cells that have changed; cells that were never listed have no data.
//!
//! Words may be in any case, with leading blanks; decimals may have a comma; lines may end as on any system. A record is
//! told from a cell by its fourth number, by a first number that is not whole, or by the zero in the second place, where a
//! cell has its row. Only one domain and square cells are read. A line `TIME UNIT …` puts another unit for hours.

mod header;
mod line;
mod records;

pub(crate) use header::is_first_word;
pub use header::{Dialect, Header, MOST_CELLS};
pub use records::Incremental;
