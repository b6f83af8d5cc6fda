//! Formulas, intervals, and what is left out.

use super::*;
use crate::testing::{cube, with_error};

#[test]
fn numbers_follow_their_formulas() {
    let mut r = cube(2, 1, 2, 1);
    r.transient = vec![1.0, 2.0, 0.0, 5.0];
    let mut x = r.clone();
    x.transient = vec![1.5, 2.0, 1.0, 3.0];
    let found = Metrics::of_cube(&x, &r, None);
    let epsilon = 0.01 * 8.0 / 3.0;
    let squares = 0.25 + 1.0 + 4.0;
    let near = |found: Option<f64>, exact: f64| {
        assert!((found.unwrap() - exact).abs() < 1e-12 * exact.abs(), "{found:?} {exact}");
    };
    assert!((found.epsilon - epsilon).abs() < 1e-15);
    near(found.rmse, (squares / 4.0_f64).sqrt());
    near(found.nmse, squares / 30.0);
    near(found.bias, -0.5 / 8.0);
    near(found.mape, (0.5 / (1.0 + epsilon) + 1.0 / epsilon + 2.0 / (5.0 + epsilon)) / 4.0);
    let symmetric = 1.0 / (2.5 + epsilon) + 2.0 / (1.0 + epsilon) + 4.0 / (8.0 + epsilon);
    near(found.smape, symmetric / 4.0);
    let e2 = epsilon * epsilon;
    near(found.relative_mse, (0.25 / (1.0 + e2) + 1.0 / e2 + 4.0 / (25.0 + e2)) / 4.0);
    assert_eq!((found.noise, found.bias_half), (None, None));
    let steady = Metrics::of_steady(&x, &r, None);
    assert_eq!(steady.rmse, Some(0.0));
}

#[test]
fn noise_is_told_from_bias() {
    let r = cube(16, 16, 20, 1);
    let relative = 0.05;
    let mut x = with_error(r.clone(), relative);
    // Errors of exactly one standard deviation, alternating, on a bias of 3 %.
    for (at, cell) in x.transient.iter_mut().enumerate() {
        *cell *= 1.03 + if at % 2 == 0 { relative } else { -relative };
    }
    let found = Metrics::of_cube(&x, &r, None);
    assert!((found.noise.unwrap() - 2.5e-3).abs() < 1e-8);
    assert!((found.squared_bias.unwrap() - 9e-4).abs() < 2e-4, "{:?}", found.squared_bias);
    let half = found.bias_half.unwrap();
    assert!((half.bound - 1.959_964 * 0.05).abs() < 1e-6);
    assert!(half.independent < half.bound / 20.0);
}

/// Regression: intervals were ±1.96 standard errors whatever the number of batches.
#[test]
fn the_interval_of_the_bias_knows_the_batches() {
    let r = cube(3, 2, 4, 1);
    let noisy = with_error(r.clone(), 0.1);
    let bound = |batches: Option<u64>, (r, of_r): (&Arrays, Option<u64>)| {
        let (x, r) = (Estimate { arrays: &noisy, batches }, Estimate { arrays: r, batches: of_r });
        Metrics::of_cube(x, r, None).bias_half.unwrap().bound / 0.1
    };
    let near = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-5, "{found} {exact}");
    near(bound(None, (&r, None)), 1.959_964);
    near(bound(Some(5), (&r, None)), 2.776_445);
    // Twice the variance, and by Welch and Satterthwaite twice the freedom.
    near(bound(Some(5), (&noisy, Some(5))), 2.0_f64.sqrt() * 2.306_004);
    // An exact half adds no freedom that it does not have.
    near(bound(Some(2), (&r, Some(9))), 12.706_205);
}

#[test]
fn shared_random_numbers_leave_no_noise_to_tell() {
    let found = Metrics::of_cube(&with_error(cube(3, 2, 4, 1), 0.1), &cube(3, 2, 4, 1), None);
    assert!(found.noise.is_some() && found.squared_bias.is_some());
    let without = found.without_noise();
    assert_eq!((without.noise, without.squared_bias, without.bias_half), (None, None, None));
    assert_eq!(without.nmse, found.nmse);
}

#[test]
fn what_is_not_finite_is_left_out_and_counted() {
    let r = cube(4, 4, 5, 3);
    let mut x = r.clone();
    x.transient[7] = f32::NAN;
    x.transient[100] = f32::INFINITY;
    let found = Metrics::of_cube(&x, &r, None);
    assert_eq!((found.left_out, found.cells), (2, 4 * 4 * 5 * 3 - 2));
    assert_eq!(found.nmse, Some(0.0));
}

#[test]
fn judged_pixels_are_chosen_and_black_references_have_no_ratios() {
    let r = cube(3, 1, 4, 1);
    let mut x = r.clone();
    x.transient[0] += 1.0;
    let judged = [false, true, true];
    assert_eq!(Metrics::of_cube(&x, &r, Some(&judged)).rmse, Some(0.0));
    assert!(Metrics::of_cube(&x, &r, None).rmse.unwrap() > 0.1);
    let mut black = r.clone();
    black.transient.fill(0.0);
    let found = Metrics::of_cube(&x, &black, None);
    assert_eq!((found.nmse, found.mape, found.bias), (None, None, None));
    assert!(found.rmse.is_some());
}

#[test]
fn curves_are_the_numbers_of_each_bin() {
    let r = cube(5, 4, 6, 3);
    let mut x = r.clone();
    x.transient.iter_mut().for_each(|cell| *cell *= 1.1);
    let curves = FrameCurves::new(&x, Some(&r), 1);
    for bin in 0..6 {
        let lit = r.transient.chunks_exact(3).skip(bin).step_by(6).any(|cell| cell[0] > 0.0);
        assert_eq!(curves.nmse[bin].is_some(), lit);
        if lit {
            assert!((curves.nmse[bin].unwrap() - 0.01).abs() < 1e-6);
            assert!((curves.bias[bin].unwrap() - 0.1).abs() < 1e-6);
        }
    }
    assert!(FrameCurves::new(&x, None, 1).nmse.iter().all(Option::is_none));
}

#[test]
fn curves_of_groups_are_the_numbers_over_their_cells() {
    let r = cube(3, 2, 7, 3);
    let mut x = r.clone();
    x.transient.iter_mut().enumerate().for_each(|(at, cell)| *cell *= 1.0 + (at % 5) as f32);
    let curves = FrameCurves::new(&x, Some(&r), 3);
    assert_eq!((curves.group, curves.mean.len()), (3, 3));
    for (at, bins) in [0..3, 3..6, 6..7].into_iter().enumerate() {
        let cells = || {
            let bin_of = |cell: usize| cell / 3 % 7;
            (0..r.transient.len()).filter(|&cell| bins.contains(&bin_of(cell))).collect::<Vec<_>>()
        };
        let of = |arrays: &Arrays, cell: usize| f64::from(arrays.transient[cell]);
        let sum = |f: &dyn Fn(usize) -> f64| cells().into_iter().map(f).sum::<f64>();
        let nmse = sum(&|c| (of(&x, c) - of(&r, c)).powi(2)) / sum(&|c| of(&r, c).powi(2));
        let bias = sum(&|c| of(&x, c)) / sum(&|c| of(&r, c)) - 1.0;
        let mean = sum(&|c| of(&x, c)) / cells().len() as f64;
        for (found, exact) in [
            (curves.nmse[at].unwrap(), nmse),
            (curves.bias[at].unwrap(), bias),
            (curves.mean[at], mean),
        ] {
            assert!((found / exact - 1.0).abs() < 1e-9, "group {at}: {found}, {exact}");
        }
    }
}
