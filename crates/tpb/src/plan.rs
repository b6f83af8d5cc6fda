//! `tpb plan`: what a render of a scene needs, and what it leaves out.

use std::fmt::Write;
use std::process::ExitCode;

use serde_json::{Value, json};
use tpb_scene::Transport;

use crate::cli::{JobArgs, MethodArg, MethodArgs, PlanArgs};
use crate::failure::Failure;
use crate::prepare::{Job, Kept, MethodSpec};
use crate::print;

/// Prints the plan: of the method that is asked for, else of all methods, the one that `render`
/// would choose first.
pub(crate) fn run(args: &PlanArgs) -> Result<ExitCode, Failure> {
    let kept = Kept { window_only: args.window_only, unwarp: args.unwarp };
    let job = Job::new(&args.job, &args.method, kept)?;
    let options = options(&job)?;
    if args.json {
        return print::out_and_done(&as_json(&job, &options));
    }
    let mut text = as_text(&job, &options);
    if args.job.method.is_none() && args.method == MethodArgs::default() {
        let others = match job.method {
            MethodSpec::Beams(_) => [MethodArg::Path, MethodArg::Light],
            MethodSpec::Path(_) => [MethodArg::Beams, MethodArg::Light],
            MethodSpec::Light(_) => [MethodArg::Beams, MethodArg::Path],
        };
        for other in others {
            let of_other = JobArgs { method: Some(other), ..args.job.clone() };
            let job = Job::new(&of_other, &args.method, kept)?;
            text.push('\n');
            text.push_str(&as_text(&job, &self::options(&job)?));
        }
    }
    print::out_and_done(&text)
}

fn options(job: &Job) -> Result<Value, Failure> {
    Ok(match job.plan.transport {
        Transport::Mono => job.method::<1>()?.options(),
        Transport::Rgb => job.method::<3>()?.options(),
    })
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
