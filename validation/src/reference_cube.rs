//! The long render that methods are compared with, small enough to ship.
//!
//! A reference cube is the mean over channels of a long render of an unbiased method
//! ([`crate::long_render`]), and what that tells of its own noise: half floats, with a scale of its own for each frame so that dark frames keep
//! their digits, compressed. What the rounding adds is known exactly when the file is made, and it
//! is counted as variance. NumPy reads the file:
//!
//! | key | type, shape | |
//! | --- | --- | --- |
//! | `transient` | f2 (H, W, T) | bins over the scale of their frame |
//! | `scale` | f8 (T) | to be multiplied with |
//! | `mask` | u1 (H, W) | 1: judged ([`crate::judged`]) |
//! | `variance_pixel` | f8 (H, W) | variance of the mean, summed over bins |
//! | `variance_frame` | f8 (T) | the same, summed over judged pixels |
//! | `opl_edges` | f8 (T + 1) | \[m\] |
//! | `provenance` | u1 (N) | JSON: program, commit, scene, seed, passes, seconds |

use std::fs;
use std::path::Path;
use std::time::Duration;

use half::f16;
use serde::{Deserialize, Serialize};
use tpb_film::archive::{ArchiveReader, ArchiveWriter, Compression};
use tpb_film::atomic_write;
use tpb_scene::load::LoadedScene;

use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::experiment::Context;
use crate::judged::Referee;
use crate::long_render::{LongMean, LongRender};
use crate::statistics::ReferenceNoise;
use crate::watch::Watch;

/// Half floats use this much of their range.
const LARGEST: f64 = 32_768.0;

/// Batches of a reference that ships, and the fewest.
const BATCHES: u32 = 32;
const FEWEST: u64 = 8;

/// Where a reference comes from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Program and version.
    pub program: String,
    /// Commit of the sources.
    pub commit: String,
    /// Method; older files do not say.
    #[serde(default = "path")]
    pub method: String,
    /// The scene with all defaults.
    pub scene: serde_json::Value,
    /// Seed.
    pub seed: u64,
    /// Passes.
    pub passes: u64,
    /// Camera paths.
    pub camera_paths: u64,
    /// Wall time \[s\].
    pub wall_seconds: f64,
    /// CPU time \[s\].
    pub cpu_seconds: Option<f64>,
}

fn path() -> String {
    "path".into()
}

/// A reference and what is known of its error.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceCube {
    /// The mean.
    pub cube: Cube,
    /// Which pixels are judged.
    pub mask: Vec<bool>,
    /// Variance of the mean, summed over a pixel's bins; rounding included.
    pub variance_pixel: Vec<f64>,
    /// The same per frame, summed over judged pixels.
    pub variance_frame: Vec<f64>,
    /// Edges of the bins \[m\].
    pub opl_edges: Vec<f64>,
    /// Where it comes from.
    pub provenance: Provenance,
}

impl ReferenceCube {
    /// Renders a reference for `time`.
    ///
    /// # Errors
    /// Those of [`LongRender::make`].
    pub fn make(
        scene: &LoadedScene,
        referee: Referee,
        time: Duration,
        seed: u64,
        commit: &str,
        watch: &mut Watch<'_>,
    ) -> Result<Self> {
        let reference = LongRender::reference(scene, referee, time, seed, commit);
        let made = LongRender { batches: BATCHES, fewest: FEWEST, ..reference }.make(watch)?;
        Ok(Self::of_long(&made))
    }

    /// What is kept of a long render.
    pub fn of_long(long: &LongMean) -> Self {
        let cube = Cube::of(&long.arrays);
        let mut variance_pixel = vec![0.0; cube.pixels()];
        let mut variance_frame = vec![0.0; cube.bins];
        for (index, &variance) in long.mean_variance.iter().enumerate() {
            let (pixel, bin) = (index / cube.bins, index % cube.bins);
            variance_pixel[pixel] += f64::from(variance);
            if long.judged[pixel] {
                variance_frame[bin] += f64::from(variance);
            }
        }
        let made = &long.made;
        let provenance = Provenance {
            program: concat!("tpb-validation ", env!("CARGO_PKG_VERSION")).into(),
            commit: made.commits.join(", "),
            method: made.method.clone(),
            scene: made.scene.clone(),
            seed: made.seed,
            passes: made.batches * made.passes,
            camera_paths: made.camera_paths,
            wall_seconds: made.wall_seconds,
            cpu_seconds: Some(made.cpu_seconds),
        };
        let mask = long.judged.clone();
        let opl_edges = long.arrays.opl_edges.clone();
        let mut reference =
            Self { cube, mask, variance_pixel, variance_frame, opl_edges, provenance };
        reference.round();
        reference
    }

