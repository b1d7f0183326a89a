//! The command `freshet-flood`: from the rasters of hydraulic models to what the water plugin plays.

mod flow;
mod info;

use anyhow::Result;
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

fn main() -> Result<()> {
    let text = match Arguments::parse().command {
        Command::Flow(arguments) => flow::run(&arguments)?,
        Command::Info(arguments) => info::run(&arguments)?,
    };
    print!("{text}");
    Ok(())
}
