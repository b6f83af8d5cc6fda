//! What the page's scripts are told, as JSON; the arrays are in streams beside it.

use serde::Serialize;
use tpb_film::{Arrays, Quantity};

use crate::comparison::{Comparison, Method};
use crate::interval::standard_errors;
use crate::metrics::{EPSILON, FrameCurves, Metrics};
use crate::pack::{PackedMethod, Prediction, Stream, code};
use crate::reduce::{Factors, edges_of_groups};

/// All but the arrays.
#[derive(Serialize)]
pub(crate) struct Manifest<'a> {
    title: &'a str,
    caption: &'a str,
    program: &'static str,
    quantity: Quantity,
    /// Whether edges are metres of OPL.
    timed: bool,
    /// Shape of the packed arrays.
    shape: Shape,
    /// Shape of the results.
    rendered: Shape,
    factors: [usize; 2],
    edges: &'a [f64],
    /// Bins of the results in a group of `frames`.
    curve_bins: usize,
    /// Edges of those groups.
    /// `None`: they are `edges`.
    curve_edges: Option<Vec<f64>>,
    code: Code,
    epsilon: f64,
    judged_label: Option<&'a str>,
    notes: &'a [String],
    methods: Vec<MethodEntry<'a>>,
}

#[derive(Serialize)]
struct Shape {
    width: usize,
    height: usize,
    bins: usize,
    channels: usize,
}

impl Shape {
    fn of(arrays: &Arrays) -> Self {
        let Arrays { width, height, bins, channels, .. } = *arrays;
        Self { width, height, bins, channels }
    }
}

/// How codes are read: `tpb_viewer::pack::code`.
#[derive(Serialize)]
struct Code {
    steps: f64,
    image_steps: f64,
    offset: f64,
    error_steps: f64,
    error_offset: f64,
}

#[derive(Serialize)]
struct MethodEntry<'a> {
    key: &'a str,
    label: &'a str,
    reference: bool,
    /// Of its variance, if known.
    batches: Option<u64>,
    /// Standard errors on each side of a 95 % interval.
    interval: Option<f64>,
    /// Whether its errors are independent of the reference's.
    independent: bool,
    /// Whether its cells are W m⁻² sr⁻¹.
    unit_known: bool,
    caption: &'a str,
    command: Option<&'a str>,
    provenance: &'a [(String, String)],
    cube: Vec<StreamEntry>,
    errors: Vec<StreamEntry>,
    before: Vec<StreamEntry>,
    after: Vec<StreamEntry>,
    steady: Vec<StreamEntry>,
    numbers: Option<&'a Numbers>,
    frames: Curves,
}

/// Errors bin by bin, in digits enough to draw them.
#[derive(Serialize)]
struct Curves {
    mean: Vec<f32>,
    nmse: Vec<Option<f32>>,
    bias: Vec<Option<f32>>,
}

impl Curves {
    fn new(frames: &FrameCurves) -> Self {
        let short = |values: &[Option<f64>]| -> Vec<Option<f32>> {
            values.iter().map(|value| value.map(|value| value as f32)).collect()
        };
        let mean = frames.mean.iter().map(|&value| value as f32).collect();
        Self { mean, nmse: short(&frames.nmse), bias: short(&frames.bias) }
    }
}

/// Where a stream is, and how it is undone.
#[derive(Serialize)]
struct StreamEntry {
    id: String,
    #[serde(flatten)]
    prediction: Prediction,
}

/// Error numbers of a method.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Numbers {
    cube: Option<Metrics>,
    steady: Metrics,
    judged_cube: Option<Metrics>,
    judged_steady: Option<Metrics>,
}

/// Points of a curve over time: more than a chart has pixels. Results with more bins have points
/// for groups of them.
const CURVE_POINTS: usize = 1 << 12;

/// What is computed from the results at their full size, once.
pub(crate) struct Judgement {
    pub(crate) numbers: Option<Numbers>,
    pub(crate) frames: FrameCurves,
}

