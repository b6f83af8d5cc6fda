//! Many tests at once, with one false-alarm probability for all of them.
//!
//! [`holm`] (Holm 1979) holds it under any dependence between the tests: with the p values in
//! ascending order, the i-th of m is multiplied by m − i + 1, and no adjusted value is smaller than
//! one before. [`sidak`] is for independent tests: 1 − (1 − p)^m.

/// Adjusted p values, in the order of `p`: the family rejects where they are at most its level.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![1.0; p.len()];
    let mut largest = 0.0_f64;
    for (rank, &index) in order.iter().enumerate() {
        largest = largest.max(((p.len() - rank) as f64 * p[index]).min(1.0));
        adjusted[index] = largest;
    }
    adjusted
}

/// The probability that the smallest of `tests` independent p values is at most `p`.
pub fn sidak(p: f64, tests: usize) -> f64 {
    -f64::exp_m1(tests as f64 * f64::ln_1p(-p.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holm_steps_down_and_keeps_the_order_of_its_input() {
        let adjusted = holm(&[0.04, 0.01, 0.03]);
        let expected = [0.06, 0.03, 0.06];
        assert!(adjusted.iter().zip(expected).all(|(a, e)| (a - e).abs() < 1e-15), "{adjusted:?}");
        assert!(holm(&[]).is_empty());
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
    }

    #[test]
    fn sidak_keeps_tiny_values_and_one_test_alone() {
        assert!((sidak(1e-18, 5) - 5e-18).abs() < 1e-30);
        assert!((sidak(0.3, 1) - 0.3).abs() < 1e-15);
        assert_eq!(sidak(1.0, 7), 1.0);
    }
}
