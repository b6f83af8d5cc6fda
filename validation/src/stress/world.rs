//! Scenes as JSON, in a unit of one's own: what a user writes, through the loader that users meet.
//!
//! All numbers are given in units of the scene; [`Unit`] says how many metres a unit of length is
//! and how many watts a unit of power. Coefficients are per unit of length, so that a scene in
//! another unit is the same scene, with every number in the file changed.

use serde_json::{Map, Value, json};

/// What the numbers of a scene are measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Metres in a unit of length.
    pub length: f64,
    /// Watts in a unit of power, at unit length: radiance is in units of this alone, powers and
    /// intensities in this times the square of the length.
    pub light: f64,
}

impl Unit {
    /// Metres and watts.
    pub const SI: Self = Self { length: 1.0, light: 1.0 };

    /// So many metres.
    pub fn of_length(length: f64) -> Self {
        Self { length, ..Self::SI }
    }
}

/// The film of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// OPL of the first edge, in units.
    pub start: f64,
    /// OPL of a bin, in units.
    pub bin: f64,
    /// Number of bins; 0 for a steady film.
    pub bins: usize,
    /// Three channels.
    pub rgb: bool,
}

/// Coefficients per unit of length, and mean cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Scattering, per channel.
    pub sigma_s: [f64; 3],
    /// Absorption, per channel.
    pub sigma_a: [f64; 3],
    /// Mean cosine of the phase function.
    pub g: f64,
}

impl Fog {
    /// Without colour.
    pub fn grey(sigma_s: f64, sigma_a: f64, g: f64) -> Self {
        Self { sigma_s: [sigma_s; 3], sigma_a: [sigma_a; 3], g }
    }
}

/// A point.
pub type Point = [f64; 3];

/// A scene under construction.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// What its numbers are measured in.
    pub unit: Unit,
    json: Map<String, Value>,
}

impl World {
    /// An empty scene.
    pub fn new(unit: Unit) -> Self {
        let mut json = Map::new();
        json.insert("type".into(), "scene".into());
        Self { unit, json }
    }

    /// Adds an entry as it stands.
    #[must_use]
    pub fn with(mut self, name: &str, entry: Value) -> Self {
        self.json.insert(name.into(), entry);
        self
    }

    /// Which depths count; roulette is off before the last of them.
    #[must_use]
    pub fn depths(self, least: u32, most: u32) -> Self {
        let depths = json!({
            "type": "path", "min_depth": least, "max_depth": most, "rr_depth": most + 1,
        });
        self.with("integrator", depths)
    }

    /// A camera; `fov` in degrees, along the film's height.
    #[must_use]
    pub fn camera(self, origin: Point, target: Point, up: Point, fov: f64, film: Film) -> Self {
        let Film { width, height, start, bin, bins, rgb } = film;
        let camera = json!({
            "type": "perspective",
            "fov": fov,
            "fov_axis": "y",
            "to_world": [self.look_at(origin, target, up)],
            "film": {
                "type": "transient_hdr_film",
                "width": width,
                "height": height,
                "pixel_format": if rgb { "rgb" } else { "luminance" },
                "temporal_bins": bins,
                "start_opl": self.length(start),
                "bin_width_opl": self.length(bin),
            },
        });
        self.with("sensor", camera)
    }

    /// Fog that fills all space beyond boundaries.
    #[must_use]
    pub fn background(self, fog: Fog) -> Self {
        let fog = self.fog(fog, None);
        self.with("fog", fog).with("background", json!({"type": "ref", "id": "fog"}))
    }

    /// A medium of a refractive index.
    pub fn fog(&self, fog: Fog, eta: Option<f64>) -> Value {
        let per_metre = |sigma: [f64; 3]| sigma.map(|sigma| sigma / self.unit.length);
        let mut medium = json!({
            "type": "homogeneous",
            "sigma_s": per_metre(fog.sigma_s),
            "sigma_a": per_metre(fog.sigma_a),
            "phase": {"type": "hg", "g": fog.g},
        });
        if let Some(eta) = eta {
            medium["eta"] = eta.into();
        }
        medium
    }

    /// A point lamp of a power in units.
    #[must_use]
    pub fn point(self, name: &str, position: Point, power: f64) -> Self {
        let intensity = self.power(power) / (4.0 * std::f64::consts::PI);
        let lamp =
            json!({"type": "point", "position": self.place(position), "intensity": intensity});
        self.with(name, lamp)
    }

    /// A laser from `origin` towards `target`, of a radius and a power in units.
    #[must_use]
    pub fn laser(self, origin: Point, target: Point, radius: f64, power: f64) -> Self {
        // Any direction across will do.
        let along: Vec<f64> = (0..3).map(|i| (target[i] - origin[i]).abs()).collect();
        let up = if along[1] <= along[0].max(along[2]) { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
        let laser = json!({
            "type": "laser",
            "to_world": [self.look_at(origin, target, up)],
            "radius": self.length(radius),
            "power": self.power(power),
        });
        self.with("laser", laser)
    }

    /// A shape whose local coordinates are units: `to_world` steps come after the unit.
    #[must_use]
    pub fn shape(self, name: &str, kind: &str, steps: Value, rest: Value) -> Self {
        let mut all = vec![json!({"scale": self.unit.length})];
        if let Value::Array(steps) = steps {
            all.extend(steps.into_iter().map(|step| self.step(step)));
        }
        let mut shape = json!({"type": kind, "to_world": all});
        if let Value::Object(rest) = rest {
            for (key, value) in rest {
                shape[key] = value;
            }
        }
        self.with(name, shape)
    }

    /// Area emission of a radiance in units.
    pub fn shine(&self, radiance: f64) -> Value {
        json!({"type": "area", "radiance": radiance * self.unit.light})
    }

    /// A length in metres.
    pub fn length(&self, units: f64) -> f64 {
        units * self.unit.length
    }

    /// The text of the scene's file.
    pub fn text(&self) -> String {
        format!("{:#}", Value::Object(self.json.clone()))
    }

    fn power(&self, units: f64) -> f64 {
        units * self.unit.light * self.unit.length * self.unit.length
    }

    fn place(&self, point: Point) -> Point {
        point.map(|x| self.length(x))
    }

    /// A step of `to_world`, its offset in metres.
    fn step(&self, mut step: Value) -> Value {
        if let Some(offset) = step.get_mut("translate").and_then(Value::as_array_mut) {
            for value in offset {
                *value = self.length(value.as_f64().unwrap_or(f64::NAN)).into();
            }
        }
        step
    }

    fn look_at(&self, origin: Point, target: Point, up: Point) -> Value {
        json!({"look_at": {"origin": self.place(origin), "target": self.place(target), "up": up}})
    }
}
