//! The report of a suite as a Markdown page: circumstances, verdict, statistics, a table of
//! experiments with their twins' verdicts, and what did not pass.

use std::fmt::Write as _;

use crate::experiment::Verdict;
use crate::report::{numbers, remarks};
use crate::suite::{Record, SuiteResult};

/// The whole page.
pub fn report(result: &SuiteResult) -> String {
    let mut page = String::new();
    head(&mut page, result);
    statistics(&mut page, result);
    experiments(&mut page, result);
    failures(&mut page, result);
    details(&mut page, result);
    page
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Passed => "passed",
        Verdict::Failed => "FAILED",
        Verdict::Broken => "BROKEN",
    }
}

fn head(page: &mut String, result: &SuiteResult) {
    let c = &result.circumstances;
    let count = |verdict| result.records.iter().filter(|r| r.verdict == verdict).count();
    let verdict = if result.passed() { "passed" } else { "FAILED" };
    let _ = write!(
        page,
        "# Validation: {verdict}\n\n\
         {} passed, {} failed, {} broken, in {:.0} s.\n\n\
         | | |\n| --- | --- |\n| commit | {} |\n| machine | {} |\n| flags | {} |\n| seed | {} |\n\n",
        count(Verdict::Passed),
        count(Verdict::Failed),
        count(Verdict::Broken),
        result.seconds,
        c.commit,
        c.machine,
        c.flags,
        c.seed,
    );
}

fn statistics(page: &mut String, result: &SuiteResult) {
    let _ = write!(
        page,
        "## Statistics\n\n\
         Chance that a sound program is called wrong: {:.1e}, of a nominal {:.0e} for the whole \
         suite. Chance that noise hides a claim: {:.1e}.\n\n",
        result.false_alarm, result.nominal, result.unresolved
    );
    for rate in result.rates() {
        let _ = writeln!(page, "* Calibration, {}", rate.line());
    }
    page.push('\n');
}

/// Twins of an experiment.
fn twins<'a>(
    result: &'a SuiteResult,
    name: &'a str,
) -> impl Iterator<Item = (&'a str, &'a Record)> {
    result.records.iter().filter_map(move |record| {
        let (label, inner) = record.name.strip_prefix("control/")?.split_once('/')?;
        (inner == name).then_some((label, record))
    })
}

fn experiments(page: &mut String, result: &SuiteResult) {
    page.push_str(
        "## Experiments\n\n\
         The interval is that of the relative error which reaches farthest from 0; p is the smallest \
         p value after Holm's correction. A negative control is the same experiment with a defect \
         made on purpose, at the same budget: it must be rejected.\n\n\
         | experiment | verdict | relative error | p | batches | contrasts | fewest contributions | s | negative controls |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for record in result.records.iter().filter(|r| !r.name.starts_with("control/")) {
        let (interval, p) = numbers(record);
        let controls: Vec<String> = twins(result, &record.name)
            .map(|(label, twin)| {
                let end = if twin.verdict == Verdict::Passed { "rejected" } else { "NOT REJECTED" };
                format!("{label}: {end}")
            })
            .collect();
        let (batches, contrasts, fewest) = counts(record);
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {} | {} | {} | {:.1} | {} |",
            record.name,
            word(record.verdict),
            interval.replace('|', "\\|"),
            p,
            batches,
            contrasts,
            fewest,
            record.seconds,
            controls.join(", ")
        );
    }
    page.push('\n');
}

fn counts(record: &Record) -> (String, String, String) {
    let Some(outcome) = record.outcome.as_ref().filter(|outcome| outcome.batches > 0) else {
        return ("-".into(), "-".into(), "-".into());
    };
    let fewest =
        outcome.contrasts.iter().filter_map(|c| c.contributions).fold(f64::INFINITY, f64::min);
    let fewest = if fewest.is_finite() { format!("{fewest:.1e}") } else { "no noise".into() };
    (outcome.batches.to_string(), outcome.contrasts.len().to_string(), fewest)
}

fn failures(page: &mut String, result: &SuiteResult) {
    let failed: Vec<&Record> =
        result.records.iter().filter(|record| record.verdict != Verdict::Passed).collect();
    if failed.is_empty() {
        return;
    }
    page.push_str("## What did not pass\n\n");
    for record in failed {
        let _ = writeln!(page, "* {}: {}", record.name, word(record.verdict));
        for line in remarks(record) {
            let _ = writeln!(page, "  * {}", line.trim());
        }
    }
    page.push('\n');
}

fn details(page: &mut String, result: &SuiteResult) {
    page.push_str("## Remarks\n\n```text\n");
    for record in &result.records {
        let _ = writeln!(page, "{}: {}", record.name, record.description);
        for line in remarks(record) {
            let _ = writeln!(page, "{line}");
        }
    }
    page.push_str("```\n");
}
