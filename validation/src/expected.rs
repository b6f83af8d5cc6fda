//! The exact expectation of single scattering in infinite fog, for any method: the pixels' bins of
//! the light itself, or of the light as a beam kernel blurs it.
//!
//! A point light of unit power stands in infinite fog (refractive index 1); the camera is in it too.
//! A ray that passes the light at the distance b, with the light at z along it, has the bins of
//! `single_scatter_radiance_bins`, `expected_blur_1d_bins`, `expected_blur_2d_bins` (with
//! `expected_blur_2d_hg_bins` where scattering is not isotropic) or `expected_blur_3d_bins`. Long and
//! short beams have the same expectation. The 2D and 3D ones ask for b larger than the radius; a
//! pixel with a ray that comes closer is an error.
//!
//! A pixel is averaged over its area on the film by a Gauss-Legendre product rule; one with a point
//! less tells the error ([`SingleScattering::cube`]). Isotropic bins and 1D, 2D bins of any g cost
//! microseconds to a millisecond; a 3D bin with g ≠ 0 is a triple quadrature, which costs seconds
//! where it holds the wavefront.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use tpb_beams::KernelChoice;
use tpb_reference::ReferenceError;
use tpb_reference::beams::expected_blur::{Blur1dBin, expected_blur_1d_bins};
use tpb_reference::beams::expected_blur_disc::{Blur2dBin, expected_blur_2d_bins};
use tpb_reference::beams::expected_blur_disc_hg::{Blur2dHgBin, expected_blur_2d_hg_bins};
use tpb_reference::beams::expected_blur_sphere::{Blur3dBin, expected_blur_3d_bins};
use tpb_reference::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};
use tpb_scene::{Sensor, TimeSpec};

use crate::cube::Cube;
use crate::error::Result;
use crate::scenes::Fog;

/// A point light of unit power in infinite fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleScattering {
    /// The fog.
    pub fog: Fog,
    /// Where the light is \[m\].
    pub light: DVec3,
    /// The kernel with its radius \[m\] that blurs it; `None` for the light itself.
    pub blur: Option<(KernelChoice, f64)>,
}

impl SingleScattering {
    /// The energy \[W m⁻² sr⁻¹\] between two OPLs \[m\] of the ray from `eye` in a unit direction.
    ///
    /// # Errors
    /// [`ReferenceError`] outside of the reference's domain.
    pub fn bin(
        &self,
        (eye, direction): (DVec3, DVec3),
        [t0, t1]: [f64; 2],
    ) -> std::result::Result<f64, ReferenceError> {
        let (energy, speed) = (1.0, 1.0);
        let (sigma_s, sigma_t, g) = (self.fog.sigma_s, self.fog.sigma_t(), self.fog.g);
        let to_light = self.light - eye;
        let ray_offset = to_light.cross(direction).length();
        let source_z = to_light.dot(direction);
        let Some((kernel, radius)) = self.blur else {
            let source_distance = to_light.length();
            let alpha = ray_offset.atan2(source_z);
            return single_scatter_radiance_bins(&SingleScatterBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                source_distance,
                alpha,
                t0,
                t1,
            });
        };
        match kernel {
            KernelChoice::OneD => expected_blur_1d_bins(&Blur1dBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                ray_offset,
                source_z,
                radius,
                t0,
                t1,
            }),
            KernelChoice::TwoD if g == 0.0 => expected_blur_2d_bins(&Blur2dBin {
                energy,
                sigma_s,
                sigma_t,
                speed,
                ray_offset,
                source_z,
                radius,
                t0,
                t1,
            }),
            KernelChoice::TwoD => expected_blur_2d_hg_bins(&Blur2dHgBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                ray_offset,
                source_z,
                radius,
                t0,
                t1,
            }),
            KernelChoice::ThreeD => expected_blur_3d_bins(&Blur3dBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                ray_offset,
                source_z,
                radius,
                t0,
                t1,
            }),
        }
    }

    /// The bins of all pixels of a square film, averaged over each by so many points along an edge.
    ///
    /// # Errors
    /// As [`Self::bin`].
    pub fn cube(
        &self,
        sensor: &Sensor,
        pixels: usize,
        time: TimeSpec,
        points: usize,
    ) -> Result<Cube> {
        let rule = gauss_legendre(points);
        let edge = |i: usize| time.start_opl + i as f64 * time.bin_width_opl;
        let pixel = |index: usize| -> std::result::Result<Vec<f64>, ReferenceError> {
            let mut bins = vec![0.0; time.bins];
            for (x, wx) in &rule {
                for (y, wy) in &rule {
                    let on_film = ((index % pixels) as f64 + x, (index / pixels) as f64 + y);
                    let ray = (sensor.position, sensor.direction(on_film.0, on_film.1));
                    for (i, bin) in bins.iter_mut().enumerate() {
                        *bin += wx * wy * self.bin(ray, [edge(i), edge(i + 1)])?;
                    }
                }
            }
            Ok(bins)
        };
        let all: Vec<Vec<f64>> = (0..pixels * pixels)
            .into_par_iter()
            .map(pixel)
            .collect::<std::result::Result<_, _>>()?;
        let mut cube = Cube::zero(pixels, pixels, time.bins);
        for (index, bins) in all.iter().enumerate() {
            cube.pixel_mut(index)[1..=time.bins].copy_from_slice(bins);
        }
        Ok(cube)
    }
}

