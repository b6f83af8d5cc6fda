//! A tiny film from the first render to the last file.

use std::fs;
use std::time::Duration;

use super::*;
use crate::cube::Cube;
use crate::gallery::agreement::{Terms, compare};
use crate::measure::BatchPlan;
use crate::reproduce::summary::Summary;
use crate::statistics::Finding;

/// A scene of a few pixels and bins in a folder of its own.
pub(crate) fn trial(name: &str) -> Options {
    let out = std::env::temp_dir().join(format!("tpb-reproduce-{name}-{}", std::process::id()));
    let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let circumstances = Circumstances {
        commit: "test".into(),
        machine: "a machine".into(),
        flags: "--trial".into(),
        seed: 3,
    };
    Options {
        time: Duration::from_millis(20),
        reference_time: Duration::from_millis(100),
        replicates: 3,
        old_references: false,
        pixels: Some(12),
        bins: Some(20),
        scenes,
        out,
        circumstances,
        command: "cargo xtask reproduce cornell-blocks".into(),
    }
}

#[test]
fn all_files_are_made_and_agree_with_each_other() {
    let options = trial("cornell");
    let _ = fs::remove_dir_all(&options.out);
    let mut told = Vec::new();
    let result =
        run(&options, &mut Watch::new(&mut |line: &str| told.push(line.to_owned()))).unwrap();
    let out = options.out.join(NAME);
    for file in ["sequence.png", "steady.png", "viewer.html", "variance-beams.png", "bias-path.png"]
    {
        assert!(fs::metadata(out.join(file)).unwrap().len() > 60, "{file}");
    }
    assert!(!out.join("replicates").exists(), "replicates are removed at the end");

    // Numbers: parts add up to the whole, and windows, kinds and bins share the signal.
    let c = &result.picture;
    for split in c.whole().methods.iter().map(|m| &m.judged) {
        let sum = split.variance.value + split.squared_bias.value;
        assert!((sum / split.nmse.value - 1.0).abs() < 1e-9);
    }
    for parts in [&c.frames, &c.kinds] {
        let shares: f64 = parts.iter().map(|part| part.share).sum();
        assert!((shares - 1.0).abs() < 1e-9, "{shares}");
        let errors = parts.iter().filter_map(|p| Some(p.share * p.splits[0].as_ref()?.nmse.value));
        assert!((errors.sum::<f64>() / c.whole().methods[0].judged.nmse.value - 1.0).abs() < 0.05);
    }
    assert!(c.pixels[0] < c.pixels[1] && c.shape == [12, 12, 20]);

    let page = fs::read_to_string(out.join("index.html")).unwrap();
    for part in [
        "photon beams, bin",
        "a broad white ring on the back wall",
        "Provenance",
        "cargo xtask reproduce",
        "commit",
        "viewer.html",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // Regression: the viewer told the means of all replicates, and a command that repeats the time.
    let viewer = fs::read_to_string(out.join("viewer.html")).unwrap();
    for method in ["path", "beams"] {
        let start = format!("tpb render scenes/cornell-blocks.json --method {method} --passes ");
        let command = viewer.split(&start).nth(1).expect("a command");
        let command: Vec<&str> = command.split('"').next().unwrap().split(' ').collect();
        let [passes, "--seed", seed, "--set", "sensor.film.width=12", ..] = command[..] else {
            panic!("{command:?}")
        };
        let told = |name: &str, value: &str| viewer.contains(&format!("[\"{name}\",\"{value}\"]"));
        assert!(told("passes", passes) && told("seed", seed), "{method}: {passes}, {seed}");
    }
    assert!(viewer.contains("[\"options\",\"samples per pass "));
    let kept: CornellResult =
        serde_json::from_str(&fs::read_to_string(out.join("result.json")).unwrap()).unwrap();
    assert_eq!(kept, result);
    let summary = Summary::read(&options.out);
    summary.write(&options).unwrap();
    assert_eq!(summary.tables()[0].rows.len(), 2);
    assert!(fs::read_to_string(options.out.join("table.md")).unwrap().contains("12x12x20"));

    // A second run uses the reference that is there.
    let reference = || fs::metadata(out.join("reference-12-20.npz")).unwrap().modified().unwrap();
    let before = reference();
    told.clear();
    run(&options, &mut Watch::new(&mut |line: &str| told.push(line.to_owned()))).unwrap();
    assert_eq!(reference(), before);
    assert!(told.iter().any(|line| line.contains("are there already")), "{told:?}");
    fs::remove_dir_all(&options.out).unwrap();
}

/// The passes and the seed that the command names make the run again, to the halves in which races
/// keep it.
fn the_command_repeats(
    options: &Options,
    loaded: &tpb_scene::load::LoadedScene,
    method: &crate::measure::Estimator,
    run: &super::super::race::Replicate,
) {
    let command = options.render_command(NAME, method.name(), run).unwrap();
    let words: Vec<&str> = command.split(' ').collect();
    let number = |flag: &str| -> u64 {
        let at = words.iter().position(|word| *word == flag).expect("a flag");
        words[at + 1].parse().unwrap()
    };
    let changes: Vec<String> =
        words.windows(2).filter(|pair| pair[0] == "--set").map(|pair| pair[1].to_owned()).collect();
    let scene = options.scenes.join("..").join(words[2]);
    let again = super::super::load(&scene, &changes).unwrap();
    assert_eq!(again.canonical, loaded.canonical, "{command}");
    let budget = tpb_render::Budget::Passes(number("--passes"));
    let settings = tpb_render::RunSettings { seed: number("--seed"), budget, first_pass: 0 };
    let scene = &again.scene;
    let plan = tpb_scene::Plan::new(scene, &scene.integrator);
    let prepared = method.prepare::<3>(scene, &plan, scene.integrator).unwrap();
    let layout = crate::measure::layout(&scene.film, 0.0).unwrap();
    let (arrays, _) = crate::measure::render(&*prepared, layout, &settings).unwrap();
    let kept = run.cube(0).unwrap().cells();
    assert_eq!(super::super::halves::HalfCube::of(&arrays).cells(), kept);
    assert!(kept.iter().any(|&cell| cell > 0.0));
}

/// The numbers of a contest are those of their formula, and its methods render the same light: cubes
/// that are empty, twice as bright, backwards in time or upside down are found.
#[test]
fn a_contest_judges_what_was_rendered() {
    let options = Options { replicates: 16, ..trial("contest") };
    let _ = fs::remove_dir_all(&options.out);
    let loaded = options.load(NAME, &[]).unwrap();
    let absorbing = options.load(NAME, &["fog.albedo=0"]).unwrap();
    let contest = contest(&options, [&loaded, &absorbing], &options.out);
    let Contested { comparison, truth, runs, .. } = contest.run(&mut Watch::default()).unwrap();
    let reference = Arrays::read_npz(&options.reference(&options.out)).unwrap();
    let cubes: Vec<Vec<Cube>> = runs
        .iter()
        .map(|runs| runs.iter().map(|run| Cube::of(&run.arrays(&reference).unwrap())).collect())
        .collect();

    // NMSE by its definition, from the arrays that are kept and the file of the reference.
    let truth_cube = Cube::of(&reference);
    let noise = truth.noise(0..truth.bins, true);
    for (cubes, method) in cubes.iter().zip(&comparison.whole().methods) {
        let error = |cube: &Cube| -> f64 {
            let judged = (0..cube.pixels()).filter(|&pixel| truth.judged[pixel]);
            let cells =
                judged.flat_map(|p| cube.pixel_bins(p).iter().zip(truth_cube.pixel_bins(p)));
            cells.map(|(x, r)| (x - r).powi(2)).sum()
        };
        let mean = cubes.iter().map(error).sum::<f64>() / cubes.len() as f64;
        let expected = (mean - noise.variance) / noise.signal();
        let found = method.judged.nmse.value;
        assert!((found - expected).abs() < 2e-3 * mean / noise.signal(), "{found} {expected}");
    }

    // Path and beams render the same light: false alarm at most 1e-6. Fewer passes do not matter.
    let plan = BatchPlan { batches: options.replicates, passes: 0, seed: 0 };
    let terms = Terms { plan, blur: 0.1, margin: 0.1 };
    let [path, beams] = [&cubes[0], &cubes[1]];
    let film = &loaded.scene.film;
    let found = |ours: &[Cube]| compare(film, &truth.judged, (ours, path), &terms);
    let sound = found(beams);
    assert_ne!(sound.finding, Finding::Different, "{:?}", sound.contrasts);
    let changed =
        |change: &dyn Fn(&Cube) -> Cube| -> Vec<Cube> { beams.iter().map(change).collect() };
    let bins = truth.bins;
    let each = |cube: &Cube, cell: &dyn Fn(usize, usize) -> f64| {
        let mut new = cube.clone();
        for pixel in 0..cube.pixels() {
            for (place, value) in new.pixel_mut(pixel).iter_mut().enumerate() {
                *value = cell(pixel, place);
            }
        }
        new
    };
    for (name, broken) in [
        ("empty", changed(&|cube| Cube::zero(cube.width, cube.height, cube.bins))),
        ("twice", changed(&|cube| each(cube, &|p, cell| 2.0 * cube.pixel(p)[cell]))),
        ("backwards", changed(&|cube| each(cube, &|p, cell| cube.pixel(p)[bins + 1 - cell]))),
        ("upside down", changed(&|cube| each(cube, &|p, c| cube.pixel(cube.pixels() - 1 - p)[c]))),
    ] {
        let judgement = found(&broken);
        assert_eq!(judgement.finding, Finding::Different, "{name}: {:?}", judgement.contrasts);
    }
    fs::remove_dir_all(&options.out).unwrap();
}

#[test]
fn an_interrupted_race_goes_on_and_a_folder_that_cannot_be_written_is_told_first() {
    let options = trial("race");
    let _ = fs::remove_dir_all(&options.out);
    let loaded = options.load(NAME, &[]).unwrap();
    let methods = [crate::measure::Estimator::of_name("path").unwrap()];
    let race = |replicates, seed| super::super::race::Race {
        loaded: &loaded,
        methods: &methods,
        times: vec![options.time],
        replicates,
        seed,
        commit: "test",
        folder: options.out.join("kept"),
    };
    let first = race(2, 5).run(&mut Watch::default()).unwrap();
    the_command_repeats(&options, &loaded, &methods[0], &first[0][1]);
    let mut told = Vec::new();
    let more =
        race(3, 5).run(&mut Watch::new(&mut |line: &str| told.push(line.to_owned()))).unwrap();
    assert_eq!(more[0][..2], first[0][..]);
    let kept = told.iter().filter(|line| line.contains("kept from an earlier run")).count();
    assert_eq!((kept, told.len()), (2, 3));
    // Another seed is another race.
    told.clear();
    race(2, 6).run(&mut Watch::new(&mut |line: &str| told.push(line.to_owned()))).unwrap();
    assert!(told.iter().all(|line| line.contains("done")), "{told:?}");
    // The largest seed is one like others: its runs are not those of small seeds.
    let seeds = |seed| race(2, seed).run(&mut Watch::default()).unwrap()[0].clone();
    let all: Vec<u64> = [0, 1, u64::MAX].into_iter().flat_map(seeds).map(|run| run.seed).collect();
    assert!((0..6).all(|i| !all[..i].contains(&all[i])), "{all:?}");
    fs::remove_dir_all(&options.out).unwrap();

    let file = std::env::temp_dir().join(format!("tpb-reproduce-file-{}", std::process::id()));
    fs::write(&file, "in the way").unwrap();
    let blocked = Options { out: file.clone(), ..options };
    let mut told = 0;
    let error = run(&blocked, &mut Watch::new(&mut |_: &str| told += 1)).unwrap_err();
    assert!(error.to_string().contains("cannot access") && told == 0, "{error}");
    fs::remove_file(&file).unwrap();
}
