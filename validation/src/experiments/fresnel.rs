//! One smooth interface, or a thin slab, between two lamps: the choice between reflection and
//! refraction.
//!
//! The camera looks at a plane interface under the angle θ_i. Reflection shows one lamp with radiance
//! R L_r, refraction another with (1 − R) L_t (η_i/η_t)²: radiance over η² is what refraction keeps.
//! They arrive at different times, so that the bins tell them apart: probability of the choice,
//! its weight, the factor η², total internal reflection and OPL inside glass in one picture. R is
//! written here from the amplitudes r_s = −sin(θ_i − θ_t)/sin(θ_i + θ_t),
//! r_p = tan(θ_i − θ_t)/tan(θ_i + θ_t). A thin slab has two interfaces without a way between them:
//! its echoes are one instant, and sum to 2R/(1 + R) (Born & Wolf 1999, section 7.6, without
//! interference; R unpolarised at each interface, as in Mitsuba); what passes keeps its direction.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use tpb_beams::BeamOptions;
use tpb_optics::Rgb;
use tpb_path::PathOptions;
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, Dielectric, FovAxis, Primitive, Reflector, Scene, Sensor, ShapePart, TimeSpec,
};

use crate::contrasts::{LinearContrast, targets};
use crate::cube::Cube;
use crate::error::Result;
use crate::experiment::{Context, Effort, Experiment, Outcome};
use crate::measure::{BatchPlan, Estimator, batches};
use crate::registry::Experiments;
use crate::sabotage::Sabotage;
use crate::scenes::{View, only_depth};
use crate::statistics::{Batches, Target, judge};

const TIME: TimeSpec = TimeSpec { start_opl: 0.0, bin_width_opl: 0.25, bins: 160 };
const REFLECTED: f64 = 3.0;
const TRANSMITTED: f64 = 2.0;
const GLASS: f64 = 1.5;
const SIDE: usize = 8;

/// What the camera looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Glass {
    /// The surface of a block, from outside.
    Outside,
    /// The same, from inside.
    Inside,
    /// A slab too thin to delay light.
    Thin,
}

/// Angle of incidence in degrees.
const CASES: [(f64, Glass); 8] = [
    (10.0, Glass::Outside),
    (75.0, Glass::Outside),
    (82.0, Glass::Outside),
    (40.5, Glass::Inside),
    (60.0, Glass::Inside),
    (10.0, Glass::Thin),
    (65.0, Glass::Thin),
    (80.0, Glass::Thin),
];

/// A method that chooses at interfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FresnelChoice {
    /// The path tracer.
    Path,
    /// The camera's side of photon beams.
    Beams,
}

/// Each method.
pub fn all() -> Experiments {
    vec![Arc::new(FresnelChoice::Path), Arc::new(FresnelChoice::Beams)]
}

/// What is expected of one case.
struct Expected {
    reflected: f64,
    transmitted: f64,
    reflected_opl: f64,
    transmitted_opl: f64,
    /// (η_i/η_t)², by which refraction changes radiance.
    eta_squared: f64,
}

fn expected(angle: f64, glass: Glass) -> Expected {
    let (eta_i, eta_t) = if glass == Glass::Inside { (GLASS, 1.0) } else { (1.0, GLASS) };
    let theta_i = angle.to_radians();
    let sine = eta_i / eta_t * theta_i.sin();
    let reflected_opl = eta_i * 3.0 / theta_i.cos();
    if sine >= 1.0 {
        let nothing = Expected {
            reflected: REFLECTED,
            transmitted: 0.0,
            reflected_opl,
            transmitted_opl: 0.0,
            eta_squared: 1.0,
        };
        return nothing;
    }
    let theta_t = sine.asin();
    let s = (theta_i - theta_t).sin() / (theta_i + theta_t).sin();
    let p = (theta_i - theta_t).tan() / (theta_i + theta_t).tan();
    let reflectance = 0.5 * (s * s + p * p);
    if glass == Glass::Thin {
        let reflectance = 2.0 * reflectance / (1.0 + reflectance);
        return Expected {
            reflected: reflectance * REFLECTED,
            transmitted: (1.0 - reflectance) * TRANSMITTED,
            reflected_opl,
            transmitted_opl: 2.0 / theta_i.cos(),
            eta_squared: 1.0,
        };
    }
    Expected {
        reflected: reflectance * REFLECTED,
        transmitted: (1.0 - reflectance) * TRANSMITTED * (eta_i / eta_t).powi(2),
        reflected_opl,
        transmitted_opl: eta_i / theta_i.cos() + eta_t / theta_t.cos(),
        eta_squared: (eta_i / eta_t).powi(2),
    }
}

