//! Adaptive Gauss-Kronrod quadrature of densities over arrival OPL.
//!
//! A density is smooth between its breaks, but often meets them like a square root (the half
//! ellipse of a sphere's blur). Over a part from `a` to `b` the integral is therefore taken in an
//! angle, `t = a + (b − a) sin²(θ/2)`, `dt = (b − a) sin(θ/2) cos(θ/2) dθ`, in which square roots
//! (and inverse square roots) at `a` and `b` are smooth. Pieces are integrated by the 15-point
//! Kronrod rule and bisected until it agrees with the 7-point Gauss rule inside it to 1e-10 of
//! the piece, or of the mean piece where that is more: the Kronrod value itself is far better.
//! Where an interval is so short that the rounding of OPLs in it disturbs more than that, the
//! rounding sets the tolerance.

use tpb_optics::Spectrum;

/// A density of unknown scale.
pub(crate) type Density<'a, const C: usize> = &'a (dyn Fn(f64) -> Spectrum<C> + Sync);

/// Agreement asked of the two rules, relative.
const TOLERANCE: f64 = 1e-10;

/// Bisections per density at most: far more than any piecewise smooth density takes.
const MAX_BISECTIONS: usize = 4000;

/// Kronrod nodes in (0, 1), from the outermost; the odd ones, and the centre, are Gauss nodes.
const NODES: [f64; 7] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_5,
];
const KRONROD: [f64; 7] = [
    0.022_935_322_010_529_22,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_2,
    0.140_653_259_715_525_9,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
];
const KRONROD_CENTRE: f64 = 0.209_482_141_084_727_8;
const GAUSS: [f64; 3] = [0.129_484_966_168_869_7, 0.279_705_391_489_276_7, 0.381_830_050_505_118_9];
const GAUSS_CENTRE: f64 = 0.417_959_183_673_469_4;

/// A part of a density that is smooth inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// First OPL \[m\].
    pub(crate) from: f64,
    /// Last OPL \[m\].
    pub(crate) to: f64,
}

impl Segment {
    /// The angle of an OPL within the segment.
    pub(crate) fn angle(self, opl: f64) -> f64 {
        2.0 * (opl - self.from).max(0.0).sqrt().atan2((self.to - opl).max(0.0).sqrt())
    }

    /// Density per angle; NaN where it is negative.
    fn at<const C: usize>(self, angle: f64, density: Density<'_, C>) -> Spectrum<C> {
        let (sin, cos) = (0.5 * angle).sin_cos();
        let length = self.to - self.from;
        // From the nearer end, so that little is lost there.
        let opl =
            if sin < cos { self.from + length * sin * sin } else { self.to - length * cos * cos };
        let value = density(opl.clamp(self.from, self.to));
        value.map(|v| if v >= 0.0 { v * (length * sin * cos) } else { f64::NAN })
    }
}

/// An interval of angles with its estimate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<const C: usize> {
    segment: Segment,
    from: f64,
    to: f64,
    /// The integral by the Kronrod rule.
    pub(crate) value: Spectrum<C>,
    /// How far the Gauss rule is from it.
    error: Spectrum<C>,
}

impl<const C: usize> Piece<C> {
    /// First estimate over the OPLs from `lower` to `upper`.
    pub(crate) fn new(segment: Segment, lower: f64, upper: f64, density: Density<'_, C>) -> Self {
        Self::estimate(segment, segment.angle(lower), segment.angle(upper), density)
    }

    fn estimate(segment: Segment, from: f64, to: f64, density: Density<'_, C>) -> Self {
        let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
        let middle = segment.at(centre, density);
        let mut kronrod = middle * KRONROD_CENTRE;
        let mut gauss = middle * GAUSS_CENTRE;
        for (i, node) in NODES.iter().enumerate() {
            let pair = segment.at(centre - half * node, density)
                + segment.at(centre + half * node, density);
            kronrod += pair * KRONROD[i];
            if i % 2 == 1 {
                gauss += pair * GAUSS[i / 2];
            }
        }
        let error = (kronrod - gauss) * half;
        Self { segment, from, to, value: kronrod * half, error: error.map(f64::abs) }
    }

    fn exceeds(&self, tolerance: Spectrum<C>) -> bool {
        (0..C).any(|c| self.error[c] > tolerance[c])
    }

    fn halves(&self, density: Density<'_, C>) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        [(self.from, middle), (middle, self.to)]
            .map(|(from, to)| Self::estimate(self.segment, from, to, density))
    }
}

/// ∫ of a density from `start` to `end`, as a profile of these [`breaks`](crate::TemporalProfile)
/// would find it, to 1e-9; NaN where the density is negative or not a number. Ends are finite.
///
/// For integrators whose densities have no closed integral: the film itself needs only the shape.
pub fn integrate<const C: usize>(
    start: f64,
    end: f64,
    breaks: &[f64],
    density: &(dyn Fn(f64) -> Spectrum<C> + Sync),
) -> Spectrum<C> {
    let inside = breaks.iter().copied().filter(|&b| start < b && b < end);
    let mut pieces = Vec::with_capacity(breaks.len() + 1);
    let mut from = start;
    for to in inside.chain([end]) {
        if to > from {
            pieces.push(Piece::new(Segment { from, to }, from, to, density));
            from = to;
        }
    }
    let total = |pieces: &[Piece<C>]| pieces.iter().map(|p| p.value).sum::<Spectrum<C>>();
    let mean = total(&pieces) / pieces.len().max(1) as f64;
    if mean.is_finite() {
        refine(pieces.iter_mut(), mean, density, &mut Vec::new());
    }
    total(&pieces)
}

/// Improves the first estimates of all pieces of one density; `stack` is a buffer.
pub(crate) fn refine<'p, const C: usize>(
    pieces: impl ExactSizeIterator<Item = &'p mut Piece<C>>,
    mean: Spectrum<C>,
    density: Density<'_, C>,
    stack: &mut Vec<Piece<C>>,
) {
    let mut bisections = 0;
    for piece in pieces {
        let Segment { from, to } = piece.segment;
        let rounding = 8.0 * f64::EPSILON * from.abs().max(to.abs()) / (to - from);
        let relative = TOLERANCE.max(rounding);
        let tolerance = Spectrum(std::array::from_fn(|c| relative * piece.value[c].max(mean[c])));
        if !piece.exceeds(tolerance) {
            continue;
        }
        let mut value = Spectrum::ZERO;
        stack.clear();
        stack.push(*piece);
        while let Some(top) = stack.pop() {
            if top.exceeds(tolerance) && bisections < MAX_BISECTIONS {
                bisections += 1;
                stack.extend(top.halves(density));
            } else {
                value += top.value;
            }
        }
        piece.value = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_root_ends_and_kinks_are_integrated_and_nonsense_is_nan() {
        let half_ellipse = |t: f64| Spectrum([(t * (2.0 - t)).max(0.0).sqrt(), 1.0]);
        let found = integrate(0.0, 2.0, &[], &half_ellipse);
        assert!((found[0] / (0.5 * std::f64::consts::PI) - 1.0).abs() < 1e-12);
        assert!((found[1] - 2.0).abs() < 1e-14);
        let roof = |t: f64| Spectrum([1.0 - (t - 0.3_f64).abs()]);
        let found = integrate(0.0, 1.0, &[0.3, 5.0], &roof)[0];
        assert!((found - 0.71).abs() < 1e-14, "{found}");
        assert!(integrate(0.0, 1.0, &[], &|t: f64| Spectrum([t - 0.5]))[0].is_nan());
        assert_eq!(integrate(1.0, 1.0, &[], &roof)[0], 0.0);
    }
}
