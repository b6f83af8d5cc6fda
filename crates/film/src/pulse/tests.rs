//! Kernels against plain quadrature over pairs of bins.

use super::*;
use crate::testing::integrate;

/// K(m) from the pulse's cumulative distribution (in bins).
fn brute(cumulative: impl Fn(f64) -> f64, m: f64, breaks: &[f64]) -> f64 {
    let mut points = vec![0.0, 1.0];
    // Kinks of the integrand in s: where an end of the target meets a kink of the distribution.
    points.extend(breaks.iter().flat_map(|b| [m + 1.0 - b, m - b]));
    points.retain(|&s| (0.0..=1.0).contains(&s));
    points.sort_by(f64::total_cmp);
    let received = |s: f64| cumulative(m + 1.0 - s) - cumulative(m - s);
    points.windows(2).map(|p| integrate(received, p[0], p[1], 400)).sum()
}

fn weight(kernel: &Kernel, m: i32) -> f64 {
    let index = kernel.back.checked_add_signed(isize::try_from(m).unwrap());
    index.and_then(|i| kernel.weights.get(i).copied()).unwrap_or(0.0)
}

#[test]
fn gaussian_weights_agree_with_quadrature_narrow_and_wide() {
    for sigma in [1e-3, 0.1, 0.5, 0.999, 1.0, 1.7, 6.0, 40.0] {
        let kernel = Kernel::gaussian(sigma, 1000);
        let breaks = [-8.0, -4.0, -2.0, 0.0, 2.0, 4.0, 8.0].map(|z| z * sigma);
        let normal = |x: f64| 0.5 * libm::erfc(-x / (sigma * SQRT_2));
        for m in -12..=12 {
            let expected = brute(normal, f64::from(m), &breaks);
            let error = (weight(&kernel, m) - expected).abs();
            assert!(error < 1e-13, "sigma {sigma}, m {m}: {} for {expected}", weight(&kernel, m));
        }
        let total = kernel.weights.iter().sum::<f64>() + kernel.below + kernel.above;
        assert!((total - 1.0).abs() < 1e-14, "sigma {sigma}: {total}");
    }
}

#[test]
fn far_tails_keep_their_relative_precision() {
    // Two bins away at sigma 0.3: P(1), P(2), P(3) by quadrature of the density with the triangle.
    let sigma = 0.3;
    let density = |t: f64| (-0.5 * (t / sigma).powi(2)).exp() / (sigma * (2.0 * PI).sqrt());
    let triangle = |t: f64| density(t) * (1.0 - (t - 2.0).abs());
    let expected = integrate(triangle, 1.0, 2.0, 4000) + integrate(triangle, 2.0, 3.0, 4000);
    let found = weight(&Kernel::gaussian(sigma, 100), 2);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
}

#[test]
fn box_weights_agree_with_quadrature() {
    for width in [1e-3, 0.3, 1.0, 1.5, 7.25] {
        let kernel = Kernel::boxed(width, 1000);
        let ramp = |x: f64| (x / width).clamp(0.0, 1.0);
        for m in -2..=10 {
            let expected = brute(ramp, f64::from(m), &[0.0, width]);
            let found = weight(&kernel, m);
            assert!((found - expected).abs() < 1e-13, "width {width}, m {m}: {found} {expected}");
        }
    }
}

#[test]
fn what_leaves_and_what_stays_is_everything_even_for_pulses_longer_than_the_window() {
    let bins = 20;
    for width in [0.01, 1.0, 5.5, 19.0, 20.0, 1e3, 1e12] {
        for kernel in [Kernel::gaussian(width, bins), Kernel::boxed(width, bins)] {
            let (early, late) = kernel.leaving(bins);
            for bin in 0..bins {
                let (to, weights) = kernel.within(bin);
                let stays: f64 = weights.iter().take(bins - to).sum();
                let total = stays + early[bin] + late[bin];
                assert!((total - 1.0).abs() < 1e-14, "width {width}, bin {bin}: {total}");
            }
        }
    }
    // A box of 30 bins from bin 5 of 20: half of it is late.
    let (early, late) = Kernel::boxed(30.0, bins).leaving(bins);
    assert!(early[5] == 0.0 && (late[5] - 15.5 / 30.0).abs() < 1e-14, "{}", late[5]);
}