impl Judgement {
    pub(crate) fn new(comparison: &Comparison<'_>, method: &Method<'_>) -> Self {
        let reference = comparison.reference().filter(|_| !method.is_reference);
        let judged = comparison.judged.as_deref();
        let x = method.arrays;
        let of_cube = |r: &Method<'_>, judged| {
            let metrics = Metrics::of_cube(method.estimate(), r.estimate(), judged);
            if method.independent { metrics } else { metrics.without_noise() }
        };
        let numbers = reference.map(|r| Numbers {
            cube: (x.bins > 0).then(|| of_cube(r, None)),
            steady: Metrics::of_steady(x, r.arrays, None),
            judged_cube: judged.filter(|_| x.bins > 0).map(|judged| of_cube(r, Some(judged))),
            judged_steady: judged.map(|judged| Metrics::of_steady(x, r.arrays, Some(judged))),
        });
        let group = x.bins.div_ceil(CURVE_POINTS).max(1);
        let frames = FrameCurves::new(x, reference.map(|reference| reference.arrays), group);
        Self { numbers, frames }
    }
}

/// Streams with their names.
#[derive(Default)]
pub(crate) struct Streams<'a>(Vec<&'a Stream>);

impl<'a> Streams<'a> {
    fn enter(&mut self, streams: &'a [Stream]) -> Vec<StreamEntry> {
        let enter = |stream: &'a Stream| {
            self.0.push(stream);
            StreamEntry { id: name(self.0.len() - 1), prediction: stream.prediction }
        };
        streams.iter().map(enter).collect()
    }

    /// Names and streams.
    pub(crate) fn named(&self) -> impl Iterator<Item = (String, &'a Stream)> {
        self.0.iter().enumerate().map(|(index, stream)| (name(index), *stream))
    }
}

fn name(index: usize) -> String {
    format!("data-{index}")
}

/// The manifest of packed results and the streams that it names. `first` is the first result,
/// reduced.
pub(crate) fn manifest<'a>(
    comparison: &'a Comparison<'_>,
    factors: Factors,
    first: &'a Arrays,
    packed: &'a [PackedMethod],
    judgements: &'a [Judgement],
) -> (Manifest<'a>, Streams<'a>) {
    let mut streams = Streams::default();
    let methods = comparison.methods.iter().zip(packed).zip(judgements);
    let methods = methods
        .map(|((method, packed), judgement)| MethodEntry {
            key: &method.key,
            label: &method.label,
            reference: method.is_reference,
            batches: method.batches,
            interval: standard_errors(method.estimate().freedom()),
            independent: method.independent,
            unit_known: method.unit_known,
            caption: &method.caption,
            command: method.command.as_deref(),
            provenance: &method.provenance,
            cube: streams.enter(&packed.cube),
            errors: streams.enter(&packed.errors),
            before: streams.enter(&packed.before),
            after: streams.enter(&packed.after),
            steady: streams.enter(&packed.steady),
            numbers: judgement.numbers.as_ref(),
            frames: Curves::new(&judgement.frames),
        })
        .collect();
    let rendered = comparison.first();
    let curve_bins = judgements.first().map_or(1, |judgement| judgement.frames.group);
    let manifest = Manifest {
        title: &comparison.title,
        caption: &comparison.caption,
        program: concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")),
        quantity: rendered.quantity,
        timed: comparison.timed,
        shape: Shape::of(first),
        rendered: Shape::of(rendered),
        factors: [factors.pixels, factors.bins],
        edges: &first.opl_edges,
        curve_bins,
        curve_edges: (factors.bins != curve_bins)
            .then(|| edges_of_groups(&rendered.opl_edges, curve_bins)),
        code: Code {
            steps: code::STEPS,
            image_steps: code::IMAGE_STEPS,
            offset: code::OFFSET,
            error_steps: code::ERROR_STEPS,
            error_offset: code::ERROR_OFFSET,
        },
        epsilon: EPSILON,
        judged_label: comparison.judged.as_ref().map(|_| comparison.judged_label.as_str()),
        notes: &comparison.notes,
        methods,
    };
    (manifest, streams)
}
