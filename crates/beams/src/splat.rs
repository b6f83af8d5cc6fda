//! The gather of the rays that come straight from the eye: each beam is drawn over a tile.
//!
//! All these rays of one sample form a lattice on the film, so that the rays that pass a beam within
//! its radius need not be searched: [`crate::scan`] solves for them, row by row, and the kernel
//! evaluates them, several at a time where it can. Nearly every ray that is evaluated is accepted;
//! a tile's bins stay in the cache.
//!
//! Rays that mirrors, glass or rough surfaces have turned form no lattice: they need
//! [`crate::beam_map`].

use glam::DVec3;
use tpb_film::Tile;
use tpb_lanes::{Instructions, Simd, WithSimd};
use tpb_optics::{Coefficients, Phase};
use tpb_scene::{Flight, MediumId, Scene};

use crate::Temporal;
use crate::beam::{Beam, CameraRay};
use crate::beam_map::Pairs;
use crate::kernel::RayBeamKernel;
use crate::scan::{Form, Knot, Lattice, Line};
use crate::sight::Sights;

/// A tile's rays from the eye through its pixels, one each, and the scattering media that they cross.
pub struct TileRays<'a, const C: usize> {
    scene: &'a Scene,
    pub(crate) lattice: Lattice,
    /// Row by row.
    pub(crate) straight: Vec<Straight>,
    /// What lies before the spans of `straight`; empty if nothing does.
    pub(crate) before: Vec<Before<C>>,
    /// The medium of `straight`, if any ray has one.
    pub(crate) medium: Option<TileMedium<C>>,
    /// η along all of `straight`.
    pub(crate) eta: f64,
    /// Spans by place, and where each place's begin.
    spans: Vec<(MediumId, CameraRay<C>)>,
    starts: Vec<u32>,
    /// Places whose spans `straight` does not hold.
    odd: Vec<bool>,
    /// Whether there are any.
    pub(crate) any_odd: bool,
}

/// The medium of a tile's rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileMedium<const C: usize> {
    pub(crate) id: MediumId,
    pub(crate) coefficients: Coefficients<C>,
    pub(crate) phase: Phase,
}

/// A ray that crosses one span of the tile's medium, distances from the eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straight {
    /// |e|.
    pub(crate) norm: f64,
    /// Where the span starts and ends \[m\]; the end is negative if there is none.
    pub(crate) start: f64,
    pub(crate) end: f64,
    /// OPL from the eye to the first surface that is not null \[m\].
    pub(crate) unwarp_opl: f64,
}

/// What light meets between the eye and a span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Before<const C: usize> {
    /// What OPL differs by from η times distance \[m\].
    pub(crate) opl: f64,
    /// Optical depth.
    pub(crate) depth: [f64; C],
}

impl<'a, const C: usize> TileRays<'a, C> {
    /// Of flights from the eye through a lattice, row by row.
    pub fn new(scene: &'a Scene, lattice: Lattice, flights: &[Flight]) -> Self {
        let mut rays = Self {
            scene,
            lattice,
            straight: Vec::with_capacity(flights.len()),
            before: Vec::with_capacity(flights.len()),
            medium: None,
            eta: scene.sensor.region.eta,
            spans: Vec::with_capacity(flights.len()),
            starts: Vec::with_capacity(flights.len() + 1),
            odd: Vec::with_capacity(flights.len()),
            any_odd: false,
        };
        for (flight, e) in flights.iter().zip(lattice.rays()) {
            rays.push(flight, e.length());
        }
        rays.starts.push(rays.spans.len() as u32);
        if rays.before.iter().all(Before::is_nothing) {
            rays.before.clear();
        }
        rays
    }

    fn push(&mut self, flight: &Flight, norm: f64) {
        let first = self.spans.len();
        self.starts.push(first as u32);
        let unwarp_opl = flight.hit.as_ref().map_or(0.0, |hit| flight.opl(hit.distance));
        let mut straight = Straight { norm, start: 0.0, end: -1.0, unwarp_opl };
        let mut before = Before { opl: 0.0, depth: [0.0; C] };
        let all = flight.spans.iter().filter_map(|span| {
            CameraRay::of_span(self.scene, flight, span).map(|(id, ray)| (span, id, ray))
        });
        for (span, id, ray) in all {
            (straight.start, straight.end) = (span.start, span.end);
            before = Before::new(self.scene, flight, span.start, &ray);
            self.spans.push((id, ray));
        }
        let odd = match &self.spans[first..] {
            [] => false,
            [(id, ray)] => {
                let medium =
                    || TileMedium { id: *id, coefficients: ray.coefficients, phase: ray.phase };
                ray.eta != self.eta || self.medium.get_or_insert_with(medium).id != *id
            }
            _ => true,
        };
        if odd {
            straight.end = -1.0;
        }
        self.any_odd |= odd;
        self.odd.push(odd);
        self.straight.push(straight);
        self.before.push(before);
    }