/// Interface at z = 1, a lamp behind it at z = 2, and one behind the camera at z = −1.
fn scene(angle: f64, glass: Glass) -> Result<Scene> {
    let view = View { pixels: SIDE, fov: 0.01, time: Some(TIME), integrator: only_depth(2) };
    let mut parts = view.parts();
    let to_world = DAffine3::from_rotation_y(angle.to_radians());
    parts.sensor = Sensor::perspective(to_world, view.fov, FovAxis::X, SIDE, SIDE);
    let disc = |z: f64, towards: f64| {
        let (u, v) = (100.0 * DVec3::X, 100.0 * towards * DVec3::Y);
        vec![Primitive::Planar(Planar::new(DVec3::new(0.0, 0.0, z), u, v, Outline::Ellipse))]
    };
    let lamp = |name: &str, z, towards, radiance| ShapePart {
        name: name.into(),
        primitives: disc(z, towards),
        bsdf: Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black },
        boundary: None,
        radiance: Some(Rgb::splat(radiance)),
    };
    // The interior is opposite to the normal.
    let dielectric = Dielectric {
        interior_eta: GLASS,
        exterior_eta: 1.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    };
    parts.shapes = vec![
        ShapePart {
            name: "interface".into(),
            primitives: disc(1.0, if glass == Glass::Inside { 1.0 } else { -1.0 }),
            bsdf: match glass {
                Glass::Thin => Bsdf::ThinDielectric(dielectric),
                Glass::Outside | Glass::Inside => Bsdf::Dielectric(dielectric),
            },
            boundary: None,
            radiance: None,
        },
        lamp("behind the interface", 2.0, -1.0, TRANSMITTED),
        lamp("behind the camera", -1.0, 1.0, REFLECTED),
    ];
    Ok(Scene::assemble(parts)?)
}

/// The light of all pixels that arrives within a bin of `opl`.
fn around(name: String, opl: f64) -> LinearContrast {
    let bin = (opl / TIME.bin_width_opl).floor() as usize + 1;
    let weight = |cell: usize| f64::from(u8::from(cell.abs_diff(bin) <= 1));
    let per_pixel = 1.0 / (SIDE * SIDE) as f64;
    let weights = (0..TIME.bins + 2).map(|cell| weight(cell) * per_pixel).collect();
    LinearContrast { name, pixels: (0..SIDE * SIDE).collect(), weights }
}

impl FresnelChoice {
    fn estimator(self) -> Estimator {
        match self {
            Self::Path => Estimator::Path(PathOptions { samples_per_pass: 1600.try_into().ok() }),
            Self::Beams => Estimator::Beams(BeamOptions {
                surface_samples: Some(1600),
                ..BeamOptions::default()
            }),
        }
    }

    fn case(
        self,
        context: &Context,
        angle: f64,
        glass: Glass,
    ) -> Result<(Vec<Target>, Vec<Vec<f64>>)> {
        let scene = scene(angle, glass)?;
        let e = expected(angle, glass);
        let side = match glass {
            Glass::Outside => "from outside",
            Glass::Inside => "from inside",
            Glass::Thin => "at a thin slab",
        };
        let mut contrasts = vec![];
        // A rare part is known from its complement.
        for (what, value, opl, eta_squared) in [
            ("reflected", e.reflected, e.reflected_opl, 1.0),
            ("refracted", e.transmitted, e.transmitted_opl, e.eta_squared),
        ] {
            if value > 0.15 * REFLECTED {
                let mut contrast = around(format!("{what} at {angle} degrees {side}"), opl);
                if context.sabotage == Some(Sabotage::EtaSquared) {
                    contrast.weights.iter_mut().for_each(|weight| *weight /= eta_squared);
                }
                contrasts.push((contrast, value));
            }
        }
        let plan = BatchPlan { batches: 64, passes: context.effort.pick(1, 2), seed: context.seed };
        let mut values = Vec::new();
        batches(&scene, &self.estimator(), context.layout(&scene.film)?, &plan, |cube: &Cube| {
            values.push(contrasts.iter().map(|(c, _)| c.value(cube)).collect());
        })?;
        let linear: Vec<LinearContrast> = contrasts.iter().map(|(c, _)| c.clone()).collect();
        let mut targets = targets(&linear, &Cube::zero(SIDE, SIDE, TIME.bins), None);
        for (target, (_, value)) in targets.iter_mut().zip(&contrasts) {
            // The pixels span a hundredth of a degree.
            (target.expected, target.error) = (*value, 2e-6 * value);
        }
        Ok((targets, values))
    }
}

impl Experiment for FresnelChoice {
    fn name(&self) -> String {
        format!("fresnel/{}", self.estimator().name())
    }

    fn description(&self) -> String {
        "reflection and refraction at one interface and at a thin slab, told apart by time, against \
         Fresnel".into()
    }

    fn twins(&self, effort: Effort) -> Vec<Sabotage> {
        let tried = effort == Effort::Full || *self == Self::Path;
        if tried { vec![Sabotage::EtaSquared] } else { vec![] }
    }

    fn run(&self, context: &Context) -> Result<Outcome> {
        let (mut targets, mut values) = (Vec::new(), vec![Vec::new(); 64]);
        for (angle, glass) in CASES {
            let (more, columns) = self.case(context, angle, glass)?;
            targets.extend(more);
            for (row, column) in values.iter_mut().zip(columns) {
                row.extend(column);
            }
        }
        let mut batches = Batches::new();
        for row in values {
            batches.push(row);
        }
        Ok(judge(&targets, &batches, &context.unbiased()).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_conserved_and_total_reflection_is_total() {
        for (angle, glass) in CASES {
            let e = expected(angle, glass);
            let factor = match glass {
                Glass::Outside => 1.0 / (GLASS * GLASS),
                Glass::Inside => GLASS * GLASS,
                Glass::Thin => 1.0,
            };
            let sum = e.reflected / REFLECTED + e.transmitted / (TRANSMITTED * factor);
            assert!((sum - 1.0).abs() < 1e-14);
        }
        assert_eq!(expected(60.0, Glass::Inside).transmitted, 0.0);
    }
}
