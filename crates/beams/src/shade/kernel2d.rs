//! The 2D kernel of [`crate::kernel2d`]: from the part of a ray inside the beam's cylinder.
//!
//! In units of e the ray is inside between the roots of A t² − 2 (p⊥·e) t + C < 0, with A = |d × e|²
//! and C = (|M| − R)(|M| + R); the discriminant is (R|d × e| − M·e)(R|d × e| + M·e). κ = 1 + cosψ is
//! sin²ψ/(1 − cosψ) where cosψ < 0: nothing cancels.

use tpb_film::{Exponentials, Tile};
use tpb_lanes::{F64s, LANES, Simd, Vectors, vectors};

use super::{Loaded, Pairs, Shade, Shared};

/// The kernel with its radius \[m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shade2d {
    pub(crate) radius: f64,
}

impl<const C: usize> Shade<C> for Shade2d {
    #[inline(always)]
    fn add<S: Simd, const PEAKED: bool, const PLAIN: bool>(
        self,
        simd: S,
        beam: &Shared<C>,
        loaded: &Loaded<C>,
        tile: &mut Tile<'_, C>,
    ) -> F64s<S> {
        let mut arrivals = Exponentials {
            places: [0.0; LANES],
            unwarp_opl: loaded.unwarp_opl,
            start: [0.0; LANES],
            end: [0.0; LANES],
            depth: [[0.0; LANES]; C],
            energy: [[0.0; LANES]; C],
        };
        let (zero, one) = (F64s::splat(simd, 0.0), F64s::splat(simd, 1.0));
        let area = std::f64::consts::PI * self.radius * self.radius;
        let mut accepted = zero;
        for index in 0..vectors::<S>() {
            let pairs = beam.pairs(simd, loaded, index);
            let per_norm = one / pairs.norm;
            let cosine = pairs.cosine * per_norm;
            let sine2 = pairs.squared * (per_norm * per_norm);
            let kappa = cosine.less(zero).choose(sine2 / (one - cosine), cosine + 1.0);
            let (first, last) = self.inside(simd, beam, &pairs, cosine);
            let length = last - first;
            let wanted = zero.less(length);
            // What is not wanted adds nothing to the first pixel, whose cells are at hand.
            wanted.of(pairs.places).store(&mut arrivals.places, index);
            let path_length = kappa * first - beam.along;
            let mut start = path_length * beam.eta + beam.opl;
            if !PLAIN {
                start = start + loaded.opl_before.vector(simd, index);
            }
            let end = start + kappa * length * beam.eta;
            wanted.of(start).store(&mut arrivals.start, index);
            wanted.of(end).store(&mut arrivals.end, index);
            let mut density = length * (1.0 / area);
            if PEAKED {
                density = density * beam.phase(simd, cosine);
            }
            // The foot moves by cosψ per metre of the ray.
            let foot = first * cosine - beam.along;
            let inside = first - pairs.start + foot * beam.explicit;
            let growth = if beam.explicit == 0.0 { one } else { kappa };
            for c in 0..C {
                let mut before = inside * beam.sigma_t[c];
                if !PLAIN {
                    before = before + loaded.depth_before[c].vector(simd, index);
                }
                let depth = growth * length * beam.sigma_t[c];
                let energy = (-before).exp() * depth.mean_decay() * beam.power[c] * density;
                let depth = if beam.exact { depth } else { zero };
                wanted.of(depth).store(&mut arrivals.depth[c], index);
                wanted.of(energy).store(&mut arrivals.energy[c], index);
            }
            accepted = accepted + wanted.of(one);
        }
        tile.deposit_exponentials(simd, &arrivals);
        accepted
    }
}

impl Shade2d {
    /// Where rays are inside the cylinder and their spans \[m\]: first and last distance; not in
    /// this order, or NaN, if nowhere.
    #[inline(always)]
    fn inside<S: Simd, const C: usize>(
        self,
        simd: S,
        beam: &Shared<C>,
        pairs: &Pairs<S>,
        cosine: F64s<S>,
    ) -> (F64s<S>, F64s<S>) {
        let zero = F64s::splat(simd, 0.0);
        let reach = pairs.squared.sqrt() * self.radius;
        let discriminant = (reach - pairs.across) * (reach + pairs.across);
        let c = (beam.distance - self.radius) * (beam.distance + self.radius);
        // The root farther from 0, by which the product of both is divided.
        let root = discriminant.max(zero).sqrt();
        let q = pairs.foot + pairs.foot.less(zero).choose(-root, root);
        let (far, near) = (q / pairs.squared, F64s::splat(simd, c) / q);
        let (near, far) = (near.min(far) * pairs.norm, near.max(far) * pairs.norm);
        // Exactly parallel: inside all along, or nowhere.
        let parallel = pairs.squared.at_most(zero);
        let near = parallel.choose(F64s::splat(simd, -f64::MAX), near);
        let far = parallel.choose(F64s::splat(simd, f64::MAX), far);
        let within = F64s::splat(simd, f64::from(u8::from(c < 0.0)));
        let discriminant = parallel.choose(within, discriminant);
        // Feet in [0, length); a foot that does not move is taken to move by next to nothing.
        let least = F64s::splat(simd, f64::MIN_POSITIVE);
        let cosine = cosine.less(least).and((-cosine).less(least)).choose(least, cosine);
        let at_start = F64s::splat(simd, beam.along) / cosine;
        let at_end = F64s::splat(simd, beam.along + beam.length) / cosine;
        let (low, high) = (at_start.min(at_end), at_start.max(at_end));
        let first = near.max(pairs.start).max(low);
        let last = far.min(pairs.end).min(high);
        (first, zero.less(discriminant).choose(last, first))
    }
}
