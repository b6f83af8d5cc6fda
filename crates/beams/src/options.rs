//! What a user may choose, and what is chosen otherwise.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use tpb_scene::{EmitterKind, Kernel, Media, Plan, Scene};

/// Where a beam ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BeamLength {
    /// At the end of its span of the medium.
    #[default]
    Long,
    /// At the collision that the photon's free flight drew.
    Short,
}

/// How the 2D kernel spreads a pair's energy over its arrival interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Temporal {
    /// As transmittance does.
    #[default]
    Exact,
    /// Evenly (Marco et al. 2017).
    Even,
}

/// The blur kernel's dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum KernelChoice {
    /// [`crate::kernel1d`].
    #[serde(rename = "1d")]
    OneD,
    /// [`crate::kernel2d`].
    #[serde(rename = "2d")]
    TwoD,
}

/// Options of the method; what is left out is chosen from scene and film ([`Settings::new`]).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BeamOptions {
    /// Blur kernel; by default the plan's.
    pub kernel: Option<KernelChoice>,
    /// Where beams end; by default long.
    pub length: Option<BeamLength>,
    /// Spread in time of the 2D kernel; by default exact.
    pub temporal: Option<Temporal>,
    /// Radius of beams in the first pass \[m\].
    pub radius: Option<f64>,
    /// Radius of the surface photons' disc in the first pass \[m\].
    pub surface_radius: Option<f64>,
    /// The beams' radius of pass i (from 0) is multiplied by (1 + i/32)^(−`radius_exponent`);
    /// by default 1/5.
    pub radius_exponent: Option<f64>,
    /// Likewise the disc's; by default 1/6.
    pub surface_radius_exponent: Option<f64>,
    /// Photons emitted in a pass.
    pub photons_per_pass: Option<u64>,
    /// How many of them leave beams; all leave surface photons.
    pub beam_photons: Option<u64>,
    /// Camera paths per pixel and pass that gather beams.
    pub gather_samples: Option<u32>,
    /// Camera paths per pixel and pass that end on a surface.
    pub surface_samples: Option<u32>,
    /// Connections to light sources per camera path.
    pub light_samples: Option<u32>,
    /// Length of the pieces that beams are stored in, in radii.
    pub piece_radii: Option<f64>,
}

/// An option that makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("option '{option}' of the beams must be {expected}, not {found}")]
pub struct OptionError {
    /// Its name.
    pub option: &'static str,
    /// What it may be.
    pub expected: &'static str,
    /// What it is.
    pub found: f64,
}

/// All options, defaults filled in: what the report shows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Settings {
    /// Blur kernel.
    pub kernel: KernelChoice,
    /// Where beams end.
    pub length: BeamLength,
    /// Spread in time of the 2D kernel.
    pub temporal: Temporal,
    /// Radius of beams in the first pass \[m\].
    pub radius: f64,
    /// Radius of the surface photons' disc in the first pass \[m\].
    pub surface_radius: f64,
    /// The beams' radius of pass i (from 0) is multiplied by (1 + i/32)^(−`radius_exponent`).
    pub radius_exponent: f64,
    /// Likewise the disc's.
    pub surface_radius_exponent: f64,
    /// Photons emitted in a pass.
    pub photons_per_pass: u64,
    /// How many of them leave beams; all leave surface photons.
    pub beam_photons: u64,
    /// Camera paths per pixel and pass that gather beams.
    pub gather_samples: u32,
    /// Camera paths per pixel and pass that end on a surface.
    pub surface_samples: u32,
    /// Connections to light sources per camera path.
    pub light_samples: u32,
    /// Length of the pieces that beams are stored in, in radii.
    pub piece_radii: f64,
}

/// Passes over which radii keep nearly their first value.
const PASSES_BEFORE_SHRINKING: f64 = 32.0;
/// Beams that a ray meets go as photons × radius, the radius as 1/edge: so many photons leave
/// beams per pixel along the image's edge that the gather costs about as much as the tracing.
const BEAM_PHOTONS_PER_PIXEL_EDGE: f64 = 128.0;
/// Photons in a disc go as photons × radius²: so many per pixel.
const PHOTONS_PER_PIXEL: u64 = 16;
/// Passes below this cost more in overhead than in light.
const FEWEST_PHOTONS: u64 = 4096;
/// Memory: about 300 bytes per photon on surfaces, 600 in media.
const MOST_PHOTONS: u64 = 1 << 18;

