//! The media of the matrix: one line each.

use tpb_optics::{Coefficients, Phase, Spectrum};
use tpb_scene::Medium;

/// A homogeneous medium in the matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatrixMedium {
    /// Its name in the names of rows.
    pub name: &'static str,
    /// sigma_s of each channel \[1/m\].
    pub sigma_s: [f64; 3],
    /// sigma_a of each channel \[1/m\].
    pub sigma_a: [f64; 3],
    /// Mean cosine of the phase function.
    pub g: f64,
}

/// All media: albedo 0 to 1, scattering to all sides, forward and backward, with colour.
pub const MEDIA: [MatrixMedium; 6] = [
    grey("isotropic", 0.4, 0.1, 0.0),
    grey("forward", 0.4, 0.1, 0.9),
    grey("backward", 0.4, 0.1, -0.5),
    grey("lossless", 0.5, 0.0, 0.0),
    grey("absorbing", 0.0, 0.5, 0.0),
    MatrixMedium { name: "coloured", sigma_s: [0.2, 0.5, 0.7], sigma_a: [0.3, 0.1, 0.05], g: 0.3 },
];

const fn grey(name: &'static str, sigma_s: f64, sigma_a: f64, g: f64) -> MatrixMedium {
    MatrixMedium { name, sigma_s: [sigma_s; 3], sigma_a: [sigma_a; 3], g }
}

/// One channel of a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Scattering coefficient \[1/m\].
    pub sigma_s: f64,
    /// Extinction coefficient \[1/m\].
    pub sigma_t: f64,
    /// Mean cosine of the phase function.
    pub g: f64,
}

impl MatrixMedium {
    /// Whether it scatters at all.
    pub fn scatters(&self) -> bool {
        self.sigma_s.iter().any(|&s| s > 0.0)
    }

    /// Whether its channels differ.
    pub fn has_colour(&self) -> bool {
        let differs = |values: [f64; 3]| values.iter().any(|v| *v != values[0]);
        differs(self.sigma_s) || differs(self.sigma_a)
    }

    /// The channels that a render has: one, or three with colour.
    pub fn channels(&self) -> Vec<Channel> {
        let channel = |c: usize| {
            let (sigma_s, sigma_t) = (self.sigma_s[c], self.sigma_s[c] + self.sigma_a[c]);
            Channel { sigma_s, sigma_t, g: self.g }
        };
        (0..if self.has_colour() { 3 } else { 1 }).map(channel).collect()
    }

    /// The medium of a scene, its coefficients multiplied by `density`.
    pub fn medium(&self, density: f64) -> Medium {
        let sigma_s = Spectrum(self.sigma_s) * density;
        let sigma_t = sigma_s + Spectrum(self.sigma_a) * density;
        Medium {
            name: self.name.into(),
            coefficients: Coefficients { sigma_s, sigma_t },
            phase: Phase::with_mean_cosine(self.g),
            eta: None,
        }
    }
}
