//! Our scene JSON in Mitsuba's words: a dictionary for `mitsuba.load_dict`, as JSON.
//!
//! The vocabulary is Mitsuba's, so most of it stays. What changes:
//!
//! * `to_world` and `to_uv` become row-major matrices; relative files become absolute.
//! * Colours as lists become `rgb`; `sigma_s` and `sigma_a` become `sigma_t`, `albedo` and `scale`
//!   (Mitsuba takes `rgb` up to 1, so that `scale` carries the size).
//! * The integrator is `transient_prbvolpath`, mitransient's one that sees media, with our depths.
//! * The film is `transient_hdr_film`. Its optical path lengths start at the near clip plane, ours at the
//!   eye: the plane is put at [`NEAR_CLIP`] and the window begins as much earlier. Off the axis by an angle a, what
//!   remains is `NEAR_CLIP` (1/cos a − 1): 0.15 mm at 30 degrees.
//! * The media that lamps stand in are left out: the peer finds them on its way there.
//!
//! What has no counterpart is refused with its JSON path and the reason.

use std::path::Path;

use serde_json::{Map, Value, json};
use tpb_scene::load::{LoadedScene, to_world};
use tpb_scene::{PixelFormat, Plan, Scene, Transport};

/// Distance of the peer's near clip plane \[m\].
pub const NEAR_CLIP: f64 = 1e-3;

/// A scene that the peer can load.
#[derive(Clone, Debug, PartialEq)]
pub struct Translation {
    /// The dictionary.
    pub dictionary: Value,
    /// The variant of Mitsuba that has as many channels as the scene needs.
    pub variant: &'static str,
}

/// What cannot be translated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{path}`: {reason}")]
pub struct Refusal {
    /// Where it stands in the scene file.
    pub path: String,
    /// Why.
    pub reason: String,
}

type Outcome<T> = Result<T, Refusal>;

/// What becomes of a parameter.
#[derive(Clone, Copy)]
enum Rule {
    Same,
    /// A number, which must not look whole to Mitsuba, or a name.
    Ior,
    Colour,
    /// A colour or a texture.
    Texture,
    Transform,
    File,
    Plugin,
    Dropped,
}

use Rule::{Colour, Dropped, File, Ior, Plugin, Same, Texture, Transform};

/// Parameters of every shape.
const SHAPE: &[(&str, Rule)] = &[
    ("to_world", Transform),
    ("flip_normals", Same),
    ("bsdf", Plugin),
    ("emitter", Plugin),
    ("interior", Plugin),
    ("exterior", Plugin),
];

/// Parameters of a plugin whose words need no second look.
fn rules(plugin: &str) -> Option<Vec<(&'static str, Rule)>> {
    let own: &[(&'static str, Rule)] = match plugin {
        "rectangle" | "cube" | "disk" | "null" | "isotropic" => &[],
        "sphere" => &[("center", Same), ("radius", Same)],
        "cylinder" => &[("p0", Same), ("p1", Same), ("radius", Same)],
        "obj" | "ply" => &[("filename", File), ("face_normals", Same), ("flip_tex_coords", Same)],
        "area" => &[("radiance", Colour)],
        "spot" => &[
            ("to_world", Transform),
            ("intensity", Colour),
            ("cutoff_angle", Same),
            ("beam_width", Same),
            ("medium", Dropped),
        ],
        "diffuse" => &[("reflectance", Texture)],
        "checkerboard" => &[("color0", Colour), ("color1", Colour), ("to_uv", Transform)],
        "bitmap" => &[
            ("filename", File),
            ("filter_type", Same),
            ("wrap_mode", Same),
            ("raw", Same),
            ("to_uv", Transform),
        ],
        "conductor" | "roughconductor" => &[
            ("material", Same),
            ("eta", Colour),
            ("k", Colour),
            ("distribution", Same),
            ("alpha", Same),
            ("alpha_u", Same),
            ("alpha_v", Same),
            ("specular_reflectance", Colour),
        ],
        "dielectric" | "thindielectric" | "roughdielectric" => &[
            ("int_ior", Ior),
            ("ext_ior", Ior),
            ("distribution", Same),
            ("alpha", Same),
            ("alpha_u", Same),
            ("alpha_v", Same),
            ("specular_reflectance", Colour),
            ("specular_transmittance", Colour),
        ],
        "hg" => &[("g", Same)],
        "ref" => &[("id", Same)],
        _ => return None,
    };
    let shape =
        matches!(plugin, "rectangle" | "cube" | "disk" | "sphere" | "cylinder" | "obj" | "ply");
    Some([own, if shape { SHAPE } else { &[] }].concat())
}

/// Translates a scene whose files stand in `directory`.
///
/// # Errors
/// [`Refusal`] for what the peer does not have, or has in another meaning.
pub fn translate(loaded: &LoadedScene, directory: &Path) -> Outcome<Translation> {
    let scene = &loaded.scene;
    let transport = Plan::new(scene, &scene.integrator).transport;
    if transport == Transport::Rgb && scene.film.pixel_format == PixelFormat::Luminance {
        return refuse("$.sensor.film.pixel_format", "one channel of a coloured scene");
    }
    let translator = Translator { scene, directory };
    let mut dictionary = Map::from_iter([
        ("type".to_owned(), json!("scene")),
        ("integrator".to_owned(), integrator(scene)?),
    ]);
    for (key, value) in loaded.canonical.as_object().into_iter().flatten() {
        let path = &format!("$.{key}");
        let translated = match key.as_str() {
            "type" | "integrator" => continue,
            "background" => {
                return refuse(
                    path,
                    "extension; the peer has vacuum where no shape says otherwise",
                );
            }
            _ if value["type"] == "perspective" => translator.sensor(value, path)?,
            _ => translator.plugin(value, path)?,
        };
        dictionary.insert(key.clone(), translated);
    }
    let variant = if transport == Transport::Mono { "llvm_ad_mono" } else { "llvm_ad_rgb" };
    Ok(Translation { dictionary: dictionary.into(), variant })
}

fn refuse<T>(path: &str, reason: impl Into<String>) -> Outcome<T> {
    Err(Refusal { path: path.to_owned(), reason: reason.into() })
}

fn integrator(scene: &Scene) -> Outcome<Value> {
    let depths = &scene.integrator;
    if depths.min_depth > 1 {
        return refuse("$.integrator.min_depth", "extension; the peer counts all shorter paths");
    }
    Ok(json!({
        "type": "transient_prbvolpath",
        "max_depth": depths.max_depth.map_or(-1, i64::from),
        "rr_depth": depths.rr_depth,
    }))
}

struct Translator<'a> {
    scene: &'a Scene,
    directory: &'a Path,
}

