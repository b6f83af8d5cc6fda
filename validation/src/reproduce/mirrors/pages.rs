//! The page of *Mirrors*: both sequences, what geometry says of them, delay, caustics, and viewers.

use std::path::Path;

use tpb_film::{Arrays, Pulse};
use tpb_viewer::{Method, PixelErrors};

use super::super::colour::{frame_luminances, white};
use super::super::page::Page;
use super::super::picture::Picture;
use super::super::race::Replicate;
use super::super::{Options, frame_name, report, tables};
use super::caustics::{BEAMS_LIGHT, Caustics, LIMIT_LIGHT, MARGIN, THREE};
use super::room::Event;
use super::{MirrorsResult, TWIN, seen};
use crate::error::{Result, ValidationError};

/// Between pictures of a grid.
const GAP: usize = 4;
const PAPER: [u8; 3] = [255; 3];

/// What made the arrays that are shown.
pub(super) struct MadeBy<'a> {
    /// The run.
    pub(super) run: &'a Replicate,
    /// What repeats it.
    pub(super) command: String,
}

/// Writes both sequences, the viewer's page, and `index.html`; the delta sequence is used up.
/// `about_caustics` is what [`caustics_viewer`] says of its page.
pub(super) fn write(
    out: &Path,
    result: &MirrorsResult,
    mut arrays: Arrays,
    made: &MadeBy<'_>,
    about_caustics: &str,
) -> Result<()> {
    let mut page = Page::new("Mirrors: wavefronts reflected, and refracted late");
    page.text(&format!(
        "A fog-filled room with a point lamp, a mirror for its left wall, a tilted mirror on the \
         right, and a ball of glass. One render by photon beams ({:.0} s, {:.0} CPU s, {} passes) \
         gives both rows: a pulse without duration, and a lamp that is switched on and stays on.",
        result.sequence.wall_seconds, result.sequence.cpu_seconds, result.sequence.passes
    ));
    let events = shown(&result.events, arrays.bins);
    let delta = frames(&arrays, &events);
    let about = viewer(out, result, made, &arrays)?;
    let pulse = arrays.apply_pulse(Pulse::Continuous);
    pulse.map_err(|error| ValidationError::unusable("continuous emission", error))?;
    let continuous = frames(&arrays, &events);
    let edges = arrays.opl_edges.clone();
    drop(arrays);
    sequences(&mut page, out, &edges, &events, delta, continuous)?;
    page.link_with("viewer.html", "All frames, pixel by pixel: the viewer", &about);
    timeline(&mut page, &result.events, &edges);
    delays(&mut page, result);
    close_ups(&mut page, &result.close);
    caustics(&mut page, &result.twin, &result.point);
    let text = "The twin's renders by all three methods, in the comparison viewer";
    page.link_with("caustics.html", text, about_caustics);
    page.heading("Path tracing and photon beams at equal time, on the twin");
    page.text(
        "The caustics of a tiny lamp, and its light in mirrors, are what path tracing finds only by \
         chance: it would be a poor referee. The light tracer's long render is the reference, in pixels \
         that look past mirrors, glass and lamp; the others are not judged.",
    );
    report::numbers(&mut page, &result.equal_time, &result.circumstances.commit);
    report::curves(&mut page, out, "Mirrors, area lamp", &result.equal_time, "")?;
    let film = report::film(&result.equal_time);
    report::provenance(&mut page, &result.circumstances, &result.command, &film);
    page.write(&out.join("index.html")).map(drop)
}

/// A frame that is shown.
struct Shown {
    bin: usize,
    /// What happens in it, by geometry.
    label: String,
    /// What is seen.
    seen: String,
}

/// Events in frames of their own: those that share one are named together, and what is seen is what
/// the first of them tells.
fn shown(events: &[Event], bins: usize) -> Vec<Shown> {
    let mut list: Vec<Shown> = Vec::new();
    for event in events {
        let bin = event.bin.min(bins.saturating_sub(1));
        match list.last_mut() {
            Some(last) if last.bin == bin => {
                last.label = format!("{}; {}", last.label, event.label);
            }
            _ => {
                let (label, seen) = (event.label.clone(), event.seen.clone());
                list.push(Shown { bin, label, seen });
            }
        }
    }
    list
}

fn frames(arrays: &Arrays, shown: &[Shown]) -> Vec<Picture> {
    let white = white(shown.iter().flat_map(|shown| frame_luminances(arrays, shown.bin)));
    shown.iter().map(|shown| Picture::frame(arrays, shown.bin, white)).collect()
}

