//! Glass slows light: the delay behind the ball, measured against its exact optical path length.
//!
//! The room of *Mirrors*, its lamp exchanged for a thin laser from the lamp's place through the
//! middle of the ball, fog that only absorbs, and light that met ball, ball and floor alone (depth 4):
//! what the eye sees of the spot on the floor arrives at one OPL. Its mean arrival (first moment of
//! the bins, whose width bounds what it cannot tell by half) is measured with the glass and with a
//! ball of index 1, and their difference compared with (η − 1)·2r. The way with glass is also
//! compared as a whole with the ball lens of `tpb_reference` (impact 0).
//!
//! Methods that can: photon beams and light tracing. No camera path connects to a laser.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use tpb_beams::BeamOptions;
use tpb_light::LightOptions;
use tpb_reference::interfaces::{BallLens, ball_lens_time};

use super::super::Options;
use super::NAME;
use super::room::Room;
use crate::cube::Cube;
use crate::error::{Result, ValidationError};
use crate::measure::{BatchPlan, Estimator, batches, layout};
use crate::statistics::batches::summarise;
use crate::statistics::student;
use crate::watch::Watch;

/// Radius of the laser \[m\].
const LASER: f64 = 0.001;
/// Width of a bin \[m\], and bins about the expected arrival.
const BIN: f64 = 0.0005;
const BINS: usize = 160;
/// The camera is turned to the spot, from where it is, with so narrow an angle \[degrees\].
const FOV: f64 = 2.0;
/// Film, batches, passes of each, photons of a pass.
const PIXELS: usize = 8;
const BATCHES: u64 = 16;
const PASSES: u64 = 4;
const PHOTONS: u64 = 4_000;
/// Confidence of intervals.
const CONFIDENCE: f64 = 0.99;

/// A measured delay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Delay {
    /// By which method.
    pub method: String,
    /// (η − 1)·2r \[m\].
    pub exact: f64,
    /// Difference of mean arrivals with and without glass \[m\].
    pub measured: f64,
    /// Half of its 99 % interval, noise alone \[m\].
    pub half: f64,
    /// What bins cannot tell \[m\]: half a bin for each of the two arrivals.
    pub resolution: f64,
    /// Mean arrival with glass \[m\].
    pub arrival: f64,
    /// The same by the exact ball lens \[m\].
    pub exact_arrival: f64,
}

impl Delay {
    /// Whether measured and exact delay and arrival agree within interval and resolution.
    pub fn agrees(&self) -> bool {
        let bound = self.half + self.resolution;
        (self.measured - self.exact).abs() <= bound
            && (self.arrival - self.exact_arrival).abs() <= bound
    }
}

/// Measures it by each method that can.
///
/// # Errors
/// If the scene cannot be changed so, or no light arrives where it should.
pub fn measure(options: &Options, room: &Room, watch: &mut Watch<'_>) -> Result<Vec<Delay>> {
    let light = LightOptions { photons_per_pass: Some(PHOTONS) };
    let beams = BeamOptions {
        photons_per_pass: Some(PHOTONS),
        surface_radius: Some(0.01),
        surface_samples: Some(64),
        ..BeamOptions::default()
    };
    let mut delays = Vec::new();
    for estimator in [Estimator::Light(light), Estimator::Beams(beams)] {
        let delay = one(options, room, &estimator)?;
        watch.tell(&format!(
            "  {}: {:.5} ± {:.5} m, exact {:.5} m; {}",
            delay.method,
            delay.measured,
            delay.half,
            delay.exact,
            if delay.agrees() { "agrees" } else { "DIFFERS" }
        ));
        delays.push(delay);
    }
    Ok(delays)
}

fn one(options: &Options, room: &Room, estimator: &Estimator) -> Result<Delay> {
    let with = arrivals(options, room, estimator, room.eta)?;
    let without = arrivals(options, room, estimator, 1.0)?;
    let (a, b) = (summarise(&with), summarise(&without));
    let t = student::quantile(0.5 * (1.0 - CONFIDENCE), BATCHES as f64 - 1.0);
    Ok(Delay {
        method: estimator.name().to_owned(),
        exact: room.delay(),
        measured: a.mean - b.mean,
        half: t * a.standard_error.hypot(b.standard_error),
        resolution: BIN,
        arrival: a.mean,
        exact_arrival: exact(room, room.eta)?,
    })
}

/// OPL from the lamp along the axis through the ball to the floor and to the eye.
fn exact(room: &Room, eta: f64) -> Result<f64> {
    let distance = room.radius;
    let ball = BallLens { impact: 0.0, eta, radius: room.radius, distance, speed: 1.0 };
    let [near, far] = room.poles();
    Ok(room.lamp.distance(near)
        + ball_lens_time(&ball)?
        + far.distance(room.floor)
        + room.floor.distance(room.eye))
}

/// Mean arrival of each batch.
fn arrivals(options: &Options, room: &Room, estimator: &Estimator, eta: f64) -> Result<Vec<f64>> {
    let vector = |v: DVec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
    let start = exact(room, eta)? - 0.5 * BIN * BINS as f64;
    let changes = [
        format!(
            "lamp={{\"type\": \"laser\", \"radius\": {LASER}, \"to_world\": [{{\"look_at\": \
             {{\"origin\": {}, \"target\": {}, \"up\": [0, 0, 1]}}}}]}}",
            vector(room.lamp),
            vector(room.ball)
        ),
        "fog.albedo=0".to_owned(),
        format!("glass.int_ior={eta}"),
        "integrator.min_depth=4".to_owned(),
        "integrator.max_depth=4".to_owned(),
        "sensor.film.pixel_format=luminance".to_owned(),
        format!("sensor.film.start_opl={start}"),
        format!("sensor.fov={FOV}"),
        format!("sensor.to_world.0.look_at.target={}", vector(room.floor)),
    ];
    let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
    let film = Options { pixels: Some(PIXELS), bins: None, ..options.clone() };
    let mut loaded = film.load(NAME, &changes)?;
    if let Some(time) = &mut loaded.scene.film.time {
        (time.bin_width_opl, time.bins) = (BIN, BINS);
    }
    let plan = BatchPlan { batches: BATCHES, passes: PASSES, seed: options.circumstances.seed };
    let mut means = Vec::new();
    let layout = layout(&loaded.scene.film, 0.0)?;
    batches(&loaded.scene, estimator, layout, &plan, |cube| means.push(mean_arrival(cube, start)))?;
    if means.iter().any(|mean| !mean.is_finite()) {
        let reason = "no light arrives through the ball";
        return Err(ValidationError::unusable("the delay behind the ball", reason));
    }
    Ok(means)
}

/// First moment of all light within the window.
fn mean_arrival(cube: &Cube, start: f64) -> f64 {
    let (mut energy, mut moment) = (0.0, 0.0);
    for (bin, sum) in cube.sum_of_pixels().iter().enumerate() {
        energy += sum;
        moment += sum * (start + BIN * (bin as f64 + 0.5));
    }
    moment / energy
}
