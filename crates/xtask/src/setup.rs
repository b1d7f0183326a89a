//! `cargo xtask setup`: what only running needs, beyond the Rust toolchain that building needs.
//!
//! Nothing links a system library. At run time the engine loads the Vulkan loader, the loader loads a driver, and
//! a window loads a few X11 libraries. On Debian and its relatives the missing ones are installed; elsewhere the
//! command to type is printed.

mod machine;
mod plan;
mod system;

use std::{
    io::Write,
    process::{Command, Stdio},
};

use anyhow::{Context, Result, bail};

pub use self::machine::{Purpose, has_display};
use self::{
    machine::{Machine, Rights},
    plan::{Plan, Step},
};

/// What there was to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Nothing was missing.
    AlreadyComplete,
    /// What was missing is installed now.
    Installed,
    /// Something is missing, and the user has been told how to install it.
    Advised,
}

/// Installs what is missing for a purpose, or says how to.
pub fn run(purpose: Purpose) -> Result<Outcome> {
    let machine = Machine::look(purpose);
    let Some(plan) = plan::plan(&machine) else {
        return Ok(Outcome::AlreadyComplete);
    };
    for lack in &plan.lacks {
        println!("setup: {lack}");
    }
    if machine.system.is_debian_like() && machine.rights != Rights::None {
        install(&plan, machine.rights, purpose)?;
        Ok(Outcome::Installed)
    } else {
        advise(&plan);
        Ok(Outcome::Advised)
    }
}

fn install(plan: &Plan, rights: Rights, purpose: Purpose) -> Result<()> {
    println!("setup: installing it with");
    for step in &plan.steps {
        println!("    {}", step.shell(rights));
    }
    for step in &plan.steps {
        carry_out(step, rights)?;
    }
    match plan::plan(&Machine::look(purpose)) {
        None => println!("setup: done"),
        Some(rest) => bail!("these commands succeeded, yet {}", rest.lacks[0]),
    }
    Ok(())
}

fn advise(plan: &Plan) {
    if plan.steps.is_empty() {
        println!("setup: install it with this system's package manager");
    } else {
        println!("setup: install it, as root, with");
        for step in &plan.steps {
            println!("    {}", step.shell(Rights::Root));
        }
    }
}

fn carry_out(step: &Step, rights: Rights) -> Result<()> {
    let line = step.shell(rights);
    let words = step.words(rights);
    let (program, args) = words.split_first().context("an empty command")?;
    let mut command = Command::new(program);
    command.args(args);
    if step.input.is_some() {
        // `tee` echoes what it writes, which has been shown already.
        command.stdin(Stdio::piped()).stdout(Stdio::null());
    }
    let mut child = command.spawn().with_context(|| format!("starting {line}"))?;
    if let Some((text, mut pipe)) = step.input.as_ref().zip(child.stdin.take()) {
        pipe.write_all(text.as_bytes()).with_context(|| format!("feeding {line}"))?;
    }
    let status = child.wait().with_context(|| format!("waiting for {line}"))?;
    if !status.success() {
        bail!("{status} from {line}");
    }
    Ok(())
}
