//! Places and directions: cameras, lamps and surfaces where geometry degenerates; refractive indices.

use std::f64::consts::{FRAC_PI_2, PI};

use serde_json::{Value, json};

use crate::error::Result;
use crate::stress::case::{Case, Finding, Method, Work};
use crate::stress::laws::refused;
use crate::stress::pencil::{NO_PATH, Pencil};
use crate::stress::shot::{Shot, load};
use crate::stress::world::{Fog, Unit, World};
use crate::stress::worlds::{FILM, everything, furnace, plate, steady};

/// Why the 1D kernel is left out along the view.
const NO_1D: &str =
    "1/sin diverges along the view: the plan takes the 2D kernel there, and says so";

/// Why the light tracer is left out along the view.
const NO_LINE: &str = "a line seen end on has infinite radiance without a kernel's width";
/// Why it is left out behind glass.
const NO_GLASS: &str = "no connection crosses glass (the plan says so)";

pub(super) fn cases() -> Vec<Case> {
    [beams(), radii(), indices(), places(), coincident()].into_iter().flatten().collect()
}

fn pencil(name: &str, risk: &'static str, pencil: Pencil) -> Case {
    Case::new(name, risk, move |setup, method| pencil.agrees(method, setup.seed, 1.0))
        .without(Method::Path, NO_PATH)
}

/// Beams from every side.
fn beams() -> Vec<Case> {
    let at = |psi| Pencil { psi, ..Pencil::USUAL };
    vec![
        pencil(
            "beam/along",
            "beam and rays from one point: parallel, the camera inside the beam",
            at(0.0),
        )
        .without(Method::Beams1d, NO_1D)
        .without(Method::Light, NO_LINE),
        pencil(
            "beam/against",
            "the camera looks straight into the beam, and stands in it: no spread in time",
            at(PI),
        )
        .without(Method::Beams1d, NO_1D)
        .without(Method::Light, NO_LINE),
        pencil("beam/across", "cosine 0: forms that divide by it", at(FRAC_PI_2)),
        pencil(
            "beam/almost-along",
            "sines of 1e-6: cancellation in cross products",
            Pencil { psi: 1e-6, radius: 1e-8, ..Pencil::USUAL },
        ),
        pencil(
            "beam/almost-against",
            "sines of 1e-6: cancellation, spread in time of 1e-20",
            Pencil { psi: PI - 1e-6, radius: 1e-8, ..Pencil::USUAL },
        ),
        pencil("beam/oblique", "the usual case, for comparison", at(2.0)),
        Case::new(
            "beam/tangent",
            "rays that graze the kernel: half of the film beside the beam must stay black",
            |setup, method| {
                let pencil = Pencil { psi: 1.0, ..Pencil::USUAL };
                let work =
                    Work { samples: 4096, photons: 4, radius: Some(1e-3), surface_radius: None };
                let image = Shot::new(&pencil.world(), method, &work)?.render(setup.seed, 1)?;
                let rows: Vec<f64> = (0..8).map(|row| image.arrays.steady[row]).collect();
                // Pixels end at one radius from the axis, to 1e-6 of it.
                let outside: f64 = [0, 1, 6, 7].map(|row| rows[row]).iter().sum();
                let inside: f64 = rows.iter().sum::<f64>() - outside;
                let text = format!("beside the beam {:.1e} of the light", outside / inside);
                Ok(Finding::exact(inside > 0.0 && outside <= 1e-4 * inside, text))
            },
        )
        .only(&Method::BEAMS, "has no kernel"),
    ]
}

