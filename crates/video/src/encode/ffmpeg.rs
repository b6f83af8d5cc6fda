//! MP4 (H.264) and WebM (VP9) by the program ffmpeg: raw frames through its standard input.
//!
//! The frames' sRGB samples become limited-range BT.709 Y'CbCr with chroma at half resolution
//! (`yuv420p`, what players know), and the file says so: matrix and primaries BT.709, transfer
//! sRGB (IEC 61966-2-1). A key frame every second makes stepping quick. ffmpeg writes beside the
//! final name; the file is renamed when all went well.

use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};
use std::thread;

use tpb_film::{FilmError, atomic_path};

use super::Reel;
use crate::{Format, VideoError, VideoOptions};

/// The last so many bytes of what ffmpeg says are kept.
const KEPT_BYTES: usize = 4096;

/// And of them the last so many lines.
const KEPT_LINES: usize = 8;

/// H.264: visually lossless; more bits for dark, flat parts, where fog would show bands.
const H264: [&str; 10] = [
    "-c:v",
    "libx264",
    "-preset",
    "medium",
    "-crf",
    "16",
    "-x264-params",
    "aq-mode=3",
    "-movflags",
    "+faststart",
];

/// VP9 at constant quality.
const VP9: [&str; 12] = [
    "-c:v",
    "libvpx-vp9",
    "-crf",
    "20",
    "-b:v",
    "0",
    "-row-mt",
    "1",
    "-deadline",
    "good",
    "-cpu-used",
    "2",
];

/// Writes all frames.
///
/// # Errors
/// [`VideoError::NoFfmpeg`], [`VideoError::Ffmpeg`]; [`VideoError::Film`] if the file cannot be
/// written.
pub(crate) fn write(
    reel: &mut Reel<'_, '_>,
    path: &Path,
    format: Format,
    options: &VideoOptions,
) -> Result<(), VideoError> {
    atomic_path(path, |unfinished| {
        let mut command = Command::new(&options.ffmpeg);
        command.args(arguments(reel, format, options.pictures.frames_per_second)).arg(unfinished);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command
            .spawn()
            .map_err(|source| VideoError::NoFfmpeg { program: options.ffmpeg.clone(), source })?;
        let listener = child.stderr.take().map(|stderr| thread::spawn(|| last_words(stderr)));
        let fed = feed(reel, &mut child);
        if fed.as_ref().is_err_and(|error| error.kind() != io::ErrorKind::BrokenPipe) {
            // No half of a video is wanted; that it has ended already is fine.
            let _ = child.kill();
        }
        let status = child.wait().map_err(|source| io_error(path, source))?;
        let last_lines = listener.and_then(|listener| listener.join().ok()).unwrap_or_default();
        let failed = |status| VideoError::Ffmpeg {
            program: options.ffmpeg.clone(),
            status,
            last_lines: lines(&last_lines),
        };
        match fed {
            // Its own words tell more than that the pipe broke.
            _ if reel.stopped() => Err(VideoError::Interrupted),
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(io_error(path, error)),
            _ if !status.success() => Err(failed(describe(status))),
            Err(_) => Err(failed("it ended before it had all frames".to_owned())),
            Ok(()) if is_empty(unfinished) => Err(failed("it wrote nothing".to_owned())),
            Ok(()) => Ok(()),
        }
    })
}

/// All but the output's name.
fn arguments(reel: &Reel<'_, '_>, format: Format, frames_per_second: u16) -> Vec<String> {
    let (width, height) = reel.size();
    let size = format!("{width}x{height}");
    let rate = frames_per_second.to_string();
    let pixels = if reel.channels() == 3 { "rgb24" } else { "gray" };
    let input = [
        "-hide_banner",
        "-loglevel",
        "error",
        "-nostats",
        "-y",
        "-f",
        "rawvideo",
        "-pixel_format",
        pixels,
        "-video_size",
        &size,
        "-framerate",
        &rate,
        "-i",
        "pipe:0",
        "-an",
    ];
    let filter = "scale=in_range=full:out_range=limited:out_color_matrix=bt709:\
                  flags=accurate_rnd+full_chroma_int,format=yuv420p";
    let colours = [
        "-vf",
        filter,
        "-color_range",
        "tv",
        "-colorspace",
        "bt709",
        "-color_primaries",
        "bt709",
        "-color_trc",
        "iec61966-2-1",
        "-g",
        &rate,
    ];
    let (codec, container) =
        if format == Format::Webm { (&VP9[..], "webm") } else { (&H264[..], "mp4") };
    let output = ["-f", container];
    let all = input.iter().chain(&colours).chain(codec).chain(&output);
    all.map(|&argument| argument.to_owned()).collect()
}

/// Hands it all frames and closes the pipe.
fn feed(reel: &mut Reel<'_, '_>, child: &mut Child) -> io::Result<()> {
    let Some(mut stdin) = child.stdin.take() else {
        return Err(io::Error::other("ffmpeg has no standard input"));
    };
    reel.play(|samples| stdin.write_all(samples))?;
    stdin.flush()
}

/// The end of what a program prints, until it closes.
fn last_words(mut stderr: ChildStderr) -> Vec<u8> {
    let (mut kept, mut buffer) = (Vec::new(), [0; 1024]);
    while let Ok(length) = stderr.read(&mut buffer) {
        if length == 0 {
            break;
        }
        kept.extend_from_slice(&buffer[..length]);
        let surplus = kept.len().saturating_sub(KEPT_BYTES);
        kept.drain(..surplus);
    }
    kept
}

/// The last lines, fit to print.
fn lines(bytes: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(bytes);
    let printable =
        |line: &str| line.chars().filter(|c| !c.is_control()).collect::<String>().trim().to_owned();
    let lines: Vec<String> =
        text.split(['\n', '\r']).map(printable).filter(|line| !line.is_empty()).collect();
    lines[lines.len().saturating_sub(KEPT_LINES)..].to_vec()
}

fn describe(status: ExitStatus) -> String {
    status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"))
}

fn is_empty(path: &Path) -> bool {
    path.metadata().map_or(true, |found| found.len() == 0)
}

fn io_error(path: &Path, source: io::Error) -> VideoError {
    FilmError::Io { path: path.to_path_buf(), source }.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_lines_are_few_and_printable() {
        let text: Vec<String> = (0..20).map(|i| format!("line {i}\x1b[31m \r\n")).collect();
        let text = text.concat();
        let lines = lines(text.as_bytes());
        assert_eq!(lines.len(), KEPT_LINES);
        assert_eq!(lines[7], "line 19[31m");
        assert!(super::lines(b"\n \r\n\xff").len() == 1, "lossy");
    }
}
