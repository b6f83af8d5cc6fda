//! Pulses on arrays: energy, shape, error bound.

use tpb_film::{Arrays, Arrival, FilmError, FilmOptions, Layout, Pulse, Quantity, TransientFilm};
use tpb_optics::Spectrum;
use tpb_optics::opl::seconds_from_opl;

use super::{AXIS, rendered, small_cube, worst};

/// Energy of each pixel and channel, wherever it is.
fn totals(arrays: &Arrays) -> Vec<f64> {
    let channels = arrays.channels;
    (0..arrays.pixels() * channels)
        .map(|i| {
            let bins = arrays.pixel(i / channels).iter().skip(i % channels).step_by(channels);
            bins.map(|&v| f64::from(v)).sum::<f64>() + arrays.before[i] + arrays.after[i]
        })
        .collect()
}

fn pulses() -> Vec<Pulse> {
    let bins = |n: f64| seconds_from_opl(0.2 * n);
    let mut pulses = vec![Pulse::Delta];
    for n in [0.05, 0.7, 3.0, 20.0, 1e4] {
        pulses.push(Pulse::Gaussian { sigma_s: bins(n) });
        pulses.push(Pulse::Box { width_s: bins(n) });
    }
    pulses
}

#[test]
fn pulses_keep_the_energy() {
    for pulse in pulses() {
        let delta = small_cube();
        let mut arrays = delta.clone();
        arrays.apply_pulse(pulse).unwrap();
        assert!(worst(totals(&arrays), totals(&delta)) < 1e-7, "{pulse:?}");
        assert!(arrays.transient.iter().all(|&v| v >= 0.0), "{pulse:?}");
        assert_eq!(arrays.steady, delta.steady);
        assert_eq!(arrays.variance.is_some(), pulse == Pulse::Delta, "{pulse:?}");
    }
}

/// Regression: bins of different widths, as cubes of other programs may have them, were spread by the
/// kernel of their mean width.
#[test]
fn uneven_bins_are_refused_unless_the_pulse_is_continuous() {
    let duration = seconds_from_opl(0.5);
    let spreading = [Pulse::Gaussian { sigma_s: duration }, Pulse::Box { width_s: duration }];
    let mut uneven = small_cube();
    let bins = uneven.bins;
    uneven.opl_edges[bins / 2] += 0.02;
    let mut rounded = small_cube();
    rounded.opl_edges.iter_mut().for_each(|edge| *edge = f64::from(*edge as f32));
    for pulse in spreading {
        let before = uneven.clone();
        let message = uneven.apply_pulse(pulse).unwrap_err().to_string();
        assert!(message.contains("bins of one width") && message.contains("1.800e-1"), "{message}");
        assert!(uneven == before, "nothing was done");
        rounded.clone().apply_pulse(pulse).unwrap();
    }
    uneven.clone().apply_pulse(Pulse::Continuous).unwrap();
    uneven.apply_pulse(Pulse::Delta).unwrap();
}

/// Regression: the weights of a box cancelled; of 1e-15 bins it made 4 % of energy, of 1e-30 it moved
/// all of it behind the window.
#[test]
fn a_pulse_far_shorter_than_a_bin_is_a_delta() {
    for bins in [1e-6, 1e-12, 1e-15, 1e-18, 1e-30, 1e-290] {
        let duration = seconds_from_opl(0.2 * bins);
        for pulse in [Pulse::Box { width_s: duration }, Pulse::Gaussian { sigma_s: duration }] {
            let delta = small_cube();
            let mut arrays = delta.clone();
            arrays.apply_pulse(pulse).unwrap();
            assert!(worst(totals(&arrays), totals(&delta)) < 1e-7, "{pulse:?}");
            let pairs = arrays.transient.iter().zip(&delta.transient);
            let largest = delta.transient.iter().copied().fold(0.0, f32::max);
            let differ = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(differ < 2e-6 * largest, "{pulse:?}: {differ}");
        }
    }
}

/// One pixel, one deposit of unit energy at an OPL.
fn instant(opl: f64) -> Arrays {
    let layout = Layout::new(1, 1, AXIS).unwrap();
    let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).unwrap();
    film.add_pass(|tile| tile.deposit(0, 0.0, &Arrival::Instant(opl), Spectrum::ONE));
    film.develop()
}

#[test]
fn the_error_of_uniform_bins_is_within_its_bound_and_near_it_at_worst() {
    for pulse in pulses().into_iter().skip(1) {
        let mut largest = 0.0_f64;
        let mut bound = 0.0;
        // Arrivals across bin 15, from 4.0 to 4.2.
        for step in 0..20 {
            let opl = 4.0 + 0.2 * f64::from(step) / 19.001;
            let mut arrays = instant(opl);
            bound = arrays.apply_pulse(pulse).unwrap().relative_error_bound;
            let cumulative = |t: f64| match pulse {
                Pulse::Gaussian { sigma_s } => {
                    0.5 * libm::erfc(-seconds_from_opl(t) / (sigma_s * 2.0_f64.sqrt()))
                }
                Pulse::Box { width_s } => (seconds_from_opl(t) / width_s).clamp(0.0, 1.0),
                Pulse::Delta | Pulse::Continuous => f64::NAN,
            };
            let error: f64 = (0..30)
                .map(|bin| {
                    let (from, to) = (arrays.opl_edges[bin] - opl, arrays.opl_edges[bin + 1] - opl);
                    (f64::from(arrays.transient[bin]) - cumulative(to) + cumulative(from)).abs()
                })
                .sum();
            assert!(error <= bound + 1e-6, "{pulse:?} at {opl}: {error} > {bound}");
            largest = largest.max(error);
        }
        // For pulses that fit into the window the bound is not idle.
        if bound > 0.05 {
            assert!(largest > 0.2 * bound, "{pulse:?}: {largest} of {bound}");
        }
    }
}

