//! A ray through a ball lens, from a plane before it to a plane behind it.
//!
//! The ball (radius R, index η relative to air) sits at the origin. A ray parallel to the axis
//! starts on the plane z = −L at the height h, is refracted into the ball and out of it, and lands on
//! the plane z = +L. With sin θi = h/R and sin θt = h/(η R) it crosses a chord of length 2R cos θt
//! and is deviated by 2(θi − θt) towards the axis (Descartes 1637). It leaves the ball at
//! (z_e, y_e) = R (cos(2θt − θi), sin(2θt − θi)) and lands at
//!
//! > y = y_e − (L − z_e) tan 2(θi − θt)
//!
//! ([`ball_lens_landing`] \[m\]) after the time ([`ball_lens_time`] \[s\], c: speed in air)
//!
//! > t = (L − √(R² − h²) + 2 η R cos θt + (L − z_e)/cos 2(θi − θt)) / c.
//!
//! θi − θt comes from its sine, (h/R)(η² − 1)/(η (q + μ)) with μ = cos θi and q = η cos θt, so that it
//! has its digits as η → 1. Domain: |h| ≤ R, |h| ≤ η R, L ≥ R, and a deviation below 90°: other rays
//! do not reach the plane.

use crate::error::{Result, finite, finite_result, positive, require};
use serde::Deserialize;

/// Inputs of a ray through a ball lens.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallLens {
    /// Height h of the ray above the axis \[m\].
    pub impact: f64,
    /// Index η of the ball, relative to air.
    pub eta: f64,
    /// Radius R of the ball \[m\].
    pub radius: f64,
    /// Distance L of both planes from the centre \[m\].
    pub distance: f64,
    /// Speed of light c in air \[m/s\].
    pub speed: f64,
}

/// The time \[s\] from plane to plane.
pub fn ball_lens_time(input: &BallLens) -> Result<f64> {
    let path = trace(input)?;
    let air =
        (input.distance / input.radius - path.cos_incidence) + path.behind / path.cos_deviation;
    let optical = air + 2.0 * path.q;
    finite_result("ball_lens", optical * (input.radius / input.speed))
}

/// The height \[m\] at which the ray lands; negative beyond the axis.
pub fn ball_lens_landing(input: &BallLens) -> Result<f64> {
    let path = trace(input)?;
    let height = path.exit_height - path.behind * (path.sin_deviation / path.cos_deviation);
    finite_result("ball_lens", height * input.radius)
}

/// The way of a ray; lengths in radii.
#[derive(Debug, Clone, Copy)]
struct Path {
    /// cos θi.
    cos_incidence: f64,
    /// η cos θt: half the optical length in the ball.
    q: f64,
    /// y_e.
    exit_height: f64,
    /// L − z_e: from the exit to the plane, along the axis.
    behind: f64,
    sin_deviation: f64,
    cos_deviation: f64,
}

fn trace(input: &BallLens) -> Result<Path> {
    let &BallLens { impact, eta, radius, distance, speed } = input;
    positive("eta", eta)?;
    positive("radius", radius)?;
    positive("speed", speed)?;
    finite("impact", impact)?;
    require(distance.is_finite() && distance >= radius, "distance", distance, "at least radius")?;
    let height = impact / radius;
    let hits = height.abs() <= eta.min(1.0);
    require(hits, "impact", impact, "at most radius, and at most eta * radius")?;
    let cos_incidence = ((1.0 - height) * (1.0 + height)).sqrt();
    let q = ((eta - height) * (eta + height)).sqrt();
    let (sin_t, cos_t) = (height / eta, q / eta);
    // Half the deviation, θi − θt. Grazing light at equal indices passes straight.
    let sum = q + cos_incidence;
    let sine = if sum > 0.0 { sin_t * (eta - 1.0) * ((eta + 1.0) / sum) } else { 0.0 };
    let cosine = cos_incidence * cos_t + height * sin_t;
    let cos_deviation = (cosine - sine) * (cosine + sine);
    require(cos_deviation > 0.0, "impact", impact, "such that the ray still runs to the plane")?;
    Ok(Path {
        cos_incidence,
        q,
        exit_height: sin_t * cosine - cos_t * sine,
        behind: distance / radius - (cos_t * cosine + sin_t * sine),
        sin_deviation: 2.0 * sine * cosine,
        cos_deviation,
    })
}

#[cfg(test)]
#[path = "ball_lens_tests.rs"]
mod tests;
