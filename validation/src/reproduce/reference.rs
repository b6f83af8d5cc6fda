//! The long render that a comparison at picture quality is judged by, made in batches.
//!
//! A reference is the mean of K batches of the unbiased path tracer, with as many passes each, one
//! after the other with one seed: it is what a single render of all passes would be. Its own noise is
//! measured, not modelled: the variance of the mean of K batches is Σ(x − x̄)²/(K(K − 1)), without bias
//! for every cell, and precise once summed over many. For errors, which are of the mean over
//! channels, that is done for the mean over channels, so that nothing need be known of how channels
//! go together; and for the energy of a pixel within the window, whose bins go together.
//!
//! The file is written after each batch: nothing is lost by an interruption, and a later run adds
//! batches until it has been rendered for as long as asked. It is a result like any other
//! (`transient`, `variance`, `opl_edges`, … as in `transient.npz`) with further keys:
//!
//! | key | type, shape | |
//! | --- | --- | --- |
//! | `mean_variance` | f4 (H, W, T) | variance of the mean over channels |
//! | `window_variance` | f8 (H, W) | variance of the sum over bins of the mean over channels |
//! | `judged` | u1 (H, W) | 1: judged ([`crate::judged`]) |
//! | `provenance` | u1 (N) | JSON: scene, seed, batches, passes, seconds, commit |

use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use tpb_film::archive::{ArchiveReader, ArchiveWriter, Compression};
use tpb_film::{Arrays, atomic_write};
use tpb_path::PathOptions;
use tpb_render::{Budget, RunSettings};
use tpb_scene::load::LoadedScene;
use tpb_scene::{Plan, Transport};

use crate::error::{Result, ValidationError};
use crate::judged::Referee;
use crate::measure::{Estimator, layout, render};

/// Batches that a new reference is made in.
const BATCHES: u32 = 8;
/// Fewer do not tell their variance.
const FEWEST: u64 = 4;

/// Where a reference comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Made {
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
}

impl Made {
    /// Whether another batch brings the wall time closer to what is wanted \[s\].
    fn wants_more(&self, wanted: f64) -> bool {
        let batch = self.wall_seconds / self.batches as f64;
        self.batches < FEWEST || self.wall_seconds + 0.5 * batch < wanted
    }
}

/// A reference and what is known of its error.
pub struct LongReference {
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

impl LongReference {
    /// The reference of a scene, rendered for `time` at least: what the file has, and as many
    /// batches more as are missing. `say` is told of each.
    pub fn obtain(
        loaded: &LoadedScene,
        path: &Path,
        time: Duration,
        seed: u64,
        commit: &str,
        say: &mut dyn FnMut(&str),
    ) -> Result<Self> {
        match Plan::new(&loaded.scene, &loaded.scene.integrator).transport {
            Transport::Mono => obtain::<1>(loaded, path, time, seed, commit, say),
            Transport::Rgb => obtain::<3>(loaded, path, time, seed, commit, say),
        }
    }

    /// Reads a file that [`LongReference::obtain`] wrote.
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

    fn write(&self, path: &Path) -> Result<()> {
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
    fn add(&mut self, batch: &Arrays) {
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

fn obtain<const C: usize>(
    loaded: &LoadedScene,
    path: &Path,
    time: Duration,
    seed: u64,
    commit: &str,
    say: &mut dyn FnMut(&str),
) -> Result<LongReference> {
    let scene = &loaded.scene;
    let kept = if path.exists() { LongReference::read(path).ok() } else { None };
    let mut reference = kept.filter(|kept| kept.made.scene == loaded.canonical);
    if let Some(LongReference { made: Made { batches, wall_seconds, .. }, .. }) = &reference {
        say(&format!("  reference: {batches} batches, {wall_seconds:.0} s, are there already"));
    }
    let plan = Plan::new(scene, &scene.integrator);
    let method =
        Estimator::Path(PathOptions::default()).prepare::<C>(scene, &plan, scene.integrator)?;
    let wanted = time.as_secs_f64();
    while reference.as_ref().is_none_or(|reference| reference.made.wants_more(wanted)) {
        let settings = match &reference {
            None => RunSettings { seed, budget: Budget::Time(time / BATCHES), first_pass: 0 },
            Some(LongReference { made, .. }) => RunSettings {
                seed: made.seed,
                budget: Budget::Passes(made.passes),
                first_pass: made.batches * made.passes,
            },
        };
        let (arrays, summary) = render(&*method, layout(&scene.film, 0.0)?, &settings)?;
        let whole = match &mut reference {
            Some(whole) => whole,
            none => none.insert(begin::<C>(loaded, &arrays, seed, summary.passes)?),
        };
        whole.add(&arrays);
        drop(arrays);
        whole.made.camera_paths += summary.counts.camera_paths;
        whole.made.wall_seconds += summary.wall_seconds;
        whole.made.cpu_seconds += summary.cpu_seconds.unwrap_or(summary.wall_seconds);
        if whole.made.commits.last().is_none_or(|last| last != commit) {
            whole.made.commits.push(commit.to_owned());
        }
        whole.write(path)?;
        let Made { batches, passes, wall_seconds, .. } = whole.made;
        say(&format!(
            "  reference: batch {batches} of {passes} passes; {wall_seconds:.0} s of {wanted:.0} s"
        ));
    }
    reference.ok_or_else(|| ValidationError::unusable("reference", "no batch was made"))
}

/// An empty reference with the shape of a batch.
fn begin<const C: usize>(
    loaded: &LoadedScene,
    batch: &Arrays,
    seed: u64,
    passes: u64,
) -> Result<LongReference> {
    if batch.bins == 0 {
        return Err(ValidationError::unusable("reference", "the scene's film has no time bins"));
    }
    let mut arrays = batch.clone();
    arrays.variance = Some(vec![0.0; arrays.transient.len()]);
    Ok(LongReference {
        mean_variance: vec![0.0; batch.pixels() * batch.bins],
        window_variance: vec![0.0; batch.pixels()],
        judged: Referee::Path.judged::<C>(&loaded.scene)?,
        made: Made {
            scene: loaded.canonical.clone(),
            seed,
            batches: 0,
            passes,
            camera_paths: 0,
            wall_seconds: 0.0,
            cpu_seconds: 0.0,
            commits: Vec::new(),
        },
        arrays,
    })
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
