//! What pages of all scenes share: the numbers and curves of a comparison, and where they come from.

use std::path::Path;

use super::compare::Comparison;
use super::page::Page;
use super::{charts, tables, write_text};
use crate::error::Result;
use crate::statistics::Winner;
use crate::suite::Circumstances;

/// Tables: by render time, by window of time, by kind of cell, and who wins which bins.
pub(crate) fn numbers(page: &mut Page, comparison: &Comparison) {
    page.heading("Numbers");
    page.table(
        &format!(
            "By render time, over judged pixels; {} replicates each; reference of {:.0} CPU s, own NMSE {:.1e}",
            comparison.replicates, comparison.reference_cpu_seconds, comparison.reference_nmse
        ),
        &tables::BY_TIME,
        &tables::by_time(comparison),
    );
    for (what, caption, parts) in [
        ("OPL", "By window of time, at the whole render time", &comparison.windows),
        ("cells", "By kind of cell: where beams win, and where they lose", &comparison.kinds),
    ] {
        if !parts.is_empty() {
            let heads = tables::by_part_heads(what, comparison);
            let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
            page.table(caption, &heads, &tables::by_part(comparison, parts));
        }
    }
    page.list(&[tables::won(comparison, Winner::First), tables::won(comparison, Winner::Second)]);
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

/// What the viewer shows of it.
pub(crate) fn provenance_of(circumstances: &Circumstances) -> Vec<(String, String)> {
    vec![
        ("commit".into(), circumstances.commit.clone()),
        ("machine".into(), circumstances.machine.clone()),
    ]
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
