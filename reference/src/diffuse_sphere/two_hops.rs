//! Light that crosses a diffuse sphere twice between two given points of the wall.
//!
//! Light leaves a wall point (Lambertian, flux Φ), is reflected once anywhere, and meets a second
//! wall point at the angle γ from the first, seen from the centre. The point of reflection is
//! uniform on the sphere; the sum x of the two chords, in diameters, has a density h(x; γ) that
//! is *not* the two-fold convolution of [`sphere_chords_pdf`](super::sphere_chords_pdf), because
//! the last chord must end where it must. Only its mean over the sphere of end points is. The irradiance is
//!
//! > E(t) = ρ Φ/(4πR²) · h(x; γ) · v/(2R),   x = v t/(2R).
//!
//! # Closed form
//!
//! Let X = x², C = sin²(γ/2), c = cos(γ/2), and w the difference of the two chords. Written in x and w,
//! the condition that three points on a sphere have the given distances turns the density into a
//! complete elliptic integral (derived here; checked against the definition in the tests):
//!
//! > h = 1/(π√C) ∫ (X − w²) / √((ω₊ − w²)(w² − ω₋)) dw
//!
//! over where the root is real, with ω± = X − 2(X − C)/(1 ± c). By the arithmetic-geometric mean
//! (Gauss 1818) M of a₀, b₀, with e₀ = c₀²/C, a₀² − b₀² = c₀², e_{n+1} = e_n² C/(4 a_{n+1})²,
//!
//! > h = (1/M) [2(X − C)/(1 + c) + Σ_n 2^(n−1) e_n],
//! > p = (1 − c)² (2(1 + c) − X),   q = (1 + c)² (X − 2(1 − c)),   p + q = 4c (X − C),
//!
//! where (a₀², b₀², c₀²) is (p, −q, p + q) for q < 0 and (p + q, q, p) otherwise. Nothing cancels, also
//! as γ → 0, where h = x/2. The support is sin(γ/2) ≤ x ≤ 2 cos(γ/4); h has a logarithmic pole
//! at x = 2 sin(γ/4), the saddle of the chords' sum, and ends with a step.
//!
//! # Before the first arrival
//!
//! Below the support no light arrives, and [`sphere_two_hop_density`] is 0. The closed form
//! goes on there with the sign turned (it is minus a density of the chords' *difference*), and
//! [`sphere_two_hop_local`] gives that continuation, because its table does. On the support the two
//! are the same. Beyond the upper end both are 0.

use crate::error::{Result, finite_result, require};
use crate::numerics::quadrature::{Node, RELATIVE_TOLERANCE, tanh_sinh};
use serde::Deserialize;

/// Inputs of [`sphere_two_hop_local`] and [`sphere_two_hop_density`].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TwoHops {
    /// Sum of the two chords, in diameters.
    pub x: f64,
    /// Cosine of the angle γ between the two ends, seen from the centre.
    pub cos_gamma: f64,
}

/// The closed form, also below the support (see there).
pub fn sphere_two_hop_local(input: &TwoHops) -> Result<f64> {
    let ends = Ends::new(input.cos_gamma)?;
    require(input.x >= 0.0, "x", input.x, "at least 0")?;
    finite_result("sphere_two_hop_local", ends.closed_form(Place::at(input.x, &ends)))
}

/// The density h of the sum of two chords between given ends; 0 outside its support.
pub fn sphere_two_hop_density(input: &TwoHops) -> Result<f64> {
    let ends = Ends::new(input.cos_gamma)?;
    require(!input.x.is_nan(), "x", input.x, "a number")?;
    if input.x < ends.first() || input.x > ends.last() {
        return Ok(0.0);
    }
    finite_result("sphere_two_hop_density", ends.closed_form(Place::at(input.x, &ends)))
}

/// The probability that the sum of two chords between given ends is within [x0, x1).
pub fn two_hop_probability(cos_gamma: f64, x0: f64, x1: f64) -> Result<f64> {
    let ends = Ends::new(cos_gamma)?;
    require(!x0.is_nan(), "x0", x0, "a number")?;
    require(x1 >= x0, "x1", x1, "not before x0")?;
    let (first, pole, last) = (ends.first(), ends.pole(), ends.last());
    let mut sum = 0.0;
    for (piece_start, piece_end) in [(first, pole), (pole, last)] {
        let (start, end) = (x0.max(piece_start), x1.min(piece_end));
        if end <= start {
            continue;
        }
        let density = |node: Node| ends.closed_form(ends.place(node, start, end));
        sum += tanh_sinh(density, start, end, RELATIVE_TOLERANCE)?.value;
    }
    finite_result("two_hop_probability", sum)
}

