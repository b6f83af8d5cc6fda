//! Arithmetic on several values at once: vectors as wide as the machine has, chosen when the program
//! runs (`pulp`). No fused operations: every machine gives the same bits.
//!
//! Code for vectors is generic over [`Simd`], and all of it must be marked `#[inline(always)]`, down to
//! what [`dispatch`] is given: what is not inlined is compiled for the oldest machine, and slow.
//! Closures are not (they carry no such mark): write functions and loops.

mod decay;
mod f32s;
mod f64s;
mod instructions;

pub use f32s::{F32s, Mask32};
pub use f64s::{F64s, Mask, integers};
pub use instructions::Instructions;
pub use pulp::{Scalar, Simd, WithSimd};

/// Values that are worked on together: as many as the widest vectors hold, or more.
pub const LANES: usize = 8;

/// How many vectors [`LANES`] f64 are.
pub const fn vectors<S: Simd>() -> usize {
    LANES / S::F64_LANES
}

/// Runs `work` with the widest vector instructions that the machine has.
#[inline(always)]
pub fn dispatch<W: WithSimd>(work: W) -> W::Output {
    Instructions::widest().dispatch(work)
}

/// Numbers that can be read as vectors.
pub trait Vectors {
    /// As many of them as a register holds.
    type Vector<S: Simd>;

    /// Vector number `index`.
    ///
    /// # Panics
    /// If there are not so many.
    fn vector<S: Simd>(&self, simd: S, index: usize) -> Self::Vector<S>;
}

/// Operators of a vector with another, or with one number.
macro_rules! operators {
    ($vector:ident $number:ident $splat:ident $neg:ident: $($trait:ident $name:ident $do:ident),*) => {
        $(
            impl<S: Simd> $trait for $vector<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    Self(self.0, self.0.$do(self.1, other.1))
                }
            }

            impl<S: Simd> $trait<$number> for $vector<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: $number) -> Self {
                    Self(self.0, self.0.$do(self.1, self.0.$splat(other)))
                }
            }
        )*

        impl<S: Simd> Neg for $vector<S> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self(self.0, self.0.$neg(self.1))
            }
        }
    };
}
use operators;
