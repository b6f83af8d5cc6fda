//! Statistics over passes, cell by cell.
//!
//! **Means.** A cell keeps the sum `S` of its passes, as f32; its mean is `S/n`. Pass n adds its energy
//! x in f64, and the sum is rounded to one of the two neighbouring f32 at random, with probabilities
//! such that the expectation is the exact sum (stochastic rounding: Forsythe 1950; Croci et al.
//! 2022): small additions to a large sum are not lost, and there is no bias. The first addition is
//! rounded to the nearest. The random numbers come from cell and pass alone, so that results are the
//! same whatever the threads: 29 bits of `key(n) + cell · 2^64/φ`, the key of each pass being random.
//!
//! *Error.* One rounding of a sum `S_i` errs by less than `u S_i`, `u = 2^-23`, with zero mean and a
//! variance of at most `(u S_i)²/4`, independently of the others. Of n alike passes `S_i ≈ S i/n`, so
//! the standard deviation of the sum is at most `S (u/2) √(n/3)`, relatively 3.4e-6 for n = 10^4 and
//! 3.4e-5 for n = 10^6; of any non-negative passes at most `S (u/2) √n`. The Monte Carlo error of
//! a cell whose passes spread by `σ` times their mean is `σ/√n`: rounding stays below a tenth of it
//! while `n < 2.9e6 σ`. (In f64 it would be 2^-53 n, and the film twice as large.)
//!
//! **Variance.** Beside S the sum `Q` of squared deviations from the mean (Welford 1962): with
//! `d = x − S/(n − 1)`, `Q += d² (n − 1)/n`, `S += x`, rounded alike. Passes are independent and alike,
//! so the variance of the mean is `Q/(n (n − 1))`. A pass that adds nothing (x = 0) adds
//! `S²/(n (n − 1)) = S² (1/(n − 1) − 1/n)` to Q, and k to n of them `S² (1/k − 1/n)`: a cell that was
//! last brought up to date after pass k is brought up by one addition, and passes need not visit
//! cells that they do not reach. Differences are taken before squares: the rounding of S enters Q
//! squared, `S² u²/24` after n passes, a standard error of `u/√24` = 2.4e-8 of the mean, less than
//! the mean's own rounding. Q is rounded like a sum.
//!
//! Below 1e-38, the smallest normal f32, sums lose digits, above 3e38 they are infinite; Q at the
//! squares of that.

use tpb_optics::seed_of;

/// Bits of an f64 that an f32 lacks.
const LOST_BITS: u32 = 29;

/// 2^64 over the golden ratio: multiples of it are spread evenly modulo 2^64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// What a pass needs to know to enter the statistics.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pass {
    /// Its number, from 1 on.
    number: u64,
    /// Random, for sums and for squares.
    keys: [u64; 2],
}

impl Pass {
    /// Pass number `number`, from 1 on.
    pub(crate) fn new(number: u64) -> Self {
        Self { number, keys: [seed_of(0, number), seed_of(1, number)] }
    }

    /// Its number.
    pub(crate) fn number(self) -> u64 {
        self.number
    }

    /// Its number, for [`Pass::lag`]: exact below 2^32; beyond, squares are too large by up to 2e-10.
    pub(crate) fn mark(self) -> u32 {
        u32::try_from(self.number).unwrap_or(u32::MAX)
    }

    /// Adds `value` to the sum of a cell; `cell` numbers all cells and channels.
    #[inline(always)]
    pub(crate) fn add(self, sum: &mut f32, value: f64, cell: usize) {
        *sum = rounded(*sum, f64::from(*sum) + value, self.keys[0], cell);
    }

    /// What the squares of cells lack that were brought up to date after pass `since` (0: never).
    pub(crate) fn lag(self, since: u32) -> f64 {
        lag(since, self.number - 1)
    }

    /// Adds `value` to the sum of a cell and to its squares, which are behind by `lag`.
    #[inline(always)]
    pub(crate) fn add_both(
        self,
        (sum, squares): (&mut f32, &mut f32),
        value: f64,
        lag: f64,
        cell: usize,
    ) {
        let (n, old) = (self.number as f64, f64::from(*sum));
        if self.number > 1 {
            let deviation = value - old / (n - 1.0);
            let whole =
                f64::from(*squares) + old * old * lag + deviation * deviation * ((n - 1.0) / n);
            *squares = rounded(*squares, whole, self.keys[1], cell);
        }
        self.add(sum, value, cell);
    }
}

/// What squares of pass `since` (0: none) lack after pass `now`, per sum squared.
pub(crate) fn lag(since: u32, now: u64) -> f64 {
    if since == 0 || u64::from(since) >= now {
        return 0.0;
    }
    1.0 / f64::from(since) - 1.0 / now as f64
}

/// `new` in f32: at random one of its neighbours, the nearest if `old` is 0.
#[inline(always)]
fn rounded(old: f32, new: f64, key: u64, cell: usize) -> f32 {
    let random = key.wrapping_add((cell as u64).wrapping_mul(GOLDEN)) >> (64 - LOST_BITS);
    let added = if old == 0.0 { 1 << (LOST_BITS - 1) } else { random };
    // Adds to the magnitude, then cuts: infinities stay.
    let bits = new.to_bits().wrapping_add(added) & !((1 << LOST_BITS) - 1);
    f64::from_bits(bits) as f32
}

/// Adds pass number `n` (from 1 on) to means and sums of squared deviations in f64 (Welford 1962);
/// `K` channels at a time.
pub(crate) fn add_to_moments<const K: usize>(
    mean: &mut [f64; K],
    squares: &mut [f64; K],
    values: [f64; K],
    n: u64,
) {
    let share = 1.0 / n as f64;
    for channel in 0..K {
        let deviation = values[channel] - mean[channel];
        mean[channel] += deviation * share;
        squares[channel] += deviation * (values[channel] - mean[channel]);
    }
}

/// Sum of squares → variance of the mean of `n` passes; `None` for fewer than two.
pub(crate) fn variance_factor(n: u64) -> Option<f64> {
    (n >= 2).then(|| 1.0 / (n as f64 * (n - 1) as f64))
}

#[cfg(test)]
mod tests;