fn sequences(
    page: &mut Page,
    out: &Path,
    edges: &[f64],
    events: &[Shown],
    delta: Vec<Picture>,
    continuous: Vec<Picture>,
) -> Result<()> {
    let rows = [delta.clone(), continuous.clone()];
    Picture::grid(&rows, GAP, PAPER).write(&out.join("sequence.png"))?;
    Picture::small_grid(&rows, GAP, PAPER).write(&out.join("small.png"))?;
    let columns: Vec<String> =
        events.iter().map(|shown| frame_name(edges, shown.bin, false)).collect();
    let row = |name: &str, at_end: bool, pictures: Vec<Picture>| {
        let named = pictures.into_iter().zip(events);
        let with_alt = named.map(|(picture, Shown { bin, label, .. })| {
            (picture, format!("{name}, {}: {label}", frame_name(edges, *bin, at_end)))
        });
        let head = if at_end { format!("{name}, at the bin's end") } else { name.to_owned() };
        (head, with_alt.collect::<Vec<_>>())
    };
    let width = edges[1] - edges[0];
    page.heading("The sequence (the source's figure 3)");
    page.pictures(
        &format!(
            "Above: a delta pulse, energy of one bin, named by its middle. Below: continuous emission \
             from time 0 on, radiance at the bin's end, {:.3} m after the time above it. Each row has \
             one exposure: display white is the 99th percentile of its lit cells.",
            0.5 * width
        ),
        &columns,
        &[row("delta pulse", false, delta), row("continuous emission", true, continuous)],
    );
    page.text(&format!("What is seen, and where. {}", seen::LAYOUT));
    let line = |Shown { bin, label, seen }: &Shown| format!("Bin {bin}, {label}. {seen}");
    page.list(&events.iter().map(line).collect::<Vec<_>>());
    page.text(seen::CONTINUOUS);
    Ok(())
}

fn timeline(page: &mut Page, events: &[Event], edges: &[f64]) {
    page.heading("When what is seen, by geometry");
    let row = |event: &Event| {
        let peak = event.peak.map_or("—".to_owned(), |peak| {
            let late = peak as f64 - event.bin as f64;
            format!("bin {peak} ({late:+.0})")
        });
        vec![
            event.label.clone(),
            format!("{:.3} m", event.opl),
            format!("{}", event.bin),
            format!("{:.0}, {:.0}", event.pixel[0], event.pixel[1]),
            peak,
        ]
    };
    let width = edges.get(1).zip(edges.first()).map_or(0.0, |(b, a)| b - a);
    page.table(
        &format!(
            "OPL from the lamp to the place and on to the eye, in bins of {width:.3} m; where one \
             expects it to be the brightest light there, the brightest bin of the pixels around it"
        ),
        &["event", "OPL", "bin", "pixel x, y", "brightest bin"],
        &events.iter().map(row).collect::<Vec<_>>(),
    );
}

fn delays(page: &mut Page, result: &MirrorsResult) {
    page.heading("Glass slows light: the delay behind the ball");
    page.text(
        "A thin laser from the lamp's place through the middle of the ball onto the floor: the mean \
         arrival with glass, less that with a ball of index 1, against (\u{3b7} \u{2212} 1)\u{b7}2r.",
    );
    let rows: Vec<Vec<String>> = result
        .delays
        .iter()
        .map(|d| {
            vec![
                d.method.clone(),
                format!("{:.5} m", d.exact),
                format!("{:.5} \u{b1} {:.5} m", d.measured, d.half),
                format!("{:+.5} m", d.measured - d.exact),
                format!("{:.5} m", d.resolution),
                format!("{:.5} / {:.5} m", d.arrival, d.exact_arrival),
                if d.agrees() { "agrees".to_owned() } else { "DIFFERS".to_owned() },
            ]
        })
        .collect();
    page.table(
        "Delay with its 99 % interval (noise); the bins' width adds its own uncertainty",
        &[
            "method",
            "exact delay",
            "measured",
            "difference",
            "bins' part",
            "arrival, exact",
            "verdict",
        ],
        &rows,
    );
}

fn close_ups(page: &mut Page, close: &[Caustics]) {
    page.heading("Caustics: path tracing, light tracing and photon beams agree within bounds");
    page.text(&format!(
        "The twin's lamp has a radius of 5 cm, so that path tracing can find its caustics: by chance. The \
         camera stays where it is and looks closely, so that every path begins at a caustic. A path that \
         meets the lamp adds at most its radiance; what all paths together may have missed is bounded by \
         that, and held by the intervals. Methods agree where the 95 % interval of their relative \
         difference lies within \u{b1}{:.0} %, chosen beforehand.",
        100.0 * MARGIN
    ));
    page.list(&close.iter().flat_map(|found| &found.regions).map(three).collect::<Vec<_>>());
    for found in close {
        page.table(
            &caption_of("Close up", found),
            &heads(found),
            &found.regions.iter().map(row).collect::<Vec<_>>(),
        );
    }
}

/// Whether three methods agree on a region, and within what.
fn three(region: &super::caustics::RegionResult) -> String {
    let bound = region.bound(&THREE);
    let within = bound.map_or("no bound is known".to_owned(), |bound| {
        format!("they lie within \u{b1}{:.1} % of each other (95 % intervals)", 100.0 * bound)
    });
    let word = if bound.is_some_and(|bound| bound <= MARGIN) {
        "path, light and beams agree"
    } else {
        "path, light and beams are not shown to agree within the margin"
    };
    let unseen = region.unseen.map_or(String::new(), |unseen| {
        format!("; path tracing may have missed up to {:.2} % of its mean", 100.0 * unseen)
    });
    format!("{}: {word}; {within}{unseen}.", region.label)
}

