//! The command line.

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use tpb_film::Pulse;

use crate::values;
use crate::video::{ToneArgs, VideoArgs};
use crate::viewer::{CompareArgs, ViewArgs};

/// Renders light in flight: transient photon beams, a path tracer, a light tracer; and analytic curves.
#[derive(Debug, Parser)]
#[command(name = "tpb", version, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene into a folder of arrays, pictures and a report
    Render(Box<RenderArgs>),
    /// Print what a render of a scene needs, and what it leaves out
    Plan(Box<PlanArgs>),
    /// Check a result and print what is in it
    Info(InfoArgs),
    /// Show a result as a page for the browser
    View(ViewArgs),
    /// Print the errors of results against a reference, and show them side by side
    Compare(Box<CompareArgs>),
    /// Make a video of a result: APNG, GIF, MP4, WebM
    Video(Box<VideoArgs>),
    /// Print or draw an analytic solution, at a point or over a range of an input
    Reference(ReferenceArgs),
    /// Print the JSON schema of scene files
    Schema,
}

/// `tpb render`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tpb render cornell-blocks.json --time 20s
  tpb render cornell-blocks.json --method path --passes 16 --seed 7 -o results/path
  tpb render cornell-blocks.json --set sensor.film.width=128 --pulse gaussian:30ps

Ctrl-c ends the render after the pass and writes what is there; once more, it aborts.
Exit codes: 0 done; 1 done, but the result is not sound; 2 bad usage, input or files.")]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent flag")]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) job: JobArgs,

    /// Wall time to render for, preparation included: 500ms, 20s, 3m, 1h [default: 10s]
    #[arg(
        long, value_name = "TIME", value_parser = values::duration, conflicts_with = "passes",
        allow_hyphen_values = true
    )]
    pub(crate) time: Option<Duration>,

    /// Number of passes to render instead; the arrays are then reproducible to the bit
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) passes: Option<NonZeroU64>,

    /// Seed of all random numbers
    #[arg(long, value_name = "S", default_value_t = 0, allow_negative_numbers = true)]
    pub(crate) seed: u64,

    /// Threads to use; results do not depend on it [default: all of the machine's]
    #[arg(long, value_name = "N", value_parser = values::threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Result folder; replaces an earlier result, nothing else [default: SCENE-METHOD]
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,

    /// Also write the variance of each cell's mean
    #[arg(long)]
    pub(crate) variance: bool,

    /// Subtract the time from the eye to the first surface from arrival times
    #[arg(long)]
    pub(crate) unwarp: bool,

    /// Keep the bins alone: neither what arrives outside the time window nor the steady image, so that
    /// light that arrives outside need not be followed
    #[arg(long)]
    pub(crate) window_only: bool,

    /// Pulse of the emitters: delta, gaussian:30ps (full width at half maximum), box:50ps
    /// (duration), or continuous (switched on at time 0)
    #[arg(
        long, value_name = "PULSE", default_value = "delta", value_parser = values::pulse,
        allow_hyphen_values = true
    )]
    pub(crate) pulse: Pulse,

    #[command(flatten)]
    pub(crate) tone: ToneArgs,

    /// Write arrays and report only
    #[arg(long, conflicts_with_all = ["tone", "exposure"])]
    pub(crate) no_pictures: bool,

    #[command(flatten)]
    pub(crate) method: MethodArgs,
}

/// `tpb plan`.
#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(crate) job: JobArgs,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,

    /// Of a render that keeps the bins alone
    #[arg(long)]
    pub(crate) window_only: bool,

    /// Of a render that subtracts the time from the eye to the first surface
    #[arg(long)]
    pub(crate) unwarp: bool,

    #[command(flatten)]
    pub(crate) method: MethodArgs,
}

/// `tpb info`.
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// A result folder, or an npz file of arrays
    pub(crate) result: PathBuf,
}

/// `tpb reference`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tpb reference --list
  tpb reference ballistic_point_fluence --set energy=1 sigma_t=0.5 r=2
  tpb reference diffusion_infinite --set r=5 mu_a=0.02 mu_s_prime=2 speed=1 \\
      --over time=1..100:400 --log-x --log-y -o curve.svg
  tpb reference sphere_centre_radiance_bins --set albedo=0.7 order=all --over bins=0..12:120

Where a solution has no value, as on a wavefront, a cell is empty (JSON: null).
Exit codes: 0 at least one value; 2 none, bad usage, or a file that cannot be written.")]
pub(crate) struct ReferenceArgs {
    /// The solution; --list names them all
    #[arg(required_unless_present = "list")]
    pub(crate) name: Option<String>,

    /// List the solutions (or only this one) with their inputs, units and validity
    #[arg(long, conflicts_with_all = ["set", "over", "quantity", "plot"])]
    pub(crate) list: bool,

    /// Inputs, each a number, a vector of JSON, or a word: energy=1 sigma_t=0.5 order=all
    #[arg(long, value_name = "KEY=VALUE", num_args = 1..)]
    pub(crate) set: Vec<String>,

    /// The input to vary, from first to last value; bins=A..B:N sets t0 and t1 to N bins
    #[arg(long, value_name = "KEY=A..B[:N]", allow_hyphen_values = true)]
    pub(crate) over: Option<String>,

    /// Space the values of --over, and the horizontal axis, by their logarithm
    #[arg(long, requires = "over")]
    pub(crate) log_x: bool,

    /// Draw the vertical axis by its logarithm
    #[arg(long, requires = "over")]
    pub(crate) log_y: bool,

    /// Only this quantity of the solution [default: all that it has]
    #[arg(long, value_name = "Q")]
    pub(crate) quantity: Option<String>,

