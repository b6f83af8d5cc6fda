//! Polynomials on [0, 1] in the basis of Bernstein, for positive functions.
//!
//! P(u) = Σ c_i B_i(u) of degree d, with B_i = C(d, i) u^i (1 − u)^(d−i). If all c_i are at least
//! 0, every operation here is a sum of products of numbers of one sign. Nothing cancels: the
//! relative error is a few roundings per degree, however small the value.

/// A polynomial by its coefficients in the Bernstein basis, lowest first; never empty.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bernstein(Vec<f64>);

impl Bernstein {
    pub(crate) fn new(coefficients: Vec<f64>) -> Self {
        debug_assert!(!coefficients.is_empty());
        Self(coefficients)
    }

    /// P(u), by the algorithm of de Casteljau.
    pub(crate) fn at(&self, u: f64) -> f64 {
        self.until(u).0.last().copied().unwrap_or_default()
    }

    /// ∫ P from `start` to `end`, within [0, 1].
    pub(crate) fn integral(&self, start: f64, end: f64) -> f64 {
        if end <= start {
            return 0.0;
        }
        if start == 0.0 && end == 1.0 {
            return self.mean();
        }
        // On [0, end], the interval that remains starts at the fraction start / end.
        let piece = self.until(end).from(start / end, (end - start) / end);
        (end - start) * piece.mean()
    }

    fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    /// u ↦ ∫ P from 0 to u.
    pub(crate) fn integral_from_start(&self) -> Self {
        let count = self.0.len() as f64;
        let mut sum = 0.0;
        let sums = self.0.iter().map(|c| {
            sum += c;
            sum / count
        });
        Self(std::iter::once(0.0).chain(sums).collect())
    }

    /// u ↦ ∫ P from u to 1.
    pub(crate) fn integral_to_end(&self) -> Self {
        self.reversed().integral_from_start().reversed()
    }

    /// u ↦ u P(u).
    pub(crate) fn times_u(&self) -> Self {
        let degree = self.0.len() as f64;
        let raised = self.0.iter().enumerate().map(|(i, c)| c * (i + 1) as f64 / degree);
        Self(std::iter::once(0.0).chain(raised).collect())
    }

    /// u ↦ (1 − u) P(u).
    pub(crate) fn times_one_minus_u(&self) -> Self {
        self.reversed().times_u().reversed()
    }

    /// u ↦ Σ factor P(u) over terms of one degree.
    pub(crate) fn sum(terms: &[(f64, Self)]) -> Self {
        let count = terms.first().map_or(1, |(_, term)| term.0.len());
        debug_assert!(terms.iter().all(|(_, term)| term.0.len() == count));
        Self(
            (0..count)
                .map(|i| terms.iter().map(|(factor, term)| factor * term.0[i]).sum())
                .collect(),
        )
    }

    /// u ↦ P(1 − u).
    fn reversed(&self) -> Self {
        Self(self.0.iter().rev().copied().collect())
    }

    /// The same polynomial with [0, u] stretched to [0, 1].
    fn until(&self, u: f64) -> Self {
        self.left_part(u, 1.0 - u)
    }

    /// The same polynomial with [u, 1] stretched to [0, 1]; `complement` is 1 − u.
    fn from(&self, u: f64, complement: f64) -> Self {
        self.reversed().left_part(complement, u).reversed()
    }

    /// De Casteljau's triangle with the weights u and 1 − u; its left edge.
    fn left_part(&self, u: f64, complement: f64) -> Self {
        let mut row = self.0.clone();
        let mut edge = Vec::with_capacity(row.len());
        while let Some(&first) = row.first() {
            edge.push(first);
            for i in 1..row.len() {
                row[i - 1] = complement * row[i - 1] + u * row[i];
            }
            row.pop();
        }
        Self(edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 + 2u + 3u² in the Bernstein basis of degree 2: c = 1, 2, 6.
    fn sample() -> Bernstein {
        Bernstein::new(vec![1.0, 2.0, 6.0])
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-14 * b.abs(), "{a} for {b}");
    }

    #[test]
    fn every_operation_meets_the_power_form() {
        let p = |u: f64| 1.0 + 2.0 * u + 3.0 * u * u;
        let integral = |u: f64| u + u * u + u * u * u;
        for u in [0.0, 0.1, 0.5, 0.9, 1.0] {
            close(sample().at(u), p(u));
            close(sample().times_u().at(u), u * p(u));
            close(sample().times_one_minus_u().at(u), (1.0 - u) * p(u));
            close(sample().integral_from_start().at(u), integral(u));
            close(sample().integral_to_end().at(u), 3.0 - integral(u));
            close(sample().integral(0.0, u), integral(u));
            close(sample().integral(u, 1.0), 3.0 - integral(u));
        }
        close(sample().integral(0.25, 0.5), integral(0.5) - integral(0.25));
        close(Bernstein::sum(&[(2.0, sample()), (0.5, sample())]).at(0.3), 2.5 * p(0.3));
    }
}
