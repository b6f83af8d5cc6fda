//! Straight lines through points, and pseudo-values of what is fitted.

/// Slope of the line of least squares.
pub fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let n = points.clone().count() as f64;
    let mean = |of: fn((f64, f64)) -> f64| points.clone().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let products = points.clone().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>();
    products / points.map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// Exponent of a power law: slope of ln|y| over ln x.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    slope(points.iter().map(|(x, y)| (x.ln(), y.abs().ln())))
}

/// Variance of independent values, without bias.
pub fn variance(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0)
}

/// Pseudo-values B θ − (B − 1) θ₋ᵢ of θ, which `of` gives from all batches or without batch i
/// (Tukey 1958).
pub fn jackknife(of: &impl Fn(Option<usize>) -> f64, batches: usize) -> Vec<f64> {
    let (n, whole) = (batches as f64, of(None));
    (0..batches).map(|batch| n * whole - (n - 1.0) * of(Some(batch))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_exponents_and_pseudo_values_of_a_mean_are_the_values() {
        let cubes: Vec<_> = [0.1, 0.5, 2.0].map(|x: f64| (x, -7.0 * x.powi(3))).to_vec();
        assert!((exponent(&cubes) - 3.0).abs() < 1e-12);
        let values = [1.0, 4.0, 2.0, 7.0];
        let mean = |without: Option<usize>| {
            let kept: Vec<f64> = values
                .iter()
                .enumerate()
                .filter(|(i, _)| Some(*i) != without)
                .map(|p| *p.1)
                .collect();
            kept.iter().sum::<f64>() / kept.len() as f64
        };
        for (pseudo, value) in jackknife(&mean, 4).iter().zip(values) {
            assert!((pseudo - value).abs() < 1e-12);
        }
        assert!((variance(&values) - 7.0).abs() < 1e-12);
    }
}
