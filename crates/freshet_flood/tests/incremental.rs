//! Incremental files as Sobek and Delft-FLS write them, as they should not be, and as noise.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::fmt::Write;

use freshet_flood::incremental::{Dialect, Incremental};
use freshet_flood::step::{Quantity, Step};
use freshet_hydro::grid::Grid;
use glam::{UVec2, dvec2, uvec2};
use proptest::prelude::*;

/// 3 columns and 2 rows of 4 m, the south-western corner at (10, 20).
const SOBEK: &str = "\
INC1.0
DOMAIN                        NUMBER   ID
                                 1   'RIVER'
MAIN DIMENSIONS                MMAX  NMAX
                        3   2
GRID                           DX      DY      X0      Y0
                        4.00     4.00   12.00  22.00
domain                        END
START TIME T0: 2011.01.01 00:00:00
CLASSES OF INCREMENTAL FILE    Waterdepth(m) Velocity(m/s)  Waterlevel(m) U-velocity(m/s)  V-velocity(m/s)
        0.020    0.100    0.500   -1.000     0.250
        0.100     -999    1.500    1.000      -999
ENDCLASSES
";

const FLS: &str = "\
/* run: breach, created at: 14:23:11, 05-02-2001
MAIN DIMENSIONS                MMAX  NMAX
                        3   2
GRID                           DX      X0      Y0
                        4.00   12.00  22.00
CLASSES OF INCREMENTAL FILE    H         C         Z         U         V
        0.020    0.100    0.500   -1.000     0.250
        0.100     -999    1.500    1.000      -999
ENDCLASSES
";

/// What stands in cells without data here.
const NONE: f32 = 999.0;

fn steps(text: &str) -> Vec<Step> {
    Incremental::new(text.as_bytes()).unwrap().collect::<Result<_, _>>().unwrap()
}

fn values(step: &Step, quantity: Quantity) -> Vec<f32> {
    let raster = step.get(quantity).unwrap();
    raster.values().iter().map(|value| if value.is_nan() { NONE } else { *value }).collect()
}

/// Times and depths.
fn depths(text: &str) -> Vec<(f64, Vec<f32>)> {
    steps(text).iter().map(|step| (step.time, values(step, Quantity::Depth))).collect()
}

fn message(text: &str) -> String {
    let steps = Incremental::new(text.as_bytes()).and_then(|steps| steps.collect::<Result<Vec<_>, _>>());
    steps.unwrap_err().to_string()
}

#[test]
fn the_header_of_either_program_tells_the_same() {
    let [sobek, fls] = [SOBEK, FLS].map(|header| format!("{header}0.0 0 1 1\n"));
    let sobek = Incremental::new(sobek.as_bytes()).unwrap().header().clone();
    let fls = Incremental::new(fls.as_bytes()).unwrap().header().clone();
    assert_eq!((sobek.dialect, fls.dialect), (Dialect::Sobek, Dialect::DelftFls));
    assert_eq!((sobek.start.as_deref(), &fls.start), (Some("2011.01.01 00:00:00"), &None));
    for header in [sobek, fls] {
        let place = header.georeference;
        // X0 and Y0 are the middle of the cell.
        assert_eq!((place.corner, place.cell_size, place.size), (dvec2(10.0, 20.0), 4.0, uvec2(3, 2)));
        assert_eq!(header.quantities, Quantity::ALL.map(Some));
        assert_eq!(header.classes[0], [0.0, 0.02, 0.1]);
        assert_eq!(header.classes[3], [0.0, -1.0, 1.0]);
        assert!(header.classes[1][2].is_nan());
    }
}

#[test]
fn cells_keep_their_value_until_they_are_listed_again() {
    // Column 1 and row 1 are south-west; rows of a grid run from the north.
    let records = "0 1 1\n1 1 2\n0.5 0 1 1\n3 2 1\n1.25 0 1 1\n1 1 0\n";
    let expected = vec![
        (0.0, vec![NONE, NONE, NONE, 0.1, NONE, NONE]),
        (1800.0, vec![NONE, NONE, 0.02, 0.1, NONE, NONE]),
        // Class 0 is the value 0, not no data.
        (4500.0, vec![NONE, NONE, 0.02, 0.0, NONE, NONE]),
    ];
    assert_eq!(depths(&format!("{SOBEK}0.0 {records}")), expected);
    assert_eq!(depths(&format!("{FLS}0.0 {records}").replace(" 0 1 1\n", " 0 1\n")), expected);
}

