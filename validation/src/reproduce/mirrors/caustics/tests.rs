//! Verdicts, differences, and what paths may have missed, of given numbers.

use super::*;

#[test]
fn verdicts_need_the_whole_interval() {
    assert_eq!(verdict([-0.02, 0.029]), Verdict::Agree);
    assert_eq!(verdict([-0.02, 0.031]), Verdict::Open);
    assert_eq!(verdict([0.031, 0.5]), Verdict::Differ);
    assert_eq!(verdict([-0.5, -0.04]), Verdict::Differ);
}

#[test]
fn differences_are_relative_to_the_second() {
    let summary = |mean, standard_error| Summary { mean, standard_error };
    let named = || "beams \u{2212} light".to_owned();
    let d = difference(named(), &summary(1.02, 0.003), &summary(1.0, 0.004), 15.0);
    let [low, high] = d.interval.unwrap();
    let middle = 0.5 * (low + high);
    assert!((middle - 0.02).abs() < 1e-12 && d.verdict == Verdict::Open, "{d:?}");
    // t of 15 degrees of freedom at 95 % is 2.131; √(0.003² + (1.02·0.004)²) = 0.005064.
    assert!((high - middle - 2.1314 * 0.005_064).abs() < 1e-5);
    let dark = difference(named(), &summary(1.0, 0.1), &summary(0.0, 0.0), 15.0);
    assert_eq!((dark.interval, dark.verdict), (None, Verdict::Open));
}

#[test]
fn what_all_paths_may_have_missed_widens_the_interval_downwards() {
    // 36 889 paths all miss light that is found once in 10 000 with a probability of 2.5 %.
    let missed = unseen(100.0, 36_889.0);
    assert!((missed / 0.01 - 1.0).abs() < 1e-4, "{missed}");
    let summary = |mean, standard_error| Summary { mean, standard_error };
    let found = difference("l - p".into(), &summary(1.0, 0.001), &summary(1.0, 0.001), 15.0);
    assert_eq!(found.verdict, Verdict::Agree);
    let [low, high] = found.interval.unwrap();
    let wide = found.clone().with_unseen(0.05);
    let [wide_low, wide_high] = wide.interval.unwrap();
    // Were the path tracer's mean 1.05, the ratio would be that much less.
    assert!((wide_low - ((1.0 + low) / 1.05 - 1.0)).abs() < 1e-12);
    assert!((wide_high - high).abs() < 1e-12 && wide.verdict == Verdict::Open);
    assert_eq!(found.with_unseen(f64::INFINITY).interval, None);
}

#[test]
fn the_bound_is_the_farthest_end_of_all_pairs() {
    let summary = |mean, standard_error| Summary { mean, standard_error };
    let of = |a: f64| difference(String::new(), &summary(a, 0.0), &summary(1.0, 0.0), 15.0);
    let unknown = Difference { of: String::new(), interval: None, verdict: Verdict::Open };
    let region = RegionResult {
        label: String::new(),
        pixels: 1,
        bins: [0, 1],
        levels: Vec::new(),
        unseen: None,
        blur: None,
        differences: vec![of(1.01), of(0.97), of(1.02), unknown],
    };
    assert!((region.bound(&THREE).unwrap() - 0.03).abs() < 1e-12);
    assert!((region.bound(&[0, 2]).unwrap() - 0.02).abs() < 1e-12);
    assert_eq!((region.bound(&[0, 3]), region.bound(&[9])), (None, None));
}

#[test]
fn half_the_radius_tells_the_blur_and_the_mean_without_it() {
    // B(R) = 1 − 0.08 R² at R = 1 and R = 1/2.
    let summary = |mean, standard_error| Summary { mean, standard_error };
    let (whole, half) = (summary(0.92, 0.003), summary(0.98, 0.004));
    let limit = combined(4.0 / 3.0, &half, -1.0 / 3.0, &whole);
    assert!((limit.mean - 1.0).abs() < 1e-12);
    assert!((limit.standard_error - (16.0 * 16.0 + 9.0_f64).sqrt() / 3e3).abs() < 1e-9);
    let blur = combined(4.0 / 3.0, &whole, -4.0 / 3.0, &half);
    assert!((blur.mean + 0.08).abs() < 1e-12);
}
