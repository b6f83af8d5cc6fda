//! The room's geometry, and a tiny film from the first render to the last file.

use std::fs;

use super::super::cornell::tests::trial;
use super::*;

#[test]
fn the_room_is_as_the_scene_says_and_the_exact_delay_is_that_of_the_glass() {
    let options = trial("room");
    let room = Room::of(&options.load(NAME, &[]).unwrap()).unwrap();
    assert!((room.delay() - 0.3).abs() < 1e-12);
    // The thick lens: rays close to the axis, by Snell's law at both faces, meet at the focus.
    let (r, u, eta) = (room.radius, room.lamp.distance(room.ball), room.eta);
    let theta: f64 = 1e-4;
    let impact = u * theta.sin();
    let (i, t) = ((impact / r).asin(), (impact / (eta * r)).asin());
    let v = impact / (2.0 * (i - t) - theta).sin();
    assert!((room.ball.distance(room.focus()) / v - 1.0).abs() < 1e-6, "{v}");
    assert!((room.floor.y + 1.0).abs() < 1e-12 && room.left.x == -1.0 && room.back.z == -1.0);
    let twin = Room::of(&options.load(TWIN, &[]).unwrap()).unwrap();
    assert_eq!((twin.lamp, twin.ball, twin.eta), (room.lamp, room.ball, room.eta));
}

#[test]
fn the_delay_behind_the_ball_is_that_of_the_glass() {
    let options = trial("delay");
    let room = Room::of(&options.load(NAME, &[]).unwrap()).unwrap();
    for delay in delay::measure(&options, &room, &mut Watch::default()).unwrap() {
        // 99 % intervals around what bins resolve; the seed is fixed.
        assert!(delay.agrees() && delay.half < 1e-3, "{delay:?}");
    }
}

#[test]
fn all_files_are_made() {
    let options = trial("mirrors");
    let _ = fs::remove_dir_all(&options.out);
    let result = run(&options, &mut Watch::default()).unwrap();
    let out = options.out.join(NAME);
    for file in ["sequence.png", "viewer.html", "caustics.html", "delay.json", "caustics-area.json"]
    {
        assert!(fs::metadata(out.join(file)).unwrap().len() > 100, "{file}");
    }
    assert!(result.events.windows(2).all(|pair| pair[0].opl <= pair[1].opl));
    assert!(result.events.len() >= 9, "{:?}", result.events);
    assert_eq!(result.twin.methods[..3], ["path", "light", "beams"]);
    assert!(result.twin.regions.iter().all(|region| region.differences.len() == 5));
    assert!(!out.join("caustics").exists(), "renders are removed at the end");
    assert!(
        result.twin.regions.iter().all(|region| region.levels[1].mean > 0.0 || region.pixels < 4)
    );
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    for part in ["delta pulse, bin", "continuous emission", "agree where", "Provenance"] {
        assert!(page.contains(part), "{part}");
    }
    let kept: MirrorsResult =
        serde_json::from_str(&fs::read_to_string(out.join("result.json")).unwrap()).unwrap();
    assert_eq!(kept.events, result.events);
    fs::remove_dir_all(&options.out).unwrap();
}
