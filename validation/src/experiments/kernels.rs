//! One beam and one camera ray: the programs' kernels against marching, and against the reference.
//!
//! Marching knows nothing of closed forms. It walks along the ray in small steps, asks of each point
//! whether the kernel covers it, finds the ends of the covered parts and the edges of the time bins
//! by bisection, and integrates C·exp(−sigma_t·path)/measure over each part by Gauss-Legendre rules:
//!
//! * 2D: covered = within R of the beam's axis with the foot on the beam; measure πR².
//! * 1D: the kernel is a ribbon of half-width R along d × ω. It is given a thickness ε across
//!   itself; measure 2Rε. The error is O((sigma_t ε)²), below 1e-9 for the ε used.
//! * 3D: points of the ray within R of the beam's *line*; each sees a chord of the beam, cut by the
//!   beam's ends and by the bin. Chords begin as square roots and have kinks: the midpoint rule in
//!   an angle, with many points.
//!
//! Both are also compared with the reference on the same cases and on random pairs.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use tpb_beams::Temporal;
use tpb_beams::beam::{Attenuation, Beam, CameraRay};
use tpb_beams::contribution::Contribution;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_beams::kernel3d::Kernel3d;
use tpb_film::{FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_optics::{Coefficients, Phase, Spectrum, Stream};
use tpb_reference::beams::beam_ray::{BeamRay1d, BeamRay2dBin, beam_ray_1d, beam_ray_2d_bins};
use tpb_reference::beams::beam_ray_sphere::{BeamRay3dBin, beam_ray_3d_bins};
use tpb_scene::MediumId;

use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Kind, Outcome};
use crate::experiments::marching::{bisect, covered_parts, gauss, midpoints};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::statistics::worse;

/// Largest relative error of an energy.
const TOLERANCE: f64 = 1e-9;

/// Of the 3D kernel against marching: chords of long spans have kinks between few midpoints, of
/// which 50 000 leave 2e-8. The reference, which splits there, is met to [`TOLERANCE`].
const SPHERE_MARCHING: f64 = 5e-8;

/// Largest error of a bin relative to the pair's energy: arrays are f32.
const BIN_TOLERANCE: f64 = 2e-7;

/// Bins of the comparison.
const BINS: usize = 12;

/// Which kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KernelPairs {
    /// The 1D kernel.
    OneD,
    /// The 2D kernel.
    TwoD,
    /// The 3D kernel.
    ThreeD,
}

/// Each kernel.
pub fn all() -> Experiments {
    vec![Arc::new(KernelPairs::OneD), Arc::new(KernelPairs::TwoD), Arc::new(KernelPairs::ThreeD)]
}

/// A beam, a ray and a medium.
#[derive(Clone, Debug)]
struct Pair {
    name: String,
    beam: (DVec3, DVec3, f64),
    ray: (DVec3, DVec3, f64),
    radius: f64,
    g: f64,
    short: bool,
    /// Factor on what the kernel gives: 1, but for a twin.
    strength: f64,
}

/// Random pairs that must meet for the comparison to say something.
const FEWEST_MET: usize = 100;

const SIGMA_S: f64 = 0.6;
const SIGMA_T: f64 = 0.9;
/// Power, throughput, OPL of the beam's origin and of the ray's origin, index.
const POWER: f64 = 2.5;
const THROUGHPUT: f64 = 0.7;
const BEAM_OPL: f64 = 0.3;
const RAY_OPL: f64 = 0.2;
const ETA: f64 = 1.25;

impl Pair {
    fn new(name: &str, beam: (DVec3, DVec3, f64), ray: (DVec3, DVec3, f64)) -> Self {
        let unit = |(o, d, l): (DVec3, DVec3, f64)| (o, d.normalize(), l);
        Self {
            name: name.into(),
            beam: unit(beam),
            ray: unit(ray),
            radius: 0.2,
            g: 0.3,
            short: false,
            strength: 1.0,
        }
    }

