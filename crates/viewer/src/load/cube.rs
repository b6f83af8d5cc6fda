//! Cubes of other programs, with what they lack made up.

use std::path::Path;

use tpb_film::{Arrays, Quantity};
use tpb_optics::opl::opl_from_seconds;

use super::Loaded;
use super::npy::{self, Array};
use crate::ViewerError;

/// What a cube's file must hold.
const WANTED: &str = "a cube is (rows, columns, bins) or (rows, columns, bins, channels)";

/// Arrays that go with a cube, and are none.
const BESIDE: [&str; 8] =
    ["steady", "before", "after", "variance", "opl_edges", "time_edges", "batches", "mask"];

/// The cube of a `.npy` file.
pub(super) fn of_npy(path: &Path) -> Result<Loaded, ViewerError> {
    let arrays = arrays(path, "the array", npy::of_file(path)?, Quantity::BinEnergy)?;
    Ok(Loaded { window_only: true, unit_known: false, ..Loaded::new(path, arrays, false) })
}

/// The cube of an archive with these arrays.
pub(super) fn of_npz(path: &Path, names: &[String]) -> Result<Loaded, ViewerError> {
    let name = choose(path, names)?;
    let quantity = match name {
        "radiance" => Quantity::RadianceAtUpperEdges,
        _ => Quantity::BinEnergy,
    };
    let cells = npy::of_member(path, name)?;
    let shape = cells.shape.clone();
    let mut arrays = arrays(path, &format!("`{name}`"), cells, quantity)?;
    let edges = edges(path, names, arrays.bins)?;
    let timed = edges.is_some();
    if let Some(edges) = edges {
        arrays.opl_edges = edges;
    }
    if names.iter().any(|name| name == "variance") {
        let variance = npy::of_member(path, "variance")?;
        if variance.shape != shape {
            return Err(ViewerError::cube(path, "`variance` has not the shape of the cube"));
        }
        let values = variance.into_f32();
        if values.iter().any(|&v| v.is_nan() || v < 0.0) {
            return Err(ViewerError::cube(path, "`variance` has values that are no variances"));
        }
        arrays.variance = Some(values);
    }
    let batches = batches(path, names)?;
    let loaded = Loaded::new(path, arrays, timed);
    Ok(Loaded { window_only: true, unit_known: false, batches, ..loaded })
}

/// From how many independent runs the variance was estimated, if the archive tells.
fn batches(path: &Path, names: &[String]) -> Result<Option<u64>, ViewerError> {
    if !names.iter().any(|name| name == "batches") {
        return Ok(None);
    }
    match npy::of_member(path, "batches")?.into_f64()[..] {
        [count] if count >= 1.0 && count.fract() == 0.0 => Ok(Some(count as u64)),
        _ => Err(ViewerError::cube(path, "`batches` is not one whole number of runs")),
    }
}

/// The pixels of an image, row by row, that are not 0.
pub(super) fn mask(path: &Path) -> Result<([usize; 2], Vec<bool>), ViewerError> {
    let array = if super::starts_with(path, super::NPY_MAGIC)? {
        npy::of_file(path)?
    } else {
        let names = npy::names(path)?;
        let name = match &names[..] {
            [only] => only,
            _ => names.iter().find(|name| *name == "mask").ok_or_else(|| {
                let reason = format!("has no array `mask` among its own ({})", names.join(", "));
                ViewerError::cube(path, reason)
            })?,
        };
        npy::of_member(path, name)?
    };
    let [height, width] = array.shape[..] else {
        let reason = format!("has the shape {:?}; a mask is (rows, columns)", array.shape);
        return Err(ViewerError::cube(path, reason));
    };
    let values = array.into_f64();
    if let Some(pixel) = values.iter().position(|value| value.is_nan()) {
        let (row, column) = (pixel / width, pixel % width);
        let reason = format!("is not a number (NaN) at row {row}, column {column}, from 0");
        return Err(ViewerError::cube(path, reason));
    }
    Ok(([height, width], values.into_iter().map(|value| value != 0.0).collect()))
}

