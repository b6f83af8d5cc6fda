//! The film through its public door: passes, pulses, files, pictures.

mod files;
mod passes;
mod pictures;
mod pulses;
mod several;

use tpb_film::{
    Arrays, Arrival, FilmOptions, Layout, TemporalProfile, Tile, TimeAxis, TransientFilm,
};
use tpb_optics::{Spectrum, Stream};

/// An axis of 30 bins of 0.2 m from 1 m.
const AXIS: Option<TimeAxis> = Some(TimeAxis { start_opl: 1.0, bin_width_opl: 0.2, bins: 30 });

/// Random deposits of all kinds, partly outside the window; returns the energy of the tile.
fn render<const C: usize>(tile: &mut Tile<'_, C>, pass: u64) -> Spectrum<C> {
    let mut sum = Spectrum::ZERO;
    for pixel in tile.pixels() {
        let mut rng = Stream::new(11, pass, pixel as u64);
        for _ in 0..=rng.index(8) {
            let start = 8.0 * rng.uniform();
            let end = start + 3.0 * rng.uniform();
            let depth = Spectrum(std::array::from_fn(|_| 6.0 * rng.uniform() - 3.0));
            let density = |t: f64| Spectrum::splat(((t - start) * (end - t)).sqrt());
            let arrival = match rng.index(5) {
                0 => Arrival::Instant(start),
                1 => Arrival::Profile(TemporalProfile::Uniform { start, end }),
                2 => Arrival::Profile(TemporalProfile::Exponential { start, end, depth }),
                3 => {
                    let rate = Spectrum::splat(1.0);
                    Arrival::Profile(TemporalProfile::ExponentialTail { start, rate })
                }
                _ => Arrival::Profile(TemporalProfile::General {
                    start,
                    end,
                    breaks: &[],
                    density: &density,
                }),
            };
            let energy = Spectrum(std::array::from_fn(|_| rng.uniform()));
            tile.deposit(pixel, 0.5 * rng.uniform(), &arrival, energy);
            sum += energy;
        }
    }
    sum
}

/// A film after some passes of [`render`].
fn rendered<const C: usize>(layout: Layout, options: FilmOptions, passes: u64) -> TransientFilm<C> {
    let mut film = TransientFilm::new(layout, options).unwrap();
    for pass in 0..passes {
        film.add_pass(|tile| render(tile, pass));
    }
    film
}

/// A small cube with variance.
fn small_cube() -> Arrays {
    let layout = Layout::new(9, 7, AXIS).unwrap();
    let options = FilmOptions { variance: true, ..FilmOptions::default() };
    rendered::<3>(layout, options, 3).develop()
}

/// Largest difference, relative to the largest value.
fn worst(a: impl IntoIterator<Item = f64>, b: impl IntoIterator<Item = f64>) -> f64 {
    let (mut error, mut scale) = (0.0_f64, 0.0_f64);
    for (a, b) in a.into_iter().zip(b) {
        error = error.max((a - b).abs());
        scale = scale.max(b.abs());
    }
    error / scale
}
