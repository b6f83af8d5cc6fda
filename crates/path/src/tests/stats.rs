//! Independent batches and their verdicts.
//!
//! A batch is one pass into a film of its own; a verdict is on a few linear functionals of its
//! arrays (contrasts). With n batches, (mean − expected)/standard error follows Student's t with
//! n − 1 degrees of freedom. The critical value is chosen so that all contrasts of one verdict
//! together reject a correct program with probability at most [`FALSE_ALARM`] (Bonferroni).

use statrs::distribution::{ContinuousCDF, StudentsT};
use tpb_film::{Arrays, FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_render::{Method, PassId};

use crate::PathTracer;

/// Of one verdict, for a random seed.
pub(super) const FALSE_ALARM: f64 = 1e-6;

/// An empty film as the tracer's scene wants it.
pub(super) fn film<const C: usize>(tracer: &PathTracer<'_, C>) -> TransientFilm<C> {
    let spec = &tracer.world.scene.film;
    let time = spec.time.map(|time| TimeAxis {
        start_opl: time.start_opl,
        bin_width_opl: time.bin_width_opl,
        bins: time.bins,
    });
    let layout = Layout::new(spec.width, spec.height, time).unwrap();
    TransientFilm::new(layout, FilmOptions::default()).unwrap()
}

/// One pass; the ledger closes and everything is finite.
pub(super) fn pass<const C: usize>(tracer: &PathTracer<'_, C>, seed: u64, index: u64) -> Arrays {
    let mut film = film(tracer);
    let report = tracer.pass(PassId { seed, index }, &mut film);
    assert!(report.ledger.closure().abs() < 1e-9, "{:?}", report.ledger);
    assert!(report.ledger.emitted == report.counts.camera_paths as f64);
    assert_eq!(film.non_finite(), 0);
    film.develop()
}

/// Means of contrasts over batches.
#[derive(Debug)]
pub(super) struct Estimates {
    pub(super) means: Vec<f64>,
    pub(super) errors: Vec<f64>,
    batches: u64,
}

/// Renders the batches and takes the contrasts of each.
pub(super) fn estimate<const C: usize>(
    tracer: &PathTracer<'_, C>,
    seed: u64,
    batches: u64,
    contrasts: impl Fn(&Arrays) -> Vec<f64>,
) -> Estimates {
    let values: Vec<Vec<f64>> =
        (0..batches).map(|index| contrasts(&pass(tracer, seed, index))).collect();
    let n = batches as f64;
    let column = |i: usize| values.iter().map(move |v| v[i]);
    let means: Vec<f64> = (0..values[0].len()).map(|i| column(i).sum::<f64>() / n).collect();
    let errors = means
        .iter()
        .enumerate()
        .map(|(i, mean)| {
            let squares: f64 = column(i).map(|v| (v - mean) * (v - mean)).sum();
            (squares / (n * (n - 1.0))).sqrt()
        })
        .collect();
    Estimates { means, errors, batches }
}

impl Estimates {
    /// All means agree with `expected`, and the first one is known to the relative `precision`
    /// (one standard error), so that agreement means something.
    pub(super) fn assert_are(&self, expected: &[f64], precision: f64, what: &str) {
        assert_eq!(self.means.len(), expected.len());
        assert!(self.errors[0] <= precision * expected[0], "{what}: too noisy: {self:?}");
        let errors = self.errors.iter().copied();
        self.compare(expected, errors.collect(), what);
    }

    /// Agrees with independent estimates of the same contrasts.
    pub(super) fn assert_agree(&self, other: &Self, precision: f64, what: &str) {
        let both: Vec<f64> =
            self.errors.iter().zip(&other.errors).map(|(a, b)| a.hypot(*b)).collect();
        assert!(both[0] <= precision * other.means[0], "{what}: too noisy: {self:?} {other:?}");
        self.compare(&other.means, both, what);
    }

    fn compare(&self, expected: &[f64], errors: Vec<f64>, what: &str) {
        let t = StudentsT::new(0.0, 1.0, (self.batches - 1) as f64).unwrap();
        let critical = t.inverse_cdf(1.0 - 0.5 * FALSE_ALARM / expected.len() as f64);
        for (i, error) in errors.into_iter().enumerate() {
            let (mean, expected) = (self.means[i], expected[i]);
            let rounding = 1e-6 * expected.abs();
            assert!(
                (mean - expected).abs() <= critical * error + rounding,
                "{what}: contrast {i} is {mean} ± {error}, expected {expected}"
            );
        }
    }
}

/// The mean over pixels of each channel: steady, then blocks of bins (`blocks` equal ones).
pub(super) fn image_and_blocks(blocks: usize) -> impl Fn(&Arrays) -> Vec<f64> {
    move |arrays| {
        let (pixels, channels) = (arrays.pixels(), arrays.channels);
        let mut sums = vec![0.0; channels * (1 + blocks)];
        for pixel in 0..pixels {
            let steady = &arrays.steady[pixel * channels..(pixel + 1) * channels];
            for (sum, value) in sums.iter_mut().zip(steady) {
                *sum += value;
            }
            for (i, &value) in arrays.pixel(pixel).iter().enumerate() {
                let block = i / channels / (arrays.bins / blocks);
                sums[(1 + block) * channels + i % channels] += f64::from(value);
            }
        }
        sums.iter().map(|sum| sum / pixels as f64).collect()
    }
}
