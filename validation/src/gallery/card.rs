//! What is known of one rendered scene: read back from its result folder.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tpb_optics::opl::seconds_from_opl;
use tpb_render::Report;

use super::catalogue::{GalleryScene, Moment};
use super::order::{self, Beside, Order};
use crate::error::{Result, ValidationError};

/// A picture of a card.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its place beneath the gallery's folder.
    pub file: String,
    /// The PNG.
    pub png: Vec<u8>,
    /// What is written below it.
    pub caption: String,
    /// What a reader is told who does not see it.
    pub alt: String,
}

/// What the plan leaves out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The part.
    pub part: String,
    /// Why.
    pub reason: String,
    /// Whether light is missing from the image.
    pub loses_light: bool,
}

/// One scene on the page.
#[derive(Clone, Debug)]
pub struct Card {
    /// Name of the scene's file, without `.json`.
    pub name: String,
    /// Title.
    pub title: String,
    /// What it shows.
    pub text: String,
    /// The steady image, three frames, time of arrival.
    pub pictures: Vec<Picture>,
    /// Pairs of name and value: method, film, time, passes, error.
    pub facts: Vec<(&'static str, String)>,
    /// What the plan leaves out.
    pub left_out: Vec<LeftOut>,
    /// Warnings of the report.
    pub warnings: Vec<String>,
    /// The command that renders it again.
    pub command: String,
    /// Links: what people read, and the file beneath the gallery's folder.
    pub links: Vec<(&'static str, String)>,
}

impl Card {
    /// Reads the result of a scene: the folder of its name in `gallery`; `Ok(None)` if there is none.
    ///
    /// # Errors
    /// If there is a result, but it cannot be read or has no time axis.
    pub fn read(scene: &GalleryScene, gallery: &Path) -> Result<Option<Self>> {
        let folder = gallery.join(&scene.name);
        let file = folder.join("report.json");
        if !file.exists() {
            return Ok(None);
        }
        let report = read_report(&file)?;
        let mut links = vec![("Animation", format!("{}/animation.png", scene.name))];
        links.push(("Report", format!("{}/report.json", scene.name)));
        let viewer = format!("{}.html", scene.name);
        if gallery.join(&viewer).exists() {
            links.insert(0, ("Explore pixels and times", viewer));
        }
        let mut facts = facts(&report);
        facts.extend(beside(scene, gallery)?.map(|text| ("In the viewer", text)));
        let second = format!("{}-beside/report.json", scene.name);
        if gallery.join(&second).is_file() {
            links.push(("Report of the second method", second));
        }
        Ok(Some(Self {
            name: scene.name.clone(),
            title: scene.title.clone(),
            text: scene.text.to_owned(),
            pictures: pictures(scene, &report, gallery)?,
            facts,
            left_out: left_out(&report.plan),
            warnings: warnings(&report),
            command: command(scene, &report),
            links,
        }))
    }
}

fn read_report(file: &Path) -> Result<Report> {
    let text = fs::read_to_string(file).map_err(|error| ValidationError::io(file, error))?;
    serde_json::from_str(&text)
        .map_err(|error| ValidationError::unusable(file.display().to_string(), error))
}

/// What the viewer has beside the method of the pictures; `None` if nobody knows.
fn beside(scene: &GalleryScene, gallery: &Path) -> Result<Option<String>> {
    let report = order::beside(&scene.name, gallery).join("report.json");
    Ok(match Order::read(&scene.name, gallery).map(|order| order.beside) {
        Some(Beside::Method(_)) if report.is_file() => Some(companion(&read_report(&report)?)),
        Some(Beside::Nobody(reason)) => {
            Some(format!("alone; others do not render it all: {reason}"))
        }
        _ => None,
    })
}

/// A companion, and what it leaves out.
fn companion(report: &Report) -> String {
    let run = &report.run;
    let flipped = format!(
        "with {}, {:.0} s, {} passes, flipped in place; neither is a reference",
        method(&report.method.name),
        run.wall_seconds,
        run.passes
    );
    let lost = report.warnings.iter().filter_map(|warning| warning.strip_prefix(LACKS));
    std::iter::once(flipped)
        .chain(lost.map(|lost| format!("it lacks {lost}")))
        .collect::<Vec<_>>()
        .join("; ")
}

/// How a report's warning of light that is left out begins.
const LACKS: &str = "the image lacks ";

fn read(gallery: &Path, file: String, caption: String, alt: String) -> Result<Picture> {
    let path = gallery.join(&file);
    let png = fs::read(&path).map_err(|error| ValidationError::io(&path, error))?;
    Ok(Picture { file, png, caption, alt })
}

fn pictures(scene: &GalleryScene, report: &Report, gallery: &Path) -> Result<Vec<Picture>> {
    let GalleryScene { name, title, .. } = scene;
    let steady = format!("{name}/steady.png");
    let mut all = vec![read(gallery, steady, "all light".into(), format!("{title}: all light"))?];
    for moment in &scene.moments {
        all.push(frame(scene, report, moment, gallery)?);
    }
    let file = format!("{name}/arrival_time.png");
    let alt = format!("{title}: mean time of arrival as hue, brightness as in the steady image");
    let mut arrival = read(gallery, file, String::new(), alt)?;
    arrival.caption = format!("time of arrival{}", scale(&arrival.png));
    all.push(arrival);
    Ok(all)
}

/// The frame that holds a moment.
fn frame(
    scene: &GalleryScene,
    report: &Report,
    moment: &Moment,
    gallery: &Path,
) -> Result<Picture> {
    let Some((start, end)) = report.film.opl_window else {
        return Err(ValidationError::unusable(scene.name.clone(), "its film has no time axis"));
    };
    let bins = report.film.bins;
    let bin = ((moment.at * bins as f64) as usize).min(bins - 1);
    let folder = gallery.join(&scene.name).join("frames");
    // A frame may stand for several bins; it is named by its first.
    let starts = |bin: &usize| folder.join(format!("frame-{bin:06}.png")).exists();
    let Some(first) = (0..=bin).rev().find(starts) else {
        let what = folder.display().to_string();
        return Err(ValidationError::unusable(what, format!("there is no frame of bin {bin}")));
    };
    let opl = start + (end - start) * (bin as f64 + 0.5) / bins as f64;
    let when = format!("{:.3} m, {}", opl, duration(seconds_from_opl(opl)));
    let seen = if moment.seen.is_empty() { String::new() } else { format!(": {}", moment.seen) };
    let alt = format!("{} at {when}{seen}", scene.title);
    let file = format!("{}/frames/frame-{first:06}.png", scene.name);
    read(gallery, file, format!("{when}{seen}"), alt)
}

/// A time as people read it.
fn duration(seconds: f64) -> String {
    if seconds < 1e-9 {
        format!("{:.0} ps", seconds * 1e12)
    } else {
        format!("{:.2} ns", seconds * 1e9)
    }
}

/// The scale that a time-of-arrival picture carries as text.
fn scale(png: &[u8]) -> String {
    let Ok(reader) = png::Decoder::new(std::io::Cursor::new(png)).read_info() else {
        return String::new();
    };
    let texts = &reader.info().uncompressed_latin1_text;
    let comment = texts.iter().find(|text| text.keyword == "Comment").map(|text| &text.text);
    // blue 5.1 m = 1.7e-8 s; red 8.2 m = 2.7e-8 s
    let end = |part: &str| -> Option<String> {
        let (colour, rest) = part.trim().split_once(' ')?;
        let opl: f64 = rest.split_once(" m")?.0.parse().ok()?;
        Some(format!("{colour} {opl:.3} m"))
    };
    let ends: Vec<String> =
        comment.map_or_else(Vec::new, |text| text.split(';').filter_map(end).collect());
    if ends.is_empty() { String::new() } else { format!(": {}", ends.join(" to ")) }
}

fn facts(report: &Report) -> Vec<(&'static str, String)> {
    let (film, run) = (&report.film, &report.run);
    let channels = if film.channels == 1 { "one channel" } else { "three channels" };
    let error = |error: f64| format!("{:.1} % (median relative error of a pixel)", 100.0 * error);
    let cpu = run.cpu_seconds.map_or_else(String::new, |cpu| format!(", {cpu:.0} s of CPU time"));
    vec![
        ("Method", method(&report.method.name).to_owned()),
        (
            "Film",
            format!("{} x {} pixels, {} bins, {channels}", film.width, film.height, film.bins),
        ),
        ("Time", format!("{:.0} s{cpu}", run.wall_seconds)),
        ("Passes", run.passes.to_string()),
        ("Error", run.relative_error.map_or_else(|| "not known".to_owned(), error)),
    ]
}

/// A method's name for people.
pub fn method(name: &str) -> &str {
    match name {
        "beams" => "photon beams",
        "path" => "path tracing",
        "light" => "light tracing",
        other => other,
    }
}

/// Warnings, but for those that the plan's list says already.
fn warnings(report: &Report) -> Vec<String> {
    let new = |text: &&String| !text.starts_with(LACKS);
    report.warnings.iter().filter(new).cloned().collect()
}

/// The lines of a report's plan.
fn left_out(plan: &Value) -> Vec<LeftOut> {
    let text = |item: &Value, key: &str| item[key].as_str().unwrap_or_default().to_owned();
    let items = plan["left_out"].as_array().into_iter().flatten();
    let of = |item: &Value| LeftOut {
        part: text(item, "part"),
        reason: text(item, "reason"),
        loses_light: item["loses_light"].as_bool().unwrap_or(false),
    };
    items.map(of).collect()
}

/// As many passes of the same seed make the same arrays, to the bit.
fn command(scene: &GalleryScene, report: &Report) -> String {
    let mut words = vec![format!(
        "cargo run --release -- render scenes/{}.json --method {} --passes {} --seed {}",
        scene.name, report.method.name, report.run.passes, report.options.run.seed
    )];
    let film = &report.scene.canonical["sensor"]["film"];
    for key in ["width", "height", "temporal_bins", "start_opl", "bin_width_opl"] {
        let own = original(scene, key);
        if own.as_ref().is_some_and(|own| !same(own, &film[key])) {
            words.push(format!("--set sensor.film.{key}={}", film[key]));
        }
    }
    words.push(format!("-o {}", scene.name));
    words.join(" ")
}

/// What a scene's own file says of its film.
fn original(scene: &GalleryScene, key: &str) -> Option<Value> {
    let text = fs::read_to_string(&scene.file).ok()?;
    let file: Value = serde_json::from_str(&text).ok()?;
    file["sensor"]["film"].get(key).cloned()
}

/// Whether two numbers are equal; 5 and 5.0 are.
fn same(a: &Value, b: &Value) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a.total_cmp(&b).is_eq(),
        _ => a == b,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn times_are_readable() {
        assert_eq!(duration(3.5e-10), "350 ps");
        assert_eq!(duration(1.2345e-8), "12.35 ns");
    }

    #[test]
    fn a_card_tells_why_a_method_stands_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        let scene = super::super::scenes_in(&scenes).expect("scenes").remove(0);
        assert_eq!(beside(&scene, folder.path()).expect("a text"), None, "nothing was asked for");
        let order = |beside| Order {
            commit: "abc".into(),
            scene: Value::Null,
            method: "beams".into(),
            beside,
            seconds: 1.0,
            budget: 1.0,
            sound: true,
        };
        let keep = |beside| order(beside).keep(&scene.name, folder.path()).expect("a file");
        keep(Beside::Nobody("path: it leaves out light of lasers".into()));
        let text = beside(&scene, folder.path()).expect("a text").expect("a reason");
        assert!(text.starts_with("alone") && text.contains("light of lasers"), "{text}");
        keep(Beside::Method("path".into()));
        assert_eq!(beside(&scene, folder.path()).expect("a text"), None, "it is not rendered yet");
    }

    #[test]
    fn the_plan_is_read_with_its_reasons() {
        let plan = json!({"left_out": [
            {"part": "media", "reason": "vacuum everywhere", "loses_light": false},
            {"part": "light of lasers", "reason": "no path", "loses_light": true},
        ]});
        let found = left_out(&plan);
        assert_eq!(found.len(), 2);
        assert!(found[1].loses_light && found[0].reason == "vacuum everywhere");
        assert!(left_out(&Value::Null).is_empty());
    }

    #[test]
    fn numbers_are_compared_by_value() {
        assert!(same(&json!(5), &json!(5.0)) && !same(&json!(5), &json!(5.5)));
    }
}
