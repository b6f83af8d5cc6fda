//! The mean of batches with its measured noise, and its file.
//!
//! For errors, which are of the mean over channels, variance is also measured for the mean over
//! channels, so that nothing need be known of how channels go together; and for the energy of a
//! pixel within the window, whose bins go together.
//!
//! The file is a result like any other (`transient`, `variance`, `opl_edges`, … as in
//! `transient.npz`) with further keys:
//!
//! | key | type, shape | |
//! | --- | --- | --- |
//! | `mean_variance` | f4 (H, W, T) | variance of the mean over channels |
//! | `window_variance` | f8 (H, W) | variance of the sum over bins of the mean over channels |
//! | `judged` | u1 (H, W) | 1: judged ([`crate::judged`]) |
//! | `provenance` | u1 (N) | JSON: scene, method, seed, batches, passes, seconds, commits, commands, values |

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use tpb_film::archive::{ArchiveReader, ArchiveWriter, Compression};
use tpb_film::{Arrays, atomic_write};
use tpb_render::RunSummary;

use crate::error::{Result, ValidationError};

/// Where a long render comes from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// Method; older files do not say.
    #[serde(default = "path")]
    pub method: String,
    /// The method with its options, as text; older files do not say, and were made with defaults.
    #[serde(default)]
    pub estimator: Option<String>,
    /// The scene with all defaults.
    pub scene: Value,
    /// Seed.
    pub seed: u64,
    /// Batches.
    pub batches: u64,
    /// Passes of a batch.
    pub passes: u64,
    /// Camera paths of all.
    pub camera_paths: u64,
    /// Wall time of all \[s\].
    pub wall_seconds: f64,
    /// CPU time of all \[s\].
    pub cpu_seconds: f64,
    /// Commits of the sources that made it.
    pub commits: Vec<String>,
    /// Commands that made it, as far as they are known.
    #[serde(default)]
    pub commands: Vec<String>,
    /// What was asked of each batch.
    #[serde(default)]
    pub values: Vec<Vec<f64>>,
}

fn path() -> String {
    "path".into()
}

impl Made {
    /// Counts what a batch took.
    pub(super) fn count(&mut self, summary: &RunSummary, commit: &str, command: &str) {
        self.camera_paths += summary.counts.camera_paths;
        self.wall_seconds += summary.wall_seconds;
        self.cpu_seconds += summary.cpu_seconds.unwrap_or(summary.wall_seconds);
        for (list, one) in [(&mut self.commits, commit), (&mut self.commands, command)] {
            if !one.is_empty() && list.last().is_none_or(|last| last != one) {
                list.push(one.to_owned());
            }
        }
    }
}

/// A mean of batches and what is known of its error.
#[derive(Clone)]
pub struct LongMean {
    /// The mean, with the variance of the mean.
    pub arrays: Arrays,
    /// Variance of the mean over channels, (pixel, bin).
    pub mean_variance: Vec<f32>,
    /// Variance of a pixel's energy within the window, averaged over channels.
    pub window_variance: Vec<f64>,
    /// Which pixels are judged.
    pub judged: Vec<bool>,
    /// Where it comes from.
    pub made: Made,
}

impl LongMean {
    /// Of no batches yet, with the shape and the edges of one.
    pub(super) fn empty(batch: &Arrays, judged: Vec<bool>, made: Made) -> Self {
        let mut arrays = batch.clone();
        arrays.variance = Some(vec![0.0; arrays.transient.len()]);
        Self {
            mean_variance: vec![0.0; batch.pixels() * batch.bins],
            window_variance: vec![0.0; batch.pixels()],
            judged,
            made,
            arrays,
        }
    }

    /// Reads a file that [`super::LongRender::obtain`] wrote.
    pub fn read(path: &Path) -> Result<Self> {
        let arrays = Arrays::read_npz(path)?;
        let mut npz = ArchiveReader::open(path)?;
        let image = [arrays.height, arrays.width];
        let cube = [arrays.height, arrays.width, arrays.bins];
        let judged = npz.required::<u8>("judged", Some(&image))?.1;
        let made = npz.required::<u8>("provenance", None)?.1;
        Ok(Self {
            mean_variance: npz.required("mean_variance", Some(&cube))?.1,
            window_variance: npz.required("window_variance", Some(&image))?.1,
            judged: judged.iter().map(|&judged| judged != 0).collect(),
            made: serde_json::from_slice(&made)
                .map_err(|e| ValidationError::unusable(path.display().to_string(), e))?,
            arrays,
        })
    }