    /// The reference of a shipped scene: the one that ships with it, else the one that an earlier
    /// run left in the context's output folder, else a new one, rendered for `time` and left there;
    /// a new one comes with a note that says so.
    pub fn of_shipped(
        loaded: &LoadedScene,
        name: &str,
        referee: Referee,
        context: &Context,
        time: Duration,
    ) -> Result<(Self, Option<String>)> {
        let made = context.made_reference_path(name);
        for path in [&context.reference_path(name), &made] {
            if path.exists() {
                let reference = Self::read(path)?;
                reference.check(loaded)?;
                if reference.provenance.method == referee.estimator().name() {
                    return Ok((reference, None));
                }
            }
        }
        let (seed, commit) = (context.seed ^ 0x5eed, "made for this run");
        let reference = Self::make(loaded, referee, time, seed, commit, &mut Watch::default())?;
        reference.write(&made)?;
        let note = format!("no reference was shipped: rendered one for {} s", time.as_secs());
        Ok((reference, Some(note)))
    }

    /// What the reference adds to errors over the pixels that `include` names.
    pub fn noise(&self, include: impl Fn(usize) -> bool) -> ReferenceNoise {
        let mut noise = ReferenceNoise::default();
        for pixel in (0..self.cube.pixels()).filter(|&pixel| include(pixel)) {
            let variance = self.variance_pixel[pixel];
            noise.power += self.cube.pixel_bins(pixel).iter().map(|r| r * r).sum::<f64>();
            noise.variance += variance;
            noise.squares += variance * variance;
            noise.largest = noise.largest.max(variance);
        }
        noise
    }

