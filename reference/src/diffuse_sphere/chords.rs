//! Light inside an empty sphere with a diffuse wall: every order of reflection, exactly.
//!
//! Between two points of a sphere, cos · cos / distance² is 1/(4R²) wherever they lie, so light
//! that leaves a Lambertian wall hits it next with uniform density. The chord has the length
//! 2R x with the density f(x) = 2x on [0, 1], independent of everything before; the time of k
//! reflections follows the k-fold convolution of f. Source and camera are at the centre, which
//! makes the first irradiation uniform; otherwise only the average over the wall is so simple.
//!
//! [`sphere_chords_pdf`] and [`sphere_chords_cdf`] give f_n and its integral, the law of the sum of n
//! chords in units of 2R. With wall albedo ρ, the radiance at the centre after k ≥ 1 reflections is
//!
//! > L_k(t) = Q ρ^k / (4π² R²) · f_{k−1}(t − 2R/v),
//!
//! a delta for k = 1; [`sphere_centre_radiance_bins`] integrates it over t0 ≤ t < t1 for Q = R = v
//! = 1, where the sum of chords is x = (t − 2)/2 \[J/(m² sr)\].
//!
//! # Stable form
//!
//! Written out in powers (x − j)^(2n−m−1), f_n is an alternating sum, without a correct digit for
//! n ≳ 12. Instead ([`ChordSum`]), f_n is kept on each cell j ≤ x < j + 1 as a polynomial with
//! *positive* coefficients in the Bernstein basis. With u = x − j,
//!
//! > f_n(j + u) = 2 ∫_0^u (u − z) P_j dz + 2 ∫_u^1 (1 − z) P_{j−1} dz + 2u ∫_u^1 P_{j−1} dz,
//!
//! where P_j is f_{n−1} on cell j: products and integrals of positive functions alone. Tails of
//! 1e-200 have as many digits as the centre. Differences of the cdf are never formed either.

use crate::error::{Result, require};
use crate::numerics::bernstein::Bernstein;
use serde::Deserialize;
use std::f64::consts::PI;

/// The largest number of chords; the work grows as its cube.
pub const MAX_CHORDS: u32 = 400;

/// Inputs of [`sphere_chords_pdf`] and [`sphere_chords_cdf`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereChords {
    /// Number of chords, 1 to [`MAX_CHORDS`].
    pub chords: u32,
    /// Sum of their lengths, in diameters.
    pub x: f64,
}

/// Inputs of [`sphere_centre_radiance_bins`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereCentreBin {
    /// Albedo ρ of the wall, 0 to 1.
    pub albedo: f64,
    /// Which reflections.
    pub order: Order,
    /// Start of the bin, in R/v.
    pub t0: f64,
    /// End of the bin, in R/v.
    pub t1: f64,
}

/// Which orders of reflection: a number from 1, or `"all"`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "serde_json::Value")]
pub enum Order {
    /// Light reflected exactly so many times.
    Exactly(u32),
    /// The sum of all orders.
    All,
}

impl TryFrom<serde_json::Value> for Order {
    type Error = &'static str;

    fn try_from(value: serde_json::Value) -> std::result::Result<Self, Self::Error> {
        if value == "all" {
            return Ok(Self::All);
        }
        let order = value.as_u64().and_then(|order| u32::try_from(order).ok());
        order.map(Self::Exactly).ok_or("an order is a whole number or \"all\"")
    }
}

/// The probability density f_n(x) that n chords sum up to x diameters.
pub fn sphere_chords_pdf(input: &SphereChords) -> Result<f64> {
    Ok(check_chords(input)?.density(input.x))
}

/// The probability that n chords sum up to at most x diameters.
pub fn sphere_chords_cdf(input: &SphereChords) -> Result<f64> {
    Ok(check_chords(input)?.probability(0.0, input.x))
}

/// The radiance \[J/(m² sr)\] seen at the centre within a bin, for Q = R = v = 1.
pub fn sphere_centre_radiance_bins(input: &SphereCentreBin) -> Result<f64> {
    let &SphereCentreBin { albedo, order, t0, t1 } = input;
    require((0.0..=1.0).contains(&albedo), "albedo", albedo, "between 0 and 1")?;
    require(t0.is_finite(), "t0", t0, "finite")?;
    require(t1.is_finite() && t1 >= t0, "t1", t1, "finite and not before t0")?;
    let first = if t0 <= 2.0 && 2.0 < t1 { albedo } else { 0.0 };
    let (x0, x1) = (0.5 * (t0 - 2.0), 0.5 * (t1 - 2.0));
    let sum = match order {
        Order::Exactly(1) => first,
        Order::Exactly(k) => {
            require(k > 0, "order", f64::from(k), "at least 1")?;
            let sum = ChordSum::new(k - 1)?;
            albedo.powi(k.cast_signed()) * sum.probability(x0, x1)
        }
        Order::All => first + all_further_orders(albedo, x0, x1)?,
    };
    Ok(sum / (4.0 * PI * PI))
}

