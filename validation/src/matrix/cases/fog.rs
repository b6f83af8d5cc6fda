//! Light scattered once in a medium without end, with the camera inside.
//!
//! The point lamp is beside the camera at the distance D, across its axis, so that beams and rays
//! meet under large angles: the variance of 1/sinψ stays small. Path tracing is compared with the
//! single scattering itself, each kernel with its exact *expected blur*, whose difference from the
//! true radiance, several percent with the radius chosen here, is part of the expectation: an
//! estimate without blur would fail.
//!
//! Light tracing does not play here. A collision at the distance s from the eye is connected to it
//! with the weight 1/s², whose square has no mean.

use glam::DVec3;
use tpb_reference::ReferenceError;
use tpb_reference::beams::expected_blur::{Blur1dBin, expected_blur_1d_bins};
use tpb_reference::beams::expected_blur_disc::{Blur2dBin, expected_blur_2d_bins};
use tpb_reference::beams::expected_blur_disc_hg::{Blur2dHgBin, expected_blur_2d_hg_bins};
use tpb_reference::beams::expected_blur_sphere::{Blur3dBin, expected_blur_3d_bins};
use tpb_reference::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};
use tpb_scene::{IntegratorSpec, MediumId, SceneParts, TimeSpec};

use super::{Budget, Case, Channel, Family, MatrixMedium, Player};
use crate::error::Result;
use crate::experiment::Effort;
use crate::matrix::players::{Blur, Kernels};
use crate::matrix::view::{Expected, Frame, gauss};
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth, unit_point};

const LIGHT_DISTANCE: f64 = 0.6;
const RADIUS: f64 = 0.25;

/// The case.
pub(super) struct Fog;

/// The exact energy of a bin, for a ray at the angle `alpha` to the direction to the lamp.
fn bin(
    channel: &Channel,
    blur: Option<(Blur, f64)>,
    alpha: f64,
    (t0, t1): (f64, f64),
) -> std::result::Result<f64, ReferenceError> {
    let &Channel { sigma_s, sigma_t, g } = channel;
    let (energy, speed) = (1.0, 1.0);
    let (ray_offset, source_z) = (LIGHT_DISTANCE * alpha.sin(), LIGHT_DISTANCE * alpha.cos());
    match blur {
        None => single_scatter_radiance_bins(&SingleScatterBin {
            energy,
            sigma_s,
            sigma_t,
            g,
            speed,
            source_distance: LIGHT_DISTANCE,
            alpha,
            t0,
            t1,
        }),
        Some((Blur::OneD, radius)) => expected_blur_1d_bins(&Blur1dBin {
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
        Some((Blur::TwoD, radius)) if g == 0.0 => expected_blur_2d_bins(&Blur2dBin {
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
        Some((Blur::ThreeD, radius)) => expected_blur_3d_bins(&Blur3dBin {
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
        Some((Blur::TwoD, radius)) => expected_blur_2d_hg_bins(&Blur2dHgBin {
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

impl Case for Fog {
    fn name(&self) -> &'static str {
        "fog"
    }

    fn question(&self) -> &'static str {
        "camera inside fog without end: one scattering"
    }

    fn frame(&self) -> Frame {
        let time = TimeSpec { start_opl: 0.1, bin_width_opl: 0.25, bins: 25 };
        Frame { side: 4, fov: 50.0, time }
    }

    fn integrator(&self) -> IntegratorSpec {
        only_depth(2)
    }

    fn takes(&self, medium: &MatrixMedium) -> bool {
        medium.scatters()
    }

    fn admits(&self, family: Family) -> bool {
        family != Family::Light
    }

    fn kernels(&self) -> Kernels {
        Kernels::All
    }

    fn parts(&self, view: &View, medium: &MatrixMedium) -> SceneParts {
        let mut parts = view.parts();
        parts.media = vec![medium.medium(1.0)];
        parts.background = Some(MediumId(0));
        parts.emitters = vec![unit_point(LIGHT_DISTANCE * DVec3::X)];
        parts
    }

    fn expected(&self, channel: &Channel, blur: Option<(Blur, f64)>) -> Result<Expected> {
        let frame = self.frame();
        let cube = |points: usize| {
            // The angle to the lamp, beside the camera, is alike above and below.
            frame.average_of_mirrored(&gauss(points), |point, bins| {
                let alpha = (1.0 + point.y * point.y).sqrt().atan2(point.x);
                for (index, value) in bins.iter_mut().enumerate() {
                    let ends = (frame.edge(index), frame.edge(index + 1));
                    *value = bin(channel, blur, alpha, ends)?;
                }
                Ok(())
            })
        };
        // The expectation of a sphere's blur is a quadrature of quadratures.
        let points = if matches!(blur, Some((Blur::ThreeD, _))) { 3 } else { 4 };
        Ok(Expected { fine: cube(points)?, coarse: cube(points - 1)? })
    }

    fn budget(&self, player: &Player, medium: &MatrixMedium, effort: Effort) -> Budget {
        // Few photons are deflected much where the phase function is peaked.
        // A pair costs the 3D kernel a quadrature, and rays that meet one beam are alike.
        let spheres = player.blur() == Some(Blur::ThreeD);
        let dear = spheres || player.is_variant() && medium.name == "coloured";
        let rays = if dear { 1 } else { 4 };
        let passes = match (player.is_baseline(), medium.name) {
            (true, _) => effort.pick(1, 2),
            (false, _) if spheres => 9,
            // A mixture of channels has no closed form along a short beam.
            (false, "coloured") if player.is_variant() => effort.pick(8, 16),
            (false, "forward") => effort.pick(25, 35),
            (false, _) => effort.pick(10, 18),
        };
        Budget { paths: 10_000, photons: 10_000, rays, passes, radius: RADIUS }
    }

    /// From columns that look towards the lamp to those that look away.
    fn groups(&self) -> Vec<(String, Vec<usize>)> {
        let side = self.frame().side;
        (0..side)
            .map(|column| {
                let pixels = (0..side).map(|row| column + row * side).collect();
                (format!("column {column} of the image"), pixels)
            })
            .collect()
    }

    fn twins(&self, player: &Player, medium: &MatrixMedium) -> Vec<Sabotage> {
        match (player.is_baseline(), medium.name) {
            (false, _) => vec![Sabotage::KERNEL],
            (true, "isotropic") => {
                vec![Sabotage::SIGMA_S, Sabotage::TRANSMITTANCE, Sabotage::PhaseNormalisation]
            }
            (true, "lossless") => vec![Sabotage::PhaseNormalisation],
            (true, "forward") => vec![Sabotage::LATE],
            (true, _) => vec![Sabotage::SIGMA_S],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The image's left looks towards the lamp: more light arrives there, and up and down alike.
    #[test]
    fn the_left_of_the_image_is_brighter() {
        let channel = Channel { sigma_s: 0.4, sigma_t: 0.5, g: 0.0 };
        let expected = Fog.expected(&channel, None).unwrap().fine;
        let energy = |pixel: usize| expected.pixel_bins(pixel).iter().sum::<f64>();
        assert!(energy(4) > energy(7));
        assert!((energy(4) / energy(8) - 1.0).abs() < 1e-12);
    }
}
