//! What a contest says to people: a table each for error and for agreement, in Markdown.

use super::NAME;
use super::agreement::{AGREEMENT, Agreement};
use super::contest::{Contest, Row};
use crate::statistics::ratio::short;
use crate::statistics::split::Estimate;

impl Contest {
    /// Lines of Markdown.
    pub fn markdown(&self) -> Vec<String> {
        let mut lines = vec![format!("### {}", self.scene), String::new()];
        lines.push(
            "| method | passes | CPU s | NMSE [95 %] | median | bias² [95 %] | whole cube | \
             less NMSE·s than the peer [95 %] | by medians |"
                .to_owned(),
        );
        lines.push("| --- | ---: | ---: | --- | ---: | --- | ---: | --- | --- |".to_owned());
        lines.extend(self.rows.iter().map(row));
        lines.push(String::new());
        lines.push(self.about());
        lines.push(String::new());
        lines.extend(self.agreement.iter().map(agreement));
        if self.agreement.is_empty() {
            lines.push("- agreement: not measured, the reference's own method did not run".into());
        }
        lines.extend(self.faults.iter().map(|fault| format!("- known of {NAME}: {fault}")));
        lines
    }

    fn about(&self) -> String {
        let curves = &self.curves;
        let versions = self.peer.versions.as_object().into_iter().flatten();
        let versions: Vec<String> =
            versions.map(|(name, value)| format!("{name} {}", plain(value))).collect();
        format!(
            "{} runs each of {} CPU s, in turn, seed {}; {} of {} pixels judged; reference: {}, {:.0} CPU s, own \
             NMSE {:.1e}. A pass of {NAME} has {} samples per pixel; left out of its time: {:.1} CPU s to \
             load, {:.1} to compile, {:.3} to trace each pass. {}.",
            curves.replicates,
            self.cpu_seconds,
            curves.seed,
            curves.pixels[0],
            curves.pixels[1],
            curves.reference.method,
            curves.reference.cpu_seconds.unwrap_or(f64::NAN),
            curves.reference_nmse,
            self.samples,
            self.peer.load_cpu_seconds,
            self.peer.compile_cpu_seconds,
            self.peer.trace_cpu_seconds,
            versions.join(", "),
        )
    }
}

fn plain(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

fn row(row: &Row) -> String {
    let cpu = row.cpu_seconds.iter().sum::<f64>() / row.cpu_seconds.len() as f64;
    let [means, medians] = [
        row.less.map(|factor| factor.text()),
        row.less_median.map(|(ratio, interval)| times(ratio, interval)),
    ];
    format!(
        "| {} | {} | {cpu:.2} | {} | {:.2e} | {} | {:.2e} | {} | {} |",
        row.method,
        row.passes,
        interval(&row.split.nmse),
        row.median,
        interval(&row.split.squared_bias),
        row.whole.value,
        means.unwrap_or_default(),
        medians.unwrap_or_default(),
    )
}

fn interval(estimate: &Estimate) -> String {
    let Estimate { value, interval: [low, high], .. } = estimate;
    format!("{value:.2e} [{low:.1e}, {high:.1e}]")
}

fn times(ratio: f64, [low, high]: [f64; 2]) -> String {
    format!("{} [{}, {}]", short(ratio), short(low), short(high))
}

fn agreement(found: &Agreement) -> String {
    let Agreement { what, difference, interval: [low, high] } = found;
    // Differences of arrival are in bins already.
    let (factor, unit) = if what.contains("arrival") { (1.0, "") } else { (100.0, " %") };
    let verdict = if found.holds() { "agrees" } else { "DISAGREES beyond noise" };
    format!(
        "- {what}, {NAME} less ours: {:+.3}{unit} [{:+.3}, {:+.3}] at {} %: {verdict}",
        factor * difference,
        factor * low,
        factor * high,
        100.0 * AGREEMENT,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disagreement_is_said_aloud() {
        let found = |interval| {
            agreement(&Agreement { what: "steady image".into(), difference: -0.02, interval })
        };
        assert_eq!(
            found([-0.03, -0.01]),
            "- steady image, mitransient less ours: -2.000 % [-3.000, -1.000] at 99.9 %: DISAGREES beyond noise"
        );
        assert!(found([-0.05, 0.01]).ends_with(": agrees"));
    }
}
