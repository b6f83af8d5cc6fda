//! What a run of this scene needs, and what is left out, with the reason: a scene pays only for
//! what it has.
//!
//! The plan is computed once, printed by `tpb plan`, and written into every report. Integrators
//! read its switches; they do not look at the scene again to decide what to do.

use std::fmt;

use serde::Serialize;
use tpb_optics::Rgb;

use crate::{Bsdf, EmitterKind, IntegratorSpec, MethodName, PixelFormat, Scene, TimeSpec};

/// What a render of a scene needs.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent switch of the run")]
pub struct Plan {
    /// Channels that light is transported in.
    pub transport: Transport,
    /// What media there are.
    pub media: Media,
    /// Shapes that refract.
    pub refracting: Vec<String>,
    /// Shapes that reflect as mirrors.
    pub mirrors: Vec<String>,
    /// Shapes that scatter diffusely.
    pub diffuse: Vec<String>,
    /// Emitters that a camera's path cannot connect to.
    pub unconnectable: Vec<String>,
    /// Photon beams are traced and gathered.
    pub beams: bool,
    /// Photons are kept on diffuse surfaces.
    pub surface_photons: bool,
    /// Light is connected from emitters to media and surfaces.
    pub next_event_estimation: bool,
    /// The kernel that fits the scene.
    pub kernel: Kernel,
    /// The film keeps time bins.
    pub time_bins: bool,
    /// What the run does, one line each.
    pub needs: Vec<Item>,
    /// What the run leaves out, one line each.
    pub left_out: Vec<Item>,
}

/// Channels that light is transported in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Transport {
    /// One channel: no colour anywhere.
    Mono,
    /// Three channels.
    Rgb,
}

/// What media there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Media {
    /// Vacuum everywhere.
    None,
    /// Only media that absorb.
    Absorbing,
    /// Some medium scatters.
    Scattering,
}

/// Blur kernel of the beam estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Kernel {
    /// A segment across beam and ray; no spread in time.
    #[serde(rename = "1d")]
    OneD,
    /// A disc across the beam (the source's case).
    #[serde(rename = "2d")]
    TwoD,
}

/// One line of the plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Item {
    /// The part.
    pub part: String,
    /// Why it is needed or not.
    pub reason: String,
    /// The only method that it concerns; `None` concerns all.
    #[serde(skip)]
    pub only: Option<MethodName>,
}

impl Plan {
    /// Looks at the scene, with the depths that this run uses.
    pub fn new(scene: &Scene, integrator: &IntegratorSpec) -> Self {
        let named = |wanted: &dyn Fn(&Bsdf) -> bool| -> Vec<String> {
            scene.shapes.iter().filter(|s| wanted(&s.bsdf)).map(|s| s.name.clone()).collect()
        };
        let refracting = named(&|b| matches!(b, Bsdf::Dielectric(_)));
        let mirrors = named(&Bsdf::is_mirror);
        let diffuse = named(&Bsdf::scatters_diffusely);
        let media = media(scene);
        let lit = !scene.power().is_zero();
        let scattering = media == Media::Scattering;
        let specular = !(refracting.is_empty() && mirrors.is_empty());
        let beams = lit && scattering && integrator.reaches(2);
        let indirect = scattering || specular || !diffuse.is_empty();
        // Next-event estimation owns direct light, except a laser's.
        let least_depth = if unconnectable(scene).is_empty() { 3 } else { 2 };
        let surface_photons =
            lit && !diffuse.is_empty() && indirect && integrator.reaches(least_depth);
        let connectable = scene.emitters.iter().any(|e| e.kind.can_be_connected());
        let mut plan = Self {
            transport: if is_chromatic(scene) { Transport::Rgb } else { Transport::Mono },
            media,
            unconnectable: unconnectable(scene),
            beams,
            surface_photons,
            next_event_estimation: connectable
                && (scattering || !diffuse.is_empty())
                && integrator.reaches(2),
            kernel: kernel(scene),
            time_bins: scene.film.time.is_some(),
            refracting,
            mirrors,
            diffuse,
            needs: vec![],
            left_out: vec![],
        };
        plan.explain(scene, integrator);
        plan
    }

    /// The same with the lines that concern this method.
    #[must_use]
    pub fn of_method(mut self, method: MethodName) -> Self {
        let concerns = |item: &Item| item.only.is_none_or(|only| only == method);
        self.needs.retain(concerns);
        self.left_out.retain(concerns);
        self
    }

    fn explain(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        self.explain_channels(scene);
        self.explain_media(scene, integrator);
        self.explain_surfaces(scene, integrator);
        match scene.film.time {
            Some(TimeSpec { start_opl, bin_width_opl, bins }) => self.need(
                "time bins",
                format!(
                    "{bins} bins of {bin_width_opl} m from {start_opl} m, and two cells beside"
                ),
            ),
            None => self.omit("time bins", "the film has no time axis".to_owned()),
        }
    }

    fn explain_channels(&mut self, scene: &Scene) {
        match (self.transport, scene.film.pixel_format) {
            (Transport::Mono, PixelFormat::Luminance) => {
                self.need("one channel", "the scene is achromatic".to_owned());
                self.omit("two more channels", "the scene is achromatic".to_owned());
            }
            (Transport::Mono, PixelFormat::Rgb) => {
                self.need("one channel", "the scene is achromatic; written three times".to_owned());
                self.omit("two more channels", "the scene is achromatic".to_owned());
            }
            (Transport::Rgb, PixelFormat::Rgb) => {
                self.need("three channels", "the scene has colour".to_owned());
            }
            (Transport::Rgb, PixelFormat::Luminance) => {
                let reason = "the scene has colour; the film keeps its luminance";
                self.need("three channels", reason.to_owned());
            }
        }
    }

