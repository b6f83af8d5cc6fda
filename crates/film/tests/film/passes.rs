//! Statistics over passes, determinism, channels, and what is kept out.

use tpb_film::{Arrival, FilmError, FilmOptions, Layout, OutputChannels, TimeAxis, TransientFilm};
use tpb_optics::{Spectrum, Stream};

use super::{AXIS, render, rendered, worst};

#[test]
fn bins_and_what_is_outside_add_up_to_the_steady_image() {
    for unwarp in [false, true] {
        let layout = Layout::new(13, 11, AXIS).unwrap();
        let options = FilmOptions { unwarp, ..FilmOptions::default() };
        let arrays = rendered::<3>(layout, options, 4).develop();
        let sums = (0..layout.pixels()).flat_map(|pixel| {
            let arrays = &arrays;
            (0..3).map(move |c| {
                let bins = arrays.pixel(pixel).iter().skip(c).step_by(3);
                let inside: f64 = bins.map(|&v| f64::from(v)).sum();
                inside + arrays.before[pixel * 3 + c] + arrays.after[pixel * 3 + c]
            })
        });
        // Four passes are four roundings of each cell, by at most 2^-23.
        assert!(worst(sums, arrays.steady.iter().copied()) < 4.0 * 1.2e-7, "rounding of f32");
        assert!(arrays.before.iter().any(|&b| b > 0.0) && arrays.after.iter().any(|&a| a > 0.0));
    }
}

#[test]
fn the_steady_image_is_the_energy_deposited_with_bins_or_without() {
    let options = FilmOptions::default();
    let with = rendered::<1>(Layout::new(40, 50, AXIS).unwrap(), options, 2).develop();
    let without = rendered::<1>(Layout::new(40, 50, None).unwrap(), options, 2).develop();
    assert!(worst(with.steady.iter().copied(), without.steady.iter().copied()) < 1e-13);
    assert!(without.transient.is_empty() && without.before.is_empty() && without.bins == 0);
    assert!(without.opl_edges.is_empty());

    let mut film = TransientFilm::<1>::new(Layout::new(40, 50, AXIS).unwrap(), options).unwrap();
    let sums = film.add_pass(|tile| (tile.pixels().collect::<Vec<_>>(), render(tile, 0)[0]));
    let firsts: Vec<_> = sums.iter().map(|(pixels, _)| pixels[0]).collect();
    assert!(firsts.is_sorted(), "tiles come in order: {firsts:?}");
    let mut all: Vec<_> = sums.iter().flat_map(|(pixels, _)| pixels.clone()).collect();
    all.sort_unstable();
    assert_eq!(all, (0..2000).collect::<Vec<_>>(), "tiles cover the image");
    let deposited: f64 = sums.iter().map(|s| s.1).sum();
    let steady: f64 = film.develop().steady.iter().sum();
    assert!((steady / deposited - 1.0).abs() < 1e-13);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let layout = Layout::new(67, 59, AXIS).unwrap();
            let options = FilmOptions { variance: true, ..FilmOptions::default() };
            let film = rendered::<3>(layout, options, 3);
            (film.relative_error().map(f64::to_bits), film.develop())
        })
    };
    let one = run(1);
    for threads in [2, 7] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn mean_variance_and_relative_error_agree_with_two_sweeps() {
    let layout = Layout::new(5, 4, AXIS).unwrap();
    let options = FilmOptions { variance: true, ..FilmOptions::default() };
    let n = 6;
    let film = rendered::<3>(layout, options, n);
    let arrays = film.develop();
    // Each pass alone.
    let passes: Vec<_> = (0..n)
        .map(|pass| {
            let mut film = TransientFilm::<3>::new(layout, options).unwrap();
            film.add_pass(|tile| render(tile, pass));
            assert!(film.relative_error().is_none() && film.develop().variance.is_none());
            film.develop()
        })
        .collect();
    let moments = |values: &dyn Fn(usize) -> f64| {
        let values: Vec<f64> = (0..n as usize).map(values).collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        (mean, squares / (n * (n - 1)) as f64)
    };
    let cells: Vec<_> = (0..arrays.transient.len())
        .map(|i| moments(&|pass| f64::from(passes[pass].transient[i])))
        .collect();
    let floats = |values: &[f32]| values.iter().map(|&v| f64::from(v)).collect::<Vec<_>>();
    assert!(worst(floats(&arrays.transient), cells.iter().map(|c| c.0)) < 1e-6);
    let variance = arrays.variance.as_ref().unwrap();
    assert!(worst(floats(variance), cells.iter().map(|c| c.1)) < 1e-6);

    let steady: Vec<_> =
        (0..arrays.steady.len()).map(|i| moments(&|pass| passes[pass].steady[i])).collect();
    let of_pixel = |channels: &[(f64, f64)]| {
        let error: f64 = channels.iter().map(|c| c.1.sqrt()).sum();
        error / channels.iter().map(|c| c.0).sum::<f64>()
    };
    let mut errors: Vec<f64> =
        steady.chunks_exact(3).map(of_pixel).filter(|error| error.is_finite()).collect();
    errors.sort_by(f64::total_cmp);
    let found = film.relative_error().unwrap();
    assert!((found / errors[errors.len() / 2] - 1.0).abs() < 1e-12, "{found}");
}

