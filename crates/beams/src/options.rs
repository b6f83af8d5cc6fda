//! What a user may choose, and what is chosen otherwise.

use serde::{Deserialize, Serialize};
use tpb_scene::{EmitterKind, Kernel, Plan, Scene};
use tpb_transport::Sampler;

use crate::defaults;

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

/// How the 2D and 3D kernels spread a pair's energy over its arrival interval.
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
    /// [`crate::kernel3d`].
    #[serde(rename = "3d")]
    ThreeD,
}

/// Options of the method; what is left out is chosen from scene and film ([`Settings::new`]).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BeamOptions {
    /// Blur kernel; by default the plan's.
    pub kernel: Option<KernelChoice>,
    /// Where beams end; by default long.
    pub length: Option<BeamLength>,
    /// Spread in time of the 2D and 3D kernels; by default exact.
    pub temporal: Option<Temporal>,
    /// Radius of beams in the first pass \[m\].
    pub radius: Option<f64>,
    /// Radius of the surface photons' disc in the first pass \[m\].
    pub surface_radius: Option<f64>,
    /// Radius of the caustic photons' disc in the first pass \[m\]; by default a fifth of the other's.
    pub caustic_radius: Option<f64>,
    /// The beams' radius of pass i (from 0) is multiplied by (1 + i/32)^(−`radius_exponent`);
    /// by default 1/5.
    pub radius_exponent: Option<f64>,
    /// Likewise the discs', with 8 for 32; by default 1/6.
    pub surface_radius_exponent: Option<f64>,
    /// Photons emitted in a pass.
    pub photons_per_pass: Option<u64>,
    /// How many of them leave beams; all leave surface photons. By default all in scenes that keep
    /// none on surfaces.
    pub beam_photons: Option<u64>,
    /// Camera paths per pixel and pass that gather beams.
    pub gather_samples: Option<u32>,
    /// Camera paths per pixel and pass that end on a surface.
    pub surface_samples: Option<u32>,
    /// Rays more per pass for pixels that see lamps, at most; 0 for none. In all they are as many as all
    /// pixels' `surface_samples` at most.
    pub lamp_samples: Option<u32>,
    /// Connections to light sources per camera path.
    pub light_samples: Option<u32>,
    /// Scattering events from which photons that have lost power are thinned out, so that those left
    /// carry what they began with.
    pub thin_from: Option<u32>,
    /// Where photons start, and which points of lights are connected to; by default Sobol.
    pub sampler: Option<Sampler>,
}

impl BeamOptions {
    /// Numbers of photons as given, whether the scene needs them or not.
    fn check_counts(&self) -> Result<(), OptionError> {
        let (photons, beams) = (self.photons_per_pass, self.beam_photons);
        for (option, count) in [("photons_per_pass", photons), ("beam_photons", beams)] {
            if count == Some(0) {
                return Err(OptionError { option, expected: "at least 1", found: 0.0 });
            }
        }
        if let (Some(photons), Some(beams)) = (photons, beams)
            && beams > photons
        {
            let (option, found) = ("beam_photons", beams as f64);
            return Err(OptionError { option, expected: "at most photons_per_pass", found });
        }
        Ok(())
    }
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
    /// Spread in time of the 2D and 3D kernels.
    pub temporal: Temporal,
    /// Radius of beams in the first pass \[m\].
    pub radius: f64,
    /// Radius of the surface photons' disc in the first pass \[m\].
    pub surface_radius: f64,
    /// Radius of the caustic photons' disc in the first pass \[m\].
    pub caustic_radius: f64,
    /// The beams' radius of pass i (from 0) is multiplied by (1 + i/32)^(−`radius_exponent`).
    pub radius_exponent: f64,
    /// Likewise the discs', with 8 for 32.
    pub surface_radius_exponent: f64,
    /// Photons emitted in a pass; 0 in scenes that keep none.
    pub photons_per_pass: u64,
    /// How many of them leave beams; all leave surface photons.
    pub beam_photons: u64,
    /// Camera paths per pixel and pass that gather beams.
    pub gather_samples: u32,
    /// Camera paths per pixel and pass that end on a surface.
    pub surface_samples: u32,
    /// Rays more per pass for pixels that see lamps, at most; 0 if the plan has none.
    pub lamp_samples: u32,
    /// Connections to light sources per camera path.
    pub light_samples: u32,
    /// Scattering events from which photons that have lost power are thinned out.
    pub thin_from: u32,
    /// Where photons start, and which points of lights are connected to.
    pub sampler: Sampler,
}

