//! The runner cannot be fooled, and a few quick cases hold.

use std::path::PathBuf;
use std::time::Duration;

use super::case::{Case, Finding, Method, Setup, Work};
use super::groups::all;
use super::laws::{near, refused, same_to_the_bit};
use super::pencil::Pencil;
use super::report;
use super::runner::{Record, StressResult, Verdict, run_cases, run_row};
use super::shot::Shot;
use super::single::Single;
use super::world::Unit;
use super::worlds::{FILM, everything};
use crate::error::{Result, ValidationError};

fn setup() -> Setup {
    Setup { seed: 1, program: None, folder: PathBuf::from("nowhere") }
}

fn row(check: impl Fn() -> Result<Finding> + Send + Sync + 'static) -> Record {
    let case = Case::of_no_method("test/row", "everything", move |_| check());
    run_row(&case, &setup(), None, Some(1), Duration::from_millis(500))
}

#[test]
fn panics_errors_and_hangs_are_red() {
    let panicked = row(|| panic!("out of {}", "range"));
    assert_eq!(panicked.verdict, Verdict::Failed);
    assert!(panicked.result.contains("panicked: out of range"), "{}", panicked.result);
    let broken = row(|| Err(ValidationError::unusable("unsound", "the arrays hold NaN")));
    assert_eq!(
        (broken.verdict, &*broken.result),
        (Verdict::Failed, "unsound: the arrays hold NaN")
    );
    let hang = row(|| {
        loop {
            std::thread::sleep(Duration::from_secs(1));
        }
    });
    assert!(hang.verdict == Verdict::Failed && hang.result.contains("did not end"));
    assert_eq!(row(|| Ok(Finding::exact(false, "wrong"))).verdict, Verdict::Failed);
    assert_eq!(row(|| Ok(Finding::exact(true, "right"))).verdict, Verdict::Passed);
}

#[test]
fn names_are_unique_and_every_method_is_run_or_left_out_with_a_reason() {
    let cases = all();
    let mut names: Vec<_> = cases.iter().map(|case| &case.name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), cases.len());
    for case in &cases {
        let of_methods = case.methods.iter().flatten().count();
        let told = case.left_out.iter().all(|(_, reason)| !reason.is_empty());
        let complete = of_methods == 0 || of_methods + case.left_out.len() == Method::ALL.len();
        assert!(told && complete && !case.methods.is_empty(), "{}", case.name);
        assert!(!case.risk.is_empty() && case.name.contains('/'));
    }
    let plan = report::plan(&cases).join("\n");
    assert!(plan.contains("scale/room-2e16-m") && plan.contains("beams-2d-short"), "{plan}");
}

/// Negative control: the same budget, an expectation that is off by 2 %.
#[test]
fn an_expectation_that_is_off_by_2_percent_is_red() {
    for (factor, passed) in [(1.0, true), (1.02, false), (0.98, false)] {
        for method in [Method::Beams1d, Method::Beams2d] {
            let finding = Pencil::USUAL.agrees(method, 1, factor).unwrap();
            assert_eq!(finding.passed, passed, "{factor} {method:?}: {}", finding.text);
        }
        let work = Work { samples: 1024, ..Work::LITTLE };
        let finding = Single::USUAL.agrees(Method::Path, &work, (1, 2), factor).unwrap();
        assert_eq!(finding.passed, passed, "{factor} path: {}", finding.text);
    }
}

/// Negative control: a length, a power or a law that is wrong in the last digits.
#[test]
fn a_law_that_almost_holds_is_red() {
    let image = |length, light, method| {
        let world = everything(Unit { length, light }, FILM);
        Shot::new(&world, method, &Work::LITTLE).unwrap().render(1, 1).unwrap()
    };
    for method in Method::ALL {
        let usual = image(1.0, 1.0, method);
        assert!(same_to_the_bit(&usual, &image(64.0, 1.0, method), 1.0).passed, "{method:?}");
        assert!(!same_to_the_bit(&usual, &image(1.0, 1.0 + 1e-6, method), 1.0).passed);
        assert!(!same_to_the_bit(&usual, &image(1.0, 2.0, method), 1.0).passed);
        assert!(near(&usual, &image(1.0, 2.0, method), 2.0, 1e-9).passed);
        assert!(!near(&usual, &image(1.0, 2.000_002, method), 2.0, 1e-9).passed);
    }
}

/// Negative control: an error without the words that a user needs, and none at all.
#[test]
fn an_unclear_error_is_red() {
    let too_large = everything(Unit::of_length(1e21), FILM);
    assert!(refused(&too_large, &["exceeds", "$.sensor"]).passed);
    assert!(!refused(&too_large, &["the moon"]).passed);
    assert!(!refused(&everything(Unit::SI, FILM), &[]).passed);
}

/// What a red row does to the table, its last line and the exit code.
#[test]
fn one_red_row_fails_the_table() {
    let green = Case::of_no_method("a/green", "little", |_| Ok(Finding::exact(true, "1 | 2")));
    let red = Case::of_no_method("a/red", "much", |_| Ok(Finding::exact(false, "wrong")));
    let run = |cases: &[Case]| run_cases(cases, &setup(), Some(1), |_| {});
    assert!(run(std::slice::from_ref(&green)).passed());
    let result = run(&[green, red]);
    assert!(!result.passed());
    let last = report::summary(&result).pop().unwrap();
    assert!(last.starts_with("stress: FAILED cases=2 failed=1"), "{last}");
    let table = report::markdown(&result);
    assert!(table.contains(r"1 \| 2") && table.contains("**FAILED**"), "{table}");
    let json = serde_json::to_string(&result).unwrap();
    assert_eq!(serde_json::from_str::<StressResult>(&json).unwrap(), result);
    assert!(!run(&[]).passed(), "nothing is no success");
}

/// A part of the table that is quick: every case that is decided without chance.
#[test]
fn a_quick_part_of_the_table_is_green() {
    let quick = [
        "scale/room-1e-6",
        "scale/room-2e16",
        "scale/too",
        "time/window",
        "time/bins-1e",
        "index/",
        "camera/",
        "lamp/",
        "coincident/",
        "light/",
        "size/",
        "radius/1e-300",
        "radius/0e0",
        "beam/tangent",
        "albedo/0",
        "thickness/fog-1e6",
    ];
    let cases: Vec<Case> = all()
        .into_iter()
        .filter(|case| quick.iter().any(|start| case.name.starts_with(start)))
        .collect();
    assert!(cases.len() > 40);
    let mut red = Vec::new();
    run_cases(&cases, &setup(), None, |record| {
        if record.verdict == Verdict::Failed {
            red.push(format!("{} ({}): {}", record.case, record.method, record.result));
        }
    });
    assert!(red.is_empty(), "{}", red.join("\n"));
}