impl Translator<'_> {
    fn sensor(&self, sensor: &Value, path: &str) -> Outcome<Value> {
        let Scene { film, sensor: camera, .. } = self.scene;
        let Some(time) = film.time else {
            return refuse(&format!("{path}.film"), "a film without time bins");
        };
        if camera.region.eta != 1.0 {
            return refuse(
                path,
                "the camera stands in glass or liquid; the peer starts at index 1",
            );
        }
        let mut found = json!({
            "type": "perspective",
            "near_clip": NEAR_CLIP,
            "sampler": { "type": "independent" },
            "film": {
                "type": "transient_hdr_film",
                "width": film.width,
                "height": film.height,
                "temporal_bins": time.bins,
                "start_opl": time.start_opl - NEAR_CLIP,
                "bin_width_opl": time.bin_width_opl,
                "rfilter": { "type": "box" },
            },
        });
        let rules = [
            ("fov", Same),
            ("fov_axis", Same),
            ("to_world", Transform),
            ("film", Dropped),
            ("medium", Plugin),
        ];
        for (key, value) in self.parameters(sensor, &rules, path)? {
            found[key] = value;
        }
        Ok(found)
    }

    fn plugin(&self, object: &Value, path: &str) -> Outcome<Value> {
        let name = object["type"].as_str().unwrap_or_default();
        let mut found = match name {
            "homogeneous" => return self.medium(object, path),
            "point" => return self.point(object, path),
            "twosided" => return self.twosided(object, path),
            "laser" => {
                return refuse(path, "extension `laser`; the peer has no beam of finite radius");
            }
            "directional" => {
                return refuse(path, "`directional`: there it arrives everywhere at one time");
            }
            _ => match rules(name) {
                Some(rules) => self.parameters(object, &rules, path)?,
                None => return refuse(path, format!("`{name}` has no translation")),
            },
        };
        found.insert("type".to_owned(), json!(name));
        Ok(found.into())
    }

    /// All parameters of an object but its type.
    fn parameters(
        &self,
        object: &Value,
        rules: &[(&str, Rule)],
        path: &str,
    ) -> Outcome<Map<String, Value>> {
        let mut found = Map::new();
        for (key, value) in object.as_object().into_iter().flatten().filter(|(k, _)| *k != "type") {
            let place = format!("{path}.{key}");
            let Some((_, rule)) = rules.iter().find(|(name, _)| name == key) else {
                return refuse(&place, "has no translation");
            };
            let translated = match rule {
                Same => value.clone(),
                Ior => value.as_f64().map_or_else(|| value.clone(), |index| json!(index)),
                Texture if rgb_of(value).is_none() => self.plugin(value, &place)?,
                Colour | Texture => colour(value, &place)?,
                Transform => transform(value, &place)?,
                File => json!(self.directory.join(value.as_str().unwrap_or_default())),
                Plugin => self.plugin(value, &place)?,
                Dropped => continue,
            };
            found.insert(key.clone(), translated);
        }
        Ok(found)
    }

    /// A point lamp by its position, however that is given.
    fn point(&self, lamp: &Value, path: &str) -> Outcome<Value> {
        let rules =
            [("position", Same), ("to_world", Dropped), ("intensity", Colour), ("medium", Dropped)];
        let mut found = self.parameters(lamp, &rules, path)?;
        if let Some(steps) = lamp.get("to_world") {
            let matrix = transform(steps, &format!("{path}.to_world"))?;
            let origin: Vec<&Value> = (0..3).map(|row| &matrix[row][3]).collect();
            found.insert("position".to_owned(), json!(origin));
        }
        found.insert("type".to_owned(), json!("point"));
        Ok(found.into())
    }

    /// Mitsuba takes the front first, by the order of the keys.
    fn twosided(&self, bsdf: &Value, path: &str) -> Outcome<Value> {
        let mut sides = self.parameters(bsdf, &[("bsdf", Plugin), ("back", Plugin)], path)?;
        let mut found = json!({ "type": "twosided" });
        for (side, name) in [("bsdf", "side_1_front"), ("back", "side_2_back")] {
            if let Some(side) = sides.remove(side) {
                found[name] = side;
            }
        }
        Ok(found)
    }

    fn medium(&self, medium: &Value, path: &str) -> Outcome<Value> {
        if medium.get("eta").is_some_and(|eta| eta.as_f64() != Some(1.0)) {
            return refuse(&format!("{path}.eta"), "extension; the peer's media have index 1");
        }
        let number = |key: &str, default: f64| medium.get(key).map_or(Some([default; 3]), rgb_of);
        let keys = ["sigma_s", "sigma_a", "sigma_t", "albedo", "scale"];
        let (Some(s), Some(a), Some(t), Some(albedo), Some(scale)) = (
            number(keys[0], 0.0),
            number(keys[1], 0.0),
            number(keys[2], 1.0),
            number(keys[3], 0.75),
            number(keys[4], 1.0),
        ) else {
            return refuse(path, "coefficients that are neither numbers nor colours");
        };
        let split = medium.get("sigma_s").is_some();
        let channel = |c: usize| if split { s[c] + a[c] } else { t[c] };
        let extinction = [0, 1, 2].map(channel);
        let part = |c: usize| if extinction[c] > 0.0 { s[c] / extinction[c] } else { 0.0 };
        let albedo = if split { [0, 1, 2].map(part) } else { albedo };
        let largest = extinction.iter().copied().fold(0.0, f64::max);
        let unit = if largest > 0.0 { largest } else { 1.0 };
        let mut found = json!({
            "type": "homogeneous",
            "sigma_t": spectrum(extinction.map(|x| x / unit)),
            "albedo": spectrum(albedo),
            "scale": scale[0] * unit,
        });
        let rules = [("phase", Plugin), ("eta", Dropped)];
        let rules = [&rules[..], &keys.map(|key| (key, Dropped))].concat();
        for (key, value) in self.parameters(medium, &rules, path)? {
            found[key] = value;
        }
        Ok(found)
    }
}

