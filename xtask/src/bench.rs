//! `cargo xtask bench`: times and counts the renderers, and compares with the last run.

mod callgrind;
mod cases;
mod costs;
mod programs;
mod tables;

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;
use tpb_dashboard::bench_runs::{self, BenchRun, Case, Counted};
use tpb_dashboard::benchmarks::{self, Benchmark, CommitBy};
use tpb_dashboard::lines;
use tpb_validation::suite::matches;
use xshell::cmd;

use self::callgrind::Callgrind;
use self::cases::{CASES, COUNTED_EDGE};
use self::programs::{Programs, Said};
use crate::circumstances::{self, commit, machine};
use crate::validate::HISTORY;
use crate::workspace::{Outcome, root, say};

/// Options of `cargo xtask bench`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask bench                       Criterion's benchmarks, whole renders, instructions; about 15 minutes
  cargo xtask bench --quick               whole renders and instructions, without Criterion; below 2 minutes
  cargo xtask bench --quick --filter 'kernel/*'
  cargo xtask bench --quick --costs --filter 'cost/*'   what scenes pay for what they do not need

Everything runs on one thread, as `cargo build --release` makes it. Instructions are counted by Valgrind
(Callgrind) on small films: those of 2n passes less those of n. Valgrind does not know AVX-512: the line
says which vector instructions the timed and the counted program used. Without Valgrind nothing is
counted.

