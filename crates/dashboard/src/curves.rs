//! Errors against run time, as `cargo xtask error-time` writes them: one file per scene.
//!
//! What is read is what the page draws; the scene that a reference carries stays in the file.
//! Numbers that are not finite are `null` in the file and `None` here.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::DashboardError;

/// Errors of all methods on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Its name.
    pub scene: String,
    /// What errors are measured from.
    pub reference: Reference,
    /// NMSE of the reference itself.
    #[serde(default)]
    pub reference_nmse: Option<f64>,
    /// Pixels that are judged, and all.
    pub pixels: [usize; 2],
    /// Runs of each method.
    pub replicates: u64,
    /// Seed of the first.
    pub seed: u64,
    /// Threads that the methods ran on.
    pub threads: usize,
    /// Where and how it was measured, if that is told: `commit`, `machine`, `flags`.
    #[serde(default)]
    pub circumstances: Option<Value>,
    /// Methods that were left out, each with the reason.
    #[serde(default)]
    pub left_out: Vec<String>,
    /// One for each method.
    pub curves: Vec<Curve>,
}

/// How a reference was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Commit of the sources.
    #[serde(default)]
    pub commit: String,
    /// Camera paths in all.
    #[serde(default)]
    pub camera_paths: Option<f64>,
    /// CPU time \[s\].
    #[serde(default)]
    pub cpu_seconds: Option<f64>,
    /// Wall time \[s\].
    #[serde(default)]
    pub wall_seconds: Option<f64>,
}

/// The error of one method against run time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the method.
    pub method: String,
    /// Its effective options.
    #[serde(default)]
    pub options: Value,
    /// Wall time of its preparation \[s\].
    #[serde(default)]
    pub setup_seconds: Option<f64>,
    /// In the order of time.
    pub checkpoints: Vec<Checkpoint>,
    /// d ln NMSE/d ln CPU seconds.
    #[serde(default)]
    pub slope: Option<Estimate>,
    /// The same of the variance alone.
    #[serde(default)]
    pub variance_slope: Option<Estimate>,
}

/// A point of a curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Passes made.
    pub passes: u64,
    /// Wall time since the start \[s\].
    pub wall_seconds: f64,
    /// CPU time since the start \[s\].
    pub cpu_seconds: f64,
    /// Root of the mean squared error.
    pub rmse: Estimate,
    /// Normalised mean squared error.
    pub nmse: Estimate,
    /// Its part that is variance.
    pub variance: Estimate,
    /// Its part that is squared bias.
    pub squared_bias: Estimate,
    /// Variance times CPU seconds \[s\].
    pub inverse_efficiency: Estimate,
}

/// A value and its confidence interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: Option<f64>,
    /// The interval.
    pub interval: [Option<f64>; 2],
}

/// Scenes of a folder by name, and the files that could not be read with the reason.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scenes {
    /// What was read.
    pub scenes: Vec<Scene>,
    /// What was not, and why.
    pub unread: Vec<String>,
}

/// Reads all JSON files of a folder; one that does not exist has none.
///
/// # Errors
/// [`DashboardError::Io`] if the folder exists and cannot be read.
pub fn read(folder: &Path) -> Result<Scenes, DashboardError> {
    let mut found = Scenes::default();
    if !folder.is_dir() {
        return Ok(found);
    }
    let io = |error| DashboardError::io(folder, error);
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let path = entry.map_err(io)?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            files.push(path);
        }
    }
    files.sort();
    for file in files {
        let read = fs::read(&file).map_err(|error| error.to_string());
        let parsed = read.and_then(|bytes| {
            serde_json::from_slice(&bytes).map_err(|error| format!("no error-time result: {error}"))
        });
        match parsed {
            Ok(scene) => found.scenes.push(scene),
            Err(reason) => found.unread.push(format!("{}: {reason}", file.display())),
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_result_is_named_and_left_out() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(read(&folder.path().join("none")).unwrap(), Scenes::default());
        let estimate = r#"{"value":1e-3,"standard_error":null,"interval":[null,2e-3]}"#;
        let checkpoint = format!(
            r#"{{"passes":2,"wall_seconds":0.5,"cpu_seconds":1.0,"rmse":{estimate},"nmse":{estimate},
               "variance":{estimate},"squared_bias":{estimate},"inverse_efficiency":{estimate}}}"#
        );
        let text = format!(
            r#"{{"scene":"a","reference":{{"scene":{{}},"camera_paths":12,"cpu_seconds":null}},
               "reference_nmse":1e-5,"pixels":[3,4],"replicates":4,"seed":1,"threads":2,
               "curves":[{{"method":"path","options":{{}},"setup_seconds":0.0,
               "checkpoints":[{checkpoint}],"slope":null,"variance_slope":{estimate}}}]}}"#
        );
        fs::write(folder.path().join("a.json"), text).unwrap();
        fs::write(folder.path().join("b.json"), "{\"scene\":").unwrap();
        fs::write(folder.path().join("a-cpu.svg"), "<svg/>").unwrap();
        let found = read(folder.path()).unwrap();
        let point = &found.scenes[0].curves[0].checkpoints[0];
        assert_eq!(point.nmse, Estimate { value: Some(1e-3), interval: [None, Some(2e-3)] });
        assert_eq!(found.unread.len(), 1);
        assert!(found.unread[0].contains("b.json: no error-time result: "), "{:?}", found.unread);
    }
}
