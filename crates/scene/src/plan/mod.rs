//! What a run of this scene needs, and what is left out, with the reason: a scene pays only for
//! what it has.
//!
//! The plan is computed once, printed by `tpb plan`, and written into every report. Integrators
//! read its switches; they do not look at the scene again to decide what to do.

mod look;

use std::fmt;

use serde::Serialize;

use self::look::{emitters, endless, has_lamps, is_chromatic, kernel, media};
use crate::{Bsdf, EmitterKind, IntegratorSpec, MethodName, PixelFormat, Scene, TimeSpec};

/// What a render of a scene needs.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent switch of the run")]
pub struct Plan {
    /// Channels that light is transported in.
    pub transport: Transport,
    /// What media there are.
    pub media: Media,
    /// Shapes of smooth glass: interfaces and thin slabs.
    pub refracting: Vec<String>,
    /// Shapes that reflect as mirrors.
    pub mirrors: Vec<String>,
    /// Shapes of rough metal or rough glass.
    pub rough: Vec<String>,
    /// Shapes that scatter diffusely.
    pub diffuse: Vec<String>,
    /// Emitters that a camera's path cannot connect to.
    pub unconnectable: Vec<String>,
    /// Why light may never end, so that paths need a limit of depth; empty if it always ends.
    pub endless: Vec<String>,
    /// Photon beams are traced and gathered.
    pub beams: bool,
    /// Photons are kept on diffuse surfaces.
    pub surface_photons: bool,
    /// Some of them are of caustics, or of spots of lasers.
    pub caustic_photons: bool,
    /// Pixels that see emitters with an area get more rays for these.
    pub lamp_rays: bool,
    /// Light is connected from emitters to media and surfaces.
    pub next_event_estimation: bool,
    /// Photons are connected from emitters, surfaces and media to the pinhole.
    pub eye_connections: bool,
    /// The kernel that fits the scene.
    pub kernel: Kernel,
    /// The film keeps time bins.
    pub time_bins: bool,
    /// It keeps them alone, and light that can only arrive outside their window is not followed.
    pub culled_by_window: bool,
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
    /// Whether light is missing from the image because this part is left out.
    pub loses_light: bool,
    /// The methods that it concerns.
    #[serde(skip)]
    pub methods: &'static [MethodName],
}

/// What concerns every method.
const ALL: &[MethodName] = &[MethodName::Path, MethodName::Beams, MethodName::Light];
/// Methods that connect camera paths to lights.
const FROM_THE_EYE: &[MethodName] = &[MethodName::Path, MethodName::Beams];
const PATH: &[MethodName] = &[MethodName::Path];
const BEAMS: &[MethodName] = &[MethodName::Beams];
const LIGHT: &[MethodName] = &[MethodName::Light];

/// Whether a part is needed (`Ok`) or left out (`Err`), each with the reason.
type Decision = Result<String, String>;

impl Plan {
    /// Looks at the scene, with the depths that this run uses.
    pub fn new(scene: &Scene, integrator: &IntegratorSpec) -> Self {
        let named = |wanted: &dyn Fn(&Bsdf) -> bool| -> Vec<String> {
            scene.shapes.iter().filter(|s| wanted(&s.bsdf)).map(|s| s.name.clone()).collect()
        };
        let mut plan = Self {
            transport: if is_chromatic(scene) { Transport::Rgb } else { Transport::Mono },
            media: media(scene),
            refracting: named(&Bsdf::is_smooth_glass),
            mirrors: named(&Bsdf::is_mirror),
            rough: named(&Bsdf::is_rough),
            diffuse: named(&Bsdf::scatters_diffusely),
            unconnectable: emitters(scene, |kind| !kind.can_be_connected()),
            endless: endless(scene),
            beams: false,
            surface_photons: false,
            caustic_photons: false,
            lamp_rays: false,
            next_event_estimation: false,
            eye_connections: false,
            kernel: kernel(scene),
            time_bins: scene.film.time.is_some(),
            culled_by_window: false,
            needs: vec![],
            left_out: vec![],
        };
        plan.decide_channels(scene);
        plan.decide_media(scene);
        plan.decide_beams(scene, integrator);
        plan.decide_surfaces(scene, integrator);
        plan.decide_lamp_rays(scene, integrator);
        plan.decide_connections(scene, integrator);
        plan.decide_eye_connections(scene, integrator);
        plan.tell_lost_light(scene, integrator);
        plan.tell_light_behind_specular(scene, integrator);
        plan.tell_time(scene);
        plan
    }

