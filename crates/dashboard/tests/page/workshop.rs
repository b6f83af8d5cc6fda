//! A folder as other tasks leave it, with numbers that are known.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;
use tpb_dashboard::{Planned, Shelf, Sources};

/// Exponents and sizes of the two methods' power laws: NMSE = size · seconds^exponent.
pub(crate) const LAWS: [(&str, f64, f64); 2] = [("path", -1.0, 0.5), ("beams", -0.8, 0.02)];

/// CPU seconds per wall second.
pub(crate) const PROCESSORS: f64 = 1.6;

/// Half width of the intervals of each method, as a share of the value.
pub(crate) const HALVES: [f64; 2] = [0.2, 0.1];

/// A folder that is removed at the end.
pub(crate) struct Workshop {
    folder: TempDir,
}

impl Workshop {
    /// Nothing in it.
    pub(crate) fn empty() -> Self {
        Self { folder: tempfile::Builder::new().prefix("a workshop, 100 %").tempdir().unwrap() }
    }

    /// Runs, errors, benchmarks and a page.
    pub(crate) fn full() -> Self {
        let workshop = Self::empty();
        workshop.put("history.jsonl", &runs());
        workshop.put("error-time/box.json", &scene("box").to_string());
        workshop.put("error-time/hall.json", &scene("hall").to_string());
        workshop.put("error-time/torn.json", "{\"scene\":");
        workshop.put("benchmarks.jsonl", &benchmarks());
        workshop.put("bench-runs.jsonl", &bench_runs());
        workshop.put("reproduce/index.html", "<title>All &amp; more</title>");
        workshop.put("reproduce/box/index.html", "<title>The box</title>");
        workshop.put("left/wrong.svg", PICTURE);
        workshop
    }