    fn evaluate(&self, kernel: KernelPairs) -> Option<Contribution<1>> {
        let attenuation = if self.short {
            Attenuation::Sampled { mixture: Spectrum([1.0]) }
        } else {
            Attenuation::Explicit
        };
        let beam = Beam {
            origin: self.beam.0,
            direction: self.beam.1,
            length: self.beam.2,
            opl: BEAM_OPL,
            power: Spectrum([POWER * self.strength]),
            attenuation,
            medium: MediumId(0),
            depth: 2,
        };
        let ray = CameraRay {
            origin: self.ray.0,
            direction: self.ray.1,
            length: self.ray.2,
            opl: RAY_OPL,
            throughput: Spectrum([THROUGHPUT]),
            coefficients: Coefficients {
                sigma_s: Spectrum([SIGMA_S]),
                sigma_t: Spectrum([SIGMA_T]),
            },
            phase: Phase::with_mean_cosine(self.g),
            eta: ETA,
        };
        match kernel {
            KernelPairs::OneD => Kernel1d { radius: self.radius }.evaluate(&beam, &ray),
            KernelPairs::TwoD => Kernel2d { radius: self.radius }.evaluate(&beam, &ray),
            KernelPairs::ThreeD => Kernel3d { radius: self.radius }.evaluate(&beam, &ray),
        }
    }

    /// Foot on the beam, coordinate along d × ω, and the one across both, of a point of the ray.
    fn local(&self, u: f64) -> [f64; 3] {
        let ((o, d, _), (origin, omega, _)) = (self.beam, self.ray);
        let offset = origin + u * omega - o;
        let n = d.cross(omega).normalize_or_zero();
        [offset.dot(d), offset.dot(n), offset.dot(n.cross(d))]
    }

    fn covered(&self, kernel: KernelPairs, thickness: f64, u: f64) -> bool {
        let ((o, d, length), (origin, omega, _)) = (self.beam, self.ray);
        let [foot, along, across] = self.local(u);
        let inside = match kernel {
            KernelPairs::OneD => along.abs() < self.radius && across.abs() < 0.5 * thickness,
            KernelPairs::TwoD | KernelPairs::ThreeD => {
                let offset = origin + u * omega - o;
                (offset - offset.dot(d) * d).length() < self.radius
            }
        };
        // Spheres reach beyond the ends of the beam; what they see of it is another question.
        inside && (kernel == KernelPairs::ThreeD || (0.0..length).contains(&foot))
    }

