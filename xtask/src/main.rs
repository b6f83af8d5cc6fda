//! Project tasks: parse, call, print. `cargo xtask` alone lists them.

mod bench;
mod circumstances;
mod dashboard;
mod doctor;
mod error_time;
mod gallery;
mod gate;
mod meshes;
mod peers;
mod reproduce;
mod schema;
mod stress;
mod tables;
mod tidy;
mod validate;
mod workspace;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Tasks of the transient photon beams workspace.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Compares the renderers with the analytic reference and with each other (the main job).
    Validate(validate::ValidateArgs),
    /// Stiff and extreme cases: a right answer or a clear error, never a panic or a hang.
    Stress(stress::StressArgs),
    /// Everything that must pass: fmt, clippy, docs, house rules, all tests.
    Test,
    /// Evaluates every row of every JSON table of published and computed values.
    Tables {
        /// Folder of tables [default: validation/tables]
        dir: Option<PathBuf>,
    },
    /// Measures the error of each method against run time: tables, JSON, charts.
    ErrorTime(error_time::ErrorTimeArgs),
    /// Times and counts the renderers' work, and compares with the last run: table, history.
    Bench(bench::BenchArgs),
    /// Renders the scenes of `scenes/` onto one page, or compares the methods on them.
    Gallery(gallery::GalleryArgs),
    /// Writes the meshes and images of the gallery's scenes.
    Meshes,
    /// Writes experiments, errors against run time and benchmarks as a page: target/dashboard.
    Dashboard(dashboard::DashboardArgs),
    /// Says which of the tools that tests, pages and videos need are there, and how to get the rest.
    Doctor,
    /// Makes the paper's scenes and figures again, with errors, delays and caustics: pages, table.
    Reproduce(reproduce::ReproduceArgs),
    /// Compares with other programs (mitransient) on the same scenes at equal CPU seconds.
    Peers(peers::PeersArgs),
    /// Renders the long reference cube of an equal-time comparison.
    ReferenceRender(validate::ReferenceRenderArgs),
    /// Checks scene.schema.json against the code, or writes it.
    Schema {
        /// Write the file instead of checking it
        #[arg(long)]
        write: bool,
    },
    /// Checks the rules of the house: floors, file lengths, one glam.
    Tidy,
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().task {
        Task::Validate(args) => validate::run(&args),
        Task::Stress(args) => stress::run(&args),
        Task::Test => gate::run(),
        Task::Tables { dir } => tables::run(dir),
        Task::ErrorTime(args) => error_time::run(&args),
        Task::Bench(args) => bench::run(&args),
        Task::Gallery(args) => gallery::run(&args),
        Task::Meshes => meshes::run(),
        Task::Dashboard(args) => dashboard::run(&args),
        Task::Doctor => doctor::run(),
        Task::Reproduce(args) => reproduce::run(&args),
        Task::Peers(args) => peers::run(&args),
        Task::ReferenceRender(args) => validate::reference_render(&args),
        Task::Schema { write } => schema::run(write),
        Task::Tidy => tidy::run(),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            workspace::complain(&error.to_string());
            ExitCode::from(2)
        }
    }
}
