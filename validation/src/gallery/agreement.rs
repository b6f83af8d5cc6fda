//! Do the methods agree on what they both render?
//!
//! Photon beams are compared with the path tracer and with the light tracer, each on what the plan
//! says that both render: all pixels, or, where the light tracer misses what stands in mirrors and
//! smooth glass, the pixels that look at none of these first. A method that misses other light is
//! not compared.
//!
//! What is judged: the steady energy of 4 x 3 blocks of the image, and the energy of all of it
//! before, in four parts of, and after the film's window. One film per batch and method; differences
//! of batch means against their spread ([`crate::statistics`]): Student's t, Holm, level 1e-6 for
//! each comparison. Beams are biased by their blur: an allowance for it, a part of each value, is no
//! difference. A verdict *equivalent* needs the interval within the margin as well; *unresolved*
//! means that noise hides what is smaller than the interval.
//!
//! Beams use the radii that they would choose for the scene's own film, and keep them; the film is
//! smaller, because only blocks are judged.

use tpb_beams::{BeamOptions, Settings};
use tpb_scene::load::LoadedScene;
use tpb_scene::{FilmSpec, Item, MethodName, Plan, Scene};

use crate::contrasts::LinearContrast;
use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::judged::is_plain;
use crate::measure::{BatchPlan, Estimator, batches, layout};
use crate::statistics::{Batches, Criterion, Judgement, Target, judge};

/// Blocks along the image's edges.
const BLOCKS: [usize; 2] = [4, 3];
/// Parts of the window.
const PARTS: usize = 4;

/// How a comparison is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Batches and passes of each, for both methods.
    pub plan: BatchPlan,
    /// The part of a value that blur may take or give.
    pub blur: f64,
    /// The difference, beyond blur, that is relevant.
    pub margin: f64,
}

/// Beams against another method.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The other method.
    pub method: &'static str,
    /// Why they cannot be compared, or what was found.
    pub found: std::result::Result<Judgement, String>,
    /// The part of pixels that is judged.
    pub judged: f64,
}

/// The methods beside beams.
const OTHERS: [(MethodName, &str); 2] = [(MethodName::Path, "path"), (MethodName::Light, "light")];

/// The method that renders most of what beams render, the path tracer before the light tracer.
///
/// # Errors
/// Why there is none: what each method leaves out.
pub fn companion(scene: &Scene) -> std::result::Result<&'static str, String> {
    let plan = Plan::new(scene, &scene.integrator);
    let (mut best, mut reasons) = (None, Vec::new());
    for (method, name) in OTHERS {
        let pixels = match overlap(scene, &plan, method) {
            Ok(pixels) => pixels.into_iter().filter(|&rendered| rendered).count(),
            Err(reason) => {
                reasons.push(format!("{name}: {reason}"));
                continue;
            }
        };
        if pixels > best.map_or(0, |(most, _)| most) {
            best = Some((pixels, name));
        }
    }
    best.map(|(_, name)| name).ok_or_else(|| reasons.join("; "))
}

/// Compares beams with each other method. `loaded` has the scene with the small film, `full` the
/// one with its own.
///
/// # Errors
/// If a film or a method refuses the scene.
pub fn agreements(
    loaded: &LoadedScene,
    full: &LoadedScene,
    terms: &Terms,
) -> Result<Vec<Agreement>> {
    let scene = &loaded.scene;
    let plan = Plan::new(scene, &scene.integrator);
    let beams = beams(&full.scene)?;
    let mut ours: Option<Vec<Cube>> = None;
    let mut all = Vec::new();
    for (method, name) in OTHERS {
        let pixels = match overlap(scene, &plan, method) {
            Ok(pixels) => pixels,
            Err(reason) => {
                all.push(Agreement { method: name, found: Err(reason), judged: 0.0 });
                continue;
            }
        };
        if ours.is_none() {
            ours = Some(cubes(scene, &beams, terms.plan)?);
        }
        let Some(ours) = &ours else { continue };
        let other = Estimator::of_name(name).expect("a method's name");
        let seeded = BatchPlan { seed: terms.plan.seed ^ 0xb1a5, ..terms.plan };
        let theirs = cubes(scene, &other, seeded)?;
        let judged = pixels.iter().filter(|&&judged| judged).count() as f64 / pixels.len() as f64;
        let found = compare(&scene.film, &pixels, (ours, &theirs), terms);
        all.push(Agreement { method: name, found: Ok(found), judged });
    }
    Ok(all)
}