    /// Writes the file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<()> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|error| ValidationError::io(folder, error))?;
        }
        let Cube { width, height, bins, .. } = self.cube;
        let scale = self.scales();
        let halves: Vec<f16> = (0..self.cube.pixels())
            .flat_map(|pixel| self.cube.pixel_bins(pixel).iter().zip(&scale))
            .map(|(value, scale)| f16::from_f64(value / scale))
            .collect();
        let mask: Vec<u8> = self.mask.iter().map(|&judged| u8::from(judged)).collect();
        let provenance = serde_json::to_vec(&self.provenance)
            .map_err(|error| ValidationError::unusable("provenance", error))?;
        atomic_write(path, |file| {
            let mut npz = ArchiveWriter::new(file, Compression::Deflated);
            npz.put("transient", &[height, width, bins], &halves)?;
            npz.put("scale", &[bins], &scale)?;
            npz.put("mask", &[height, width], &mask)?;
            npz.put("variance_pixel", &[height, width], &self.variance_pixel)?;
            npz.put("variance_frame", &[bins], &self.variance_frame)?;
            npz.put("opl_edges", &[bins + 1], &self.opl_edges)?;
            npz.put("provenance", &[provenance.len()], &provenance)?;
            npz.finish()
        })?;
        Ok(())
    }

    /// Reads what [`ReferenceCube::write`] wrote.
    pub fn read(path: &Path) -> Result<Self> {
        let broken = |reason: &str| ValidationError::unusable(path.display().to_string(), reason);
        let mut npz = ArchiveReader::open(path)?;
        let (shape, halves) = npz.required::<f16>("transient", None)?;
        let &[height, width, bins] = shape.as_slice() else {
            return Err(broken("`transient` does not have 3 dimensions"));
        };
        let scale = npz.required::<f64>("scale", None)?.1;
        let mask = npz.required::<u8>("mask", None)?.1;
        let variance_pixel = npz.required::<f64>("variance_pixel", None)?.1;
        let variance_frame = npz.required::<f64>("variance_frame", None)?.1;
        let opl_edges = npz.required::<f64>("opl_edges", None)?.1;
        let provenance = npz.required::<u8>("provenance", None)?.1;
        let pixels = width * height;
        let fits = bins > 0
            && (scale.len(), variance_frame.len(), opl_edges.len()) == (bins, bins, bins + 1)
            && (mask.len(), variance_pixel.len()) == (pixels, pixels);
        if !fits {
            return Err(broken("arrays of different sizes"));
        }
        let mut cube = Cube::zero(width, height, bins);
        for (pixel, halves) in halves.chunks_exact(bins).enumerate() {
            for ((cell, half), scale) in
                cube.pixel_mut(pixel)[1..].iter_mut().zip(halves).zip(&scale)
            {
                *cell = half.to_f64() * scale;
            }
        }
        Ok(Self {
            cube,
            mask: mask.iter().map(|&judged| judged != 0).collect(),
            variance_pixel,
            variance_frame,
            opl_edges,
            provenance: serde_json::from_slice(&provenance)
                .map_err(|error| ValidationError::unusable(path.display().to_string(), error))?,
        })
    }

    /// Refuses a scene that is not the one that the reference was made of.
    pub fn check(&self, scene: &LoadedScene) -> Result<()> {
        if self.provenance.scene == scene.canonical {
            return Ok(());
        }
        let reason = "the scene differs from the one that its reference was made of";
        Err(ValidationError::unusable("reference cube", reason))
    }

    fn scales(&self) -> Vec<f64> {
        let brightest = |bin: usize| {
            let values = (0..self.cube.pixels()).map(|pixel| self.cube.pixel_bins(pixel)[bin]);
            values.fold(0.0, f64::max)
        };
        let scale = |largest: f64| if largest > 0.0 { largest / LARGEST } else { 1.0 };
        (0..self.cube.bins).map(|bin| scale(brightest(bin))).collect()
    }

    /// Rounds to half floats, and counts the error as variance.
    fn round(&mut self) {
        let scales = self.scales();
        for pixel in 0..self.cube.pixels() {
            for (bin, scale) in scales.iter().enumerate() {
                let cell = &mut self.cube.pixel_mut(pixel)[bin + 1];
                let rounded = f16::from_f64(*cell / scale).to_f64() * scale;
                let error = (rounded - *cell) * (rounded - *cell);
                *cell = rounded;
                self.variance_pixel[pixel] += error;
                if self.mask[pixel] {
                    self.variance_frame[bin] += error;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reference() -> ReferenceCube {
        let mut cube = Cube::zero(3, 2, 4);
        for pixel in 0..6 {
            for (bin, cell) in cube.pixel_mut(pixel)[1..=4].iter_mut().enumerate() {
                // Frames of very different brightness.
                *cell = (pixel as f64 + 0.123_456) * 1e-6_f64.powf(bin as f64);
            }
        }
        let mut reference = ReferenceCube {
            cube,
            mask: vec![true, false, true, true, true, true],
            variance_pixel: vec![0.0; 6],
            variance_frame: vec![0.0; 4],
            opl_edges: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            provenance: Provenance {
                program: "test".into(),
                commit: "none".into(),
                method: path(),
                scene: serde_json::json!({"type": "scene"}),
                seed: 1,
                passes: 2,
                camera_paths: 3,
                wall_seconds: 4.0,
                cpu_seconds: None,
            },
        };
        reference.round();
        reference
    }

    #[test]
    fn a_file_gives_back_what_was_written() {
        let folder = std::env::temp_dir().join(format!("tpb-reference-{}", std::process::id()));
        let path = folder.join("cube.npz");
        let reference = reference();
        reference.write(&path).unwrap();
        let back = ReferenceCube::read(&path).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(back, reference);
    }

    #[test]
    fn rounding_is_small_in_bright_and_dark_frames_and_counted_as_variance() {
        let reference = reference();
        for bin in 0..4 {
            let exact = 5.123_456 * 1e-6_f64.powi(bin);
            let kept = reference.cube.pixel_bins(5)[bin as usize];
            assert!((kept / exact - 1.0).abs() < 5e-4, "bin {bin}");
        }
        let noise = reference.noise(|pixel| reference.mask[pixel]);
        let frames: f64 = reference.variance_frame.iter().sum();
        assert!(noise.variance > 0.0 && (noise.variance / frames - 1.0).abs() < 1e-12);
        assert!(noise.variance < 1e-6 * noise.power);
    }
}
