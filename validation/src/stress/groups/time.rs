//! The time axis: bins from 1e-6 to 1e6 of the scene's transit time, one or 1e5 of them, and windows
//! far from the light.
//!
//! Bins change nothing but where light is kept: with the same random numbers the steady image is the
//! same, to the rounding of its sum, and what a fine row of bins holds adds up to what one bin over
//! the same window holds.

use tpb_film::Pulse;

use crate::error::Result;
use crate::stress::case::{Case, Finding, Method, Setup, Work};
use crate::stress::laws::{near, refused};
use crate::stress::shot::{Image, Shot};
use crate::stress::world::{Film, Unit};
use crate::stress::worlds::{FILM, everything};

/// OPL at which the first light of the room has arrived, and by which most of it has.
const LIT: (f64, f64) = (4.0, 14.0);

fn image(setup: &Setup, method: Method, (start, bin, bins): (f64, f64, usize)) -> Result<Image> {
    let film = Film { width: 2, height: 2, start, bin, bins, ..FILM };
    let work = Work { samples: 16, ..Work::LITTLE };
    Shot::new(&everything(Unit::SI, film), method, &work)?.render(setup.seed, 2)
}

/// The image of one wide bin over the light.
fn coarse(setup: &Setup, method: Method) -> Result<Image> {
    image(setup, method, (LIT.0, LIT.1 - LIT.0, 1))
}

/// The steady image is that of any other bins.
fn same_steady(a: &Image, b: &Image) -> Finding {
    let pairs = a.arrays.steady.iter().zip(&b.arrays.steady);
    let worst = pairs.map(|(a, b)| (a - b).abs() / a.max(*b)).fold(0.0, f64::max);
    let text = format!("steady image differs by {worst:.1e}");
    Finding::exact(worst <= 1e-12 && a.total() > 0.0, text)
}

fn shares(image: &Image) -> [f64; 3] {
    image.parts().map(|part| part / image.total())
}

fn told([before, inside, after]: [f64; 3]) -> String {
    format!("before {before:.3}, in the window {inside:.3}, after {after:.3}")
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (width, bins) in [(1e-6, 100_000), (1e-3, 10_000), (1e-4, 100_000)] {
        cases.push(Case::new(
            format!("time/bins-{width:e}-x-{bins}"),
            "spread over thousands of bins: sums that drift, edges that overlap, time without end",
            move |setup, method| {
                let one = image(setup, method, (LIT.0, width * bins as f64, 1))?;
                let many = image(setup, method, (LIT.0, width, bins))?;
                let (a, b) = (shares(&one), shares(&many));
                let differ = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let text = format!("{}; one bin differs by {differ:.1e}", told(b));
                Ok(Finding::exact(differ <= 1e-6, text).and(same_steady(&one, &many)))
            },
        ));
    }
    for width in [1e3, 1e6] {
        cases.push(Case::new(
            format!("time/bins-{width:e}-x-3"),
            "a whole render in one bin",
            move |setup, method| {
                let image = image(setup, method, (0.0, width, 3))?;
                let bins: Vec<f64> = (0..3)
                    .map(|bin| (0..4).map(|pixel| image.cells(pixel, 0)[bin + 1]).sum::<f64>())
                    .collect();
                let first = bins[0] / image.total();
                let passed = (first - 1.0).abs() < 1e-6 && bins[1] == 0.0 && bins[2] == 0.0;
                let text = format!("first bin {first:.9} of the light, next {:e}", bins[1]);
                Ok(Finding::exact(passed, text).and(same_steady(&coarse(setup, method)?, &image)))
            },
        ));
    }
    for (name, start, cell) in
        [("before-1e6", -1e6, 2), ("after-1e6", 1e6, 0), ("after-1e12", 1e12, 0)]
    {
        cases.push(Case::new(
            format!("time/window-{name}"),
            "light outside the window that is lost, or lands in the border bins",
            move |setup, method| {
                let image = image(setup, method, (start, 1.0, 50))?;
                let shares = shares(&image);
                let passed = (shares[cell] - 1.0).abs() < 1e-12 && shares[1] == 0.0;
                let finding = Finding::exact(passed, told(shares));
                Ok(finding.and(same_steady(&coarse(setup, method)?, &image)))
            },
        ));
    }
    cases.push(Case::new(
        "time/shifted-window",
        "a window that moves by whole bins must move its contents",
        |setup, method| {
            let early = image(setup, method, (LIT.0, 0.25, 40))?;
            let late = image(setup, method, (LIT.0 + 2.5, 0.25, 40))?;
            let mut differ = 0.0_f64;
            for pixel in 0..4 {
                let (a, b) = (early.cells(pixel, 0), late.cells(pixel, 0));
                for bin in 0..30 {
                    differ = differ.max((a[bin + 11] - b[bin + 1]).abs());
                }
            }
            let relative = differ / early.total();
            let text = format!("bins differ by {relative:.1e} of the light");
            Ok(Finding::exact(relative <= 1e-7, text).and(same_steady(&early, &late)))
        },
    ));
    cases.extend(pulses());
    cases.push(Case::of_no_method(
        "time/bins-narrower-than-rounding",
        "bins that no arrival can be told apart in",
        |_| {
            let film = Film { start: 1e300, ..FILM };
            Ok(refused(&everything(Unit::SI, film), &["too narrow", "bin_width_opl", "metres"]))
        },
    ));
    cases.push(Case::new(
        "time/no-bins",
        "a film without a time axis is another way through the film",
        |setup, method| {
            let steady = image(setup, method, (0.0, 1.0, 0))?;
            Ok(near(&steady_of(coarse(setup, method)?), &steady, 1.0, 1e-12))
        },
    ));
    cases
}

/// Pulses from far below a bin's width to far above the window: the energy is kept.
fn pulses() -> Vec<Case> {
    let mut cases = Vec::new();
    for width_s in [1e-30, 1e-24, 1e-16, 1e-9, 1e-6, 1e3] {
        cases.push(Case::of_no_method(
            format!("time/pulses-of-{width_s:e}-s"),
            "a pulse far shorter or longer than a bin: cancellation that makes or loses energy",
            move |setup| {
                let mut finding = Finding::exact(true, "sums off by");
                for pulse in [Pulse::Box { width_s }, Pulse::Gaussian { sigma_s: width_s }] {
                    let mut image = image(setup, Method::Path, (LIT.0, 0.25, 40))?;
                    let whole: f64 = image.parts().iter().sum();
                    image.arrays.apply_pulse(pulse)?;
                    let off = image.parts().iter().sum::<f64>() / whole - 1.0;
                    finding = finding.and(Finding::exact(off.abs() < 1e-6, format!("{off:.1e}")));
                }
                Ok(finding)
            },
        ));
    }
    cases
}

/// The same without its bins.
fn steady_of(mut image: Image) -> Image {
    let arrays = &mut image.arrays;
    arrays.bins = 0;
    (arrays.transient, arrays.before, arrays.after) = (vec![], vec![], vec![]);
    // Without bins the steady image is all there is.
    image
}