#[test]
fn every_spelling_gives_the_same_steps() {
    let text = format!("{SOBEK}0.5 0 1 1\n1 1 2\n2 2 1\n");
    let expected = vec![(1800.0, vec![NONE, 0.02, NONE, 0.1, NONE, NONE])];
    assert_eq!(depths(&text), expected);
    let body = format!("{FLS}0.5 0 1\n1 1 2\n2 2 1\n");
    for text in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.to_ascii_lowercase(),
        text.to_ascii_uppercase(),
        format!("\u{feff}{text}"),
        text.replace('\n', "  \t\n  \n   "),
        text.trim_end().into(),
        // Decimal commas; decimals without a leading zero; exponents.
        text.replace('.', ","),
        text.replace("0.5 0 1 1", ".5 0 1 1"),
        text.replace("0.5 0 1 1", "5e-1 0 1 1"),
        // No block of a domain, no start, other words in their places.
        text.replace("DOMAIN                        NUMBER   ID\n                                 1   'RIVER'\n", "")
            .replace("domain                        END\n", ""),
        text.replace("START TIME T0: 2011.01.01 00:00:00\n", ""),
        text.replace("START TIME", "TIME UNIT H\nSTART TIME"),
        text.replace("0.5 0 1 1", "30. 0 1 1").replace("START TIME", "TIME UNIT minutes\nSTART TIME"),
        text.replace("Waterdepth(m)", "Water depth (m)").replace("U-velocity(m/s)", "U velocity [m/s]"),
        text.replace("3   2\n", "3.0  2.0\n"),
        // Columns without names are in the usual order.
        text.replace("Waterdepth(m) Velocity(m/s)  Waterlevel(m) U-velocity(m/s)  V-velocity(m/s)", ""),
        body.clone(),
        body.replace("/* run: breach, created at: 14:23:11, 05-02-2001\n", ""),
        body.replace("05-02-2001\n", "05-02-2001 */\n"),
        body.replace("05-02-2001\n", "05-02-2001\nby hand */\n"),
        // A whole number of hours is told from a cell by the zero in place of its row.
        body.replace("0.5 0 1", "1 0 1").replace("/* run", "TIME UNIT 30min\n/* run").replace("30min", "h"),
    ] {
        let found = depths(&text);
        assert_eq!(found.len(), 1, "{text:?}");
        assert_eq!(found[0].1, expected[0].1, "{text:?}");
        assert!([1800.0, 3600.0].contains(&found[0].0), "{text:?}");
    }
}

#[test]
fn all_quantities_of_a_time_are_one_step() {
    let text = format!(
        "{SOBEK}0.0 0 1 1\n1 1 1\n0.0 0 2 1\n1 1 1\n0.0 0 3 1\n1 1 2\n0.0 0 4 1\n1 1 1\n0.0 0 5 1\n1 1 0\n\
         1.0 0 4 1\n1 1 2\n2 1 1\n1.0 0 1 1\n1.0 0 4 1\n3 1 2\n"
    );
    let steps = steps(&text);
    assert_eq!(steps.iter().map(|step| step.time).collect::<Vec<_>>(), [0.0, 3600.0]);
    let south = |step: &Step, quantity| values(step, quantity)[3..].to_vec();
    let first: Vec<Vec<f32>> = Quantity::ALL.map(|quantity| south(&steps[0], quantity)).into();
    assert_eq!(first.iter().map(|row| row[0]).collect::<Vec<_>>(), [0.02, 0.1, 1.5, -1.0, 0.0]);
    assert_eq!(south(&steps[1], Quantity::East), [1.0, -1.0, 1.0]);
    // What has no record at a time stays as it was.
    assert_eq!(south(&steps[1], Quantity::Level), [1.5, NONE, NONE]);
}

#[test]
fn a_quantity_appears_with_its_first_record_and_an_unknown_one_never() {
    let text = SOBEK.replace("Velocity(m/s)  ", "Salinity(g/l)  ");
    let steps = steps(&format!("{text}0.0 0 1 1\n1 1 1\n1.0 0 2 1\n1 1 1\n1.0 0 3 1\n"));
    assert!(steps[0].get(Quantity::Level).is_none());
    assert_eq!(values(&steps[1], Quantity::Level), [NONE; 6]);
    assert!(steps[1].get(Quantity::Speed).is_none());
}

#[test]
fn a_class_that_the_quantity_does_not_have_is_no_data() {
    let steps = steps(&format!("{SOBEK}0.0 0 2 1\n1 1 1\n1.0 0 2 1\n1 1 2\n"));
    assert_eq!(values(&steps[0], Quantity::Speed)[3], 0.1);
    assert_eq!(values(&steps[1], Quantity::Speed)[3], NONE);
}

