//! Scenes that several groups of cases share.

use serde_json::{Value, json};

use crate::stress::world::{Film, Fog, Unit, World};

/// A room with one of everything: fog behind a null boundary, diffuse walls, a mirror, a glass ball,
/// a sphere, an area lamp, a point lamp and a laser. `film` says how time is cut.
pub fn everything(unit: Unit, film: Film) -> World {
    let world = World::new(unit).depths(1, 8);
    let fog = world.fog(Fog::grey(0.4, 0.1, 0.3), None);
    let white = json!({"bsdf": {"type": "diffuse", "reflectance": 0.5}});
    let mirror =
        json!({"bsdf": {"type": "conductor", "material": "none", "specular_reflectance": 0.9}});
    let glass = json!({"bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}});
    let front = json!({"bsdf": {"type": "null"}, "interior": {"type": "ref", "id": "fog"}});
    let lamp = json!({"emitter": world.shine(3.0)});
    let turned = |angle: f64, axis: [f64; 3], place: [f64; 3]| json!([{"rotate": {"axis": axis, "angle": angle}}, {"translate": place}]);
    world
        .with("fog", fog)
        .camera([0.0, 0.0, 3.9], [0.0; 3], [0.0, 1.0, 0.0], 38.0, film)
        .shape("front", "rectangle", json!([{"translate": [0.0, 0.0, 1.0]}]), front)
        .shape("back", "rectangle", json!([{"translate": [0.0, 0.0, -1.0]}]), white.clone())
        .shape(
            "floor",
            "rectangle",
            turned(-90.0, [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
            white.clone(),
        )
        .shape(
            "ceiling",
            "rectangle",
            turned(90.0, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            white.clone(),
        )
        .shape("left", "rectangle", turned(90.0, [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]), mirror)
        .shape("right", "rectangle", turned(-90.0, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), white.clone())
        .shape("ball", "sphere", json!([{"scale": 0.3}, {"translate": [-0.4, -0.5, 0.1]}]), glass)
        .shape("stone", "sphere", json!([{"scale": 0.2}, {"translate": [0.5, -0.6, -0.2]}]), white)
        .shape(
            "lamp",
            "disk",
            json!([{"scale": 0.2}, {"rotate": {"axis": [1.0, 0.0, 0.0], "angle": 90.0}},
                {"translate": [0.2, 0.97, 0.0]}]),
            lamp,
        )
        .point("bulb", [0.3, 0.4, 0.3], 2.0)
        .laser([-0.8, 0.7, 0.6], [0.5, -0.6, -0.2], 0.02, 1.0)
}

/// The film of [`everything`]: 6 × 6 pixels, bins that hold nearly all light.
pub const FILM: Film = Film { width: 6, height: 6, start: 2.5, bin: 0.25, bins: 60, rgb: false };

/// A closed sphere of radius 2 that shines everywhere with radiance 1, and a ball of radius 1 of
/// glass of this index within: whoever looks from vacuum sees radiance 1 wherever he looks, from
/// inside the glass its index squared. The camera stands at `eye` and looks along −z.
pub fn furnace(index: f64, eye: [f64; 3], film: Film) -> World {
    let world = World::new(Unit::SI).depths(1, 400);
    let glass = json!({"bsdf": {"type": "dielectric", "int_ior": index, "ext_ior": 1.0}});
    let wall = json!({"emitter": world.shine(1.0), "flip_normals": true});
    let target = [eye[0], eye[1], eye[2] - 1.0];
    world
        .camera(eye, target, [0.0, 1.0, 0.0], 40.0, film)
        .shape("wall", "sphere", json!([{"scale": 2.0}]), wall)
        .shape("glass", "sphere", json!([]), glass)
}

/// The same sphere filled with fog, without glass.
pub fn foggy_furnace(fog: Fog, film: Film) -> World {
    let world = World::new(Unit::SI).depths(1, 200);
    let fog = world.fog(fog, None);
    let wall = json!({"emitter": world.shine(1.0), "flip_normals": true});
    world
        .with("fog", fog)
        .with("background", json!({"type": "ref", "id": "fog"}))
        .camera([0.1, 0.2, 0.3], [0.1, 0.2, -1.0], [0.0, 1.0, 0.0], 60.0, film)
        .shape("wall", "sphere", json!([{"scale": 2.0}]), wall)
}

/// A rectangle of half-width 1 with its normal along +z, white on that side.
pub fn plate() -> Value {
    json!({"bsdf": {"type": "diffuse", "reflectance": 0.5}})
}

/// A steady film.
pub fn steady(side: usize) -> Film {
    Film { width: side, height: side, start: 0.0, bin: 1.0, bins: 0, rgb: false }
}