/// The map of a list of steps, row by row.
fn transform(steps: &Value, path: &str) -> Outcome<Value> {
    let Some(map) = to_world(steps) else { return refuse(path, "no list of steps") };
    let linear = map.matrix3;
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis, map.translation];
    let rows = [0, 1, 2].map(|row| columns.map(|column| column[row]));
    Ok(json!([rows[0], rows[1], rows[2], [0.0, 0.0, 0.0, 1.0]]))
}

fn colour(value: &Value, path: &str) -> Outcome<Value> {
    match rgb_of(value) {
        Some(rgb) => Ok(spectrum(rgb)),
        None => refuse(path, "neither a number nor a colour"),
    }
}

/// A number where all channels are alike.
fn spectrum(rgb: [f64; 3]) -> Value {
    if rgb == [rgb[0]; 3] { json!(rgb[0]) } else { json!({ "type": "rgb", "value": rgb }) }
}

/// A number, a list, or an object that says so of one.
fn rgb_of(value: &Value) -> Option<[f64; 3]> {
    match value {
        Value::Number(number) => number.as_f64().map(|number| [number; 3]),
        Value::Array(list) => {
            let channels: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
            channels?.try_into().ok()
        }
        Value::Object(object)
            if matches!(object.get("type")?.as_str()?, "rgb" | "uniform" | "spectrum") =>
        {
            rgb_of(object.get("value")?)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests;