#[test]
fn errors_name_line_column_expectation_and_finding() {
    let first = SOBEK.lines().count() + 1;
    let second = first + 1;
    let body = |records: &str| format!("{SOBEK}{records}");
    for (text, line, expected) in [
        (String::new(), 1, "column 1: expected CLASSES OF INCREMENTAL FILE, found the end of the file"),
        (
            "hello world".into(),
            1,
            "column 1: expected MAIN DIMENSIONS, GRID, DOMAIN, START TIME or CLASSES OF INCREMENTAL FILE, \
             found “hello world”",
        ),
        // The header.
        (
            SOBEK.replace("3   2\n", "3   x\n"),
            5,
            "column 29: expected two numbers of columns and rows, MMAX NMAX, found “x”",
        ),
        (
            SOBEK.replace("3   2\n", "3\n"),
            5,
            "column 25: expected two numbers of columns and rows, MMAX NMAX, found “3”",
        ),
        (
            SOBEK.replace("4.00     4.00", "4.00     5.00"),
            7,
            "column 25: expected DY equal to DX, for cells are squares here, found “4.00 5.00 12.00 22.00”",
        ),
        (
            SOBEK.replace("4.00     4.00", "0 0"),
            7,
            "column 25: expected a cell size above zero, found “0 0 12.00 22.00”",
        ),
        (
            SOBEK.replace("domain                        END", "MAIN DIMENSIONS MMAX NMAX\n3 2"),
            8,
            "column 1: expected one domain, for files of several are not read here, found “MAIN DIMENSIONS MMAX NMAX”",
        ),
        (
            SOBEK.replace("GRID ", "/* "),
            10,
            "column 1: expected GRID before the classes, found “CLASSES OF INCREMENTAL FILE Waterdepth(m…”",
        ),
        (
            SOBEK.replace("     0.250", ""),
            12,
            "column 9: expected 4 class values, one for each quantity, found “0.100 -999 1.500 1.000 -999”",
        ),
        (
            SOBEK.replace("ENDCLASSES", ""),
            14,
            "column 1: expected a row of class values or ENDCLASSES, found the end of the file",
        ),
        // Records.
        (body(""), first, "column 1: expected a record (hours, 0, quantity), found the end of the file"),
        (body("1 1 1\n"), first, "column 1: expected a record (hours, 0, quantity), found a cell"),
        (body("0.0 0 6 1\n"), first, "column 7: expected a quantity from 1 to 5, found 6"),
        (body("0.0 0 0 1\n"), first, "column 7: expected a quantity from 1 to 5, found 0"),
        (body("1e400 0 1 1\n"), first, "column 1: expected a finite time, found inf"),
        (body("1.0 0 1 1\n0.5 0 1 1\n"), second, "column 1: expected a time from 1, found 0.5"),
        // Cells.
        (body("0.0 0 1 1\n4 1 1\n"), second, "column 1: expected a column from 1 to 3, found 4"),
        (body("0.0 0 1 1\n0 1 1\n"), second, "column 1: expected a column from 1 to 3, found 0"),
        (body("0.0 0 1 1\n1  3 1\n"), second, "column 4: expected a row from 1 to 2, found 3"),
        (body("0.0 0 1 1\n1 1 3\n"), second, "column 5: expected a class from 0 to 2, found 3"),
        (body("0.0 0 1 1\n1 1 -1\n"), second, "column 5: expected a whole number, found “-1”"),
        (body("0.0 0 1 1\n1 x 1\n"), second, "column 3: expected a whole number, found “x”"),
        (
            body("0.0 0 1 1\nend\n"),
            second,
            "column 1: expected a cell (column, row, class) or a record (hours, 0, quantity), found “end”",
        ),
        (body("0.0 0 1 1\n1 1 1 1 1\n"), second, "column 9: expected at most four numbers on a line, found “1”"),
        // A last line that is torn off.
        (body("0.0 0 1 1\n1 1 1\n2 2"), second + 1, "column 1: expected three or four numbers on a line, found 2"),
    ] {
        assert_eq!(message(&text), format!("line {line}, {expected}"), "{text:?}");
    }
}

#[test]
fn nothing_comes_after_an_error() {
    let text = format!("{SOBEK}0.0 0 1 1\n1.0 0 1 1\n9 9 9\n2.0 0 1 1\n");
    let mut steps = Incremental::new(text.as_bytes()).unwrap();
    assert!(steps.next().unwrap().is_ok());
    assert!(steps.next().unwrap().is_err());
    assert!(steps.next().is_none());
}

#[test]
fn a_huge_domain_costs_no_memory() {
    let text = SOBEK.replace("3   2\n", "4000000000 4000000000\n") + "0.0 0 1 1\n1 1 1\n";
    assert!(message(&text).starts_with("line 5, column 25: expected at most 100000000 cells"));
    // This much is allowed, but costs nothing before the first record is read.
    let text = SOBEK.replace("3   2\n", "10000 10000\n") + "0.0 0 1 1\n1 1 1\n";
    assert_eq!(Incremental::new(text.as_bytes()).unwrap().header().georeference.size, uvec2(10_000, 10_000));
}