    /// The spans of the ray at a place.
    #[inline]
    fn spans(&self, place: u32) -> &[(MediumId, CameraRay<C>)] {
        let place = place as usize;
        &self.spans[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// Whether a place's spans are not in [`TileRays::straight`].
    #[inline]
    pub(crate) fn is_odd(&self, place: u32) -> bool {
        self.odd[place as usize]
    }
}

impl<const C: usize> Before<C> {
    /// Before the span of `ray` that starts at `start`.
    fn new(scene: &Scene, flight: &Flight, start: f64, ray: &CameraRay<C>) -> Self {
        let opl = ray.opl - ray.eta * start;
        // Of equal indices only their products' rounding is left.
        let opl = if opl.abs() <= 4.0 * f64::EPSILON * ray.opl { 0.0 } else { opl };
        Self { opl, depth: flight.depth(scene, start).0 }
    }

    fn is_nothing(&self) -> bool {
        self.opl == 0.0 && self.depth.iter().all(|&depth| depth == 0.0)
    }
}

/// A beam on its way over a tile.
#[derive(Clone, Copy)]
pub struct Drawn<'a, const C: usize> {
    pub(crate) beam: &'a Beam<C>,
    /// Its origin relative to the eye \[m\].
    pub(crate) from_eye: DVec3,
    /// M·e, with M = `from_eye` × direction.
    pub(crate) moment: Form,
    /// direction·e.
    pub(crate) cosine: Form,
    /// What its contributions are multiplied by.
    pub(crate) share: f64,
    pub(crate) temporal: Temporal,
}

impl<const C: usize> Drawn<'_, C> {
    /// The rays at `places`, one by one; returns how many pairs were accepted.
    #[inline]
    pub(crate) fn one_by_one<K: RayBeamKernel>(
        &self,
        kernel: K,
        rays: &TileRays<'_, C>,
        places: impl Iterator<Item = u32>,
        tile: &mut Tile<'_, C>,
    ) -> u64 {
        let mut accepted = 0;
        for place in places {
            let unwarp_opl = rays.straight[place as usize].unwarp_opl;
            for (_, ray) in rays.spans(place).iter().filter(|span| span.0 == self.beam.medium) {
                if let Some(contribution) = kernel.evaluate(self.beam, ray) {
                    accepted += 1;
                    let target = (&mut *tile, place as usize, unwarp_opl);
                    contribution.deposit(self.temporal, self.share, target);
                }
            }
        }
        accepted
    }
}

/// All beams of a pass, to be drawn over a tile.
pub struct Splat<'a, const C: usize, K> {
    /// The kernel.
    pub kernel: K,
    /// The pass's beams.
    pub beams: &'a [Beam<C>],
    /// What the camera sees of them.
    pub sights: &'a Sights,
    /// The tile's rays.
    pub rays: &'a TileRays<'a, C>,
    /// How contributions are spread in time.
    pub temporal: Temporal,
    /// What they are multiplied by.
    pub share: f64,
    /// The vector instructions that it is done with; bits do not depend on them.
    pub instructions: Instructions,
}

impl<const C: usize, K: RayBeamKernel> Splat<'_, C, K> {
    /// Draws them. `counts` says whether light paths of some depth count.
    pub fn draw(&self, counts: impl Fn(u32) -> bool, tile: &mut Tile<'_, C>) -> Pairs {
        self.instructions.dispatch(Work(self, counts, tile))
    }

    #[inline(always)]
    fn draw_with<S: Simd>(
        &self,
        simd: S,
        counts: impl Fn(u32) -> bool,
        tile: &mut Tile<'_, C>,
    ) -> Pairs {
        let &Self { kernel, beams, sights, rays, temporal, share, .. } = self;
        let lattice = &rays.lattice;
        let radius = kernel.radius() * (1.0 + 1e-9);
        let mut found = vec![Knot::default(); lattice.room()];
        let mut pairs = Pairs::default();
        for (index, sight) in sights.listed(tile.rows().start) {
            if !lattice.sees(sight) {
                continue;
            }
            let beam = &beams[*index as usize];
            if !counts(beam.depth) {
                continue;
            }
            let from_eye = beam.origin - rays.scene.sensor.position;
            let (d, m) = (beam.direction, from_eye.cross(beam.direction));
            let (moment, cosine) = (lattice.form(m), lattice.form(d));
            let line = Line { d, m, moment, cosine, radius };
            let count = lattice.scan(simd, sight, &line, &mut found);
            if count == 0 {
                continue;
            }
            let drawn = Drawn { beam, from_eye, moment, cosine, share, temporal };
            pairs.tested += count as u64;
            pairs.accepted += kernel.draw(simd, &drawn, rays, &found[..count], tile);
        }
        pairs
    }
}

/// For dispatch.
struct Work<'a, 'b, const C: usize, K, F>(&'a Splat<'a, C, K>, F, &'a mut Tile<'b, C>);

impl<const C: usize, K: RayBeamKernel, F: Fn(u32) -> bool> WithSimd for Work<'_, '_, C, K, F> {
    type Output = Pairs;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Pairs {
        self.0.draw_with(simd, self.1, self.2)
    }
}
