//! The 3D kernel: a sphere of radius R swept along the beam.
//!
//! Every point of the ray sees every point of the beam closer than R, with the density 3/(4πR³):
//!
//! ```text
//! C · 3/(4πR³) ∫∫ exp(−sigma_t (s_b + s_r)) ds_b ds_r,   |x_r(s_r) − x_b(s_b)| < R,
//! ```
//!
//! at OPL τ_b + τ_r + η (s_b + s_r). At one T = s_b + s_r the region ([`crate::sweep`]) has a width
//! in s_r, and the pair arrives as width times exp(−sigma_t T): half an ellipse where neither segment
//! ends in the region, pieces of it otherwise. For a whole ellipse of half length A in T and area
//! π g/sinψ, g = R² − distance²,
//!
//! ```text
//! ∫∫ = π g/sinψ · exp(−sigma_t T*) · 2 I₁(a)/a,   a = sigma_t A,
//! ```
//!
//! by the series Σ (a²/4)^k/(k! (k+1)!). A short beam of one channel has exp(−sigma_t s_r) alone: the
//! same with a = sigma_t √g/sinψ. Cut ellipses, deep ones and coloured short beams are integrated
//! by the film's quadrature, whose rule the profile goes through anyway.
//!
//! Unlike the discs, spheres reach beyond the ends of the beam. (Jarosz et al. 2011, "A comprehensive
//! theory of volumetric radiance estimation using photon points and beams", section 5; the time
//! profile is our derivation.)

use std::f64::consts::PI;

use glam::DVec3;
use tpb_film::integrate;
use tpb_optics::Spectrum;

use crate::beam::{Attenuation, Beam, CameraRay};
use crate::contribution::{Contribution, Spread};
use crate::kernel::RayBeamKernel;
use crate::kernel2d::RULE;
use crate::sweep::{Side, Sweep};

/// The kernel with its radius.
#[derive(Clone, Copy, Debug)]
pub struct Kernel3d {
    /// Radius of the sphere \[m\].
    pub radius: f64,
}

/// The closest points of a beam and a ray.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Distance along the beam \[m\].
    pub along_beam: f64,
    /// Distance along the ray \[m\].
    pub along_ray: f64,
    /// From the beam's point to the ray's.
    pub offset: DVec3,
}

/// How a pair's light is spread over the times at which it arrives.
#[derive(Clone, Copy, Debug)]
pub struct Swept<const C: usize> {
    sweep: Sweep,
    attenuation: Attenuation<C>,
    sigma_t: Spectrum<C>,
    along_beam: f64,
    along_ray: f64,
}

/// Optical half lengths up to which the series is used.
const LARGEST_SERIES: f64 = 4.0;

impl RayBeamKernel for Kernel3d {
    type Meeting = Closest;

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
    ) -> Option<Closest> {
        let n = direction.cross(ray_direction);
        let w = ray_origin - origin;
        let squared = n.length_squared();
        let across = w.dot(n);
        if squared > 0.0 && across * across >= self.radius * self.radius * squared {
            return None;
        }
        // The closest points of the lines; of parallel ones any, and then of the segments.
        let on_line = if squared > 0.0 { w.cross(direction).dot(n) / squared } else { 0.0 };
        let mut along_ray = on_line.clamp(0.0, ray_length);
        let foot = (w + along_ray * ray_direction).dot(direction);
        let along_beam = foot.clamp(0.0, length);
        if along_beam != foot {
            let back = (along_beam * direction - w).dot(ray_direction);
            along_ray = back.clamp(0.0, ray_length);
        }
        let offset = w + along_ray * ray_direction - along_beam * direction;
        let near = offset.length_squared() < self.radius * self.radius;
        near.then_some(Closest { along_beam, along_ray, offset })
    }

    #[inline]
    fn contribution<const C: usize>(
        self,
        closest: &Closest,
        beam: &Beam<C>,
        ray: &CameraRay<C>,
    ) -> Contribution<C> {
        let &Closest { along_beam, along_ray, offset } = closest;
        let middle = beam.opl + ray.opl + ray.eta * (along_beam + along_ray);
        let of_beam =
            Side { direction: beam.direction, first: -along_beam, last: beam.length - along_beam };
        let of_ray =
            Side { direction: ray.direction, first: -along_ray, last: ray.length - along_ray };
        let Some(sweep) = Sweep::new(offset, self.radius, of_beam, of_ray) else {
            // Touched to rounding.
            let spread = Spread::Exponential { depth: Spectrum::ZERO };
            return Contribution { start: middle, end: middle, energy: Spectrum::ZERO, spread };
        };
        let swept = Swept {
            sweep,
            attenuation: beam.attenuation,
            sigma_t: ray.coefficients.sigma_t,
            along_beam,
            along_ray,
        };
        let phase = ray.phase.value(-ray.direction.dot(beam.direction));
        let scattered = ray.throughput * beam.power * ray.coefficients.sigma_s;
        let density = 0.75 / PI / (self.radius * self.radius * self.radius);
        let [first, last] = sweep.span();
        Contribution {
            start: middle + ray.eta * first,
            end: middle + ray.eta * last,
            energy: scattered * swept.integral() * (phase * density),
            spread: Spread::Swept(swept),
        }
    }
}

