//! Images as textures: PNG (sRGB, made linear) and OpenEXR (linear).
//!
//! Texel (i, j) of an image of w × h has its middle at ((i + ½)/w, (j + ½)/h), its first row at v =
//! 0. An alpha channel is not read.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use exr::prelude as exr;
use glam::DVec2;
use tpb_optics::{Rgb, Spectrum};

/// Images with more texels are refused.
const MOST_TEXELS: usize = 1 << 28;

/// An image, linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Bitmap {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
}

/// What is seen between the middles of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Bilinear interpolation of the four around.
    Bilinear,
}

/// What is seen beyond the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image again, every other time mirrored.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

impl Bitmap {
    /// From linear texels, row by row. `None` if their number is not width × height, at least 1.
    pub fn new(width: usize, height: usize, texels: Vec<[f32; 3]>) -> Option<Self> {
        let fits = !texels.is_empty() && width.checked_mul(height) == Some(texels.len());
        fits.then_some(Self { width, height, texels })
    }

    /// Reads a file by its extension, `png` or `exr`. `raw`: a PNG holds linear values already.
    ///
    /// # Errors
    /// What is wrong with the file, in words; values outside of 0 to 1 are.
    pub fn load(path: &Path, raw: bool) -> Result<Self, String> {
        let is_file = fs::metadata(path).map_err(|error| error.to_string())?.is_file();
        if !is_file {
            return Err("this is not a file".to_owned());
        }
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let image = match extension.as_deref() {
            Some("png") => png(path, raw)?,
            Some("exr") => open_exr(path)?,
            _ => return Err("only `png` and `exr` files are read".to_owned()),
        };
        let sound = |texel: &[f32; 3]| texel.iter().all(|v| (0.0..=1.0).contains(v));
        match image.texels.iter().position(|texel| !sound(texel)) {
            None => Ok(image),
            Some(index) => Err(format!(
                "the texel in column {}, row {} is not within 0 to 1",
                index % image.width,
                index / image.width
            )),
        }
    }

    /// The value at texture coordinates.
    pub fn at(&self, uv: DVec2, filter: Filter, wrap: Wrap) -> Rgb {
        let place = uv * DVec2::new(self.width as f64, self.height as f64);
        match filter {
            Filter::Nearest => self.texel(place.floor(), wrap),
            Filter::Bilinear => {
                let place = place - DVec2::splat(0.5);
                let corner = place.floor();
                let DVec2 { x, y } = place - corner;
                let at = |dx: f64, dy: f64| self.texel(corner + DVec2::new(dx, dy), wrap);
                let upper = at(0.0, 0.0) * (1.0 - x) + at(1.0, 0.0) * x;
                let lower = at(0.0, 1.0) * (1.0 - x) + at(1.0, 1.0) * x;
                upper * (1.0 - y) + lower * y
            }
        }
    }

    fn texel(&self, at: DVec2, wrap: Wrap) -> Rgb {
        let (x, y) = (wrapped(at.x, self.width, wrap), wrapped(at.y, self.height, wrap));
        Spectrum(self.texels[y * self.width + x].map(f64::from))
    }

    /// The largest value of each channel.
    pub fn most(&self) -> Rgb {
        let most = |channel: usize| self.texels.iter().map(|t| t[channel]).fold(0.0, f32::max);
        Spectrum([0, 1, 2].map(|channel| f64::from(most(channel))))
    }

    /// Whether it has no colour.
    pub fn is_achromatic(&self) -> bool {
        self.texels.iter().all(|[r, g, b]| r == g && g == b)
    }
}

/// The index of a texel along one side, from any whole number.
fn wrapped(index: f64, count: usize, wrap: Wrap) -> usize {
    let n = count as f64;
    let index = match wrap {
        Wrap::Repeat => index.rem_euclid(n),
        Wrap::Mirror => {
            let twice = index.rem_euclid(2.0 * n);
            if twice < n { twice } else { 2.0 * n - 1.0 - twice }
        }
        Wrap::Clamp => index,
    };
    // NaN and what rounding leaves outside too.
    (index.max(0.0) as usize).min(count - 1)
}

/// sRGB's curve, from coded values to linear ones (IEC 61966-2-1).
fn linear(coded: f32) -> f32 {
    if coded <= 0.04045 { coded / 12.92 } else { ((coded + 0.055) / 1.055).powf(2.4) }
}

fn png(path: &Path, raw: bool) -> Result<Bitmap, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    // Palettes and fewer than 8 bits become 8 bits.
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(width, height)?;
    let size = reader.output_buffer_size().ok_or("the image does not fit memory")?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(|error| error.to_string())?;
    let wide = frame.bit_depth == png::BitDepth::Sixteen;
    let value = |index: usize| {
        if wide {
            f32::from(u16::from_be_bytes([bytes[2 * index], bytes[2 * index + 1]])) / 65535.0
        } else {
            f32::from(bytes[index]) / 255.0
        }
    };
    let value = |index: usize| if raw { value(index) } else { linear(value(index)) };
    let channels = frame.color_type.samples();
    let texel = |index: usize| match channels {
        1 | 2 => [value(index * channels); 3],
        _ => [0, 1, 2].map(|channel| value(index * channels + channel)),
    };
    let texels = (0..width * height).map(texel).collect();
    Bitmap::new(width, height, texels).ok_or_else(|| "the image is empty".to_owned())
}

