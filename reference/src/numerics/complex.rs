//! Complex numbers, as far as contour integrals need them.

use std::ops::{Add, Mul};

/// re + i im.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

impl Complex {
    pub(crate) const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// e^self.
    pub(crate) fn exp(self) -> Self {
        let modulus = self.re.exp();
        let (sine, cosine) = self.im.sin_cos();
        Self::new(modulus * cosine, modulus * sine)
    }

    /// ln(1 + self), the principal value, with its digits for small numbers.
    pub(crate) fn ln_1p(self) -> Self {
        let square = self.re * (2.0 + self.re) + self.im * self.im;
        Self::new(0.5 * square.ln_1p(), self.im.atan2(1.0 + self.re))
    }

    /// The quotient.
    pub(crate) fn over(self, other: Self) -> Self {
        let square = other.re * other.re + other.im * other.im;
        Self::new(
            (self.re * other.re + self.im * other.im) / square,
            (self.im * other.re - self.re * other.im) / square,
        )
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Add<f64> for Complex {
    type Output = Self;

    fn add(self, other: f64) -> Self {
        Self::new(self.re + other, self.im)
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;

    fn mul(self, other: f64) -> Self {
        Self::new(self.re * other, self.im * other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_operations_undo_each_other() {
        let (a, b) = (Complex::new(0.3, -1.7), Complex::new(-2.0, 0.4));
        let undone = [(a * b).over(b), a.ln_1p().exp() + -1.0, (a.exp() + -1.0).ln_1p()];
        for found in undone {
            let error = (found.re - a.re).hypot(found.im - a.im);
            assert!(error < 1e-15, "{found:?} for {a:?}");
        }
    }

    #[test]
    fn logarithms_near_one_keep_their_digits() {
        let small = Complex::new(-1e-20, 3e-20).ln_1p();
        assert!((small.re / -1e-20 - 1.0).abs() < 1e-15 && (small.im / 3e-20 - 1.0).abs() < 1e-15);
    }
}
