//! Cells against closed forms, plain quadrature and conservation of energy.

use proptest::prelude::*;

use super::*;
use crate::layout::TimeAxis;
use crate::testing::integrate;

const AXIS: TimeAxis = TimeAxis { start_opl: 1.5, bin_width_opl: 0.07, bins: 40 };

fn spread_on_axis<const C: usize>(
    profile: &TemporalProfile<'_, C>,
    energy: Spectrum<C>,
    shift: f64,
) -> Result<Vec<Spectrum<C>>, NotFinite> {
    let clock = Clock::new(AXIS);
    let mut cells = vec![Spectrum::ZERO; clock.cells()];
    let mut workspace = Workspace::default();
    let result = spread(profile, energy, shift, &clock, &mut cells, &mut workspace);
    if result.is_err() {
        assert!(cells.iter().all(|cell| cell.is_zero()), "a refused contribution left a trace");
    }
    result.map(|changed| {
        let outside = |cell: &usize| !changed.contains(cell);
        assert!((0..cells.len()).filter(outside).all(|cell| cells[cell].is_zero()), "{changed:?}");
        cells
    })
}

/// Cells of a single-channel profile of unit energy.
fn cells(profile: TemporalProfile<'_, 1>) -> Vec<f64> {
    let cells = spread_on_axis(&profile, Spectrum([1.0]), 0.0).unwrap();
    cells.iter().map(|cell| cell[0]).collect()
}

/// Compares cells with the increments of a cumulative distribution.
fn check(found: &[f64], cumulative: impl Fn(f64) -> f64, tolerance: f64) {
    let clock = Clock::new(AXIS);
    for (cell, &found) in found.iter().enumerate() {
        let expected = cumulative(clock.upper(cell)) - cumulative(clock.lower(cell));
        assert!((found - expected).abs() <= tolerance, "cell {cell}: {found} for {expected}");
    }
}

#[test]
fn uniform_parts_are_lengths() {
    for (start, end) in [(1.6, 1.61), (1.2, 3.1), (1.57, 9.0), (0.1, 0.2), (7.0, 8.0), (0.0, 9.0)] {
        let part = |t: f64| (t.clamp(start, end) - start) / (end - start);
        check(&cells(TemporalProfile::Uniform { start, end }), part, 1e-15);
    }
}

#[test]
fn exponential_cells_agree_with_plain_quadrature() {
    let clock = Clock::new(AXIS);
    for depth in [-700.0, -30.0, -1.0, -1e-3, -1e-9, 0.0, 1e-12, 1e-5, 0.3, 2.0, 25.0, 300.0] {
        for (start, end) in [(1.53, 1.82), (1.2, 3.1), (1.57, 4.5), (0.5, 9.0)] {
            let profile = TemporalProfile::Exponential { start, end, depth: Spectrum([depth]) };
            let density = |t: f64| {
                let x = (t - start) / (end - start);
                // Scaled by the largest value, which is at one of the ends.
                if depth > 0.0 {
                    (-depth * x).exp()
                } else {
                    (depth * (end - t) / (end - start)).exp()
                }
            };
            let panels = 3000 + 100 * depth.abs() as u32;
            let total = integrate(density, start, end, panels);
            for (cell, found) in cells(profile).into_iter().enumerate() {
                let lower = clock.lower(cell).clamp(start, end);
                let upper = clock.upper(cell).clamp(start, end);
                let expected = integrate(density, lower, upper, panels) / total;
                let error = (found - expected).abs();
                assert!(
                    error <= 1e-12 * expected.max(1e-6),
                    "depth {depth}, [{start}, {end}], cell {cell}: {found} for {expected}"
                );
            }
        }
    }
}

