//! What a render is, as data, and the film that it needs.
//!
//! The scene knows no film and the film no scene; here they meet. The scene says size, bins and
//! pixel format, the plan how many channels are transported, the options what else is wanted:
//!
//! | transported | pixel format | film |
//! | --- | --- | --- |
//! | 1 | luminance | as transported |
//! | 1 | rgb | one channel, repeated when arrays are made |
//! | 3 | luminance | combined to luminance in each pass, before the statistics |
//! | 3 | rgb | as transported |
//!
//! A pulse of some duration mixes bins. For its support, guard bins are kept at both ends of the
//! window and dropped once the pulse is applied, so that no bin of the result lacks energy that
//! arrived outside.

use serde::{Deserialize, Serialize};
use tpb_film::{
    Arrays, FilmError, FilmOptions, Layout, OutputChannels, PictureOptions, Pulse, PulseReport,
    Quantity, TimeAxis, TransientFilm,
};
use tpb_scene::{FilmSpec, PixelFormat, Transport};

use crate::{RenderError, RunSettings, memory};

/// Pulses that reach further than this many bins are refused.
const MAX_GUARD_BINS: usize = 1 << 18;

/// What the delta pulse does.
const EXACT: PulseReport =
    PulseReport { guard_bins_start: 0, guard_bins_end: 0, relative_error_bound: 0.0 };

/// All that a render depends on beside scene and method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderOptions {
    /// Seed, budget (10 s by default) and first pass.
    pub run: RunSettings,
    /// Threads; by default as many as the machine has. Arrays do not depend on it.
    pub threads: Option<usize>,
    /// Also write the variance of each cell's mean over passes; only for the delta pulse.
    pub variance: bool,
    /// Subtract from arrival times the OPL from the eye to the first surface that is not null.
    pub unwarp: bool,
    /// Keep the bins alone: neither what arrives outside the window nor the steady image. Unless times
    /// are unwarped, methods then leave out what can only arrive outside.
    pub window_only: bool,
    /// The shape of the emitters' pulse; by default a delta.
    pub pulse: Pulse,
    /// How pictures are made; `None` makes none.
    pub pictures: Option<PictureOptions>,
}

/// The film of a render.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmSetup {
    layout: Layout,
    options: FilmOptions,
    pulse: Pulse,
    /// Guard bins before and after the window.
    guards: (usize, usize),
    /// Bins of the window.
    bins: usize,
}

impl FilmSetup {
    /// The film that a scene's spec, the transported channels and the options ask for.
    ///
    /// # Errors
    /// [`RenderError::Film`] for impossible layouts and pulses, and for a window alone where there is
    /// none or where its light depends on what came before.
    pub fn new(
        spec: &FilmSpec,
        transport: Transport,
        options: &RenderOptions,
    ) -> Result<Self, RenderError> {
        let RenderOptions { variance, unwarp, window_only, pulse, .. } = *options;
        if window_only && spec.time.is_none() {
            return Err(unsuitable("a film without a time axis has no window"));
        }
        if window_only && pulse == Pulse::Continuous {
            return Err(unsuitable(
                "continuous emission needs what arrived before the window, which is not kept",
            ));
        }
        let output = match (transport, spec.pixel_format) {
            (Transport::Mono, PixelFormat::Rgb) => OutputChannels::Rgb,
            (Transport::Rgb, PixelFormat::Luminance) => OutputChannels::Luminance,
            _ => OutputChannels::AsTransported,
        };
        let axis = spec.time.map(|time| TimeAxis {
            start_opl: time.start_opl,
            bin_width_opl: time.bin_width_opl,
            bins: time.bins,
        });
        // The window itself is checked before bins are added to it.
        let window = Layout::new(spec.width, spec.height, axis)?;
        let guards = guard_bins(pulse, axis)?;
        let time = axis.map(|axis| TimeAxis {
            start_opl: axis.start_opl - guards.0 as f64 * axis.bin_width_opl,
            bins: axis.bins.saturating_add(guards.0).saturating_add(guards.1),
            ..axis
        });
        Ok(Self {
            layout: Layout::new(spec.width, spec.height, time)?,
            options: FilmOptions { variance, output, unwarp, window_only },
            pulse,
            guards,
            bins: window.bins(),
        })
    }

    /// Size and time axis of the film, guard bins included.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Guard bins before and after the window.
    pub fn guard_bins(&self) -> (usize, usize) {
        self.guards
    }

    /// An empty film.
    ///
    /// # Errors
    /// [`RenderError::Memory`], or [`RenderError::Film`], if it does not fit.
    pub fn film<const C: usize>(&self) -> Result<TransientFilm<C>, RenderError> {
        let (kept, written) = match self.options.output {
            OutputChannels::AsTransported => (C, C),
            OutputChannels::Luminance => (1, 1),
            OutputChannels::Rgb => (C, C.max(3)),
        };
        memory::check(&self.layout, self.options.variance, kept, written)?;
        Ok(TransientFilm::new(self.layout, self.options)?)
    }

    /// The arrays of a film that [`FilmSetup::film`] made: developed, with the pulse applied and
    /// the guard bins dropped.
    ///
    /// # Errors
    /// [`RenderError::Film`], if the pulse cannot be applied.
    pub fn develop<const C: usize>(
        &self,
        film: TransientFilm<C>,
    ) -> Result<(Arrays, PulseReport), RenderError> {
        let mut arrays = film.into_arrays();
        let mut report = EXACT;
        if self.pulse != Pulse::Delta {
            report = arrays.apply_pulse(self.pulse)?;
        }
        if self.guards != (0, 0) {
            arrays.crop_bins(self.guards.0..self.guards.0 + self.bins);
        }
        if self.options.window_only {
            arrays.keep_window();
        }
        Ok((arrays, report))
    }
}

