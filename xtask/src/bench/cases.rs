//! What is timed and counted. A case that changes is a new one: give it another name.

/// Folder of the scenes that the experiments use.
const SCENES: &str = "validation/scenes";
/// Folder of the gallery's scenes.
const GALLERY: &str = "scenes";

/// Who does the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// A part of the renderers by itself: `benches/examples/kernels.rs`.
    Kernel(&'static str),
    /// A whole render: folder and name of the scene, options of `tpb render`.
    Render(&'static str, &'static str, &'static [&'static str]),
}

/// A case.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) work: Work,
    /// Passes that are timed, about a second's.
    pub(crate) timed: u64,
    /// Passes that are counted: the instructions of as many again, less theirs.
    pub(crate) counted: u64,
}

/// Pixels along an edge of renders that are counted.
pub(crate) const COUNTED_EDGE: usize = 24;

/// All cases.
pub(crate) const CASES: &[Case] = &[
    kernel("kernel/photons", "photons", 40),
    kernel("kernel/gather, 1D", "gather-1d", 40),
    kernel("kernel/gather, 2D", "gather-2d", 30),
    kernel("kernel/gather, turned rays", "gather-turned", 10),
    kernel("kernel/paths", "paths", 90),
    render("cornell-blocks, beams", SCENES, "cornell-blocks", &["--method", "beams"], 3),
    render(
        "cornell-blocks, beams 2D",
        SCENES,
        "cornell-blocks",
        &["--method", "beams", "--kernel", "2d"],
        3,
    ),
    render("cornell-blocks, path", SCENES, "cornell-blocks", &["--method", "path"], 10),
    render("cornell-blocks, light", SCENES, "cornell-blocks", &["--method", "light"], 4),
    render("mirror-caustic, beams", SCENES, "mirror-caustic", &["--method", "beams"], 1),
    render(
        "torus-knot, beams",
        GALLERY,
        "torus-knot",
        &["--method", "beams", "--set=sensor.film.width=96", "--set=sensor.film.height=72"],
        1,
    ),
    render("surfaces-only, path", GALLERY, "surfaces-only", &["--method", "path"], 1),
];

const fn kernel(name: &'static str, kernel: &'static str, timed: u64) -> Case {
    Case { name, work: Work::Kernel(kernel), timed, counted: 1 }
}

const fn render(
    name: &'static str,
    folder: &'static str,
    scene: &'static str,
    options: &'static [&'static str],
    timed: u64,
) -> Case {
    Case { name, work: Work::Render(folder, scene, options), timed, counted: 1 }
}

impl Case {
    /// Arguments of its program, for so many passes. `edge`: pixels along the edges of a render's film,
    /// instead of those that the scene asks for.
    pub(crate) fn arguments(&self, passes: u64, seed: u64, edge: Option<usize>) -> Vec<String> {
        match self.work {
            Work::Kernel(kernel) => {
                vec![kernel.to_owned(), passes.to_string(), seed.to_string()]
            }
            Work::Render(folder, scene, options) => {
                let film = edge.into_iter().flat_map(film_options);
                std::iter::once(format!("{folder}/{scene}.json"))
                    .chain(options.iter().map(|&option| option.to_owned()))
                    .chain(film)
                    .chain(render_options(passes, seed))
                    .collect()
            }
        }
    }
}

/// A square film with so many pixels along its edges.
pub(crate) fn film_options(edge: usize) -> impl Iterator<Item = String> {
    ["width", "height"].into_iter().map(move |side| format!("--set=sensor.film.{side}={edge}"))
}

/// What all renders have in common: one thread, so many passes, arrays and report only.
pub(crate) fn render_options(passes: u64, seed: u64) -> impl Iterator<Item = String> {
    let passes = format!("--passes={passes}");
    [passes, format!("--seed={seed}"), "--threads=1".to_owned(), "--no-pictures".to_owned()]
        .into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_have_names_of_their_own_and_say_what_they_run() {
        let mut names: Vec<_> = CASES.iter().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), CASES.len());
        let case = CASES.iter().find(|case| case.name == "cornell-blocks, path").unwrap();
        let arguments = case.arguments(2, 7, Some(8)).join(" ");
        let expected = "validation/scenes/cornell-blocks.json --method path \
                        --set=sensor.film.width=8 --set=sensor.film.height=8 \
                        --passes=2 --seed=7 --threads=1 --no-pictures";
        assert_eq!(arguments, expected);
    }
}