fn caustics(page: &mut Page, twin: &Caustics, point: &Caustics) {
    page.heading("Caustics in the whole room: do the methods agree?");
    page.text(&format!(
        "Means over \
         regions with \u{b1} one standard error, and 95 % intervals of relative differences; methods \
         agree where the interval lies within \u{b1}{:.0} %. Of the whole room's paths few begin at a \
         caustic, and they find the lamp in mirrors and through glass rarely: with few finds the mean and \
         its measured standard error are both too low, more often than not. What all of them may have \
         missed is held by the intervals, which resolve little here; close up they do.",
        100.0 * MARGIN
    ));
    let count = |pair: usize| {
        let [agree, differ, open] = twin.verdicts(pair);
        format!("{agree} agree, {differ} differ, {open} are open")
    };
    page.text(&format!(
        "Photons on surfaces are blurred over a disc, beams over their radius: a region whose borders \
         cut through a caustic loses what is blurred out of it, and where borders of shadows lie in it, \
         gains. Of the twin's regions, beams against light: {}. Rendered once more with half the radii, \
         beams tell their own blur, 4/3 (B(R) \u{2212} B(R/2)), and their mean without it, R \u{2192} 0 \
         (Richardson): {}.",
        count(BEAMS_LIGHT),
        count(LIMIT_LIGHT)
    ));
    for (caption, found) in [
        ("The twin with an area lamp", twin),
        ("The point lamp: path tracing misses its caustics, and is expected to differ", point),
    ] {
        page.table(
            &caption_of(caption, found),
            &heads(found),
            &found.regions.iter().map(row).collect::<Vec<_>>(),
        );
    }
}

fn caption_of(caption: &str, found: &Caustics) -> String {
    let spent = found.methods.iter().zip(&found.cpu_seconds).zip(&found.passes);
    let spent: Vec<String> = spent
        .map(|((method, seconds), passes)| format!("{method} {seconds:.0} CPU s, {passes} passes"))
        .collect();
    format!("{caption} ({}; {} batches each)", spent.join("; "), found.batches)
}

fn heads(found: &Caustics) -> Vec<&str> {
    let mut heads = vec!["region", "pixels", "bins"];
    heads.extend(found.methods.iter().map(String::as_str));
    heads.push("blur of beams");
    let differences = found.regions.first().map(|region| &region.differences);
    heads.extend(differences.into_iter().flatten().map(|difference| difference.of.as_str()));
    heads
}

fn row(region: &super::caustics::RegionResult) -> Vec<String> {
    let mut row = vec![
        region.label.clone(),
        region.pixels.to_string(),
        format!("{} to {}", region.bins[0], region.bins[1]),
    ];
    let level =
        |l: &super::caustics::Level| format!("{:.3e} \u{b1} {:.1e}", l.mean, l.standard_error);
    row.extend(region.levels.iter().map(level));
    row.push(region.blur.map_or("—".to_owned(), tables::percent));
    row.extend(region.differences.iter().map(tables::difference));
    row
}

fn viewer(
    out: &Path,
    result: &MirrorsResult,
    made: &MadeBy<'_>,
    arrays: &Arrays,
) -> Result<String> {
    let mut method = Method::new("beams", "photon beams", arrays);
    method.provenance = report::provenance_of_run(&result.circumstances, made.run);
    method.command = Some(made.command.clone());
    let mut page = tpb_viewer::Comparison::new("Mirrors", vec![method]);
    page.caption = "A pulse in a fog-filled room with mirrors and a glass ball.".into();
    page.notes =
        result.events.iter().map(|e| format!("Bin {}, {}. {}", e.bin, e.label, e.seen)).collect();
    report::viewer(&out.join("viewer.html"), &page)
}

/// The page that shows the twin by all methods; what is to be said of it.
pub(super) fn caustics_viewer(
    out: &Path,
    options: &Options,
    found: &Caustics,
    means: &[Arrays],
) -> Result<String> {
    let methods = found.methods.iter().zip(&found.cpu_seconds).zip(&found.passes).zip(means);
    let methods = methods
        .map(|(((name, seconds), passes), arrays)| {
            let key = name.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
            let mut method = Method::new(key, format!("{name}, {seconds:.0} CPU s"), arrays);
            method.batches = Some(found.batches);
            if name == "path" {
                method.pixel_errors = PixelErrors::Independent;
            }
            method.provenance = report::provenance_of(&options.circumstances);
            let passes = format!("{passes}, in {} batches", found.batches);
            method.provenance.push(("passes".into(), passes));
            method.provenance.push(("CPU s".into(), format!("{seconds:.0}")));
            method.command = Some(options.command.clone());
            method
        })
        .collect();
    let mut page = tpb_viewer::Comparison::new("Mirrors, with a tiny area lamp", methods);
    page.caption = format!("{TWIN}: path tracing, light tracing, photon beams; no reference.");
    page.notes = vec!["The light tracer does not see what stands in mirrors and glass.".into()];
    report::viewer(&out.join("caustics.html"), &page)
}
