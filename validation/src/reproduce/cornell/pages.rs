//! The page of *Cornell blocks*: sequence, steady images, tables, curves, maps, and the viewer.

use std::path::Path;

use tpb_film::Arrays;
use tpb_viewer::{Method, PixelErrors};

use super::super::colour::{diverging, frame_luminances, luminance, sequential, white};
use super::super::compare::Comparison;
use super::super::maps::{BiasMap, VarianceMaps, scale_bar};
use super::super::page::Page;
use super::super::picture::Picture;
use super::super::{bin_of, frame_name, report};
use super::{CornellResult, Shown};
use crate::error::Result;
use crate::statistics::Factor;

/// Between pictures of a grid.
const GAP: usize = 4;
const PAPER: [u8; 3] = [255; 3];
/// OPL at which frames are shown \[m\], chosen before anything was compared, and what is seen then and
/// where, written by people who looked at them.
const SHOWN: [(f64, &str); 6] = [
    (
        4.2,
        "A dome of lit fog hangs from the lamp at the top, brightest below the lamp; its lower border, \
         the front, is at the height of the picture's middle. All else is dark.",
    ),
    (
        4.75,
        "The lit fog has reached the red wall on the left and the green one on the right: both are \
         bright down to a curved border. A short white bar left of the middle is the top of the tall \
         block. The lowest quarter of the picture is dark.",
    ),
    (
        5.25,
        "White bands of direct light: on the front of the tall block, left of the middle, on top of the \
         short one, lower right, and on the floor at the lower border. A red and a green arc run down \
         the walls. The upper part of the tall block and the front of the short one are grey: lit by \
         the fog alone.",
    ),
    (
        5.8,
        "A white arc crosses the floor from corner to corner, behind the short block. The arcs on the \
         walls have moved to the back. On the back wall below the lamp a pale patch begins: the front \
         arrives. The left side of the tall block is red, the right one of the short block green, lit \
         by the walls.",
    ),
    (
        6.3,
        "The front is a broad white ring on the back wall; the tall block hides its lower left. Thin \
         arcs remain at the back of the red and of the green wall, and a white bar at the right end of \
         the floor.",
    ),
    (
        7.35,
        "The front has gone: diffuse light everywhere, reddish at the left, greenish at the right. The \
         front of the short block is darkest.",
    ),
];

/// Writes pictures, charts, the viewer's page, and `index.html`.
pub(super) fn write(out: &Path, result: &CornellResult, shown: &Shown<'_>) -> Result<()> {
    let comparison = &result.picture;
    let mut page = Page::new("Cornell blocks: photon beams and path tracing at equal time");
    introduction(&mut page, comparison);
    let arrays = shown.arrays()?;
    sequence(&mut page, out, &arrays)?;
    steady(&mut page, out, &arrays)?;
    let about = viewer(out, result, shown, &arrays)?;
    drop(arrays);
    page.link_with("viewer.html", "All frames, pixel by pixel: the comparison viewer", &about);
    report::numbers(&mut page, comparison, &result.circumstances.commit);
    report::curves(&mut page, out, "Cornell blocks", comparison, "")?;
    maps(&mut page, out, shown)?;
    if let Some(precise) = &result.precise {
        page.heading("The same at 64x64 pixels and 200 bins, against the shipped reference");
        page.text(&format!(
            "The own NMSE of that reference is {:.1e}, against {:.1e} above: errors are known better.",
            precise.reference_nmse, comparison.reference_nmse
        ));
        report::numbers(&mut page, precise, &result.circumstances.commit);
        report::curves(&mut page, out, "Cornell blocks, 64x64x200", precise, "-precise")?;
    }
    report::provenance(
        &mut page,
        &result.circumstances,
        &result.command,
        &report::film(comparison),
    );
    page.write(&out.join("index.html")).map(drop)
}

