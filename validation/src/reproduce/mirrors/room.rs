//! The room of *Mirrors* as geometry: where lamp, ball and mirrors are, and when light is where.
//!
//! All is read from the scene, so that what captions say goes with it. OPL counts from the lamp to
//! the eye: |lamp − p| + |p − eye| for a front that comes straight to p, with the lamp's mirror image
//! in place of the lamp behind a plane mirror. Along the axis through lamp and ball, glass of index η
//! adds (η − 1)·2r. The paraxial focus behind the ball is at v from its centre,
//! 1/v = 1/f − 1/u, f = η r/(2(η − 1)), u the lamp's distance (thick lens; both principal planes are
//! at the centre).

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tpb_film::Arrays;
use tpb_scene::load::LoadedScene;
use tpb_scene::{Scene, Vertex};

use super::super::bin_of;
use super::seen;
use crate::error::{Result, ValidationError};

/// Pixels on each side of the place of an event that its light is looked for in, for each 64 pixels
/// of the film.
const AROUND: f64 = 0.5;

/// Rays from the lamp begin so far from its middle, for it may have a size \[m\].
const CLEAR: f64 = 0.1;

/// The room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// The eye \[m\].
    pub eye: DVec3,
    /// The lamp \[m\].
    pub lamp: DVec3,
    /// Centre of the ball \[m\].
    pub ball: DVec3,
    /// Radius of the ball \[m\].
    pub radius: f64,
    /// Index of the glass.
    pub eta: f64,
    /// Foot of the lamp on the left mirror \[m\].
    pub left: DVec3,
    /// Centre of the tilted mirror \[m\].
    pub tilted: DVec3,
    /// Where the axis through lamp and ball meets the floor \[m\].
    pub floor: DVec3,
    /// Foot of the lamp on the back wall \[m\].
    pub back: DVec3,
}

/// Something that happens in the sequence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// What.
    pub label: String,
    /// What is seen then, and where in the picture.
    #[serde(default)]
    pub seen: String,
    /// When its light is seen \[m\].
    pub opl: f64,
    /// The bin of that.
    pub bin: usize,
    /// Where, in pixels from the upper left corner.
    pub pixel: [f64; 2],
    /// Bin with the most light in the pixels around; `None` where no peak is expected, since other
    /// light is brighter there.
    pub peak: Option<usize>,
}

impl Room {
    /// Read from a scene with a `lamp`, a `ball` of `glass`, mirrors `left` and `tilted`.
    ///
    /// # Errors
    /// If the scene lacks one of them, or the lamp does not see them.
    pub fn of(loaded: &LoadedScene) -> Result<Self> {
        let (canonical, scene) = (&loaded.canonical, &loaded.scene);
        let lamp =
            place(canonical, "/lamp/position").or_else(|_| place(canonical, "/lamp/center"))?;
        let ball = place(canonical, "/ball/center")?;
        let steps = canonical.pointer("/tilted/to_world").and_then(Value::as_array);
        let moved = steps.into_iter().flatten().find_map(|step| step.get("translate"));
        let tilted =
            moved.and_then(vector).ok_or_else(|| missing("/tilted/to_world/…/translate"))?;
        let radius = number(canonical, "/ball/radius")?;
        let axis = (ball - lamp).normalize();
        Ok(Self {
            eye: scene.sensor.position,
            lamp,
            ball,
            radius,
            eta: number(canonical, "/glass/int_ior")?,
            left: landing(scene, lamp - CLEAR * DVec3::X, -DVec3::X, "left")?,
            tilted,
            floor: landing(scene, ball + 1.001 * radius * axis, axis, "floor")?,
            back: landing(scene, lamp - CLEAR * DVec3::Z, -DVec3::Z, "back")?,
        })
    }

    /// Unit direction from the lamp to the middle of the ball.
    pub fn axis(&self) -> DVec3 {
        (self.ball - self.lamp).normalize()
    }

    /// Where the axis enters the ball, and where it leaves it.
    pub fn poles(&self) -> [DVec3; 2] {
        [self.ball - self.radius * self.axis(), self.ball + self.radius * self.axis()]
    }

    /// The paraxial focus behind the ball.
    pub fn focus(&self) -> DVec3 {
        let f = self.eta * self.radius / (2.0 * (self.eta - 1.0));
        let u = self.lamp.distance(self.ball);
        self.ball + self.axis() / (1.0 / f - 1.0 / u)
    }

    /// What the glass adds to the OPL along the axis \[m\].
    pub fn delay(&self) -> f64 {
        (self.eta - 1.0) * 2.0 * self.radius
    }

    /// The lamp's image in the left mirror.
    pub fn image(&self) -> DVec3 {
        2.0 * self.left - self.lamp
    }