/// Radii from 1e-7 to 10 times the scene.
fn radii() -> Vec<Case> {
    let risk =
        "radii far below or above all other lengths: cancellation, f32 tests that lose beams";
    let at = |radius: f64| {
        pencil(&format!("radius/{radius:e}"), risk, Pencil { radius, psi: 1.0, ..Pencil::USUAL })
    };
    let narrow = "the film does not hold the kernel whole: its sum is no line's";
    let mut cases = vec![at(1e-7), at(1e-5), at(0.1).without(Method::Light, narrow)];
    cases.push(at(10.0).without(Method::Light, narrow));
    for (radius, passed) in [(1e-300, false), (1e300, false), (0.0, false), (f64::NAN, false)] {
        cases.push(
            Case::new(
                format!("radius/{radius:e}-refused"),
                "a radius whose square is 0, infinite or no number",
                move |_, method| {
                    let work = Work { radius: Some(radius), ..Work::LITTLE };
                    let shot = Shot::new(&everything(Unit::SI, FILM), method, &work)?;
                    let result = shot.render(1, 1);
                    let text = result.as_ref().err().map(ToString::to_string).unwrap_or_default();
                    let finding = crate::stress::laws::says(&text, &["'radius'", "must be"]);
                    Ok(if passed { Finding::exact(result.is_ok(), "accepted") } else { finding })
                },
            )
            .only(&Method::BEAMS, "has no radius"),
        );
    }
    cases
}

/// Refractive indices: the furnace shows radiance 1 from outside, index squared from inside.
fn indices() -> Vec<Case> {
    let mut cases = Vec::new();
    for index in [1.0, 1.0 + 1e-12, 1.5, 10.0, 1e6, 1e-6] {
        cases.push(Case::new(
            format!("index/furnace-{index}"),
            "Fresnel at equal, almost equal and extreme indices: 0/0, refraction off the unit sphere",
            move |setup, method| lit(setup.seed, method, index, [0.0, 0.3, 1.6], 1.0),
        )
        .without(Method::Light, NO_GLASS));
    }
    for index in [1.5, 10.0] {
        cases.push(
            Case::new(
                format!("index/inside-{index}"),
                "a camera inside glass: radiance must grow by the index squared",
                move |setup, method| {
                    lit(setup.seed, method, index, [0.05, 0.0, 0.0], index * index)
                },
            )
            .without(Method::Light, NO_GLASS),
        );
    }
    cases.push(Case::new(
        "index/trapped-importance",
        "total internal reflection for ever: paths without end, energy that nobody accounts for",
        |setup, method| {
            // Seen from 0.5 off the centre, all rays of the film meet the sphere at sines above 1/10.
            let world = furnace(10.0, [0.5, 0.0, 0.0], steady(4));
            let image = Shot::new(&world, method, &Work::LITTLE)?.render(setup.seed, 1)?;
            let dark = Finding::exact(image.total() == 0.0, format!("sum {:e}", image.total()));
            if method != Method::Path {
                return Ok(dark); // Their ledger is of light.
            }
            let cut = image.ledger.cut_by_depth / image.ledger.emitted;
            let text = format!("{cut} of the paths were cut by depth");
            Ok(dark.and(Finding::exact((cut - 1.0).abs() < 1e-12, text)))
        },
    ));
    cases.push(
        Case::new(
            "index/trapped-light",
            "total internal reflection for ever: the ledger must hold what the depth limit cuts",
            |setup, method| {
                // Of a lamp at r = 0.3 in glass of index 10, sinθ = r sinα ≤ 1/10 leaves: 1 − cos(asin 1/3)
                // on both sides, all the rest is cut.
                let world = furnace(10.0, [0.0, 0.3, 1.6], steady(2)).with("wall", Value::Null);
                let world = without_wall(&world).point("bulb", [0.3, 0.0, 0.0], 1.0);
                // A diffuse floor, so that photons are traced at all.
                let floor = json!([{"translate": [0.0, 0.0, -4.0]}]);
                let world = world.shape("floor", "rectangle", floor, plate());
                let work = Work { photons: 10_000, ..Work::LITTLE };
                let image = Shot::new(&world, method, &work)?.render(setup.seed, 1)?;
                let cut = image.ledger.cut_by_depth / image.ledger.emitted;
                let share = (8.0_f64 / 9.0).sqrt();
                let n = 10_000.0;
                let sigma = (share * (1.0 - share) / n).sqrt();
                // The two-sided tail of six standard deviations; 1e-5 for light near the critical angle.
                let passed = (cut - share).abs() < 6.0 * sigma + 1e-5;
                let text = format!("cut {cut:.5}, exactly {share:.5}");
                Ok(Finding { passed, text, false_alarm: 2e-9 })
            },
        )
        .without(Method::Path, "its ledger is of importance: index/trapped-importance"),
    );
    cases
}

