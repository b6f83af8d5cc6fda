//! Which vector instructions there are.
//!
//! A program is compiled for the oldest machine of its kind, and vector code for each set of
//! instructions besides: which one runs is decided when it runs. Every set gives the same bits.

use std::fmt;

use pulp::{Arch, Scalar, Simd, WithSimd};

/// A set of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// One number at a time: what every machine has.
    Scalar,
    /// Four f64: AVX2 with what came with it (x86-64-v3).
    Avx2,
    /// Eight f64: AVX-512 (x86-64-v4).
    Avx512,
    /// Those of a machine that is no x86-64.
    Other,
}

impl Instructions {
    /// The widest that this machine has.
    #[inline]
    pub fn widest() -> Self {
        match Arch::new() {
            Arch::Scalar => Self::Scalar,
            #[cfg(target_arch = "x86_64")]
            Arch::V3(_) => Self::Avx2,
            #[cfg(target_arch = "x86_64")]
            Arch::V4(_) => Self::Avx512,
            #[allow(
                unreachable_patterns,
                reason = "sets of machines that this is not compiled for"
            )]
            _ => Self::Other,
        }
    }

    /// All that this machine has, from the narrowest to the widest.
    pub fn available() -> Vec<Self> {
        let widest = Self::widest();
        let all = match widest {
            Self::Scalar => &[Self::Scalar][..],
            Self::Avx2 => &[Self::Scalar, Self::Avx2],
            Self::Avx512 => &[Self::Scalar, Self::Avx2, Self::Avx512],
            Self::Other => &[Self::Scalar, Self::Other],
        };
        all.to_vec()
    }

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
            Self::Other => std::env::consts::ARCH,
        }
    }

    /// Runs `work` with these; one number at a time on a machine that does not have them, which gives
    /// the same bits.
    #[inline]
    pub fn dispatch<W: WithSimd>(self, work: W) -> W::Output {
        match (self, Arch::new()) {
            (Self::Scalar, _) => Simd::vectorize(Scalar, work),
            #[cfg(target_arch = "x86_64")]
            (Self::Avx2, Arch::V4(_)) => match pulp::x86::V3::try_new() {
                Some(simd) => Simd::vectorize(simd, work),
                None => Simd::vectorize(Scalar, work),
            },
            #[cfg(target_arch = "x86_64")]
            (Self::Avx512, Arch::V3(_)) => Simd::vectorize(Scalar, work),
            (_, arch) => arch.dispatch(work),
        }
    }
}

impl fmt::Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use crate::{F64s, LANES, Vectors, vectors};

    use super::*;

    /// How many f64 a vector holds, and sums and products of eight numbers that round.
    struct Work([f64; LANES]);

    impl WithSimd for Work {
        type Output = (usize, [f64; LANES]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let mut out = [0.0; LANES];
            for index in 0..vectors::<S>() {
                let x = self.0.vector(simd, index);
                let y = (x * 1.1 + 0.3) / (x.sqrt() + 0.7);
                y.min(F64s::splat(simd, 7.0)).exp().store(&mut out, index);
            }
            (S::F64_LANES, out)
        }
    }

    #[test]
    fn every_set_is_the_one_that_was_asked_for_and_gives_the_same_bits() {
        let available = Instructions::available();
        assert_eq!(available.last(), Some(&Instructions::widest()));
        let numbers = std::array::from_fn(|lane| 0.37 * (lane * lane) as f64 + 0.1);
        let expected = Instructions::Scalar.dispatch(Work(numbers));
        assert_eq!(expected.0, 1);
        for instructions in available {
            let (wide, found) = instructions.dispatch(Work(numbers));
            let lanes = match instructions {
                Instructions::Scalar => 1,
                Instructions::Avx2 => 4,
                Instructions::Avx512 => 8,
                Instructions::Other => wide,
            };
            assert_eq!(wide, lanes, "{instructions}");
            assert_eq!(found.map(f64::to_bits), expected.1.map(f64::to_bits), "{instructions}");
        }
    }
}
