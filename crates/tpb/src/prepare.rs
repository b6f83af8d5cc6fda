//! What `render` and `plan` share: from the command line to a scene, its plan and a method.

use std::num::NonZero;

use tpb_beams::{BeamLength, BeamOptions, KernelChoice, PhotonBeams, Sampler, Temporal};
use tpb_light::{LightOptions, LightTracer};
use tpb_path::{PathOptions, PathTracer};
use tpb_render::Method;
use tpb_scene::load::{self, LoadedScene, Override};
use tpb_scene::{IntegratorSpec, MethodName, Plan};

use crate::cli::{
    BeamArgs, BeamLengthArg, JobArgs, KernelArg, MethodArg, MethodArgs, PathArgs, PhotonArgs,
    SamplerArg, TemporalArg,
};
use crate::failure::Failure;

/// A scene that is ready to be rendered.
pub(crate) struct Job {
    /// The scene and its effective text.
    pub(crate) loaded: LoadedScene,
    /// Depths, as the command line overrides the scene.
    pub(crate) integrator: IntegratorSpec,
    /// What the run needs.
    pub(crate) plan: Plan,
    /// The method and its own options.
    pub(crate) method: MethodSpec,
}

/// What of the light is kept, and from when its times are counted.
#[derive(Clone, Copy)]
pub(crate) struct Kept {
    /// The bins alone.
    pub(crate) window_only: bool,
    /// Times are counted from each pixel's first surface.
    pub(crate) unwarp: bool,
}

/// A method with its options.
#[derive(Clone, Debug)]
pub(crate) enum MethodSpec {
    /// Photon beams.
    Beams(BeamOptions),
    /// Path tracer.
    Path(PathOptions),
    /// Light tracer.
    Light(LightOptions),
}

impl Job {
    /// Loads the scene and decides how to render it.
    pub(crate) fn new(args: &JobArgs, own: &MethodArgs, kept: Kept) -> Result<Self, Failure> {
        let overrides: Vec<Override> =
            args.set.iter().map(|text| Override::parse(text)).collect::<Result<_, _>>()?;
        let loaded = load::load_scene(&args.scene, &overrides)?;
        let integrator = integrator(args, &loaded.scene.integrator);
        if let Some(max) = integrator.max_depth.filter(|&max| max < integrator.min_depth) {
            let min = integrator.min_depth;
            return Err(Failure::input(format!(
                "the deepest paths ({max}) are less deep than the shallowest ({min}): none counts"
            )));
        }
        let method = MethodSpec::new(args.method, own, &integrator)?;
        let mut plan = Plan::new(&loaded.scene, &integrator);
        if kept.window_only && plan.time_bins {
            plan = plan.keeping_window_only(kept.unwarp);
        }
        let plan = plan.of_method(method.method());
        if integrator.max_depth.is_none() && !plan.endless.is_empty() {
            let reasons = plan.endless.join("; ");
            return Err(Failure::with_help(
                format!("light may never end, and the depth of paths is unlimited: {reasons}"),
                "limit it with --max-depth N; the energy cut is then in the ledger of the report",
            ));
        }
        Ok(Self { loaded, integrator, plan, method })
    }

    /// The method itself, prepared for this scene.
    pub(crate) fn method<const C: usize>(&self) -> Result<Box<dyn Method<C> + '_>, Failure> {
        let (scene, plan) = (&self.loaded.scene, &self.plan);
        Ok(match &self.method {
            MethodSpec::Path(options) => {
                Box::new(PathTracer::<C>::new(scene, plan, self.integrator, options))
            }
            MethodSpec::Light(options) => Box::new(
                LightTracer::<C>::new(scene, plan, self.integrator, options)
                    .map_err(|e| Failure::input(e.to_string()))?,
            ),
            MethodSpec::Beams(options) => Box::new(
                PhotonBeams::new(scene, plan, self.integrator, options)
                    .map_err(|e| Failure::input(e.to_string()))?,
            ),
        })
    }
}

impl MethodSpec {
    /// The command line's method, else the scene's, else beams.
    fn new(
        asked: Option<MethodArg>,
        own: &MethodArgs,
        integrator: &IntegratorSpec,
    ) -> Result<Self, Failure> {
        let asked = asked.map(|asked| match asked {
            MethodArg::Beams => MethodName::Beams,
            MethodArg::Path => MethodName::Path,
            MethodArg::Light => MethodName::Light,
        });
        let MethodArgs { beams, photons, path } = own;
        let spec = match asked.or(integrator.method).unwrap_or(MethodName::Beams) {
            MethodName::Beams => Self::Beams(beam_options(beams, photons)),
            MethodName::Path => Self::Path(PathOptions { samples_per_pass: path.samples_per_pass }),
            MethodName::Light => Self::Light(LightOptions { photons_per_pass: photons.photons }),
        };
        let given = [
            (*beams != BeamArgs::default(), &["beams"][..]),
            (*photons != PhotonArgs::default(), &["beams", "light"]),
            (*path != PathArgs::default(), &["path"]),
        ];
        for (given, owners) in given {
            if given && !owners.contains(&spec.name()) {
                let name = owners[0];
                let used = spec.name();
                let message = format!("options of {name} are given, but the method is {used}");
                let help = format!("leave them out, or add --method {name}");
                return Err(Failure::with_help(message, help));
            }
        }
        Ok(spec)
    }

    fn method(&self) -> MethodName {
        match self {
            Self::Beams(_) => MethodName::Beams,
            Self::Path(_) => MethodName::Path,
            Self::Light(_) => MethodName::Light,
        }
    }

    /// Its name on the command line.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Beams(_) => "beams",
            Self::Path(_) => "path",
            Self::Light(_) => "light",
        }
    }
}

fn integrator(args: &JobArgs, scene: &IntegratorSpec) -> IntegratorSpec {
    IntegratorSpec {
        method: scene.method,
        max_depth: args.max_depth.map_or(scene.max_depth, |depth| depth.0),
        min_depth: args.min_depth.map_or(scene.min_depth, NonZero::get),
        rr_depth: args.rr_depth.map_or(scene.rr_depth, NonZero::get),
    }
}

fn beam_options(args: &BeamArgs, photons: &PhotonArgs) -> BeamOptions {
    BeamOptions {
        kernel: args.kernel.map(|kernel| match kernel {
            KernelArg::OneD => KernelChoice::OneD,
            KernelArg::TwoD => KernelChoice::TwoD,
            KernelArg::ThreeD => KernelChoice::ThreeD,
        }),
        length: args.beam_length.map(|length| match length {
            BeamLengthArg::Long => BeamLength::Long,
            BeamLengthArg::Short => BeamLength::Short,
        }),
        temporal: args.temporal.map(|temporal| match temporal {
            TemporalArg::Exact => Temporal::Exact,
            TemporalArg::Even => Temporal::Even,
        }),
        radius: args.radius,
        surface_radius: args.surface_radius,
        caustic_radius: args.caustic_radius,
        radius_exponent: args.radius_exponent,
        surface_radius_exponent: args.surface_radius_exponent,
        photons_per_pass: photons.photons,
        beam_photons: args.beam_photons,
        gather_samples: args.gather_samples,
        surface_samples: args.surface_samples,
        lamp_samples: args.lamp_samples,
        light_samples: args.light_samples,
        thin_from: args.thin_from,
        sampler: args.sampler.map(|sampler| match sampler {
            SamplerArg::Sobol => Sampler::Sobol,
            SamplerArg::Independent => Sampler::Independent,
        }),
    }
}
