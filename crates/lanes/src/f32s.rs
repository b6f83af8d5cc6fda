//! Vectors of f32, for what only culls.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::{Simd, Vectors, operators};

/// As many f32 as a register holds.
#[derive(Clone, Copy)]
pub struct F32s<S: Simd>(S, S::f32s);

/// Truth of each.
#[derive(Clone, Copy)]
pub struct Mask32<S: Simd>(S, S::m32s);

impl<const N: usize> Vectors for [f32; N] {
    type Vector<S: Simd> = F32s<S>;

    #[inline(always)]
    fn vector<S: Simd>(&self, simd: S, index: usize) -> F32s<S> {
        F32s(simd, S::as_simd_f32s(self).0[index])
    }
}

impl<S: Simd> F32s<S> {
    /// The same value in each.
    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self(simd, simd.splat_f32s(value))
    }

    /// As vector number `index` of an array.
    #[inline(always)]
    pub fn store<const N: usize>(self, to: &mut [f32; N], index: usize) {
        S::as_mut_simd_f32s(to).0[index] = self.1;
    }

    /// |self|.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        Self(self.0, self.0.abs_f32s(self.1))
    }

    /// The larger; of a NaN either.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(self.0, self.0.max_f32s(self.1, other.1))
    }

    /// The smaller; of a NaN either.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self(self.0, self.0.min_f32s(self.1, other.1))
    }

    /// self ≤ other.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Mask32<S> {
        Mask32(self.0, self.0.less_than_or_equal_f32s(self.1, other.1))
    }
}

impl<S: Simd> Mask32<S> {
    /// Both.
    #[inline(always)]
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0, self.0.and_m32s(self.1, other.1))
    }

    /// `value` where true, 0 elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn of(self, value: F32s<S>) -> F32s<S> {
        F32s(self.0, self.0.select_f32s(self.1, value.1, self.0.splat_f32s(0.0)))
    }
}

operators!(F32s f32 splat_f32s neg_f32s:
    Add add add_f32s, Sub sub sub_f32s, Mul mul mul_f32s, Div div div_f32s);
