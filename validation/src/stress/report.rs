//! The table of stress cases as text, Markdown and JSON.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Result, ValidationError};
use crate::stress::case::{Case, Method};
use crate::stress::runner::{Record, StressResult, Verdict};

/// The plan: what will be run.
pub fn plan(cases: &[Case]) -> Vec<String> {
    let width = width(cases);
    let line = |case: &Case| {
        let methods: Vec<_> = case.methods.iter().flatten().map(|method| method.name()).collect();
        let methods = if methods.is_empty() { "-".to_owned() } else { methods.join(" ") };
        format!("  {:width$}  {:36}  {}", case.name, methods, case.risk)
    };
    cases.iter().map(line).collect()
}

/// Width of the column of names.
pub fn width(cases: &[Case]) -> usize {
    cases.iter().map(|case| case.name.len()).max().unwrap_or(0)
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Passed => "passed",
        Verdict::Failed => "FAILED",
        Verdict::LeftOut => "  -   ",
    }
}

/// One row, for the terminal.
pub fn line(record: &Record, width: usize) -> String {
    let Record { case, method, result, verdict, seconds, .. } = record;
    let methods = Method::ALL.map(|method| method.name().len()).into_iter().max().unwrap_or(0);
    let result = result.replace('\n', " ");
    format!("{}  {case:width$}  {method:methods$}  {seconds:6.1} s  {result}", word(*verdict))
}

/// What failed, with what could break; and the line for machines.
pub fn summary(result: &StressResult) -> Vec<String> {
    let mut lines = Vec::new();
    for record in result.records.iter().filter(|record| record.verdict == Verdict::Failed) {
        lines.push(format!("FAILED  {} ({}): {}", record.case, record.method, record.result));
        lines.push(format!("        what could break: {}", record.risk));
        lines.push(format!(
            "        repeat: cargo xtask stress --seed {} --filter '{}'",
            result.seed, record.case
        ));
    }
    lines.push(format!(
        "chance that a sound program is called wrong: {:.1e}; left out with a reason: {}",
        result.false_alarm(),
        result.count(Verdict::LeftOut)
    ));
    let (passed, failed) = (result.count(Verdict::Passed), result.count(Verdict::Failed));
    lines.push(format!(
        "stress: {} cases={} failed={failed} left_out={} seconds={:.1}",
        if result.passed() { "PASSED" } else { "FAILED" },
        passed + failed,
        result.count(Verdict::LeftOut),
        result.seconds
    ));
    lines
}

/// The table as Markdown.
pub fn markdown(result: &StressResult) -> String {
    let mut text = format!(
        "# Stiff and extreme cases\n\nSeed {}, {:.0} s, {} passed, {} failed, {} left out.\n\n\
         | case | method | what could break | result | verdict | s |\n\
         | --- | --- | --- | --- | --- | --- |\n",
        result.seed,
        result.seconds,
        result.count(Verdict::Passed),
        result.count(Verdict::Failed),
        result.count(Verdict::LeftOut),
    );
    for Record { case, method, risk, result, verdict, seconds, .. } in &result.records {
        let cell = |text: &str| text.replace('|', "\\|").replace('\n', " ");
        let verdict = match verdict {
            Verdict::Passed => "passed",
            Verdict::Failed => "**FAILED**",
            Verdict::LeftOut => "left out",
        };
        let row = [case, method, risk, &cell(result), verdict].join(" | ");
        // Writing to a text cannot fail.
        let _ = writeln!(text, "| {row} | {seconds:.1} |");
    }
    text
}

/// Writes `stress.json` and `stress.md` into a folder; the paths that it wrote.
pub fn write(result: &StressResult, folder: &Path) -> Result<Vec<PathBuf>> {
    fs::create_dir_all(folder).map_err(|error| ValidationError::io(folder, error))?;
    let json = folder.join("stress.json");
    write_json(result, &json)?;
    let table = folder.join("stress.md");
    fs::write(&table, markdown(result)).map_err(|error| ValidationError::io(&table, error))?;
    Ok(vec![json, table])
}

/// Writes all rows as JSON.
pub fn write_json(result: &StressResult, path: &Path) -> Result<()> {
    let text = serde_json::to_string_pretty(result)
        .map_err(|error| ValidationError::unusable("results", error))?;
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|error| ValidationError::io(folder, error))?;
    }
    fs::write(path, text + "\n").map_err(|error| ValidationError::io(path, error))
}