/// Nodes and weights of the Gauss-Legendre rule on (0, 1): Newton's method on the polynomial.
pub fn gauss_legendre(points: usize) -> Vec<(f64, f64)> {
    let n = points as f64;
    (0..points)
        .map(|i| {
            let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..50 {
                let (mut before, mut value) = (0.0, 1.0);
                for k in 0..points {
                    let k = k as f64;
                    (before, value) =
                        (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
                }
                slope = n * (x * value - before) / ((x - 1.0) * (x + 1.0));
                x -= value / slope;
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x) * (1.0 + x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{View, only_depth};

    #[test]
    fn the_rules_integrate_polynomials_of_their_degree() {
        for points in 1..8_i32 {
            for power in 0..2 * points {
                let found: f64 = gauss_legendre(points.unsigned_abs() as usize)
                    .iter()
                    .map(|(x, w)| w * x.powi(power))
                    .sum();
                assert!((found * f64::from(power + 1) - 1.0).abs() < 1e-13, "{points} {power}");
            }
        }
    }

    #[test]
    fn narrow_kernels_tend_to_the_light_itself_for_every_phase_function() {
        let view = View { pixels: 2, fov: 20.0, time: None, integrator: only_depth(2) };
        let sensor = view.parts().sensor;
        let time = TimeSpec { start_opl: 0.0, bin_width_opl: 0.7, bins: 5 };
        for g in [0.0, 0.7] {
            let fog = Fog { sigma_s: 0.4, sigma_a: 0.1, g };
            let of = |blur| {
                let light = DVec3::new(0.8, 0.1, 0.2);
                SingleScattering { fog, light, blur }.cube(&sensor, 2, time, 2).unwrap()
            };
            let sharp = of(None);
            let total = sharp.values.iter().sum::<f64>();
            let kernels = [KernelChoice::OneD, KernelChoice::TwoD, KernelChoice::ThreeD];
            for &kernel in if g == 0.0 { &kernels[..] } else { &kernels[..2] } {
                let (near, far) = (of(Some((kernel, 1e-3))), of(Some((kernel, 0.4))));
                let off = |cube: &Cube| {
                    let pairs = cube.values.iter().zip(&sharp.values);
                    pairs.map(|(a, b)| (a - b).abs()).sum::<f64>() / total
                };
                assert!(off(&near) < 1e-4 && off(&far) > 1e-3, "{kernel:?} {g}");
            }
        }
    }
}