    fn put(&self, name: &str, text: &str) {
        let file = self.path(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn root(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn sources(&self) -> Sources {
        let shelf = |title: &str, folder: &str| Shelf {
            title: title.into(),
            folder: self.path(folder),
            command: format!("cargo xtask {folder}"),
        };
        Sources {
            commit: "0123456789ab-dirty".into(),
            machine: "a machine".into(),
            root: self.root().to_owned(),
            plan: plan(),
            histories: vec![self.path("history.jsonl"), self.path("none.jsonl")],
            benchmarks: vec![self.path("benchmarks.jsonl")],
            bench_runs: vec![self.path("bench-runs.jsonl")],
            error_time: self.path("error-time"),
            shelves: vec![shelf("Scenes", "reproduce"), shelf("Gallery", "gallery")],
            out: self.path("dashboard"),
        }
    }
}

const PICTURE: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="30"><rect width="40" height="30" fill="red"/></svg>"#;

fn plan() -> Vec<Planned> {
    let planned = |name: &str, quick| Planned {
        name: name.into(),
        description: format!("compares {name} </script> with theory"),
        quick,
    };
    vec![
        planned("samplers/phase", true),
        planned("control/warp/samplers/phase", true),
        planned("matrix/fog/path", true),
        planned("control/late/matrix/fog/path", true),
        planned("control/loss/matrix/fog/path", false),
        planned("matrix/fog/beams-1d", true),
        planned("control/kernel/matrix/fog/beams-1d", true),
        planned("matrix/room/path", false),
        planned("glass/clock", true),
    ]
}

fn record(name: &str, verdict: &str, interval: &Value, p: &Value) -> Value {
    json!({ "name": name, "verdict": verdict, "seconds": 2.5, "interval": interval, "p": p,
            "batches": 64, "contrasts": 3, "notes": [format!("a note on {name}")] })
}

/// Three runs, the second with a torn end; the third of some experiments only.
fn runs() -> String {
    let run = |time: u64, commit: &str, records: Vec<Value>| {
        json!({ "time": time, "commit": commit, "machine": "a machine, 2 threads", "seed": 1,
                "flags": "validate --quick", "effort": "quick", "seconds": 100.0,
                "false_alarm": 1e-7, "nominal": 1e-6, "unresolved": 0.01, "records": records })
        .to_string()
    };
    let path =
        |low: f64, high: f64| record("matrix/fog/path", "passed", &json!([low, high]), &json!(0.5));
    let late = record("control/late/matrix/fog/path", "passed", &json!([0.1, 0.2]), &json!(1e-30));
    let mut failed = record("matrix/fog/beams-1d", "failed", &json!([0.012, 0.034]), &json!(1e-9));
    failed["table"] = json!(["method   NMSE", "beams  1.3e-2 < 2"]);
    failed["repeat"] = json!("cargo xtask validate --seed 1 --filter 'matrix/fog/beams-1d'");
    failed["files"] = json!(["left/wrong.svg", "left/gone.png"]);
    failed["notes"] = json!(["most significant: bin 12 (z = 9.1)"]);
    let kernel =
        record("control/kernel/matrix/fog/beams-1d", "failed", &json!([0.0, 0.01]), &json!(0.2));
    let broken = json!({ "name": "glass/clock", "verdict": "broken", "seconds": 0.01,
                         "error": "the scene <b>cannot</b> be read" });
    [
        run(1_700_000_000, "aaaaaaaaaaaa", vec![path(-0.004, 0.001), late.clone(), broken]),
        "{\"time\": 1700000100, \"commit\": \"torn".to_owned(),
        run(
            1_700_003_600,
            "bbbbbbbbbbbb-dirty",
            vec![
                record("samplers/phase", "passed", &Value::Null, &json!(0.6)),
                record("control/warp/samplers/phase", "failed", &Value::Null, &json!(0.3)),
                path(-0.003, 0.002),
                late,
                failed,
                kernel,
                record("old/experiment", "passed", &Value::Null, &Value::Null),
            ],
        ),
        run(1_700_007_200, "cccccccccccc", vec![path(-0.002, 0.003)]),
    ]
    .join("\n")
}

/// Errors that follow their laws exactly.
fn scene(name: &str) -> Value {
    let curve = |(&(method, exponent, size), half): (&(&str, f64, f64), f64)| {
        let estimate = |value: f64| {
            json!({ "value": value, "standard_error": 0.1 * value,
                    "interval": [value * (1.0 - half), value * (1.0 + half)] })
        };
        let checkpoints: Vec<Value> = (0..6)
            .map(|k| {
                let wall = 0.1 * 2.0_f64.powi(k);
                let cpu = wall * PROCESSORS;
                let nmse = size * cpu.powf(exponent);
                json!({ "passes": 1 << k, "wall_seconds": wall, "cpu_seconds": cpu,
                    "rmse": estimate(nmse.sqrt()), "nmse": estimate(nmse),
                    "variance": estimate(0.9 * nmse),
                    // Negative by chance at first, then resolved.
                    "squared_bias": if k < 3 { json!({ "value": -1e-6, "interval": [-1e-5, 1e-6] }) }
                                    else { estimate(0.1 * nmse) },
                    "inverse_efficiency": estimate(0.9 * nmse * cpu) })
            })
            .collect();
        json!({ "method": method, "options": { "rays": 9 }, "setup_seconds": 0.01,
                "checkpoints": checkpoints,
                "slope": { "value": exponent, "interval": [exponent - 0.05, exponent + 0.05] },
                "variance_slope": null })
    };
    let curves: Vec<Value> = LAWS.iter().zip(HALVES).map(curve).collect();
    json!({ "scene": name, "reference": { "commit": "rrrrrrrrrrrr", "scene": {}, "cpu_seconds": 960.0 },
            "reference_nmse": 7e-4, "pixels": [4033, 4096], "replicates": 8, "seed": 1, "threads": 2,
            "circumstances": { "commit": "eeee", "machine": "its machine", "flags": "error-time" },
            "curves": curves })
}

/// Two runs of one machine, between them one of another; the second counts more and is slower.
fn bench_runs() -> String {
    let run = |time: u64,
               commit: &str,
               machine: &str,
               slower: f64,
               counted: Value,
               costs: Value| {
        let command = "tpb render box.json";
        let case = |name: &str, counted: Value| {
            json!({ "name": name, "command": command, "passes": 4, "cpu_seconds": 2.0 * slower,
                    "wall_seconds": 2.0, "vectors": "AVX-512", "rates": { "pairs": 1e7 / slower, "paths": 5.0 },
                    "counted": counted })
        };
        json!({ "time": time, "commit": commit, "machine": machine, "build": "release",
                "cases": [case("box, beams", counted), case("box, path", Value::Null)],
                "costs": costs })
        .to_string()
    };
    let counted = |instructions: f64| {
        json!({ "command": "tpb render box.json --passes=1", "instructions": instructions,
                "work": { "pairs": 1e6 }, "tool": "callgrind", "vectors": "AVX2" })
    };
    let cost = json!([{ "name": "cost/media", "sides": ["media in the program", "compiled out"],
                        "instructions": [103e6, 100e6], "at_most": 1.02 }]);
    [
        run(1_700_000_000, "aaaaaaaaaaaa", "a machine", 1.0, counted(300e6), cost),
        run(1_700_003_600, "bbbbbbbbbbbb", "another", 9.0, counted(900e6), json!([])),
        run(1_700_007_200, "cccccccccccc", "a machine", 1.25, counted(303e6), json!([])),
    ]
    .join("\n")
}

fn benchmarks() -> String {
    let line = |time: u64, commit: &str, bench: &str, nanoseconds: f64, elements: Value| {
        json!({ "time": time, "commit": commit, "commit_by": "time", "machine": "a machine",
                "bench": bench, "nanoseconds": nanoseconds,
                "interval": [0.99 * nanoseconds, 1.01 * nanoseconds], "confidence": 0.95,
                "statistic": "slope", "elements": elements })
        .to_string()
    };
    [
        line(1_700_000_000, "aaaaaaaaaaaa", "gather/tiles", 5e6, json!(100_000)),
        line(1_700_003_600, "bbbbbbbbbbbb", "gather/tiles", 4e6, json!(100_000)),
        line(1_700_003_600, "bbbbbbbbbbbb", "paths/room", 2.5e9, Value::Null),
        line(1_700_007_200, "cccccccccccc", "gather/tiles", 4.4e6, json!(100_000)),
    ]
    .join("\n")
}
