use super::slope::{Resolved, slope};
use super::{Checkpoint, Curve, ErrorAgainstTime};
use crate::reference_cube::Provenance;
use crate::statistics::split::Estimate;
use crate::statistics::{Gram, ReferenceNoise};
use crate::suite::Circumstances;

const NO_NOISE: ReferenceNoise =
    ReferenceNoise { power: 1.0, variance: 0.0, squares: 0.0, largest: 0.0 };

/// Residuals of four replicates whose size falls as seconds^exponent.
fn checkpoint(seconds: f64, exponent: f64) -> Resolved {
    let size = seconds.powf(0.5 * exponent);
    let residuals: Vec<Vec<f64>> = (0..4)
        .map(|i| (0..8).map(|cell| if cell % 4 == i { size } else { 0.0 }).collect())
        .collect();
    Resolved::new(&Gram::of(&residuals), &NO_NOISE, &[seconds; 4], 0)
}

#[test]
fn a_power_law_has_its_exponent_as_slope() {
    for exponent in [-1.0, -0.8, 0.0] {
        let points: Vec<Resolved> =
            (0..6).map(|k| checkpoint(0.1 * 2.0_f64.powi(k), exponent)).collect();
        let slope = slope(&points, 0.95).unwrap();
        assert!((slope.value - exponent).abs() < 1e-12, "{slope:?}");
        assert!(slope.standard_error < 1e-12, "replicates of one size do not scatter");
    }
}

#[test]
fn one_checkpoint_has_no_slope() {
    assert!(slope(&[checkpoint(1.0, -1.0)], 0.95).is_none());
}

/// An estimate whose error is not known.
fn estimate(value: f64) -> Estimate {
    Estimate { value, standard_error: f64::INFINITY, interval: [0.5 * value, f64::INFINITY] }
}

#[test]
fn the_dashboard_reads_what_is_written() {
    let checkpoint = Checkpoint {
        passes: 4,
        wall_seconds: 0.5,
        cpu_seconds: 0.9,
        rmse: estimate(2.0),
        nmse: estimate(3.0),
        variance: estimate(4.0),
        squared_bias: estimate(-5.0),
        inverse_efficiency: estimate(6.0),
    };
    let found = ErrorAgainstTime {
        scene: "box".into(),
        reference: Provenance {
            camera_paths: 123,
            cpu_seconds: Some(7.5),
            ..Provenance::default()
        },
        reference_nmse: 1e-4,
        pixels: [3, 4],
        replicates: 8,
        seed: 2,
        threads: 2,
        circumstances: Circumstances { machine: "m".into(), ..Circumstances::default() },
        left_out: vec!["light: a reason".into()],
        curves: vec![Curve {
            method: "path".into(),
            options: serde_json::json!({ "samples": 9 }),
            setup_seconds: 0.1,
            checkpoints: vec![checkpoint],
            slope: Some(estimate(-1.0)),
            variance_slope: None,
        }],
    };
    let folder = std::env::temp_dir().join(format!("tpb-curves-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("box.json"), serde_json::to_string(&found).unwrap()).unwrap();
    let read = tpb_dashboard::curves::read(&folder).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(read.unread.is_empty(), "{:?}", read.unread);
    let scene = &read.scenes[0];
    assert_eq!((scene.scene.as_str(), scene.pixels, scene.replicates), ("box", [3, 4], 8));
    assert_eq!(
        (scene.reference.camera_paths, scene.reference.cpu_seconds),
        (Some(123.0), Some(7.5))
    );
    assert_eq!(scene.circumstances.as_ref().unwrap()["machine"], "m");
    let point = &scene.curves[0].checkpoints[0];
    assert_eq!((point.passes, point.wall_seconds, point.cpu_seconds), (4, 0.5, 0.9));
    let values =
        [&point.rmse, &point.nmse, &point.variance, &point.squared_bias, &point.inverse_efficiency];
    assert_eq!(values.map(|e| e.value), [2.0, 3.0, 4.0, -5.0, 6.0].map(Some));
    assert_eq!(point.nmse.interval, [Some(1.5), None]);
    assert_eq!(scene.curves[0].slope.as_ref().unwrap().value, Some(-1.0));
}
