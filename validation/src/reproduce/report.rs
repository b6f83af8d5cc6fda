//! What pages of all scenes share: the numbers and curves of a comparison, and where they come from.

use std::path::Path;

use tpb_viewer::{Factors, PageReport};

use super::compare::{Comparison, Part};
use super::losses::losses;
use super::page::Page;
use super::race::Replicate;
use super::truth::Origin;
use super::{charts, tables, write_text};
use crate::error::{Result, ValidationError};
use crate::statistics::Winner;
use crate::suite::Circumstances;

/// Tables: by render time, by window of time, by kind of cell, and who wins which bins.
pub(crate) fn numbers(page: &mut Page, comparison: &Comparison, commit: &str) {
    page.heading("Numbers");
    if let Some(origin) = &comparison.reference {
        page.note(&made_by(origin, commit));
    }
    page.note(&precision(comparison));
    page.table(
        &format!(
            "By render time, over judged pixels; {} replicates each; reference of {:.0} CPU s, own NMSE {:.1e}",
            comparison.replicates, comparison.reference_cpu_seconds, comparison.reference_nmse
        ),
        &tables::BY_TIME,
        &tables::by_time(comparison),
    );
    let lamps: Vec<Part> = comparison.lamps.iter().cloned().collect();
    for (what, caption, parts) in [
        ("OPL", "By window of time, at the whole render time", &comparison.windows),
        ("cells", "By kind of cell: where beams win, and where they lose", &comparison.kinds),
        ("pixels", "Pixels that are not judged; share of all pixels' \u{3a3}r\u{b2}", &lamps),
    ] {
        if !parts.is_empty() {
            let heads = tables::by_part_heads(what, comparison);
            let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
            page.table(caption, &heads, &tables::by_part(comparison, parts));
        }
    }
    let parts = &comparison.kinds_in_windows;
    if !parts.is_empty() {
        let heads = tables::by_part_heads("cells, OPL", comparison);
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        let rows = tables::by_part(comparison, parts);
        page.folded_table("By kind of cell and window of time", &heads, &rows);
    }
    lost(page, comparison);
    page.list(&[tables::won(comparison, Winner::First), tables::won(comparison, Winner::Second)]);
}

/// Where a reference comes from; `commit` is that of the errors.
fn made_by(origin: &Origin, commit: &str) -> String {
    let Origin { method, batches, passes, commits, commands } = origin;
    let commits_text = commits.join(", ");
    if *batches == 0 {
        return format!(
            "The reference ships with the scene: {method}, {passes} passes, by sources of commit \
             {commits_text}."
        );
    }
    let by = if commands.is_empty() {
        String::new()
    } else {
        format!(", by `{}`", commands.join("`, then `"))
    };
    let other = if commits.iter().all(|made| made == commit) {
        ""
    } else {
        ". ATTENTION: these are not the sources of the renders that it judges"
    };
    format!(
        "The reference: {method}, {batches} batches of {passes} passes, by sources of commit \
         {commits_text}{by}{other}."
    )
}

/// What the reference's own noise lets be known, and what not.
fn precision(comparison: &Comparison) -> String {
    let own = comparison.reference_nmse;
    let errors = comparison.whole().methods.iter().map(|method| method.judged.nmse.value);
    let noisier: Vec<&str> = comparison
        .methods
        .iter()
        .zip(errors)
        .filter(|&(_, error)| own > error)
        .map(|(name, _)| name.as_str())
        .collect();
    let subtracted = "It is measured from the spread of its batches and subtracted, so that errors \
                      below are those from the truth; viewers do not subtract it, and judge one \
                      replicate, channel by channel: their numbers are larger.";
    if noisier.is_empty() {
        return format!("The reference's own NMSE is {own:.1e}. {subtracted}");
    }
    format!(
        "The reference's own NMSE is {own:.1e}: it is noisier than what it judges of {}. {subtracted} \
         Sums over many cells can be judged so, with wider intervals; single cells, dark frames and \
         pictures cannot: there more grain in the reference says nothing about the methods.",
        noisier.join(" and ")
    )
}

