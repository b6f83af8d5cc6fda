//! Several deposits at once, in the form that vector units like.

use tpb_lanes::{F64s, LANES, Simd, Vectors, integers, vectors};
use tpb_optics::Spectrum;

use crate::arrival::{Arrival, TemporalProfile};
use crate::layout::Clock;
use crate::tile::{BLOCK, GROUP, Tile};

/// Instants at once.
#[derive(Clone, Copy, Debug)]
pub struct Instants<const C: usize> {
    /// Places of their pixels in [`Tile::pixels`], whole numbers.
    pub places: [f64; LANES],
    /// OPL from the eye to the first surface that is not null \[m\], finite; anything if the film
    /// does not [unwarp](Tile::unwarps).
    pub unwarp_opl: [f64; LANES],
    /// OPL from the emitter to the eye \[m\].
    pub opl: [f64; LANES],
    /// Time-integrated radiance by channel \[W m^-2 sr^-1\].
    pub energy: [[f64; LANES]; C],
}

/// Exponential profiles at once ([`TemporalProfile::Exponential`]).
#[derive(Clone, Copy, Debug)]
pub struct Exponentials<const C: usize> {
    /// Places of their pixels in [`Tile::pixels`], whole numbers.
    pub places: [f64; LANES],
    /// OPL from the eye to the first surface that is not null \[m\], finite; anything if the film
    /// does not [unwarp](Tile::unwarps).
    pub unwarp_opl: [f64; LANES],
    /// First arrival \[m\].
    pub start: [f64; LANES],
    /// Last arrival \[m\], not before the first.
    pub end: [f64; LANES],
    /// Optical depth between them, not negative.
    pub depth: [[f64; LANES]; C],
    /// Time-integrated radiance by channel \[W m^-2 sr^-1\].
    pub energy: [[f64; LANES]; C],
}

