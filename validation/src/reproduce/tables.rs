//! Numbers of a comparison as rows of tables.

use super::compare::{AtTime, Comparison, Part};
use super::losses::Loss;
use super::mirrors::caustics::{Difference, Verdict};
use crate::statistics::split::Estimate;
use crate::statistics::{Factor, Winner};

/// `1.20e-3 [1.0e-3, 1.4e-3]`, `0.789 [0.67, 0.91]`.
pub(crate) fn interval(estimate: &Estimate) -> String {
    let [low, high] = estimate.interval.map(|end| digits(end, 2));
    format!("{} [{low}, {high}]", digits(estimate.value, 3))
}

/// A number to so many digits, with a power of ten where it is small or large.
fn digits(value: f64, count: usize) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !size.is_finite() || !(0.1..1e4).contains(&size) {
        return format!("{value:.*e}", count - 1);
    }
    let before = size.log10().floor() + 1.0;
    format!("{value:.*}", (count as f64 - before).max(0.0) as usize)
}

/// `[-1.0 %, +2.0 %]`.
pub(crate) fn percent([low, high]: [f64; 2]) -> String {
    format!("[{:+.1} %, {:+.1} %]", 100.0 * low, 100.0 * high)
}

/// The interval of a difference and what it says.
pub(crate) fn difference(difference: &Difference) -> String {
    let word = match difference.verdict {
        Verdict::Agree => "agree",
        Verdict::Differ => "DIFFER",
        Verdict::Open => "open",
    };
    difference.interval.map_or("—".to_owned(), |ends| format!("{} {word}", percent(ends)))
}

/// Heads of [`by_time`].
pub(crate) const BY_TIME: [&str; 8] = [
    "time, method",
    "wall s",
    "CPU s",
    "passes",
    "NMSE",
    "variance",
    "bias\u{b2}",
    "NMSE, all pixels",
];

/// A row for each render time and method, and one for their factor.
pub(crate) fn by_time(comparison: &Comparison) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for time in &comparison.times {
        for (name, m) in comparison.methods.iter().zip(&time.methods) {
            rows.push(vec![
                format!("{:.3} s, {name}", time.seconds),
                format!("{:.2}", m.spent.wall_seconds),
                format!("{:.2}", m.spent.cpu_seconds),
                format!("{:.1}", m.passes),
                interval(&m.judged.nmse),
                interval(&m.judged.variance),
                interval(&m.judged.squared_bias),
                m.whole.as_ref().map_or("—".to_owned(), |whole| interval(&whole.nmse)),
            ]);
        }
        rows.push(factor_row(time));
    }
    rows
}

fn factor_row(time: &AtTime) -> Vec<String> {
    let text = |factor: Option<Factor>| factor.map_or("—".to_owned(), |f| f.text());
    let mut row = vec![format!("{:.3} s, times less error", time.seconds)];
    row.extend((0..3).map(|_| String::new()));
    row.push(format!("{}; wall: {}", text(time.factor), text(time.factor_wall)));
    row.extend([String::new(), String::new(), text(time.factor_whole)]);
    row
}

/// Heads of [`by_part`].
pub(crate) fn by_part_heads(what: &str, comparison: &Comparison) -> Vec<String> {
    let mut heads = vec![what.to_owned(), "share of \u{3a3}r\u{b2}".to_owned()];
    for method in &comparison.methods {
        heads.extend(["NMSE", "variance", "bias\u{b2}"].map(|part| format!("{method}: {part}")));
    }
    heads.extend(["times less error".to_owned(), "less error".to_owned()]);
    heads
}

/// A row for each part.
pub(crate) fn by_part(comparison: &Comparison, parts: &[Part]) -> Vec<Vec<String>> {
    let row = |part: &Part| {
        let mut row = vec![part.label.clone(), format!("{:.2} %", 100.0 * part.share)];
        for split in &part.splits {
            match split {
                Some(split) => {
                    row.extend([&split.nmse, &split.variance, &split.squared_bias].map(interval));
                }
                None => row.extend((0..3).map(|_| "—".to_owned())),
            }
        }
        row.push(part.factor.map_or("—".to_owned(), |factor| factor.text()));
        row.push(winner(comparison, part.winner()));
        row
    };
    parts.iter().map(row).collect()
}

/// Heads of [`loss`].
pub(crate) const LOSS: [&str; 4] =
    ["where beams lose", "times less error", "share of \u{3a3}r\u{b2}", "why"];

/// A row for a part that beams lose.
pub(crate) fn loss(loss: Loss) -> Vec<String> {
    let Loss { label, factor, share, reason } = loss;
    vec![label, factor, format!("{:.2} %", 100.0 * share), reason]
}

/// Who has less error.
pub(crate) fn winner(comparison: &Comparison, winner: Winner) -> String {
    let name = |index: usize| comparison.methods.get(index).cloned().unwrap_or_default();
    match winner {
        Winner::First => name(0),
        Winner::Second => name(1),
        Winner::Unresolved => "not resolved".to_owned(),
    }
}

/// What is said of the bins that one method wins.
pub(crate) fn won(comparison: &Comparison, who: Winner) -> String {
    let ranges = comparison.won(who);
    let name = winner(comparison, who);
    if ranges.is_empty() {
        return format!("{name}: in no single bin less error, with its interval.");
    }
    let bins: usize = ranges.iter().map(|(range, _)| range.len()).sum();
    let share: f64 = ranges.iter().map(|(_, share)| share).sum();
    let mut longest = ranges.clone();
    longest.sort_by(|a, b| b.0.len().cmp(&a.0.len()).then(a.0.start.cmp(&b.0.start)));
    let named: Vec<String> = longest
        .iter()
        .take(4)
        .map(|(range, share)| {
            let opl = [range.start, range.end - 1].map(|bin| comparison.frames[bin].opl);
            format!(
                "bins {} to {} ({:.2} to {:.2} m, {:.1} % of \u{3a3}r\u{b2})",
                range.start,
                range.end - 1,
                opl[0][0],
                opl[1][1],
                100.0 * share
            )
        })
        .collect();
    format!(
        "{name}: less error, each with its interval, in {bins} of {} bins, which hold {:.1} % of \
         \u{3a3}r\u{b2}; the longest runs: {}.",
        comparison.frames.len(),
        100.0 * share,
        named.join("; ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression: numbers near 1 were `3.40e0 [2.6e0, 4.2e0]`.
    #[test]
    fn numbers_near_one_have_no_power_of_ten() {
        let text = |value, ends| interval(&Estimate { value, standard_error: 0.0, interval: ends });
        assert_eq!(text(3.4, [2.6, 4.2]), "3.40 [2.6, 4.2]");
        assert_eq!(text(0.789, [0.67, 0.91]), "0.789 [0.67, 0.91]");
        assert_eq!(text(59.8, [43.0, 77.0]), "59.8 [43, 77]");
        assert_eq!(text(1.2e-3, [-1e-3, 1.4e-3]), "1.20e-3 [-1.0e-3, 1.4e-3]");
        assert_eq!(text(f64::NAN, [0.0, f64::INFINITY]), "NaN [0, inf]");
    }
}
