//! Runs as tables for a person.

use tpb_dashboard::bench_runs::{BenchRun, Change, Cost};

/// What was timed and counted, with changes since the last run.
pub(crate) fn cases(run: &BenchRun, changes: &[Option<Change>]) -> Vec<String> {
    let head = ["case", "CPU s", "last", "rate per CPU s", "last", "instructions", "per", "last"];
    let mut rows = vec![head.map(str::to_owned)];
    for (case, change) in run.cases.iter().zip(changes) {
        let change = change.clone().unwrap_or_default();
        let main = case.main_rate();
        let (rate, rate_change) = main.map_or_else(
            || (String::new(), None),
            |(unit, rate)| (format!("{} {unit}", short(rate)), change.rates.get(unit).copied()),
        );
        let counted = case.counted.as_ref();
        let per = counted.and_then(|counted| {
            let (unit, _) = main?;
            let work = counted.work.get(unit)?;
            let unit = unit.strip_suffix('s').unwrap_or(unit);
            Some(format!("{} a {unit}", short(counted.instructions / work)))
        });
        rows.push([
            case.name.clone(),
            format!("{:.2}", case.cpu_seconds),
            times(change.cpu),
            rate,
            times(rate_change),
            counted.map_or("not counted".to_owned(), |counted| short(counted.instructions)),
            per.unwrap_or_default(),
            change.instructions.map_or(String::new(), |ratio| format!("x{ratio:.4}")),
        ]);
    }
    aligned(&rows)
}

/// What is not needed.
pub(crate) fn costs(costs: &[Cost]) -> Vec<String> {
    let head = ["case", "instructions of", "over", "ratio", "goal"];
    let mut rows = vec![head.map(str::to_owned)];
    for cost in costs {
        let side =
            |index: usize| format!("{}: {}", cost.sides[index], short(cost.instructions[index]));
        let goal = match (cost.at_most, cost.at_least) {
            (Some(most), _) => format!("<= {most}"),
            (None, Some(least)) => format!(">= {least}"),
            (None, None) => String::new(),
        };
        let verdict = match cost.met() {
            Some(true) => " met",
            Some(false) => " MISSED",
            None => "",
        };
        let ratio = format!("{:.4}", cost.ratio());
        rows.push([cost.name.clone(), side(0), side(1), ratio, format!("{goal}{verdict}")]);
    }
    aligned(&rows)
}

/// New over old.
fn times(ratio: Option<f64>) -> String {
    ratio.map_or(String::new(), |ratio| format!("x{ratio:.2}"))
}

/// Three digits with a prefix.
fn short(number: f64) -> String {
    let (scale, prefix) = [(1e9, " G"), (1e6, " M"), (1e3, " k")]
        .into_iter()
        .find(|(scale, _)| number.abs() >= *scale)
        .unwrap_or((1.0, ""));
    let value = number / scale;
    let places = if value >= 99.95 {
        0
    } else if value >= 9.995 {
        1
    } else {
        2
    };
    format!("{value:.places$}{prefix}")
}

/// Columns of one width; the first to the left, the others to the right.
fn aligned<const N: usize>(rows: &[[String; N]]) -> Vec<String> {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: [usize; N] = std::array::from_fn(|column| width(column).unwrap_or(0));
    let line = |row: &[String; N]| {
        let cells = row.iter().zip(widths).enumerate().map(|(column, (cell, width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use tpb_dashboard::bench_runs::{Case, Counted};

    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let expected = [
            (0.5, "0.50"),
            (9.996, "10.0"),
            (999.0, "999"),
            (12_345.0, "12.3 k"),
            (299_180_668.0, "299 M"),
            (5.4e9, "5.40 G"),
        ];
        for (number, text) in expected {
            assert_eq!(short(number), text);
        }
    }

    #[test]
    fn tables_show_values_and_changes() {
        let case = Case {
            name: "a".into(),
            cpu_seconds: 1.5,
            rates: BTreeMap::from([("paths".into(), 10.0), ("pairs".into(), 2e6)]),
            counted: Some(Counted {
                instructions: 3e8,
                work: BTreeMap::from([("pairs".into(), 1e6)]),
                ..Counted::default()
            }),
            ..Case::default()
        };
        let plain = Case { name: "b".into(), ..Case::default() };
        let run = BenchRun { cases: vec![case, plain], ..BenchRun::default() };
        let change = Change {
            cpu: Some(1.25),
            rates: BTreeMap::from([("pairs".into(), 0.8)]),
            instructions: Some(1.00012),
            ..Change::default()
        };
        let table = cases(&run, &[Some(change), None]);
        let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
        let expected = "a 1.50 x1.25 2.00 M pairs x0.80 300 M 300 a pair x1.0001";
        assert_eq!(words(&table[1]), expected);
        assert_eq!(words(&table[2]), "b 0.00 not counted");
        let cost = Cost {
            name: "c".into(),
            sides: ["with".into(), "without".into()],
            instructions: [103.0, 100.0],
            at_most: Some(1.02),
            at_least: None,
        };
        let table = costs(&[cost]);
        assert_eq!(words(&table[1]), "c with: 103 without: 100 1.0300 <= 1.02 MISSED");
    }
}
