//! Estimators under test, and the batches that are made with them.
//!
//! A batch is a film of its own with a fixed number of passes; consecutive batches use consecutive
//! passes of one seed, so that they are independent and repeat to the bit.

use tpb_beams::{BeamOptions, KernelChoice, PhotonBeams};
use tpb_film::{Arrays, FilmOptions, Layout, TimeAxis, TransientFilm};
use tpb_light::{LightOptions, LightTracer};
use tpb_path::{PathOptions, PathTracer};
use tpb_render::{Budget, Method, RunSettings, RunSummary, Stopwatch, run};
use tpb_scene::{FilmSpec, IntegratorSpec, Plan, Scene, Transport};

use crate::cube::Cube;
use crate::error::{Result, ValidationError};

/// A method with its options.
#[derive(Clone, Debug, PartialEq)]
pub enum Estimator {
    /// The path tracer.
    Path(PathOptions),
    /// Photon beams.
    Beams(BeamOptions),
    /// The light tracer.
    Light(LightOptions),
}

impl Estimator {
    /// Names of all methods.
    pub const NAMES: [&'static str; 3] = ["path", "light", "beams"];

    /// The method of a name with its default options.
    pub fn of_name(name: &str) -> Option<Self> {
        match name {
            "path" => Some(Self::Path(PathOptions::default())),
            "light" => Some(Self::Light(LightOptions::default())),
            "beams" => Some(Self::Beams(BeamOptions::default())),
            _ => None,
        }
    }

    /// Its name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Path(_) => "path",
            Self::Beams(_) => "beams",
            Self::Light(_) => "light",
        }
    }

    /// Labels of all methods and of the kernels that beams may have beside their default.
    pub const LABELS: [&'static str; 6] =
        ["path", "light", "beams", "beams-1d", "beams-2d", "beams-3d"];

    /// The method of a label, else with its default options.
    pub fn of_label(label: &str) -> Option<Self> {
        let kernel = match label {
            "beams-1d" => KernelChoice::OneD,
            "beams-2d" => KernelChoice::TwoD,
            "beams-3d" => KernelChoice::ThreeD,
            name => return Self::of_name(name),
        };
        Some(Self::Beams(BeamOptions { kernel: Some(kernel), ..BeamOptions::default() }))
    }

    /// Its name, and the kernel if one is chosen.
    pub fn label(&self) -> &'static str {
        let Self::Beams(BeamOptions { kernel: Some(kernel), .. }) = self else {
            return self.name();
        };
        match kernel {
            KernelChoice::OneD => "beams-1d",
            KernelChoice::TwoD => "beams-2d",
            KernelChoice::ThreeD => "beams-3d",
        }
    }

    /// The method, ready to make passes.
    pub fn prepare<'a, const C: usize>(
        &self,
        scene: &'a Scene,
        plan: &'a Plan,
        integrator: IntegratorSpec,
    ) -> Result<Box<dyn Method<C> + 'a>> {
        Ok(match self {
            Self::Path(options) => Box::new(PathTracer::<C>::new(scene, plan, integrator, options)),
            Self::Light(options) => Box::new(
                LightTracer::<C>::new(scene, plan, integrator, options)
                    .map_err(|error| ValidationError::unusable("the light tracer", error))?,
            ),
            Self::Beams(options) => Box::new(
                PhotonBeams::new(scene, plan, integrator, options)
                    .map_err(|error| ValidationError::unusable("photon beams", error))?,
            ),
        })
    }
}

/// How many batches, of how many passes, with which random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BatchPlan {
    /// Independent batches.
    pub batches: u64,
    /// Passes of each.
    pub passes: u64,
    /// Seed.
    pub seed: u64,
}

/// The film that a scene asks for, its window later by `shift` \[m\].
pub fn layout(spec: &FilmSpec, shift: f64) -> Result<Layout> {
    let time = spec.time.map(|time| TimeAxis {
        start_opl: time.start_opl + shift,
        bin_width_opl: time.bin_width_opl,
        bins: time.bins,
    });
    Ok(Layout::new(spec.width, spec.height, time)?)
}

/// Passes of a prepared method into a new film.
pub fn render<const C: usize>(
    method: &dyn Method<C>,
    layout: Layout,
    settings: &RunSettings,
) -> Result<(Arrays, RunSummary)> {
    render_keeping(method, layout, FilmOptions::default(), settings)
}

/// The same, into a film with these options.
pub fn render_keeping<const C: usize>(
    method: &dyn Method<C>,
    layout: Layout,
    options: FilmOptions,
    settings: &RunSettings,
) -> Result<(Arrays, RunSummary)> {
    let mut film = TransientFilm::<C>::new(layout, options)?;
    let summary = run(method, &mut film, settings, &Stopwatch::start(), &mut ());
    if film.non_finite() > 0 {
        let reason = format!("{} contributions were not finite", film.non_finite());
        return Err(ValidationError::unusable(method.name(), reason));
    }
    Ok((film.develop(), summary))
}

/// Renders batches and hands each cube over; channels are one below the other
/// ([`Cube::stacked`]).
pub fn batches(
    scene: &Scene,
    estimator: &Estimator,
    layout: Layout,
    plan: &BatchPlan,
    each: impl FnMut(&Cube),
) -> Result<()> {
    let needs = Plan::new(scene, &scene.integrator);
    match needs.transport {
        Transport::Mono => batches_with::<1>(scene, &needs, estimator, layout, plan, each),
        Transport::Rgb => batches_with::<3>(scene, &needs, estimator, layout, plan, each),
    }
}

fn batches_with<const C: usize>(
    scene: &Scene,
    needs: &Plan,
    estimator: &Estimator,
    layout: Layout,
    plan: &BatchPlan,
    mut each: impl FnMut(&Cube),
) -> Result<()> {
    let method = estimator.prepare::<C>(scene, needs, scene.integrator)?;
    for batch in 0..plan.batches {
        let settings = RunSettings {
            seed: plan.seed,
            budget: Budget::Passes(plan.passes),
            first_pass: batch * plan.passes,
        };
        let (arrays, _) = render(&*method, layout, &settings)?;
        each(&Cube::stacked(&arrays));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_name_methods_and_kernels() {
        for label in Estimator::LABELS {
            let estimator = Estimator::of_label(label).unwrap();
            assert_eq!(estimator.label(), label);
            assert!(label.starts_with(estimator.name()));
        }
        assert_eq!(Estimator::of_label("beams-4d"), None);
    }
}
