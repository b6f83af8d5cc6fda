//! The gather of rays that mirrors, glass or rough surfaces have turned: they form no lattice.
//!
//! Neighbours in the image still travel much the same way. Rays are taken in bundles, these in
//! smaller ones, down to 16 rays; at each step the beams that come near a bundle
//! (`bundle.rs`) are copied for the smaller bundles in it. What is left is tested ray by ray,
//! 16 at a time, and then evaluated by the kernel. Nothing is built but the list of beams.

use std::ops::Range;

use rayon::prelude::*;
use tpb_lanes::{Instructions, Simd, WithSimd};
use tpb_scene::MediumId;

use crate::beam::{Beam, CameraRay};
use crate::bundle::{BLOCK, BeamBlock, Bundle, Frame, Line, Numbers, RayBlock};
use crate::kernel::RayBeamKernel;

/// Rays of a bundle, from the largest to the smallest.
const BUNDLES: [usize; 3] = [512, 64, BLOCK];

/// The beams of one pass.
pub struct BeamMap<'a, const C: usize> {
    beams: &'a [Beam<C>],
    frame: Frame,
    blocks: Vec<BeamBlock>,
    /// The kernel's reach in the frame.
    radius: f32,
    instructions: Instructions,
}

/// Pairs that a query tested and accepted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairs {
    /// Pairs that were evaluated.
    pub tested: u64,
    /// Pairs that contributed.
    pub accepted: u64,
}

impl Pairs {
    /// Adds another query's.
    pub fn add(&mut self, other: Self) {
        self.tested += other.tested;
        self.accepted += other.accepted;
    }
}

impl<'a, const C: usize> BeamMap<'a, C> {
    /// For queries with `kernel`.
    pub fn new<K: RayBeamKernel>(kernel: K, beams: &'a [Beam<C>]) -> Self {
        let frame = Frame::new(beams, kernel.radius());
        let blocks = beams
            .par_chunks(BLOCK)
            .enumerate()
            .map(|(number, chunk)| BeamBlock::new(&frame, chunk, number * BLOCK))
            .collect();
        let (radius, instructions) = (frame.radius(kernel.radius()), Instructions::widest());
        Self { beams, frame, blocks, radius, instructions }
    }

    /// With these vector instructions instead of the widest: the same bits.
    #[must_use]
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { instructions, ..self }
    }

    /// Shows `found` every beam that the kernel joins to a ray, with the number of the ray: for each ray
    /// in the order of the beams. Rays that are near each other should be near each other in `rays`.
    pub fn query<K: RayBeamKernel>(
        &self,
        kernel: K,
        rays: &[(MediumId, CameraRay<C>)],
        found: impl FnMut(usize, &Beam<C>, &K::Meeting),
    ) -> Pairs {
        let lines: Vec<_> = rays.iter().map(|(_, ray)| self.frame.line(ray)).collect();
        self.instructions.dispatch(Query {
            map: self,
            kernel,
            rays,
            lines: &lines,
            found,
            near: std::array::from_fn(|_| Vec::new()),
            close: Vec::with_capacity(BLOCK),
            pairs: Pairs::default(),
        })
    }
}

/// A query on its way.
struct Query<'q, 'a, const C: usize, K, F> {
    map: &'q BeamMap<'a, C>,
    kernel: K,
    rays: &'q [(MediumId, CameraRay<C>)],
    lines: &'q [Option<Line>],
    found: F,
    /// Beams near the bundle of each size that is under way.
    near: [Vec<BeamBlock>; BUNDLES.len()],
    /// Beams that come close to some ray of a block, and to which.
    close: Vec<(Beam<C>, Numbers)>,
    pairs: Pairs,
}

impl<const C: usize, K, F> WithSimd for Query<'_, '_, C, K, F>
where
    K: RayBeamKernel,
    F: FnMut(usize, &Beam<C>, &K::Meeting),
{
    type Output = Pairs;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Pairs {
        let [large, middle, small] = BUNDLES;
        let end = self.rays.len();
        for first in (0..end).step_by(large) {
            let large_end = (first + large).min(end);
            if !self.cull(simd, 0, first..large_end) {
                continue;
            }
            for first in (first..large_end).step_by(middle) {
                let middle_end = (first + middle).min(large_end);
                if !self.cull(simd, 1, first..middle_end) {
                    continue;
                }
                for first in (first..middle_end).step_by(small) {
                    let small_end = (first + small).min(middle_end);
                    if self.cull(simd, 2, first..small_end) {
                        self.meet(simd, first..small_end);
                    }
                }
            }
        }
        self.pairs
    }
}

impl<const C: usize, K, F> Query<'_, '_, C, K, F>
where
    K: RayBeamKernel,
    F: FnMut(usize, &Beam<C>, &K::Meeting),
{
    /// Finds the beams near a bundle among those near the bundle that it is in; whether there are any.
    #[inline(always)]
    fn cull<S: Simd>(&mut self, simd: S, size: usize, rays: Range<usize>) -> bool {
        let (larger, smaller) = self.near.split_at_mut(size);
        let from = larger.last().map_or(&self.map.blocks, |near| near);
        let near = &mut smaller[0];
        near.clear();
        let Some(bundle) = Bundle::around(self.lines[rays].iter().flatten().copied()) else {
            return false;
        };
        let mut count = 0;
        for block in from {
            let is_near = block.near(simd, &bundle, self.map.radius);
            for (lane, is_near) in is_near.into_iter().enumerate() {
                if is_near != 0.0 {
                    block.push(lane, near, count);
                    count += 1;
                }
            }
        }
        count > 0
    }

    /// The rays of a smallest bundle against the beams near it.
    #[inline(always)]
    fn meet<S: Simd>(&mut self, simd: S, rays: Range<usize>) {
        let block = RayBlock::new(&self.lines[rays.clone()]);
        for beams in &self.near[BUNDLES.len() - 1] {
            self.close.clear();
            for (lane, &index) in beams.index.iter().enumerate() {
                let near = block.near(simd, beams, lane, self.map.radius);
                // Copied before any is evaluated: memory is slow, but many answers come together.
                if near.iter().sum::<f32>() > 0.0 && index != BeamBlock::NONE {
                    self.close.push((self.map.beams[index as usize], near));
                }
            }
            for (beam, near) in &self.close {
                for (number, &is_near) in rays.clone().zip(near) {
                    let (medium, ray) = &self.rays[number];
                    if is_near == 0.0 || *medium != beam.medium {
                        continue;
                    }
                    self.pairs.tested += 1;
                    let meeting = self.kernel.meet(
                        beam.origin,
                        beam.direction,
                        beam.length,
                        ray.origin,
                        ray.direction,
                        ray.length,
                    );
                    if let Some(meeting) = meeting {
                        self.pairs.accepted += 1;
                        (self.found)(number, beam, &meeting);
                    }
                }
            }
        }
    }
}
