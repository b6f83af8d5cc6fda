//! Beams in a hierarchy of boxes, found by camera rays.
//!
//! A long beam in one box is hit by rays far from it, so beams are stored in pieces: not copies
//! of the beam (start time and transmittance belong to its true origin), but an interval of it
//! with a box of its own. A ray may meet several pieces of a beam; the piece that holds the
//! kernel's reporting point ([`RayBeamKernel`]) counts the pair. Pieces are half-open and share
//! their ends, the first reaching to −∞ and the last to +∞ (lengths are the kernel's business), so
//! that exactly one piece holds any point; and since the reporting point lies within the radius
//! of it, its box is met by the ray. Boxes are culled in f32, conservatively; the pair is then
//! evaluated in f64.
//!
//! Pieces are even up to a length at which they would become too many, as in fog without walls,
//! where beams are as long as light can be seen; from there on they grow geometrically.
//!
//! The box of a piece from a to b with unit direction d is that of its ends, grown along axis i by
//! R √(1 − d_i²): the radius acts across the beam only. Where a beam ends, kernels with round ends
//! need a ball around the end as well.

use glam::DVec3;
use tpb_accel::{Aabb, Bvh, Quality};
use tpb_scene::MediumId;

use crate::beam::{Beam, CameraRay};
use crate::kernel::RayBeamKernel;

/// Even pieces per beam at most; then they grow.
const EVEN_PIECES: f64 = 12.0;
/// Growth of a piece over the one before, beyond the even ones.
const GROWTH: f64 = 2.0;

/// A part of a beam, with what the geometric test needs.
#[derive(Clone, Copy, Debug)]
struct Piece {
    origin: DVec3,
    direction: DVec3,
    length: f64,
    beam: u32,
    /// Feet in `start..end` belong to this piece.
    start: f32,
    end: f32,
}

/// The beams of one pass.
pub struct BeamMap<'a, const C: usize> {
    beams: &'a [Beam<C>],
    pieces: Vec<Piece>,
    bvh: Bvh,
}

/// Pairs that a query tested and accepted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairs {
    /// Pieces whose pair was evaluated.
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
    /// For queries with `kernel`, with pieces of about `piece_length` \[m\] (may be infinite).
    pub fn new<K: RayBeamKernel>(kernel: K, beams: &'a [Beam<C>], piece_length: f64) -> Self {
        let radius = kernel.radius();
        let mut pieces = Vec::with_capacity(beams.len());
        let mut boxes = Vec::with_capacity(beams.len());
        for (index, beam) in beams.iter().enumerate() {
            split(beam, index as u32, piece_length, |piece, from, to| {
                let ends = [from, to].map(|s| beam.origin + s * beam.direction);
                let d = beam.direction;
                let across = (DVec3::ONE - d * d).max(DVec3::ZERO).map(f64::sqrt) * radius;
                let Aabb { mut min, mut max } = Aabb::around(ends);
                (min, max) = (min - across, max + across);
                if K::ROUND_ENDS {
                    let is_end = [piece.start == f32::NEG_INFINITY, piece.end == f32::INFINITY];
                    for (end, _) in ends.into_iter().zip(is_end).filter(|(_, is_end)| *is_end) {
                        (min, max) = (min.min(end - radius), max.max(end + radius));
                    }
                }
                pieces.push(piece);
                boxes.push(Aabb { min, max });
            });
        }
        let bvh = Bvh::build(&boxes, Quality::FastBuild);
        Self { beams, pieces, bvh }
    }

    /// Shows `found` every beam of `medium` that the kernel joins to the ray, once.
    #[inline]
    pub fn query<K: RayBeamKernel>(
        &self,
        kernel: K,
        medium: MediumId,
        ray: &CameraRay<C>,
        mut found: impl FnMut(&Beam<C>, &K::Meeting),
    ) -> Pairs {
        let mut pairs = Pairs::default();
        self.bvh.visit(ray.origin, ray.direction, ray.length, |index| {
            let piece = &self.pieces[index];
            pairs.tested += 1;
            let meeting = kernel.meet(
                piece.origin,
                piece.direction,
                piece.length,
                ray.origin,
                ray.direction,
                ray.length,
            )?;
            let foot = K::reporting_point(&meeting);
            if f64::from(piece.start) <= foot && foot < f64::from(piece.end) {
                let beam = &self.beams[piece.beam as usize];
                if beam.medium == medium {
                    pairs.accepted += 1;
                    found(beam, &meeting);
                }
            }
            None
        });
        pairs
    }
}

/// Cuts a beam: `add` gets each piece, and the part of the beam that its box must hold.
fn split<const C: usize>(
    beam: &Beam<C>,
    index: u32,
    piece_length: f64,
    mut add: impl FnMut(Piece, f64, f64),
) {
    let length = beam.length;
    let even = (length / piece_length).ceil().clamp(1.0, EVEN_PIECES);
    let mut step = if even < EVEN_PIECES { length / even } else { piece_length };
    let mut piece = Piece {
        origin: beam.origin,
        direction: beam.direction,
        length,
        beam: index,
        start: f32::NEG_INFINITY,
        end: f32::INFINITY,
    };
    let (mut from, mut count) = (0.0_f64, 1.0);
    loop {
        // Boundaries are f32 for the pieces and for the boxes alike. Not a sliver at the end.
        let to = (from + step) as f32;
        if f64::from(to) + 0.5 * step >= length || f64::from(to) <= from {
            piece.end = f32::INFINITY;
            add(piece, from, length);
            return;
        }
        piece.end = to;
        add(piece, from, f64::from(to));
        (from, piece.start) = (f64::from(to), to);
        count += 1.0;
        if count > EVEN_PIECES {
            step *= GROWTH;
        }
    }
}
