//! The few commands a newcomer types: `cargo xtask setup`, `river`, `test`, `bench` and `assets`.

mod bench;
mod command;
mod example;
mod setup;
mod simulation;
mod test;
mod textures;

use std::{ffi::OsString, process::ExitCode};

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Chores of bevy_freshet.
#[derive(Parser)]
#[command(bin_name = "cargo xtask")]
struct Xtask {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Makes sure that this machine can draw: a Vulkan driver, and the libraries of a window if there is a display
    Setup,
    /// Sets up, then runs the river example: in a window, or into river.png where there is no display
    #[command(disable_help_flag = true)]
    River {
        /// Handed to the example; --help lists them
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<OsString>,
    },
    /// Sets up, then plays back a flood: in a window, or into flood.png where there is no display
    #[command(disable_help_flag = true)]
    Flood {
        /// Handed to the example; --help lists them
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<OsString>,
    },
    /// Sets up, then checks everything: format, lints, documentation, tests
    Test,
    /// Measures what things cost
    #[command(subcommand)]
    Bench(bench::Bench),
    /// Paints the textures in assets/textures anew
    Assets,
}

fn main() -> Result<ExitCode> {
    match Xtask::parse().task {
        Task::Setup => {
            if setup::run(setup::Purpose::Run)? == setup::Outcome::AlreadyComplete {
                println!("Everything is there; nothing to do.");
            }
        }
        Task::River { args } => return example::run("river", args),
        Task::Flood { args } => return example::run("flood", args),
        Task::Test => test::run()?,
        Task::Bench(bench) => return bench::run(bench),
        Task::Assets => textures::write_all()?,
    }
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_commands_are_consistent() {
        Xtask::command().debug_assert();
    }

    #[test]
    fn the_examples_get_every_argument_after_their_names() {
        let xtask = Xtask::try_parse_from(["xtask", "river", "--help", "--frames", "9"]);
        let Ok(Xtask { task: Task::River { args } }) = xtask else {
            panic!("arguments of the example are refused");
        };
        assert_eq!(args, ["--help", "--frames", "9"]);
        let xtask = Xtask::try_parse_from(["xtask", "flood", "converted", "--at", "30min"]);
        let Ok(Xtask { task: Task::Flood { args } }) = xtask else {
            panic!("arguments of the example are refused");
        };
        assert_eq!(args, ["converted", "--at", "30min"]);
    }
}
