//! The command `freshet-flood`: from the rasters of hydraulic models to what the water plugin plays.

mod flow;
mod info;

use std::io::{self, Write};
use std::process::ExitCode;

use anyhow::{Error, Result};
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
        Command::Info(arguments) => info::run(&arguments)?,
    };
    Ok(io::stdout().write_all(text.as_bytes())?)
}

/// What went wrong and why, without causes that what stands before them repeats.
fn message(error: &Error) -> String {
    let causes = error.chain().skip(1).map(ToString::to_string);
    causes.fold(error.to_string(), |text, cause| if text.contains(&cause) { text } else { text + ": " + &cause })
}
