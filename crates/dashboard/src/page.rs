//! The page: what is read, what is kept of it, and the files that are written.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::Serialize;
use tpb_film::atomic_write;
use tpb_page::{Document, document, json_element};

use crate::assets::{PAGE, SCRIPTS, STYLES};
use crate::bench_rows::BenchRuns;
use crate::bench_runs::{self, BenchRun};
use crate::benchmarks::{self, Benchmark, seconds};
use crate::copies::Copies;
use crate::curves::{self, Scenes};
use crate::history::{self, Run, Verdict};
use crate::overview::{Overview, Planned, Row};
use crate::shelves::{self, Filled, Shelf};
use crate::{DashboardError, lines};

/// Where everything lies.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Commit of the sources, as it is now.
    pub commit: String,
    /// Processor, threads, system.
    pub machine: String,
    /// Root of the workspace: files of failed experiments are named from there.
    pub root: PathBuf,
    /// The experiments of the suite.
    pub plan: Vec<Planned>,
    /// Files of [`history::Run`] lines.
    pub histories: Vec<PathBuf>,
    /// Files of [`Benchmark`] lines.
    pub benchmarks: Vec<PathBuf>,
    /// Files of [`BenchRun`] lines.
    pub bench_runs: Vec<PathBuf>,
    /// Folder of errors against run time.
    pub error_time: PathBuf,
    /// Where other commands leave their pages.
    pub shelves: Vec<Shelf>,
    /// Folder to write.
    pub out: PathBuf,
}

/// What became of a dashboard.
#[derive(Clone, Debug, PartialEq)]
pub struct DashboardReport {
    /// The page.
    pub page: PathBuf,
    /// Its size \[bytes\].
    pub bytes: usize,
    /// Experiments whose latest result is that they passed, that they did not; and those without.
    pub experiments: [usize; 3],
    /// Scenes with errors against run time.
    pub scenes: usize,
    /// Benchmarks: Criterion's, and cases of runs.
    pub benchmarks: usize,
    /// Pages that are linked.
    pub linked: usize,
    /// Size of their copies, with all that they show \[bytes\].
    pub copied: u64,
    /// Remarks: lines and files that could not be read, files that are not copied.
    pub remarks: Vec<String>,
}

/// What the page carries.
#[derive(Serialize)]
struct Data<'a> {
    program: String,
    time: u64,
    commit: &'a str,
    machine: &'a str,
    overview: Overview,
    /// Pictures of experiments that did not pass: name of the experiment, then (name, address).
    pictures: BTreeMap<String, Vec<(String, String)>>,
    error_time: Scenes,
    benchmarks: Vec<Benchmark>,
    bench_runs: BenchRuns,
    shelves: Vec<Filled>,
    remarks: Vec<String>,
}

/// Bytes of pictures that the page carries at most, in all and one by one.
const PICTURES: (usize, u64) = (12_000_000, 400_000);

/// Writes `index.html` into [`Sources::out`], `data.json`, which has the same data, and `pages`, copies
/// of the pages that it links.
///
/// # Errors
/// [`DashboardError::Io`] if a history or a folder exists and cannot be read,
/// [`DashboardError::Film`] if a file cannot be written, [`DashboardError::Occupied`] if there is a
/// folder `pages` that is not ours.
pub fn write(sources: &Sources) -> Result<DashboardReport, DashboardError> {
    fs::create_dir_all(&sources.out).map_err(|e| DashboardError::io(&sources.out, e))?;
    let mut copies = Copies::new(&sources.out)?;
    let data = gather(sources, &mut copies)?;
    let copied = copies.finish()?;
    let html = document(&Document {
        template: PAGE,
        title: "Dashboard: transient photon beams",
        styles: &STYLES,
        data: &json_element("data", &data)?,
        scripts: &SCRIPTS,
    });
    let page = sources.out.join("index.html");
    atomic_write(&page, |file| file.write_all(html.as_bytes()))?;
    let json = serde_json::to_string(&data)?;
    atomic_write(&sources.out.join("data.json"), |file| file.write_all(json.as_bytes()))?;
    Ok(report(&data, page, html.len(), copied))
}