impl Settings {
    /// Fills in the defaults.
    ///
    /// # Errors
    /// [`OptionError`] for radii, exponents and counts out of their range.
    pub fn new(scene: &Scene, plan: &Plan, options: &BeamOptions) -> Result<Self, OptionError> {
        let footprint = footprint(scene, plan);
        let pixels = scene.film.width * scene.film.height;
        let few = (BEAM_PHOTONS_PER_PIXEL_EDGE * (pixels as f64).sqrt()) as u64;
        let many = (PHOTONS_PER_PIXEL * pixels as u64).clamp(FEWEST_PHOTONS, MOST_PHOTONS);
        let few = few.clamp(FEWEST_PHOTONS, MOST_PHOTONS);
        let photons_per_pass = options
            .photons_per_pass
            .or(options.beam_photons)
            .unwrap_or(if plan.surface_photons { many.max(few) } else { few });
        let beam_photons = options.beam_photons.unwrap_or(few.min(photons_per_pass));
        let kernel = options.kernel.unwrap_or(match plan.kernel {
            Kernel::OneD => KernelChoice::OneD,
            Kernel::TwoD => KernelChoice::TwoD,
        });
        let settings = Self {
            kernel,
            length: options.length.unwrap_or_default(),
            temporal: options.temporal.unwrap_or_default(),
            radius: options.radius.unwrap_or(footprint),
            surface_radius: options.surface_radius.unwrap_or(2.0 * footprint),
            radius_exponent: options.radius_exponent.unwrap_or(0.2),
            surface_radius_exponent: options.surface_radius_exponent.unwrap_or(1.0 / 6.0),
            photons_per_pass,
            beam_photons,
            gather_samples: options.gather_samples.unwrap_or(2),
            surface_samples: options.surface_samples.unwrap_or(8),
            light_samples: options.light_samples.unwrap_or(4),
            piece_radii: options.piece_radii.unwrap_or(16.0),
        };
        settings.check()?;
        Ok(settings)
    }

    /// Radii of beams and discs in pass `index` \[m\].
    ///
    /// With variance ∝ 1/R for beams and 1/R² for discs, and bias ∝ R², the mean square error falls
    /// fastest with exponents 1/5 and 1/6. The first passes keep the radius nearly: it is a pixel's
    /// or two already, and shrinking from the very first pass would buy bias that noise hides.
    pub fn radii(&self, index: u64) -> (f64, f64) {
        let age = 1.0 + index as f64 / PASSES_BEFORE_SHRINKING;
        let beams = self.radius * age.powf(-self.radius_exponent);
        (beams, self.surface_radius * age.powf(-self.surface_radius_exponent))
    }

    fn check(&self) -> Result<(), OptionError> {
        let lengths = [
            ("radius", self.radius),
            ("surface_radius", self.surface_radius),
            ("piece_radii", self.piece_radii),
        ];
        for (option, found) in lengths {
            if !(found > 0.0 && found.is_finite()) {
                return Err(OptionError { option, expected: "positive and finite", found });
            }
        }
        let counts = [
            ("photons_per_pass", self.photons_per_pass),
            ("beam_photons", self.beam_photons),
            ("gather_samples", u64::from(self.gather_samples)),
            ("surface_samples", u64::from(self.surface_samples)),
            ("light_samples", u64::from(self.light_samples)),
        ];
        for (option, found) in counts {
            if found == 0 {
                return Err(OptionError { option, expected: "at least 1", found: 0.0 });
            }
        }
        if self.beam_photons > self.photons_per_pass {
            let (option, found) = ("beam_photons", self.beam_photons as f64);
            return Err(OptionError { option, expected: "at most photons_per_pass", found });
        }
        let exponents = [
            ("radius_exponent", self.radius_exponent),
            ("surface_radius_exponent", self.surface_radius_exponent),
        ];
        for (option, found) in exponents {
            if !(0.0..0.5).contains(&found) {
                return Err(OptionError { option, expected: "at least 0 and below 0.5", found });
            }
        }
        Ok(())
    }
}

/// Width of a pixel at the distance of what is looked at \[m\]: the middle of the scene, or, in
/// fog without walls, a mean free path away.
fn footprint(scene: &Scene, plan: &Plan) -> f64 {
    let eye = scene.sensor.position;
    let bounds = scene.bounds();
    let distance = if scene.primitives.is_empty() {
        let free_paths = scene.media.iter().map(|m| 1.0 / m.coefficients.sigma_t.mean());
        let nearest_light = scene.emitters.iter().filter_map(|e| position(&e.kind));
        let to_light = nearest_light.map(|p| (p - eye).length()).fold(f64::INFINITY, f64::min);
        let free_path = free_paths.fold(f64::INFINITY, f64::min);
        if plan.media == Media::None { to_light } else { free_path.min(to_light) }
    } else {
        (bounds.centre() - eye).length().max(0.5 * bounds.radius())
    };
    let distance = if distance > 0.0 && distance.is_finite() { distance } else { 1.0 };
    distance * scene.sensor.pixel_width()
}

fn position(emitter: &EmitterKind) -> Option<DVec3> {
    match *emitter {
        EmitterKind::Point { position, .. }
        | EmitterKind::Spot { position, .. }
        | EmitterKind::Laser { position, .. } => Some(position),
        EmitterKind::Area { .. } => None,
    }
}