    /// OPL to the eye of light that comes straight from a (virtual) lamp to p \[m\].
    fn seen(&self, lamp: DVec3, p: DVec3) -> f64 {
        lamp.distance(p) + p.distance(self.eye)
    }

    /// OPL to the eye of light along the axis, through the ball, to p behind it \[m\].
    pub fn through(&self, p: DVec3) -> f64 {
        self.seen(self.lamp, p) + self.delay()
    }

    /// What happens when, in the order of time.
    pub fn events(&self, scene: &Scene, arrays: &Arrays) -> Vec<Event> {
        let [near, far] = self.poles();
        let straight = |p: DVec3| self.seen(self.lamp, p);
        let reflected = |p: DVec3| self.seen(self.image(), p);
        let list = [
            ("the front meets the glass ball", seen::BALL, near, straight(near), false),
            ("the front meets the left mirror", seen::LEFT, self.left, straight(self.left), false),
            (
                "the front meets the tilted mirror",
                seen::TILTED,
                self.tilted,
                straight(self.tilted),
                false,
            ),
            (
                "the front off the left mirror meets the ball",
                seen::REFLECTED,
                near,
                reflected(near),
                false,
            ),
            (
                "the light through the glass leaves the ball, late",
                seen::LEAVES,
                far,
                self.through(far),
                true,
            ),
            (
                "without glass it would be at the focus by now",
                seen::WITHOUT,
                self.focus(),
                straight(self.focus()),
                false,
            ),
            ("the front meets the back wall", seen::BACK, self.back, straight(self.back), false),
            (
                "the light through the glass is at its focus",
                seen::FOCUS,
                self.focus(),
                self.through(self.focus()),
                true,
            ),
            (
                "the caustic lights the floor",
                seen::CAUSTIC,
                self.floor,
                self.through(self.floor),
                true,
            ),
            (
                "the front off the left mirror meets the back wall",
                seen::RING,
                self.back,
                reflected(self.back),
                false,
            ),
        ];
        let mut events: Vec<Event> = list
            .into_iter()
            .filter_map(|(label, seen, place, opl, peak)| {
                let point = scene.sensor.project(place - self.eye)?;
                let pixel = [point.x, point.y];
                let peak = peak.then(|| brightest(arrays, pixel));
                let bin = bin_of(&arrays.opl_edges, opl);
                let [label, seen] = [label, seen].map(str::to_owned);
                Some(Event { label, seen, opl, bin, pixel, peak })
            })
            .collect();
        events.sort_by(|a, b| a.opl.total_cmp(&b.opl));
        events
    }
}

/// The bin with the most light in the pixels around a place.
fn brightest(arrays: &Arrays, [x, y]: [f64; 2]) -> usize {
    let side = AROUND * arrays.width as f64 / 64.0;
    let range = |at: f64, end: usize| {
        let first = (at - side).floor().max(0.0) as usize;
        first.min(end - 1)..((at + side).ceil() as usize).clamp(1, end)
    };
    let mut sums = vec![0.0; arrays.bins];
    for row in range(y, arrays.height) {
        for column in range(x, arrays.width) {
            let cells = arrays.pixel(row * arrays.width + column).chunks_exact(arrays.channels);
            for (sum, cell) in sums.iter_mut().zip(cells) {
                *sum += cell.iter().map(|&v| f64::from(v)).sum::<f64>();
            }
        }
    }
    (0..sums.len()).max_by(|&a, &b| sums[a].total_cmp(&sums[b])).unwrap_or(0)
}

/// Where a ray lands, on a shape of this name.
fn landing(scene: &Scene, from: DVec3, direction: DVec3, name: &str) -> Result<DVec3> {
    let start = Vertex { position: from, primitive: None, region: scene.sensor.region };
    let hit = scene.fly(&start, direction).hit;
    let found = hit.filter(|hit| scene.shape(hit.primitive).name == name);
    found.map(|hit| hit.position).ok_or_else(|| {
        ValidationError::unusable("the mirrors' room", format!("a ray should land on `{name}`"))
    })
}

fn missing(pointer: &str) -> ValidationError {
    ValidationError::unusable("the mirrors' room", format!("the scene has no {pointer}"))
}

fn number(canonical: &Value, pointer: &str) -> Result<f64> {
    canonical.pointer(pointer).and_then(Value::as_f64).ok_or_else(|| missing(pointer))
}

fn place(canonical: &Value, pointer: &str) -> Result<DVec3> {
    canonical.pointer(pointer).and_then(vector).ok_or_else(|| missing(pointer))
}

fn vector(value: &Value) -> Option<DVec3> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    <[f64; 3]>::try_from(numbers?).ok().map(DVec3::from_array)
}