/// The furnace without its shining wall.
fn without_wall(world: &World) -> World {
    let black = json!({"bsdf": {"type": "diffuse", "reflectance": 0.0}, "flip_normals": true});
    world.clone().shape("wall", "sphere", json!([{"scale": 9.0}]), black)
}

fn lit(seed: u64, method: Method, index: f64, eye: [f64; 3], radiance: f64) -> Result<Finding> {
    let world = furnace(index, eye, steady(4));
    let image =
        Shot::new(&world, method, &Work { samples: 16, ..Work::LITTLE })?.render(seed, 1)?;
    let off = |value: &f64| (value / radiance - 1.0).abs();
    let worst = image.arrays.steady.iter().map(off).fold(0.0, f64::max);
    let text = format!("radiance {radiance} off by {worst:.1e}");
    Ok(Finding::exact(worst <= 1e-9, text))
}

/// A room that is turned about an axis of no symmetry, so that nothing lies on a grid.
fn turned_wall(world: World, name: &str, rest: Value) -> World {
    world.shape(name, "rectangle", turn([0.1, 0.2, -1.0]), rest)
}

fn turn(place: [f64; 3]) -> Value {
    json!([{"rotate": {"axis": [1.0, 2.0, 3.0], "angle": 37.0}}, {"translate": place}])
}

/// A point of the turned wall, and one at a distance before it.
fn on_wall(before: f64) -> [f64; 3] {
    // Rodrigues' rotation of (0.3, 0.2, before) about (1, 2, 3)/√14 by 37°.
    let axis = [1.0, 2.0, 3.0].map(|x: f64| x / 14.0_f64.sqrt());
    let p = [0.3, 0.2, before];
    let (sin, cos) = 37.0_f64.to_radians().sin_cos();
    let dot: f64 = (0..3).map(|i| axis[i] * p[i]).sum();
    let cross = |i: usize| axis[(i + 1) % 3] * p[(i + 2) % 3] - axis[(i + 2) % 3] * p[(i + 1) % 3];
    let place = [0.1, 0.2, -1.0];
    [0, 1, 2].map(|i| cos * p[i] + sin * cross(i) + (1.0 - cos) * dot * axis[i] + place[i])
}

/// A scene with the turned wall, a camera and a lamp.
fn scene(eye: [f64; 3], lamp: Option<[f64; 3]>, wall: Value) -> World {
    let target = [eye[0], eye[1], eye[2] - 1.0];
    let world = World::new(Unit::SI).depths(1, 4);
    let fog = world.fog(Fog::grey(0.4, 0.1, 0.0), None);
    let world = world.with("fog", fog).camera(eye, target, [0.0, 1.0, 0.0], 40.0, steady(4));
    let world = turned_wall(world, "wall", wall);
    match lamp {
        Some(place) => world.point("bulb", place, 1.0),
        None => world,
    }
}

const AWAY: [f64; 3] = [0.3, 0.4, 2.0];

