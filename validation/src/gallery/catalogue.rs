//! Which scenes there are, and what is seen in them.
//!
//! A scene is a JSON file of the gallery's folder; what this catalogue does not know is shown all
//! the same, under the name of its file.

use std::path::{Path, PathBuf};

use crate::error::{Result, ValidationError};

/// A moment worth showing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// When: 0 is the begin of the film's window, 1 its end.
    pub at: f64,
    /// What is seen then.
    pub seen: &'static str,
}

/// What people are told of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Name of the file, without `.json`.
    pub name: &'static str,
    /// Title.
    pub title: &'static str,
    /// What it shows, in a sentence or two.
    pub text: &'static str,
    /// Three moments, in order.
    pub moments: [Moment; 3],
}

/// A scene of the gallery.
#[derive(Clone, Debug, PartialEq)]
pub struct GalleryScene {
    /// Name of the file, without `.json`.
    pub name: String,
    /// The file.
    pub file: PathBuf,
    /// Title.
    pub title: String,
    /// What it shows; may be empty.
    pub text: &'static str,
    /// Three moments, in order.
    pub moments: [Moment; 3],
}

const fn at(at: f64, seen: &'static str) -> Moment {
    Moment { at, seen }
}

/// Moments of a scene that nobody has described.
const ANY: [Moment; 3] = [at(0.3, ""), at(0.5, ""), at(0.7, "")];

/// Moments of *Mirrors* and of its twin.
const MIRRORS: [Moment; 3] = [
    at(0.307, "the front comes off the tilted mirror; light through the ball leaves it, late"),
    at(0.370, "light through the ball is near its focus; the front meets the back wall"),
    at(0.426, "the caustic lights the floor; on the back wall the front and its mirror image"),
];

/// What is known, in the order of the page.
pub const ENTRIES: [Entry; 12] = [
    Entry {
        name: "torus-knot",
        title: "Glass knot",
        text: "A pulse of a spot light meets a torus knot of tinted glass in fog. Light through the \
               glass is late, and bent into caustics: sheets in the fog, lines on the floor.",
        moments: [
            at(0.37, "the front of the pulse, bends of the knot cut out of it"),
            at(
                0.52,
                "light from the glass is behind the front, and drawn together to sheets in the fog",
            ),
            at(0.67, "caustics run over the floor, light from the glass behind the straight light"),
        ],
    },
    Entry {
        name: "laser-smoke",
        title: "Laser through smoke",
        text: "One pulse of a laser, off two mirrors onto a white ball: light in flight, as \
               femto-photography films it. No path from the eye can find a laser; photon beams do.",
        moments: [
            at(0.25, "the pulse on its first leg; smoke and floor around it glow with its light"),
            at(0.55, "the pulse on its way back from the right mirror"),
            at(0.90, "the pulse has met the ball, whose light spreads through the smoke"),
        ],
    },
    Entry {
        name: "liquid",
        title: "Liquid in a glass",
        text: "A tumbler with a liquid that scatters and absorbs, lit from the left: three kinds of \
               interfaces, smoke around. Light is slower in the liquid by a third.",
        moments: [
            at(0.30, "the front has met the glass and enters the liquid"),
            at(0.44, "in the liquid the front is behind the one outside, and steeper"),
            at(0.62, "light leaves the liquid below, drawn together onto the table"),
        ],
    },
    Entry {
        name: "window",
        title: "A window",
        text: "A spot light shines through a window with cross bars into dusty air: the front of the \
               pulse carries the image of the window through the room.",
        moments: [
            at(0.30, "the image of the window enters the room"),
            at(0.52, "it has met the ball; its lower edge runs over the floor"),
            at(0.82, "it meets the table, which lights what is around it"),
        ],
    },
    Entry {
        name: "chapel",
        title: "A rose window",
        text: "Parallel sunlight through a rose window of coloured panes, thin slabs of glass, into \
               dusty air: its front is a plane that carries the window through the room, onto a \
               compass rose of marble, which is an image.",
        moments: [
            at(0.295, "the front carries the window into the room; the panes mirror it"),
            at(0.460, "the front meets the floor, along a line"),
            at(0.585, "half of the window has landed; light from the marble fills the room"),
        ],
    },
    Entry {
        name: "frosted",
        title: "Frosted glass and copper",
        text: "The upper half of a spot light's beam passes over a block of frosted glass, the lower \
               half through it; a slab of rough copper throws both up to the ceiling. Rough surfaces \
               make no method leave light out, but path tracing finds the lamp through the block by \
               chance alone, and is noisy.",
        moments: [
            at(0.300, "half of the front passes above the block; the other half is in the glass"),
            at(0.380, "above the front is sharp, behind the glass it is late and spread"),
            at(0.600, "the copper throws a broad lobe, in its own colour, through the fog"),
        ],
    },
    Entry {
        name: "neon",
        title: "Neon",
        text: "Three lamps that have an area, a knot, a tube and a disc, flash at once in fog above a \
               floor of rough steel. All methods render all of it, the lamps' reflections in the \
               floor included.",
        moments: [
            at(0.195, "a shell of lit fog around each lamp; the nearest is seen first"),
            at(0.260, "the shells pass through each other; the steel reflects them, blurred"),
            at(0.585, "the fronts are on the back wall, as rings"),
        ],
    },
    Entry {
        name: "surfaces-only",
        title: "Only surfaces",
        text: "A flash lights a spot of the left wall; all else is its indirect light. There is no \
               medium: the plan leaves out beams, free flights and transmittance.",
        moments: [
            at(0.37, "light from the wall meets the pillar; rings run over floor and ceiling"),
            at(0.67, "the front on the back wall, behind the pillar"),
            at(
                0.76,
                "the front with the pillar's shadow; the right wall lights up, mirrored by the steel ball",
            ),
        ],
    },
    Entry {
        name: "fog-only",
        title: "Only fog",
        text: "Three clouds of coloured fog in a haze, and a spot light. There is no surface: the plan \
               leaves out surface photons, specular chains and, for beams, next-event estimation.",
        moments: [
            at(0.22, "the front enters the haze"),
            at(0.44, "it lights the first cloud"),
            at(0.67, "the clouds' shadows, carried along by the front"),
        ],
    },
    Entry {
        name: "cornell-blocks",
        title: "Cornell blocks",
        text: "Two blocks in a room of fog, the scene of the paper's figure 2.",
        moments: [
            at(0.335, "a dome of lit fog has reached the red wall and the green one"),
            at(0.370, "bands of direct light on both blocks, arcs along the walls"),
            at(0.450, "the front is on the back wall, with the shadow of the tall block"),
        ],
    },
    Entry {
        name: "mirrors",
        title: "Mirrors",
        text: "Fog, plane mirrors and a ball of glass, the scene of the paper's figure 3.",
        moments: MIRRORS,
    },
    Entry {
        name: "mirrors-area",
        title: "Mirrors, with a lamp that has an area",
        text: "The same with a tiny lamp instead of a point, so that a path from the eye can meet it.",
        moments: MIRRORS,
    },
];

