//! Statistics against sums in f64.

use tpb_optics::Stream;

use super::*;

/// u/2 of the module's text: half the spacing of f32, relatively, at most.
const HALF_ULP: f64 = 1.0 / (1 << 24) as f64;

/// Sum and squares of one cell of number `cell` after these passes.
fn accumulated(passes: &[f64], cell: usize) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for (i, &value) in passes.iter().enumerate() {
        let pass = Pass::new(i as u64 + 1);
        pass.add_both((&mut sum, &mut squares), value, 0.0, cell);
    }
    let mut alone = 0.0;
    for (i, &value) in passes.iter().enumerate() {
        Pass::new(i as u64 + 1).add(&mut alone, value, cell);
    }
    assert_eq!(alone, sum, "sums do not depend on squares");
    (f64::from(sum), f64::from(squares))
}

/// Each result is a neighbour, and each neighbour comes as often as its nearness says: 5.5 standard
/// deviations of a binomial, false alarms 4e-8 each.
#[test]
fn rounding_is_to_a_neighbour_and_without_bias() {
    let old = 1.0_f32;
    let n = 100_000;
    for part in [0.001, 0.3, 0.5, 0.97] {
        for (cell, sign) in [(0, 1.0), (12_345, -1.0), (1 << 40, 1.0)] {
            let (near, far) = (sign * 1.5_f64, sign * f64::from(1.5_f32.next_up()));
            let new = near + part * (far - near);
            let ups = (1..=n).filter(|&pass| {
                let found = f64::from(rounded(old, new, Pass::new(pass).keys[0], cell));
                assert!(found == near || found == far, "{found}");
                found == far
            });
            let found = ups.count() as f64;
            let (mean, spread) = (n as f64 * part, (n as f64 * part * (1.0 - part)).sqrt());
            assert!((found - mean).abs() < 5.5 * spread, "{part} {cell}: {found} for {mean}");
        }
    }
    for exact in [0.0, 1.5, -2.0, 1e-40_f32.into(), f64::INFINITY] {
        assert_eq!(f64::from(rounded(old, exact, u64::MAX, 7)), exact);
    }
}

/// A name, the value of each pass, and how many roundings of the whole sum all of them equal at most.
type Kind<'a> = (&'a str, &'a dyn Fn(u64) -> f64, f64);

/// The bound of the module's text, times six (false alarms 2e-9), over 10^5 passes of every kind.
#[test]
fn sums_of_many_passes_keep_the_stated_accuracy() {
    let n = 100_000;
    let uniform = |i: u64| Stream::new(1, 2, i).uniform();
    let kinds: [Kind<'_>; 4] = [
        ("constant", &|_| 0.1, (n as f64 / 3.0).sqrt()),
        ("uniform", &uniform, (n as f64 / 3.0).sqrt()),
        // A first pass a thousand times as bright as all others together.
        ("dark after bright", &|i| if i == 0 { 1.0 } else { 1e-8 }, (n as f64).sqrt()),
        ("rare", &|i| if i % 997 == 5 { 1e3 } else { 0.0 }, (n as f64).sqrt()),
    ];
    for (name, value, roundings) in kinds {
        let passes: Vec<f64> = (0..n).map(value).collect();
        let exact: f64 = passes.iter().sum();
        for cell in 0..8 {
            let error = (accumulated(&passes, cell).0 / exact - 1.0).abs();
            assert!(error < 6.0 * HALF_ULP * roundings, "{name}: {error}");
        }
    }
}

/// Negative control: rounding to the nearest loses what the bound above would not allow.
#[test]
fn rounding_to_the_nearest_would_lose_small_passes() {
    let n = 100_000;
    let nearest = (1..n).fold(1.0_f32, |sum, _| (f64::from(sum) + 1e-8) as f32);
    let error = f64::from(nearest) / (1.0 + 1e-8 * f64::from(n - 1)) - 1.0;
    assert!(error.abs() > 6.0 * HALF_ULP * f64::from(n).sqrt(), "{error}");
}

#[test]
fn squares_agree_with_two_sweeps() {
    for (mean, spread, tolerance) in [(0.0, 1.0, 1e-4), (1.0, 1e-2, 1e-3)] {
        let mut rng = Stream::new(4, 5, 6);
        let passes: Vec<f64> = (0..10_000).map(|_| mean + spread * rng.uniform()).collect();
        let average = passes.iter().sum::<f64>() / passes.len() as f64;
        let expected: f64 = passes.iter().map(|x| (x - average).powi(2)).sum();
        let found = accumulated(&passes, 3).1;
        assert!((found / expected - 1.0).abs() < tolerance, "{found} for {expected}");
    }
}

/// Cells without noise have none: a standard error of `u/√24` of the mean, times six.
#[test]
fn rounding_hardly_adds_to_the_variance() {
    for n in [2, 100, 10_000] {
        for cell in 0..8 {
            let squares = accumulated(&vec![0.1; n], cell).1;
            let error = (squares * variance_factor(n as u64).unwrap()).sqrt() / 0.1;
            assert!(error < 6.0 * 2.0 * HALF_ULP / 24.0_f64.sqrt(), "{n}: {error}");
        }
    }
    assert_eq!(variance_factor(1), None);
}

/// Passes that add nothing, one by one and all at once.
#[test]
fn squares_are_brought_up_over_passes_that_add_nothing() {
    let values = [2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0];
    let (sum, squares) = accumulated(&values, 9);
    let (mut alone, mut brought, mut since) = (0.0_f32, 0.0_f32, 0);
    for (i, &value) in values.iter().enumerate().filter(|v| *v.1 > 0.0) {
        let pass = Pass::new(i as u64 + 1);
        let lag = pass.lag(since);
        pass.add_both((&mut alone, &mut brought), value, lag, 9);
        since = pass.mark();
    }
    assert_eq!(f64::from(alone), sum);
    assert!((f64::from(brought) / squares - 1.0).abs() < 1e-6, "{brought} for {squares}");
    // And up to a later pass.
    let later = accumulated(&[2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0, 0.0, 0.0], 9).1;
    let lagged = squares + sum * sum * lag(since, 9);
    assert!((lagged / later - 1.0).abs() < 1e-6, "{lagged} for {later}");
}