/// Beams with the radii of the scene's own film.
fn beams(full: &Scene) -> Result<Estimator> {
    let plan = Plan::new(full, &full.integrator);
    let settings = Settings::new(full, &plan, &BeamOptions::default())
        .map_err(|error| ValidationError::unusable("photon beams", error))?;
    Ok(Estimator::Beams(BeamOptions {
        radius: Some(settings.radius),
        surface_radius: Some(settings.surface_radius),
        radius_exponent: Some(0.0),
        surface_radius_exponent: Some(0.0),
        ..BeamOptions::default()
    }))
}

fn cubes(scene: &Scene, estimator: &Estimator, plan: BatchPlan) -> Result<Vec<Cube>> {
    let mut cubes = Vec::new();
    batches(scene, estimator, layout(&scene.film, 0.0)?, &plan, |cube| cubes.push(cube.clone()))?;
    Ok(cubes)
}

/// The pixels that beams and this method both render whole, or why there are none.
fn overlap(
    scene: &Scene,
    plan: &Plan,
    method: MethodName,
) -> std::result::Result<Vec<bool>, String> {
    let lost = |method: MethodName| -> Vec<&Item> {
        let lost = |item: &&Item| item.loses_light && item.methods.contains(&method);
        plan.left_out.iter().filter(lost).collect()
    };
    if let Some(item) = lost(MethodName::Beams).first() {
        return Err(format!("beams leave out {}", item.part));
    }
    let pixels = scene.film.width * scene.film.height;
    match lost(method)[..] {
        [] => Ok(vec![true; pixels]),
        [_] if method == MethodName::Light => Ok((0..pixels).map(|p| is_plain(scene, p)).collect()),
        [item, ..] => Err(format!("it leaves out {}", item.part)),
    }
}

/// Judges batches against those of another method.
pub(crate) fn compare(
    film: &FilmSpec,
    judged: &[bool],
    (ours, theirs): (&[Cube], &[Cube]),
    terms: &Terms,
) -> Judgement {
    let channels = ours.first().map_or(1, |cube| cube.pixels() / judged.len());
    let contrasts = contrasts(film, judged, channels);
    let mean = |contrast: &LinearContrast| {
        theirs.iter().map(|cube| contrast.value(cube)).sum::<f64>() / theirs.len() as f64
    };
    // Nothing is said of cells that are dark for the other method.
    let (contrasts, expected): (Vec<_>, Vec<f64>) = contrasts
        .into_iter()
        .map(|contrast| (mean(&contrast), contrast))
        .filter(|(expected, _)| *expected > 0.0)
        .map(|(expected, contrast)| (contrast, expected))
        .unzip();
    let targets: Vec<Target> = contrasts
        .iter()
        .zip(&expected)
        .map(|(contrast, &expected)| Target {
            name: contrast.name.clone(),
            expected,
            error: terms.blur * expected,
        })
        .collect();
    let mut values = Batches::new();
    for (x, y) in ours.iter().zip(theirs) {
        let value = |(contrast, expected): (&LinearContrast, &f64)| {
            contrast.value(x) - contrast.value(y) + expected
        };
        values.push(contrasts.iter().zip(&expected).map(value).collect());
    }
    let margin = terms.blur + terms.margin;
    judge(&targets, &values, &Criterion { margin, confidence: 0.99, level: 1e-6 })
}

