//! `cargo xtask river` and `cargo xtask flood`.

use std::{ffi::OsString, process::ExitCode};

use anyhow::Result;

use crate::{command, setup};

/// Sets the machine up and runs the example `name` with `args`; its exit code becomes this command's.
pub fn run(name: &str, args: Vec<OsString>) -> Result<ExitCode> {
    setup::run(setup::Purpose::Run)?;
    let status = command::status(
        command::cargo()
            .args(["run", "--package", "bevy_freshet", "--features", "panel", "--example", name, "--"])
            .args(with_output(name, args, setup::has_display())),
    )?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Without a display to open a window on, the picture goes to a file, unless `args` already names one.
fn with_output(name: &str, mut args: Vec<OsString>, display: bool) -> Vec<OsString> {
    let names = |arg: &OsString, option: &str| {
        let bytes = arg.as_encoded_bytes();
        bytes.strip_prefix(option.as_bytes()).is_some_and(|rest| rest.is_empty() || rest.starts_with(b"="))
    };
    let named = args.iter().any(|arg| names(arg, "--out") || names(arg, "--film"));
    let asks_for_help = args.iter().any(|arg| arg == "--help" || arg == "-h");
    if !display && !named && !asks_for_help {
        args.extend(["--out".into(), format!("{name}.png").into()]);
    }
    args
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(args: &[&str], display: bool) -> Vec<OsString> {
        with_output("river", args.iter().map(OsString::from).collect(), display)
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
        assert_eq!(output(&["--film", "a.gif"], false), ["--film", "a.gif"]);
        assert_eq!(output(&["--help"], false), ["--help"]);
    }
}