    /// Format of the output [default: that of the name of -o, or csv]
    #[arg(long)]
    pub(crate) format: Option<ReferenceFormat>,

    /// Also draw a plot, as SVG
    #[arg(long, value_name = "FILE", requires = "over")]
    pub(crate) plot: Option<PathBuf>,

    /// Write to a file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReferenceFormat {
    /// A table; lines that begin with # say what it is
    Csv,
    /// An object
    Json,
    /// A plot
    Svg,
}

/// Scene and method.
#[derive(Clone, Debug, Args)]
pub(crate) struct JobArgs {
    /// The scene file (JSON)
    pub(crate) scene: PathBuf,

    /// Rendering method [default: the scene's integrator, or beams]
    #[arg(long)]
    pub(crate) method: Option<MethodArg>,

    /// Change a value of the scene: sensor.film.width=128
    #[arg(long, value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,

    /// Deepest paths counted, -1 for all; 1 is light seen directly [default: the scene's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = values::max_depth)]
    pub(crate) max_depth: Option<values::MaxDepth>,

    /// Shallowest paths counted [default: the scene's]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) min_depth: Option<NonZeroU32>,

    /// Depth from which Russian roulette may end a path [default: the scene's]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) rr_depth: Option<NonZeroU32>,
}

/// Options that belong to one method.
#[derive(Debug, Default, PartialEq, Args)]
pub(crate) struct MethodArgs {
    #[command(flatten)]
    pub(crate) beams: BeamArgs,

    #[command(flatten)]
    pub(crate) photons: PhotonArgs,

    #[command(flatten)]
    pub(crate) path: PathArgs,
}

/// Options of the photon beams; what is not given is chosen from scene and film.
#[derive(Debug, Default, PartialEq, Args)]
#[command(next_help_heading = "Options of beams (chosen from scene and film unless given)")]
pub(crate) struct BeamArgs {
    /// Blur kernel
    #[arg(long)]
    pub(crate) kernel: Option<KernelArg>,

    /// Where beams end: with their medium, or at a sampled collision
    #[arg(long, value_name = "LENGTH")]
    pub(crate) beam_length: Option<BeamLengthArg>,

    /// How the 2D and 3D kernels spread energy over time
    #[arg(long, value_name = "SPREAD")]
    pub(crate) temporal: Option<TemporalArg>,

    /// Radius of the kernel in the first pass, in metres
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) radius: Option<f64>,

    /// Radius of the surface photons' disc in the first pass, in metres
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) surface_radius: Option<f64>,

    /// Radius of the disc for caustics, in metres: light that mirrors and glass alone have turned, and
    /// spots of lasers; a fifth of the other by default
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) caustic_radius: Option<f64>,

    /// How fast the kernel shrinks over the passes, from 0 (not at all) to below 0.5
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub(crate) radius_exponent: Option<f64>,

    /// Likewise the surface photons' disc
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub(crate) surface_radius_exponent: Option<f64>,

    /// How many of the photons leave beams; all leave surface photons
    #[arg(
        long, value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..=1_000_000_000),
        allow_negative_numbers = true
    )]
    pub(crate) beam_photons: Option<u64>,

    /// Camera rays per pixel and pass that gather beams
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) gather_samples: Option<u32>,

    /// Camera rays per pixel and pass that end on a surface
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) surface_samples: Option<u32>,

    /// More rays per pass for pixels that see lamps, which look for these alone: at most so many, and in
    /// all as many as other camera rays; 0 for none
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) lamp_samples: Option<u32>,

    /// Connections to light sources per camera ray
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) light_samples: Option<u32>,

    /// Events from which photons that have lost power are thinned out
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) thin_from: Option<u32>,

    /// Where photons start, and which points of lights are connected to
    #[arg(long, value_enum, value_name = "SAMPLER")]
    pub(crate) sampler: Option<SamplerArg>,
}

/// Options of the methods that trace photons.
#[derive(Debug, Default, PartialEq, Args)]
#[command(
    next_help_heading = "Options of beams and light (chosen from scene and film unless given)"
)]
pub(crate) struct PhotonArgs {
    /// Photons emitted in a pass
    #[arg(
        long, value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..=1_000_000_000),
        allow_negative_numbers = true
    )]
    pub(crate) photons: Option<u64>,
}

/// Options of the path tracer.
#[derive(Debug, Default, PartialEq, Args)]
#[command(next_help_heading = "Options of path (chosen from the film unless given)")]
pub(crate) struct PathArgs {
    /// Camera paths per pixel and pass
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) samples_per_pass: Option<NonZeroU32>,
}

/// A rendering method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodArg {
    /// Transient photon beams
    Beams,
    /// Transient path tracer, unbiased
    Path,
    /// Transient light tracer, unbiased: photons connected to the pinhole
    Light,
}

/// A kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KernelArg {
    /// A segment across beam and ray; no spread in time
    #[value(name = "1d")]
    OneD,
    /// A disc across the beam
    #[value(name = "2d")]
    TwoD,
    /// A sphere swept along the beam
    #[value(name = "3d")]
    ThreeD,
}

/// Where beams end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BeamLengthArg {
    /// With their medium
    Long,
    /// At a sampled collision
    Short,
}

/// How the 2D and 3D kernels spread energy over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TemporalArg {
    /// As transmittance does
    Exact,
    /// Evenly
    Even,
}

/// Where photons start, and which points of lights are connected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SamplerArg {
    /// Spread evenly: a scrambled Sobol sequence
    Sobol,
    /// Independent of one another
    Independent,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Cli::command().debug_assert();
    }
}
