//! What a plan decides, and why.

use tpb_scene::{IntegratorSpec, Item, MethodName, Plan, Scene};

use super::{cornell_with, parse, shipped_text};

fn shipped(name: &str) -> Scene {
    parse(&shipped_text(name)).unwrap().scene
}

fn cornell(changes: &[&str]) -> Scene {
    cornell_with(changes).unwrap().scene
}

fn plan(scene: &Scene, max_depth: u32) -> Plan {
    Plan::new(scene, &IntegratorSpec { max_depth: Some(max_depth), ..scene.integrator })
}

fn lines(items: &[Item]) -> String {
    let lines: Vec<_> =
        items.iter().map(|item| format!("{}: {}", item.part, item.reason)).collect();
    lines.join("\n")
}

const LASER: &str = r#"beam={"type": "laser", "power": 1, "radius": 0.01,
    "to_world": [{"rotate": {"axis": [0, 1, 0], "angle": 90}}]}"#;

#[test]
fn switches_and_reasons_agree_at_every_depth() {
    for name in ["cornell-blocks", "infinite-point", "mirror-caustic", "mirror-caustic-point"] {
        let scene = shipped(name);
        for depth in 1..5 {
            let plan = plan(&scene, depth);
            let needed = |part: &str| plan.needs.iter().any(|item| item.part == part);
            let left_out = |part: &str| plan.left_out.iter().any(|item| item.part == part);
            for (part, on) in [
                ("photon beams", plan.beams),
                ("surface photons", plan.surface_photons),
                ("next-event estimation", plan.next_event_estimation),
                ("connections to the eye", plan.eye_connections),
            ] {
                assert_eq!(needed(part), on, "{name} to depth {depth}: {part}\n{plan}");
                assert!(on || left_out(part), "{name} to depth {depth}: {part}\n{plan}");
            }
        }
    }
}

#[test]
fn caustics_come_from_mirrors_and_glass() {
    let caustics = |name: &str, depth| plan(&shipped(name), depth).caustic_photons;
    assert!(caustics("mirror-caustic", 3) && !caustics("mirror-caustic", 2));
    assert!(!caustics("cornell-blocks", 10) && !caustics("infinite-point", 10));
}

#[test]
fn beams_connect_at_surfaces_only() {
    let plan = plan(&shipped("infinite-point"), 10);
    assert!(plan.diffuse.is_empty() && plan.next_event_estimation);
    let (path, beams) =
        (plan.clone().of_method(MethodName::Path), plan.of_method(MethodName::Beams));
    assert!(lines(&path.needs).contains("next-event"), "{path}");
    assert!(!lines(&path.left_out).contains("next-event"), "{path}");
    assert!(!lines(&beams.needs).contains("next-event"), "{beams}");
    assert!(lines(&beams.left_out).contains("next-event"), "{beams}");
}

#[test]
fn light_that_a_method_loses_is_marked() {
    let lost = |scene: &Scene, depth, method| {
        let left_out = plan(scene, depth).of_method(method).left_out;
        let lost = left_out.into_iter().filter(|item| item.loses_light);
        lost.map(|item| format!("{}: {}", item.part, item.reason)).collect::<Vec<_>>()
    };
    let (path, beams) = (MethodName::Path, MethodName::Beams);
    let (caustic, laser) = (shipped("mirror-caustic-point"), cornell(&[LASER]));
    for (scene, depth, word) in [(&caustic, 3, "caustics"), (&laser, 2, "connect to: beam")] {
        let [line] = &lost(scene, depth, path)[..] else { panic!("{word}") };
        assert!(line.contains(word), "{line}");
        assert!(lost(scene, depth - 1, path).is_empty(), "not reached: {word}");
        assert!(lost(scene, depth, beams).is_empty(), "{word}");
    }
    assert!(lost(&shipped("mirror-caustic"), 9, path).is_empty(), "the lamp has an area");
    // The light tracer finds caustics and lasers, but sees nothing in mirrors.
    for (name, depth) in [("mirror-caustic-point", 3), ("mirror-caustic", 2)] {
        let scene = shipped(name);
        let [line] = &lost(&scene, depth, MethodName::Light)[..] else { panic!("{name}") };
        assert!(line.contains("across: glass_shape, mirror_shape"), "{line}");
        assert!(lost(&scene, depth - 1, MethodName::Light).is_empty(), "{name}");
        assert!(!lost(&scene, depth, path).contains(line), "{name}");
    }
    assert!(lost(&laser, 9, MethodName::Light).is_empty());
    assert!(lost(&cornell(&[]), 9, path).is_empty());
}

