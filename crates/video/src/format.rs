//! File formats.

use std::path::Path;

use crate::VideoError;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One picture that covers all frames; lossless.
    Png,
    /// Animated PNG: lossless, plays in any browser.
    Apng,
    /// GIF: at most 256 colours, plays anywhere.
    Gif,
    /// H.264 in MP4, by ffmpeg.
    Mp4,
    /// VP9 in WebM, by ffmpeg.
    Webm,
}

impl Format {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// [`VideoError::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, VideoError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("apng") => Ok(Self::Apng),
            Some("gif") => Ok(Self::Gif),
            Some("mp4") => Ok(Self::Mp4),
            Some("webm") => Ok(Self::Webm),
            _ => Err(VideoError::UnknownFormat { path: path.to_path_buf() }),
        }
    }

    /// Its name, and its largest side in pixels.
    pub(crate) fn limit(self) -> (&'static str, usize) {
        match self {
            Self::Png => ("PNG", i32::MAX as usize),
            Self::Apng => ("APNG", i32::MAX as usize),
            Self::Gif => ("GIF", u16::MAX as usize),
            Self::Mp4 => ("MP4", 16_384),
            Self::Webm => ("WebM", 16_384),
        }
    }

    /// Whether sides have to be even: chroma has half the resolution.
    pub(crate) fn even_sides(self) -> bool {
        matches!(self, Self::Mp4 | Self::Webm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_formats() {
        for (name, expected) in [
            ("a.png", Format::Png),
            ("b/a.b.APNG", Format::Apng),
            ("a.gif", Format::Gif),
            ("a.Mp4", Format::Mp4),
            ("a.webm", Format::Webm),
        ] {
            assert_eq!(Format::of(Path::new(name)).unwrap(), expected, "{name}");
        }
        for name in ["a", "a.avi", "gif", ".mp4", "a.gif/"] {
            let found = Format::of(Path::new(name));
            if name == "a.gif/" {
                assert!(found.is_ok());
                continue;
            }
            let message = found.unwrap_err().to_string();
            assert!(message.contains(".webm") && message.contains(name), "{message}");
        }
    }
}