/// All scenes of a folder, those of the catalogue first and in its order.
///
/// # Errors
/// If the folder cannot be read.
pub fn scenes_in(folder: &Path) -> Result<Vec<GalleryScene>> {
    let io = |error| ValidationError::io(folder, error);
    let mut scenes = Vec::new();
    for file in std::fs::read_dir(folder).map_err(io)? {
        let file = file.map_err(io)?.path();
        let name = file.file_stem().and_then(|stem| stem.to_str());
        if let (Some(name), Some("json")) = (name, file.extension().and_then(|e| e.to_str())) {
            scenes.push(scene(name, &file));
        }
    }
    let place = |name: &str| ENTRIES.iter().position(|entry| entry.name == name);
    scenes.sort_by_key(|scene| (place(&scene.name).unwrap_or(ENTRIES.len()), scene.name.clone()));
    Ok(scenes)
}

fn scene(name: &str, file: &Path) -> GalleryScene {
    let known = ENTRIES.iter().find(|entry| entry.name == name);
    GalleryScene {
        name: name.to_owned(),
        file: file.to_owned(),
        title: known.map_or(name, |entry| entry.title).to_owned(),
        text: known.map_or("", |entry| entry.text),
        moments: known.map_or(ANY, |entry| entry.moments),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_in_order_and_in_the_window() {
        for entry in &ENTRIES {
            let [a, b, c] = entry.moments.map(|moment| moment.at);
            assert!(0.0 <= a && a < b && b < c && c < 1.0, "{}", entry.name);
        }
    }

    #[test]
    fn known_scenes_come_first_and_unknown_ones_are_shown() {
        let folder = tempfile::tempdir().expect("a folder");
        for file in ["zebra.json", "window.json", "torus-knot.json", "notes.txt"] {
            std::fs::write(folder.path().join(file), "{}").expect("a file");
        }
        let names: Vec<_> =
            scenes_in(folder.path()).expect("scenes").into_iter().map(|scene| scene.name).collect();
        assert_eq!(names, ["torus-knot", "window", "zebra"]);
        assert!(scenes_in(&folder.path().join("nowhere")).is_err());
    }
}
