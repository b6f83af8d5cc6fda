//! Light scattered once in endless fog: a point lamp beside the camera, in any unit.
//!
//! The lamp of unit power stands at (1, 0, 0), the camera at the origin looks along +z. Every pixel
//! is the mean over its area of the exact radiance: of `path` and
//! `light` the single scattering itself, of beams their expected blur, bin by bin (`single_scatter_radiance_bins`, `expected_blur_1d_bins`,
//! `expected_blur_2d_hg_bins`, `expected_blur_3d_bins`).

use tpb_reference::ReferenceError;
use tpb_reference::beams::expected_blur::{Blur1dBin, expected_blur_1d_bins};
use tpb_reference::beams::expected_blur_disc_hg::{Blur2dHgBin, expected_blur_2d_hg_bins};
use tpb_reference::beams::expected_blur_sphere::{Blur3dBin, expected_blur_3d_bins};
use tpb_reference::single_scattering::{SingleScatterBin, single_scatter_radiance_bins};

use crate::contrasts::LinearContrast;
use crate::error::Result;
use crate::stress::case::{Finding, Method, Work};
use crate::stress::laws::{Expected, agrees};
use crate::stress::shot::Shot;
use crate::stress::world::{Film, Fog, Unit, World};

/// Nodes and weights of Gauss and Legendre on (0, 1).
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Single scattering in fog, seen in a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Single {
    /// What its numbers are measured in.
    pub unit: Unit,
    /// The fog, per unit of length.
    pub fog: Fog,
    /// Refractive index of the fog: only time stretches.
    pub eta: f64,
    /// Bins: OPL of the first edge, of a bin, and their number.
    pub bins: (f64, f64, usize),
    /// Angle between the view axis and the direction to the lamp, and the camera's field of view, in
    /// degrees.
    pub view: (f64, f64),
    /// Radius of beams.
    pub radius: f64,
    /// Power of the lamp.
    pub power: f64,
}

/// Pixels along the film's edges.
const SIDE: usize = 4;

impl Single {
    /// Optical thickness 0.5 between camera and lamp, 12 bins that hold most of the light.
    pub const USUAL: Self = Self {
        unit: Unit::SI,
        fog: Fog { sigma_s: [0.4; 3], sigma_a: [0.1; 3], g: 0.0 },
        eta: 1.0,
        bins: (0.2, 0.5, 12),
        view: (90.0, 50.0),
        radius: 0.25,
        power: 1.0,
    };

    /// The scene.
    pub fn world(&self) -> World {
        let (start, bin, bins) = self.bins;
        let film = Film {
            width: SIDE,
            height: SIDE,
            start: start * self.eta,
            bin: bin * self.eta,
            bins,
            rgb: self.is_coloured(),
        };
        let world = World::new(self.unit).depths(2, 2);
        let fog = world.fog(self.fog, Some(self.eta));
        let (sin, cos) = self.view.0.to_radians().sin_cos();
        // The lamp is seen at this angle from the axis, in the plane of x and z.
        let lamp = [sin, 0.0, cos];
        world
            .with("fog", fog)
            .with("background", serde_json::json!({"type": "ref", "id": "fog"}))
            .camera([0.0; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], self.view.1, film)
            .point("lamp", lamp, self.power)
    }

    /// A shot of it.
    pub fn shot(&self, method: Method, work: &Work) -> Result<Shot> {
        let work = Work { radius: Some(self.radius), ..*work };
        Shot::new(&self.world(), method, &work)
    }

    /// Renders and compares; exact values are multiplied by `factor` (1, but for sabotage).
    pub fn agrees(
        &self,
        method: Method,
        work: &Work,
        (seed, passes): (u64, u64),
        factor: f64,
    ) -> Result<Finding> {
        let expected = self.expected(method)?.times(factor);
        agrees(&self.shot(method, work)?, seed, passes, &expected)
    }

    fn is_coloured(&self) -> bool {
        let Fog { sigma_s, sigma_a, .. } = self.fog;
        [sigma_s, sigma_a].iter().any(|s| s.iter().any(|x| *x != s[0]))
    }