/// Blocks of the image, and parts of the time.
fn contrasts(film: &FilmSpec, judged: &[bool], channels: usize) -> Vec<LinearContrast> {
    let bins = film.time.map_or(0, |time| time.bins);
    let FilmSpec { width, height, .. } = *film;
    let block = |pixel: usize| {
        let (column, row) = (pixel % width, pixel / width);
        [column * BLOCKS[0] / width, row * BLOCKS[1] / height]
    };
    let pixels = |wanted: &dyn Fn(usize) -> bool| -> Vec<usize> {
        let ours = (0..judged.len()).filter(|&p| judged[p] && wanted(p));
        ours.flat_map(|p| (0..channels).map(move |c| p + c * judged.len())).collect()
    };
    let mut all = Vec::new();
    for (row, column) in (0..BLOCKS[1]).flat_map(|r| (0..BLOCKS[0]).map(move |c| (r, c))) {
        all.push(LinearContrast {
            name: format!("block {column}, {row}"),
            pixels: pixels(&|pixel| block(pixel) == [column, row]),
            weights: vec![1.0; bins + 2],
        });
    }
    let part = |cell: usize| match cell {
        0 => 0,
        cell if cell == bins + 1 => PARTS + 1,
        cell => 1 + (cell - 1) * PARTS / bins.max(1),
    };
    for k in 0..PARTS + 2 {
        let name = match k {
            0 => "before the window".to_owned(),
            k if k == PARTS + 1 => "after the window".to_owned(),
            k => format!("part {k} of {PARTS} of the window"),
        };
        let weights = (0..bins + 2).map(|cell| f64::from(u8::from(part(cell) == k))).collect();
        all.push(LinearContrast { name, pixels: pixels(&|_| true), weights });
    }
    all.retain(|contrast| !contrast.pixels.is_empty());
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Finding;

    const FILM: FilmSpec = FilmSpec {
        width: 8,
        height: 6,
        pixel_format: tpb_scene::PixelFormat::Rgb,
        time: Some(tpb_scene::TimeSpec { start_opl: 0.0, bin_width_opl: 1.0, bins: 10 }),
    };

    #[test]
    fn each_cell_is_judged_once_in_space_and_once_in_time() {
        let mut judged = vec![true; 48];
        judged[5] = false;
        let all = contrasts(&FILM, &judged, 3);
        assert_eq!(all.len(), 12 + PARTS + 2);
        for part in [&all[..12], &all[12..]] {
            let mut seen = vec![0.0; 3 * 48 * 12];
            for contrast in part {
                for (pixel, (cell, weight)) in contrast
                    .pixels
                    .iter()
                    .flat_map(|&pixel| contrast.weights.iter().enumerate().map(move |w| (pixel, w)))
                {
                    seen[pixel * 12 + cell] += weight;
                }
            }
            for (index, times) in seen.into_iter().enumerate() {
                let expected = if judged[index / 12 % 48] { 1.0 } else { 0.0 };
                assert_eq!(times, expected, "cell {index}");
            }
        }
    }

    /// Batches of noisy light, 5 % of it missing in one block.
    #[test]
    fn a_block_that_lacks_light_is_found() {
        let batch = |seed: u64, lacks: f64| -> Vec<Cube> {
            let mut rng = tpb_optics::Stream::new(seed, 0, 0);
            let mut cube = || {
                let mut cube = Cube::zero(8, 6, 10);
                for value in &mut cube.values {
                    *value = 0.9 + 0.2 * rng.uniform();
                }
                // Two pixels of the upper left block.
                for cell in cube.pixel_mut(0).iter_mut() {
                    *cell *= 1.0 - lacks;
                }
                cube
            };
            (0..32).map(|_| cube()).collect()
        };
        let plan = BatchPlan { batches: 32, passes: 1, seed: 0 };
        let terms = Terms { plan, blur: 0.005, margin: 0.01 };
        let found = |lacks: f64| {
            compare(&FILM, &[true; 48], (&batch(1, lacks), &batch(2, 0.0)), &terms).finding
        };
        assert_eq!(found(0.0), Finding::Equivalent);
        // A fourth of a block's light, so 5 % of the block.
        assert_eq!(found(0.2), Finding::Different);
    }
}
