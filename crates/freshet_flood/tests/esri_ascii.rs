//! ESRI ASCII grids as programs write them, as they should not be, and as noise.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::io::{self, Read, Write};

use flate2::Compression;
use flate2::write::GzEncoder;
use freshet_flood::esri_ascii::{EsriError, EsriGrid};
use freshet_hydro::grid::Grid;
use glam::{DVec2, UVec2, dvec2, uvec2, vec2};
use proptest::prelude::*;

const HEADER: &str = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\n";

/// The grid in `text`, its values with no data written as 999.
fn read(text: &str) -> (DVec2, f32, Vec<f32>) {
    let EsriGrid { corner, grid } = EsriGrid::parse(text.as_bytes()).unwrap();
    assert_eq!(grid.size(), uvec2(3, 2));
    let cell_size = grid.cell_size();
    let grid = grid.map(|value| if value.is_nan() { 999.0 } else { *value });
    (corner, cell_size, grid.into_values())
}

fn message(text: &str) -> String {
    EsriGrid::parse(text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn every_spelling_gives_the_same_grid() {
    let expected = (dvec2(10.0, 20.0), 2.0, vec![1.0, -2.5, 999.0, 4e2, 0.0, 6.0]);
    let values = "1 -2.5 -9999 4e2 0 6";
    for text in [
        format!("{HEADER}{values}"),
        format!("{HEADER}1 -2.5 -9999\n4e2 0 6\n\n  \n"),
        // Any case, any order, leading blanks, CRLF, a byte-order mark, values broken anywhere.
        "\u{feff}  CELLSIZE 2.0\r\n\tYllCorner\t20\r\nNROWS 2\r\n NCOLS   3\r\nXLLCORNER 1e1\r\n\
         1\r\n-2.5 -9999 400 0\r\n+6.0 \r\n"
            .into(),
        // Lines of an old Macintosh.
        format!("{HEADER}{values}").replace('\n', "\r"),
        // The centre of the lower-left cell; corner and centre mixed.
        HEADER.replace("xllcorner 10", "xllcenter 11").replace("yllcorner 20", "YLLCENTER 21") + values,
        HEADER.replace("xllcorner 10", "XLLCenter 11") + values,
        HEADER.replace("cellsize 2", "DX 2\nDY 2.0") + values,
        HEADER.replace("cellsize 2", "dx 2") + values,
        // Decimal commas.
        HEADER.replace("cellsize 2", "cellsize 2,0") + "1,0 -2,5 -9999,0 4,0e2 0 6",
        // No data by other names.
        format!("{HEADER}NODATA_value -1\n1 -2.5 -1.0 4e2 0 6"),
        format!("{HEADER}nodata_value nan\n1 -2.5 NaN 4e2 0 6"),
        format!("{HEADER}1 -2.5 -nan(ind) 4e2 0 6"),
        format!("{HEADER}NODATA_VALUE -1.7976931348623157e308\n1 -2.5 -1.797693134862315e308 4e2 0 6"),
    ] {
        assert_eq!(read(&text), expected, "{text:?}");
    }
}

#[test]
fn rows_run_from_north_to_south() {
    let esri = EsriGrid::parse(format!("{HEADER}1 2 3 4 5 6").as_bytes()).unwrap();
    assert_eq!(esri.grid.get(uvec2(0, 0)), Some(&1.0));
    assert_eq!(esri.grid.get(uvec2(2, 1)), Some(&6.0));
    // The centre of the map's cell in the north-west.
    assert_eq!(esri.local_from_map(dvec2(11.0, 23.0)), esri.grid.position(uvec2(0, 0)));
    assert_eq!(esri.map_from_local(vec2(-3.0, 2.0)), esri.corner);
}

#[test]
fn errors_name_line_column_expectation_and_finding() {
    let keys = "ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize, dx, dy, nodata_value";
    for (text, expected) in [
        (
            String::new(),
            "line 1, column 1: expected the header to give cellsize (or dx and dy), found none before the first value",
        ),
        (
            format!("{HEADER}1 2 3\n4 5"),
            "line 7, column 4: expected 6 values (3 columns × 2 rows), found the end of the file after 5",
        ),
        (
            format!("{HEADER}1 2 3\n4 5 6\n7"),
            "line 8, column 1: expected the end of the file after 6 values (3 × 2), found “7”",
        ),
        (format!("{HEADER}1 2 x3\n4 5 6"), "line 6, column 5: expected a number, found “x3”"),
        (format!("{HEADER}1 2 1e99"), "line 6, column 5: expected a finite number, found “1e99”"),
        (format!("{HEADER}0 1.000,5"), "line 6, column 3: expected a number, found “1.000,5”"),
        (
            HEADER.replace("ncols 3", "ncols 0"),
            "line 1, column 7: expected a whole number from 1 to 4294967295, found “0”",
        ),
        (
            HEADER.replace("nrows 2", "nrows 2.5"),
            "line 2, column 7: expected a whole number from 1 to 4294967295, found “2.5”",
        ),
        (
            HEADER.replace("nrows 2", "nrows -2"),
            "line 2, column 7: expected a whole number from 1 to 4294967295, found “-2”",
        ),
        (
            HEADER.replace("nrows 2\n", ""),
            "line 5, column 1: expected the header to give nrows, found none before the first value",
        ),
        (
            HEADER.replace("yllcorner 20\n", ""),
            "line 5, column 1: expected the header to give yllcorner (or yllcenter), found none before the first value",
        ),
        (HEADER.replace("cellsize 2", "cellsize -2"), "line 5, column 10: expected a cell size above zero, found “-2”"),
        (
            HEADER.replace("cellsize 2", "cellsize"),
            "line 6, column 1: expected a finite number for cellsize, found the end of the file",
        ),
        (
            HEADER.replace("cellsize 2", "dx 2\ndy 3"),
            "line 6, column 4: expected dy equal to dx, for cells are squares here, found “3”",
        ),
        (
            HEADER.replace("cellsize 2", "dy 2"),
            "line 6, column 1: expected the header to give cellsize (or dx and dy), found none before the first value",
        ),
        (format!("{HEADER}dx 2\n"), "line 6, column 4: expected either cellsize or dx and dy, not both, found “2”"),
        (format!("{HEADER}xllcenter 2\n"), "line 6, column 11: expected xllcorner or xllcenter, not both, found “2”"),
        (format!("{HEADER}NCOLS 3\n"), "line 6, column 1: expected ncols only once, found “NCOLS”"),
        (
            format!("{HEADER}ncells 3\n"),
            &format!("line 6, column 1: expected a number or one of the keys {keys}, found “ncells”"),
        ),
    ] {
        assert_eq!(message(&text), expected, "{text:?}");
    }
}

#[test]
fn a_file_packed_by_gzip_is_read_whatever_its_name() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("packed.asc");
    let file = std::fs::File::create(&path).unwrap();
    let mut packer = GzEncoder::new(file, Compression::default());
    packer.write_all(format!("{HEADER}1 2 3 4 5 6").as_bytes()).unwrap();
    packer.finish().unwrap();
    let read = EsriGrid::read(&path).unwrap();
    assert_eq!(read.grid.values(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    // What is torn off is told, with the file's name.
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 12]).unwrap();
    let error = EsriGrid::read(&path).unwrap_err();
    assert!(matches!(&error, EsriError::Io { .. }) && error.to_string().contains("packed.asc"), "{error}");
}

/// A stream that gives one byte at a time, and now and then is interrupted.
struct Dripping<'a>(&'a [u8], bool);

