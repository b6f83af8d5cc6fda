//! The 1D kernel of [`crate::kernel1d`]: an instant from the closest points.

use tpb_film::{Instants, Tile};
use tpb_lanes::{F64s, LANES, Simd, Vectors, vectors};

use super::{Loaded, Shade, Shared};

/// The kernel with its radius \[m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shade1d {
    pub(crate) radius: f64,
}

impl<const C: usize> Shade<C> for Shade1d {
    #[inline(always)]
    fn add<S: Simd, const PEAKED: bool, const PLAIN: bool>(
        self,
        simd: S,
        beam: &Shared<C>,
        loaded: &Loaded<C>,
        tile: &mut Tile<'_, C>,
    ) -> F64s<S> {
        let mut instants = Instants {
            places: [0.0; LANES],
            unwarp_opl: loaded.unwarp_opl,
            opl: [0.0; LANES],
            energy: [[0.0; LANES]; C],
        };
        let (zero, one) = (F64s::splat(simd, 0.0), F64s::splat(simd, 1.0));
        let mut accepted = zero;
        for index in 0..vectors::<S>() {
            let pairs = beam.pairs(simd, loaded, index);
            let inverse = one / pairs.squared.sqrt();
            let way = pairs.foot * (inverse * inverse);
            let along_ray = way * pairs.norm;
            let along_beam = way * pairs.cosine - beam.along;
            let wanted = (pairs.across * pairs.across)
                .less(pairs.squared * (self.radius * self.radius))
                .and(pairs.start.at_most(along_ray))
                .and(along_ray.less(pairs.end))
                .and(zero.at_most(along_beam))
                .and(along_beam.less(F64s::splat(simd, beam.length)));
            // What is not wanted adds nothing to the first pixel, whose cells are at hand.
            wanted.of(pairs.places).store(&mut instants.places, index);
            let mut density = pairs.norm * inverse * (0.5 / self.radius);
            if PEAKED {
                density = density * beam.phase(simd, pairs.cosine / pairs.norm);
            }
            let mut opl = (along_beam + along_ray) * beam.eta + beam.opl;
            if !PLAIN {
                opl = opl + loaded.opl_before.vector(simd, index);
            }
            wanted.of(opl).store(&mut instants.opl, index);
            let inside = along_ray - pairs.start + along_beam * beam.explicit;
            for c in 0..C {
                let mut depth = inside * beam.sigma_t[c];
                if !PLAIN {
                    depth = depth + loaded.depth_before[c].vector(simd, index);
                }
                let energy = (-depth).exp() * beam.power[c] * density;
                wanted.of(energy).store(&mut instants.energy[c], index);
            }
            accepted = accepted + wanted.of(one);
        }
        tile.deposit_instants(simd, &instants);
        accepted
    }
}