#[test]
fn a_box_starts_with_the_light_and_a_gaussian_is_around_it() {
    let mut arrays = instant(4.1);
    arrays.apply_pulse(Pulse::Box { width_s: seconds_from_opl(0.6) }).unwrap();
    let lit: Vec<usize> = (0..30).filter(|&bin| arrays.transient[bin] > 1e-7).collect();
    assert_eq!(lit, [15, 16, 17, 18]);

    let mut arrays = instant(4.1);
    let report = arrays.apply_pulse(Pulse::gaussian_fwhm(seconds_from_opl(0.9))).unwrap();
    let half = arrays.transient[15] / 2.0;
    for k in 1..10 {
        assert!((arrays.transient[15 - k] - arrays.transient[15 + k]).abs() < 1e-7);
    }
    assert!(
        arrays.transient[17] > half && arrays.transient[18] < half,
        "half maximum at 2.25 bins"
    );
    // 8.5 sigma of 0.9 m/2.355 in bins of 0.2 m, and one for the width of the source's bin.
    assert_eq!((report.guard_bins_start, report.guard_bins_end), (18, 18));
}

#[test]
fn bins_beyond_the_guard_do_not_depend_on_what_is_outside_the_window() {
    let pulse = Pulse::Box { width_s: seconds_from_opl(1.0) };
    let layout = Layout::new(9, 7, AXIS).unwrap();
    let whole = {
        let mut wide = layout;
        let axis = wide.time.as_mut().unwrap();
        (axis.start_opl, axis.bins) = (-3.0, 90);
        let mut arrays = rendered::<1>(wide, FilmOptions::default(), 1).develop();
        arrays.apply_pulse(pulse).unwrap();
        arrays.crop_bins(20..50);
        arrays
    };
    let mut arrays = rendered::<1>(layout, FilmOptions::default(), 1).develop();
    let report = arrays.apply_pulse(pulse).unwrap();
    let (start, end) = (report.guard_bins_start, 30 - report.guard_bins_end);
    assert_eq!((start, end), (5, 30), "a causal box of 5 bins");
    let cells = |arrays: &Arrays, bins: std::ops::Range<usize>| -> Vec<f64> {
        (0..63).flat_map(|p| arrays.pixel(p)[bins.clone()].to_vec()).map(f64::from).collect()
    };
    assert!(worst(cells(&arrays, start..end), cells(&whole, start..end)) < 1e-6);
    assert!(worst(cells(&arrays, 0..start), cells(&whole, 0..start)) > 1e-3, "guards are needed");
}

#[test]
fn continuous_emission_is_the_running_sum_and_tends_to_the_steady_image() {
    let delta = small_cube();
    let mut arrays = delta.clone();
    let report = arrays.apply_pulse(Pulse::Continuous).unwrap();
    assert_eq!(report.relative_error_bound, 0.0);
    assert_eq!(arrays.quantity, Quantity::RadianceAtUpperEdges);
    for pixel in 0..arrays.pixels() {
        for c in 0..3 {
            let mut sum = delta.before[pixel * 3 + c];
            for bin in 0..30 {
                sum += f64::from(delta.pixel(pixel)[bin * 3 + c]);
                let found = f64::from(arrays.pixel(pixel)[bin * 3 + c]);
                assert!((found - sum).abs() <= 1e-7 * sum, "{found} for {sum}");
            }
            let end = sum + delta.after[pixel * 3 + c];
            assert!((end - delta.steady[pixel * 3 + c]).abs() < 1e-6);
        }
    }
    let again = arrays.apply_pulse(Pulse::Delta);
    assert!(matches!(again, Err(FilmError::Unsuitable(_))), "it is no response to a delta");
}

#[test]
fn impossible_pulses_are_errors() {
    for bad in [0.0, -1e-9, f64::NAN, f64::INFINITY] {
        for pulse in [Pulse::Gaussian { sigma_s: bad }, Pulse::Box { width_s: bad }] {
            assert!(matches!(small_cube().apply_pulse(pulse), Err(FilmError::Pulse(_))), "{bad}");
        }
    }
    let layout = Layout::new(3, 3, None).unwrap();
    let mut steady = rendered::<1>(layout, FilmOptions::default(), 1).develop();
    assert!(matches!(steady.apply_pulse(Pulse::Continuous), Err(FilmError::Unsuitable(_))));
}

#[test]
fn cropping_moves_energy_outside() {
    let whole = small_cube();
    let mut cropped = whole.clone();
    cropped.crop_bins(4..21);
    assert_eq!((cropped.bins, cropped.opl_edges.len()), (17, 18));
    assert_eq!(cropped.opl_edges[0], whole.opl_edges[4]);
    assert_eq!(cropped.pixel(5), &whole.pixel(5)[4 * 3..21 * 3]);
    assert_eq!(cropped.variance.as_ref().unwrap().len(), cropped.transient.len());
    assert!(worst(totals(&cropped), totals(&whole)) < 1e-12);
}