impl Read for Dripping<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.1 = !self.1;
        if self.1 {
            return Err(io::ErrorKind::Interrupted.into());
        }
        let most = buffer.len().min(1);
        self.0.read(&mut buffer[..most])
    }
}

#[test]
fn streams_may_break_a_text_anywhere() {
    let text = format!("\u{feff}{HEADER}1 -2.5\r\n-9999 4e2 0 6\r\n");
    let whole = EsriGrid::parse(text.as_bytes()).unwrap();
    let dripping = EsriGrid::read_from(Dripping(text.as_bytes(), false)).unwrap();
    assert_eq!(whole.to_string(), dripping.to_string());
    let error = EsriGrid::read_from(Dripping((text + "\r\n x").as_bytes(), false)).unwrap_err();
    assert!(error.to_string().starts_with("line 9, column 2: expected the end of the file"), "{error}");
}

#[test]
fn texts_longer_than_any_buffer_are_read_and_words_of_that_length_refused() {
    let header = HEADER.replace("ncols 3", "ncols 1000").replace("nrows 2", "nrows 400");
    let values: Vec<String> = (0..400_000).map(|cell| (cell % 1234).to_string()).collect();
    let esri = EsriGrid::parse(format!("{header}{}", values.join(" ")).as_bytes()).unwrap();
    assert!(esri.grid.values().iter().enumerate().all(|(cell, value)| *value == (cell % 1234) as f32));
    let mut lines = values.join("\r\n");
    lines.replace_range(lines.len() - 1.., "x");
    assert!(message(&format!("{header}{lines}")).starts_with("line 400005, column 1: expected a number, found “"));
    assert!(message(&format!("{HEADER}{}", "1".repeat(1 << 20))).contains("expected words of less than"));
}

