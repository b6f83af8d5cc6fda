//! The pairs of points of a beam and a ray that are closer than R: an ellipse, cut by their ends.
//!
//! Points are counted from the closest pair, at s_b⁰ and s_r⁰, with p = x_r − x_b there. In
//! τ = (s_b + s_r) − (s_b⁰ + s_r⁰) and σ = s_r − s_r⁰, with d the beam's direction, ω the ray's,
//! m = d + ω and κ = |m|²/2, points are at p − τ d + σ m from each other. At one τ, σ runs between
//! the roots of
//!
//! ```text
//! 2κ σ² + 2 (p·m − κτ) σ + (τ² − 2τ p·d − g) = 0,   g = R² − |p|²,
//! discriminant/4 = 2κg + (p·m)² − 2κτ p·(ω − d) − κ (2 − κ) τ²,   2 − κ = |d − ω|²/2,
//! ```
//!
//! taken in the form that does not cancel as κ → 0 (the ray looks into the light; for κ = 0 all σ or
//! none), and between the four ends: of the ray, −s_r⁰ and l_r − s_r⁰; of the beam, τ + s_b⁰ − l_b
//! and τ + s_b⁰. The region is convex, so that τ runs through one interval: it ends where the
//! ellipse does or where it meets an end, and the width in σ is smooth between such meetings. For
//! parallel pairs (κ = 2) the ellipse has no ends of its own.

use glam::DVec3;

/// The region of one pair.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    kappa: f64,
    /// 2 − κ.
    complement: f64,
    /// g.
    gap: f64,
    /// p·d, p·m and p·(ω − d).
    along: f64,
    bisecting: f64,
    skew: f64,
    /// First and last σ on the ray.
    on_ray: [f64; 2],
    /// First and last τ − σ on the beam.
    on_beam: [f64; 2],
    /// First and last τ.
    span: [f64; 2],
    /// τ between which the width is smooth: the first `kinks` of these, ascending.
    breaks: [f64; MOST_BREAKS],
    kinks: usize,
}

/// Each of four ends meets the ellipse twice.
pub(crate) const MOST_BREAKS: usize = 8;

/// A segment seen from the closest pair: the point there, its direction, first and last place.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub(crate) direction: DVec3,
    pub(crate) first: f64,
    pub(crate) last: f64,
}

impl Sweep {
    /// `offset` is p, shorter than the radius; places count from the closest pair. `None` where
    /// rounding leaves no interval of τ.
    pub(crate) fn new(offset: DVec3, radius: f64, beam: Side, ray: Side) -> Option<Self> {
        let (d, omega) = (beam.direction, ray.direction);
        let distance = offset.length();
        let mut sweep = Self {
            kappa: 0.5 * (d + omega).length_squared(),
            complement: 0.5 * (d - omega).length_squared(),
            gap: (radius - distance) * (radius + distance),
            along: offset.dot(d),
            bisecting: offset.dot(d + omega),
            skew: offset.dot(omega - d),
            on_ray: [ray.first, ray.last],
            on_beam: [beam.first, beam.last],
            span: [f64::INFINITY, f64::NEG_INFINITY],
            breaks: [0.0; MOST_BREAKS],
            kinks: 0,
        };
        sweep.own_ends();
        if !sweep.is_whole() {
            sweep.cut(offset, radius, beam, ray);
        }
        (sweep.span[0] < sweep.span[1]).then_some(sweep)
    }

    /// Whether the whole ellipse lies within both segments.
    pub(crate) fn is_whole(&self) -> bool {
        let reach = self.reach();
        let inside = |[first, last]: [f64; 2]| first < -reach && reach < last;
        // Closest pairs at an end are not perpendicular to the segment.
        inside(self.on_ray) && inside(self.on_beam)
    }

    /// How far the ellipse extends along beam and ray; infinite for parallel pairs.
    fn reach(&self) -> f64 {
        (self.gap / (self.kappa * self.complement)).sqrt()
    }

    /// First and last τ.
    pub(crate) fn span(&self) -> [f64; 2] {
        self.span
    }

    /// τ between which widths are smooth, ascending.
    pub(crate) fn breaks(&self) -> &[f64] {
        &self.breaks[..self.kinks]
    }

    /// Area of the ellipse as (g, sinψ): π g/sinψ.
    pub(crate) fn gap_and_sine(&self) -> (f64, f64) {
        (self.gap, (self.kappa * self.complement).sqrt())
    }

