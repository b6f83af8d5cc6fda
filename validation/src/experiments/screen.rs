//! What a camera sees on a flat diffuse screen that is lit in a known way.
//!
//! A pixel's value is the mean over its area of ρ/π E(x), arriving when the light reaches x plus the
//! way from x to the camera. The mean is taken over a low-discrepancy sequence (Roberts 2018: steps
//! 1/φ, …, 1/φ^d with φ^(d+1) = φ + 1), moved from pixel to pixel. Further dimensions are added as
//! needed:
//!
//! * an elliptic *lamp* is a mean over its points;
//! * the *blur* of surface photons, exactly: the light that is counted at x is that of a point p
//!   within a disc around x, delayed by η ω·(x − p), which the estimate does for light along ω.
//!   Light that the estimate connects to the lamp (`direct`) is not blurred.
//!
//! Half of the points give a coarser mean, whose difference is taken as the error.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use tpb_scene::Scene;

use crate::cube::Cube;
use crate::error::{Result, ValidationError};

/// A screen, and the camera in front of it.
pub(super) struct Screen<'a> {
    /// Camera and film.
    pub(super) scene: &'a Scene,
    /// A point of the screen.
    pub(super) origin: DVec3,
    /// Its unit normal, towards the camera.
    pub(super) normal: DVec3,
    /// Its reflectance.
    pub(super) albedo: f64,
    /// Refractive index in front of it.
    pub(super) eta: f64,
    /// Half axes of an elliptic lamp; 0 for a point \[m\].
    pub(super) lamp: DVec2,
    /// Radius of the disc that photons are gathered from; 0 for estimates without \[m\].
    pub(super) blur: f64,
    /// Points in a pixel.
    pub(super) points: usize,
}

/// Light that reaches a point of the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit {
    /// Irradiance \[W/m²\] if the lamp were one point.
    pub(super) irradiance: f64,
    /// Since it left the lamp \[m\].
    pub(super) opl: f64,
    /// Its unit direction.
    pub(super) direction: DVec3,
    /// Whether the estimate connects it to the lamp.
    pub(super) direct: bool,
}

/// What is expected of a film.
pub(super) struct Expected {
    /// The film.
    pub(super) cube: Cube,
    /// By half as many points.
    pub(super) coarser: Cube,
    /// Mean cosine of the incident light in each pixel.
    pub(super) cosines: Vec<f64>,
}

/// A pixel's cells by all points and by the first half, and the cosine.
struct Pixel {
    cells: Vec<f64>,
    half: Vec<f64>,
    cosine: f64,
}

impl Screen<'_> {
    /// The film, if `lit` tells how a point of the lamp (offset from its centre) lights a point of
    /// the screen.
    pub(super) fn expected(
        &self,
        lit: impl Fn(DVec2, DVec3) -> Result<Vec<Lit>> + Sync,
    ) -> Result<Expected> {
        let film = &self.scene.film;
        let bins = film.time.map_or(0, |time| time.bins);
        let pixels: Vec<Pixel> = (0..film.width * film.height)
            .into_par_iter()
            .map(|pixel| self.pixel(pixel, &lit))
            .collect::<Result<_>>()?;
        let mut cube = Cube::zero(film.width, film.height, bins);
        let mut coarser = cube.clone();
        for (index, pixel) in pixels.iter().enumerate() {
            cube.pixel_mut(index).copy_from_slice(&pixel.cells);
            coarser.pixel_mut(index).copy_from_slice(&pixel.half);
        }
        Ok(Expected { cube, coarser, cosines: pixels.iter().map(|pixel| pixel.cosine).collect() })
    }

    fn pixel(
        &self,
        pixel: usize,
        lit: &(impl Fn(DVec2, DVec3) -> Result<Vec<Lit>> + Sync),
    ) -> Result<Pixel> {
        let film = &self.scene.film;
        let time = film
            .time
            .ok_or_else(|| ValidationError::unusable("screen", "its film has no time axis"))?;
        let mut cells = vec![0.0; time.bins + 2];
        let mut half = cells.clone();
        let (mut energy, mut across) = (0.0, 0.0);
        let (column, row) = ((pixel % film.width) as f64, (pixel / film.width) as f64);
        let (wide, blurred) = (self.lamp != DVec2::ZERO, self.blur > 0.0);
        let sequence = Sequence::new(2 + 2 * u8::from(wide) + 2 * u8::from(blurred), pixel);
        let (first, second) = self.normal.any_orthonormal_pair();
        for index in 0..self.points {
            let u = |k| sequence.at(index, k);
            let x = self.seen_at(column + u(0), row + u(1));
            let offset = if wide { self.lamp * disc(u(2), u(3)) } else { DVec2::ZERO };
            let k = if wide { 4 } else { 2 };
            let aside = if blurred { self.blur * disc(u(k), u(k + 1)) } else { DVec2::ZERO };
            let p = x + aside.x * first + aside.y * second;
            let back = self.eta * (x - self.scene.sensor.position).length();
            let mut count = |light: &Lit| {
                let lag = if light.direct { 0.0 } else { self.eta * light.direction.dot(x - p) };
                let opl = light.opl + lag + back;
                let value = self.albedo / PI * light.irradiance;
                let place = (opl - time.start_opl) / time.bin_width_opl;
                let cell = (place.floor() + 1.0).clamp(0.0, time.bins as f64 + 1.0) as usize;
                cells[cell] += value;
                if index < self.points / 2 {
                    half[cell] += value;
                }
                energy += value;
                across -= value * light.direction.dot(self.normal);
            };
            if blurred {
                lit(offset, x)?.iter().filter(|l| l.direct).for_each(&mut count);
                lit(offset, p)?.iter().filter(|l| !l.direct).for_each(&mut count);
            } else {
                lit(offset, x)?.iter().for_each(&mut count);
            }
        }
        for (cell, half) in cells.iter_mut().zip(&mut half) {
            *cell /= self.points as f64;
            *half /= (self.points / 2) as f64;
        }
        Ok(Pixel { cells, half, cosine: if energy > 0.0 { across / energy } else { 1.0 } })
    }

    /// The point of the screen behind a place on the film, in pixels.
    fn seen_at(&self, x: f64, y: f64) -> DVec3 {
        let eye = self.scene.sensor.position;
        let direction = self.scene.sensor.direction(x, y);
        let distance = (self.origin - eye).dot(self.normal) / direction.dot(self.normal);
        eye + distance * direction
    }
}

