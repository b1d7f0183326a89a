//! `cargo xtask test`: everything that is checked, here and in continuous integration.

use std::time::{Duration, Instant};

use anyhow::{Result, bail};

use crate::{command, setup};

/// One check.
struct Step {
    name: &'static str,
    /// What cargo is told.
    args: &'static [&'static str],
    rustdocflags: Option<&'static str>,
}

/// Quick checks first; those that compile the same things the same way follow one another.
const STEPS: [Step; 7] = [
    Step::new("format", &["fmt", "--all", "--check"]),
    Step::new("lints", &["clippy", "--workspace", "--all-targets", "--all-features", "--", "-D", "warnings"]),
    // The library alone: dev-dependencies could switch on what a user of the bare plugin does not have.
    Step::new(
        "lints without features",
        &["clippy", "--package", "bevy_freshet", "--lib", "--no-default-features", "--", "-D", "warnings"],
    ),
    Step {
        rustdocflags: Some("-D warnings"),
        ..Step::new("documentation", &["doc", "--workspace", "--all-features", "--no-deps"])
    },
    Step::new(
        "lints of tests without features",
        &["clippy", "--package", "bevy_freshet", "--tests", "--no-default-features", "--", "-D", "warnings"],
    ),
    Step::new("tests", &["test", "--workspace", "--all-features"]),
    Step::new("tests without features", &["test", "--package", "bevy_freshet", "--no-default-features"]),
];

impl Step {
    const fn new(name: &'static str, args: &'static [&'static str]) -> Self {
        Self { name, args, rustdocflags: None }
    }

    /// The command line as one would type it.
    fn line(&self) -> String {
        let environment = self.rustdocflags.map(|flags| format!("RUSTDOCFLAGS='{flags}' ")).unwrap_or_default();
        format!("{environment}cargo {}", self.args.join(" "))
    }

    /// Whether the check passes.
    fn passes(&self) -> Result<bool> {
        let mut cargo = command::cargo();
        cargo.args(self.args);
        if let Some(flags) = self.rustdocflags {
            cargo.env("RUSTDOCFLAGS", flags);
        }
        Ok(command::status(&mut cargo)?.success())
    }
}

/// Sets the machine up and runs each step, up to the first that fails.
pub fn run() -> Result<()> {
    setup::run(setup::Purpose::Test)?;
    let mut took = Vec::new();
    for step in &STEPS {
        println!("\n== {}: {}", step.name, step.line());
        let start = Instant::now();
        let passes = step.passes()?;
        took.push((step.name, start.elapsed()));
        if !passes {
            print_summary(&took);
            bail!("{} failed: {}", step.name, step.line());
        }
    }
    print_summary(&took);
    println!("All passed.");
    Ok(())
}

fn print_summary(took: &[(&str, Duration)]) {
    println!("\n{:<24} {:>8}", "step", "seconds");
    for (name, time) in took {
        println!("{name:<24} {:>8.1}", time.as_secs_f64());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_reads_as_one_would_type_it() {
        let lines = STEPS.map(|step| step.line());
        assert_eq!(lines[0], "cargo fmt --all --check");
        assert_eq!(lines[3], "RUSTDOCFLAGS='-D warnings' cargo doc --workspace --all-features --no-deps");
    }
}