#[test]
fn tails_have_their_closed_form_and_end_after_the_window() {
    for rate in [1e-9, 0.1, 3.0, 200.0] {
        for start in [0.3, 1.5, 1.87, 4.2, 6.0] {
            let profile = TemporalProfile::ExponentialTail { start, rate: Spectrum([rate]) };
            let before = |t: f64| -(-rate * (t - start).max(0.0)).exp_m1();
            check(&cells(profile), before, 1e-15);
        }
    }
    let infinite = TemporalProfile::ExponentialTail { start: 1.6, rate: Spectrum([f64::INFINITY]) };
    let found = cells(infinite);
    assert!(found[2] == 1.0 && found.iter().sum::<f64>() == 1.0, "an infinite rate is an instant");
}

#[test]
fn extreme_depths_are_instants_at_the_ends() {
    for (depth, opl) in [(1e9, 1.52), (f64::MAX, 1.52), (f64::INFINITY, 1.52)] {
        for (depth, opl) in [(depth, opl), (-depth, 3.91)] {
            let depth = Spectrum([depth]);
            let profile = TemporalProfile::Exponential { start: 1.52, end: 3.91, depth };
            let found = cells(profile);
            assert_eq!(found[Clock::new(AXIS).cell(opl)], 1.0, "{depth:?}");
            assert_eq!(found.iter().sum::<f64>(), 1.0);
        }
    }
}

#[test]
fn a_half_ellipse_agrees_with_its_closed_form() {
    for (centre, half) in [(2.4, 0.9), (1.6, 0.01), (1.4, 0.2), (3.0, 3.0)] {
        let (start, end) = (centre - half, centre + half);
        let density = |t: f64| Spectrum([((t - start) * (end - t)).sqrt()]);
        let profile = TemporalProfile::General { start, end, breaks: &[], density: &density };
        let cumulative = |t: f64| {
            let x = ((t - centre) / half).clamp(-1.0, 1.0);
            0.5 + (x * ((1.0 - x) * (1.0 + x)).sqrt() + x.asin()) / std::f64::consts::PI
        };
        check(&cells(profile), cumulative, 1e-10);
    }
}

#[test]
fn kinks_jumps_and_peaks_are_resolved_to_1e_9() {
    // A jump at 2, a kink at 3: 1, then 4, then 4 − 2 (t − 3).
    let density = |t: f64| Spectrum([if t < 2.0 { 1.0 } else { 4.0 - 2.0 * (t - 3.0).max(0.0) }]);
    let breaks = [2.0, 3.0];
    let profile =
        TemporalProfile::General { start: 1.0, end: 4.5, breaks: &breaks, density: &density };
    let cumulative = |t: f64| {
        let t = t.clamp(1.0, 4.5);
        let area = (t.min(2.0) - 1.0) + 4.0 * (t - 2.0).max(0.0) - (t - 3.0).max(0.0).powi(2);
        area / (1.0 + 10.0 - 2.25)
    };
    check(&cells(profile), cumulative, 1e-13);

    // A Lorentzian a hundredth of a bin wide: only the adaptive part can find its area.
    let (centre, width) = (2.345, 7e-4);
    let density = |t: f64| Spectrum([1.0 / (1.0 + ((t - centre) / width).powi(2))]);
    let profile = TemporalProfile::General { start: 1.0, end: 4.5, breaks: &[], density: &density };
    let angle = |t: f64| ((t.clamp(1.0, 4.5) - centre) / width).atan();
    let cumulative = |t: f64| (angle(t) - angle(1.0)) / (angle(4.5) - angle(1.0));
    check(&cells(profile), cumulative, 1e-9);
}

#[test]
fn a_general_exponential_agrees_with_the_closed_one_in_each_channel() {
    let depth = Spectrum([3.0, 0.0, -1.5]);
    let (start, end) = (1.3, 3.7);
    let density = |t: f64| depth.map(|d| (-d * (t - start) / (end - start)).exp());
    let general = TemporalProfile::General { start, end, breaks: &[], density: &density };
    let closed = TemporalProfile::Exponential { start, end, depth };
    let energy = Spectrum([1.0, 2.0, 0.0]);
    let general = spread_on_axis(&general, energy, 0.25).unwrap();
    let closed = spread_on_axis(&closed, energy, 0.25).unwrap();
    for (a, b) in general.iter().zip(&closed) {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-12), "{a:?} {b:?}");
    }
}

