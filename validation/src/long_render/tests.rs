//! Batches of a tiny film against a single render of all their passes.

use std::sync::atomic::{AtomicBool, Ordering};

use tpb_film::FilmOptions;

use super::*;
use crate::measure::render_keeping;
use crate::reference_cube::ReferenceCube;
use crate::reproduce::load;

/// *Cornell blocks* on 8x8 pixels and 20 bins.
fn scene() -> LoadedScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/cornell-blocks.json");
    let changes = ["width=8", "height=8", "temporal_bins=20", "bin_width_opl=0.7"]
        .map(|change| format!("sensor.film.{change}"));
    load(&path, &changes).unwrap()
}

/// Batches of two passes; no clock decides.
fn order<'a>(loaded: &'a LoadedScene, values: &'a Values<'a>) -> LongRender<'a> {
    LongRender {
        passes: Some(2),
        fewest: 6,
        values,
        ..LongRender::reference(loaded, Referee::Path, Duration::ZERO, 5, "test")
    }
}

fn sum(values: &[f32]) -> f64 {
    values.iter().map(|&v| f64::from(v)).sum()
}

#[test]
fn the_mean_of_batches_is_one_render_of_all_passes() {
    let loaded = scene();
    let energy = |arrays: &Arrays| vec![sum(&arrays.transient)];
    let mean = order(&loaded, &energy).make(&mut Watch::default()).unwrap();
    assert_eq!((mean.made.batches, mean.made.passes), (6, 2));

    let plan = Plan::new(&loaded.scene, &loaded.scene.integrator);
    let path = Referee::Path.estimator();
    let method = path.prepare::<3>(&loaded.scene, &plan, loaded.scene.integrator).unwrap();
    let settings = RunSettings { seed: 5, budget: Budget::Passes(12), first_pass: 0 };
    let options = FilmOptions { variance: true, ..FilmOptions::default() };
    let layout = layout(&loaded.scene.film, 0.0).unwrap();
    let (single, _) = render_keeping(&*method, layout, options, &settings).unwrap();
    for (batched, single) in mean.arrays.transient.iter().zip(&single.transient) {
        assert!((batched - single).abs() <= 2e-6 * single.abs(), "{batched} {single}");
    }
    for (batched, single) in mean.arrays.steady.iter().zip(&single.steady) {
        assert!((batched - single).abs() <= 1e-12 * single.abs(), "{batched} {single}");
    }
    // The noise that 6 batches and 12 passes show, added over 3840 cells. Seed and passes are fixed:
    // what is asserted was measured, and says that they are the same quantity.
    let variance = |arrays: &Arrays| sum(arrays.variance.as_ref().unwrap());
    let ratio = variance(&mean.arrays) / variance(&single);
    assert!((0.6..1.6).contains(&ratio), "{ratio}");

    // The small file holds the mean over channels, and the same noise of it.
    let cube = ReferenceCube::of_long(&mean);
    assert_eq!((cube.provenance.passes, cube.provenance.method.as_str()), (12, "path"));
    for pixel in 0..64 {
        for (kept, exact) in
            cube.cube.pixel_bins(pixel).iter().zip(mean.arrays.pixel(pixel).chunks_exact(3))
        {
            let exact = sum(exact) / 3.0;
            assert!((kept - exact).abs() <= 5e-4 * exact, "{kept} {exact}");
        }
    }
    let noise: f64 = cube.variance_pixel.iter().sum();
    let measured = sum(&mean.mean_variance);
    assert!(noise >= measured && noise < 1.001 * measured, "{noise} {measured}: rounding is added");

    // What is asked of each batch.
    let energies: Vec<f64> = mean.made.values.iter().map(|values| values[0]).collect();
    let whole = sum(&mean.arrays.transient);
    assert!((energies.iter().sum::<f64>() / 6.0 / whole - 1.0).abs() < 1e-6);
}

#[test]
fn an_interrupted_render_goes_on_to_the_same_bits() {
    let loaded = scene();
    let folder = std::env::temp_dir().join(format!("tpb-long-render-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let order = order(&loaded, &no_values);
    let whole = order.make(&mut Watch::default()).unwrap();

    let (stop, mut told) = (AtomicBool::new(false), 0);
    let mut tell = |_: &str| {
        told += 1;
        stop.store(told == 3, Ordering::Relaxed);
    };
    let path = folder.join("kept.npz");
    let ended = order.obtain(&path, &mut Watch::new(&mut tell).with_stop(&stop));
    assert!(matches!(ended, Err(ValidationError::Interrupted)));
    assert_eq!(LongMean::read(&path).unwrap().made.batches, 3);
    let resumed = order.obtain(&path, &mut Watch::default()).unwrap();
    assert!(resumed.arrays == whole.arrays);
    assert_eq!(resumed.window_variance, whole.window_variance);
    assert_eq!(resumed.made.values.len(), 6);

    // Other sources do not go on with what is measured, but with a truth.
    let mut told = String::new();
    let mut tell = |line: &str| told.push_str(line);
    let mut watch = Watch::new(&mut tell);
    LongRender { commit: "other", own: true, ..order }.obtain(&path, &mut watch).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(!told.contains("are there already") && told.contains("1 batches"), "{told}");
}