fn unsuitable(reason: &'static str) -> RenderError {
    FilmError::Unsuitable(reason).into()
}

/// How many bins before and after a window a pulse reaches, from the pulse's own report on a row
/// of bins long enough for it.
fn guard_bins(pulse: Pulse, axis: Option<TimeAxis>) -> Result<(usize, usize), RenderError> {
    if pulse == Pulse::Delta {
        return Ok((0, 0));
    }
    let mut bins = axis.map_or(0, |_| 64);
    loop {
        let width = axis.map_or(1.0, |axis| axis.bin_width_opl);
        let mut row = Arrays {
            width: 1,
            height: 1,
            bins,
            channels: 1,
            quantity: Quantity::BinEnergy,
            opl_edges: (0..=bins).map(|edge| edge as f64 * width).collect(),
            transient: vec![0.0; bins],
            variance: None,
            before: vec![0.0],
            after: vec![0.0],
            steady: vec![0.0],
        };
        let report = row.apply_pulse(pulse)?;
        let guards = (report.guard_bins_start, report.guard_bins_end);
        if guards.0.max(guards.1) < bins {
            return Ok(guards);
        }
        if bins >= MAX_GUARD_BINS {
            let reason = format!("it is longer than {MAX_GUARD_BINS} bins of {width} m");
            return Err(FilmError::Pulse(reason).into());
        }
        bins *= 8;
    }
}

#[cfg(test)]
mod tests {
    use tpb_film::Arrival;
    use tpb_optics::{Spectrum, opl::seconds_from_opl};
    use tpb_scene::TimeSpec;

    use super::*;

    fn spec(pixel_format: PixelFormat) -> FilmSpec {
        let time = TimeSpec { start_opl: 1.0, bin_width_opl: 0.5, bins: 10 };
        FilmSpec { width: 4, height: 3, pixel_format, time: Some(time) }
    }

    fn with_pulse(pulse: Pulse) -> RenderOptions {
        RenderOptions { pulse, ..RenderOptions::default() }
    }

    #[test]
    fn channels_follow_scene_and_film() {
        let channels = |transport, format| {
            let setup =
                FilmSetup::new(&spec(format), transport, &RenderOptions::default()).unwrap();
            match transport {
                Transport::Mono => setup.film::<1>().unwrap().output_channels(),
                Transport::Rgb => setup.film::<3>().unwrap().output_channels(),
            }
        };
        assert_eq!(channels(Transport::Mono, PixelFormat::Luminance), 1);
        assert_eq!(channels(Transport::Mono, PixelFormat::Rgb), 3);
        assert_eq!(channels(Transport::Rgb, PixelFormat::Luminance), 1);
        assert_eq!(channels(Transport::Rgb, PixelFormat::Rgb), 3);
    }

    /// Light that arrives just before the window shines into it where the pulse is long.
    #[test]
    fn a_pulse_gathers_what_arrived_outside_the_window() {
        let pulse = Pulse::Box { width_s: seconds_from_opl(1.0) };
        let options = with_pulse(pulse);
        let setup =
            FilmSetup::new(&spec(PixelFormat::Luminance), Transport::Mono, &options).unwrap();
        assert!(setup.guard_bins().0 >= 2, "{:?}", setup.guard_bins());
        let mut film = setup.film::<1>().unwrap();
        film.add_pass(|tile| {
            for pixel in tile.pixels() {
                tile.deposit(pixel, 0.0, &Arrival::Instant(0.75), Spectrum([8.0]));
            }
        });
        let (arrays, report) = setup.develop(film).unwrap();
        assert_eq!((arrays.bins, arrays.opl_edges[0], arrays.opl_edges[10]), (10, 1.0, 6.0));
        assert!((report.relative_error_bound - 0.5).abs() < 1e-12, "{report:?}");
        // Uniform in [0.5, 1), then spread over 1 m: 3/4 arrive in the window, in two bins.
        let inside: f32 = arrays.pixel(0).iter().sum();
        assert!((inside - 6.0).abs() < 1e-5, "{:?}", arrays.pixel(0));
        assert!((arrays.before[0] - 2.0).abs() < 1e-5);
    }

    #[test]
    fn impossible_films_and_pulses_are_errors() {
        let new =
            |spec: &FilmSpec, pulse| FilmSetup::new(spec, Transport::Mono, &with_pulse(pulse));
        let steady = FilmSpec { time: None, ..spec(PixelFormat::Rgb) };
        assert!(new(&steady, Pulse::Delta).is_ok());
        let error = new(&steady, Pulse::Continuous);
        assert!(matches!(error, Err(RenderError::Film(FilmError::Unsuitable(_)))), "{error:?}");
        let error = new(&spec(PixelFormat::Rgb), Pulse::Box { width_s: -1.0 });
        assert!(matches!(error, Err(RenderError::Film(FilmError::Pulse(_)))), "{error:?}");
        let empty = FilmSpec { width: 0, ..spec(PixelFormat::Rgb) };
        assert!(new(&empty, Pulse::Delta).is_err());
        for (spec, pulse) in [(steady, Pulse::Delta), (spec(PixelFormat::Rgb), Pulse::Continuous)] {
            let options = RenderOptions { window_only: true, ..with_pulse(pulse) };
            let error = FilmSetup::new(&spec, Transport::Mono, &options);
            assert!(matches!(error, Err(RenderError::Film(FilmError::Unsuitable(_)))), "{error:?}");
        }
        let second = new(&spec(PixelFormat::Rgb), Pulse::gaussian_fwhm(1.0)).unwrap_err();
        assert!(second.to_string().contains("longer than"), "{second}");
    }
}
