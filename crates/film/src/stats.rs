//! Mean and variance over passes, cell by cell, in one sweep (Welford 1962).
//!
//! With pass `n` of value x: `d = x − mean`, `mean += d/n`, `M2 += d (x − mean)`. Passes are
//! independent and alike, so the variance of the mean is `M2/(n (n − 1))`.

/// Adds pass number `n` (from 1 on) to the means alone; `K` channels at a time.
pub(crate) fn add_to_means<const K: usize>(
    mean: &mut [f64],
    values: impl Iterator<Item = [f64; K]>,
    n: u64,
) {
    let share = 1.0 / n as f64;
    for (mean, values) in mean.as_chunks_mut::<K>().0.iter_mut().zip(values) {
        for (mean, value) in mean.iter_mut().zip(values) {
            *mean += (value - *mean) * share;
        }
    }
}

/// Adds pass number `n` (from 1 on) to means and sums of squared deviations.
pub(crate) fn add_to_moments<const K: usize>(
    mean: &mut [f64],
    squares: &mut [f64],
    values: impl Iterator<Item = [f64; K]>,
    n: u64,
) {
    let share = 1.0 / n as f64;
    let (mean, squares) = (mean.as_chunks_mut::<K>().0, squares.as_chunks_mut::<K>().0);
    for ((mean, squares), values) in mean.iter_mut().zip(squares).zip(values) {
        for channel in 0..K {
            let deviation = values[channel] - mean[channel];
            mean[channel] += deviation * share;
            squares[channel] += deviation * (values[channel] - mean[channel]);
        }
    }
}

/// M2 → variance of the mean of `n` passes; `None` for fewer than two.
pub(crate) fn variance_factor(n: u64) -> Option<f64> {
    (n >= 2).then(|| 1.0 / (n as f64 * (n - 1) as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sweep_agrees_with_two_even_where_the_spread_is_tiny() {
        let passes: Vec<f64> = (0..50).map(|i| 1e6 + f64::from(i * i % 17) * 1e-3).collect();
        let (mut mean, mut squares, mut only_mean) = ([0.0], [0.0], [0.0]);
        for (i, &x) in passes.iter().enumerate() {
            add_to_moments(&mut mean, &mut squares, [[x]].into_iter(), i as u64 + 1);
            add_to_means(&mut only_mean, [[x]].into_iter(), i as u64 + 1);
        }
        let n = passes.len() as f64;
        // Offsets from 1e6 are exact enough to sum plainly.
        let two_mean = passes.iter().map(|x| x - 1e6).sum::<f64>() / n;
        let two_squares: f64 = passes.iter().map(|x| (x - 1e6 - two_mean).powi(2)).sum();
        assert!((mean[0] - 1e6 - two_mean).abs() < 1e-9, "{}", mean[0]);
        assert!((squares[0] / two_squares - 1.0).abs() < 1e-6, "{} {two_squares}", squares[0]);
        assert_eq!(mean, only_mean);
        let variance = squares[0] * variance_factor(50).unwrap();
        assert!((variance / (two_squares / (n * (n - 1.0))) - 1.0).abs() < 1e-6);
        assert_eq!(variance_factor(1), None);
    }
}
