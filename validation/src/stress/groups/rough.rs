//! Rough surfaces at the ends of their range, and seen and lit along themselves.

use serde_json::{Value, json};

use crate::stress::case::{Case, Finding, Method, Work};
use crate::stress::shot::Shot;
use crate::stress::world::{Film, Unit, World};
use crate::stress::worlds::{FILM, everything, furnace, steady};

pub(super) fn cases() -> Vec<Case> {
    vec![
        room("rough/alpha-1e-4", "densities of 1e7 per steradian, half vectors of rounding", 1e-4),
        room("rough/alpha-1", "weights at grazing angles, light below the horizon", 1.0),
        Case::new(
            "rough/furnace",
            "energy won: a ball of nearly smooth glass must vanish in a furnace",
            |setup, method| {
                let world = furnace(1.5, [0.0, 0.3, 1.6], steady(2)).shape(
                    "glass",
                    "sphere",
                    json!([]),
                    json!({"bsdf": glass(1e-4)}),
                );
                let work = Work { samples: 4000, photons: 20_000, ..Work::LITTLE };
                let image = Shot::new(&world, method, &work)?.render(setup.seed, 1)?;
                let mean = image.total() / 4.0;
                // What is lost is lost at grazing angles, connections have their noise; the light
                // tracer sees lamps only where glass does not stand before them.
                let sound = method == Method::Light || (0.99..=1.001).contains(&mean);
                Ok(Finding::exact(sound, format!("mean radiance {mean}")))
            },
        ),
        Case::new(
            "rough/grazing",
            "light and view within 1e-6 of a rough floor: 0/0 in masking and Jacobians",
            |setup, method| {
                let film = Film { width: 4, height: 4, ..FILM };
                let low = 1e-6;
                let world = World::new(Unit::SI)
                    .depths(1, 6)
                    .camera([0.0, low, 2.0], [0.0, low, 0.0], [0.0, 1.0, 0.0], 2e-4, film)
                    .shape("metal", "rectangle", floor(0.0), json!({"bsdf": metal(1.0)}))
                    .shape("glass", "rectangle", floor(-2.5), json!({"bsdf": glass(0.01)}))
                    .point("bulb", [0.3, low, -0.5], 1.0);
                let work = Work { samples: 200, photons: 20_000, ..Work::LITTLE };
                let image = Shot::new(&world, method, &work)?.render(setup.seed, 2)?;
                let lit = image.total() > 0.0;
                Ok(Finding::exact(lit, format!("sound, sum {:e}", image.total())))
            },
        )
        .without(Method::Light, "no photon lands in a view of 1e-6"),
    ]
}

/// The room with one of everything, its mirror and its glass rough.
fn room(name: &'static str, risk: &'static str, alpha: f64) -> Case {
    Case::new(name, risk, move |setup, method| {
        let ball = json!([{"scale": 0.3}, {"translate": [-0.4, -0.5, 0.1]}]);
        let left = json!([{"rotate": {"axis": [0.0, 1.0, 0.0], "angle": 90.0}},
            {"translate": [-1.0, 0.0, 0.0]}]);
        let world = everything(Unit::SI, FILM)
            .shape("ball", "sphere", ball, json!({"bsdf": glass(alpha)}))
            .shape("left", "rectangle", left, json!({"bsdf": metal(alpha)}));
        let image = Shot::new(&world, method, &Work::LITTLE)?.render(setup.seed, 4)?;
        Ok(Finding::exact(image.total() > 0.0, format!("sound, sum {:e}", image.total())))
    })
}

fn glass(alpha: f64) -> Value {
    json!({"type": "roughdielectric", "distribution": "ggx", "alpha": alpha, "int_ior": 1.5,
        "ext_ior": 1.0})
}

fn metal(alpha: f64) -> Value {
    json!({"type": "roughconductor", "distribution": "ggx", "alpha": alpha, "eta": 0.2, "k": 3.0})
}

/// A rectangle in the plane y = 0 about z.
fn floor(z: f64) -> Value {
    json!([{"rotate": {"axis": [1.0, 0.0, 0.0], "angle": -90.0}}, {"translate": [0.0, 0.0, z]}])
}