    /// In each channel: all energy of the window, and halves of it in time where both are lit.
    fn expected(&self, method: Method) -> Result<Expected> {
        let bins = self.bins.2;
        let pixels: Vec<usize> = (0..SIDE * SIDE).collect();
        let channels = if self.is_coloured() { 3 } else { 1 };
        let mut expected = Expected::grey(vec![], vec![]);
        for channel in 0..channels {
            let per_bin = self.per_bin(method, channel)?;
            let total: f64 = per_bin.iter().sum();
            let mut parts = Vec::from([(0, bins)]);
            let half = (1..bins).find(|&b| per_bin[..b].iter().sum::<f64>() >= 0.5 * total);
            if let Some(half) = half {
                parts.extend([(0, half), (half, bins)]);
            }
            for (first, end) in parts {
                let value: f64 = per_bin[first..end].iter().sum();
                if value < 0.2 * total {
                    continue;
                }
                let inside = |cell: usize| (first + 1..=end).contains(&cell);
                let weights = (0..bins + 2).map(|cell| f64::from(u8::from(inside(cell)))).collect();
                let name = format!("channel {channel}, bins {first}..{end}");
                expected.contrasts.push(LinearContrast { name, pixels: pixels.clone(), weights });
                expected.channels.push(channel);
                // The rule's error on these smooth pixels is far below.
                expected.values.push((value, 1e-4 * value));
            }
        }
        Ok(expected)
    }

    /// Exact energy of each bin, summed over the pixels.
    fn per_bin(&self, method: Method, channel: usize) -> Result<Vec<f64>> {
        let (start, width, bins) = self.bins;
        let tangent = (0.5 * self.view.1).to_radians().tan();
        let (sin, cos) = self.view.0.to_radians().sin_cos();
        let mut sums = vec![0.0; bins];
        for pixel in 0..SIDE * SIDE {
            for ((u, wu), (v, wv)) in GAUSS.iter().flat_map(|&u| GAUSS.map(|v| (u, v))) {
                let on_film =
                    |index: usize, u: f64| tangent * (2.0 * (index as f64 + u) / SIDE as f64 - 1.0);
                // Mirrored left to right or not: rows are summed over all columns.
                let (x, y) = (on_film(pixel % SIDE, u), on_film(pixel / SIDE, v));
                let cosine = (x * sin + cos) / (1.0 + x * x + y * y).sqrt();
                let alpha = cosine.clamp(-1.0, 1.0).acos();
                for (bin, sum) in sums.iter_mut().enumerate() {
                    let edge = |i: usize| start + i as f64 * width;
                    let value = self.radiance(method, channel, alpha, edge(bin), edge(bin + 1))?;
                    *sum += wu * wv * value * self.power * self.unit.light;
                }
            }
        }
        Ok(sums)
    }

    /// Exact energy of a bin of a ray at the angle `alpha` to the lamp, in units.
    fn radiance(
        &self,
        method: Method,
        channel: usize,
        alpha: f64,
        t0: f64,
        t1: f64,
    ) -> std::result::Result<f64, ReferenceError> {
        let Fog { sigma_s, sigma_a, g } = self.fog;
        let sigma_t = sigma_s[channel] + sigma_a[channel];
        let (sigma_s, energy, speed, radius) = (sigma_s[channel], 1.0, 1.0, self.radius);
        let (ray_offset, source_z) = (alpha.sin(), alpha.cos());
        match method {
            Method::Path | Method::Light => single_scatter_radiance_bins(&SingleScatterBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                source_distance: 1.0,
                alpha,
                t0,
                t1,
            }),
            Method::Beams1d => expected_blur_1d_bins(&Blur1dBin {
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
            Method::Beams2d | Method::BeamsShort => expected_blur_2d_hg_bins(&Blur2dHgBin {
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
            Method::Beams3d => expected_blur_3d_bins(&Blur3dBin {
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
}
