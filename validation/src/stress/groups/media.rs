//! Media: optical thickness, albedo, phase functions, colour.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use serde_json::json;

use crate::contrasts::LinearContrast;
use crate::error::Result;
use crate::stress::case::{Case, Finding, Method, Work};
use crate::stress::laws::{Expected, agrees};
use crate::stress::pencil::{NO_PATH, Pencil};
use crate::stress::shot::Shot;
use crate::stress::single::Single;
use crate::stress::world::{Film, Fog, Unit, World};
use crate::stress::worlds::{foggy_furnace, steady};

/// Why short beams are left out of thick media.
const NO_SHORT: &str = "a short beam gets so deep by chance only: no 2 % within the budget (beams-2d shares the kernel)";

pub(super) fn cases() -> Vec<Case> {
    [thickness(), albedo(), phase(), colour()].into_iter().flatten().collect()
}

/// Photons and passes that resolve 2 % of the usual single scattering.
pub(super) fn effort(method: Method) -> (Work, u64) {
    let work = Work { samples: 4, photons: 8000, radius: None, surface_radius: None };
    match method {
        Method::Path => (Work { samples: 1024, ..work }, 1),
        // Its variance is infinite with the eye in fog (the plan says so): it converges slowly.
        Method::Light => (Work { photons: 400_000, ..work }, 1),
        // A pair costs the 3D kernel a quadrature.
        Method::Beams3d => (Work { samples: 1, photons: 16_000, ..work }, 2),
        Method::BeamsShort => (Work { samples: 1, photons: 16_000, ..work }, 6),
        Method::Beams1d | Method::Beams2d => (Work { samples: 1, photons: 16_000, ..work }, 3),
    }
}

fn single(
    name: &str,
    risk: &'static str,
    scene: impl Fn() -> Single + Send + Sync + 'static,
) -> Case {
    Case::new(name, risk, move |setup, method| {
        let (work, passes) = effort(method);
        scene().agrees(method, &work, (setup.seed, passes), 1.0)
    })
}

fn pencil(
    name: &str,
    risk: &'static str,
    scene: impl Fn() -> Pencil + Send + Sync + 'static,
) -> Case {
    Case::new(name, risk, move |setup, method| scene().agrees(method, setup.seed, 1.0))
        .without(Method::Path, NO_PATH)
}

fn thickness() -> Vec<Case> {
    let mut cases = Vec::new();
    for thickness in [1e-6, 1.0] {
        cases.push(single(
            &format!("thickness/fog-{thickness:e}"),
            "free flights that almost never, or almost always, collide: noise, 0/0, lost tails",
            move || Single {
                fog: Fog::grey(0.8 * thickness, 0.2 * thickness, 0.0),
                ..Single::USUAL
            },
        ));
    }
    let thick = Single { fog: Fog::grey(8.0, 2.0, 0.0), bins: (0.5, 0.25, 8), ..Single::USUAL };
    cases.push(
        Case::new(
            "thickness/fog-1e1",
            "transmittance of 1e-5: light that few photons carry",
            move |setup, method| {
                let (work, passes) = effort(method);
                let work = Work { photons: 4 * work.photons, ..work };
                thick.agrees(method, &work, (setup.seed, passes), 1.0)
            },
        )
        .without(Method::BeamsShort, NO_SHORT)
        .without(
            Method::Beams3d,
            "2 % of so few photons' light costs minutes of quadratures: thickness/pencil-1e2 instead",
        )
        .without(
            Method::Light,
            "infinite variance with the eye in fog (the plan says so): thickness/pencil-1e2 instead",
        ),
    );
    cases.push(Case::new(
        "thickness/fog-1e6",
        "transmittance exp(-1e6) = 0: NaN from 0/0 or inf x 0, passes without end",
        |setup, method| {
            let fog = Fog::grey(8e5, 2e5, 0.0);
            let shot = Single { fog, ..Single::USUAL }.shot(method, &Work::LITTLE)?;
            let total = shot.render(setup.seed, 4)?.total();
            Ok(Finding::exact(total == 0.0, format!("sum {total:e}, exactly 0 in f64")))
        },
    ));
    for thickness in [1e-6, 1.0] {
        cases.push(pencil(
            &format!("thickness/pencil-{thickness:e}"),
            "transmittance that is lost against 1, collisions that never happen",
            move || Pencil {
                fog: Fog::grey(0.8 * thickness, 0.2 * thickness, 0.0),
                ..Pencil::USUAL
            },
        ));
    }
    cases.push(
        pencil("thickness/pencil-1e2", "contributions of 1e-87 of the light", || Pencil {
            fog: Fog::grey(80.0, 20.0, 0.0),
            power: 1e80,
            ..Pencil::USUAL
        })
        .without(Method::BeamsShort, NO_SHORT),
    );
    for thickness in [1e3, 1e6] {
        cases.push(
            Case::new(
                format!("thickness/wall-{thickness:e}"),
                "all that is seen happens within 1e-6 of the scene: cancellation in distances",
                move |setup, method| wall(setup.seed, method, thickness),
            )
            .without(Method::Path, NO_PATH)
            .without(
                Method::Beams3d,
                "a sphere's blur across the boundary has no closed form (pencils check the kernel)",
            ),
        );
    }
    cases
}

