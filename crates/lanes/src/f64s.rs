//! Vectors of f64.

use std::ops::{Add, Div, Mul, Neg, Not, Sub};

use crate::{LANES, Simd, Vectors, operators};

/// As many f64 as a register holds.
#[derive(Clone, Copy)]
pub struct F64s<S: Simd>(S, S::f64s);

/// Truth of each.
#[derive(Clone, Copy)]
pub struct Mask<S: Simd>(S, S::m64s);

impl<const N: usize> Vectors for [f64; N] {
    type Vector<S: Simd> = F64s<S>;

    #[inline(always)]
    fn vector<S: Simd>(&self, simd: S, index: usize) -> F64s<S> {
        F64s(simd, S::as_simd_f64s(self).0[index])
    }
}

/// Added and taken off again, it rounds to the nearest integer, which its low bits then hold.
pub(crate) const ROUND: f64 = 6_755_399_441_055_744.0;

impl<S: Simd> F64s<S> {
    /// The same value in each.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self(simd, simd.splat_f64s(value))
    }

    /// As vector number `index` of an array.
    #[inline(always)]
    pub fn store<const N: usize>(self, to: &mut [f64; N], index: usize) {
        S::as_mut_simd_f64s(to).0[index] = self.1;
    }

    /// Of all of them, in an order that depends on the machine: for whole numbers.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0.reduce_sum_f64s(self.1)
    }

    /// The largest of them.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.0.reduce_max_f64s(self.1)
    }

    /// The smallest of them.
    #[inline(always)]
    pub fn smallest(self) -> f64 {
        self.0.reduce_min_f64s(self.1)
    }

    /// |self|.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        Self(self.0, self.0.abs_f64s(self.1))
    }

    /// √self.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt_f64s(self.1))
    }

    /// The larger; of a NaN either.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(self.0, self.0.max_f64s(self.1, other.1))
    }

    /// self < other.
    #[inline(always)]
    pub fn less(self, other: Self) -> Mask<S> {
        Mask(self.0, self.0.less_than_f64s(self.1, other.1))
    }

    /// self = other.
    #[inline(always)]
    pub fn equals(self, other: Self) -> Mask<S> {
        Mask(self.0, self.0.equal_f64s(self.1, other.1))
    }

    /// The smaller; of a NaN either.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self(self.0, self.0.min_f64s(self.1, other.1))
    }

    /// The nearest integer, for less than 2⁵¹.
    #[inline(always)]
    #[must_use]
    pub fn round(self) -> Self {
        self + ROUND - ROUND
    }

    /// self ≤ other.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Mask<S> {
        Mask(self.0, self.0.less_than_or_equal_f64s(self.1, other.1))
    }

    /// The instructions that it is made for.
    #[inline(always)]
    pub(crate) fn simd(self) -> S {
        self.0
    }

    /// 2ᵏ, if the low bits of each hold k.
    #[inline(always)]
    pub(crate) fn power_of_two(self) -> Self {
        let mut bits = [0.0; LANES];
        self.store(&mut bits, 0);
        for bits in &mut bits[..S::F64_LANES] {
            *bits = f64::from_bits(bits.to_bits().wrapping_add(1023) << 52);
        }
        bits.vector(self.0, 0)
    }
}

impl<S: Simd> Not for Mask<S> {
    type Output = Self;

    /// The opposite.
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0, self.0.not_m64s(self.1))
    }
}

impl<S: Simd> Mask<S> {
    /// Both.
    #[inline(always)]
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0, self.0.and_m64s(self.1, other.1))
    }

    /// `value` where true, `other` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn choose(self, value: F64s<S>, other: F64s<S>) -> F64s<S> {
        F64s(self.0, self.0.select_f64s(self.1, value.1, other.1))
    }

    /// `value` where true, 0 elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn of(self, value: F64s<S>) -> F64s<S> {
        F64s(self.0, self.0.select_f64s(self.1, value.1, self.0.splat_f64s(0.0)))
    }
}

operators!(F64s f64 splat_f64s neg_f64s:
    Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

/// The integers that `values`, whole numbers from 0 to 2³² − 1, are.
#[inline(always)]
pub fn integers(values: &[f64; LANES]) -> [u32; LANES] {
    // Their low bits, once nothing is left behind the point.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let mut integers = [0; LANES];
    for (integer, value) in integers.iter_mut().zip(values) {
        *integer = (value + WHOLE).to_bits() as u32;
    }
    integers
}
