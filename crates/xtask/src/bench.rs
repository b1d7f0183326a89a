//! `cargo xtask bench`.

use std::{ffi::OsString, process::ExitCode};

use anyhow::Result;
use clap::Subcommand;

use crate::{command, setup, simulation};

/// What to measure.
#[derive(Subcommand)]
pub enum Bench {
    /// What the parts of the river cost: tables in Markdown, as ratios to "all on"
    #[command(disable_help_flag = true)]
    Features {
        /// Handed to the bench; --help lists them
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<OsString>,
    },
    /// What a step of the shallow water costs: on one core, on all, and on the GPU
    Simulation,
}

/// Sets the machine up and runs a bench; its exit code becomes this command's.
pub fn run(bench: Bench) -> Result<ExitCode> {
    setup::run(setup::Purpose::Run)?;
    let Bench::Features { args } = bench else { return simulation::run() };
    let bench = ["run", "--package", "bevy_freshet", "--example", "bench_features", "--"];
    let status = command::status(command::cargo().args(bench).args(args))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
