//! The command that repeats a render, from its report.

use std::path::Path;

use serde_json::Value;
use tpb_film::Pulse;
use tpb_render::Report;
use tpb_scene::load::load_scene;

/// The command that makes a result again: same scene, film, depths, seed and number of passes.
pub(crate) fn command(report: &Report) -> String {
    let mut parts = vec![
        "tpb render".to_owned(),
        quoted(&report.scene.file),
        format!("--method {}", report.method.name),
        format!("--passes {}", report.run.passes),
        format!("--seed {}", report.options.run.seed),
    ];
    let method = &report.method;
    let deepest = method.max_depth.map_or_else(|| "-1".to_owned(), |depth| depth.to_string());
    parts.push(format!("--max-depth {deepest}"));
    parts.push(format!("--min-depth {} --rr-depth {}", method.min_depth, method.rr_depth));
    parts.extend(changes(report).into_iter().map(|change| format!("--set {}", quoted(&change))));
    parts.extend(flags(&report.method.options));
    if report.options.variance {
        parts.push("--variance".to_owned());
    }
    if report.options.unwarp {
        parts.push("--unwarp".to_owned());
    }
    if report.options.pulse != Pulse::Delta {
        parts.push(format!("--pulse {}", pulse(report.options.pulse)));
    }
    parts.join(" ")
}

/// Values by which the report's scene differs from its file, as `path=value`: what was set on the
/// command line. Depths and method have flags of their own. A file that is gone or no longer loads
/// cannot be compared: then those of the film.
fn changes(report: &Report) -> Vec<String> {
    let rendered = &report.scene.canonical;
    let mut changes = Vec::new();
    if let Ok(file) = load_scene(Path::new(&report.scene.file), &[]) {
        for (name, value) in rendered.as_object().into_iter().flatten() {
            if name != "integrator" {
                differences(name, &file.canonical[name], value, &mut changes);
            }
        }
    } else {
        let film = &rendered["sensor"]["film"];
        for key in ["width", "height", "temporal_bins", "start_opl", "bin_width_opl"] {
            differences(&format!("sensor.film.{key}"), &Value::Null, &film[key], &mut changes);
        }
    }
    changes
}

/// Adds what is at `path` in `new` and not the same in `old`.
fn differences(path: &str, old: &Value, new: &Value, changes: &mut Vec<String>) {
    match (old, new) {
        (Value::Object(old), Value::Object(new)) => {
            for (name, value) in new {
                let before = old.get(name).unwrap_or(&Value::Null);
                differences(&format!("{path}.{name}"), before, value, changes);
            }
        }
        _ if old == new => {}
        _ => changes.push(format!("{path}={new}")),
    }
}

/// Options that the command line has a flag for, by their names in reports.
const FLAGS: [(&str, &str); 17] = [
    ("kernel", "--kernel"),
    ("length", "--beam-length"),
    ("temporal", "--temporal"),
    ("radius", "--radius"),
    ("surface_radius", "--surface-radius"),
    ("caustic_radius", "--caustic-radius"),
    ("radius_exponent", "--radius-exponent"),
    ("surface_radius_exponent", "--surface-radius-exponent"),
    ("beam_photons", "--beam-photons"),
    ("gather_samples", "--gather-samples"),
    ("surface_samples", "--surface-samples"),
    ("lamp_samples", "--lamp-samples"),
    ("light_samples", "--light-samples"),
    ("thin_from", "--thin-from"),
    ("sampler", "--sampler"),
    ("photons_per_pass", "--photons"),
    ("samples_per_pass", "--samples-per-pass"),
];

/// The flags of effective options.
fn flags(options: &Value) -> Vec<String> {
    let of = |(name, flag): &(&str, &str)| match &options[*name] {
        Value::String(word) => Some(format!("{flag} {word}")),
        Value::Number(number) => Some(format!("{flag} {number}")),
        _ => None,
    };
    FLAGS.iter().filter_map(of).collect()
}

/// A word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// A pulse as `--pulse` takes it.
pub(crate) fn pulse(pulse: Pulse) -> String {
    // Full width at half maximum of a Gaussian: 2 √(2 ln 2) σ.
    const FWHM: f64 = 2.354_820_045_030_949_3;
    match pulse {
        Pulse::Delta => "delta".to_owned(),
        Pulse::Gaussian { sigma_s } => format!("gaussian:{}ps", sigma_s * FWHM * 1e12),
        Pulse::Box { width_s } => format!("box:{}ps", width_s * 1e12),
        Pulse::Continuous => "continuous".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn words_are_safe_in_a_shell() {
        assert_eq!(quoted("a/b-c.json"), "a/b-c.json");
        assert_eq!(quoted("my scene.json"), "'my scene.json'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }

    #[test]
    fn differences_are_named_by_their_paths() {
        let old = json!({ "fog": { "albedo": 0.8, "phase": { "g": 0.0 } }, "list": [1, 2] });
        let new = json!({ "fog": { "albedo": 0.5, "phase": { "g": 0.0 } }, "list": [1, 3] });
        let mut found = Vec::new();
        differences("scene", &old, &new, &mut found);
        assert_eq!(found, ["scene.fog.albedo=0.5", "scene.list=[1,3]"]);
    }
}
