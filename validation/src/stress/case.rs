//! What a stress case is.

use std::path::PathBuf;
use std::sync::Arc;

use tpb_beams::{BeamLength, BeamOptions, KernelChoice};
use tpb_light::LightOptions;
use tpb_path::PathOptions;

use crate::error::Result;
use crate::measure::Estimator;

/// A method in the variant that is put under stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// The path tracer.
    Path,
    /// The light tracer.
    Light,
    /// Long photon beams with the 1D kernel.
    Beams1d,
    /// Long photon beams with the 2D kernel.
    Beams2d,
    /// Long photon beams with the 3D kernel.
    Beams3d,
    /// Short photon beams with the 2D kernel.
    BeamsShort,
}

/// How much a method does in a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Camera paths per pixel.
    pub samples: u32,
    /// Photons.
    pub photons: u64,
    /// Radius of beams \[m\]; `None` leaves the choice to the method.
    pub radius: Option<f64>,
    /// Radius of surface photons' discs \[m\]; `None` leaves the choice to the method.
    pub surface_radius: Option<f64>,
}

impl Work {
    /// Enough to go through all of a method's code.
    pub const LITTLE: Self = Self { samples: 4, photons: 500, radius: None, surface_radius: None };

    /// With lengths in a unit of so many metres.
    #[must_use]
    pub fn in_unit(self, metres: f64) -> Self {
        let scaled = |length: Option<f64>| length.map(|length| length * metres);
        Self { radius: scaled(self.radius), surface_radius: scaled(self.surface_radius), ..self }
    }
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Path, Self::Light, Self::Beams1d, Self::Beams2d, Self::Beams3d, Self::BeamsShort];
    /// Those that leave beams.
    pub const BEAMS: [Self; 4] = [Self::Beams1d, Self::Beams2d, Self::Beams3d, Self::BeamsShort];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Light => "light",
            Self::Beams1d => "beams-1d",
            Self::Beams2d => "beams-2d",
            Self::Beams3d => "beams-3d",
            Self::BeamsShort => "beams-2d-short",
        }
    }

    /// The estimator, with a radius that does not shrink.
    pub fn estimator(self, work: &Work) -> Estimator {
        let beams = |kernel, length| {
            Estimator::Beams(BeamOptions {
                kernel: Some(kernel),
                length: Some(length),
                radius: work.radius,
                surface_radius: work.surface_radius,
                radius_exponent: Some(0.0),
                surface_radius_exponent: Some(0.0),
                photons_per_pass: Some(work.photons),
                beam_photons: Some(work.photons),
                gather_samples: Some(work.samples),
                surface_samples: Some(work.samples),
                light_samples: Some(1),
                ..BeamOptions::default()
            })
        };
        match self {
            Self::Path => {
                Estimator::Path(PathOptions { samples_per_pass: work.samples.try_into().ok() })
            }
            Self::Light => Estimator::Light(LightOptions { photons_per_pass: Some(work.photons) }),
            Self::Beams1d => beams(KernelChoice::OneD, BeamLength::Long),
            Self::Beams2d => beams(KernelChoice::TwoD, BeamLength::Long),
            Self::Beams3d => beams(KernelChoice::ThreeD, BeamLength::Long),
            Self::BeamsShort => beams(KernelChoice::TwoD, BeamLength::Short),
        }
    }
}

/// What all cases of a run share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Seed of all random numbers.
    pub seed: u64,
    /// The built `tpb` program, for cases that go through its command line.
    pub program: Option<PathBuf>,
    /// A folder for their files.
    pub folder: PathBuf,
}

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether it is as it should be.
    pub passed: bool,
    /// The numbers, for people.
    pub text: String,
    /// Chance of calling a sound program wrong.
    pub false_alarm: f64,
}

impl Finding {
    /// Of a check without chance.
    pub fn exact(passed: bool, text: impl Into<String>) -> Self {
        Self { passed, text: text.into(), false_alarm: 0.0 }
    }

    /// Both must be well.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        let Self { passed, text, false_alarm } = other;
        self.passed &= passed;
        self.text = [self.text, text].join("; ");
        self.false_alarm += false_alarm;
        self
    }
}

/// A check: `None` for the method where a case has none.
type Check = Arc<dyn Fn(&Setup, Option<Method>) -> Result<Finding> + Send + Sync>;

/// One danger.
#[derive(Clone)]
pub struct Case {
    /// `group/name`.
    pub name: String,
    /// What could break.
    pub risk: &'static str,
    /// For whom it is run; `None` stands for a case that no method takes part in.
    pub methods: Vec<Option<Method>>,
    /// For whom it is not run, and why.
    pub left_out: Vec<(Method, &'static str)>,
    check: Check,
}

impl Case {
    /// A case for all methods.
    pub fn new(
        name: impl Into<String>,
        risk: &'static str,
        check: impl Fn(&Setup, Method) -> Result<Finding> + Send + Sync + 'static,
    ) -> Self {
        let check = move |setup: &Setup, method: Option<Method>| {
            check(setup, method.expect("such cases are run for methods only"))
        };
        Self {
            name: name.into(),
            risk,
            methods: Method::ALL.map(Some).to_vec(),
            left_out: Vec::new(),
            check: Arc::new(check),
        }
    }

    /// A case that no method takes part in.
    pub fn of_no_method(
        name: impl Into<String>,
        risk: &'static str,
        check: impl Fn(&Setup) -> Result<Finding> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            risk,
            methods: vec![None],
            left_out: Vec::new(),
            check: Arc::new(move |setup, _| check(setup)),
        }
    }

    /// Leaves a method out, and says why.
    #[must_use]
    pub fn without(mut self, method: Method, reason: &'static str) -> Self {
        self.methods.retain(|m| *m != Some(method));
        self.left_out.push((method, reason));
        self
    }

    /// Leaves out all methods but these, and says why.
    #[must_use]
    pub fn only(self, methods: &[Method], reason: &'static str) -> Self {
        let others = Method::ALL.into_iter().filter(|method| !methods.contains(method));
        others.fold(self, |case, method| case.without(method, reason))
    }

    /// Carries it out.
    pub fn run(&self, setup: &Setup, method: Option<Method>) -> Result<Finding> {
        (self.check)(setup, method)
    }
}