/// Cameras and lamps on surfaces.
fn places() -> Vec<Case> {
    let null = || json!({"bsdf": {"type": "null"}, "interior": {"type": "ref", "id": "fog"}});
    let glass = || json!({"bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}});
    let mut cases = Vec::new();
    for (kind, wall) in [("null", null()), ("glass", glass()), ("wall", plate())] {
        let (a, b) = (wall.clone(), wall.clone());
        cases.push(Case::of_no_method(
            format!("camera/on-{kind}"),
            "rounding decides on which side of a surface a ray starts",
            move |_| {
                Ok(refused(
                    &scene(on_wall(0.0), Some(AWAY), a.clone()),
                    &["stands on 'wall'", "move it"],
                ))
            },
        ));
        cases.push(Case::of_no_method(
            format!("lamp/on-{kind}"),
            "rounding decides which part of the light is lost",
            move |_| {
                Ok(refused(
                    &scene(AWAY, Some(on_wall(0.0)), b.clone()),
                    &["stands on 'wall'", "'bulb'", "move it"],
                ))
            },
        ));
        cases.push(Case::new(
            format!("camera/just-off-{kind}"),
            "a surface at 1e-6 of the scene: must be seen as one, not stepped over",
            move |setup, method| {
                let world = scene(on_wall(1e-6), Some(AWAY), wall.clone());
                let image = Shot::new(&world, method, &Work::LITTLE)?.render(setup.seed, 2)?;
                Ok(Finding::exact(true, format!("sound, sum {:e}", image.total())))
            },
        ));
    }
    cases.push(Case::of_no_method(
        "lamp/laser-on-wall",
        "rounding decides whether a laser gets out of the wall that it stands on",
        |_| {
            let world = scene(AWAY, None, plate()).laser(on_wall(0.0), on_wall(1.0), 0.01, 1.0);
            Ok(refused(&world, &["'laser'", "stands on 'wall'"]))
        },
    ));
    cases.push(Case::of_no_method("camera/at-a-lamp-in-fog", "infinite radiance", |_| {
        let world = everything(Unit::SI, FILM).point("bulb", [0.3, 0.4, 0.3], 1.0);
        let world = world.camera([0.3, 0.4, 0.3], [0.0; 3], [0.0, 1.0, 0.0], 40.0, FILM);
        Ok(refused(&world, &["emitter 'bulb'", "infinite radiance", "move"]))
    }));
    cases.push(Case::new(
        "lamp/just-off-wall",
        "a lamp at 1e-6 of a wall lights it with 1e12 times the irradiance: it must not break sums",
        |setup, method| {
            let world = scene(AWAY, Some(on_wall(1e-6)), plate());
            let image = Shot::new(&world, method, &Work::LITTLE)?.render(setup.seed, 2)?;
            Ok(Finding::exact(true, format!("sound, sum {:e}", image.total())))
        },
    ));
    cases
}

/// Surfaces in the same place.
fn coincident() -> Vec<Case> {
    let lamp = || json!({"emitter": {"type": "area", "radiance": 1.0}});
    let small = || {
        json!([{"scale": 0.2}, {"rotate": {"axis": [1.0, 2.0, 3.0], "angle": 37.0}},
            {"translate": [0.1, 0.2, -1.0]}])
    };
    let glass = || json!({"bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}});
    let with = move |name: &str, steps: Value, rest: Value| {
        scene(AWAY, None, plate()).shape(name, "rectangle", steps, rest)
    };
    let same = &["in the same place", "move or shrink"];
    let flipped = json!({"bsdf": {"type": "diffuse"}, "flip_normals": true});
    vec![
        Case::of_no_method(
            "coincident/lamp-in-a-wall",
            "half of a lamp's light ends in the wall that it lies in",
            move |_| Ok(refused(&with("panel", small(), lamp()), same)),
        ),
        Case::of_no_method(
            "coincident/glass-on-a-wall",
            "which of two surfaces is met first, rounding decides",
            move |_| Ok(refused(&with("pane", small(), glass()), same)),
        ),
        Case::of_no_method(
            "coincident/back-to-back",
            "light meets the black back of one of two sheets",
            move |_| {
                Ok(refused(
                    &with("back", turn([0.1, 0.2, -1.0]), flipped.clone()),
                    &["in the same place", "twosided"],
                ))
            },
        ),
        Case::of_no_method(
            "coincident/box-on-a-floor",
            "a check that refuses what is harmless: every box stands on something",
            move |_| {
                let steps = json!([{"scale": 0.2}, {"translate": [0.0, 0.0, 0.2]},
                    {"rotate": {"axis": [1.0, 2.0, 3.0], "angle": 37.0}}, {"translate": [0.1, 0.2, -1.0]}]);
                let world = scene(AWAY, Some([0.5, 0.6, 1.0]), plate());
                let world = world.shape("box", "cube", steps, plate());
                Ok(Finding::exact(load(&world).is_ok(), "accepted"))
            },
        ),
    ]
}