impl<const C: usize> Tile<'_, C> {
    /// [`Tile::deposit_at`] of [`LANES`] instants at once, to the same bits. Those without energy add
    /// nothing, but their places and times must be sound.
    ///
    /// # Panics
    /// If a place is not in the tile.
    #[inline(always)]
    pub fn deposit_instants<S: Simd>(&mut self, simd: S, instants: &Instants<C>) {
        let Instants { places, unwarp_opl, opl, energy } = instants;
        let Some(clock) = self.small_clock() else {
            if !self.add_to_steady(simd, places, energy) {
                self.deposit_one_by_one(instants);
            }
            return;
        };
        let (mut cells, mut unsound) = ([0.0; LANES], F64s::splat(simd, 0.0));
        for index in 0..vectors::<S>() {
            let mut opl = opl.vector(simd, index);
            if self.unwarp {
                opl = opl - unwarp_opl.vector(simd, index);
            }
            // 0, or NaN for what is not finite.
            unsound = unsound + opl * 0.0;
            for energy in energy {
                unsound = unsound + energy.vector(simd, index) * 0.0;
            }
            let place = places.vector(simd, index);
            let cell = place * self.cells_per_pixel as f64 + clock.cells_of(simd, opl);
            cell.store(&mut cells, index);
        }
        if unsound.sum().is_nan() {
            return self.deposit_one_by_one(instants);
        }
        self.add(&integers(&cells), energy);
    }

    #[cold]
    fn deposit_one_by_one(&mut self, instants: &Instants<C>) {
        let Instants { places, unwarp_opl, opl, energy } = instants;
        for lane in 0..LANES {
            let energy = Spectrum(std::array::from_fn(|channel| energy[channel][lane]));
            let arrival = Arrival::Instant(opl[lane]);
            self.deposit_at(places[lane] as usize, unwarp_opl[lane], &arrival, energy);
        }
    }

    /// [`Tile::deposit_at`] of [`LANES`] exponential profiles at once, to rounding. Those without
    /// energy add nothing, but their places and times must be sound.
    ///
    /// # Panics
    /// If a place is not in the tile.
    #[inline(always)]
    pub fn deposit_exponentials<S: Simd>(&mut self, simd: S, given: &Exponentials<C>) {
        let Some(clock) = self.small_clock() else {
            if !self.add_to_steady(simd, &given.places, &given.energy) {
                self.profiles_one_by_one(given, [true; LANES]);
            }
            return;
        };
        let (mut first, mut beyond) = ([0.0; LANES], [0.0; LANES]);
        // What goes to the first cell, and what to the next.
        let (mut here, mut next) = ([[0.0; LANES]; C], [[0.0; LANES]; C]);
        let (mut unsound, mut most) = (F64s::splat(simd, 0.0), F64s::splat(simd, 0.0));
        for index in 0..vectors::<S>() {
            let (mut start, mut end) =
                (given.start.vector(simd, index), given.end.vector(simd, index));
            if self.unwarp {
                let shift = given.unwarp_opl.vector(simd, index);
                (start, end) = (start - shift, end - shift);
            }
            let (cell, last) = (clock.cells_of(simd, start), clock.cells_of(simd, end));
            let crossed = last - cell;
            // 0, or NaN for what is not finite.
            unsound = unsound + start * 0.0 + end * 0.0;
            most = most.max(crossed);
            let split = F64s::splat(simd, 0.0).less(crossed);
            let edge = cell * clock.bin_width() + clock.start();
            let part = split.of((edge - start) / (end - start));
            for c in 0..C {
                let energy = given.energy[c].vector(simd, index);
                let depth = given.depth[c].vector(simd, index);
                unsound = unsound + energy * 0.0 + depth * 0.0;
                let share = part * (part * depth).mean_decay() / depth.mean_decay();
                // Rounding must leave nothing negative for the next cell.
                let share = share.min(F64s::splat(simd, 1.0));
                let before = split.choose(energy * share, energy);
                before.store(&mut here[c], index);
                (energy - before).store(&mut next[c], index);
            }
            let place = given.places.vector(simd, index) * self.cells_per_pixel as f64;
            (place + cell).store(&mut first, index);
            crossed.store(&mut beyond, index);
        }
        if unsound.sum().is_nan() {
            return self.profiles_one_by_one(given, [true; LANES]);
        }
        let most = most.largest();
        if most > 1.0 {
            let mut many = [false; LANES];
            for lane in 0..LANES {
                many[lane] = beyond[lane] > 1.0;
                if many[lane] {
                    beyond[lane] = 0.0;
                    for c in 0..C {
                        (here[c][lane], next[c][lane]) = (0.0, 0.0);
                    }
                }
            }
            self.profiles_one_by_one(given, many);
        }
        self.add(&integers(&first), &here);
        if most > 0.0 {
            for lane in 0..LANES {
                first[lane] += beyond[lane];
            }
            self.add(&integers(&first), &next);
        }
    }

    /// Adds energies to pixels, where the film keeps no times and all energies are finite; whether it did.
    #[inline(always)]
    fn add_to_steady<S: Simd>(
        &mut self,
        simd: S,
        places: &[f64; LANES],
        energy: &[[f64; LANES]; C],
    ) -> bool {
        let mut unsound = F64s::splat(simd, 0.0);
        for index in 0..vectors::<S>() {
            for energy in energy {
                unsound = unsound + energy.vector(simd, index) * 0.0;
            }
        }
        let sound = !unsound.sum().is_nan();
        let fits = self.clock.is_none() && u32::try_from(self.cells.len()).is_ok() && sound;
        if fits {
            self.add(&integers(places), energy);
        }
        fits
    }

    /// Adds energies to cells.
    #[inline(always)]
    fn add(&mut self, cells: &[u32; LANES], energy: &[[f64; LANES]; C]) {
        if self.marking {
            for cell in cells {
                self.marks[*cell as usize / BLOCK] = 1;
                self.groups[*cell as usize / GROUP] = 1;
            }
        }
        for lane in 0..LANES {
            let cell = &mut self.cells[cells[lane] as usize];
            for channel in 0..C {
                cell[channel] += energy[channel][lane];
            }
        }
    }

    /// The clock, if its cells can be numbered by [`integers`].
    #[inline(always)]
    fn small_clock(&self) -> Option<Clock> {
        self.clock.filter(|_| u32::try_from(self.cells.len()).is_ok())
    }

    #[cold]
    fn profiles_one_by_one(&mut self, given: &Exponentials<C>, which: [bool; LANES]) {
        let Exponentials { places, unwarp_opl, start, end, depth, energy } = given;
        for lane in (0..LANES).filter(|&lane| which[lane]) {
            let of = |values: &[[f64; LANES]; C]| {
                Spectrum(std::array::from_fn(|channel| values[channel][lane]))
            };
            let profile = TemporalProfile::Exponential {
                start: start[lane],
                end: end[lane],
                depth: of(depth),
            };
            let arrival = Arrival::Profile(profile);
            self.deposit_at(places[lane] as usize, unwarp_opl[lane], &arrival, of(energy));
        }
    }
}