fn introduction(page: &mut Page, comparison: &Comparison) {
    let whole = comparison.whole();
    let factor = |f: Option<Factor>| f.map_or("an unresolved number of".to_owned(), |f| f.text());
    page.text(&format!(
        "Each method rendered {} times for {} s. Over the {} of {} pixels that see no lamp, photon \
         beams have {} times less error (NMSE \u{d7} CPU s, 95 % interval) than path tracing; over \
         all pixels, of which those that see the lamp hold most of the signal, {} times.",
        comparison.replicates,
        whole.seconds,
        comparison.pixels[0],
        comparison.pixels[1],
        factor(whole.factor),
        factor(whole.factor_whole),
    ));
    page.note(
        "NMSE is \u{3a3}(x \u{2212} r)\u{b2}/\u{3a3}r\u{b2} over cells (pixel and bin; mean of the channels). Over \
         independent replicates it is split into variance and squared bias; the reference's own \
         measured noise is subtracted and held by the intervals (jackknife over replicates, \
         Student's t). \u{201c}Times less error\u{201d} is a ratio of NMSE \u{d7} CPU seconds with \
         Fieller's interval.",
    );
}

fn sequence(page: &mut Page, out: &Path, arrays: &[Arrays; 3]) -> Result<()> {
    let [path, beams, reference] = arrays;
    let bins: Vec<usize> =
        SHOWN.iter().map(|&(opl, _)| bin_of(&reference.opl_edges, opl)).collect();
    let white = white(bins.iter().flat_map(|&bin| frame_luminances(reference, bin)));
    let rows = [("photon beams", beams), ("path tracing", path), ("reference", reference)];
    let pictures: Vec<Vec<Picture>> = rows
        .iter()
        .map(|(_, arrays)| bins.iter().map(|&bin| Picture::frame(arrays, bin, white)).collect())
        .collect();
    Picture::grid(&pictures, GAP, PAPER).write(&out.join("sequence.png"))?;
    Picture::small_grid(&pictures[..2], GAP, PAPER).write(&out.join("small.png"))?;
    let columns: Vec<String> =
        bins.iter().map(|&bin| frame_name(&reference.opl_edges, bin, false)).collect();
    let rows: Vec<(String, Vec<(Picture, String)>)> = rows
        .iter()
        .zip(pictures)
        .map(|((name, _), pictures)| {
            let named = pictures.into_iter().zip(columns.iter().zip(SHOWN));
            let with_alt =
                named.map(|(p, (time, (_, seen)))| (p, format!("{name}, {time}: {seen}")));
            ((*name).to_owned(), with_alt.collect())
        })
        .collect();
    page.heading("The sequence (the source's figure 2, with a reference)");
    page.pictures(
        "One bin of time each, named by its middle, the same for all rows, with the same exposure: \
         display white is the 99th percentile of the reference's lit cells in these frames.",
        &columns,
        &rows,
    );
    page.text("What is seen, and where:");
    let line = |(bin, (_, seen)): (&usize, (f64, &str))| format!("Bin {bin}. {seen}");
    page.list(&bins.iter().zip(SHOWN).map(line).collect::<Vec<_>>());
    Ok(())
}

fn steady(page: &mut Page, out: &Path, arrays: &[Arrays; 3]) -> Result<()> {
    let [path, beams, reference] = arrays;
    let pixels = reference.steady.chunks_exact(reference.channels);
    let white = white(pixels.map(|pixel| luminance(pixel.iter().copied())));
    let rows = [("photon beams", beams), ("path tracing", path), ("reference", reference)];
    let pictures: Vec<Picture> = rows.iter().map(|(_, a)| Picture::steady(a, white)).collect();
    Picture::grid(std::slice::from_ref(&pictures), GAP, PAPER).write(&out.join("steady.png"))?;
    let columns: Vec<String> = rows.iter().map(|(name, _)| (*name).to_owned()).collect();
    let row = pictures.into_iter().zip(&columns).map(|(picture, name)| {
        (
            picture,
            format!(
                "steady image by {name}: a box of fog with two white blocks, a red and a green wall"
            ),
        )
    });
    page.heading("Steady images");
    page.pictures(
        "All time added up, from the same renders; the same exposure.",
        &columns,
        &[("steady".to_owned(), row.collect())],
    );
    Ok(())
}