/// Σ ρ^(n+1) P(x0 ≤ sum of n chords < x1) over n ≥ 1.
fn all_further_orders(albedo: f64, x0: f64, x1: f64) -> Result<f64> {
    if x1 <= 0.0 || albedo == 0.0 {
        return Ok(0.0);
    }
    let mut chords = ChordSum::one();
    let mut weight = albedo * albedo;
    let mut sum = weight * chords.probability(x0, x1);
    // A bound of the weighted probabilities, from f ≤ 2x: (2x²)^n / (2n)!, falling by `ratio`.
    let mut bound = weight * x1 * x1;
    loop {
        let n = f64::from(chords.chords);
        let ratio = 2.0 * albedo * x1 * x1 / ((2.0 * n + 1.0) * (2.0 * n + 2.0));
        if ratio < 0.5 && bound * ratio <= 1e-17 * sum {
            return Ok(sum);
        }
        chords = chords.with_one_more()?;
        weight *= albedo;
        bound *= ratio;
        sum += weight * chords.probability(x0, x1);
    }
}

fn check_chords(input: &SphereChords) -> Result<ChordSum> {
    require(!input.x.is_nan(), "x", input.x, "a number")?;
    ChordSum::new(input.chords)
}

/// The law of the sum of n chords of a sphere of diameter 1.
#[derive(Debug, Clone)]
pub struct ChordSum {
    chords: u32,
    /// The density on each of the cells [j, j+1), j = 0 … n−1, of degree 2n − 1.
    cells: Vec<Bernstein>,
}

impl ChordSum {
    /// The sum of 1 to [`MAX_CHORDS`] chords.
    pub fn new(chords: u32) -> Result<Self> {
        check_count(chords)?;
        (1..chords).try_fold(Self::one(), |sum, _| sum.with_one_more())
    }

    /// A single chord.
    pub fn one() -> Self {
        Self { chords: 1, cells: vec![Bernstein::new(vec![0.0, 2.0])] }
    }

    /// The sum of this and one more independent chord.
    pub fn with_one_more(&self) -> Result<Self> {
        check_count(self.chords + 1)?;
        let from_same = |cell: &Bernstein| (2.0, cell.integral_from_start().integral_from_start());
        let from_previous = |cell: &Bernstein| {
            [
                (2.0, cell.times_one_minus_u().integral_to_end()),
                (2.0, cell.integral_to_end().times_u()),
            ]
        };
        let cells = (0..=self.cells.len())
            .map(|j| {
                let previous = j.checked_sub(1).map(|i| from_previous(&self.cells[i]));
                let same = self.cells.get(j).map(from_same);
                let terms: Vec<_> = previous.into_iter().flatten().chain(same).collect();
                Bernstein::sum(&terms)
            })
            .collect();
        Ok(Self { chords: self.chords + 1, cells })
    }

    /// The number n of chords.
    pub fn chords(&self) -> u32 {
        self.chords
    }

    /// The density at x.
    pub fn density(&self, x: f64) -> f64 {
        if !(0.0..=f64::from(self.chords)).contains(&x) {
            return 0.0;
        }
        // The upper end of the support belongs to the last cell.
        let cell = (x as usize).min(self.cells.len() - 1);
        self.cells[cell].at(x - cell as f64)
    }

    /// The probability of x0 ≤ sum < x1.
    pub fn probability(&self, x0: f64, x1: f64) -> f64 {
        if x0 <= 0.0 && x1 >= f64::from(self.chords) {
            return 1.0;
        }
        let piece = |(j, cell): (usize, &Bernstein)| {
            let in_cell = |x: f64| (x - j as f64).clamp(0.0, 1.0);
            cell.integral(in_cell(x0), in_cell(x1))
        };
        self.cells.iter().enumerate().map(piece).sum()
    }
}

fn check_count(chords: u32) -> Result<f64> {
    let requirement = "between 1 and 400 (later light needs more)";
    require((1..=MAX_CHORDS).contains(&chords), "chords", f64::from(chords), requirement)
}

#[cfg(test)]
#[path = "chords_tests.rs"]
mod tests;
