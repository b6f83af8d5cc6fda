//! `tpb video`: a result as a video.

mod args;
mod progress;
mod source;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use tpb_film::Tone;
use tpb_optics::opl::seconds_from_opl;
use tpb_video::{Format, MAX_FPS_GIF, VideoError, VideoOptions, VideoReport, White, write_video};

pub(crate) use args::{ToneArgs, VideoArgs};

use crate::failure::Failure;
use crate::print;
use crate::summary::Lines;
use progress::Bar;
use source::Source;

/// The exit code of a program that SIGINT ended.
const INTERRUPTED: u8 = 130;

/// How ffmpeg is installed here.
const INSTALL: &str = if cfg!(target_os = "macos") {
    "brew install ffmpeg"
} else if cfg!(target_os = "windows") {
    "winget install ffmpeg"
} else {
    "sudo apt-get install ffmpeg"
};

/// Reads, paints, encodes, prints.
pub(crate) fn run(args: &VideoArgs) -> Result<ExitCode, Failure> {
    let named = args.output.as_deref().map(Format::of).transpose()?;
    let mut source = Source::read(&args.result)?;
    if args.time.unwarp {
        source.need_unwarped()?;
    }
    let path = args.output.clone().unwrap_or_else(|| default_output(&args.result));
    let format = named.unwrap_or(Format::Apng);
    let bins = source.bins(&args.time)?;
    source.apply_pulse(args.light.pulse)?;
    let options = VideoOptions { bins, timed: source.timed(), ..options(args) };
    let bar = Bar::new();
    let written = write_video(source.arrays(), &path, format, &options, &mut |done, total| {
        bar.show(done, total)
    });
    bar.finish();
    let report = match written {
        Err(_) if bar.interrupted() => {
            print::err(&VideoError::Interrupted.to_string());
            return Ok(ExitCode::from(INTERRUPTED));
        }
        written => written?,
    };
    print::out(&describe(&path, format, &options, &report, &source))?;
    Ok(if source.is_sound() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Named after the result, in the current folder.
fn default_output(result: &Path) -> PathBuf {
    PathBuf::from(format!("{}.apng", crate::viewer::name(result)))
}

fn options(args: &VideoArgs) -> VideoOptions {
    let VideoArgs { light, time, .. } = args;
    let mut pictures = light.tone.pictures();
    pictures.frames_per_second = args.fps;
    pictures.max_frames = time.max_frames;
    let white = match (light.follow, light.white) {
        (true, _) => White::Followed,
        (false, Some(white)) => White::Given(white),
        (false, None) => White::Shared,
    };
    VideoOptions {
        pictures,
        white,
        scale: args.scale,
        label: args.label,
        colour_time: light.colour_time.map(Into::into),
        dither: args.dither,
        ffmpeg: std::env::var_os("FFMPEG").unwrap_or_else(|| OsString::from("ffmpeg")),
        ..VideoOptions::default()
    }
}

/// What was made.
fn describe(
    path: &Path,
    format: Format,
    options: &VideoOptions,
    report: &VideoReport,
    source: &Source,
) -> String {
    let mut lines = Lines::default();
    let (width, height) = report.size;
    let size = report.bytes as f64 / 1e6;
    let fps = options.pictures.frames_per_second;
    let length = if format == Format::Png {
        "one picture (name it .apng for a video)".to_owned()
    } else {
        let seconds = report.frames as f64 / f64::from(fps);
        format!("{} frames at {fps} per second = {seconds:.1} s", report.frames)
    };
    lines.add("video", &format!("{}: {width} x {height}, {length}, {size:.2} MB", path.display()));
    if report.padding != (0, 0) {
        let (columns, rows) = report.padding;
        lines.add(
            "padding",
            &format!("{columns} columns, {rows} rows of black: sides must be even"),
        );
    }
    lines.add("bins", &bins(report, source));
    lines.add("exposure", &exposure(options, report));
    for remark in &source.remarks {
        lines.add("WARNING", remark);
    }
    lines.text()
}

fn bins(report: &VideoReport, source: &Source) -> String {
    let (first, end) = (report.bins.start, report.bins.end);
    let shown = format!("{first}..{end}, {} a frame", report.bins_per_frame);
    if !source.timed() {
        return shown;
    }
    let edges = &source.arrays().opl_edges;
    let (from, to) = (edges[first], edges[end]);
    let ns = |opl: f64| seconds_from_opl(opl) * 1e9;
    format!("{shown}: {:.4} ns to {:.4} ns = {from:.4} m to {to:.4} m", ns(from), ns(to))
}

fn exposure(options: &VideoOptions, report: &VideoReport) -> String {
    let tone = match options.pictures.tone {
        Tone::Linear => "linear",
        Tone::Log => "log",
        Tone::Filmic => "filmic",
    };
    let stops = options.pictures.exposure_stops;
    if options.white == White::Followed {
        return format!("{tone}, {stops:+} stops, follows the frames");
    }
    format!("{tone}, {stops:+} stops; others alike: --white {:.4e}", report.white)
}

impl From<VideoError> for Failure {
    fn from(error: VideoError) -> Self {
        let message = error.to_string();
        match error {
            VideoError::UnknownFormat { .. } => {
                Self::with_help(format!("-o {message}"), "for example -o video.apng")
            }
            VideoError::Option { option, value, expected } => {
                let message = format!("--{option} {value}: expected {expected}");
                match option {
                    "fps" => Self::with_help(
                        message,
                        format!(
                            "players slow a GIF down above {MAX_FPS_GIF} frames per second; .apng, \
                             .mp4 and .webm take up to 240"
                        ),
                    ),
                    "scale" => Self::with_help(message, "larger ones are the player's to make"),
                    "max-frames" => Self::with_help(message, "leave it out for 300"),
                    _ => Self::input(message),
                }
            }
            VideoError::TooLarge { .. } => Self::with_help(message, "--scale makes it smaller"),
            VideoError::Label { .. } => Self::with_help(
                format!("--label: {message}"),
                "--scale 2 or more enlarges the picture",
            ),
            VideoError::NoFfmpeg { .. } => Self::with_help(
                format!("{message}; MP4 and WebM are made by ffmpeg"),
                format!(
                    "install it: {INSTALL} (or name the program in the environment variable FFMPEG); \
                     .apng and .gif need nothing"
                ),
            ),
            VideoError::Ffmpeg { .. } if message.contains("ncoder") => Self::with_help(
                message,
                "if this ffmpeg lacks the encoder, try .webm instead of .mp4 or the reverse; .apng \
                 needs none",
            ),
            _ => Self::input(message),
        }
    }
}
