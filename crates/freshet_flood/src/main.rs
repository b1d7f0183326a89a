//! The command `freshet-flood`: from the rasters of hydraulic models to what the water plugin plays.

mod flow;

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
}

fn main() -> Result<()> {
    match Arguments::parse().command {
        Command::Flow(arguments) => print!("{}", flow::run(&arguments)?),
    }
    Ok(())
}