/// Blocks of pixels: so many columns and rows of them.
pub(super) fn blocks(
    (width, height): (usize, usize),
    (columns, rows): (usize, usize),
) -> Vec<(String, Vec<usize>)> {
    let block = |column: usize, row: usize| {
        let inside = |pixel: &usize| {
            pixel % width * columns / width == column && pixel / width * rows / height == row
        };
        (format!("block {column}, {row}"), (0..width * height).filter(inside).collect())
    };
    (0..rows).flat_map(|row| (0..columns).map(move |column| block(column, row))).collect()
}

/// A low-discrepancy sequence in the unit cube.
pub(super) struct Sequence {
    steps: Vec<f64>,
    start: Vec<f64>,
}

impl Sequence {
    /// In so many dimensions; `which` moves it as a whole.
    pub(super) fn new(dimensions: u8, which: usize) -> Self {
        let mut phi: f64 = 2.0;
        for _ in 0..64 {
            phi = (1.0 + phi).powf(1.0 / f64::from(dimensions + 1));
        }
        let steps: Vec<f64> = (1..=dimensions).map(|k| phi.powi(-i32::from(k))).collect();
        // Steps of another kind, so that moved sequences are not parts of each other.
        let start = (1..=dimensions)
            .map(|k| (0.5 + which as f64 * f64::from(2 * k + 1).sqrt()).fract())
            .collect();
        Self { steps, start }
    }

    /// Coordinate `k` of a point.
    pub(super) fn at(&self, index: usize, k: usize) -> f64 {
        (self.start[k] + (index + 1) as f64 * self.steps[k]).fract()
    }
}

/// The unit disc, uniformly, from the unit square.
pub(super) fn disc(u: f64, v: f64) -> DVec2 {
    u.sqrt() * DVec2::from_angle(2.0 * PI * v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moved_sequences_integrate_smooth_functions_well() {
        let (n, pixels) = (16384, 32);
        let mean = |pixel: usize| {
            let sequence = Sequence::new(4, pixel);
            let value = |i| (0..4).map(|k| 2.0 * sequence.at(i, k)).product::<f64>();
            (0..n).map(value).sum::<f64>() / n as f64
        };
        let all = (0..pixels).map(mean).sum::<f64>() / pixels as f64;
        assert!((all - 1.0).abs() < 1e-3, "{all}");
    }

    #[test]
    fn blocks_cover_the_film_once() {
        let blocks = blocks((6, 8), (2, 4));
        let mut all: Vec<usize> = blocks.iter().flat_map(|(_, pixels)| pixels.clone()).collect();
        all.sort_unstable();
        assert_eq!(all, (0..48).collect::<Vec<_>>());
        assert_eq!(blocks.len(), 8);
    }
}
