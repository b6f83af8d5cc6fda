//! Batch means: one value of each contrast per independent batch.
//!
//! Mean and standard error of the mean over B batches, s/√B with s² = Σ(x − x̄)²/(B − 1), computed
//! about the mean (two passes; nothing cancels).

/// Values of several contrasts in independent batches.
#[derive(Clone, Debug, Default)]
pub struct Batches {
    /// `values[batch][contrast]`.
    values: Vec<Vec<f64>>,
}

/// What the batches say about one contrast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Mean over batches.
    pub mean: f64,
    /// Standard error of that mean; infinite under two batches.
    pub standard_error: f64,
}

impl Batches {
    /// No batches yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a batch: one value for each contrast.
    pub fn push(&mut self, values: Vec<f64>) {
        debug_assert!(self.values.first().is_none_or(|first| first.len() == values.len()));
        self.values.push(values);
    }

    /// The values of each batch.
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.values
    }

    /// How many batches there are.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// How many contrasts each batch has.
    pub fn contrasts(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// Degrees of freedom of the standard errors.
    pub fn freedom(&self) -> f64 {
        self.values.len().saturating_sub(1).max(1) as f64
    }

    /// Mean and standard error of one contrast.
    pub fn summary(&self, contrast: usize) -> Summary {
        let column: Vec<f64> = self.values.iter().map(|batch| batch[contrast]).collect();
        summarise(&column)
    }
}

/// Mean and standard error of independent values.
pub fn summarise(values: &[f64]) -> Summary {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let standard_error =
        if values.len() < 2 { f64::INFINITY } else { (squares / ((n - 1.0) * n)).sqrt() };
    Summary { mean, standard_error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_batches_have_no_error_and_one_third_is_one_third() {
        let mut batches = Batches::new();
        for x in [1.0, 2.0, 3.0] {
            batches.push(vec![7.0, x]);
        }
        assert_eq!(batches.summary(0), Summary { mean: 7.0, standard_error: 0.0 });
        let Summary { mean, standard_error } = batches.summary(1);
        assert!(
            (mean - 2.0).abs() < 1e-15
                && (standard_error * standard_error * 3.0 - 1.0).abs() < 1e-15
        );
    }

    #[test]
    fn a_single_batch_knows_nothing_of_its_error() {
        assert_eq!(summarise(&[3.0]).standard_error, f64::INFINITY);
    }
}