/// Where beams lose, and why; or that nothing such was found.
pub(crate) fn lost(page: &mut Page, comparison: &Comparison) {
    let rows: Vec<Vec<String>> = losses(comparison).into_iter().map(tables::loss).collect();
    if rows.is_empty() {
        page.note(
            "No kind of cell, window of time or kind within a window was found in which beams lose, \
             each with its interval.",
        );
        return;
    }
    page.table("Where beams lose, each with its interval, and why", &tables::LOSS, &rows);
}

/// Charts, in the page and as files whose names end with the suffix.
pub(crate) fn curves(
    page: &mut Page,
    out: &Path,
    title: &str,
    comparison: &Comparison,
    suffix: &str,
) -> Result<()> {
    page.heading("Curves");
    for (file, svg, alt) in [
        (
            "error-by-bin",
            charts::error_by_bin(comparison, title)?,
            "NMSE of every bin over judged pixels, with 95 % intervals. Bins whose error is not \
             resolved from 0 leave gaps.",
        ),
        (
            "factor-by-bin",
            charts::factor_by_bin(comparison, title)?,
            "Times less NMSE \u{d7} CPU s of photon beams in every bin, with 95 % intervals. Below 1 \
             path tracing wins.",
        ),
        (
            "signal-by-bin",
            charts::signal_by_bin(comparison, title)?,
            "Share of the signal in every bin: how much each counts in the NMSE of the whole.",
        ),
        (
            "error-by-time",
            charts::error_by_time(comparison, title)?,
            "NMSE of the whole cube against CPU time, with 95 % intervals; squared bias where it is \
             resolved.",
        ),
    ] {
        write_text(&out.join(format!("{file}{suffix}.svg")), &svg)?;
        page.chart(&svg, alt);
    }
    Ok(())
}

/// Writes a viewer's page; what is to be said of it where it is linked.
pub(crate) fn viewer(path: &Path, comparison: &tpb_viewer::Comparison<'_>) -> Result<String> {
    let written = tpb_viewer::write_comparison(path, comparison)
        .map_err(|error| ValidationError::unusable("viewer page", error))?;
    Ok(shown(&written))
}

fn shown(written: &PageReport) -> String {
    let size = written.bytes as f64 / 1e6;
    let shape = |[rows, columns, bins]: [usize; 3]| {
        format!("{columns} \u{d7} {rows} pixels \u{d7} {bins} bins")
    };
    if written.factors == Factors::NONE {
        return format!("{size:.1} MB, {}: all that was rendered", shape(written.rendered));
    }
    let Factors { pixels, bins } = written.factors;
    format!(
        "{size:.1} MB, {}, reduced from {} to keep the page small: means of {pixels} \u{d7} {pixels} \
         pixels, sums of {bins} bins; error numbers are of the full arrays",
        shape(written.shown),
        shape(written.rendered)
    )
}

/// What the viewer shows of it.
pub(crate) fn provenance_of(circumstances: &Circumstances) -> Vec<(String, String)> {
    vec![
        ("commit".into(), circumstances.commit.clone()),
        ("machine".into(), circumstances.machine.clone()),
    ]
}

/// What the viewer shows of one run: what was spent on it, and its effective options.
pub(crate) fn provenance_of_run(
    circumstances: &Circumstances,
    run: &Replicate,
) -> Vec<(String, String)> {
    let mut rows = provenance_of(circumstances);
    rows.push(("seed".into(), run.seed.to_string()));
    if let Some(spent) = run.spent.last() {
        rows.push(("passes".into(), spent.passes.to_string()));
        rows.push(("wall s".into(), format!("{:.2}", spent.wall_seconds)));
        rows.push(("CPU s".into(), format!("{:.2}", spent.cpu_seconds)));
    }
    let options = run.options.as_object().into_iter().flatten();
    let options: Vec<String> = options
        .map(|(name, value)| {
            let word = value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned);
            format!("{} {word}", name.replace('_', " "))
        })
        .collect();
    rows.push(("options".into(), options.join(", ")));
    rows
}

