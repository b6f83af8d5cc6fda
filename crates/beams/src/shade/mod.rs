//! Kernels evaluated for several rays from the eye at once.
//!
//! With p the beam's origin relative to the eye, d its direction, M = p × d, p⊥ = p − (p·d) d, and a
//! ray's direction e of any length,
//!
//! ```text
//! |d × e|,    M·e,    d·e,    p⊥·e
//! ```
//!
//! say all that a kernel asks of a pair: the closest points lie (p⊥·e)/|d × e|² times e along the ray,
//! and the distance of the lines is |M·e|/|d × e|. All but the norm are linear in e, which is linear
//! in column and row.

mod kernel1d;
mod kernel2d;

use tpb_film::Tile;
use tpb_lanes::{F64s, LANES, Simd, Vectors};
use tpb_optics::Phase;
use tpb_optics::phase::ISOTROPIC;

use crate::Temporal;
use crate::beam::Attenuation;
use crate::kernel::RayBeamKernel;
use crate::scan::{Form, Knot};
use crate::splat::{Drawn, TileMedium, TileRays};

pub(crate) use kernel1d::Shade1d;
pub(crate) use kernel2d::Shade2d;

/// A kernel for several rays at once.
pub(crate) trait Shade<const C: usize>: Copy {
    /// Adds what `beam` sends to the rays of one [`Loaded`]; returns 1 for each pair that was accepted,
    /// lane by lane. `PEAKED`: the medium is not isotropic. `PLAIN`: nothing lies before the rays'
    /// spans.
    fn add<S: Simd, const PEAKED: bool, const PLAIN: bool>(
        self,
        simd: S,
        beam: &Shared<C>,
        loaded: &Loaded<C>,
        tile: &mut Tile<'_, C>,
    ) -> F64s<S>;
}

/// Adds what a beam sends to the rays at `knots`; returns how many pairs were accepted. Rays that
/// [`TileRays::straight`] does not hold, and beams whose attenuation has no closed form, are
/// evaluated one by one by `kernel`.
#[inline(always)]
pub(crate) fn shade<S: Simd, K: RayBeamKernel, H: Shade<C>, const C: usize>(
    simd: S,
    (kernel, shade): (K, H),
    drawn: &Drawn<'_, C>,
    rays: &TileRays<'_, C>,
    knots: &[Knot],
    tile: &mut Tile<'_, C>,
) -> u64 {
    let explicit = drawn.beam.attenuation == Attenuation::Explicit;
    let places = knots.iter().map(|&knot| rays.lattice.place(knot));
    if C > 1 && !explicit {
        return drawn.one_by_one(kernel, rays, places, tile);
    }
    let mut accepted = 0;
    if rays.any_odd {
        let odd = places.filter(|&place| rays.is_odd(place));
        accepted += drawn.one_by_one(kernel, rays, odd, tile);
    }
    let Some(medium) = rays.medium.filter(|medium| medium.id == drawn.beam.medium) else {
        return accepted;
    };
    let beam = Shared::new(drawn, rays, &medium, explicit);
    let peaked = medium.phase != Phase::Isotropic;
    accepted
        + match (peaked, rays.before.is_empty()) {
            (false, true) => beam.all::<S, H, false, true>(simd, shade, rays, knots, tile),
            (false, false) => beam.all::<S, H, false, false>(simd, shade, rays, knots, tile),
            (true, true) => beam.all::<S, H, true, true>(simd, shade, rays, knots, tile),
            (true, false) => beam.all::<S, H, true, false>(simd, shade, rays, knots, tile),
        }
}

/// What all pairs of one beam share.
pub(crate) struct Shared<const C: usize> {
    /// Of the tile.
    columns: f64,
    /// d × e.
    normal: [Form; 3],
    /// d·e.
    cosine: Form,
    /// M·e.
    moment: Form,
    /// M.
    line: [f64; 3],
    /// |M|.
    distance: f64,
    /// p·d.
    along: f64,
    length: f64,
    opl: f64,
    eta: f64,
    /// The phase function is (1 − g²)/(4π)/(near + slope·h)^(3/2), h = (1 ∓ cosθ)/2.
    sign: f64,
    near: f64,
    slope: f64,
    /// Share of power, sigma_s and phase function that no ray changes.
    power: [f64; C],
    sigma_t: [f64; C],
    /// 1 if the beam's transmittance is explicit, else 0.
    explicit: f64,
    /// Whether arrival is exact in time.
    exact: bool,
}

/// [`LANES`] rays of a tile.
pub(crate) struct Loaded<const C: usize> {
    column: [f64; LANES],
    row: [f64; LANES],
    norm: [f64; LANES],
    start: [f64; LANES],
    end: [f64; LANES],
    unwarp_opl: [f64; LANES],
    opl_before: [f64; LANES],
    depth_before: [[f64; LANES]; C],
}

/// Several pairs, in units in which a ray's direction is e.
struct Pairs<S: Simd> {
    /// Places in the tile.
    places: F64s<S>,
    /// |d × e|².
    squared: F64s<S>,
    /// M·e.
    across: F64s<S>,
    /// d·e.
    cosine: F64s<S>,
    /// p⊥·e.
    foot: F64s<S>,
    /// |e|.
    norm: F64s<S>,
    /// The ray's span \[m\].
    start: F64s<S>,
    end: F64s<S>,
}