impl<const C: usize> Swept<C> {
    /// ∫∫ of the attenuation over the region.
    fn integral(&self) -> Spectrum<C> {
        if self.sweep.is_whole()
            && let Some(integral) = self.whole()
        {
            return integral;
        }
        let [first, last] = self.sweep.span();
        self.scale() * integrate(first, last, self.sweep.breaks(), &|tau| self.at(tau))
    }

    /// The integral over a whole ellipse, if it has a short series.
    fn whole(&self) -> Option<Spectrum<C>> {
        let [first, last] = self.sweep.span();
        let (gap, sine) = self.sweep.gap_and_sine();
        let half_length = match self.attenuation {
            Attenuation::Explicit => 0.5 * (last - first),
            Attenuation::Sampled { .. } if C == 1 => gap.sqrt() / sine,
            Attenuation::Sampled { .. } => return None,
        };
        let depth = self.sigma_t * half_length;
        if depth.max_channel() > LARGEST_SERIES {
            return None;
        }
        let middle = self.attenuation.at(self.sigma_t, self.along_beam, self.along_ray);
        Some(middle * depth.map(bessel_series) * (PI * gap / sine))
    }

    /// First and last τ, and the τ where the profile is not smooth.
    pub(crate) fn span_and_breaks(&self) -> ([f64; 2], &[f64]) {
        (self.sweep.span(), self.sweep.breaks())
    }

    /// The attenuation, integrated over the ray's points at one τ, over [`Self::scale`].
    pub(crate) fn at(&self, tau: f64) -> Spectrum<C> {
        let Some([first, last]) = self.sweep.on_ray(tau) else { return Spectrum::ZERO };
        let width = last - first;
        match self.attenuation {
            Attenuation::Explicit => {
                let passed = tau - self.sweep.span()[0];
                self.sigma_t.map(|sigma| (-sigma * passed).exp() * width)
            }
            Attenuation::Sampled { .. } if C == 1 => {
                let passed = first - self.sweep.least_on_ray();
                self.sigma_t.map(|sigma| (-sigma * passed).exp() * width * decay(sigma * width))
            }
            Attenuation::Sampled { .. } => self.coloured(tau, first, width),
        }
    }

    /// What [`Self::at`] is relative to, so that it does not overflow and rarely underflows.
    fn scale(&self) -> Spectrum<C> {
        let Self { along_beam, along_ray, .. } = *self;
        match self.attenuation {
            Attenuation::Explicit => {
                let path = along_beam + along_ray + self.sweep.span()[0];
                self.sigma_t.map(|sigma| (-sigma * path).exp())
            }
            Attenuation::Sampled { .. } if C == 1 => {
                let path = (along_ray + self.sweep.least_on_ray()).max(0.0);
                self.sigma_t.map(|sigma| (-sigma * path).exp())
            }
            Attenuation::Sampled { .. } => Spectrum::ONE,
        }
    }

    /// A coloured short beam has no closed form: Gauss-Legendre panels of one optical depth.
    fn coloured(&self, tau: f64, first: f64, width: f64) -> Spectrum<C> {
        let panels = (self.sigma_t.max_channel() * width).ceil().max(1.0);
        let half = 0.5 * width / panels;
        let mut sum = Spectrum::ZERO;
        for panel in 0..panels as usize {
            let middle = first + (2 * panel + 1) as f64 * half;
            for (node, weight) in RULE.as_node_weight_pairs() {
                let sigma = middle + half * node;
                let (on_beam, on_ray) = (self.along_beam + tau - sigma, self.along_ray + sigma);
                sum +=
                    self.attenuation.at(self.sigma_t, on_beam.max(0.0), on_ray) * (half * weight);
            }
        }
        sum
    }
}

/// 2 I₁(a)/a.
fn bessel_series(a: f64) -> f64 {
    let quarter = 0.25 * a * a;
    let (mut term, mut sum, mut k) = (1.0, 1.0, 0.0);
    while term > f64::EPSILON * sum {
        k += 1.0;
        term *= quarter / (k * (k + 1.0));
        sum += term;
    }
    sum
}

/// The mean of e^(−u) over 0 < u < x.
fn decay(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x }
}
