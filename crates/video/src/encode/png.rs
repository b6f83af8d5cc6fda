//! PNG and animated PNG: lossless, 8 bits, sRGB.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent};

use super::Reel;

/// Writes all frames, which play for ever; a single picture where there is no speed.
pub(crate) fn write(
    reel: &mut Reel<'_, '_>,
    frames_per_second: Option<u16>,
    file: &mut impl Write,
) -> io::Result<()> {
    let side = |side: usize| u32::try_from(side).map_err(io::Error::other);
    let (width, height) = reel.size();
    let mut encoder = Encoder::new(file, side(width)?, side(height)?);
    encoder.set_color(if reel.channels() == 3 { ColorType::Rgb } else { ColorType::Grayscale });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    if let Some(frames_per_second) = frames_per_second {
        encoder.set_animated(side(reel.count())?, 0)?;
        encoder.set_frame_delay(1, frames_per_second)?;
    }
    let mut writer = encoder.write_header()?;
    reel.play(|samples| Ok(writer.write_image_data(samples)?))?;
    Ok(writer.finish()?)
}