#[test]
fn rough_surfaces_are_connected_to_and_keep_no_photons() {
    let rough = r#"white={"type": "roughconductor", "distribution": "ggx", "material": "none",
        "specular_reflectance": 0.9}"#;
    let scene = cornell(&[rough, LASER]);
    let plan = plan(&scene, 9);
    assert!(plan.rough.contains(&"floor".to_owned()), "{plan}");
    assert!(plan.next_event_estimation && plan.eye_connections);
    let lost = |method| lines(&plan.clone().of_method(method).left_out);
    assert!(lost(MethodName::Beams).contains("rough surfaces to: beam"), "{plan}");
    assert!(!lost(MethodName::Light).contains("rough"), "{plan}");
    assert!(endless_rough("1").len() > 1 && endless_rough("0.99").is_empty());
}

fn endless_rough(reflectance: &str) -> Vec<String> {
    let rough = r#"white={"type": "roughconductor", "distribution": "ggx", "material": "none"}"#;
    let change = format!("white.specular_reflectance={reflectance}");
    plan(&cornell(&[rough, &change]), 9).endless
}

#[test]
fn the_reason_of_the_kernel_is_true_for_a_laser() {
    let reason = |scene: &Scene| lines(&plan(scene, 9).needs);
    assert!(reason(&cornell(&[])).contains("1D kernel: spread directions"));
    let laser = reason(&cornell(&[LASER]));
    assert!(laser.contains("1D kernel: no temporal blur; sound unless"), "{laser}");
}

#[test]
fn light_that_may_never_end_is_found() {
    let endless = |changes: &[&str]| plan(&cornell(changes), 9).endless;
    assert!(endless(&[]).is_empty() && endless(&["fog.albedo=0.999999"]).is_empty());
    let [fog] = &endless(&["fog.albedo=1"])[..] else { panic!("fog") };
    assert!(fog.contains("medium 'fog'"), "{fog}");
    let red = r#"white.reflectance={"type": "rgb", "value": [1, 0.5, 0]}"#;
    let walls = endless(&[red]);
    assert!(walls.len() > 1 && walls[0].contains("shape 'back'"), "{walls:?}");
    assert!(endless(&["fog.albedo=1", "fog.sigma_t=0"]).is_empty(), "vacuum");
    let [mirror] = &plan(&shipped("mirror-caustic"), 9).endless[..] else { panic!("no glass") };
    assert!(mirror.contains("shape 'mirror_shape'"), "{mirror}");
}

/// Regression: total reflection in glass was not seen as endless.
#[test]
fn light_that_glass_may_trap_for_ever_is_found() {
    let with_glass = |lamp: &str, more: &str, fog: &str| {
        let glass = format!(
            r#"glass={{"type": "cube", "to_world": [{{"scale": 0.2}}, {{"translate": [0, 0.3, 0.5]}}],
                "bsdf": {{"type": "dielectric", "int_ior": 1.5, "ext_ior": 1 {more}}}}}"#
        );
        let lamp = format!(r#"bulb={{"type": "point", "position": {lamp}}}"#);
        plan(&cornell(&[&glass, &lamp, fog]), 9).endless
    };
    let with_fog = |fog| with_glass("[0, 0.35, 0.5]", "", fog);
    let with_glass = |lamp, more| with_glass(lamp, more, "fog.sigma_t=0");
    let [trap] = &with_glass("[0, 0.35, 0.5]", "")[..] else { panic!("it is inside") };
    assert!(trap.contains("shape 'glass'") && trap.contains("'bulb'"), "{trap}");
    assert!(with_fog("fog.albedo=0.8").is_empty(), "fog takes of it");
    assert!(with_glass("[0, 0.8, 0.5]", "").is_empty(), "what enters leaves again");
    assert!(with_glass("[0, 0.35, 0.5]", r#", "specular_reflectance": 0.9"#).is_empty());
}
