//! One palette for all frames of a GIF.
//!
//! Colours are drawn from all frames, black left out (most of a dark video is black), and
//! clustered in OKLab (Ottosson 2020) by k-means. Black and white are always there, so that
//! darkness stays dark and labels white. One palette instead of one per frame keeps still parts
//! still: nothing flickers, and the file stays small.

use quantette::color_map::{IndexedColorMap, NearestNeighborColorMap};
use quantette::color_space::srgb8_to_oklab;
use quantette::deps::palette::{Oklab, Srgb, cast::ArraysAs};
use quantette::dither::FloydSteinberg;
use quantette::{ImageRef, PaletteBuf, PaletteSize, Pipeline, QuantizeMethod};

/// At most about this many colours are drawn.
const DRAWN: usize = 1 << 19;

/// Colours beside black, white and the transparent one.
const CLUSTERS: u8 = 253;

/// Draws colours from frames.
pub(super) struct Draw {
    one_in: u64,
    seen: u64,
    colours: Vec<Srgb<u8>>,
}

impl Draw {
    /// From so many pixels in all.
    pub(super) fn new(pixels: usize) -> Self {
        Self { one_in: pixels.div_ceil(DRAWN).max(1) as u64, seen: 0, colours: Vec::new() }
    }

    /// From the next pixels. Which of them is fixed by their number (Knuth's multiplicative hash):
    /// even over image and time, without the columns that a fixed stride may hit.
    pub(super) fn see(&mut self, samples: &[u8]) {
        for pixel in samples.chunks_exact(3) {
            let hash = self.seen.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
            self.seen += 1;
            if hash.is_multiple_of(self.one_in) && pixel != [0; 3] {
                self.colours.push(Srgb::new(pixel[0], pixel[1], pixel[2]));
            }
        }
    }

    /// The palette for what was drawn.
    pub(super) fn palette(self) -> Palette {
        let mut colours = vec![Srgb::new(0, 0, 0), Srgb::new(255, 255, 255)];
        let pipeline = Pipeline::new()
            .palette_size(PaletteSize::from_u8_clamped(CLUSTERS))
            .quantize_method(QuantizeMethod::kmeans());
        // Fails only where nothing was drawn: a black video.
        if let Ok(pipeline) = pipeline.input_slice(&self.colours) {
            colours.extend_from_slice(&pipeline.output_srgb8_palette());
        }
        Palette::new(colours)
    }
}

/// At most 255 colours.
pub(super) struct Palette {
    colours: Vec<Srgb<u8>>,
    nearest: NearestNeighborColorMap<Oklab, f32, 3>,
}

impl Palette {
    fn new(colours: Vec<Srgb<u8>>) -> Self {
        let oklab = PaletteBuf::new(srgb8_to_oklab(&colours)).expect("at most 255 colours");
        Self { colours, nearest: NearestNeighborColorMap::new(oklab) }
    }

    /// How many colours.
    pub(super) fn len(&self) -> usize {
        self.colours.len()
    }

    /// Samples, three a colour, and one colour more, for what is transparent.
    pub(super) fn samples(&self) -> Vec<u8> {
        let all = self.colours.iter().flat_map(|c| [c.red, c.green, c.blue]);
        all.chain([0; 3]).collect()
    }

    /// Indices of the nearest colours; with errors passed on to neighbours, if `dither`.
    pub(super) fn indices(&self, samples: &[u8], width: usize, dither: bool) -> Vec<u8> {
        let (pixels, _) = samples.as_chunks::<3>();
        let pixels: &[Srgb<u8>] = pixels.arrays_as();
        let oklab = srgb8_to_oklab(pixels);
        if dither {
            let (width, height) = (width as u32, (oklab.len() / width) as u32);
            let image = ImageRef::new(width, height, &oklab).expect("rows of equal width");
            let dithered = FloydSteinberg::new().dither_image_to_indexed(image, &self.nearest);
            return dithered.into_parts().1;
        }
        self.nearest.map_to_indices(&oklab)
    }
}