    /// No point of the region has a smaller σ.
    pub(crate) fn least_on_ray(&self) -> f64 {
        if self.is_whole() { -self.reach() } else { self.on_ray[0] }
    }

    /// First and last σ at `tau`.
    pub(crate) fn on_ray(&self, tau: f64) -> Option<[f64; 2]> {
        let [first, last] = self.within(tau)?;
        let ([ray_first, ray_last], [beam_first, beam_last]) = (self.on_ray, self.on_beam);
        let first = first.max(ray_first).max(tau - beam_last);
        let last = last.min(ray_last).min(tau - beam_first);
        (first < last).then_some([first, last])
    }

    /// The roots of the module's equation.
    fn within(&self, tau: f64) -> Option<[f64; 2]> {
        let Self { kappa, complement, gap, along, bisecting, skew, .. } = *self;
        let constant = tau * (tau - 2.0 * along) - gap;
        if kappa == 0.0 {
            return (constant < 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let discriminant =
            kappa * (2.0 * (gap - tau * skew) - complement * tau * tau) + bisecting * bisecting;
        if discriminant <= 0.0 {
            return None;
        }
        let half = bisecting - kappa * tau;
        let q = -(half + discriminant.sqrt().copysign(half));
        let (a, b) = (q / (2.0 * kappa), constant / q);
        Some([a.min(b), a.max(b)])
    }

    /// The ends of the ellipse, where they lie on both segments.
    fn own_ends(&mut self) {
        let Self { kappa, complement, gap, along, bisecting, skew, .. } = *self;
        let [first, last] = if kappa == 0.0 {
            roots(1.0, -along, -gap)
        } else {
            roots(0.5 * complement, 0.5 * skew, -(gap + bisecting * bisecting / (2.0 * kappa)))
        };
        for tau in [first, last] {
            if !tau.is_finite() {
                continue;
            }
            let ([ray_first, ray_last], [beam_first, beam_last]) = (self.on_ray, self.on_beam);
            let (lower, upper) = (ray_first.max(tau - beam_last), ray_last.min(tau - beam_first));
            let sigma = 0.5 * tau - bisecting / (2.0 * kappa);
            let on_both =
                if kappa == 0.0 { lower < upper } else { (lower..=upper).contains(&sigma) };
            if on_both {
                self.extend(tau);
            }
        }
    }

    /// Where the region meets the ends of both segments.
    fn cut(&mut self, offset: DVec3, radius: f64, beam: Side, ray: Side) {
        let mut add = |[first, last]: [f64; 2]| {
            if first < last {
                for tau in [first, last] {
                    self.extend(tau);
                    self.breaks[self.kinks] = tau;
                    self.kinks += 1;
                }
            }
        };
        let between = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.max(c), b.min(d)];
        for sigma in [ray.first, ray.last] {
            if let Some(near) = chord(offset + sigma * ray.direction, -beam.direction, radius) {
                add(between(near, [beam.first, beam.last]).map(|on_beam| on_beam + sigma));
            }
        }
        for on_beam in [beam.first, beam.last] {
            if let Some(near) = chord(offset - on_beam * beam.direction, ray.direction, radius) {
                add(between(near, [ray.first, ray.last]).map(|sigma| on_beam + sigma));
            }
        }
        let [first, last] = self.span;
        let mut kept = 0;
        for index in 0..self.kinks {
            let tau = self.breaks[index];
            if first < tau && tau < last {
                self.breaks[kept] = tau;
                kept += 1;
            }
        }
        self.kinks = kept;
        self.breaks[..kept].sort_unstable_by(f64::total_cmp);
    }

    fn extend(&mut self, tau: f64) {
        self.span = [self.span[0].min(tau), self.span[1].max(tau)];
    }
}

/// Roots of a x² + 2 b x + c with a ≥ 0 > c, ascending; infinite where a = 0.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let q = -(b + (b * b - a * c).sqrt().copysign(b));
    let (x, y) = (q / a, c / q);
    [x.min(y), x.max(y)]
}

/// Where `from + s * direction` is closer than `radius` to 0; `None` too for infinite `from`.
fn chord(from: DVec3, direction: DVec3, radius: f64) -> Option<[f64; 2]> {
    let middle = -from.dot(direction);
    let distance = from.cross(direction).length();
    let half2 = (radius - distance) * (radius + distance);
    (half2 > 0.0).then(|| [middle - half2.sqrt(), middle + half2.sqrt()])
}
