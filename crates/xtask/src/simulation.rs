//! `cargo xtask bench simulation`: one table of what a step of the shallow water costs on the CPU and on the GPU.

use std::process::{Command, ExitCode, Stdio};

use anyhow::{Context, Result, ensure};

use crate::command;

/// A row of the bench of `freshet_hydro`: cells, one core, share of the memory's bound, all cores.
struct OnCpu<'a> {
    cells: &'a str,
    one: &'a str,
    share: &'a str,
    all: &'a str,
}

/// Runs both measurements, one after the other, and prints their table in Markdown.
pub fn run() -> Result<ExitCode> {
    let on_cpu = output(command::cargo().args(["bench", "--package", "freshet_hydro", "--bench", "shallow_water"]))?;
    let test = ["test", "--package", "bevy_freshet", "--lib", "costs_of_steps", "--", "--ignored", "--nocapture"];
    let on_gpu = output(command::cargo().args(test))?;
    if let Some(bound) = on_cpu.lines().find(|line| line.starts_with("triad")) {
        println!("{bound}");
    }
    print!("{}", table(&on_cpu, &on_gpu));
    println!("\nUnits: M cell-steps/s. The GPU path is timed by frames, with all that a frame does beside its steps.");
    Ok(ExitCode::SUCCESS)
}

/// What a program prints; its complaints go to the terminal.
fn output(program: &mut Command) -> Result<String> {
    let output = program.stderr(Stdio::inherit()).output().context("starting a measurement")?;
    ensure!(output.status.success(), "a measurement failed: {}", output.status);
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn table(on_cpu: &str, on_gpu: &str) -> String {
    let mut table =
        "| cells | one core | of the bound | all cores | GPU path | of all cores |\n|---|---|---|---|---|---|\n"
            .to_owned();
    for OnCpu { cells, one, share, all } in on_cpu.lines().filter_map(row) {
        let gpu = gpu_rate(on_gpu, cells);
        let ratio = gpu.and_then(|gpu| Some(gpu / all.parse::<f64>().ok()?));
        let shown =
            |value: Option<f64>, digits: usize| value.map_or("–".to_owned(), |value| format!("{value:.digits$}"));
        table += &format!("| {cells} | {one} | {share} | {all} | {} | {} |\n", shown(gpu, 1), shown(ratio, 2));
    }
    table
}

/// The row that a line of the bench is, if it is one.
fn row(line: &str) -> Option<OnCpu<'_>> {
    let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
    match cells[..] {
        [cells, one, _, share, all, _] if cells.ends_with('²') => Some(OnCpu { cells, one, share, all }),
        _ => None,
    }
}

/// The rate in a line like `64²: 3958 steps, 17.7 M cell-steps/s, twin 156.4`.
fn gpu_rate(on_gpu: &str, cells: &str) -> Option<f64> {
    let line = on_gpu.lines().find_map(|line| line.strip_prefix(cells)?.strip_prefix(':'))?;
    line.split(", ").nth(1)?.split(' ').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_measurements_meet_in_a_table() {
        let on_cpu = "triad: 37.2 GB/s\n| cells | one |\n|---|---|\n| 64² | 100.0 | 10.00 | 9.8 % | 200.0 | 2.00 |\n\
                      | 2048² | 90.0 | 11.11 | 9.0 % | 150.0 | 1.67 |\n";
        let on_gpu = "running 1 test\n64²: 3958 steps, 50.0 M cell-steps/s, twin 156.4\n";
        let table = table(on_cpu, on_gpu);
        assert!(table.contains("| 64² | 100.0 | 9.8 % | 200.0 | 50.0 | 0.25 |"), "{table}");
        assert!(table.ends_with("| 2048² | 90.0 | 9.0 % | 150.0 | – | – |\n"), "{table}");
    }
}
