//! What is compared: methods with arrays of one shape, at most one of them the reference.

use tpb_film::Arrays;

use crate::{Estimate, PixelErrors, ViewerError};

/// Bytes of a page unless another budget is set: 20 MB.
pub const DEFAULT_BUDGET: usize = 20_000_000;

/// Edges of bins that differ by less than this, relative to the window, are the same.
const EDGE_TOLERANCE: f64 = 1e-9;

/// One result of a comparison.
#[derive(Clone, Debug)]
pub struct Method<'a> {
    /// Short and unique, for links and scripts: `beams`.
    pub key: String,
    /// What people read: `photon beams, 20 s`.
    pub label: String,
    /// What it rendered.
    pub arrays: &'a Arrays,
    /// Whether the others are judged by it.
    pub is_reference: bool,
    /// What is known of the errors of neighbouring pixels: how wide intervals of reduced cubes are.
    pub pixel_errors: PixelErrors,
    /// From how many independent batches (passes, replicates) the variance was estimated: intervals
    /// are by Student's t. `None`: not known; then they are as for very many, and the page says so.
    pub batches: Option<u64>,
    /// Whether its errors are independent of the reference's. `false` if both were rendered from
    /// the same random numbers: then noise cannot be told from bias, and those numbers are left out.
    pub independent: bool,
    /// Whether its cells are W m⁻² sr⁻¹. `false`: nobody knows their unit.
    pub unit_known: bool,
    /// A sentence about it; may be empty.
    pub caption: String,
    /// How it was made, as pairs of name and value, in the order in which they are shown.
    pub provenance: Vec<(String, String)>,
    /// The command that makes it again.
    pub command: Option<String>,
}

impl<'a> Method<'a> {
    /// A method without a caption and provenance.
    pub fn new(key: impl Into<String>, label: impl Into<String>, arrays: &'a Arrays) -> Self {
        Self {
            key: key.into(),
            label: label.into(),
            arrays,
            is_reference: false,
            pixel_errors: PixelErrors::default(),
            batches: None,
            independent: true,
            unit_known: true,
            caption: String::new(),
            provenance: Vec::new(),
            command: None,
        }
    }

    /// Its arrays with the number of their batches.
    pub(crate) fn estimate(&self) -> Estimate<'a> {
        Estimate { arrays: self.arrays, batches: self.batches }
    }
}

/// Results of one scene, side by side.
#[derive(Clone, Debug)]
pub struct Comparison<'a> {
    /// Title of the page: the scene.
    pub title: String,
    /// A sentence or two below the title; may be empty.
    pub caption: String,
    /// What is compared, in the order of the number keys 1 to 9 (there may be more).
    pub methods: Vec<Method<'a>>,
    /// Whether the edges of the bins are metres of OPL. `false`: they count bins, as for cubes of
    /// other programs that came without a time axis.
    pub timed: bool,
    /// Pixels that error numbers are also given for, such as those that see no lamp.
    pub judged: Option<Vec<bool>>,
    /// What `judged` selects: `pixels that see no lamp`; may be empty without it.
    pub judged_label: String,
    /// The most that the page may take \[bytes\]; cubes are reduced until they fit.
    pub budget_bytes: usize,
    /// Remarks, shown as a list.
    pub notes: Vec<String>,
}

impl<'a> Comparison<'a> {
    /// A comparison with the default budget.
    pub fn new(title: impl Into<String>, methods: Vec<Method<'a>>) -> Self {
        Self {
            title: title.into(),
            caption: String::new(),
            methods,
            timed: true,
            judged: None,
            judged_label: String::new(),
            budget_bytes: DEFAULT_BUDGET,
            notes: Vec::new(),
        }
    }