    pub(super) fn write(&self, path: &Path) -> Result<()> {
        let a = &self.arrays;
        let made = serde_json::to_vec(&self.made)
            .map_err(|e| ValidationError::unusable("provenance", e))?;
        let (image, cube) = ([a.height, a.width], [a.height, a.width, a.bins]);
        let (colours, cells) =
            ([a.height, a.width, a.channels], [a.height, a.width, a.bins, a.channels]);
        let judged: Vec<u8> = self.judged.iter().map(|&judged| u8::from(judged)).collect();
        atomic_write(path, |file| {
            let mut npz = ArchiveWriter::new(file, Compression::Stored);
            npz.put("transient", &cells, &a.transient)?;
            if let Some(variance) = &a.variance {
                npz.put("variance", &cells, variance)?;
            }
            npz.put("opl_edges", &[a.opl_edges.len()], &a.opl_edges)?;
            npz.put("time_edges", &[a.opl_edges.len()], &a.time_edges())?;
            for (name, values) in
                [("before", &a.before), ("after", &a.after), ("steady", &a.steady)]
            {
                npz.put(name, &colours, values)?;
            }
            npz.put("mean_variance", &cube, &self.mean_variance)?;
            npz.put("window_variance", &image, &self.window_variance)?;
            npz.put("judged", &image, &judged)?;
            npz.put("provenance", &[made.len()], &made)?;
            npz.finish()
        })?;
        Ok(())
    }

    /// Adds a batch to means and variances.
    pub(super) fn add(&mut self, batch: &Arrays) {
        let n = self.made.batches as f64 + 1.0;
        let channels = self.arrays.channels;
        let mean = |cell: &[f32]| cell.iter().map(|&v| f64::from(v)).sum::<f64>() / channels as f64;
        for pixel in 0..batch.pixels() {
            let size = batch.bins * channels;
            let (mut before, mut after) = (0.0, 0.0);
            let cells = self.arrays.transient[pixel * size..].chunks_exact(channels);
            for ((old, new), variance) in cells
                .zip(batch.pixel(pixel).chunks_exact(channels))
                .zip(&mut self.mean_variance[pixel * batch.bins..])
            {
                *variance = next_variance(f64::from(*variance), mean(old), mean(new), n) as f32;
                before += mean(old);
                after += mean(new);
            }
            let variance = &mut self.window_variance[pixel];
            *variance = next_variance(*variance, before, after, n);
        }
        let variances = self.arrays.variance.get_or_insert_default();
        for ((mean, variance), &new) in
            self.arrays.transient.iter_mut().zip(variances).zip(&batch.transient)
        {
            let (old, new) = (f64::from(*mean), f64::from(new));
            *variance = next_variance(f64::from(*variance), old, new, n) as f32;
            *mean = (old + (new - old) / n) as f32;
        }
        let a = &mut self.arrays;
        for (mean, new) in [
            (&mut a.before, &batch.before),
            (&mut a.after, &batch.after),
            (&mut a.steady, &batch.steady),
        ] {
            for (mean, new) in mean.iter_mut().zip(new) {
                *mean += (new - *mean) / n;
            }
        }
        self.made.batches += 1;
    }
}

/// The variance of the mean of n values, from that of the first n − 1, their mean, and the last one;
/// of one value, 0. With M = Σ(x − x̄)², variance = M/(n(n − 1)) and ΔM = (x − x̄)² (n − 1)/n.
fn next_variance(variance: f64, mean: f64, value: f64, n: f64) -> f64 {
    if n < 2.0 {
        return 0.0;
    }
    let before = variance * (n - 1.0) * (n - 2.0);
    let more = (value - mean) * (value - mean) * (n - 1.0) / n;
    (before + more) / (n * (n - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variance_of_a_mean_grows_value_by_value() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0];
        let (mut variance, mut mean) = (0.0, 0.0);
        for (index, value) in values.iter().enumerate() {
            let n = index as f64 + 1.0;
            variance = next_variance(variance, mean, *value, n);
            mean += (value - mean) / n;
        }
        // Mean 2.8, squares 12.8: 12.8/(5·4).
        assert!((mean - 2.8_f64).abs() < 1e-15 && (variance - 0.64_f64).abs() < 1e-15);
    }
}
