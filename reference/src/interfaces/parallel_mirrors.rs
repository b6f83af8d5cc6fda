//! A point pulse between two parallel mirrors: one image after the other.
//!
//! The mirrors are the planes x = 0 ("first", reflectance r0) and x = W ("second", rW). The source at
//! x_s has the images (method of images; any textbook of optics)
//!
//! > x = 2jW + x_s, reflected |j| times by each mirror (`image_sign` = 1), and
//! > x = 2jW − x_s, reflected |j| + 1 and |j| times (j ≤ 0) or j − 1 and j times (j ≥ 1), first and
//! > second mirror (`image_sign` = −1),
//!
//! for every whole j (`image`); j = 0 with sign 1 is the source itself. An observer at x_o and at the
//! lateral distance ρ, r = √((x_o − x)² + ρ²) from an image, receives of it at the time r/c
//! ([`parallel_mirrors_time`] \[s\]) the fluence per energy ([`parallel_mirrors_weight`] \[1/m²\])
//!
//! > r0^a rW^b / (4π r²).
//!
//! Domain: source and observer between the mirrors; r > 0 for the weight. The reflectances do not
//! depend on the angle.

use crate::error::{Result, finite_result, non_negative, positive, require};
use serde::Deserialize;
use std::f64::consts::PI;

/// Inputs of an image between two mirrors.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParallelMirrors {
    /// Distance W of the mirrors \[m\].
    pub width: f64,
    /// Distance x_s of the source from the first mirror \[m\].
    pub source_x: f64,
    /// Distance x_o of the observer from the first mirror \[m\].
    pub observer_x: f64,
    /// Lateral distance ρ of source and observer \[m\].
    pub lateral: f64,
    /// Number j of the image.
    pub image: i32,
    /// 1 for the images 2jW + x_s, −1 for 2jW − x_s.
    pub image_sign: i32,
    /// Reflections a on the first mirror; they follow from the image, and are checked if given.
    pub bounces_first: Option<u32>,
    /// Reflections b on the second mirror, likewise.
    pub bounces_second: Option<u32>,
    /// Reflectance of the first mirror, at x = 0.
    pub first_reflectance: f64,
    /// Reflectance of the second mirror, at x = W.
    pub second_reflectance: f64,
    /// Speed of light c \[m/s\].
    pub speed: f64,
}

/// The time \[s\] when the light of an image arrives.
pub fn parallel_mirrors_time(input: &ParallelMirrors) -> Result<f64> {
    let image = Image::of(input)?;
    finite_result("parallel_mirrors", image.distance / input.speed)
}

/// The fluence per energy \[1/m²\] that an image adds.
pub fn parallel_mirrors_weight(input: &ParallelMirrors) -> Result<f64> {
    let Image { distance, first, second } = Image::of(input)?;
    require(distance > 0.0, "lateral", input.lateral, "above 0 where the image is the observer")?;
    let reflected = input.first_reflectance.powf(f64::from(first))
        * input.second_reflectance.powf(f64::from(second));
    finite_result("parallel_mirrors", reflected / (4.0 * PI) / distance / distance)
}

#[derive(Debug, Clone, Copy)]
struct Image {
    /// r.
    distance: f64,
    /// a.
    first: u32,
    /// b.
    second: u32,
}

impl Image {
    fn of(input: &ParallelMirrors) -> Result<Self> {
        let &ParallelMirrors { width, source_x, observer_x, lateral, image, image_sign, .. } =
            input;
        check(input)?;
        let pairs = image.unsigned_abs();
        let (first, second) = match (image_sign, image) {
            (1, _) => (pairs, pairs),
            (_, ..=0) => (pairs + 1, pairs),
            (_, 1..) => (pairs - 1, pairs),
        };
        let agree = |given: Option<u32>, bounces| given.is_none_or(|given| given == bounces);
        let requirement = "the one of the image, or left out";
        let given = |bounces: Option<u32>| bounces.map_or(f64::NAN, f64::from);
        let (a, b) = (input.bounces_first, input.bounces_second);
        require(agree(a, first), "bounces_first", given(a), requirement)?;
        require(agree(b, second), "bounces_second", given(b), requirement)?;
        // The source and the observer first: for the source itself their difference is exact.
        let along =
            (observer_x - f64::from(image_sign) * source_x) - 2.0 * f64::from(image) * width;
        Ok(Self { distance: along.hypot(lateral), first, second })
    }
}

fn check(input: &ParallelMirrors) -> Result<()> {
    let width = positive("width", input.width)?;
    let between = |name, x: f64| require((0.0..=width).contains(&x), name, x, "within 0 to width");
    between("source_x", input.source_x)?;
    between("observer_x", input.observer_x)?;
    non_negative("lateral", input.lateral)?;
    let sign = input.image_sign;
    require(matches!(sign, 1 | -1), "image_sign", f64::from(sign), "1 or -1")?;
    let reflectance = |name, r: f64| require((0.0..=1.0).contains(&r), name, r, "between 0 and 1");
    reflectance("first_reflectance", input.first_reflectance)?;
    reflectance("second_reflectance", input.second_reflectance)?;
    positive("speed", input.speed)?;
    Ok(())
}

#[cfg(test)]
#[path = "parallel_mirrors_tests.rs"]
mod tests;
