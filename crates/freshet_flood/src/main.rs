//! The command `freshet-flood`: from the rasters of hydraulic models to what the water plugin plays.

mod convert;
mod flow;
mod grid;
mod info;
mod source;

use std::io::{self, Write};
use std::process::ExitCode;

use anyhow::{Context, Error, Result};
use clap::{Parser, Subcommand};

/// Prepares terrain and flood rasters for real-time water.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compute the steady flow of a river over a terrain and store it as a flow map.
    Flow(flow::Arguments),
    /// Convert a flood into maps to be played: arrival, depth at every step, current, terrain, maxima.
    Convert(convert::Arguments),
    /// Print a flood at one time as an ESRI ASCII grid.
    Grid(grid::Arguments),
    /// Tell what a raster, an incremental file or a folder of rasters holds.
    Info(info::Arguments),
}

fn main() -> ExitCode {
    match run(Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("Error: {}", message(&error));
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> Result<()> {
    let text = match command {
        Command::Flow(arguments) => flow::run(&arguments)?,
        Command::Convert(arguments) => convert::run(&arguments)?,
        Command::Grid(arguments) => grid::run(&arguments)?,
        Command::Info(arguments) => info::run(&arguments)?,
    };
    match io::stdout().lock().write_all(text.as_bytes()) {
        // Whoever reads may have seen enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written.context("the output cannot be written"),
    }
}

/// What went wrong and why, without causes that what stands before them repeats.
fn message(error: &Error) -> String {
    let causes = error.chain().skip(1).map(ToString::to_string);
    causes.fold(error.to_string(), |text, cause| if text.contains(&cause) { text } else { text + ": " + &cause })
}