    /// C of the kernels.
    fn scattered(&self) -> f64 {
        let cosine = -self.ray.1.dot(self.beam.1);
        let g = self.g;
        let phase = (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5));
        POWER * THROUGHPUT * SIGMA_S * phase
    }

    /// Energy per length of ray where it is covered.
    fn density(&self, kernel: KernelPairs, thickness: f64, u: f64) -> f64 {
        let measure = match kernel {
            KernelPairs::OneD => 2.0 * self.radius * thickness,
            KernelPairs::TwoD => PI * self.radius * self.radius,
            KernelPairs::ThreeD => 4.0 / 3.0 * PI * self.radius.powi(3),
        };
        let path = if self.short { u } else { u + self.local(u)[0] };
        self.scattered() / measure * (-SIGMA_T * path).exp()
    }

    /// Energy per length of ray between two arrivals, for the sphere around a point of the ray.
    fn seen_of_beam(&self, u: f64, arrivals: [f64; 2]) -> f64 {
        let ((o, d, length), (origin, omega, _)) = (self.beam, self.ray);
        let offset = origin + u * omega - o;
        let foot = offset.dot(d);
        let distance = (offset - foot * d).length();
        let half = ((self.radius - distance).max(0.0) * (self.radius + distance)).sqrt();
        let [from, to] = arrivals.map(|opl| (opl - BEAM_OPL - RAY_OPL) / ETA - u);
        let (first, last) = ((foot - half).max(0.0).max(from), (foot + half).min(length).min(to));
        if last <= first {
            return 0.0;
        }
        let left = |s_b: f64| (-SIGMA_T * (u + s_b)).exp() / SIGMA_T;
        let along = if self.short {
            (-SIGMA_T * u).exp() * (last - first)
        } else {
            left(first) - left(last)
        };
        0.75 / PI / self.radius.powi(3) * self.scattered() * along
    }

    fn arrival(&self, u: f64) -> f64 {
        BEAM_OPL + RAY_OPL + ETA * (u + self.local(u)[0])
    }

    /// Energy in each interval of `edges`, by marching.
    fn march(&self, kernel: KernelPairs, edges: &[f64]) -> Vec<f64> {
        let thickness = 2e-5;
        let mut bins = vec![0.0; edges.len() - 1];
        let covered = |u: f64| self.covered(kernel, thickness, u);
        for (start, end) in covered_parts(&covered, &self.candidates(kernel, thickness)) {
            for (bin, ends) in bins.iter_mut().zip(edges.windows(2)) {
                if kernel == KernelPairs::ThreeD {
                    *bin += midpoints(|u| self.seen_of_beam(u, [ends[0], ends[1]]), start, end);
                    continue;
                }
                // Arrival never decreases along the ray.
                let at = |edge: f64| bisect(|u| self.arrival(u) >= edge, start, end);
                *bin += gauss(|u| self.density(kernel, thickness, u), at(ends[0]), at(ends[1]));
            }
        }
        bins
    }

    /// Points along the ray to look at, close enough together to miss nothing.
    fn candidates(&self, kernel: KernelPairs, thickness: f64) -> Vec<f64> {
        let length = self.ray.2;
        let mut points: Vec<f64> = (0..=20_000).map(|i| length * f64::from(i) / 20_000.0).collect();
        if kernel == KernelPairs::OneD {
            // The ribbon is thin: look closely where the ray goes through it.
            let (a, b) = (self.local(0.0)[2], self.local(length)[2]);
            let middle = length * a / (a - b);
            if middle.is_finite() {
                let width = 4.0 * length * thickness / (a - b).abs();
                points.extend((0..=400).map(|i| middle + width * (f64::from(i) / 200.0 - 1.0)));
                points.retain(|u| (0.0..=length).contains(u));
                points.sort_by(f64::total_cmp);
            }
        }
        points
    }

    fn reference(&self, kernel: KernelPairs, edges: &[f64]) -> Result<Vec<f64>> {
        let ((o, d, beam_length), (origin, omega, ray_length)) = (self.beam, self.ray);
        let (beam_origin, beam_direction) = (o.to_array(), d.to_array());
        let (ray_origin, ray_direction) = (origin.to_array(), omega.to_array());
        let (sigma_s, sigma_t, g, radius) = (SIGMA_S, SIGMA_T, self.g, self.radius);
        let start = BEAM_OPL + RAY_OPL;
        match kernel {
            KernelPairs::OneD => {
                let weight = beam_ray_1d(&BeamRay1d {
                    sigma_s,
                    sigma_t,
                    g,
                    radius,
                    beam_origin,
                    beam_direction,
                    beam_length,
                    ray_origin,
                    ray_direction,
                    ray_length,
                })?;
                Ok(vec![POWER * THROUGHPUT * weight])
            }
            KernelPairs::ThreeD => edges
                .windows(2)
                .map(|ends| {
                    Ok(beam_ray_3d_bins(&BeamRay3dBin {
                        energy: POWER * THROUGHPUT,
                        sigma_s,
                        sigma_t,
                        g,
                        speed: 1.0 / ETA,
                        radius,
                        beam_origin,
                        beam_direction,
                        beam_length,
                        ray_origin,
                        ray_direction,
                        ray_length,
                        t0: ends[0] - start,
                        t1: ends[1] - start,
                    })?)
                })
                .collect(),
            KernelPairs::TwoD => edges
                .windows(2)
                .map(|ends| {
                    let energy = POWER * THROUGHPUT;
                    let (t0, t1) = (ends[0] - start, ends[1] - start);
                    Ok(beam_ray_2d_bins(&BeamRay2dBin {
                        energy,
                        sigma_s,
                        sigma_t,
                        g,
                        speed: 1.0 / ETA,
                        radius,
                        beam_origin,
                        beam_direction,
                        beam_length,
                        ray_origin,
                        ray_direction,
                        ray_length,
                        t0,
                        t1,
                    })?)
                })
                .collect(),
        }
    }
}

/// The film's bins of a contribution, and its energy in f64.
fn deposited(contribution: &Contribution<1>, axis: TimeAxis) -> Result<(Vec<f64>, f64)> {
    let mut film = TransientFilm::<1>::new(Layout::new(1, 1, Some(axis))?, FilmOptions::default())?;
    film.add_pass(|tile| contribution.deposit(Temporal::Exact, 1.0, (tile, 0, 0.0)));
    let arrays = film.develop();
    Ok((arrays.transient.iter().map(|&v| f64::from(v)).collect(), arrays.steady[0]))
}

