//! How fast the text readers are, in MB/s of text in memory on one core: `cargo bench -p freshet_flood --bench reading`,
//! or with `--profile dev` as the examples are built.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Instant;

use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::incremental::Incremental;

/// Columns and rows.
const SIZE: usize = 2000;

fn main() {
    let depths = (0..SIZE * SIZE).map(|cell| (cell * 7919 % 10_007) as f64 / 2001.0);
    let grid = |value: fn(f64) -> String| {
        let header = format!("ncols {SIZE}\nnrows {SIZE}\nxllcorner 0\nyllcorner 0\ncellsize 5\nnodata_value -9999\n");
        let mut text = header;
        for (cell, depth) in depths.clone().enumerate() {
            text += &value(depth);
            text += if cell % SIZE == SIZE - 1 { "\n" } else { " " };
        }
        text
    };
    esri_ascii("ESRI grid, 4 decimals", &grid(|depth| format!("{depth:.4}")));
    esri_ascii("ESRI grid, 8 decimals", &grid(|depth| format!("{depth:.8}")));
    esri_ascii(
        "ESRI grid, mostly -9999",
        &grid(|depth| if depth < 4.5 { "-9999".into() } else { format!("{depth:.4}") }),
    );
    esri_ascii("ESRI grid, decimal commas", &grid(|depth| format!("{depth:.4}").replace('.', ",")));
    incremental();
}

fn esri_ascii(name: &str, text: &str) {
    measure(name, text, || {
        black_box(EsriGrid::parse(text.as_bytes()).expect("a grid"));
    });
}

fn incremental() {
    let mut text = format!("MAIN DIMENSIONS MMAX NMAX\n{SIZE} {SIZE}\nGRID DX X0 Y0\n5 0 0\n");
    text += "CLASSES OF INCREMENTAL FILE H\n0.02\n0.1\n0.5\n1\n2\n5\nENDCLASSES\n";
    for record in 0..4 {
        let _ = writeln!(text, "{}.5 0 1", record);
        for cell in 0..SIZE * SIZE {
            let (column, row) = (cell % SIZE + 1, cell / SIZE + 1);
            let _ = writeln!(text, "{column} {row} {}", (cell + record) % 7);
        }
    }
    measure("incremental file", &text, || {
        for step in Incremental::new(text.as_bytes()).expect("a file") {
            black_box(step.expect("a step"));
        }
    });
}

/// Prints the best of some runs.
fn measure(name: &str, text: &str, run: impl Fn()) {
    let seconds = (0..5).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    let best = seconds.fold(f64::INFINITY, f64::min);
    println!("{name:28} {:6.1} MB {:7.0} MB/s", text.len() as f64 / 1e6, text.len() as f64 / 1e6 / best);
}