/// Radius of the caustic photons' disc over the other's: caustics are sharp, and bright enough for it.
const CAUSTIC_RADIUS: f64 = 0.2;
/// Radii of a pass \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radii {
    /// Of beams.
    pub beams: f64,
    /// Of the surface photons' disc.
    pub surface: f64,
    /// Of the caustic photons' disc.
    pub caustic: f64,
}

/// Passes over which the beams' radius keeps nearly its first value.
const PASSES_BEFORE_SHRINKING: f64 = 32.0;
/// Likewise the discs', which begin wider.
const PASSES_BEFORE_DISCS_SHRINK: f64 = 8.0;
/// Beams that a ray meets go as photons × radius, the radius as 1/edge: so many photons leave
/// beams per pixel along the image's edge that the gather costs about as much as the tracing.
const BEAM_PHOTONS_PER_PIXEL_EDGE: f64 = 128.0;
/// Photons in a disc go as photons × radius²: so many per pixel.
const PHOTONS_PER_PIXEL: u64 = 16;
/// Passes below this cost more in overhead than in light.
const FEWEST_PHOTONS: u64 = 4096;
/// A pass takes 1.2 GB at most by default; see [`SURFACE_BYTES`] and [`BEAM_BYTES`].
const MOST_PHOTONS: u64 = 1 << 18;
/// At least the peak memory of a photon's traces on surfaces. Measured on cornell-blocks without
/// thinning, 2.3 traces each: 350.
const SURFACE_BYTES: u64 = 400;
/// Likewise of its beams, 5.3 each, when every tile had a list of its own: 3440.
const BEAM_BYTES: u64 = 4000;
/// Connections to light sources per camera path, where there is a choice.
const LIGHT_SAMPLES: u32 = 8;
/// Rays more per pass for pixels that see lamps.
const LAMP_SAMPLES: u32 = 64;
/// Memory beyond which a pass is refused.
const MOST_BYTES: u64 = 16 << 30;

/// Connections to light sources per camera path: all to the same place where there is one only.
fn light_samples(scene: &Scene) -> u32 {
    let kinds = scene.emitters.iter().map(|emitter| &emitter.kind);
    let mut connected = kinds.filter(|kind| kind.can_be_connected());
    match (connected.next(), connected.next()) {
        (Some(EmitterKind::Area { .. }), None) | (_, Some(_)) => LIGHT_SAMPLES,
        _ => 1,
    }
}