#[test]
fn a_film_becomes_the_arrays_that_it_can_copy() {
    for (output, variance) in
        [OutputChannels::AsTransported, OutputChannels::Luminance, OutputChannels::Rgb]
            .into_iter()
            .flat_map(|output| [(output, false), (output, true)])
    {
        let options = FilmOptions { variance, output, ..FilmOptions::default() };
        for time in [AXIS, None] {
            for passes in [0, 1, 3] {
                let layout = Layout::new(7, 5, time).unwrap();
                let film = rendered::<1>(layout, options, passes);
                let copy = film.develop();
                assert_eq!(copy.transient.len(), 35 * copy.bins * copy.channels);
                assert_eq!(copy.variance.is_some(), variance && passes > 1 && time.is_some());
                assert!(film.into_arrays() == copy, "{output:?} {variance} {time:?} {passes}");
            }
        }
    }
}

/// Passes that reach few cells of many: all statistics are those of passes that visit every cell.
#[test]
fn cells_that_a_pass_does_not_reach_are_as_if_it_added_nothing() {
    let bins = 1000;
    let time = TimeAxis { start_opl: 0.0, bin_width_opl: 1.0, bins };
    let options = FilmOptions { variance: true, ..FilmOptions::default() };
    let layout = Layout::new(3, 2, Some(time)).unwrap();
    let mut film = TransientFilm::<1>::new(layout, options).unwrap();
    let passes = 40_u64;
    let mut values = vec![vec![0.0; passes as usize]; 6 * bins];
    let mut given = 0.0;
    for pass in 0..passes {
        let hits: Vec<_> = (0..6_usize)
            .flat_map(|pixel| {
                let mut rng = Stream::new(5, pass, pixel as u64);
                // The ends of the axis, the ends of blocks, and a bin that is often hit.
                let bins = [0, 14, 15, 16, 30, 31, 999].map(|bin| (bin, rng.index(3) == 0));
                let bins: Vec<_> = bins.into_iter().filter_map(|b| b.1.then_some(b.0)).collect();
                bins.into_iter()
                    .chain([rng.index(1000)])
                    .map(move |bin| (pixel, bin))
                    .collect::<Vec<_>>()
            })
            .collect();
        let energy = |hit: usize| 1.0 + (hit % 5) as f64;
        film.add_pass(|tile| {
            let own: Vec<usize> = tile.pixels().collect();
            for (hit, &(pixel, bin)) in hits.iter().enumerate().filter(|h| own.contains(&h.1.0)) {
                let arrival = Arrival::Instant(bin as f64 + 0.5);
                tile.deposit(pixel, 0.0, &arrival, Spectrum([energy(hit)]));
            }
        });
        for (hit, (pixel, bin)) in hits.into_iter().enumerate() {
            values[pixel * bins + bin][pass as usize] += energy(hit);
            given += energy(hit);
        }
    }
    let arrays = film.into_arrays();
    let n = passes as f64;
    let means: Vec<f64> = values.iter().map(|v| v.iter().sum::<f64>() / n).collect();
    let variances = values.iter().zip(&means).map(|(values, mean)| {
        values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))
    });
    for (cell, (found, expected)) in arrays.variance.unwrap().into_iter().zip(variances).enumerate()
    {
        let error = (f64::from(found) - expected).abs();
        assert!(error <= 2e-6 * expected, "cell {cell}: {found} for {expected}");
    }
    for (found, expected) in arrays.transient.iter().zip(means) {
        assert!((f64::from(*found) - expected).abs() <= 1e-6 * expected, "{found} for {expected}");
    }
    assert!((arrays.steady.iter().sum::<f64>() * n / given - 1.0).abs() < 1e-12);
}

