//! `tpb info`: what is in a result, and whether it is sound.
//!
//! Checked: bins + before + after = steady image in every pixel, to the rounding of f32 (for
//! continuous emission: the last edge + after); and what the report says of the render.

use std::path::Path;
use std::process::ExitCode;

use tpb_film::{Arrays, Quantity};
use tpb_optics::opl::seconds_from_opl;

use crate::cli::InfoArgs;
use crate::failure::Failure;
use crate::summary::Lines;
use crate::{folder, print, summary};

/// Relative: each of the cells is rounded to f32, 6e-8.
const TOLERANCE: f64 = 1e-6;

/// Reads, checks, prints.
pub(crate) fn run(args: &InfoArgs) -> Result<ExitCode, Failure> {
    let path = folder::arrays_of(&args.result);
    let arrays = Arrays::read_npz(&path).map_err(|e| Failure::input(e.to_string()))?;
    let mut lines = Lines::default();
    lines.add("file", &path.display().to_string());
    shapes(&mut lines, &arrays);
    let mut sound = totals(&mut lines, &arrays);
    sound &= report(&mut lines, &folder::report_of(&args.result));
    print::out(&lines.text())?;
    Ok(if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn shapes(lines: &mut Lines, arrays: &Arrays) {
    let Arrays { width, height, bins, channels, quantity, ref opl_edges, .. } = *arrays;
    if let [first, .., last] = opl_edges[..] {
        let shape =
            format!("({height}, {width}, {bins}, {channels}) = (rows, columns, bins, channels)");
        let name = match quantity {
            Quantity::BinEnergy => "transient",
            Quantity::RadianceAtUpperEdges => "radiance",
        };
        lines.add(name, &shape);
        let (from, to) = (seconds_from_opl(first) * 1e9, seconds_from_opl(last) * 1e9);
        lines.add("window", &format!("{first:.6} m to {last:.6} m = {from:.4} ns to {to:.4} ns"));
        let width = (last - first) / bins as f64;
        let width_s = seconds_from_opl(width) * 1e12;
        lines.add("bin width", &format!("{width:.6} m = {width_s:.4} ps"));
        let variance = if arrays.variance.is_some() { "kept" } else { "not kept" };
        lines.add("variance", variance);
    } else {
        lines.add("steady", &format!("({height}, {width}, {channels}); no time axis"));
    }
}

/// Energies, and whether they add up.
fn totals(lines: &mut Lines, arrays: &Arrays) -> bool {
    let steady: f64 = arrays.steady.iter().sum();
    lines.add("steady total", &format!("{steady:.6e} (sum over pixels and channels)"));
    let finite = arrays.steady.iter().all(|s| s.is_finite())
        && arrays.transient.iter().all(|c| c.is_finite());
    if !finite {
        lines.add("WARNING", "some values are not finite");
    }
    if arrays.bins == 0 {
        return finite;
    }
    let part = |energy: f64| if steady == 0.0 { 0.0 } else { 100.0 * energy / steady };
    let (before, after): (f64, f64) = (arrays.before.iter().sum(), arrays.after.iter().sum());
    let inside = (0..arrays.pixels()).map(|pixel| inside(arrays, pixel).iter().sum::<f64>());
    let (inside, worst) = (inside.sum::<f64>(), imbalance(arrays));
    lines.add(
        "energy",
        &format!(
            "{:.4} % before the window, {:.4} % in it, {:.4} % after it",
            part(before),
            part(inside),
            part(after),
        ),
    );
    let holds = worst <= TOLERANCE;
    let verdict = if holds { "holds" } else { "IS BROKEN" };
    lines.add("bins = steady", &format!("{verdict}: off by at most {worst:.1e} in any pixel"));
    finite && holds
}

/// What arrived within the window at a pixel, by channel.
fn inside(arrays: &Arrays, pixel: usize) -> Vec<f64> {
    let channels = arrays.channels;
    let cells = arrays.pixel(pixel);
    let of_channel = |channel: usize| {
        let mut values = cells.iter().skip(channel).step_by(channels).map(|&cell| f64::from(cell));
        match arrays.quantity {
            Quantity::BinEnergy => values.sum(),
            // The running sum began with what came before.
            Quantity::RadianceAtUpperEdges => {
                values.next_back().unwrap_or(0.0) - arrays.before[pixel * channels + channel]
            }
        }
    };
    (0..channels).map(of_channel).collect()
}

/// The worst relative difference between a pixel's cells and its steady value.
fn imbalance(arrays: &Arrays) -> f64 {
    let channels = arrays.channels;
    let mut worst: f64 = 0.0;
    for pixel in 0..arrays.pixels() {
        for (channel, inside) in inside(arrays, pixel).into_iter().enumerate() {
            let at = pixel * channels + channel;
            let sum = inside + arrays.before[at] + arrays.after[at];
            let scale = arrays.steady[at].abs().max(f64::MIN_POSITIVE);
            let difference = (sum - arrays.steady[at]).abs() / scale;
            worst = worst.max(if difference.is_nan() { f64::INFINITY } else { difference });
        }
    }
    worst
}

/// What the report says, if there is one.
fn report(lines: &mut Lines, path: &Path) -> bool {
    if !path.exists() {
        lines.add("report", "none");
        return true;
    }
    match folder::read_report(path) {
        Ok(report) => {
            lines.add("scene", &report.scene.file);
            lines.add("program", &report.program);
            summary::of_report(lines, &report);
            report.is_sound()
        }
        Err(error) => {
            lines.add("WARNING", &format!("cannot read {}: {error}", path.display()));
            false
        }
    }
}
