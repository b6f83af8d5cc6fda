//! The page: how far cubes are reduced to keep the budget, and the HTML around them.
//!
//! Factors are tried from the gentlest on. A few rows of each reduced result are packed to estimate
//! the size; the first factors whose estimate fits are packed whole, and the next are tried if the
//! whole does not fit after all. Error numbers are those of the full size, whatever is shown.

use std::io::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tpb_film::{Arrays, FilmError, atomic_write};
use tpb_page::{Document, document, json_element};

use crate::ViewerError;
use crate::assets::{PAGE, SCRIPTS, STYLES};
use crate::comparison::{Comparison, Method};
use crate::manifest::{Judgement, manifest};
use crate::pack::PackedMethod;
use crate::reduce::{Factors, reduce, reduce_rows};

/// Rows of a sample from which the size is estimated.
const SAMPLE_ROWS: usize = 8;

/// Estimates within this part of the budget are tried.
const CONFIDENCE: f64 = 0.97;

/// What became of a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageReport {
    /// Its size \[bytes\].
    pub bytes: usize,
    /// By how much the cubes are reduced.
    pub factors: Factors,
    /// (rows, columns, bins) shown.
    pub shown: [usize; 3],
    /// (rows, columns, bins) of the results.
    pub rendered: [usize; 3],
}

/// Writes the page, whole or not at all.
///
/// # Errors
/// Those of [`page`], and [`ViewerError::Film`] if the file cannot be written.
pub fn write_comparison(
    path: &Path,
    comparison: &Comparison<'_>,
) -> Result<PageReport, ViewerError> {
    let (html, report) = page(comparison)?;
    atomic_write(path, |file| file.write_all(html.as_bytes()))?;
    Ok(report)
}

/// The page as text.
///
/// # Errors
/// Those of [`Comparison::check`]; [`ViewerError::Budget`] if nothing fits.
pub fn page(comparison: &Comparison<'_>) -> Result<(String, PageReport), ViewerError> {
    comparison.check()?;
    let judged = comparison.methods.iter().map(|method| Judgement::new(comparison, method));
    let judgements: Vec<Judgement> = judged.collect();
    let bare =
        html(comparison, Factors::NONE, &without_cells(comparison.first()), &[], &judgements)?;
    let bare = bare.len();
    let too_small = |needed| ViewerError::Budget { needed, budget: comparison.budget_bytes };
    let room = comparison.budget_bytes.checked_sub(bare).ok_or_else(|| too_small(bare))? as f64;
    let mut smallest = bare;
    // Cells that must become one at least, as far as is known.
    let mut least = 0;
    for factors in Factors::all(comparison.first()) {
        let last = factors.cells() >= cells(comparison.first());
        if factors.cells() < least && !last {
            continue;
        }
        let estimate = estimate(comparison, factors)?;
        if estimate > CONFIDENCE * room && !last {
            // Noise averages out: bytes fall faster than cells, but hardly three times as fast.
            least = (factors.cells() as f64 * estimate / (3.0 * room)) as usize;
            smallest = bare + estimate as usize;
            continue;
        }
        let (text, report) = build(comparison, factors, &judgements)?;
        if text.len() <= comparison.budget_bytes {
            return Ok((text, report));
        }
        smallest = text.len();
    }
    Err(too_small(smallest))
}

/// The shape alone.
fn without_cells(arrays: &Arrays) -> Arrays {
    let Arrays { width, height, bins, channels, quantity, .. } = *arrays;
    let (opl_edges, transient, variance) = (Vec::new(), Vec::new(), None);
    let (before, after, steady) = (Vec::new(), Vec::new(), Vec::new());
    Arrays {
        width,
        height,
        bins,
        channels,
        quantity,
        opl_edges,
        transient,
        variance,
        before,
        after,
        steady,
    }
}

fn cells(arrays: &Arrays) -> usize {
    arrays.pixels() * arrays.bins.max(1)
}

/// Bytes of the streams and of the edges of bins in the page, told from a few rows.
fn estimate(comparison: &Comparison<'_>, factors: Factors) -> Result<f64, ViewerError> {
    let rows = comparison.first().height.div_ceil(factors.pixels);
    let count = rows.min(SAMPLE_ROWS);
    let sample: Vec<usize> = (0..count).map(|i| (2 * i + 1) * rows / (2 * count)).collect();
    let (mut bytes, mut edges) = (0.0, 0.0);
    for method in &comparison.methods {
        let part = reduce_rows(method.arrays, factors, method.pixel_errors, &sample);
        edges = serde_json::to_string(&part.opl_edges).map_or(0.0, |text| text.len() as f64);
        let part = pack(&part)?;
        let sizes = part.streams().map(|stream| stream.bytes.len() as f64);
        bytes += sizes.sum::<f64>() * rows as f64 / count as f64;
    }
    Ok(bytes * 4.0 / 3.0 + edges)
}

fn pack(arrays: &Arrays) -> Result<PackedMethod, ViewerError> {
    PackedMethod::new(arrays).map_err(|source| {
        ViewerError::Film(FilmError::Io { path: "the packed arrays".into(), source })
    })
}