/// Where the two ends lie.
#[derive(Debug, Clone, Copy)]
struct Ends {
    /// C = sin²(γ/2).
    sine_squared: f64,
    /// c = cos(γ/2).
    cosine: f64,
}

/// A sum of chords, with its distances from the ends of the support and from the pole.
#[derive(Debug, Clone, Copy)]
struct Place {
    x: f64,
    from_first: f64,
    beyond_pole: f64,
    to_last: f64,
}

impl Place {
    fn at(x: f64, ends: &Ends) -> Self {
        let (from_first, beyond_pole) = (x - ends.first(), x - ends.pole());
        Self { x, from_first, beyond_pole, to_last: ends.last() - x }
    }
}

impl Ends {
    fn new(cos_gamma: f64) -> Result<Self> {
        let allowed = (-1.0..=1.0).contains(&cos_gamma);
        require(allowed, "cos_gamma", cos_gamma, "between -1 and 1")?;
        let sine_squared = 0.5 * (1.0 - cos_gamma);
        Ok(Self { sine_squared, cosine: (0.5 * (1.0 + cos_gamma)).sqrt() })
    }

    /// 1 − c.
    fn versine(&self) -> f64 {
        self.sine_squared / (1.0 + self.cosine)
    }

    /// sin(γ/2).
    fn first(&self) -> f64 {
        self.sine_squared.sqrt()
    }

    /// 2 sin(γ/4).
    fn pole(&self) -> f64 {
        (2.0 * self.versine()).sqrt()
    }

    /// 2 cos(γ/4).
    fn last(&self) -> f64 {
        (2.0 * (1.0 + self.cosine)).sqrt()
    }

    /// The place of a node between `start` and `end`, its distances to full precision where these
    /// are the ends or the pole, because nodes crowd there.
    fn place(&self, node: Node, start: f64, end: f64) -> Place {
        let (first, pole, last) = (self.first(), self.pole(), self.last());
        // The distances of the pole from both ends of the support, without a difference.
        let versine = self.versine();
        let first_to_pole = if versine > 0.0 { versine * versine / (pole + first) } else { 0.0 };
        let pole_to_last = 4.0 * self.cosine / (last + pole);
        let Node { x, from_start, to_end } = node;
        let mut place = Place::at(x, self);
        if start == pole {
            place.from_first = from_start + first_to_pole;
            place.beyond_pole = from_start;
        } else if start == first {
            place.from_first = from_start;
        }
        if end == pole {
            place.beyond_pole = -to_end;
            place.to_last = to_end + pole_to_last;
        } else if end == last {
            place.to_last = to_end;
        }
        place
    }

    fn closed_form(&self, Place { x, from_first, beyond_pole, to_last }: Place) -> f64 {
        let (sine_squared, c, versine) = (self.sine_squared, self.cosine, self.versine());
        let beyond_first = from_first * (x + self.first());
        let before_last = to_last * (self.last() + x);
        if before_last < 0.0 {
            return 0.0;
        }
        let p = versine * versine * before_last;
        let q = (1.0 + c) * (1.0 + c) * beyond_pole * (x + self.pole());
        let sum = 4.0 * c * beyond_first;
        // c₀²/C, written so that C may be 0.
        let (a, b, e) = if beyond_pole < 0.0 {
            (p, -q, 4.0 * c * (beyond_first / sine_squared))
        } else {
            (sum, q, versine / (1.0 + c) * before_last)
        };
        let (mut a, mut b, mut e) = (a.max(0.0).sqrt(), b.sqrt(), e);
        let mut series = 2.0 * beyond_first / (1.0 + c) + 0.5 * e;
        let mut weight = 0.5;
        // Quadratic convergence; from b/a = 1e-300, 15 steps.
        for _ in 0..MAX_STEPS {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
            e *= e * sine_squared / (16.0 * a * a);
            weight *= 2.0;
            series += weight * e;
            if weight * e <= 1e-17 * series.abs() && (a - b).abs() <= 1e-8 * a {
                break;
            }
        }
        // One more step brings a and b together to rounding: it squares their distance.
        let mean = 0.5 * (0.5 * (a + b) + (a * b).sqrt());
        series / mean
    }
}

const MAX_STEPS: u32 = 24;

#[cfg(test)]
#[path = "two_hops_tests.rs"]
mod tests;
