//! The `tpb` program: transient renders of scenes with participating media.
//!
//! Thin: it parses the command line, calls the crates below, and prints. One module per
//! subcommand; beside them
//!
//! * [`cli`], [`values`]: the command line, and values with units on it;
//! * [`prepare`]: what `render` and `plan` share — the scene, its plan, the method;
//! * [`folder`]: the result folder, safe against accidents;
//! * [`mod@reference`]: analytic solutions;
//! * [`video`]: results as videos;
//! * [`viewer`]: results as pages, and their error numbers;
//! * [`watch`]: progress bar and ctrl-c;
//! * [`failure`], [`mod@print`]: all that is printed goes through these.
//!
//! Exit codes: 0 done; 1 done, but the result is not sound; 2 bad usage, input or files. A reader
//! that closes the pipe early is no failure.

mod cli;
mod failure;
mod folder;
mod info;
mod plan;
mod prepare;
mod print;
mod reference;
mod render;
mod schema;
mod summary;
mod values;
mod video;
mod viewer;
mod watch;

use std::process::ExitCode;

use clap::Parser;

use cli::{Cli, Command};

fn main() -> ExitCode {
    let outcome = match &Cli::parse().command {
        Command::Render(args) => render::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Info(args) => info::run(args),
        Command::Reference(args) => reference::run(args),
        Command::View(args) => viewer::view(args),
        Command::Compare(args) => viewer::compare(args),
        Command::Video(args) => video::run(args),
        Command::Schema => schema::run(),
    };
    match outcome {
        Ok(code) => code,
        Err(failure) => failure.report(),
    }
}
