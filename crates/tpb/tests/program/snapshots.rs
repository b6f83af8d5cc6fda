//! What the program says, word by word.

use serde_json::{Value, json};

use crate::{FEW, SMALL, assert_done, program, root, stdout, tpb};

#[test]
fn help() {
    let subcommands =
        ["", "render", "plan", "info", "view", "compare", "video", "reference", "schema"];
    for subcommand in subcommands {
        let arguments: Vec<&str> = subcommand.split_whitespace().chain(["--help"]).collect();
        let output = tpb(&root(), arguments);
        assert_done(&output);
        insta::assert_snapshot!(
            format!("help-{subcommand}").trim_end_matches('-'),
            stdout(&output)
        );
    }
}

#[test]
fn plans() {
    for scene in ["cornell-blocks", "infinite-point", "mirror-caustic", "mirror-caustic-point"] {
        for method in ["beams", "path", "light"] {
            let file = format!("validation/scenes/{scene}.json");
            let output = tpb(&root(), ["plan", &file, "--method", method]);
            assert_done(&output);
            insta::assert_snapshot!(format!("plan-{scene}-{method}"), stdout(&output));
        }
    }
}

#[test]
fn without_a_method_all_plans_are_shown_the_default_first() {
    let file = "validation/scenes/cornell-blocks.json";
    let plan = |more: &[&str]| stdout(&tpb(&root(), [&["plan", file], more].concat()));
    let [path, beams, light] = ["path", "beams", "light"].map(|name| plan(&["--method", name]));
    assert_eq!(plan(&[]), format!("{path}\n{beams}\n{light}"));
    assert_eq!(plan(&["--kernel", "2d", "--method", "beams"]).matches("method: ").count(), 1);
}

#[test]
fn the_plan_as_json_says_the_same() {
    let output = tpb(&root(), ["plan", "validation/scenes/infinite-point.json", "--json"]);
    assert_done(&output);
    let plan: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(plan["plan"]["media"], "scattering");
    assert_eq!(plan["film"]["width"], 64);
}

#[test]
fn reports() {
    let light = &["--method", "light", "--photons", "500"][..];
    for (method, options) in
        [("path", &["--method", "path"][..]), ("beams", &FEW[..]), ("light", light)]
    {
        let folder = tempfile::tempdir().unwrap();
        let mut command = program();
        command.current_dir(root()).arg("render").arg("validation/scenes/cornell-blocks.json");
        command.args(SMALL).args(options).args(["--passes", "2", "--seed", "3"]);
        assert_done(&command.arg("-o").arg(folder.path()).output().unwrap());
        let text = std::fs::read_to_string(folder.path().join("report.json")).unwrap();
        let mut report: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["scene"]["canonical"]["sensor"]["film"]["width"], 12);
        report["scene"]["canonical"] = json!("[the scene]");
        report["program"] = json!("[program and version]");
        report["vectors"] = json!("[vector instructions]");
        report["peak_memory_bytes"] = json!("[bytes]");
        for measured in ["run", "rates", "ledger_closure"] {
            hide_numbers(&mut report[measured]);
        }
        round_numbers(&mut report);
        insta::assert_snapshot!(format!("report-{method}"), format!("{report:#}"));
    }
}

/// Numbers that depend on the machine, or on the order of random numbers.
fn hide_numbers(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => *value = json!("[number]"),
        Value::Array(items) => items.iter_mut().for_each(hide_numbers),
        Value::Object(members) => {
            for (name, member) in members.iter_mut() {
                match name.as_str() {
                    "counts" => {
                        let counts = member.as_object_mut().into_iter().flatten();
                        counts.for_each(|(_, count)| *count = json!("[count]"));
                    }
                    _ => hide_numbers(member),
                }
            }
        }
        _ => {}
    }
}

/// To six digits.
fn round_numbers(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let rounded: f64 =
                format!("{:.5e}", number.as_f64().unwrap_or(0.0)).parse().unwrap_or(0.0);
            *value = json!(rounded);
        }
        Value::Array(items) => items.iter_mut().for_each(round_numbers),
        Value::Object(members) => members.values_mut().for_each(round_numbers),
        _ => {}
    }
}