/// The same of a long render: whose sources made it, in how many passes.
pub(crate) fn provenance_of_reference(
    circumstances: &Circumstances,
    origin: Option<&Origin>,
    cpu_seconds: f64,
) -> Vec<(String, String)> {
    let mut rows = vec![("machine".into(), circumstances.machine.clone())];
    if let Some(Origin { method, batches, passes, commits, .. }) = origin {
        rows.insert(0, ("commit".into(), commits.join(", ")));
        rows.push(("method".into(), method.clone()));
        rows.push(("passes".into(), format!("{batches} batches of {passes}")));
    }
    rows.push(("CPU s".into(), format!("{cpu_seconds:.0}")));
    rows
}

/// What was compared, and how.
pub(crate) fn film(c: &Comparison) -> Vec<(&'static str, String)> {
    let options = c.methods.iter().zip(&c.options).map(|(m, o)| format!("{m}: {o}"));
    vec![
        ("film", format!("{}x{} pixels, {} bins", c.shape[0], c.shape[1], c.shape[2])),
        ("options", options.collect::<Vec<_>>().join("; ")),
        ("all numbers", "result.json".to_owned()),
    ]
}

/// Where the page comes from, and the command that repeats it.
pub(crate) fn provenance(
    page: &mut Page,
    circumstances: &Circumstances,
    command: &str,
    more: &[(&str, String)],
) {
    page.heading("Provenance");
    let mut facts = vec![
        ("commit", circumstances.commit.clone()),
        ("machine", circumstances.machine.clone()),
        ("flags", circumstances.flags.clone()),
        ("seed", circumstances.seed.to_string()),
    ];
    facts.extend(more.iter().cloned());
    page.facts(&facts);
    page.command(command);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::testing::{arrays, comparison};

    #[test]
    fn a_reference_says_who_made_it_and_how_noisy_it_is() {
        let origin = |batches, commit: &str| Origin {
            method: "path".into(),
            batches,
            passes: 7,
            commits: vec![commit.into()],
            commands: vec!["cargo xtask reproduce all".into()],
        };
        let own = made_by(&origin(8, "abc"), "abc");
        assert!(own.ends_with("of commit abc, by `cargo xtask reproduce all`."), "{own}");
        let other = made_by(&origin(8, "abc"), "abd");
        assert!(other.contains("ATTENTION: these are not the sources"), "{other}");
        assert!(made_by(&origin(0, "abc"), "abd").contains("ships with the scene"));
        // Errors of 1 against 1e-3, and against 2.
        let mut comparison = comparison();
        assert!(!precision(&comparison).contains("noisier"));
        comparison.reference_nmse = 2.0;
        assert!(precision(&comparison).contains("noisier than what it judges of path and beams"));
    }

    #[test]
    fn a_viewer_that_had_to_be_reduced_says_so_where_it_is_linked() {
        let folder = std::env::temp_dir().join(format!("tpb-viewer-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("viewer.html");
        let arrays = arrays(24, 16, 30, 3);
        let method = tpb_viewer::Method::new("a", "A", &arrays);
        let mut comparison = tpb_viewer::Comparison::new("reduced", vec![method]);
        assert_eq!(comparison.budget_bytes, 20_000_000, "the budget of a page");
        let whole = viewer(&file, &comparison).unwrap();
        assert!(
            whole.ends_with("24 \u{d7} 16 pixels \u{d7} 30 bins: all that was rendered"),
            "{whole}"
        );
        comparison.budget_bytes = std::fs::metadata(&file).unwrap().len() as usize - 1;
        let reduced = viewer(&file, &comparison).unwrap();
        let bytes = std::fs::metadata(&file).unwrap().len() as usize;
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(bytes <= comparison.budget_bytes);
        assert!(reduced.contains("reduced from 24 \u{d7} 16 pixels \u{d7} 30 bins"), "{reduced}");
    }
}