Each run is a line of history.jsonl in --out; it is compared there, and in benches/history.jsonl, with the
last run of the same machine and build. `cargo xtask dashboard` draws them.")]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line are independent")]
pub(crate) struct BenchArgs {
    /// Whole renders once and instructions, without Criterion's benchmarks
    #[arg(long)]
    quick: bool,
    /// Only what has a name that matches (`*`, `?`; plain text: contains it)
    #[arg(long, value_name = "GLOB")]
    filter: Option<String>,
    /// Also count what scenes pay for what they do not need; 5 minutes, builds tpb without media
    #[arg(long)]
    costs: bool,
    /// Turns, of which the fastest counts [default: 3, or 1 with --quick]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    turns: Option<u32>,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Also keep the run in benches/history.jsonl, which is under version control
    #[arg(long)]
    record: bool,
    /// Print the names and stop
    #[arg(long)]
    list: bool,
    /// Folder of history.jsonl and of results [default: target/bench]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Files of runs: the one that every run writes, and the one that is kept.
pub(crate) fn histories(from: &Path) -> [PathBuf; 2] {
    [from.join("bench").join(HISTORY), kept()]
}

/// The history that is under version control.
fn kept() -> PathBuf {
    root().join("benches").join(HISTORY)
}

/// Measures, compares, prints, and keeps; true if all goals of costs are met.
pub(crate) fn run(args: &BenchArgs) -> Outcome {
    let wanted = |name: &str| args.filter.as_ref().is_none_or(|glob| matches(glob, name));
    let chosen: Vec<&cases::Case> = CASES.iter().filter(|case| wanted(case.name)).collect();
    let some_costs = args.costs && costs::names().any(wanted);
    if args.list {
        let costs = costs::names().filter(|name| args.costs && wanted(name));
        chosen.iter().map(|case| case.name).chain(costs).for_each(say);
        return Ok(true);
    }
    if chosen.is_empty() && !some_costs && args.quick {
        return Err("nothing matches the filter; --list shows all".into());
    }
    let out = args.out.clone().unwrap_or_else(|| root().join("target/bench"));
    say("building");
    let programs = Programs::build(out.clone(), !chosen.is_empty())?;
    let callgrind = Callgrind::find(programs.shell());
    if callgrind.is_none() {
        say("note: no Valgrind was found (apt-get install valgrind): instructions are not counted");
    }
    let mut run = BenchRun {
        commit: commit(),
        machine: machine(None),
        features: features(),
        compiler: first_line(&cmd!(programs.shell(), "rustc --version").quiet().read()?),
        build: build()?,
        flags: circumstances::of(None, args.seed).flags,
        seed: args.seed,
        cases: time(args, &programs, &chosen)?,
        ..BenchRun::default()
    };
    if let Some(callgrind) = &callgrind {
        count(args, &programs, callgrind, &chosen, &mut run.cases)?;
    }
    run.seconds = run.cases.iter().map(|case| case.wall_seconds).sum();
    run.cpu_seconds = run.cases.iter().map(|case| case.cpu_seconds).sum();
    if !args.quick {
        run.benchmarks = criterion(args, &programs)?;
    }
    match &callgrind {
        Some(callgrind) if some_costs => {
            run.costs = costs::measure(&programs, callgrind, args.seed, wanted)?;
        }
        _ => {}
    }
    run.time = now()?;
    finish(args, &run, &out)
}

/// Compares with earlier runs, prints, and adds the line to the histories.
fn finish(args: &BenchArgs, run: &BenchRun, out: &Path) -> Outcome {
    let (own, kept) = (out.join(HISTORY), kept());
    let mut earlier: Vec<BenchRun> = lines::read(&own)?.values;
    earlier.extend(lines::read(&kept)?.values);
    let changes = bench_runs::changes(run, &bench_runs::merge(earlier));
    say("");
    if !run.cases.is_empty() {
        for line in tables::cases(run, &changes) {
            say(&line);
        }
        let mut commits: Vec<_> = changes.iter().flatten().map(|c| c.commit.as_str()).collect();
        commits.sort_unstable();
        commits.dedup();
        say(&match commits.as_slice() {
            [] => "no run of this machine and build is there to compare with".to_owned(),
            commits => format!("last: new over old, old = {}", commits.join(", ")),
        });
        say(&vectors(run));
    }
    if !run.costs.is_empty() {
        say("");
        for line in tables::costs(&run.costs) {
            say(&line);
        }
    }
    lines::append(&own, std::slice::from_ref(run))?;
    if args.record {
        lines::append(&kept, std::slice::from_ref(run))?;
    }
    say(&format!("added to {}", own.display()));
    Ok(run.costs.iter().all(|cost| cost.met() != Some(false)))
}

/// Times the cases in turns, so that a busy machine slows all alike; the fastest turn counts.
fn time(
    args: &BenchArgs,
    programs: &Programs,
    chosen: &[&cases::Case],
) -> Result<Vec<Case>, Box<dyn Error>> {
    let turns = args.turns.unwrap_or(if args.quick { 1 } else { 3 });
    let mut best: Vec<Option<Case>> = vec![None; chosen.len()];
    for turn in 0..turns {
        if !chosen.is_empty() {
            say(&format!("timing {} cases, turn {} of {turns}", chosen.len(), turn + 1));
        }
        for (case, best) in chosen.iter().zip(&mut best) {
            let command = programs.command(case.work, case.arguments(case.timed, args.seed, None));
            let said = command.run(programs.shell(), &[])?;
            if best.as_ref().is_none_or(|best| said.cpu_seconds < best.cpu_seconds) {
                *best = Some(timed(case, command.shown, said));
            }
        }
    }
    Ok(best.into_iter().flatten().collect())
}

fn timed(case: &cases::Case, command: String, said: Said) -> Case {
    let rate = |(what, work): (String, f64)| (what, work / said.cpu_seconds);
    Case {
        name: case.name.to_owned(),
        command,
        passes: case.timed,
        cpu_seconds: said.cpu_seconds,
        wall_seconds: said.wall_seconds,
        vectors: said.vectors,
        rates: said.work.into_iter().map(rate).collect(),
        counted: None,
    }
}

/// Counts the instructions of the cases.
fn count(
    args: &BenchArgs,
    programs: &Programs,
    callgrind: &Callgrind,
    chosen: &[&cases::Case],
    found: &mut [Case],
) -> Result<(), Box<dyn Error>> {
    if !chosen.is_empty() {
        say(&format!("counting the instructions of {} cases", chosen.len()));
    }
    let file = programs.file("callgrind.out");
    for (case, found) in chosen.iter().zip(found) {
        let make = |passes| {
            let arguments = case.arguments(passes, args.seed, Some(COUNTED_EDGE));
            programs.command(case.work, arguments)
        };
        let count = callgrind.count(programs.shell(), &file, case.counted, make)?;
        let work = count.said.work.into_iter().map(|(what, n)| (what, n / case.counted as f64));
        found.counted = Some(Counted {
            command: make(case.counted).shown,
            instructions: count.instructions,
            work: work.collect::<BTreeMap<_, _>>(),
            tool: callgrind.name.clone(),
            vectors: count.said.vectors,
        });
    }
    Ok(())
}

/// Runs Criterion's benchmarks and reads what they left.
fn criterion(args: &BenchArgs, programs: &Programs) -> Result<Vec<Benchmark>, Box<dyn Error>> {
    let started = now()?;
    let sh = programs.shell();
    let pattern: Vec<String> = args.filter.iter().map(|glob| regex(glob)).collect();
    cmd!(sh, "cargo bench --package tpb-benches -- {pattern...}").quiet().run()?;
    let commit = commit();
    let folder = root().join("target/criterion");
    let found =
        benchmarks::collect(&folder, &[], &machine(None), |_| (commit.clone(), CommitBy::Run))?;
    Ok(found.into_iter().filter(|benchmark| benchmark.time >= started).collect())
}

/// A pattern of `*` and `?` as a regular expression.
fn regex(glob: &str) -> String {
    let open = !glob.contains(['*', '?']);
    let body: String = glob
        .chars()
        .map(|c| match c {
            '*' => ".*".to_owned(),
            '?' => ".".to_owned(),
            c if c.is_ascii_punctuation() && !"/_-,= ".contains(c) => format!("\\{c}"),
            c => c.to_string(),
        })
        .collect();
    if open { body } else { format!("^{body}$") }
}

/// Which vector instructions were used.
fn vectors(run: &BenchRun) -> String {
    let mut timed: Vec<_> = run.cases.iter().map(|case| case.vectors.as_str()).collect();
    let counted = run.cases.iter().filter_map(|case| case.counted.as_ref());
    let mut counted: Vec<_> = counted.map(|counted| counted.vectors.as_str()).collect();
    for list in [&mut timed, &mut counted] {
        list.sort_unstable();
        list.dedup();
    }
    let counted = if counted.is_empty() { vec!["nothing"] } else { counted };
    format!("vectors: {} timed, {} counted", timed.join(", "), counted.join(", "))
}

/// Instruction sets of the processor that matter here.
fn features() -> Vec<String> {
    #[cfg(target_arch = "x86_64")]
    let found = [
        ("sse4.2", is_x86_feature_detected!("sse4.2")),
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("bmi2", is_x86_feature_detected!("bmi2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
        ("avx512dq", is_x86_feature_detected!("avx512dq")),
        ("avx512vl", is_x86_feature_detected!("avx512vl")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let found = [(std::env::consts::ARCH, true)];
    found.iter().filter(|(_, there)| *there).map(|(name, _)| (*name).to_owned()).collect()
}

/// The profile that programs are built with, and the flags of the environment.
fn build() -> Result<String, Box<dyn Error>> {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml"))?;
    let flags = ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_RUSTFLAGS"];
    #[expect(clippy::disallowed_methods, reason = "what cargo builds with is told, not obeyed")]
    let flags = flags.iter().filter_map(|name| std::env::var(name).ok());
    let flags: Vec<String> = flags.filter(|flags| !flags.is_empty()).collect();
    let flags = if flags.is_empty() { "none".to_owned() } else { flags.join(" ") };
    Ok(format!("{}, flags: {flags}", profile(&manifest)))
}

/// The release profile of a manifest, on one line.
fn profile(manifest: &str) -> String {
    let lines = manifest.lines().map(str::trim);
    let of_profile = lines.skip_while(|line| *line != "[profile.release]").skip(1);
    let settings = of_profile
        .take_while(|line| !line.starts_with('['))
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    std::iter::once("release").chain(settings).collect::<Vec<_>>().join(", ")
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

/// Whole seconds since 1970.
fn now() -> Result<u64, Box<dyn Error>> {
    Ok(SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_of_both_kinds_mean_the_same() {
        assert_eq!(regex("gather"), "gather");
        assert_eq!(regex("gather/*, R = 0.0?5"), r"^gather/.*, R = 0\.0.5$");
    }

    #[test]
    fn the_profile_is_that_of_the_manifest() {
        let text = "[lints]\nx = 1\n\n[profile.release]\ndebug = \"none\"\n# why\nlto = true\n\n\
                    [profile.dev]\nopt-level = 1\n";
        assert_eq!(profile(text), "release, debug = \"none\", lto = true");
        assert_eq!(profile("[profile.dev]\nopt-level = 1\n"), "release");
        assert!(build().unwrap().starts_with("release, "));
    }
}