fn gather<'a>(sources: &'a Sources, copies: &mut Copies) -> Result<Data<'a>, DashboardError> {
    let mut remarks = Vec::new();
    let runs: Vec<Run> = history::merge(all(&sources.histories, &mut remarks)?);
    let bench_runs = bench_runs::merge(all::<BenchRun>(&sources.bench_runs, &mut remarks)?);
    let of_runs = bench_runs.iter().flat_map(|run| run.benchmarks.iter().cloned());
    let benchmarks = all::<Benchmark>(&sources.benchmarks, &mut remarks)?;
    let benchmarks = benchmarks::merge(benchmarks.into_iter().chain(of_runs));
    let overview = Overview::new(&sources.plan, &runs);
    let pictures = pictures(&overview.rows, &sources.root);
    let error_time = curves::read(&sources.error_time)?;
    remarks.extend(error_time.unread.iter().cloned());
    let shelves = sources.shelves.iter().map(|shelf| shelves::fill(shelf, copies));
    let shelves = shelves.collect::<Result<_, _>>()?;
    remarks.append(&mut copies.remarks);
    Ok(Data {
        program: format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")),
        time: seconds(SystemTime::now()),
        commit: &sources.commit,
        machine: &sources.machine,
        overview,
        pictures,
        error_time,
        benchmarks,
        bench_runs: BenchRuns::new(&bench_runs),
        shelves,
        remarks,
    })
}

/// The lines of several files.
fn all<T: serde::de::DeserializeOwned>(
    files: &[PathBuf],
    remarks: &mut Vec<String>,
) -> Result<Vec<T>, DashboardError> {
    let mut values = Vec::new();
    for file in files {
        let found = lines::read(file)?;
        if found.torn > 0 {
            remarks.push(format!(
                "{}: {} lines could not be read (torn, or of another kind)",
                file.display(),
                found.torn
            ));
        }
        values.extend(found.values);
    }
    Ok(values)
}

/// Pictures that experiments left when they did not pass, and that are still there.
fn pictures(rows: &[Row], root: &Path) -> BTreeMap<String, Vec<(String, String)>> {
    let mut found = BTreeMap::new();
    let mut room = PICTURES.0;
    for row in rows.iter().flat_map(|row| std::iter::once(row).chain(&row.controls)) {
        let latest = row.latest.as_ref().map(|latest| &latest.1);
        let failed = latest.filter(|record| record.verdict != Verdict::Passed);
        let mut pictures = Vec::new();
        for file in failed.into_iter().flat_map(|record| &record.files) {
            let Some(picture) = shelves::picture(&root.join(file), PICTURES.1) else { continue };
            if picture.len() <= room {
                room -= picture.len();
                let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
                pictures.push((name.into_owned(), picture));
            }
        }
        if !pictures.is_empty() {
            found.insert(row.name.clone(), pictures);
        }
    }
    found
}

fn report(data: &Data<'_>, page: PathBuf, bytes: usize, copied: u64) -> DashboardReport {
    let mut experiments = [0; 3];
    let rows = data.overview.rows.iter();
    for row in rows.flat_map(|row| std::iter::once(row).chain(&row.controls)) {
        let passed = row.latest.as_ref().map(|(_, record)| record.verdict == Verdict::Passed);
        experiments[passed.map_or(2, |passed| usize::from(!passed))] += 1;
    }
    let mut names: Vec<&str> = data.benchmarks.iter().map(|line| line.bench.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    DashboardReport {
        page,
        bytes,
        experiments,
        scenes: data.error_time.scenes.len(),
        benchmarks: names.len() + data.bench_runs.cases(),
        linked: data.shelves.iter().map(|shelf| shelf.pages.len()).sum(),
        copied,
        remarks: data.remarks.clone(),
    }
}