/// A laser meets a half-space of dense fog straight; seen under 45°, its spot has the radiance
/// E ϖ p/(1 + μ), E the irradiance and μ the cosine of the view. Blur is along the boundary only, and
/// the spot is wide: every radius has the same expectation.
fn wall(seed: u64, method: Method, sigma_t: f64) -> Result<Finding> {
    let mean_free_path = 1.0 / sigma_t;
    let (spot, radius, view) = (20.0 * mean_free_path, mean_free_path, mean_free_path);
    let world = World::new(Unit::SI).depths(2, 2);
    let albedo = 0.8;
    let fog = world.fog(Fog::grey(albedo * sigma_t, (1.0 - albedo) * sigma_t, 0.0), None);
    let film = Film { width: 2, height: 2, start: 0.0, bin: 10.0, bins: 1, rgb: false };
    let eye = [-FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2];
    let fov = 2.0 * view.atan().to_degrees();
    let boundary = json!({"bsdf": {"type": "null"}, "interior": {"type": "ref", "id": "fog"}});
    let turn = json!([{"rotate": {"axis": [0.0, 1.0, 0.0], "angle": 180.0}}]);
    let world = world
        .with("fog", fog)
        .camera(eye, [0.0; 3], [0.0, 1.0, 0.0], fov, film)
        .shape("boundary", "rectangle", turn, boundary)
        .laser([0.0, 0.0, -1.0], [0.0; 3], spot, 1.0);
    let irradiance = 1.0 / (PI * spot * spot);
    let radiance = irradiance * albedo * 0.25 / PI / (1.0 + FRAC_1_SQRT_2);
    let weights = vec![1.0; 3];
    let contrast = LinearContrast { name: "all light".into(), pixels: (0..4).collect(), weights };
    // The spot's rim is 20 free paths away: e^-20 of the light.
    let expected = Expected::grey(vec![contrast], vec![(4.0 * radiance, 1e-5 * radiance)]);
    let photons = if method == Method::Light { 200_000 } else { 100_000 };
    let work = Work { samples: 64, photons, radius: Some(radius), surface_radius: None };
    agrees(&Shot::new(&world, method, &work)?, seed, 1, &expected)
}

fn albedo() -> Vec<Case> {
    let mut cases = vec![Case::new(
        "albedo/0",
        "weights of 0, roulette on nothing, a plan without scattering",
        |setup, method| {
            let fog = Fog::grey(0.0, 0.5, 0.0);
            let shot = Single { fog, ..Single::USUAL }.shot(method, &Work::LITTLE)?;
            let image = shot.render(setup.seed, 2)?;
            let total = image.total();
            Ok(Finding::exact(total == 0.0, format!("sum {total:e}, exactly 0: nothing scatters")))
        },
    )];
    for (name, absorption) in [("1-1e-12", 1e-12), ("1", 0.0)] {
        cases.push(single(
            &format!("albedo/{name}"),
            "absorption that is lost against 1, or none at all",
            move || Single {
                fog: Fog::grey(0.5 * (1.0 - absorption), 0.5 * absorption, 0.0),
                ..Single::USUAL
            },
        ));
        cases.push(
            Case::new(
                format!("albedo/furnace-{name}"),
                "light of all orders that nothing absorbs: it must neither fade nor grow",
                move |setup, method| lit_fog(setup.seed, method, absorption),
            )
            .without(Method::BeamsShort, "as beams-2d, with more noise: photons scatter alike"),
        );
    }
    cases
}

/// Fog that absorbs nothing within walls of radiance 1 has the radiance 1 everywhere.
fn lit_fog(seed: u64, method: Method, absorption: f64) -> Result<Finding> {
    let sigma = 0.5;
    let fog = Fog::grey(sigma * (1.0 - absorption), sigma * absorption, 0.5);
    let world = foggy_furnace(fog, steady(4));
    let radius = 2e-3;
    let samples = if method == Method::Path { 256 } else { 8 };
    let work = Work { samples, photons: 20_000, radius: Some(radius), surface_radius: None };
    let pixels = (0..16).collect();
    let contrast = LinearContrast { name: "all light".into(), pixels, weights: vec![0.0, 0.0] };
    let expected = Expected::grey(vec![contrast], vec![(16.0, 16.0 * radius)]).steady();
    agrees(&Shot::new(&world, method, &work)?, seed, 2, &expected)
}

fn phase() -> Vec<Case> {
    let mut cases = Vec::new();
    // Towards the lamp for forward peaks, away from it for backward ones: where the peak is seen.
    for (g, angle) in [(0.999, 4.0), (-0.999, 176.0)] {
        cases.push(
            single(
                &format!("phase/fog-g{g}"),
                "a peak of 1e6 times the mean: cancellation near it, fireflies",
                move || Single {
                    fog: Fog::grey(0.4, 0.1, g),
                    view: (angle, 2.0),
                    bins: (0.9, 0.4, 12),
                    radius: 0.05,
                    ..Single::USUAL
                },
            )
            .only(
                &[Method::Path],
                "rays almost along beams are the pencils' task: there the beam is not left to chance",
            ),
        );
    }
    for (g, psi) in [(0.999, PI - 1e-3), (-0.999, 1e-3), (0.999, 1.0), (-0.999, 1.0)] {
        cases.push(pencil(
            &format!("phase/pencil-g{g}-psi{psi:.3}"),
            "a peak of 1e6 times the mean: cancellation near it",
            move || Pencil {
                fog: Fog::grey(0.4, 0.1, g),
                psi,
                radius: if psi == 1.0 { 1e-3 } else { 1e-5 },
                ..Pencil::USUAL
            },
        ));
    }
    cases
}

fn colour() -> Vec<Case> {
    vec![single(
        "colour/sigma-1e6-apart",
        "one distance for channels of depth 1e-6 and 1: unbounded weights, 0/0",
        || Single {
            fog: Fog { sigma_s: [0.8e-6, 0.8e-3, 0.8], sigma_a: [0.2e-6, 0.2e-3, 0.2], g: 0.0 },
            ..Single::USUAL
        },
    )]
}
