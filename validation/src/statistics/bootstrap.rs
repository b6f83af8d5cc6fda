//! Bootstrap intervals, for what has no t interval: medians over replicates with fireflies.
//!
//! Percentile intervals (Efron 1979) from resampling whole replicates, with random numbers of a
//! fixed stream. At least 16 replicates give them a meaning.

use tpb_optics::Stream;

/// How many resamples.
const RESAMPLES: usize = 4000;

/// The median; NaN without values.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

/// The ratio of the medians of two samples, and its percentile interval.
pub fn ratio_of_medians(a: &[f64], b: &[f64], confidence: f64) -> (f64, [f64; 2]) {
    let mut rng = Stream::new(0, 0, 0);
    let resample = |values: &[f64], rng: &mut Stream| -> f64 {
        median(&(0..values.len()).map(|_| values[rng.index(values.len())]).collect::<Vec<_>>())
    };
    let mut ratios: Vec<f64> =
        (0..RESAMPLES).map(|_| resample(a, &mut rng) / resample(b, &mut rng)).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |fraction: f64| ratios[((fraction * RESAMPLES as f64) as usize).min(RESAMPLES - 1)];
    let tail = 0.5 * (1.0 - confidence);
    (median(a) / median(b), [at(tail), at(1.0 - tail)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_holds_the_ratio_and_shrugs_off_a_firefly() {
        let mut rng = Stream::new(3, 0, 0);
        let mut a: Vec<f64> = (0..16).map(|_| 3.0 + 0.3 * rng.uniform()).collect();
        let b: Vec<f64> = (0..16).map(|_| 1.0 + 0.1 * rng.uniform()).collect();
        a[7] = 1e9;
        let (ratio, [low, high]) = ratio_of_medians(&a, &b, 0.95);
        assert!(low <= ratio && ratio <= high && low > 2.7 && high < 3.3, "{low} {ratio} {high}");
    }

    #[test]
    fn medians_of_even_and_odd_counts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
