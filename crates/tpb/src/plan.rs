//! `tpb plan`: what a render of a scene needs, and what it leaves out.

use std::fmt::Write;
use std::process::ExitCode;

use serde_json::{Value, json};
use tpb_scene::Transport;

use crate::cli::PlanArgs;
use crate::failure::Failure;
use crate::prepare::Job;
use crate::print;

/// Prints the plan.
pub(crate) fn run(args: &PlanArgs) -> Result<ExitCode, Failure> {
    let job = Job::new(&args.job, &args.method)?;
    let options = match job.plan.transport {
        Transport::Mono => job.method::<1>()?.options(),
        Transport::Rgb => job.method::<3>()?.options(),
    };
    let text = if args.json { as_json(&job, &options) } else { as_text(&job, &options) };
    print::out_and_done(&text)
}

fn as_text(job: &Job, options: &Value) -> String {
    let film = &job.loaded.scene.film;
    let depth = job.integrator.max_depth.map_or_else(|| "any".to_owned(), |max| max.to_string());
    let mut text = format!(
        "method: {}, depths {} to {depth}, Russian roulette from {}\nfilm: {} x {} pixels\n{}",
        job.method.name(),
        job.integrator.min_depth,
        job.integrator.rr_depth,
        film.width,
        film.height,
        job.plan,
    );
    text.push_str("options of the method:\n");
    for (name, value) in options.as_object().into_iter().flatten() {
        let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        // Writing to a text cannot fail.
        let _ = writeln!(text, "  {name:<30} {value}");
    }
    text
}

fn as_json(job: &Job, options: &Value) -> String {
    let film = &job.loaded.scene.film;
    let value = json!({
        "method": job.method.name(),
        "max_depth": job.integrator.max_depth,
        "min_depth": job.integrator.min_depth,
        "rr_depth": job.integrator.rr_depth,
        "film": { "width": film.width, "height": film.height },
        "plan": job.plan,
        "options": options,
    });
    format!("{value:#}")
}