fn build(
    comparison: &Comparison<'_>,
    factors: Factors,
    judgements: &[Judgement],
) -> Result<(String, PageReport), ViewerError> {
    let whole = factors == Factors::NONE;
    let mut packed = Vec::with_capacity(comparison.methods.len());
    let reduced = |method: &Method<'_>| reduce(method.arrays, factors, method.pixel_errors);
    let first = reduced(&comparison.methods[0]);
    for (index, method) in comparison.methods.iter().enumerate() {
        packed.push(match index {
            0 => pack(&first)?,
            _ if whole => pack(method.arrays)?,
            _ => pack(&reduced(method))?,
        });
    }
    let text = html(comparison, factors, &first, &packed, judgements)?;
    let shape = |arrays: &Arrays| [arrays.height, arrays.width, arrays.bins];
    let report = PageReport {
        bytes: text.len(),
        factors,
        shown: shape(&first),
        rendered: shape(comparison.first()),
    };
    Ok((text, report))
}

fn html(
    comparison: &Comparison<'_>,
    factors: Factors,
    first: &Arrays,
    packed: &[PackedMethod],
    judgements: &[Judgement],
) -> Result<String, ViewerError> {
    let (manifest, streams) = manifest(comparison, factors, first, packed, judgements);
    let mut data = json_element("manifest", &manifest)
        .map_err(|error| ViewerError::Comparison(format!("cannot be written: {error}")))?;
    for (name, stream) in streams.named() {
        data.push_str("<script type=\"application/octet-stream\" id=\"");
        data.push_str(&name);
        data.push_str("\">");
        STANDARD.encode_string(&stream.bytes, &mut data);
        data.push_str("</script>\n");
    }
    Ok(document(&Document {
        template: PAGE,
        title: &comparison.title,
        styles: &STYLES,
        data: &data,
        scripts: &SCRIPTS,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{cube, with_error};

    #[test]
    fn a_small_comparison_is_shown_whole() {
        let (a, b) = (with_error(cube(12, 9, 20, 3), 0.1), cube(12, 9, 20, 3));
        let reference = Method { is_reference: true, ..Method::new("r", "reference", &b) };
        let comparison =
            Comparison::new("A </script> title", vec![Method::new("a", "A", &a), reference]);
        let (text, report) = page(&comparison).unwrap();
        assert_eq!(report.factors, Factors::NONE);
        assert_eq!((report.bytes, report.shown), (text.len(), [9, 12, 20]));
        assert!(text.contains("<title>A &lt;/script&gt; title"));
        assert!(!text.contains("A </script> title"), "escaped in the manifest, too");
        for part in ["http://", "https://", "src=", "url("] {
            let ours = text.replace("https://github.com/leeoniya/uPlot", "");
            assert!(!ours.contains(part), "the page asks for nothing, but has {part}");
        }
    }

    #[test]
    fn the_budget_is_kept_and_the_reduction_told() {
        let arrays = with_error(cube(64, 48, 60, 3), 0.1);
        let method = |key: &str| Method::new(key, key, &arrays);
        let mut comparison = Comparison::new("budget", vec![method("a"), method("b")]);
        let whole = page(&comparison).unwrap().1;
        assert_eq!(whole.factors, Factors::NONE);
        let bare = 400_000;
        for budget in [whole.bytes - 1, usize::midpoint(whole.bytes, bare), bare] {
            comparison.budget_bytes = budget;
            let (text, report) = page(&comparison).unwrap();
            assert!(text.len() <= budget && report.factors != Factors::NONE, "{report:?}");
            let cells: usize = report.shown.iter().product();
            assert!(cells < 48 * 64 * 60 && report.rendered == [48, 64, 60], "{report:?}");
            let factors =
                format!("\"factors\":[{},{}]", report.factors.pixels, report.factors.bins);
            assert!(text.contains(&factors));
        }
        comparison.budget_bytes = 10_000;
        assert!(matches!(page(&comparison), Err(ViewerError::Budget { budget: 10_000, .. })));
    }

    /// Regression: curves over all pixels, and edges of bins, were stored bin by bin as text: a page of
    /// one pixel with very many bins had no room for anything else.
    #[test]
    fn one_pixel_with_a_million_bins_has_a_page() {
        let bins = 1_000_000;
        let mut arrays = with_error(cube(1, 1, bins, 1), 0.1);
        for (at, edge) in arrays.opl_edges.iter_mut().enumerate() {
            *edge = 1.0 + at as f64 / 3e5;
        }
        let reference = Method { is_reference: true, ..Method::new("r", "R", &arrays) };
        let mut comparison =
            Comparison::new("long", vec![Method::new("a", "A", &arrays), reference]);
        for budget in [crate::DEFAULT_BUDGET, 1_000_000] {
            comparison.budget_bytes = budget;
            let (text, report) = page(&comparison).unwrap();
            assert!(text.len() <= budget, "{} bytes", text.len());
            let [1, 1, shown] = report.shown else { panic!("{report:?}") };
            assert!((1000..=crate::reduce::LONGEST).contains(&shown), "{report:?}");
            assert!(text.contains("\"curve_bins\":245,\"curve_edges\":["));
        }
    }

    #[test]
    fn steady_films_have_pages() {
        let mut arrays = cube(5, 4, 3, 1);
        arrays.bins = 0;
        arrays.opl_edges.clear();
        arrays.transient.clear();
        arrays.before.clear();
        arrays.after.clear();
        let comparison = Comparison::new("steady", vec![Method::new("a", "A", &arrays)]);
        assert_eq!(page(&comparison).unwrap().1.shown, [4, 5, 0]);
    }
}