    /// The reference, if there is one.
    pub fn reference(&self) -> Option<&Method<'a>> {
        self.methods.iter().find(|method| method.is_reference)
    }

    /// The first method; a checked comparison has one.
    pub(crate) fn first(&self) -> &'a Arrays {
        self.methods[0].arrays
    }

    /// That it can be shown.
    ///
    /// # Errors
    /// [`ViewerError::Comparison`] without methods, with equal keys, or with two references;
    /// [`ViewerError::Mismatch`] for different shapes or time axes.
    pub fn check(&self) -> Result<(), ViewerError> {
        let Some((first, others)) = self.methods.split_first() else {
            return Err(ViewerError::Comparison("nothing to compare: no methods".to_owned()));
        };
        if first.arrays.pixels() == 0 || first.arrays.channels == 0 {
            return Err(ViewerError::Comparison(format!("`{}` has no pixels", first.label)));
        }
        if self.methods.iter().filter(|method| method.is_reference).count() > 1 {
            return Err(ViewerError::Comparison("more than one reference".to_owned()));
        }
        for (index, method) in others.iter().enumerate() {
            if self.methods[..=index].iter().any(|earlier| earlier.key == method.key) {
                let message = format!("two methods have the key `{}`", method.key);
                return Err(ViewerError::Comparison(message));
            }
            same_shape((&first.label, first.arrays), (&method.label, method.arrays))?;
        }
        let pixels = first.arrays.pixels();
        if self.judged.as_ref().is_some_and(|judged| judged.len() != pixels) {
            let message = format!("the judged pixels are not {pixels}, one for each pixel");
            return Err(ViewerError::Comparison(message));
        }
        Ok(())
    }
}

/// That two results have the same shape, quantity and time axis; named in the error.
pub(crate) fn same_shape(a: (&str, &Arrays), b: (&str, &Arrays)) -> Result<(), ViewerError> {
    let (shape_a, shape_b) = (shape(a.1), shape(b.1));
    if shape_a != shape_b {
        return Err(ViewerError::Mismatch(format!(
            "shapes differ: {} has {shape_a}, {} has {shape_b} (rows, columns, bins, channels)",
            a.0, b.0
        )));
    }
    if a.1.quantity != b.1.quantity {
        return Err(ViewerError::Mismatch(format!(
            "{} holds {:?}, {} holds {:?}: compare results of the same kind of pulse",
            a.0, a.1.quantity, b.0, b.1.quantity
        )));
    }
    if !same_edges(&a.1.opl_edges, &b.1.opl_edges) {
        return Err(ViewerError::Mismatch(format!(
            "time windows differ: {} has {}, {} has {}",
            a.0,
            window(a.1),
            b.0,
            window(b.1)
        )));
    }
    Ok(())
}

fn shape(arrays: &Arrays) -> String {
    let Arrays { width, height, bins, channels, .. } = arrays;
    format!("({height}, {width}, {bins}, {channels})")
}

fn window(arrays: &Arrays) -> String {
    match arrays.opl_edges[..] {
        [first, .., last] => format!("{first} m to {last} m of OPL"),
        _ => "none".to_owned(),
    }
}

fn same_edges(a: &[f64], b: &[f64]) -> bool {
    let span = match a {
        [first, .., last] => last - first,
        _ => 0.0,
    };
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= EDGE_TOLERANCE * span)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::cube;

    #[test]
    fn what_cannot_be_compared_is_named() {
        let (a, b) = (cube(4, 3, 5, 1), cube(4, 3, 6, 1));
        let compare = |methods| Comparison::new("test", methods).check().map_err(|e| e.to_string());
        assert!(compare(Vec::new()).unwrap_err().contains("no methods"));
        let message = compare(vec![Method::new("a", "first", &a), Method::new("b", "second", &b)]);
        let message = message.unwrap_err();
        for part in ["first has (3, 4, 5, 1)", "second has (3, 4, 6, 1)"] {
            assert!(message.contains(part), "{part} is missing in {message}");
        }
        let twice = compare(vec![Method::new("a", "A", &a), Method::new("a", "B", &a)]);
        assert!(twice.unwrap_err().contains("key `a`"));
        let reference = Method { is_reference: true, ..Method::new("r", "R", &a) };
        let other = Method { key: "s".to_owned(), ..reference.clone() };
        assert!(compare(vec![reference.clone(), other]).unwrap_err().contains("one reference"));
        let mut later = a.clone();
        later.opl_edges.iter_mut().for_each(|edge| *edge += 0.5);
        let shifted = compare(vec![reference.clone(), Method::new("b", "late", &later)]);
        assert!(shifted.unwrap_err().contains("time windows differ"));
        assert!(compare(vec![reference, Method::new("b", "B", &a)]).is_ok());
    }
}