/// Errors relative to the pair's energy: of the energy, of the worst bin, and of the reference.
fn errors(pair: &Pair, kernel: KernelPairs) -> Result<[f64; 3]> {
    let axis = TimeAxis { start_opl: 0.0, bin_width_opl: 0.75, bins: BINS };
    let mut edges = axis.edges();
    let marched_bins = pair.march(kernel, &edges);
    edges.push(1e3);
    let marched: f64 = pair.march(kernel, &edges).iter().sum();
    let (bins, energy) = match pair.evaluate(kernel) {
        Some(contribution) => deposited(&contribution, axis)?,
        None => (vec![0.0; BINS], 0.0),
    };
    let relative = |error: f64| if error == 0.0 { 0.0 } else { error.abs() / marched };
    let worst_bin = bins.iter().zip(&marched_bins).map(|(a, b)| relative(a - b)).fold(0.0, worse);
    let of_reference: f64 =
        if pair.short { energy } else { pair.reference(kernel, &edges)?.iter().sum() };
    Ok([relative(energy - marched), worst_bin, relative(energy - of_reference)])
}

fn cases(kernel: KernelPairs) -> Vec<Pair> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let beam = (DVec3::ZERO, z, 3.0);
    let at = DVec3::new;
    let mut pairs = vec![
        Pair::new("perpendicular", beam, (at(-2.0, 0.05, 1.0), x, 5.0)),
        Pair::new("oblique", beam, (at(-1.0, 0.1, 0.5), at(1.0, 0.0, 0.6), 5.0)),
        Pair::new("oblique, against", beam, (at(-1.0, 0.1, 2.5), at(1.0, 0.05, -0.8), 5.0)),
        Pair::new("parallel", beam, (at(0.1, 0.05, -1.0), z, 6.0)),
        Pair::new("antiparallel", beam, (at(0.1, 0.05, 5.0), -z, 9.0)),
        Pair::new("almost antiparallel", beam, (at(0.1, 0.05, 5.0), at(1e-5, 0.0, -1.0), 9.0)),
        Pair::new("almost parallel", beam, (at(0.1, 0.05, -1.0), at(-1e-4, 0.0, 1.0), 6.0)),
        Pair::new("grazing", beam, (at(-2.0, 0.199_9, 1.0), x + 0.3 * z, 5.0)),
        Pair::new("grazing, missed", beam, (at(-2.0, 0.200_1, 1.0), x, 5.0)),
        Pair::new("clipped at the beam's start", beam, (at(-0.5, 0.02, 0.08), x - 0.4 * z, 5.0)),
        Pair::new("clipped at the beam's end", beam, (at(-0.5, 0.02, 2.6), x + 0.9 * z, 5.0)),
        Pair::new("clipped at the ray's end", beam, (at(-2.0, 0.05, 1.0), x, 2.07)),
        Pair::new("beyond the beam's end", beam, (at(-2.0, 0.0, 3.5), x, 5.0)),
        Pair::new("before the ray's start", beam, (at(0.5, 0.0, 1.0), x, 5.0)),
        Pair::new("camera inside", beam, (at(-0.03, 0.05, 1.0), x + 0.2 * y - 0.5 * z, 5.0)),
        Pair::new("camera inside, looking along", beam, (at(-0.03, 0.05, 1.0), z, 5.0)),
        Pair::new("camera inside, looking against", beam, (at(-0.03, 0.05, 1.0), -z, 5.0)),
    ];
    if kernel == KernelPairs::OneD {
        // A ribbon without thickness has no expectation for pairs that lie in it.
        pairs.retain(|pair| pair.beam.1.cross(pair.ray.1).length() > 1e-3);
    } else {
        if kernel == KernelPairs::ThreeD {
            pairs.extend([
                Pair::new("around the beam's start", beam, (at(-1.0, 0.03, -0.1), x, 5.0)),
                Pair::new("around the beam's end", beam, (at(-1.0, 0.03, 3.1), x + 0.02 * z, 5.0)),
                Pair::new("before the beam, along it", beam, (at(0.1, 0.05, -3.0), z, 2.9)),
                Pair::new(
                    "a beam within the sphere",
                    (beam.0, z, 0.1),
                    (at(-1.0, 0.03, 0.0), x, 5.0),
                ),
            ]);
        }
        let short = pairs.clone().into_iter().map(|pair| Pair {
            name: format!("{}, short beam", pair.name),
            short: true,
            ..pair
        });
        pairs.extend(short.collect::<Vec<_>>());
    }
    pairs
}

