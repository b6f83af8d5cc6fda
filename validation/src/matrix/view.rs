//! What the matrix' cameras see: a square image from the origin along +z, and its pixels in
//! coordinates of the plane at distance 1.

use std::num::NonZeroUsize;

use gauss_quad::GaussLegendre;
use glam::DVec3;
use rayon::prelude::*;
use tpb_reference::ReferenceError;
use tpb_scene::TimeSpec;

use crate::cube::Cube;
use crate::error::Result;

/// Pixels and bins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Pixels on a side; an even number.
    pub side: usize,
    /// Full angle across the film \[degrees\].
    pub fov: f64,
    /// The time axis.
    pub time: TimeSpec,
}

/// A point of the image plane at distance 1: +x is on the left of the image, +y at its top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePoint {
    /// Towards +x.
    pub x: f64,
    /// Towards +y.
    pub y: f64,
}

impl PlanePoint {
    /// Unit direction of the camera's ray.
    pub fn direction(&self) -> DVec3 {
        DVec3::new(self.x, self.y, 1.0).normalize()
    }

    /// Length of the ray from the eye to a plane at distance 1.
    pub fn slant(&self) -> f64 {
        (1.0 + self.x * self.x + self.y * self.y).sqrt()
    }
}

impl Frame {
    /// Lower edge of a bin \[m\].
    pub fn edge(&self, bin: usize) -> f64 {
        self.time.start_opl + bin as f64 * self.time.bin_width_opl
    }

    /// A point of a pixel; `u` and `v` from its left and upper edge, 0 to 1.
    pub fn point(&self, pixel: usize, u: f64, v: f64) -> PlanePoint {
        let half = (0.5 * self.fov.to_radians()).tan();
        let at = |index: usize, offset: f64| {
            half * (1.0 - 2.0 * (index as f64 + offset) / self.side as f64)
        };
        PlanePoint { x: at(pixel % self.side, u), y: at(pixel / self.side, v) }
    }

    /// The mean over each pixel of what a ray's bins hold, by the product of a Gauss-Legendre rule.
    pub fn average(
        &self,
        rule: &[(f64, f64)],
        bins: impl Fn(PlanePoint, &mut [f64]) -> std::result::Result<(), ReferenceError> + Sync,
    ) -> Result<Cube> {
        self.average_of_rows(self.side, rule, bins)
    }

    /// The same of what is alike above and below the middle of the image.
    pub fn average_of_mirrored(
        &self,
        rule: &[(f64, f64)],
        bins: impl Fn(PlanePoint, &mut [f64]) -> std::result::Result<(), ReferenceError> + Sync,
    ) -> Result<Cube> {
        let mut cube = self.average_of_rows(self.side.div_ceil(2), rule, bins)?;
        for pixel in self.side.div_ceil(2) * self.side..cube.pixels() {
            let (column, row) = (pixel % self.side, pixel / self.side);
            let alike = cube.pixel((self.side - 1 - row) * self.side + column).to_vec();
            cube.pixel_mut(pixel).copy_from_slice(&alike);
        }
        Ok(cube)
    }

    /// The first rows; the others stay 0.
    fn average_of_rows(
        &self,
        rows: usize,
        rule: &[(f64, f64)],
        bins: impl Fn(PlanePoint, &mut [f64]) -> std::result::Result<(), ReferenceError> + Sync,
    ) -> Result<Cube> {
        let mut cube = Cube::zero(self.side, self.side, self.time.bins);
        let pixels: Vec<Vec<f64>> = (0..rows * self.side)
            .into_par_iter()
            .map(|pixel| {
                let mut sums = vec![0.0; self.time.bins];
                let mut one = sums.clone();
                for (u, wu) in rule {
                    for (v, wv) in rule {
                        one.fill(0.0);
                        bins(self.point(pixel, *u, *v), &mut one)?;
                        sums.iter_mut().zip(&one).for_each(|(sum, value)| *sum += wu * wv * value);
                    }
                }
                Ok(sums)
            })
            .collect::<std::result::Result<_, ReferenceError>>()?;
        for (pixel, bins) in pixels.iter().enumerate() {
            cube.pixel_mut(pixel)[1..=self.time.bins].copy_from_slice(bins);
        }
        Ok(cube)
    }

