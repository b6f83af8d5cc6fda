//! What photons add to pixels, sorted by pixel for the film's tiles.
//!
//! A counting sort: stable, so that each pixel's contributions stay in the photons' order, whatever
//! the tiles and threads.

use std::ops::Range;

use tpb_optics::Spectrum;

/// What a photon adds to a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contribution<const C: usize> {
    /// Time-integrated radiance, averaged over the pixel \[W m^-2 sr^-1\].
    pub(crate) energy: Spectrum<C>,
    /// OPL from the emitter to the eye, or what an unwarping film makes of it \[m\].
    pub(crate) opl: f64,
    /// The pixel, y · width + x.
    pub(crate) pixel: u32,
}

/// Contributions by pixel.
pub(crate) struct Sorted<const C: usize> {
    /// Where each pixel's begin, and after the last one's the number of all.
    starts: Vec<usize>,
    contributions: Vec<(f64, Spectrum<C>)>,
}

impl<const C: usize> Sorted<C> {
    /// Of chunks in the photons' order, for a film of so many pixels.
    pub(crate) fn new(chunks: Vec<Vec<Contribution<C>>>, pixels: usize) -> Self {
        // One further place: after the scattering, starts[p] is where pixel p − 1 begins.
        let mut starts = vec![0; pixels + 2];
        for contribution in chunks.iter().flatten() {
            starts[contribution.pixel as usize + 2] += 1;
        }
        for pixel in 2..starts.len() {
            starts[pixel] += starts[pixel - 1];
        }
        let count = starts[starts.len() - 1];
        let mut contributions = vec![(0.0, Spectrum::ZERO); count];
        // Each chunk is freed as soon as it is sorted in.
        for chunk in chunks {
            for Contribution { energy, opl, pixel } in chunk {
                let place = &mut starts[pixel as usize + 1];
                contributions[*place] = (opl, energy);
                *place += 1;
            }
        }
        Self { starts, contributions }
    }

    /// OPL and energy of a pixel's contributions.
    pub(crate) fn of(&self, pixel: usize) -> &[(f64, Spectrum<C>)] {
        let range: Range<usize> = self.starts[pixel]..self.starts[pixel + 1];
        &self.contributions[range]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_get_their_own_in_order() {
        let given = [(2, 0.1), (0, 0.2), (2, 0.3), (4, 0.4), (0, 0.5), (2, 0.6)];
        let contributions: Vec<_> = given
            .iter()
            .map(|&(pixel, opl)| Contribution { energy: Spectrum([2.0 * opl]), opl, pixel })
            .collect();
        let chunks = vec![contributions[..2].to_vec(), vec![], contributions[2..].to_vec()];
        let sorted = Sorted::new(chunks, 5);
        for pixel in 0..5 {
            let expected: Vec<_> = given.iter().filter(|g| g.0 as usize == pixel).collect();
            let found = sorted.of(pixel);
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(expected) {
                assert_eq!(*found, (expected.1, Spectrum([2.0 * expected.1])));
            }
        }
        assert!(Sorted::<1>::new(vec![], 3).of(2).is_empty());
    }
}
