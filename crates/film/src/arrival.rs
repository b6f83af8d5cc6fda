//! When energy arrives: the one form in which integrators tell the film about time.
//!
//! All times are OPL in metres, from the emitter's surface to the eye. A profile has unit area per
//! channel; the deposit's energy multiplies it. Integrators never see bins or windows.

use std::fmt;

use tpb_optics::Spectrum;

/// Arrival of one contribution.
#[derive(Clone, Copy, Debug)]
pub enum Arrival<'a, const C: usize> {
    /// All of it at one OPL \[m\].
    Instant(f64),
    /// Spread over an interval.
    Profile(TemporalProfile<'a, C>),
}

/// A density over arrival OPL, normalised by the film.
///
/// An interval with `start == end` is an instant. A start after the end, a NaN, or a density that
/// cannot be normalised makes the contribution count as non-finite, and it is kept out.
#[derive(Clone, Copy)]
pub enum TemporalProfile<'a, const C: usize> {
    /// Constant density from `start` to `end`.
    Uniform {
        /// First arrival \[m\].
        start: f64,
        /// Last arrival \[m\].
        end: f64,
    },
    /// Density ∝ exp(−depth·(opl − start)/(end − start)) per channel. The depth has any sign; 0 is
    /// uniform, ±∞ puts everything at the start or at the end.
    Exponential {
        /// First arrival \[m\].
        start: f64,
        /// Last arrival \[m\], finite.
        end: f64,
        /// Optical depth between them, per channel.
        depth: Spectrum<C>,
    },
    /// Density rate·exp(−rate·(opl − start)) from `start` to infinity. Channels without energy may
    /// have any rate; the others need a positive one (∞ is an instant).
    ExponentialTail {
        /// First arrival \[m\].
        start: f64,
        /// Decay per metre of OPL, per channel \[1/m\].
        rate: Spectrum<C>,
    },
    /// Any other non-negative density over `[start, end]`, known up to a factor per channel;
    /// integrated and normalised by the film to 1e-9. It is asked for OPLs within `[start, end]`.
    General {
        /// First arrival \[m\].
        start: f64,
        /// Last arrival \[m\], finite.
        end: f64,
        /// Points within where the density is not smooth, ascending: kinks, jumps and square-root
        /// ends of parts. `start` and `end` are such points without being listed.
        breaks: &'a [f64],
        /// The density.
        density: &'a (dyn Fn(f64) -> Spectrum<C> + Sync),
    },
}

impl<const C: usize> fmt::Debug for TemporalProfile<'_, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uniform { start, end } => write!(f, "Uniform [{start}, {end}]"),
            Self::Exponential { start, end, depth } => {
                write!(f, "Exponential [{start}, {end}] of depth {:?}", depth.0)
            }
            Self::ExponentialTail { start, rate } => {
                write!(f, "ExponentialTail from {start} at rate {:?}", rate.0)
            }
            Self::General { start, end, breaks, .. } => {
                write!(f, "General [{start}, {end}] with breaks {breaks:?}")
            }
        }
    }
}