impl Settings {
    /// Fills in the defaults.
    ///
    /// # Errors
    /// [`OptionError`] for radii, exponents and counts out of their range, and for more photons than
    /// fit into 16 GiB.
    pub fn new(scene: &Scene, plan: &Plan, options: &BeamOptions) -> Result<Self, OptionError> {
        options.check_counts()?;
        let (radius, surface_radius) = defaults::radii(scene);
        let surface_radius = options.surface_radius.unwrap_or(surface_radius);
        let pixels = scene.film.width * scene.film.height;
        let few = (BEAM_PHOTONS_PER_PIXEL_EDGE * (pixels as f64).sqrt()) as u64;
        let many = (PHOTONS_PER_PIXEL * pixels as u64).clamp(FEWEST_PHOTONS, MOST_PHOTONS);
        let few = few.clamp(FEWEST_PHOTONS, MOST_PHOTONS);
        let (given, given_beams) = (options.photons_per_pass, options.beam_photons);
        let (photons_per_pass, beam_photons) = match (plan.surface_photons, plan.beams) {
            (true, beams) => {
                let photons = given.or(given_beams).unwrap_or(many.max(few));
                (photons, if beams { given_beams.unwrap_or(few.min(photons)) } else { 0 })
            }
            (false, true) => {
                let photons = given_beams.or(given).unwrap_or(few);
                (photons, photons)
            }
            (false, false) => (0, 0),
        };
        let kernel = options.kernel.unwrap_or(match plan.kernel {
            Kernel::OneD => KernelChoice::OneD,
            Kernel::TwoD => KernelChoice::TwoD,
        });
        let settings = Self {
            kernel,
            length: options.length.unwrap_or_default(),
            temporal: options.temporal.unwrap_or_default(),
            radius: options.radius.unwrap_or(radius),
            surface_radius,
            caustic_radius: options.caustic_radius.unwrap_or(CAUSTIC_RADIUS * surface_radius),
            radius_exponent: options.radius_exponent.unwrap_or(0.2),
            surface_radius_exponent: options.surface_radius_exponent.unwrap_or(1.0 / 6.0),
            photons_per_pass,
            beam_photons,
            gather_samples: options.gather_samples.unwrap_or(2),
            surface_samples: options.surface_samples.unwrap_or(4),
            lamp_samples: if plan.lamp_rays {
                options.lamp_samples.unwrap_or(LAMP_SAMPLES)
            } else {
                0
            },
            light_samples: options.light_samples.unwrap_or_else(|| light_samples(scene)),
            thin_from: options.thin_from.unwrap_or(2),
            sampler: options.sampler.unwrap_or(Sampler::Sobol),
        };
        settings.check()?;
        Ok(settings)
    }

    /// Radii of beams and discs in pass `index`.
    ///
    /// With variance ∝ 1/R for beams and 1/R² for discs, and bias ∝ R², the mean square error falls
    /// fastest with exponents 1/5 and 1/6. (Near borders bias is ∝ R; see the crate's page.) The
    /// first passes keep the radius nearly: it is some pixels already, and shrinking from the
    /// very first pass would buy bias that noise hides.
    pub fn radii(&self, index: u64) -> Radii {
        let age = |few: f64| 1.0 + index as f64 / few;
        let discs = age(PASSES_BEFORE_DISCS_SHRINK).powf(-self.surface_radius_exponent);
        Radii {
            beams: self.radius * age(PASSES_BEFORE_SHRINKING).powf(-self.radius_exponent),
            surface: self.surface_radius * discs,
            caustic: self.caustic_radius * discs,
        }
    }

    fn check(&self) -> Result<(), OptionError> {
        let lengths = [
            ("radius", self.radius),
            ("surface_radius", self.surface_radius),
            ("caustic_radius", self.caustic_radius),
        ];
        for (option, found) in lengths {
            // Cubes of radii, and products of them with lengths, stay finite.
            if !(1e-30..=1e30).contains(&found) {
                return Err(OptionError { option, expected: "from 1e-30 to 1e30", found });
            }
        }
        let counts = [
            ("gather_samples", u64::from(self.gather_samples)),
            ("surface_samples", u64::from(self.surface_samples)),
            ("light_samples", u64::from(self.light_samples)),
        ];
        for (option, found) in counts {
            if found == 0 {
                return Err(OptionError { option, expected: "at least 1", found: 0.0 });
            }
        }
        let bytes = u128::from(self.photons_per_pass) * u128::from(SURFACE_BYTES)
            + u128::from(self.beam_photons) * u128::from(BEAM_BYTES);
        if bytes > u128::from(MOST_BYTES) {
            let (option, found) = ("photons_per_pass", self.photons_per_pass as f64);
            let expected =
                "few enough for 16 GiB (about 400 bytes each, and 4000 each that leaves beams)";
            return Err(OptionError { option, expected, found });
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
