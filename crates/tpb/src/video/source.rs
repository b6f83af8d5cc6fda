//! The result that a video shows: its arrays, what its report allows, and the bins asked for.

use std::ops::Range;
use std::path::Path;

use tpb_film::{Arrays, Pulse};
use tpb_optics::opl::{opl_from_seconds, seconds_from_opl};

use super::args::TimeArgs;
use crate::failure::Failure;
use crate::values::Bounds;
use crate::viewer::{Input, command, pulse_name};

/// A result, and what to say about it.
pub(super) struct Source {
    input: Input,
    /// What the reader should know.
    pub(super) remarks: Vec<String>,
}

impl Source {
    /// Reads a result or a cube of another program.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let mut input = Input::read(path, None)?;
        let remarks = input.loaded.remarks.clone();
        // Not shown, and as large as the cube.
        input.loaded.arrays.variance = None;
        if input.loaded.arrays.bins == 0 {
            let file = input.loaded.file.display();
            return Err(Failure::with_help(
                format!("{file} has no time axis: there is nothing to move"),
                "render it with sensor.film.temporal_bins of at least 1",
            ));
        }
        Ok(Self { input, remarks })
    }

    pub(super) fn arrays(&self) -> &Arrays {
        &self.input.loaded.arrays
    }

    /// Whether bins are times; otherwise they are numbers.
    pub(super) fn timed(&self) -> bool {
        self.input.loaded.timed
    }

    /// Whether all cells are finite and none is negative.
    pub(super) fn is_sound(&self) -> bool {
        self.input.loaded.is_sound()
    }

    /// That the film subtracted the leg to the first surface, which cannot be done afterwards.
    pub(super) fn need_unwarped(&self) -> Result<(), Failure> {
        let why = "--unwarp: the arrays of a result cannot be unwarped afterwards, because rays of \
                   one pixel meet surfaces at different distances; the film does it as light arrives";
        match &self.input.report {
            Some(report) if report.options.unwarp => Ok(()),
            Some(report) => Err(Failure::with_help(
                why,
                format!("render it again: {} --unwarp", command(report)),
            )),
            None => Err(Failure::with_help(why, "no report tells how this one was made")),
        }
    }

    /// The bins that the command line asks for.
    pub(super) fn bins(&self, args: &TimeArgs) -> Result<Option<Range<usize>>, Failure> {
        let count = self.arrays().bins;
        if let Some(bins) = args.bins {
            let (first, end) = (bins.0.unwrap_or(0), bins.1.unwrap_or(count));
            if first >= end || end > count {
                let message = format!("--bins {first}..{end}: the result has the bins 0..{count}");
                return Err(Failure::with_help(
                    message,
                    "A..B are the bins A to B - 1, counted from 0",
                ));
            }
            return Ok(Some(first..end));
        }
        let to_opl =
            |bounds: Bounds| Bounds(bounds.0.map(opl_from_seconds), bounds.1.map(opl_from_seconds));
        let (flag, bounds) = match (args.time_range, args.opl_range) {
            (Some(seconds), _) => ("--time-range", to_opl(seconds)),
            (None, Some(opl)) => ("--opl-range", opl),
            (None, None) => return Ok(None),
        };
        self.need_axis(flag, "--bins A..B")?;
        self.overlapping(flag, bounds).map(Some)
    }

    /// The bins that overlap an interval of OPL.
    fn overlapping(&self, flag: &str, bounds: Bounds) -> Result<Range<usize>, Failure> {
        let edges = &self.arrays().opl_edges;
        let (from, to) = (bounds.0.unwrap_or(f64::NEG_INFINITY), bounds.1.unwrap_or(f64::INFINITY));
        let first = edges[1..].partition_point(|&upper| upper <= from);
        let end = edges[..edges.len() - 1].partition_point(|&lower| lower < to);
        if first < end {
            return Ok(first..end);
        }
        let last = edges[edges.len() - 1];
        let ns = |opl: f64| seconds_from_opl(opl) * 1e9;
        let message = format!(
            "{flag}: no bin lies there; the result has {:.4} ns to {:.4} ns = {:.4} m to {last:.4} m",
            ns(edges[0]),
            ns(last),
            edges[0],
        );
        Err(Failure::with_help(message, "name a range that overlaps it, such as 2ns..8ns"))
    }

    /// Turns the response to a delta pulse into that to another.
    pub(super) fn apply_pulse(&mut self, pulse: Pulse) -> Result<(), Failure> {
        if pulse == Pulse::Delta {
            return Ok(());
        }
        self.need_axis("--pulse", "a result of tpb")?;
        let rendered = self.input.report.as_ref().map_or(Pulse::Delta, |r| r.options.pulse);
        if rendered != Pulse::Delta {
            let message =
                format!("--pulse: the result already has the pulse {}", pulse_name(rendered));
            return Err(Failure::with_help(
                message,
                "pulses are applied to results of --pulse delta",
            ));
        }
        let arrays = &mut self.input.loaded.arrays;
        let outside = |cells: &[f64]| cells.iter().any(|&energy| energy > 0.0);
        let (before, after) = (outside(&arrays.before), outside(&arrays.after));
        let report =
            arrays.apply_pulse(pulse).map_err(|e| Failure::input(format!("--pulse: {e}")))?;
        for (bins, missing, end, side) in [
            (report.guard_bins_start, before, "first", "before"),
            (report.guard_bins_end, after, "last", "after"),
        ] {
            if bins > 0 && missing {
                self.remarks.push(format!(
                    "the {end} {bins} bins lack what the pulse spreads of light from {side} the \
                     window; render with --pulse to have it"
                ));
            }
        }
        Ok(())
    }

    fn need_axis(&self, flag: &str, instead: &str) -> Result<(), Failure> {
        if self.timed() {
            return Ok(());
        }
        let file = self.input.loaded.file.display();
        Err(Failure::with_help(
            format!("{flag}: {file} has no time axis"),
            format!("use {instead}"),
        ))
    }
}
