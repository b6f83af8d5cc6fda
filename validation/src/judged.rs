//! Who referees a comparison of whole images, and which pixels it can judge.
//!
//! Pixels that see an emitter, directly or through mirrors and glass, are not judged: there a few
//! cells hold nearly all of the power, and the rest of the image would not count. Nor are those in
//! which a point stands: the fog around it is infinitely bright.

use std::num::NonZeroU32;

use tpb_light::LightOptions;
use tpb_optics::{Coefficients, Spectrum};
use tpb_path::PathOptions;
use tpb_render::{Budget, RunSettings};
use tpb_scene::{Bsdf, EmitterKind, Plan, Reflector, Scene, Transport};

use crate::cube::dilate;
use crate::error::Result;
use crate::measure::{Estimator, layout, render};

/// Camera paths that look for emitters: so many per pixel at most, and as many per area of a larger
/// film as of one of 64x64 pixels.
const MASK_SAMPLES: usize = 4096;
const MASK_PIXELS: usize = 64 * 64;

/// Rays along each side of a pixel that look for mirrors and glass.
const GRID: usize = 4;

/// An unbiased method that others are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Referee {
    /// The path tracer: all light but caustics of points, spots and lasers.
    Path,
    /// The light tracer: all light but what is seen in mirrors and through glass.
    Light,
}

impl Referee {
    /// The method, with default options.
    pub fn estimator(self) -> Estimator {
        match self {
            Self::Path => Estimator::Path(PathOptions::default()),
            Self::Light => Estimator::Light(LightOptions::default()),
        }
    }

    /// [`Referee::judged`] with as many channels as the scene needs.
    ///
    /// # Errors
    /// [`crate::ValidationError`] if the scene cannot be rendered.
    pub fn judged_of(self, scene: &Scene) -> Result<Vec<bool>> {
        match Plan::new(scene, &scene.integrator).transport {
            Transport::Mono => self.judged::<1>(scene),
            Transport::Rgb => self.judged::<3>(scene),
        }
    }

    /// Which pixels it judges, row by row: those within one pixel of which no emitter is seen, and
    /// for the light tracer neither mirrors nor glass.
    ///
    /// # Errors
    /// [`crate::ValidationError`] if the scene cannot be rendered.
    pub fn judged<const C: usize>(self, scene: &Scene) -> Result<Vec<bool>> {
        let lamps = sees_no_emitter::<C>(scene)?;
        Ok(match self {
            Self::Path => lamps,
            Self::Light => {
                lamps.into_iter().zip(sees_no_mirror(scene)).map(|(a, b)| a && b).collect()
            }
        })
    }
}

/// Pixels within one pixel of which no emitter is seen, directly or through mirrors and glass (where
/// nothing scatters, what arrives is emission), and in which no point or spot stands.
fn sees_no_emitter<const C: usize>(scene: &Scene) -> Result<Vec<bool>> {
    let scene = without_scattering(scene);
    let plan = Plan::new(&scene, &scene.integrator);
    let pixels = scene.film.width * scene.film.height;
    let samples = MASK_SAMPLES.min(MASK_SAMPLES * MASK_PIXELS / pixels).max(16);
    let options =
        PathOptions { samples_per_pass: u32::try_from(samples).ok().and_then(NonZeroU32::new) };
    let method = Estimator::Path(options).prepare::<C>(&scene, &plan, scene.integrator)?;
    let mut layout = layout(&scene.film, 0.0)?;
    layout.time = None;
    let settings = RunSettings { seed: 0, budget: Budget::Passes(1), first_pass: 0 };
    let (arrays, _) = render(&*method, layout, &settings)?;
    let mut lit: Vec<bool> =
        arrays.steady.chunks_exact(arrays.channels).map(|p| p.iter().any(|&v| v > 0.0)).collect();
    for emitter in &scene.emitters {
        if let EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } =
            emitter.kind
            && let Some(at) = scene.sensor.project(position - scene.sensor.position)
        {
            lit[at.y as usize * layout.width + at.x as usize] = true;
        }
    }
    Ok(dilate(&lit, layout.width, layout.height).into_iter().map(|near| !near).collect())
}

/// The scene with clear media, and black wherever surfaces scatter.
fn without_scattering(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for medium in &mut scene.media {
        medium.coefficients = Coefficients { sigma_s: Spectrum::ZERO, sigma_t: Spectrum::ZERO };
    }
    let smooth = |side| if let Reflector::Mirror(_) = side { side } else { Reflector::Black };
    for shape in &mut scene.shapes {
        shape.bsdf = match shape.bsdf {
            Bsdf::Opaque { front, back } => {
                Bsdf::Opaque { front: smooth(front), back: smooth(back) }
            }
            Bsdf::RoughDielectric(..) => {
                Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black }
            }
            smooth => smooth,
        };
    }
    scene
}

/// Pixels within one pixel of which neither a mirror nor glass is seen, row by row.
pub fn sees_no_mirror(scene: &Scene) -> Vec<bool> {
    let (width, height) = (scene.film.width, scene.film.height);
    let seen: Vec<bool> = (0..width * height).map(|pixel| !is_plain(scene, pixel)).collect();
    dilate(&seen, width, height).into_iter().map(|near| !near).collect()
}

/// Whether nothing smooth, mirror or glass, is what a pixel looks at.
pub(crate) fn is_plain(scene: &Scene, pixel: usize) -> bool {
    let (x, y) = (pixel % scene.film.width, pixel / scene.film.width);
    let at = |i: usize| (i as f64 + 0.5) / GRID as f64;
    (0..GRID * GRID).all(|i| {
        let direction = scene.sensor.direction(x as f64 + at(i % GRID), y as f64 + at(i / GRID));
        scene.fly(&scene.eye(), direction).hit.is_none_or(|hit| {
            let bsdf = &scene.shape(hit.primitive).bsdf;
            !(bsdf.is_mirror() || bsdf.is_smooth_glass())
        })
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// The lamp of mirror-caustic is seen directly, and as a speck in the mirror ball.
    #[test]
    fn pixels_that_see_a_lamp_in_a_mirror_are_not_judged() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let loaded = crate::scenes::shipped(&folder.join("mirror-caustic.json")).unwrap();
        let judged = Referee::Path.judged::<1>(&loaded.scene).unwrap();
        let sensor = &loaded.scene.sensor;
        let seen = |point: DVec3| {
            let at = sensor.project(point - sensor.position).unwrap();
            at.y as usize * loaded.scene.film.width + at.x as usize
        };
        let (lamp, ball) = (DVec3::new(0.3, 0.8, 0.1), DVec3::new(-0.5, -0.55, -0.3));
        let mut point = ball;
        for _ in 0..50 {
            let half = (lamp - point).normalize() + (sensor.position - point).normalize();
            point = ball + 0.4 * half.normalize();
        }
        assert!(!judged[seen(lamp)] && !judged[seen(point)]);
        let elsewhere = DVec3::new(0.0, -0.9, 0.9);
        assert!(judged[seen(elsewhere)]);
        // The light tracer does not see what stands in the ball at all.
        let (judged, centre) = (Referee::Light.judged::<1>(&loaded.scene).unwrap(), seen(ball));
        assert!(!judged[seen(lamp)] && !judged[seen(point)] && !judged[centre]);
        assert!(judged[seen(elsewhere)]);
    }
}