/// Which array is the cube.
fn choose<'a>(path: &Path, names: &'a [String]) -> Result<&'a str, ViewerError> {
    if let Some(known) = names.iter().find(|name| *name == "transient" || *name == "radiance") {
        return Ok(known);
    }
    let (mut cubes, mut broken) = (Vec::new(), None);
    for name in names.iter().filter(|name| !BESIDE.contains(&name.as_str())) {
        match npy::member(path, name) {
            Ok(member) if matches!(member.dimensions, 3 | 4) => cubes.push(name.as_str()),
            Ok(_) => {}
            Err(error) => broken = broken.or(Some(error)),
        }
    }
    match (&cubes[..], broken) {
        (&[only], _) => Ok(only),
        // It may be the cube.
        ([], Some(error)) => Err(error),
        ([], None) => Err(ViewerError::cube(
            path,
            format!("has no cube among its arrays ({}); {WANTED}", names.join(", ")),
        )),
        _ => Err(ViewerError::cube(
            path,
            format!("has several cubes ({}); name the one meant `transient`", cubes.join(", ")),
        )),
    }
}

/// The edges of the bins as OPL, if the archive has them.
fn edges(path: &Path, names: &[String], bins: usize) -> Result<Option<Vec<f64>>, ViewerError> {
    let has = |name: &str| names.iter().any(|n| n == name);
    for name in ["opl_edges", "time_edges"] {
        if !has(name) {
            continue;
        }
        let mut edges = npy::of_member(path, name)?.into_f64();
        if name == "time_edges" {
            for edge in &mut edges {
                *edge = opl_from_seconds(*edge);
            }
        }
        let rising = edges.windows(2).all(|pair| pair[0] < pair[1]);
        if edges.len() != bins + 1 || !rising || edges.iter().any(|edge| !edge.is_finite()) {
            let reason = format!("`{name}` is not a rising list of the {} edges of bins", bins + 1);
            return Err(ViewerError::cube(path, reason));
        }
        return Ok(Some(edges));
    }
    Ok(None)
}

/// A cube alone: nothing outside the window, times count bins.
fn arrays(
    path: &Path,
    name: &str,
    array: Array,
    quantity: Quantity,
) -> Result<Arrays, ViewerError> {
    let [height, width, bins, channels] = match array.shape[..] {
        [height, width, bins] => [height, width, bins, 1],
        [height, width, bins, channels] => [height, width, bins, channels],
        _ => {
            let reason = format!("{name} has the shape {:?}; {WANTED}", array.shape);
            return Err(ViewerError::cube(path, reason));
        }
    };
    if height * width * bins == 0 || !matches!(channels, 1 | 3) {
        let reason = format!(
            "{name} has the shape {:?}: at least one pixel and bin and 1 or 3 channels are needed",
            array.shape
        );
        return Err(ViewerError::cube(path, reason));
    }
    let transient = array.into_f32();
    let outside = vec![0.0; height * width * channels];
    let mut arrays = Arrays {
        width,
        height,
        bins,
        channels,
        quantity,
        opl_edges: (0..=bins).map(|edge| edge as f64).collect(),
        transient,
        variance: None,
        before: outside.clone(),
        after: outside.clone(),
        steady: outside,
    };
    arrays.steady = within_window(&arrays);
    Ok(arrays)
}

/// The light of the window alone: the sum of a pixel's bins; of continuous emission, the radiance at
/// the last edge.
pub(super) fn within_window(arrays: &Arrays) -> Vec<f64> {
    let Arrays { bins, channels, quantity, .. } = *arrays;
    let counted = match quantity {
        Quantity::BinEnergy => bins,
        Quantity::RadianceAtUpperEdges => 1,
    };
    let mut image = vec![0.0; arrays.pixels() * channels];
    for (pixel, sums) in image.chunks_exact_mut(channels).enumerate() {
        for cell in arrays.pixel(pixel).rchunks_exact(channels).take(counted) {
            sums.iter_mut().zip(cell).for_each(|(sum, &cell)| *sum += f64::from(cell));
        }
    }
    image
}