/// Random pairs, against the reference alone: the largest error.
fn random_pairs(kernel: KernelPairs, seed: u64, count: usize) -> Result<(f64, usize)> {
    let mut rng = Stream::new(seed, 0, 9);
    let mut point =
        |size: f64| size * DVec3::from_array(std::array::from_fn(|_| 2.0 * rng.uniform() - 1.0));
    let (mut worst, mut met) = (0.0_f64, 0);
    for i in 0..count {
        let mut pair =
            Pair::new("random", (point(1.0), point(1.0), 2.0), (point(1.0), point(1.0), 3.0));
        pair.radius = 0.05 + 0.4 * (i % 7) as f64 / 7.0;
        let edges = [0.0, 100.0];
        let expected: f64 = pair.reference(kernel, &edges)?.iter().sum();
        let energy = pair.evaluate(kernel).map_or(0.0, |c| c.energy[0]);
        met += usize::from(expected > 0.0);
        let error = (energy - expected).abs();
        worst = worse(worst, if error == 0.0 { 0.0 } else { error / expected.max(1e-300) });
    }
    Ok((worst, met))
}

impl KernelPairs {
    /// How many random pairs are compared; the 3D kernel's reference is a quadrature.
    fn random_pairs(self, effort: Effort) -> usize {
        if self == Self::ThreeD {
            effort.pick(10_000, 100_000)
        } else {
            effort.pick(20_000, 1_000_000)
        }
    }
}

impl Experiment for KernelPairs {
    fn name(&self) -> String {
        let kernel = match self {
            Self::OneD => "1d",
            Self::TwoD => "2d",
            Self::ThreeD => "3d",
        };
        format!("kernel/{kernel}")
    }

    fn description(&self) -> String {
        "one beam and one ray against brute-force marching and the reference".into()
    }

    fn kind(&self) -> Kind {
        Kind::Exact
    }

    fn twins(&self, _: Effort) -> Vec<Sabotage> {
        vec![Sabotage::KERNEL]
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (mut worst, mut worst_bin, mut notes, mut passed) = (0.0_f64, 0.0_f64, vec![], true);
        let mut cases = cases(*self);
        for pair in &mut cases {
            pair.strength = context.estimate_factor();
            let [energy, bin, reference] = errors(pair, *self)?;
            worst = worse(worse(worst, energy), reference);
            worst_bin = worse(worst_bin, bin);
            // Written so that a NaN fails.
            let marching = if *self == Self::ThreeD { SPHERE_MARCHING } else { TOLERANCE };
            let met = energy <= marching && reference <= TOLERANCE && bin <= BIN_TOLERANCE;
            if !met {
                passed = false;
                notes.push(format!(
                    "{}: energy off by {energy:.1e}, worst bin {bin:.1e}, reference {reference:.1e}",
                    pair.name
                ));
            }
        }
        // Parallel pairs belong to the 1D kernel's definition: they add nothing.
        if *self == Self::OneD {
            let parallel =
                Pair::new("parallel", (DVec3::ZERO, DVec3::Z, 3.0), (DVec3::ZERO, DVec3::Z, 3.0));
            passed &= parallel.evaluate(*self).is_none_or(|c| c.energy.is_zero());
        }
        let (random, met) = random_pairs(*self, context.seed, self.random_pairs(context.effort))?;
        passed &= random <= TOLERANCE && met >= FEWEST_MET;
        worst = worse(worst, random);
        notes.insert(0, format!(
            "{} cases; {met} random pairs that meet, off by {random:.1e}; bins off by {worst_bin:.1e}",
            cases.len()
        ));
        Ok(Outcome::exact(passed, notes).with_interval([-worst, worst]))
    }
}
