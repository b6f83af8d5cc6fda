//! Pearson's chi-square test of a histogram against expected counts.
//!
//! Cells are pooled, the least expected first, until each has an expectation of at least 5, as the
//! approximation needs (Cochran 1954). Counts in cells that should stay empty fail at once: p = 0.
//! The expectations must add up to the number of samples: a missing part is given a cell of its
//! own by the caller.

use statrs::function::gamma::checked_gamma_ur;

/// Least expectation of a pooled cell.
const LEAST_EXPECTED: f64 = 5.0;

/// Expectations below this are zero up to the error of their quadrature.
const EMPTY: f64 = 1e-9;

/// The result of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Σ (observed − expected)²/expected over pooled cells.
    pub statistic: f64,
    /// Pooled cells less one.
    pub freedom: usize,
    /// P(a larger statistic) if the expectations are true.
    pub p: f64,
}

/// Tests `observed` counts against `expected` ones.
///
/// # Panics
/// If the two differ in length.
pub fn chi_square(observed: &[u64], expected: &[f64]) -> ChiSquare {
    assert_eq!(observed.len(), expected.len(), "one expectation for each cell");
    let impossible = ChiSquare { statistic: f64::INFINITY, freedom: 0, p: 0.0 };
    let count: u64 = observed.iter().sum();
    let total: f64 = expected.iter().sum();
    // Written so that a NaN fails.
    let adds_up = (total - count as f64).abs() <= 1e-6 * count as f64;
    let stray = |(&o, &e): (&u64, &f64)| o > 0 && e <= EMPTY;
    if !adds_up || observed.iter().zip(expected).any(stray) {
        return impossible;
    }
    let pooled = pool(observed, expected);
    let statistic = pooled.iter().map(|&(o, e)| (o - e) * (o - e) / e).sum();
    let freedom = pooled.len().saturating_sub(1);
    let p = if freedom == 0 { 1.0 } else { upper_tail(statistic, freedom) };
    ChiSquare { statistic, freedom, p }
}

/// P(χ² > statistic).
fn upper_tail(statistic: f64, freedom: usize) -> f64 {
    if statistic <= 0.0 {
        return 1.0;
    }
    checked_gamma_ur(0.5 * freedom as f64, 0.5 * statistic).unwrap_or(0.0)
}

/// (observed, expected) of cells with an expectation of at least [`LEAST_EXPECTED`].
fn pool(observed: &[u64], expected: &[f64]) -> Vec<(f64, f64)> {
    let mut cells: Vec<(f64, f64)> =
        observed.iter().zip(expected).map(|(&o, &e)| (o as f64, e)).collect();
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut pooled: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for (o, e) in cells {
        open = (open.0 + o, open.1 + e);
        if open.1 >= LEAST_EXPECTED {
            pooled.push(open);
            open = (0.0, 0.0);
        }
    }
    if let Some(last) = pooled.last_mut() {
        *last = (last.0 + open.0, last.1 + open.1);
    }
    pooled
}

#[cfg(test)]
mod tests {
    use super::*;
    use tpb_optics::Stream;

    fn histogram(seed: u64, samples: usize, cells: usize, map: impl Fn(f64) -> f64) -> Vec<u64> {
        let mut rng = Stream::new(seed, 0, 0);
        let mut counts = vec![0; cells];
        for _ in 0..samples {
            counts[(map(rng.uniform()) * cells as f64) as usize] += 1;
        }
        counts
    }

    #[test]
    fn under_the_null_p_is_uniform() {
        // 2000 tests at level 5 %: 100 expected, sd 9.7; six of them either way. Seeds are fixed.
        let rejected = (0..2000)
            .filter(|&seed| chi_square(&histogram(seed, 1000, 20, |u| u), &[50.0; 20]).p < 0.05)
            .count();
        assert!((42..=158).contains(&rejected), "{rejected} of 2000");
    }

    #[test]
    fn a_density_that_is_wrong_by_three_percent_is_rejected() {
        let counts = histogram(5, 1_000_000, 20, |u| u * (0.97 + 0.03 * u));
        assert!(chi_square(&counts, &[50_000.0; 20]).p < 1e-9);
    }

    #[test]
    fn counts_where_nothing_can_be_and_lost_mass_fail_at_once() {
        assert_eq!(chi_square(&[1, 99], &[0.0, 100.0]).p, 0.0);
        assert_eq!(chi_square(&[50, 50], &[50.0, 45.0]).p, 0.0);
        assert_eq!(chi_square(&[50, 50], &[50.0, f64::NAN]).p, 0.0);
    }

    #[test]
    fn rare_cells_are_pooled() {
        let test = chi_square(&[2, 1, 97], &[1.0, 2.0, 97.0]);
        assert_eq!((test.freedom, test.p), (0, 1.0));
        let test = chi_square(&[6, 1, 2, 91], &[3.0, 1.0, 3.0, 93.0]);
        assert_eq!(test.freedom, 1);
    }
}