    fn explain_media(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let names = scene.media.iter().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", ");
        match self.media {
            Media::None => self.omit("media", "vacuum everywhere".to_owned()),
            Media::Absorbing => self.need("transmittance", format!("media: {names}")),
            Media::Scattering => {
                self.need("transmittance and scattering", format!("media: {names}"));
            }
        }
        if self.beams {
            let (kernel, why) = match self.kernel {
                Kernel::OneD => ("1D", "spread directions: no temporal blur, finite variance"),
                Kernel::TwoD => {
                    ("2D", "a laser lies along the view, where 1/sin of the 1D kernel diverges")
                }
            };
            self.need("photon beams", "a medium scatters light".to_owned());
            self.need(&format!("{kernel} kernel"), why.to_owned());
        } else if self.media != Media::Scattering {
            self.omit("photon beams", "no medium scatters light".to_owned());
        } else if integrator.reaches(2) {
            self.omit("photon beams", "the scene has no light".to_owned());
        } else {
            self.omit("photon beams", "max_depth leaves no scattering".to_owned());
        }
    }

    fn explain_surfaces(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let specular = [self.refracting.clone(), self.mirrors.clone()].concat();
        if specular.is_empty() {
            self.omit("specular chains", "no mirror and no refracting boundary".to_owned());
        } else {
            self.need("specular chains", format!("shapes: {}", specular.join(", ")));
        }
        if self.surface_photons {
            self.need("surface photons", format!("diffuse shapes: {}", self.diffuse.join(", ")));
        } else if self.diffuse.is_empty() {
            self.omit("surface photons", "no surface scatters diffusely".to_owned());
        } else if integrator.reaches(3) {
            self.omit("surface photons", "the scene has no light".to_owned());
        } else {
            self.omit("surface photons", "max_depth leaves no indirect light".to_owned());
        }
        if self.next_event_estimation {
            self.need("next-event estimation", "emitters that a path can connect to".to_owned());
        } else {
            self.omit(
                "next-event estimation",
                "nothing scatters, or no emitter to connect to".into(),
            );
        }
        if !self.unconnectable.is_empty() {
            let names = self.unconnectable.join(", ");
            self.omit(
                "light of collimated emitters in the path tracer",
                format!("a path cannot connect to: {names}; photon beams render it"),
            );
        }
        let points = scene
            .emitters
            .iter()
            .any(|e| matches!(e.kind, EmitterKind::Point { .. } | EmitterKind::Spot { .. }));
        if points && !specular.is_empty() {
            self.omit(
                "caustics of point and spot emitters in the path tracer",
                "no path can hit a point through a specular boundary; photon beams render them"
                    .into(),
            );
        }
    }

    fn need(&mut self, part: &str, reason: String) {
        self.needs.push(item(part, reason));
    }

    fn omit(&mut self, part: &str, reason: String) {
        self.left_out.push(item(part, reason));
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (title, items) in [("needs", &self.needs), ("leaves out", &self.left_out)] {
            writeln!(f, "{title}:")?;
            for Item { part, reason, .. } in items {
                writeln!(f, "  {part:<30} {reason}")?;
            }
        }
        Ok(())
    }
}

/// A line of the plan; what it concerns is told by its part.
fn item(part: &str, reason: String) -> Item {
    let only = match part {
        "photon beams" | "1D kernel" | "2D kernel" | "surface photons" => Some(MethodName::Beams),
        _ if part.ends_with("in the path tracer") => Some(MethodName::Path),
        _ => None,
    };
    Item { part: part.to_owned(), reason, only }
}

fn media(scene: &Scene) -> Media {
    let scatters = scene.media.iter().any(|m| m.coefficients.scatters());
    let takes = scene.media.iter().any(|m| !m.coefficients.sigma_t.is_zero());
    match (scatters, takes) {
        (true, _) => Media::Scattering,
        (false, true) => Media::Absorbing,
        (false, false) => Media::None,
    }
}

fn is_chromatic(scene: &Scene) -> bool {
    let media = scene.media.iter().flat_map(|m| [m.coefficients.sigma_s, m.coefficients.sigma_t]);
    let surfaces = scene.shapes.iter().flat_map(|s| s.bsdf.factors());
    let emitters = scene.emitters.iter().map(|e| e.kind.color());
    media.chain(surfaces).chain(emitters).any(|c| !Rgb::is_achromatic(c))
}

fn unconnectable(scene: &Scene) -> Vec<String> {
    let hidden = scene.emitters.iter().filter(|e| !e.kind.can_be_connected());
    hidden.map(|e| e.name.clone()).collect()
}

/// A laser whose axis the camera looks along (either way) needs the 2D kernel.
fn kernel(scene: &Scene) -> Kernel {
    let (w, h) = (scene.film.width as f64, scene.film.height as f64);
    let forward = scene.sensor.forward();
    // The cone around the view axis through the film's corners.
    let cos_corner = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)]
        .map(|(x, y)| scene.sensor.direction(x, y).dot(forward))
        .into_iter()
        .fold(1.0, f64::min);
    let along_view = scene.emitters.iter().any(|e| match e.kind {
        EmitterKind::Laser { axis, .. } => axis.dot(forward).abs() >= cos_corner,
        _ => false,
    });
    if along_view { Kernel::TwoD } else { Kernel::OneD }
}
