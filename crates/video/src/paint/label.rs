//! Time and OPL, written into a corner of each frame.
//!
//! Bitmap fonts (the X11 *misc-fixed* family, in the public domain, as `embedded-graphics` carries
//! them), white with a black outline. The font is the largest that is at most a sixteenth of the
//! picture high and fits; numbers keep their places from frame to frame.

use std::convert::Infallible;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::ascii::{
    FONT_4X6, FONT_5X7, FONT_6X10, FONT_7X13, FONT_8X13, FONT_9X15, FONT_10X20,
};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::Drawable;
use embedded_graphics::text::{Baseline, Text};
use tpb_optics::opl::seconds_from_opl;

use crate::VideoError;

/// Fonts by size.
const FONTS: [&MonoFont<'_>; 7] =
    [&FONT_4X6, &FONT_5X7, &FONT_6X10, &FONT_7X13, &FONT_8X13, &FONT_9X15, &FONT_10X20];

/// Pixels from the corner, and around the glyphs, at the font's own size.
const MARGIN: u16 = 2;

/// A unit and its size.
type Unit = (&'static str, f64);

const TIMES: [Unit; 7] = [
    ("ks", 1e3),
    ("s", 1.0),
    ("ms", 1e-3),
    ("us", 1e-6),
    ("ns", 1e-9),
    ("ps", 1e-12),
    ("fs", 1e-15),
];
const LENGTHS: [Unit; 5] = [("km", 1e3), ("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)];

/// The label of a video.
pub(super) struct Label {
    /// Lines of each frame that do not depend on its exposure.
    lines: Vec<Vec<String>>,
    font: &'static MonoFont<'static>,
    zoom: usize,
}

impl Label {
    /// For frames at these OPL \[m\] (numbers of bins, if not `timed`), in an image of `size`.
    pub(super) fn new(
        times: &[f64],
        timed: bool,
        exposed: bool,
        size: (usize, usize),
    ) -> Result<Self, VideoError> {
        let lines = if timed { timed_lines(times) } else { bin_lines(times) };
        let columns = lines.iter().flatten().map(String::len).max().unwrap_or(0);
        let columns = if exposed { columns.max(exposure_line(0.0).len()) } else { columns };
        let rows = lines.first().map_or(0, Vec::len) + usize::from(exposed);
        let needed = |font: &MonoFont<'_>, zoom: usize| {
            let glyph = font.character_size;
            let side =
                |count: usize, size: u32| zoom * (count * size as usize + 2 * usize::from(MARGIN));
            (side(columns, glyph.width), side(rows, glyph.height))
        };
        let limit = size.1 / 16;
        let zoom = (limit / FONT_10X20.character_size.height as usize).max(1);
        let suits = |index: &usize| {
            let (font, zoom) = (FONTS[*index], if *index + 1 == FONTS.len() { zoom } else { 1 });
            let (width, height) = needed(font, zoom);
            let small = *index == 0 || font.character_size.height as usize <= limit;
            small && width <= size.0 && height <= size.1
        };
        let Some(index) = (0..FONTS.len()).rev().find(suits) else {
            return Err(VideoError::Label { needed: needed(FONTS[0], 1), available: size });
        };
        let zoom = if index + 1 == FONTS.len() { zoom } else { 1 };
        Ok(Self { lines, font: FONTS[index], zoom })
    }

    /// Draws it into the samples of a picture of (width, height, channels).
    pub(super) fn draw(
        &self,
        frame: usize,
        stops: Option<f64>,
        samples: &mut [u8],
        (width, height, channels): (usize, usize, usize),
    ) {
        let mut text = self.lines[frame].join("\n");
        if let Some(stops) = stops {
            text.push('\n');
            text.push_str(&exposure_line(stops));
        }
        let mut glyphs = Glyphs::default();
        let style = MonoTextStyle::new(self.font, BinaryColor::On);
        let corner = Point::new(i32::from(MARGIN), i32::from(MARGIN));
        let text = Text::with_baseline(&text, corner, style, Baseline::Top);
        let Ok(_) = text.draw(&mut glyphs);
        let mut fill = |left: usize, top: usize, side: usize, shade: u8| {
            for y in top..(top + side).min(height) {
                let row = &mut samples[y * width * channels..(y + 1) * width * channels];
                row[left * channels..(left + side).min(width) * channels].fill(shade);
            }
        };
        // MARGIN keeps the outline within the picture.
        for &(x, y) in &glyphs.0 {
            fill((x - 1) * self.zoom, (y - 1) * self.zoom, 3 * self.zoom, 0);
        }
        for &(x, y) in &glyphs.0 {
            fill(x * self.zoom, y * self.zoom, self.zoom, 255);
        }
    }
}

/// Time and OPL.
fn timed_lines(times: &[f64]) -> Vec<Vec<String>> {
    let seconds: Vec<f64> = times.iter().map(|&opl| seconds_from_opl(opl)).collect();
    let (time, opl) = (Column::new(&seconds, &TIMES, "ns"), Column::new(times, &LENGTHS, "m"));
    let width = time.width.max(opl.width);
    let lines = seconds.iter().zip(times);
    lines.map(|(&t, &o)| vec![time.line(t, width), opl.line(o, width) + " OPL"]).collect()
}

/// Numbers of bins.
fn bin_lines(times: &[f64]) -> Vec<Vec<String>> {
    let last = times.last().map_or(0.0, |time| time.floor());
    let width = format!("{last}").len();
    times.iter().map(|time| vec![format!("bin {:>width$}", time.floor())]).collect()
}

/// How much brighter a frame is shown than the video's own exposure would.
fn exposure_line(stops: f64) -> String {
    format!("{stops:+5.1} EV")
}

/// How numbers of one kind are written.
struct Column {
    unit: Unit,
    decimals: usize,
    width: usize,
}

impl Column {
    /// In the `usual` unit, if it takes few digits; with one digit more than steps need.
    fn new(values: &[f64], units: &[Unit], usual: &str) -> Self {
        let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let usual = units.iter().find(|unit| unit.0 == usual);
        let usual = usual.filter(|unit| (0.01..1e4).contains(&(largest / unit.1)));
        let by_size = units.iter().find(|unit| largest >= unit.1).or(units.last());
        let unit = usual.or(by_size).copied().unwrap_or(("", 1.0));
        let step = match values {
            [first, second, ..] => (second - first) / unit.1,
            _ => largest / unit.1 / 100.0,
        };
        let decimals = if step > 0.0 { (1.0 - step.log10()).ceil().clamp(0.0, 9.0) } else { 3.0 };
        let decimals = decimals as usize;
        let longest = values.iter().map(|v| format!("{:.decimals$}", v / unit.1).len()).max();
        Self { unit, decimals, width: longest.unwrap_or(0) }
    }

    fn line(&self, value: f64, width: usize) -> String {
        let decimals = self.decimals;
        format!("{:>width$.decimals$} {}", value / self.unit.1, self.unit.0)
    }
}

/// Pixels of a drawn text.
#[derive(Default)]
struct Glyphs(Vec<(usize, usize)>);

impl OriginDimensions for Glyphs {
    fn size(&self) -> Size {
        Size::new(u32::from(u16::MAX), u32::from(u16::MAX))
    }
}

impl DrawTarget for Glyphs {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<BinaryColor>>,
    {
        for Pixel(point, colour) in pixels {
            if let (BinaryColor::On, Ok(x), Ok(y)) =
                (colour, usize::try_from(point.x), usize::try_from(point.y))
            {
                self.0.push((x, y));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_resolve_the_steps_and_keep_their_places() {
        // 200 bins of 0.07 m: 0.2335 ns.
        let times: Vec<f64> = (0..200).map(|i| 0.07 * (f64::from(i) + 0.5)).collect();
        let lines = timed_lines(&times);
        assert_eq!(lines[0], ["  0.12 ns", " 0.035 m OPL"][..].to_vec());
        assert_eq!(lines[199], [" 46.58 ns", "13.965 m OPL"][..].to_vec());
        let all: std::collections::BTreeSet<&String> = lines.iter().map(|l| &l[0]).collect();
        assert_eq!(all.len(), 200, "all frames differ");
        assert!(lines.iter().all(|l| l[0].len() == 9), "and none is longer");
    }

    #[test]
    fn units_follow_the_size_of_the_scene() {
        let first = |opl: f64| {
            let lines = timed_lines(&[0.5 * opl, opl]);
            lines[1].iter().map(|l| l.trim().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(first(1e-5), ["33 fs", "10.0 um OPL"]);
        assert_eq!(first(3e5), ["1.00 ms", "300 km OPL"]);
        assert_eq!(first(0.3), ["1.00 ns", "0.30 m OPL"]);
        assert_eq!(bin_lines(&[0.5, 10.5])[0], ["bin  0"]);
    }

    #[test]
    fn the_font_grows_with_the_picture_and_must_fit() {
        let times = [1.0, 2.0, 3.0];
        let font =
            |size| Label::new(&times, true, false, size).map(|l| (l.font.character_size, l.zoom));
        assert_eq!(font((64, 64)).unwrap(), (Size::new(4, 6), 1));
        assert_eq!(font((512, 512)).unwrap(), (Size::new(10, 20), 1));
        assert_eq!(font((2000, 2000)).unwrap(), (Size::new(10, 20), 6));
        assert!(matches!(font((12, 10)), Err(VideoError::Label { available: (12, 10), .. })));
        // Wide enough for small letters only.
        assert_eq!(font((60, 2000)).unwrap().0, Size::new(5, 7));
    }

    #[test]
    fn letters_are_white_on_a_black_outline() {
        let label = Label::new(&[1.0, 2.0], true, true, (100, 60)).unwrap();
        let mut samples = vec![100; 100 * 60 * 3];
        label.draw(0, Some(3.0), &mut samples, (100, 60, 3));
        let (white, black) =
            (samples.iter().filter(|&&s| s == 255), samples.iter().filter(|&&s| s == 0));
        assert!(white.count() > 300 && black.count() > 300);
        assert!(samples.iter().all(|s| [0, 100, 255].contains(s)));
        assert!(samples.chunks(3).all(|p| p[0] == p[1] && p[1] == p[2]));
        assert!(samples[3 * 100 * 30..].iter().all(|&s| s == 100), "in the upper corner");
    }
}