fn viewer(
    out: &Path,
    result: &CornellResult,
    shown: &Shown<'_>,
    [path, beams, reference]: &[Arrays; 3],
) -> Result<String> {
    let comparison = &result.picture;
    let method = |key: &str, index: usize, label: &str, arrays| {
        let mut method = Method::new(key, label, arrays);
        method.batches = Some(comparison.replicates as u64);
        // The arrays are those of the first replicate.
        let run = &shown.contested.runs[index][0];
        method.provenance = report::provenance_of_run(&result.circumstances, run);
        method.command = Some(shown.commands[index].clone());
        method
    };
    let seconds = comparison.whole().seconds;
    let mut path_method = method("path", 0, &format!("path tracing, {seconds} s"), path);
    path_method.pixel_errors = PixelErrors::Independent;
    let beams = method("beams", 1, &format!("photon beams, {seconds} s"), beams);
    let mut truth = Method::new("reference", "reference: path tracing, long", reference);
    truth.is_reference = true;
    truth.batches = Some(shown.contested.truth.window_freedom as u64 + 1);
    truth.pixel_errors = PixelErrors::Independent;
    let origin = comparison.reference.as_ref();
    truth.provenance = report::provenance_of_reference(
        &result.circumstances,
        origin,
        comparison.reference_cpu_seconds,
    );
    truth.command = origin.and_then(|origin| origin.commands.last().cloned());
    let mut page = tpb_viewer::Comparison::new("Cornell blocks", vec![path_method, beams, truth]);
    page.caption = "Photon beams and path tracing at equal time, with a long path render.".into();
    page.judged = Some(shown.contested.truth.judged.clone());
    page.judged_label = "pixels that see no lamp".into();
    page.notes = vec![format!(
        "Intervals of path and beams are those of one replicate, from the spread of {} of them.",
        comparison.replicates
    )];
    report::viewer(&out.join("viewer.html"), &page)
}

fn maps(page: &mut Page, out: &Path, shown: &Shown<'_>) -> Result<()> {
    let names = ["path", "beams"];
    let variances = VarianceMaps::new(&shown.contested.maps, &shown.contested.truth);
    page.heading("Maps");
    let mut row = Vec::new();
    for (name, picture) in names.iter().zip(&variances.pictures) {
        picture.write(&out.join(format!("variance-{name}.png")))?;
        row.push((picture.clone(), format!("variance of {name}, pixel by pixel, false colour")));
    }
    let columns: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    page.pictures(
        "Variance of a pixel, summed over its bins, over the mean signal of a judged pixel.",
        &columns,
        &[("variance".to_owned(), row)],
    );
    page.scale(
        &scale_bar(sequential),
        &format!("{:.0e}", variances.darkest),
        &format!("{:.0e} (logarithmic)", variances.brightest),
    )?;
    let biases: Vec<Option<BiasMap>> =
        shown.contested.maps.iter().map(|map| BiasMap::new(map, &shown.contested.truth)).collect();
    let scale = biases.iter().flatten().map(BiasMap::largest).fold(0.01, f64::max);
    let mut row = Vec::new();
    let mut remarks = Vec::new();
    for (name, bias) in names.iter().zip(&biases) {
        let Some(bias) = bias else { continue };
        let picture = bias.picture(&shown.contested.truth, scale);
        picture.write(&out.join(format!("bias-{name}.png")))?;
        let remark = format!(
            "{name}: {} of {} blocks of {}x{} pixels are resolved; without any bias about {:.0} would \
             be, by chance.",
            bias.resolved(),
            bias.blocks.len(),
            bias.side,
            bias.side,
            bias.by_chance()
        );
        row.push((picture, format!("bias of {remark}")));
        remarks.push(remark);
    }
    if row.is_empty() {
        return Ok(());
    }
    page.pictures(
        "Relative bias of the energy of blocks of pixels. Grey: not resolved at 99 %, nothing is \
         claimed.",
        &columns,
        &[("bias".to_owned(), row)],
    );
    let ends = format!("{:.1} %", 100.0 * scale);
    page.scale(
        &scale_bar(|at| diverging(2.0 * at - 1.0)),
        &format!("\u{2212}{ends}: too dark"),
        &format!("+{ends}: too bright"),
    )?;
    page.list(&remarks);
    Ok(())
}