    /// The mean over each pixel where each ray sees one instant: `light` gives energy and OPL. By
    /// the midpoints of `count` × `count` parts, for bins cut a pixel along a curve.
    pub fn average_of_instants(
        &self,
        count: usize,
        light: impl Fn(PlanePoint) -> (f64, f64) + Sync,
    ) -> Cube {
        let mut cube = Cube::zero(self.side, self.side, self.time.bins);
        let cells = self.time.bins + 2;
        cube.values.par_chunks_mut(cells).enumerate().for_each(|(pixel, cells)| {
            let at = |i: usize| (i as f64 + 0.5) / count as f64;
            for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
                let (energy, opl) = light(self.point(pixel, at(i), at(j)));
                let bin = (opl - self.time.start_opl) / self.time.bin_width_opl;
                let cell = (bin.floor() + 1.0).clamp(0.0, self.time.bins as f64 + 1.0);
                cells[cell as usize] += energy / (count * count) as f64;
            }
        });
        cube
    }

    /// The upper and the lower half, where quadrants would need too much light.
    pub fn halves(&self) -> Vec<(String, Vec<usize>)> {
        let upper = |pixel: &usize| pixel / self.side < self.side / 2;
        let (upper, lower) = (0..self.side * self.side).partition(upper);
        vec![("upper half".to_owned(), upper), ("lower half".to_owned(), lower)]
    }

    /// Square blocks of pixels, two by two.
    pub fn quadrants(&self) -> Vec<(String, Vec<usize>)> {
        let half = self.side / 2;
        let of = |pixel: usize| pixel % self.side / half + 2 * (pixel / self.side / half);
        ["upper left", "upper right", "lower left", "lower right"]
            .iter()
            .enumerate()
            .map(|(q, name)| {
                let pixels = (0..self.side * self.side).filter(|&p| of(p) == q).collect();
                ((*name).to_owned(), pixels)
            })
            .collect()
    }
}

/// Gauss-Legendre nodes and weights on (0, 1).
pub fn gauss(points: usize) -> Vec<(f64, f64)> {
    let points = NonZeroUsize::new(points).expect("a rule has points");
    let rule = GaussLegendre::new(points);
    rule.as_node_weight_pairs().iter().map(|(x, w)| (0.5 + 0.5 * x, 0.5 * w)).collect()
}

/// What two rules, a fine and a coarse one, say of an expectation.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// By the fine rule.
    pub fine: Cube,
    /// By the coarse rule, which tells the error.
    pub coarse: Cube,
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        side: 4,
        fov: 40.0,
        time: TimeSpec { start_opl: 1.0, bin_width_opl: 0.02, bins: 5 },
    };

    #[test]
    fn rules_integrate_polynomials_of_their_degree() {
        for points in 2..=4_i32 {
            for n in 0..2 * points {
                let moment: f64 = gauss(points as usize).iter().map(|(x, w)| w * x.powi(n)).sum();
                assert!((moment * f64::from(n + 1) - 1.0).abs() < 1e-14, "{points} {n}");
            }
        }
    }

    #[test]
    fn the_frame_agrees_with_the_camera() {
        let sensor = tpb_scene::Sensor::perspective(
            glam::DAffine3::IDENTITY,
            FRAME.fov,
            tpb_scene::FovAxis::X,
            FRAME.side,
            FRAME.side,
        );
        let ours = FRAME.point(6, 0.25, 0.75).direction();
        assert!((ours - sensor.direction(2.25, 1.75)).length() < 1e-15);
    }

    #[test]
    fn both_averages_agree_and_instants_are_put_into_their_bins() {
        // One unit of energy at the slant of a plane at distance 1.
        let instants = FRAME.average_of_instants(300, |p| (1.0, p.slant()));
        let total = FRAME
            .average(&gauss(3), |_, bins| {
                bins[0] = 1.0;
                Ok(())
            })
            .unwrap();
        for pixel in 0..16 {
            let cells = instants.pixel(pixel);
            assert!((cells.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            assert!((total.pixel_bins(pixel)[0] - 1.0).abs() < 1e-14);
        }
        // The inner pixels reach to tan 20°/2 along both axes: slant at most 1.0326.
        assert!(instants.pixel(5)[3..].iter().all(|&v| v == 0.0));
        assert_eq!(instants.pixel(0)[0], 0.0);
    }
}