#[test]
fn a_huge_header_costs_no_memory() {
    let header = HEADER.replace('3', "4000000000").replace("nrows 2", "nrows 4000000000");
    assert!(message(&format!("{header}1 2 3")).contains("found the end of the file after 3"));
}

#[test]
fn files_are_named_in_errors_and_written_back() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("esri_ascii_round_trip.asc");
    // A grid that holds the usual no-data value as a value.
    let grid = Grid::new(uvec2(2, 2), 0.5, vec![-9999.0, f32::NAN, 0.1, 1e-30]).unwrap();
    let corner = dvec2(131_250.125, -7.0);
    EsriGrid { corner, grid }.write(&path).unwrap();
    let read = EsriGrid::read(&path).unwrap();
    assert_eq!(read.corner, corner);
    assert_eq!(read.grid.values()[0], -9999.0);
    assert!(read.grid.values()[1].is_nan());

    let missing = folder.join("no_such.asc");
    let error = EsriGrid::read(&missing).unwrap_err();
    assert!(matches!(error, EsriError::Io { .. }));
    assert!(error.to_string().contains("no_such.asc"));
    std::fs::write(&path, "ncols x").unwrap();
    let error = EsriGrid::read(&path).unwrap_err().to_string();
    assert!(
        error.ends_with("round_trip.asc, line 1, column 7: expected a finite number for ncols, found “x”"),
        "{error}"
    );
    assert!(EsriGrid::read(folder).is_err());
}

fn value() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -100.0_f32..100.0,
        1 => any::<f32>().prop_filter("the format holds no infinity", |value| !value.is_infinite()),
        1 => Just(f32::NAN),
        1 => Just(-9999.0),
    ]
}

fn esri_grid() -> impl Strategy<Value = EsriGrid> {
    let size = (1_u32..12, 1_u32..12).prop_map(UVec2::from);
    (size, 1e-3_f32..1e3, -1e7..1e7_f64, -1e7..1e7_f64).prop_flat_map(|(size, cell_size, x, y)| {
        prop::collection::vec(value(), (size.x * size.y) as usize)
            .prop_map(move |values| EsriGrid { corner: dvec2(x, y), grid: Grid::new(size, cell_size, values).unwrap() })
    })
}

/// Words that a grid could hold, in any order.
fn nearly_a_grid() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        "(?i)(ncols|nrows|xllcorner|yllcenter|cellsize|dx|nodata_value)",
        "-?[0-9]{1,12}([.,][0-9]{0,3})?(e-?[0-9]{1,3})?",
        "\\PC{0,3}",
    ];
    prop::collection::vec((word, "[ \t\r\n]{1,2}"), 0..40)
        .prop_map(|words| words.into_iter().map(|(word, blank)| word + &blank).collect())
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(esri in esri_grid()) {
        let again = EsriGrid::parse(esri.to_string().as_bytes()).unwrap();
        prop_assert_eq!(again.corner, esri.corner);
        prop_assert_eq!(again.grid.size(), esri.grid.size());
        prop_assert_eq!(again.grid.cell_size(), esri.grid.cell_size());
        for (again, value) in again.grid.values().iter().zip(esri.grid.values()) {
            prop_assert!(again == value || again.is_nan() && value.is_nan());
        }
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = EsriGrid::parse(&bytes);
        let _ = EsriGrid::parse(&[HEADER.as_bytes(), &bytes].concat());
    }

    #[test]
    fn misplaced_words_never_panic(text in nearly_a_grid()) {
        let _ = EsriGrid::parse(text.as_bytes());
        let _ = EsriGrid::parse(format!("{HEADER}{text}").as_bytes());
    }
}