impl<const C: usize> Loaded<C> {
    /// At most [`LANES`] rays; the others end before they begin.
    #[inline(always)]
    fn new<const PLAIN: bool>(rays: &TileRays<'_, C>, given: &[Knot], unwarps: bool) -> Self {
        // A copy of a length that is not known would be a call.
        let mut knots = [given[0]; LANES];
        for (lane, knot) in knots.iter_mut().enumerate() {
            *knot = given[lane.min(given.len() - 1)];
        }
        let mut loaded = Self {
            column: [0.0; LANES],
            row: [0.0; LANES],
            norm: [0.0; LANES],
            start: [0.0; LANES],
            end: [0.0; LANES],
            unwarp_opl: [0.0; LANES],
            opl_before: [0.0; LANES],
            depth_before: [[0.0; LANES]; C],
        };
        for (lane, &knot) in knots.iter().enumerate() {
            loaded.column[lane] = f64::from(knot.column());
            loaded.row[lane] = f64::from(knot.row());
        }
        for (lane, &knot) in knots.iter().enumerate() {
            let place = rays.lattice.place(knot) as usize;
            let ray = &rays.straight[place];
            loaded.norm[lane] = ray.norm;
            loaded.start[lane] = ray.start;
            loaded.end[lane] = if lane < given.len() { ray.end } else { -1.0 };
            if !PLAIN {
                let before = &rays.before[place];
                loaded.opl_before[lane] = before.opl;
                for (loaded, depth) in loaded.depth_before.iter_mut().zip(before.depth) {
                    loaded[lane] = depth;
                }
            }
        }
        if unwarps {
            for (lane, &knot) in knots.iter().enumerate() {
                let place = rays.lattice.place(knot) as usize;
                loaded.unwarp_opl[lane] = rays.straight[place].unwarp_opl;
            }
        }
        loaded
    }
}

impl<const C: usize> Shared<C> {
    #[inline(always)]
    fn new(
        drawn: &Drawn<'_, C>,
        rays: &TileRays<'_, C>,
        medium: &TileMedium<C>,
        explicit: bool,
    ) -> Self {
        let (beam, p, lattice) = (drawn.beam, drawn.from_eye, &rays.lattice);
        let coefficients = &medium.coefficients;
        let g = match medium.phase {
            Phase::Isotropic => 0.0,
            Phase::HenyeyGreenstein { g } => g,
        };
        let a = g.abs();
        let along = p.dot(beam.direction);
        let line = p.cross(beam.direction);
        let scale = drawn.share * ISOTROPIC * (1.0 - a * a);
        let mut power = [0.0; C];
        for (c, power) in power.iter_mut().enumerate() {
            *power = beam.power[c] * coefficients.sigma_s[c] * scale;
        }
        Self {
            columns: lattice.columns as f64,
            normal: lattice.cross(beam.direction),
            cosine: drawn.cosine,
            moment: drawn.moment,
            line: line.to_array(),
            distance: line.length(),
            along,
            length: beam.length,
            opl: beam.opl,
            eta: rays.eta,
            sign: g.signum(),
            near: (1.0 - a) * (1.0 - a),
            slope: 4.0 * a,
            power,
            sigma_t: coefficients.sigma_t.0,
            explicit: f64::from(u8::from(explicit)),
            exact: drawn.temporal == Temporal::Exact,
        }
    }

    #[inline(always)]
    fn all<S: Simd, H: Shade<C>, const PEAKED: bool, const PLAIN: bool>(
        &self,
        simd: S,
        shade: H,
        rays: &TileRays<'_, C>,
        knots: &[Knot],
        tile: &mut Tile<'_, C>,
    ) -> u64 {
        let mut accepted = F64s::splat(simd, 0.0);
        for given in knots.chunks(LANES) {
            let loaded = Loaded::new::<PLAIN>(rays, given, tile.unwarps());
            accepted = accepted + shade.add::<S, PEAKED, PLAIN>(simd, self, &loaded, tile);
        }
        accepted.sum() as u64
    }

    /// Vector number `index` of the pairs with some rays.
    #[inline(always)]
    fn pairs<S: Simd>(&self, simd: S, loaded: &Loaded<C>, index: usize) -> Pairs<S> {
        let (i, j) = (loaded.column.vector(simd, index), loaded.row.vector(simd, index));
        let [nx, ny, nz] = self.normal;
        let (nx, ny, nz) = (nx.over(i, j), ny.over(i, j), nz.over(i, j));
        let [mx, my, mz] = self.line;
        Pairs {
            places: j * self.columns + i,
            squared: nx * nx + ny * ny + nz * nz,
            across: self.moment.over(i, j),
            cosine: self.cosine.over(i, j),
            // p⊥·e = (d × M)·e: from p⊥ itself it would cancel where pair and view are nearly parallel.
            foot: -(nx * mx + ny * my + nz * mz),
            norm: loaded.norm.vector(simd, index),
            start: loaded.start.vector(simd, index),
            end: loaded.end.vector(simd, index),
        }
    }

    /// The phase function over what [`Shared::power`] holds of it, for cosψ = d·ω.
    #[inline(always)]
    fn phase<S: Simd>(&self, simd: S, cosine: F64s<S>) -> F64s<S> {
        let half_versine = (cosine * self.sign + 1.0) * 0.5;
        let base = half_versine.max(F64s::splat(simd, 0.0)) * self.slope + self.near;
        F64s::splat(simd, 1.0) / (base * base.sqrt())
    }
}
