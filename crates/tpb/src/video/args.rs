//! The command line of `tpb video`, and the options of pictures that `tpb render` shares.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use tpb_film::{ArrivalTime, PictureOptions, Pulse, Tone};

use crate::values::{self, Bounds};

/// `tpb video`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tpb video beams -o beams.mp4 --scale 4 --label
  tpb video beams -o beams.gif --time-range 2ns..8ns --tone filmic --exposure 1
  tpb video beams -o waves.webm --pulse gaussian:100ps --colour-time
  tpb video beams -o arrival.png --colour-time=peak

APNG is lossless and plays in any browser; GIF has 256 colours; MP4 and WebM are made by the program
ffmpeg, which has to be installed (or named in the environment variable FFMPEG). A .png is one
picture of all the light in the range.
All frames share one exposure, so that their brightnesses compare and nothing flickers. To expose
another result alike, give it the --white that this one prints.
Exit codes: 0 done; 1 done, but some cells are negative or not finite; 2 bad usage or files.")]
pub(crate) struct VideoArgs {
    /// A result folder, or a cube of any program (.npz, .npy)
    pub(crate) result: PathBuf,

    /// The video; its ending (.apng, .gif, .mp4, .webm, .png) says the format [default: named after
    /// the result, .apng]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true)]
    pub(crate) fps: u16,

    /// Pixels of the video per pixel of the image and side
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    pub(crate) scale: usize,

    /// Write time and OPL into the frames
    #[arg(long)]
    pub(crate) label: bool,

    /// Mix colours that a GIF lacks of others
    #[arg(long)]
    pub(crate) dither: bool,

    #[command(flatten)]
    pub(crate) light: LightArgs,

    #[command(flatten)]
    pub(crate) time: TimeArgs,
}

/// What of the light is shown, and how bright.
#[derive(Debug, Args)]
#[command(next_help_heading = "Light")]
pub(crate) struct LightArgs {
    #[command(flatten)]
    pub(crate) tone: ToneArgs,

    /// Energy per bin that is display white before --exposure [default: 99 % of the lit cells are
    /// darker]
    #[arg(long, value_name = "VALUE", value_parser = values::white, allow_hyphen_values = true)]
    pub(crate) white: Option<f64>,

    /// Expose each frame by itself, smoothly; brightnesses of frames no longer compare
    #[arg(long, conflicts_with_all = ["white", "colour_time"])]
    pub(crate) follow: bool,

    /// Colour all light so far by its mean (or, with =peak, brightest) time of arrival; light of
    /// the frame itself is white
    #[arg(
        long, value_name = "TIME", alias = "color-time", num_args = 0..=1, require_equals = true,
        default_missing_value = "mean"
    )]
    pub(crate) colour_time: Option<ArrivalArg>,

    /// Pulse to apply to a result of the delta pulse: gaussian:30ps (full width at half maximum),
    /// box:50ps (duration), or continuous (switched on at time 0)
    #[arg(
        long, value_name = "PULSE", default_value = "delta", value_parser = values::pulse,
        allow_hyphen_values = true
    )]
    pub(crate) pulse: Pulse,
}

/// Which time is shown.
#[derive(Debug, Args)]
#[command(next_help_heading = "Time (ranges may leave an end open)")]
pub(crate) struct TimeArgs {
    /// From one time to another: 2ns..8ns
    #[arg(
        long, value_name = "A..B", value_parser = values::time_bounds, allow_hyphen_values = true,
        conflicts_with_all = ["opl_range", "bins"]
    )]
    pub(crate) time_range: Option<Bounds>,

    /// From one optical path length to another, in metres: 0.6..2.4
    #[arg(
        long, value_name = "A..B", value_parser = values::opl_bounds, allow_hyphen_values = true,
        conflicts_with = "bins"
    )]
    pub(crate) opl_range: Option<Bounds>,

    /// Bins A to B - 1, counted from 0
    #[arg(long, value_name = "A..B", value_parser = values::bins, allow_hyphen_values = true)]
    pub(crate) bins: Option<values::Bins>,

    /// Average bins so that there are at most so many frames
    #[arg(long, value_name = "N", default_value_t = 300, allow_negative_numbers = true)]
    pub(crate) max_frames: usize,

    /// Demand times without the leg from the eye to the first surface: render with --unwarp
    #[arg(long)]
    pub(crate) unwarp: bool,
}

/// Tone mapping.
#[derive(Debug, Args)]
pub(crate) struct ToneArgs {
    /// Tone curve of pictures [default: linear]
    #[arg(long, value_name = "TONE")]
    pub(crate) tone: Option<ToneArg>,

    /// Exposure of pictures in stops: 1 doubles, -1 halves [default: 0]
    #[arg(long, value_name = "STOPS", value_parser = values::stops, allow_hyphen_values = true)]
    pub(crate) exposure: Option<f64>,
}

impl ToneArgs {
    /// The pictures that were asked for.
    pub(crate) fn pictures(&self) -> PictureOptions {
        let tone = match self.tone {
            None | Some(ToneArg::Linear) => Tone::Linear,
            Some(ToneArg::Log) => Tone::Log,
            Some(ToneArg::Filmic) => Tone::Filmic,
        };
        let exposure_stops = self.exposure.unwrap_or(0.0);
        PictureOptions { tone, exposure_stops, ..PictureOptions::default() }
    }
}

/// A tone curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ToneArg {
    /// sRGB, clipped at white
    Linear,
    /// Equal ratios are equal steps of grey, over four decades
    Log,
    /// The ACES film curve: deep shadows, soft highlights
    Filmic,
}

/// A time of arrival.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ArrivalArg {
    /// Weighted by energy
    Mean,
    /// Of the brightest bin
    Peak,
}

impl From<ArrivalArg> for ArrivalTime {
    fn from(arrival: ArrivalArg) -> Self {
        match arrival {
            ArrivalArg::Mean => Self::Mean,
            ArrivalArg::Peak => Self::Peak,
        }
    }
}
