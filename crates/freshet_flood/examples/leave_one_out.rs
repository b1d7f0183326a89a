//! How well the steps of a flood tell what happens between them.
//!
//! `cargo run -p freshet_flood --example leave_one_out -- FOLDER/dm*.asc`

use std::error::Error;

use freshet_flood::raster::Raster;

#[path = "../tests/floods/leave_one_out.rs"]
mod leave_one_out;

fn main() -> Result<(), Box<dyn Error>> {
    let mut steps = Vec::new();
    for path in std::env::args().skip(1) {
        steps.push(Raster::read(path)?.grid.map(|depth| depth.max(0.0)));
    }
    for every in [2, 3, 4] {
        println!("one of {every} steps kept    F1: mean   all  later turning | error of the depth: all  later");
        for (way, row) in leave_one_out::WAYS.iter().zip(leave_one_out::scores(&steps, every)?) {
            let mean = row.steps.iter().sum::<f64>() / row.steps.len() as f64;
            let f1 = [mean, row.all.f1(), row.later.f1(), row.turning.f1()].map(|f1| format!("{f1:.4}")).join(" ");
            println!("{way:24} {f1} | {:.4} m {:.4} m", row.all.error(), row.later.error());
        }
    }
    Ok(())
}