    /// The same with the lines that concern this method.
    #[must_use]
    pub fn of_method(mut self, method: MethodName) -> Self {
        let concerns = |item: &Item| item.methods.contains(&method);
        self.needs.retain(concerns);
        self.left_out.retain(concerns);
        self
    }

    /// The same for a film that keeps its window alone: neither what arrives outside nor the steady
    /// image. A film that `unwarp`s counts times from each pixel's first surface: there, when light
    /// leaves its emitter does not tell whether it can arrive within the window.
    #[must_use]
    pub fn keeping_window_only(mut self, unwarp: bool) -> Self {
        self.lose(ALL, "light outside the window", "the bins alone are kept, as asked");
        let culled = |what: &str| {
            if unwarp {
                Ok("followed: times are counted from each pixel's first surface".to_owned())
            } else {
                Err(format!("{what} end once all that comes of them arrives after the window"))
            }
        };
        self.note(PATH, "paths to after the window", culled("camera paths and connections"));
        self.note(LIGHT, "photons to after the window", culled("photons and connections"));
        let beams = "photons and camera paths";
        self.note(BEAMS, "photons to after the window", culled(beams));
        if self.beams {
            let reason =
                "what of a beam can arrive at the eye only before or after it is not drawn";
            let decision = if unwarp { culled("") } else { Err(reason.to_owned()) };
            self.note(BEAMS, "beams outside the window", decision);
        }
        self.culled_by_window = !unwarp;
        self
    }

    fn decide_channels(&mut self, scene: &Scene) {
        let reason = match (self.transport, scene.film.pixel_format) {
            (Transport::Mono, PixelFormat::Luminance) => "the scene is achromatic",
            (Transport::Mono, PixelFormat::Rgb) => "the scene is achromatic; written three times",
            (Transport::Rgb, PixelFormat::Rgb) => "the scene has colour",
            (Transport::Rgb, PixelFormat::Luminance) => {
                "the scene has colour; the film keeps its luminance"
            }
        };
        let channels = match self.transport {
            Transport::Mono => "one channel",
            Transport::Rgb => "three channels",
        };
        self.note(ALL, channels, Ok(reason.to_owned()));
        if self.transport == Transport::Mono {
            self.note(ALL, "two more channels", Err("the scene is achromatic".to_owned()));
        }
    }

