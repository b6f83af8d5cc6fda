//! The room's geometry, and a tiny film from the first render to the last file.

use std::fs;

use super::super::cornell::tests::trial;
use super::*;
use crate::judged::Referee;

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

/// Pixels from the upper left corner, as parts of the picture.
#[test]
fn things_are_where_the_texts_say() {
    let loaded = trial("seen").load(NAME, &[]).unwrap();
    let room = Room::of(&loaded).unwrap();
    let sensor = &loaded.scene.sensor;
    let at = |place: glam::DVec3| {
        let point = sensor.project(place - room.eye).unwrap();
        [point.x, point.y].map(|pixel| pixel / loaded.scene.film.width as f64)
    };
    let (lamp, ball, tilted) = (at(room.lamp), at(room.ball), at(room.tilted));
    assert!(lamp[0] < 0.4 && lamp[1] < 0.3, "upper left: {lamp:?}");
    assert!(ball.iter().all(|&side| 0.5 < side && side < 0.6), "just past the middle: {ball:?}");
    assert!(tilted[0] > 0.7 && (0.4..0.55).contains(&tilted[1]), "at the right: {tilted:?}");
    // The left mirror ends where the back wall begins: a fifth from the left, and as much above.
    let corner = at(glam::DVec3::new(room.left.x, 1.0, room.back.z));
    assert!(corner.iter().all(|&side| (0.19..0.22).contains(&side)), "{corner:?}");
    let [_, far] = room.poles().map(at);
    assert!(far[0] > ball[0] && far[1] > ball[1], "its lower right edge: {far:?}");
    let (focus, floor) = (at(room.focus()), at(room.floor));
    assert!(focus[0] > 0.6 && (0.75..floor[1]).contains(&focus[1]), "above the floor: {focus:?}");
    assert!(floor[0] > focus[0] && floor[1] > 0.85, "lower right: {floor:?}");
    let back = at(room.back);
    assert!(back[0] < ball[0] && back[1] < 0.35, "upper left of the ball: {back:?}");
    let blank = blank(&loaded).unwrap();
    let dark = Arrays { transient: vec![0.0; 3 * blank.pixels() * blank.bins], ..blank };
    let events = room.events(&loaded.scene, &dark);
    assert_eq!(events.len(), 10);
    let texts: std::collections::BTreeSet<&str> =
        events.iter().map(|event| event.seen.as_str()).collect();
    assert!(texts.len() == 10 && texts.iter().all(|text| text.ends_with('.')), "{texts:?}");
}

#[test]
fn close_ups_look_at_the_caustics_and_at_nothing_smooth() {
    let options = trial("close");
    let room = Room::of(&options.load(TWIN, &[]).unwrap()).unwrap();
    for close_up in CloseUp::all(&room) {
        let changes = close_up.changes(room.eye);
        let narrow = Options { pixels: Some(16), bins: Some(160), ..options.clone() };
        let loaded = narrow.load(TWIN, &changes.each_ref().map(String::as_str)).unwrap();
        let scene = &loaded.scene;
        let middle = scene.sensor.project(close_up.place - room.eye).unwrap();
        assert!((middle.x - 8.0).abs() < 1e-9 && (middle.y - 8.0).abs() < 1e-9, "{middle:?}");
        let across = close_up.half / 8.0 / close_up.place.distance(room.eye);
        assert!((scene.sensor.pixel_width() / across - 1.0).abs() < 1e-9);
        // The light tracer judges every pixel.
        let judged = Referee::Light.judged_of(scene).unwrap();
        assert!(judged.iter().all(|&judged| judged), "{}", close_up.key);
        let regions = close_up.regions(scene, &judged).unwrap();
        assert_eq!([0, 1, 2].map(|index| regions[index].pixels.len()), [256, 256, 64]);
        let bin = ((room.through(close_up.place) - 3.6) / 0.04) as usize;
        assert!(regions[1].bins.contains(&bin) && regions[1].bins.len() < 13);
        assert_eq!((regions[0].bins.clone(), &regions[1].bins), (0..160, &regions[2].bins));
    }
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
    for file in [
        "sequence.png",
        "viewer.html",
        "caustics.html",
        "delay.json",
        "caustics-area.json",
        "caustics-close.json",
    ] {
        assert!(fs::metadata(out.join(file)).unwrap().len() > 100, "{file}");
    }
    assert!(result.events.windows(2).all(|pair| pair[0].opl <= pair[1].opl));
    assert!(result.events.len() >= 9, "{:?}", result.events);
    assert_eq!(result.twin.methods[..3], ["path", "light", "beams"]);
    assert!(result.twin.regions.iter().all(|region| region.differences.len() == 6));
    let close: Vec<_> = result.close.iter().flat_map(|found| &found.regions).collect();
    // All cells that are compared close up hold light, and path tracing has a bound there.
    assert_eq!(close.len(), 6);
    assert!(close.iter().all(|region| region.levels[1].mean > 0.0), "{close:?}");
    assert!(close.iter().all(|region| region.unseen.is_none_or(|unseen| unseen > 0.0)));
    assert!(result.equal_time.lamps.is_none() && result.equal_time.whole().factor_whole.is_none());
    assert!(!out.join("caustics").exists(), "renders are removed at the end");
    assert!(
        result.twin.regions.iter().all(|region| region.levels[1].mean > 0.0 || region.pixels < 4)
    );
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    for part in [
        "delta pulse, bin",
        "continuous emission",
        "agree where",
        "path, light and beams",
        "the caustic, the brightest place",
        "Provenance",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let kept: MirrorsResult =
        serde_json::from_str(&fs::read_to_string(out.join("result.json")).unwrap()).unwrap();
    assert_eq!(kept.events, result.events);
    fs::remove_dir_all(&options.out).unwrap();
}
