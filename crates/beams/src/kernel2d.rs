//! The 2D kernel: a disc across the beam, swept along it to a cylinder of radius R.
//!
//! The point at distance u along the ray has its foot on the beam at s_b(u) = w·d + u cosψ
//! (symbols as in [`crate::kernel1d`]). The blur region is the interval [u₁, u₂] of the ray inside
//! the cylinder, with u in [0, l_r] and the foot in [0, l_b]. Over it the path length
//! T = s_b + u grows by κ u, κ = |d + ω|²/2 = 1 − cosθ, and the energy is
//!
//! ```text
//! C/(πR²) ∫ exp(−sigma_t T(u)) du = C/(πR²) exp(−sigma_t T(u₁)) Δu f(sigma_t κ Δu),
//! f(x) = −expm1(−x)/x, f(0) = 1:
//! ```
//!
//! for κ → 0, the camera looking straight into the light, it arrives at one instant and nothing
//! divides by κ. Arrival is exponential over [η T(u₁), η T(u₂)] with depth sigma_t κ Δu. A short
//! beam of one channel has 1 in place of exp(−sigma_t s_b): depth sigma_t Δu. Short beams in
//! coloured media have no closed form: Gauss-Legendre panels of at most two optical depths, exact
//! to rounding.
//!
//! The cylinder: a u² + 2 b u + c < 0 with a = |n|², b = (w × d)·(ω × d),
//! c = (|w × d| − R)(|w × d| + R), and b² − a c = (R|n| − w·n)(R|n| + w·n), where nothing cancels;
//! the roots are q/a and c/q, q = −(b ± √(b² − a c)) with the sign of b, so that the near root is
//! right however parallel the pair. Exactly parallel pairs are inside for all u, or for none.
//! (Jarosz et al. 2008, "The beam radiance estimate"; Marco et al. 2017, figure 1.)

use std::f64::consts::PI;
use std::sync::LazyLock;

use gauss_quad::GaussLegendre;
use glam::DVec3;
use tpb_film::Tile;
use tpb_lanes::Simd;
use tpb_optics::Spectrum;

use crate::beam::{Attenuation, Beam, CameraRay};
use crate::contribution::{Contribution, Spread};
use crate::kernel::RayBeamKernel;
use crate::scan::Knot;
use crate::shade::{Shade2d, shade};
use crate::splat::{Drawn, TileRays};

/// The kernel with its radius.
#[derive(Clone, Copy, Debug)]
pub struct Kernel2d {
    /// Radius of the disc \[m\].
    pub radius: f64,
}

/// The part of a ray inside a beam's cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Inside {
    /// Distance along the ray where it begins \[m\].
    pub first: f64,
    /// Its length \[m\].
    pub length: f64,
    /// Foot of the ray's origin on the beam \[m\].
    pub foot_of_origin: f64,
    /// cosψ = d·ω.
    pub cosine: f64,
    /// κ = 1 + cosψ.
    pub kappa: f64,
}

/// For what has no closed form.
pub(crate) static RULE: LazyLock<GaussLegendre> =
    LazyLock::new(|| GaussLegendre::new(16.try_into().expect("16 is not 0")));

impl RayBeamKernel for Kernel2d {
    type Meeting = Inside;

    fn radius(self) -> f64 {
        self.radius
    }

    #[inline]
    fn meet(
        self,
        origin: DVec3,
        direction: DVec3,
        length: f64,
        ray_origin: DVec3,
        ray_direction: DVec3,
        ray_length: f64,
    ) -> Option<Inside> {
        let w = ray_origin - origin;
        let (mut first, mut last) = self.cylinder(w, direction, ray_direction)?;
        (first, last) = (first.max(0.0), last.min(ray_length));
        let foot_of_origin = w.dot(direction);
        let cosine = direction.dot(ray_direction);
        if cosine == 0.0 {
            if !(0.0..length).contains(&foot_of_origin) {
                return None;
            }
        } else {
            let at_start = -foot_of_origin / cosine;
            let at_end = (length - foot_of_origin) / cosine;
            first = first.max(at_start.min(at_end));
            last = last.min(at_start.max(at_end));
        }
        let kappa = 0.5 * (direction + ray_direction).length_squared();
        let inside = Inside { first, length: last - first, foot_of_origin, cosine, kappa };
        (last > first).then_some(inside)
    }