/// Few bright pixels without noise, or dark ones, do not decide what is said of the image.
#[test]
fn the_relative_error_is_that_of_a_typical_lit_pixel() {
    let layout = Layout::new(10, 10, None).unwrap();
    let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).unwrap();
    for pass in 0..2 {
        film.add_pass(|tile| {
            for pixel in tile.pixels() {
                let energy = match pixel {
                    0..5 => 1e6,
                    5..40 => 0.0,
                    // 1 ± 0.1, a standard error of 10 %.
                    _ => [0.9, 1.1][pass],
                };
                tile.deposit(pixel, 0.0, &Arrival::Instant(2.0), Spectrum([energy]));
            }
        });
    }
    assert!((film.relative_error().unwrap() - 0.1).abs() < 1e-12);
    let mut black = TransientFilm::<1>::new(layout, FilmOptions::default()).unwrap();
    black.add_pass(|_| ());
    black.add_pass(|_| ());
    assert_eq!(black.relative_error(), None);
}

#[test]
fn luminance_combines_channels_before_the_statistics() {
    let layout = Layout::new(6, 5, AXIS).unwrap();
    let options = FilmOptions { variance: true, ..FilmOptions::default() };
    let rgb = rendered::<3>(layout, options, 1).develop();
    let luminance = FilmOptions { output: OutputChannels::Luminance, ..options };
    let grey = rendered::<3>(layout, luminance, 1).develop();
    assert_eq!((rgb.channels, grey.channels), (3, 1));
    let combined = |cells: &[f32]| -> Vec<f64> {
        let cells = cells.chunks_exact(3).map(|c| [c[0], c[1], c[2]].map(f64::from));
        cells.map(|c| Spectrum(c).luminance()).collect()
    };
    let found = grey.transient.iter().map(|&v| f64::from(v));
    assert!(worst(found, combined(&rgb.transient)) < 1e-6);

    // One random number drives all channels: the deviations add before they are squared.
    let mut film = TransientFilm::<3>::new(layout, luminance).unwrap();
    for pass in 0..4 {
        film.add_pass(|tile| {
            for pixel in tile.pixels() {
                let energy = Spectrum::splat(Stream::new(3, pass, pixel as u64).uniform());
                tile.deposit(pixel, 0.0, &Arrival::Instant(2.0), energy);
            }
        });
    }
    let passes: Vec<f64> = (0..4).map(|pass| Stream::new(3, pass, 7).uniform()).collect();
    let mean = passes.iter().sum::<f64>() / 4.0;
    let expected = passes.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / 12.0;
    let found = f64::from(film.develop().variance.unwrap()[7 * 30 + 5]);
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} for {expected}");
}