fn open_exr(path: &Path) -> Result<Bitmap, String> {
    struct Rows(usize, Vec<[f32; 3]>);
    let image = exr::read_first_rgba_layer_from_file(
        path,
        |size, _| Rows(size.0, vec![[f32::NAN; 3]; size.0 * size.1]),
        |Rows(width, texels), at, (r, g, b, _): (f32, f32, f32, f32)| {
            texels[at.1 * *width + at.0] = [r, g, b];
        },
    );
    let image = image.map_err(|error| error.to_string())?;
    let (width, height) = (image.layer_data.size.0, image.layer_data.size.1);
    check_size(width, height)?;
    let texels = image.layer_data.channel_data.pixels.1;
    Bitmap::new(width, height, texels).ok_or_else(|| "the image is empty".to_owned())
}

fn check_size(width: usize, height: usize) -> Result<(), String> {
    match width.checked_mul(height) {
        Some(texels) if texels <= MOST_TEXELS => Ok(()),
        _ => Err(format!("the image has more than {MOST_TEXELS} texels")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_interpolated_and_wrapped() {
        let grey = |v: f32| [v; 3];
        let texels = [0.0, 0.25, 0.5, 1.0, 0.75, 0.5].map(grey).to_vec();
        let image = Bitmap::new(3, 2, texels).unwrap();
        let at = |u, v, filter, wrap| image.at(DVec2::new(u, v), filter, wrap)[1];
        let (near, linear) = (Filter::Nearest, Filter::Bilinear);
        for (u, v, filter, wrap, expected) in [
            (0.1, 0.1, near, Wrap::Repeat, 0.0),
            (0.9, 0.9, near, Wrap::Repeat, 0.5),
            (1.1, 0.6, near, Wrap::Repeat, 1.0),
            (1.1, 0.6, near, Wrap::Mirror, 0.5),
            (-0.1, -0.1, near, Wrap::Mirror, 0.0),
            (7.0, -3.0, near, Wrap::Clamp, 0.5),
            (0.5, 0.25, linear, Wrap::Repeat, 0.25),
            (2.0 / 3.0, 0.25, linear, Wrap::Repeat, 0.375),
            (0.5, 0.5, linear, Wrap::Repeat, 0.5),
            (0.0, 0.25, linear, Wrap::Repeat, 0.25),
            (0.0, 0.25, linear, Wrap::Clamp, 0.0),
            (f64::NAN, 0.0, near, Wrap::Repeat, 0.0),
        ] {
            assert!(
                (at(u, v, filter, wrap) - expected).abs() < 1e-7,
                "{u} {v} {filter:?} {wrap:?}"
            );
        }
        assert!(Bitmap::new(2, 2, vec![[0.0; 3]; 3]).is_none());
    }

    #[test]
    fn files_are_read_and_made_linear() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 2, 1);
        encoder.set_color(png::ColorType::Rgba);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[0, 255, 188, 9, 10, 20, 30, 255]).unwrap();
        writer.finish().unwrap();
        let image = Bitmap::load(&path, false).unwrap();
        assert_eq!((image.width, image.height), (2, 1));
        // 188/255 in sRGB is half of the light, nearly.
        assert!((image.texels[0][2] - 0.502_886_5).abs() < 1e-6 && image.texels[0][1] == 1.0);
        assert!((image.texels[1][0] - 10.0 / 255.0 / 12.92).abs() < 1e-7);
        let raw = Bitmap::load(&path, true).unwrap();
        assert!((raw.texels[0][2] - 188.0 / 255.0).abs() < 1e-7 && !raw.is_achromatic());

        let path = folder.path().join("b.exr");
        let value = |x: usize, y: usize| (0.25 * x as f32, 0.5, 0.1 * y as f32, 1.0_f32);
        exr::write_rgba_file(&path, 3, 2, value).unwrap();
        let image = Bitmap::load(&path, false).unwrap();
        assert_eq!((image.width, image.height), (3, 2));
        assert!((image.texels[5][0] - 0.5).abs() < 1e-6 && (image.texels[5][2] - 0.1).abs() < 1e-6);
        assert!((image.most()[0] - 0.5).abs() < 1e-6);
        exr::write_rgba_file(&path, 2, 2, |_, _| (1.5_f32, 0.0, 0.0, 1.0)).unwrap();
        assert!(Bitmap::load(&path, false).unwrap_err().contains("column 0, row 0"));
        fs::write(&path, b"no image").unwrap();
        assert!(Bitmap::load(&path, false).is_err());
        assert!(Bitmap::load(&folder.path().join("c.jpg"), false).is_err());
    }
}