    #[inline]
    fn contribution<const C: usize>(
        self,
        inside: &Inside,
        beam: &Beam<C>,
        ray: &CameraRay<C>,
    ) -> Contribution<C> {
        let &Inside { first, length, kappa, .. } = inside;
        let sigma_t = ray.coefficients.sigma_t;
        let path_length = inside.foot_of_origin + kappa * first;
        let start = beam.opl + ray.opl + ray.eta * path_length;
        let (integral, spread) = match beam.attenuation {
            Attenuation::Explicit => {
                exponential(sigma_t.map(|s| (-s * path_length).exp()), sigma_t * kappa, length)
            }
            Attenuation::Sampled { .. } if C == 1 => {
                exponential(beam.attenuation.at(sigma_t, 0.0, first), sigma_t, length)
            }
            attenuation @ Attenuation::Sampled { .. } => mixture(attenuation, sigma_t, inside),
        };
        let phase = ray.phase.value(-inside.cosine);
        let scattered = ray.throughput * beam.power * ray.coefficients.sigma_s;
        Contribution {
            start,
            end: start + ray.eta * kappa * length,
            energy: scattered * integral * (phase / (PI * self.radius * self.radius)),
            spread,
        }
    }

    #[inline(always)]
    fn draw<S: Simd, const C: usize>(
        self,
        simd: S,
        drawn: &Drawn<'_, C>,
        rays: &TileRays<'_, C>,
        knots: &[Knot],
        tile: &mut Tile<'_, C>,
    ) -> u64 {
        shade(simd, (self, Shade2d { radius: self.radius }), drawn, rays, knots, tile)
    }
}

impl Kernel2d {
    /// The interval of an endless ray inside the endless cylinder.
    #[inline]
    fn cylinder(self, w: DVec3, d: DVec3, omega: DVec3) -> Option<(f64, f64)> {
        let n = omega.cross(d);
        let (a, sine) = (n.length_squared(), n.length());
        let across = w.cross(d);
        let distance = across.length();
        let c = (distance - self.radius) * (distance + self.radius);
        if a == 0.0 {
            return (c < 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let (reach, offset) = (self.radius * sine, w.dot(n));
        let discriminant = (reach - offset) * (reach + offset);
        if discriminant <= 0.0 {
            return None;
        }
        let b = across.dot(n);
        let q = -(b + discriminant.sqrt().copysign(b));
        let (near, far) = (q / a, c / q);
        Some((near.min(far), near.max(far)))
    }
}

impl Inside {
    /// Foot on the beam of the ray's point at distance `u` \[m\].
    #[inline]
    fn foot(&self, u: f64) -> f64 {
        self.foot_of_origin + self.cosine * u
    }
}

/// ∫ of `first`·exp(−rate·u) from 0 to `length`, and its shape.
#[inline]
fn exponential<const C: usize>(
    first: Spectrum<C>,
    rate: Spectrum<C>,
    length: f64,
) -> (Spectrum<C>, Spread<C>) {
    let depth = rate * length;
    let mean = depth.map(|x| if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x });
    (first * mean * length, Spread::Exponential { depth })
}

/// ∫ of a coloured short beam's attenuation over the interval, and its shape.
fn mixture<const C: usize>(
    attenuation: Attenuation<C>,
    sigma_t: Spectrum<C>,
    inside: &Inside,
) -> (Spectrum<C>, Spread<C>) {
    let &Inside { first, length, .. } = inside;
    let panels = (sigma_t.max_channel() * length).ceil().max(1.0);
    let width = length / panels;
    let mut integral = Spectrum::ZERO;
    for panel in 0..panels as usize {
        let middle = first + (panel as f64 + 0.5) * width;
        for (node, weight) in RULE.as_node_weight_pairs() {
            let u = middle + 0.5 * width * node;
            integral += attenuation.at(sigma_t, inside.foot(u), u) * (0.5 * width * weight);
        }
    }
    let last = first + length;
    let spread = Spread::Mixture {
        attenuation,
        sigma_t,
        along_beam: [inside.foot(first), inside.foot(last)],
        along_ray: [first, last],
    };
    (integral, spread)
}