#[test]
fn a_single_channel_is_repeated_only_when_arrays_are_made() {
    let layout = Layout::new(6, 5, AXIS).unwrap();
    let plain = rendered::<1>(layout, FilmOptions::default(), 2).develop();
    let options = FilmOptions { output: OutputChannels::Rgb, ..FilmOptions::default() };
    let rgb = rendered::<1>(layout, options, 2).develop();
    assert_eq!(rgb.channels, 3);
    assert_eq!(rgb.transient.len(), 3 * plain.transient.len());
    for (three, one) in rgb.transient.chunks_exact(3).zip(&plain.transient) {
        assert_eq!(three, [*one; 3]);
    }
    for (three, one) in rgb.steady.chunks_exact(3).zip(&plain.steady) {
        assert_eq!(three, [*one; 3]);
    }
}

#[test]
fn what_is_not_finite_is_counted_and_kept_out() {
    let layout = Layout::new(4, 4, AXIS).unwrap();
    let mut film = TransientFilm::<3>::new(layout, FilmOptions::default()).unwrap();
    film.add_pass(|tile| {
        for pixel in tile.pixels() {
            let broken = Spectrum([1.0, f64::NAN, 1.0]);
            tile.deposit(pixel, 0.0, &Arrival::Instant(2.0), broken);
            tile.deposit(pixel, 0.0, &Arrival::Instant(2.0), Spectrum::splat(f64::INFINITY));
            tile.deposit(pixel, 0.0, &Arrival::Instant(f64::NAN), Spectrum::ONE);
            tile.deposit(pixel, 0.0, &Arrival::Instant(f64::INFINITY), Spectrum::ONE);
            tile.deposit(pixel, 0.0, &Arrival::Instant(2.0), Spectrum::ONE);
            assert!(tile.non_finite() >= 4);
        }
    });
    assert_eq!(film.non_finite(), 4 * 16);
    assert!(film.develop().steady.iter().all(|&v| v == 1.0));
}

#[test]
fn an_unwarping_film_subtracts_the_way_from_the_eye() {
    let bin = |unwarp| {
        let options = FilmOptions { unwarp, ..FilmOptions::default() };
        let mut film = TransientFilm::<1>::new(Layout::new(1, 1, AXIS).unwrap(), options).unwrap();
        film.add_pass(|tile| tile.deposit(0, 1.0, &Arrival::Instant(2.5), Spectrum::ONE));
        film.develop().transient.iter().position(|&v| v == 1.0)
    };
    assert_eq!((bin(false), bin(true)), (Some(7), Some(2)));
}

#[test]
fn films_that_do_not_fit_are_errors_not_aborts() {
    let bins = |bins| Some(TimeAxis { start_opl: 0.0, bin_width_opl: 1.0, bins });
    for (width, height, time) in [
        (usize::MAX, 2, None),
        (1 << 40, 1 << 10, None),
        (1 << 20, 1 << 20, bins(1 << 20)),
        (4096, 4096, bins(1 << 45)),
    ] {
        let layout = Layout { width, height, time };
        let film = TransientFilm::<3>::new(layout, FilmOptions::default());
        assert!(matches!(film, Err(FilmError::TooLarge { .. })), "{width} {height}");
    }
    let empty = Layout { width: 0, height: 3, time: None };
    let film = TransientFilm::<1>::new(empty, FilmOptions::default());
    assert!(matches!(film, Err(FilmError::Empty { .. })), "checked again by the film");
}

/// Regression: arrays of infinities, or of zeros for light, came without a word.
#[test]
fn values_beyond_f32_are_told() {
    let told = |energy: f64| {
        let mut film =
            TransientFilm::<1>::new(Layout::new(2, 1, AXIS).unwrap(), FilmOptions::default())
                .unwrap();
        film.add_pass(|tile| {
            for pixel in tile.pixels() {
                tile.deposit(pixel, 0.0, &Arrival::Instant(2.0), Spectrum([energy]));
            }
        });
        film.develop().out_of_range(true)
    };
    assert!(told(1e40).is_some_and(|text| text.contains("2 values") && text.contains("lower")));
    assert!(told(1e-42).is_some_and(|text| text.contains("raise all powers")));
    assert_eq!((told(1e38), told(1e-30), told(0.0)), (None, None, None));
}
