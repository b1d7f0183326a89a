//! `cargo xtask river`.

use std::{ffi::OsString, process::ExitCode};

use anyhow::Result;

use crate::{command, setup};

/// Sets the machine up and runs the river example with `args`; its exit code becomes this command's.
pub fn run(args: Vec<OsString>) -> Result<ExitCode> {
    setup::run(setup::Purpose::Run)?;
    let status = command::status(
        command::cargo()
            .args(["run", "--package", "bevy_freshet", "--features", "panel", "--example", "river", "--"])
            .args(with_output(args, setup::has_display())),
    )?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Without a display to open a window on, the picture goes to a file, unless `args` already names one.
fn with_output(mut args: Vec<OsString>, display: bool) -> Vec<OsString> {
    let named = args.iter().any(|arg| arg == "--out" || arg.as_encoded_bytes().starts_with(b"--out="));
    let asks_for_help = args.iter().any(|arg| arg == "--help" || arg == "-h");
    if !display && !named && !asks_for_help {
        args.extend(["--out", "river.png"].map(OsString::from));
    }
    args
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(args: &[&str], display: bool) -> Vec<OsString> {
        with_output(args.iter().map(OsString::from).collect(), display)
    }

    #[test]
    fn draws_into_a_file_only_without_a_display() {
        assert_eq!(output(&["--frames", "9"], false), ["--frames", "9", "--out", "river.png"]);
        assert_eq!(output(&["--frames", "9"], true), ["--frames", "9"]);
    }

    #[test]
    fn keeps_the_file_the_user_names() {
        assert_eq!(output(&["--out", "a.png"], false), ["--out", "a.png"]);
        assert_eq!(output(&["--out=a.png"], false), ["--out=a.png"]);
        assert_eq!(output(&["--help"], false), ["--help"]);
    }
}
