//! Independent batches of a method, and their verdict: Student's t on a few contrasts.
//!
//! A batch is one pass into a film of its own. With n batches, (mean − expected)/standard error
//! follows Student's t with n − 1 degrees of freedom; the critical value shares [`FALSE_ALARM`] out
//! evenly among the contrasts of one verdict (Bonferroni).

use statrs::distribution::{ContinuousCDF, StudentsT};
use tpb_film::{Arrays, FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_render::{Method, PassId, PassReport};
use tpb_scene::FilmSpec;

/// Of one verdict, for a random seed.
const FALSE_ALARM: f64 = 1e-6;

/// A film as the scene wants it.
pub(crate) fn layout(spec: &FilmSpec) -> Layout {
    let time = spec.time.map(|time| TimeAxis {
        start_opl: time.start_opl,
        bin_width_opl: time.bin_width_opl,
        bins: time.bins,
    });
    Layout::new(spec.width, spec.height, time).expect("a film")
}

/// One pass; the ledger closes and everything is finite.
pub(crate) fn pass<const C: usize>(
    method: &dyn Method<C>,
    spec: &FilmSpec,
    options: FilmOptions,
    id: PassId,
) -> (Arrays, PassReport) {
    let mut film = TransientFilm::<C>::new(layout(spec), options).expect("a film");
    let report = method.pass(id, &mut film);
    assert!(report.ledger.closure().abs() < 1e-9, "{:?}", report.ledger);
    assert_eq!(film.non_finite(), 0);
    (film.develop(), report)
}

/// Means of contrasts over batches, and their standard errors.
#[derive(Debug)]
pub(crate) struct Estimates {
    pub(crate) means: Vec<f64>,
    pub(crate) errors: Vec<f64>,
    batches: u64,
}

/// Renders the batches and takes the contrasts of each.
pub(crate) fn estimate<const C: usize>(
    method: &dyn Method<C>,
    spec: &FilmSpec,
    (seed, batches): (u64, u64),
    contrasts: impl Fn(&Arrays) -> Vec<f64>,
) -> Estimates {
    let of = |index| {
        let (arrays, _) = pass(method, spec, FilmOptions::default(), PassId { seed, index });
        contrasts(&arrays)
    };
    let values: Vec<Vec<f64>> = (0..batches).map(of).collect();
    let n = batches as f64;
    let means: Vec<f64> =
        (0..values[0].len()).map(|i| values.iter().map(|v| v[i]).sum::<f64>() / n).collect();
    let error = |i: usize| {
        let squares: f64 = values.iter().map(|v| (v[i] - means[i]).powi(2)).sum();
        (squares / (n * (n - 1.0))).sqrt()
    };
    let errors = (0..means.len()).map(error).collect();
    Estimates { means, errors, batches }
}

impl Estimates {
    /// All means agree with `expected`, which are known; each mean of at least a tenth
    /// of the largest is known to the relative `precision` (one standard error), so that agreement
    /// means something.
    pub(crate) fn assert_are(&self, expected: &[f64], precision: f64, what: &str) {
        self.compare(expected, &self.errors, precision, what);
    }

    /// Agrees with independent estimates of the same contrasts.
    pub(crate) fn assert_agree(&self, other: &Self, precision: f64, what: &str) {
        let both: Vec<f64> =
            self.errors.iter().zip(&other.errors).map(|(a, b)| a.hypot(*b)).collect();
        self.compare(&other.means, &both, precision, what);
    }

    /// Other values of as many batches.
    pub(crate) fn with(&self, means: Vec<f64>, errors: Vec<f64>) -> Self {
        Self { means, errors, batches: self.batches }
    }

    fn compare(&self, expected: &[f64], errors: &[f64], precision: f64, what: &str) {
        assert_eq!(self.means.len(), expected.len());
        let t = StudentsT::new(0.0, 1.0, (self.batches - 1) as f64).expect("a distribution");
        let critical = t.inverse_cdf(1.0 - 0.5 * FALSE_ALARM / expected.len() as f64);
        let largest = expected.iter().copied().fold(0.0, f64::max);
        for (i, (&error, &expected)) in errors.iter().zip(expected).enumerate() {
            let mean = self.means[i];
            let faint = expected < 0.1 * largest;
            assert!(
                faint || error <= precision * expected,
                "{what}: {i} is too noisy: {mean} ± {error}"
            );
            assert!(
                (mean - expected).abs() <= critical * error + 1e-9 * expected,
                "{what}: contrast {i} is {mean} ± {error}, expected {expected}"
            );
        }
    }
}

/// The mean over pixels of each channel: steady, then `blocks` equal blocks of bins.
pub(crate) fn image_and_blocks(blocks: usize) -> impl Fn(&Arrays) -> Vec<f64> {
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

/// Every pixel's steady value.
pub(crate) fn steady(arrays: &Arrays) -> Vec<f64> {
    arrays.steady.clone()
}