    fn decide_media(&mut self, scene: &Scene) {
        let names = scene.media.iter().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", ");
        let (part, decision) = match self.media {
            Media::None => ("media", Err("vacuum everywhere".to_owned())),
            Media::Absorbing => ("transmittance", Ok(format!("media: {names}"))),
            Media::Scattering => ("transmittance and scattering", Ok(format!("media: {names}"))),
        };
        self.note(ALL, part, decision);
    }

    fn decide_beams(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let decision = if self.media != Media::Scattering {
            Err("no medium scatters light")
        } else if scene.power().is_zero() {
            Err("the scene has no light")
        } else if !integrator.reaches(2) {
            Err("max_depth leaves no scattering")
        } else {
            Ok("a medium scatters light")
        };
        self.beams = self.note(BEAMS, "photon beams", owned(decision));
        if self.beams {
            let (kernel, why) = match self.kernel {
                Kernel::TwoD => (
                    "2D kernel",
                    "collimated light lies along the view, where 1/sin of the 1D kernel diverges",
                ),
                Kernel::OneD if self.unconnectable.is_empty() => {
                    ("1D kernel", "spread directions: no temporal blur, finite variance")
                }
                Kernel::OneD => (
                    "1D kernel",
                    "no temporal blur; sound unless laser light is turned along the view",
                ),
            };
            self.note(BEAMS, kernel, Ok(why.to_owned()));
        }
    }

    fn decide_surfaces(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let specular = [&self.refracting[..], &self.mirrors].concat().join(", ");
        self.note(
            ALL,
            "specular chains",
            if specular.is_empty() {
                Err("no mirror and no refracting boundary".to_owned())
            } else {
                Ok(format!("shapes: {specular}"))
            },
        );
        if !self.rough.is_empty() {
            let shapes = format!("shapes: {}", self.rough.join(", "));
            self.note(ALL, "rough reflection and refraction", Ok(shapes));
        }
        // Next-event estimation owns direct light, except a laser's.
        let least_depth = if self.unconnectable.is_empty() { 3 } else { 2 };
        let decision = if self.diffuse.is_empty() {
            Err("no surface scatters diffusely".to_owned())
        } else if scene.power().is_zero() {
            Err("the scene has no light".to_owned())
        } else if !integrator.reaches(least_depth) {
            Err("max_depth leaves no light for them".to_owned())
        } else {
            Ok(format!("diffuse shapes: {}", self.diffuse.join(", ")))
        };
        self.surface_photons = self.note(BEAMS, "surface photons", decision);
        if self.surface_photons {
            let decision = if !self.unconnectable.is_empty() {
                Ok(format!("straight light of {}", self.unconnectable.join(", ")))
            } else if specular.is_empty() || !integrator.reaches(3) {
                Err("no light straight from mirrors or smooth glass".to_owned())
            } else {
                Ok(format!("light straight from {specular}"))
            };
            self.caustic_photons = self.note(BEAMS, "a disc for caustics", decision);
        }
    }

    fn decide_lamp_rays(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let straight_only = self.refracting.is_empty() && self.mirrors.is_empty();
        let decision = if !has_lamps(scene) {
            Err("no emitter has an area")
        } else if !integrator.reaches(1) || (straight_only && !integrator.counts(1)) {
            Err("depths leave out emitters that are seen")
        } else {
            Ok("emitters that are seen have sharp edges")
        };
        self.lamp_rays = self.note(BEAMS, "more rays to lamps", owned(decision));
    }

    /// Beams connect at surfaces only, the path tracer in media too.
    fn decide_connections(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let part = "next-event estimation";
        let (surfaces, media) = (self.surfaces_spread(), self.media == Media::Scattering);
        let decision = if emitters(scene, EmitterKind::can_be_connected).is_empty() {
            Err("no emitter that a path can connect to")
        } else if !integrator.reaches(2) {
            Err("max_depth leaves no scattering")
        } else if !surfaces && !media {
            Err("nothing scatters")
        } else {
            Ok("emitters that a path can connect to")
        };
        let in_media_only = decision.is_ok() && !surfaces;
        let methods = if in_media_only { PATH } else { FROM_THE_EYE };
        self.next_event_estimation = self.note(methods, part, owned(decision));
        if in_media_only {
            let reason = "no surface scatters diffusely; in media, beams bring all light";
            self.note(BEAMS, part, Err(reason.to_owned()));
        }
    }

    /// What the light tracer does.
    fn decide_eye_connections(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let (surfaces, media) = (self.surfaces_spread(), self.media == Media::Scattering);
        let lamps = integrator.min_depth <= 1 && has_lamps(scene);
        let decision = if scene.power().is_zero() {
            Err("the scene has no light")
        } else if !(surfaces || media || lamps) {
            Err("nothing scatters, and no emitter has an area")
        } else if !(lamps || integrator.reaches(2)) {
            Err("max_depth leaves no scattering")
        } else {
            Ok("photons at surfaces, in media and on lamps")
        };
        self.eye_connections = self.note(LIGHT, "connections to the eye", owned(decision));
        let eye = scene.sensor.region.medium.map(|id| scene.medium(id));
        if self.eye_connections && eye.is_some_and(|medium| medium.coefficients.scatters()) {
            let reason = "the eye is in fog: unbiased, but rare bright photons near the eye make \
                          the variance infinite (logarithmically); errors shown are too small";
            self.note(LIGHT, "photons close to the eye", Ok(reason.to_owned()));
        }
    }

    /// Light that a path from the camera cannot find.
    fn tell_lost_light(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let seen = self.surfaces_spread() || self.media == Media::Scattering;
        if seen && integrator.reaches(2) && !self.unconnectable.is_empty() {
            let names = self.unconnectable.join(", ");
            let reason = format!("no path can connect to: {names}; photon beams render it");
            self.lose(PATH, "light of lasers", &reason);
        }
        let points = emitters(scene, |kind| {
            kind.can_be_connected() && !matches!(kind, EmitterKind::Area { .. })
        });
        let specular = !(self.refracting.is_empty() && self.mirrors.is_empty());
        if seen && integrator.reaches(3) && specular && !points.is_empty() {
            let names = points.join(", ");
            let reason = format!("no path can hit a point by a mirror or through glass: {names}");
            let reason = format!("{reason}; photon beams render it");
            self.lose(PATH, "caustics of points and spots", &reason);
        }
        self.tell_light_lost_on_rough(integrator, &points, specular);
    }

    /// Beams find the light of a rough surface from the camera alone: by connections and by chance.
    fn tell_light_lost_on_rough(
        &mut self,
        integrator: &IntegratorSpec,
        points: &[String],
        specular: bool,
    ) {
        if self.rough.is_empty() {
            return;
        }
        if integrator.reaches(2) && !self.unconnectable.is_empty() {
            let names = self.unconnectable.join(", ");
            let reason = format!("nothing connects rough surfaces to: {names}");
            let reason = format!("{reason}; the light tracer renders it");
            self.lose(BEAMS, "light of lasers on rough surfaces", &reason);
        }
        if integrator.reaches(3) && specular && !points.is_empty() {
            let reason = format!(
                "no path can hit a point by a mirror or through glass: {}",
                points.join(", ")
            );
            let reason = format!("{reason}; the light tracer renders it");
            self.lose(BEAMS, "caustics on rough surfaces", &reason);
        }
    }

    /// Whether surfaces spread light into many directions.
    fn surfaces_spread(&self) -> bool {
        !(self.diffuse.is_empty() && self.rough.is_empty())
    }

    /// Light that the light tracer cannot find: nothing connects across mirrors and smooth glass.
    fn tell_light_behind_specular(&mut self, scene: &Scene, integrator: &IntegratorSpec) {
        let specular = [&self.refracting[..], &self.mirrors].concat().join(", ");
        // Seen in a mirror, a lamp has depth 2, what another emitter lights 3.
        let least_depth = if has_lamps(scene) { 2 } else { 3 };
        let seen = has_lamps(scene) || self.surfaces_spread() || self.media == Media::Scattering;
        let light = !scene.power().is_zero();
        if seen && light && !specular.is_empty() && integrator.reaches(least_depth) {
            let part = "light in mirrors and glass";
            let reason = format!("no photon connects to the eye across: {specular}");
            self.lose(LIGHT, part, &format!("{reason}; path and photon beams render it"));
        }
    }

    fn tell_time(&mut self, scene: &Scene) {
        let decision = match scene.film.time {
            Some(TimeSpec { start_opl, bin_width_opl, bins }) => Ok(format!(
                "{bins} bins of {bin_width_opl} m from {start_opl} m, and two cells beside"
            )),
            None => Err("the film has no time axis".to_owned()),
        };
        self.note(ALL, "time bins", decision);
    }

    /// Writes a decision down, and says whether the part is needed.
    fn note(&mut self, methods: &'static [MethodName], part: &str, decision: Decision) -> bool {
        let needed = decision.is_ok();
        let (Ok(reason) | Err(reason)) = decision;
        let item = Item { part: part.to_owned(), reason, loses_light: false, methods };
        if needed {
            self.needs.push(item);
        } else {
            self.left_out.push(item);
        }
        needed
    }

    /// Light that some methods leave out.
    fn lose(&mut self, methods: &'static [MethodName], part: &str, reason: &str) {
        let (part, reason) = (part.to_owned(), reason.to_owned());
        self.left_out.push(Item { part, reason, loses_light: true, methods });
    }
}

fn owned(decision: Result<&str, &str>) -> Decision {
    decision.map(str::to_owned).map_err(str::to_owned)
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