#[test]
fn improper_profiles_are_refused_whole() {
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    let uniform = |start, end| TemporalProfile::Uniform { start, end };
    let exponential =
        |start, end, d| TemporalProfile::Exponential { start, end, depth: Spectrum([1.0, d, 1.0]) };
    let tail = |start, r| TemporalProfile::ExponentialTail { start, rate: Spectrum([1.0, r, 1.0]) };
    let negative = |t: f64| Spectrum::splat(2.0 - t);
    let broken = |t: f64| Spectrum([1.0, if t > 1.9 { nan } else { 1.0 }, 1.0]);
    let dark = |_: f64| Spectrum([1.0, 0.0, 1.0]);
    let general =
        |density, breaks| TemporalProfile::General { start: 1.0, end: 3.0, breaks, density };
    let refused = [
        uniform(2.0, 1.9),
        uniform(nan, 2.0),
        uniform(1.0, nan),
        uniform(1.0, infinity),
        uniform(infinity, infinity),
        exponential(2.0, 1.0, 1.0),
        exponential(1.0, infinity, 1.0),
        exponential(1.0, 2.0, nan),
        tail(nan, 1.0),
        tail(2.0, nan),
        tail(2.0, 0.0),
        tail(2.0, -1.0),
        general(&negative, &[]),
        general(&broken, &[]),
        general(&dark, &[]),
        general(&|_| Spectrum::ONE, &[f64::NAN]),
    ];
    for profile in &refused {
        assert!(spread_on_axis(profile, Spectrum::ONE, 0.0).is_err(), "{profile:?}");
    }
    // A channel without energy may lack a density.
    let energy = Spectrum([1.0, 0.0, 2.0]);
    for profile in [tail(2.0, 0.0), general(&dark, &[])] {
        let sum: Spectrum<3> = spread_on_axis(&profile, energy, 0.0).unwrap().into_iter().sum();
        assert!((0..3).all(|c| (sum[c] - energy[c]).abs() < 1e-14), "{sum:?}");
    }
}

/// Intervals from very short to longer than the window, in and around it.
fn intervals() -> impl Strategy<Value = (f64, f64)> {
    (-1.0..6.0_f64, -17.0..1.0_f64).prop_map(|(start, log)| (start, start + 10_f64.powf(log)))
}

proptest! {
    #[test]
    fn cells_are_not_negative_and_add_up_to_the_energy(
        (start, end) in intervals(),
        depth in prop::array::uniform3(prop_oneof![-1e3..1e3_f64, -1.0..1.0_f64, Just(0.0)]),
        rate in prop::array::uniform3(1e-3..1e3_f64),
        energy in prop::array::uniform3(prop_oneof![0.0..1e3_f64, Just(0.0)]),
        shift in -2.0..2.0_f64,
        kind in 0..4,
    ) {
        let middle = [0.5 * (start + end)];
        let density = |t: f64| Spectrum([1.0, 1.0 + (t - start), if t < middle[0] { 1.0 } else { 3.0 }]);
        let profile = match kind {
            0 => TemporalProfile::Uniform { start, end },
            1 => TemporalProfile::Exponential { start, end, depth: Spectrum(depth) },
            2 => TemporalProfile::ExponentialTail { start, rate: Spectrum(rate) },
            _ => TemporalProfile::General { start, end, breaks: &middle, density: &density },
        };
        let energy = Spectrum(energy);
        let cells = spread_on_axis(&profile, energy, shift).unwrap();
        let clock = Clock::new(AXIS);
        let first = clock.cell(start - shift);
        prop_assert!(cells[..first].iter().all(|cell| cell.is_zero()), "light before its time");
        let sum: Spectrum<3> = cells.iter().copied().sum();
        for c in 0..3 {
            prop_assert!(cells.iter().all(|cell| cell[c] >= 0.0), "{cells:?}");
            prop_assert!((sum[c] - energy[c]).abs() <= 4e-14 * energy[c], "{sum:?} {energy:?}");
        }
    }
}