const CLASSES: [f32; 4] = [0.0, 0.02, 0.5, 3.25];

/// Times in hours, and for depth and level the class of each cell, if it has one.
type Flood = Vec<(f64, [Vec<Option<usize>>; 2])>;

/// A size, and for each step the hours since the last, and what becomes of each cell: it is left alone, or gets a class.
fn flood() -> impl Strategy<Value = (UVec2, Flood)> {
    let size = (1_u32..6, 1_u32..6).prop_map(UVec2::from);
    let class = prop_oneof![3 => Just(None), 2 => (0..CLASSES.len()).prop_map(Some)];
    size.prop_flat_map(move |size| {
        let cells = prop::collection::vec(class.clone(), (size.x * size.y) as usize);
        let step = (1_u32..100, [cells.clone(), cells]);
        (Just(size), prop::collection::vec(step, 1..6))
    })
    .prop_map(|(size, changes)| {
        let mut flood: Flood = Vec::new();
        for (hundredths, changed) in changes {
            let (mut hours, mut state) =
                flood.last().cloned().unwrap_or((-0.01, changed.clone().map(|cells| vec![None; cells.len()])));
            hours += f64::from(hundredths) / 100.0;
            for (state, changed) in state.iter_mut().zip(changed) {
                for (cell, class) in state.iter_mut().zip(changed) {
                    *cell = class.or(*cell);
                }
            }
            flood.push((hours, state));
        }
        (size, flood)
    })
}

/// The text of a flood: depth is quantity 1 and level 2.
fn written(size: UVec2, flood: &Flood, dialect: Dialect) -> String {
    let mut text = match dialect {
        Dialect::Sobek => "INC1.0\nDOMAIN NUMBER ID\n1 'A'\n",
        Dialect::DelftFls => "",
    }
    .to_string();
    let (grid, domain) = if dialect == Dialect::Sobek { ("2 2 1 1", " 1") } else { ("2 1 1", "") };
    writeln!(text, "MAIN DIMENSIONS MMAX NMAX\n{} {}\nGRID\n{grid}\nCLASSES OF INCREMENTAL FILE H Z", size.x, size.y)
        .unwrap();
    CLASSES[1..].iter().for_each(|class| writeln!(text, " {class} {class}").unwrap());
    text += "ENDCLASSES\n";
    let mut last: [Vec<Option<usize>>; 2] = Default::default();
    for (hours, state) in flood {
        for (quantity, (cells, last)) in state.iter().zip(&mut last).enumerate() {
            writeln!(text, "{hours:.6} 0 {}{domain}", quantity + 1).unwrap();
            for (index, class) in cells.iter().enumerate().filter(|(index, class)| last.get(*index) != Some(*class)) {
                let (column, row) = (index as u32 % size.x + 1, size.y - index as u32 / size.x);
                class.iter().for_each(|class| writeln!(text, "{column} {row} {class}").unwrap());
            }
            last.clone_from(cells);
        }
    }
    text
}

/// Words that a file could hold.
const WORD: &str = "(?i)(main|grid|classes|endclasses|/\\*|inc1.0|-?[0-4](\\.[05])?|-999)";

proptest! {
    #[test]
    fn what_either_program_writes_is_read_back((size, flood) in flood()) {
        for dialect in [Dialect::Sobek, Dialect::DelftFls] {
            let read = steps(&written(size, &flood, dialect));
            prop_assert_eq!(read.len(), flood.len());
            for (step, (hours, state)) in read.iter().zip(&flood) {
                prop_assert!((step.time - hours * 3600.0).abs() < 1e-2);
                for (quantity, cells) in [Quantity::Depth, Quantity::Level].into_iter().zip(state) {
                    let expected = cells.iter().map(|class| class.map_or(NONE, |class| CLASSES[class])).collect();
                    let expected = Grid::new(size, 2.0, expected).unwrap();
                    prop_assert_eq!(values(step, quantity), expected.values());
                }
            }
        }
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for text in [bytes.clone(), [SOBEK.as_bytes(), &bytes].concat(), [FLS.as_bytes(), &bytes].concat()] {
            let _ = Incremental::new(text.as_slice()).map(Iterator::count);
        }
    }

    #[test]
    fn misplaced_words_never_panic(
        words in prop::collection::vec((WORD, "[ \n]"), 0..60),
        cut in 0_usize..500,
    ) {
        let noise: String = words.into_iter().map(|(word, blank)| word + &blank).collect();
        let cut = cut.min(SOBEK.len());
        for text in [noise.clone(), format!("{SOBEK}{noise}"), format!("{}{noise}{}", &SOBEK[..cut], &SOBEK[cut..])] {
            let _ = Incremental::new(text.as_bytes()).map(Iterator::count);
        }
    }
}
