//! Pages that other commands write: what is there is copied and linked, what is missing is named with
//! the command that makes it.

use std::fs;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use crate::DashboardError;
use crate::benchmarks::seconds;
use crate::copies::{Copies, address};

/// Where a command leaves its pages.
#[derive(Clone, Debug, PartialEq)]
pub struct Shelf {
    /// What the pages are, as a heading.
    pub title: String,
    /// The folder; pages are the HTML files in it and in its folders. They are copied with what they
    /// name, as far as it lies in this folder.
    pub folder: PathBuf,
    /// The command that makes them.
    pub command: String,
}

/// A shelf with what was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Filled {
    pub(crate) title: String,
    pub(crate) command: String,
    pub(crate) pages: Vec<Found>,
}

/// A page.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Found {
    /// Its own title, or the folder's name.
    pub(crate) title: String,
    /// The address of its copy, relative to the dashboard's.
    pub(crate) link: String,
    pub(crate) bytes: u64,
    /// Its last change \[s since 1970, UTC\].
    pub(crate) time: u64,
    /// A small picture beside it, as a data address.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) picture: Option<String>,
}

/// Largest picture that is taken into the page \[bytes\].
const PICTURE: u64 = 400_000;

/// Names of pictures that stand for a page: beside `index.html`, or in the folder that is named like
/// the page.
const PICTURES: [&str; 5] =
    ["thumbnail.png", "thumbnail.svg", "small.png", "sequence.png", "steady.png"];

/// Looks for the pages of a shelf, and copies them.
pub(crate) fn fill(shelf: &Shelf, copies: &mut Copies) -> Result<Filled, DashboardError> {
    let mut files = pages(&shelf.folder);
    for folder in entries(&shelf.folder).into_iter().filter(|path| path.is_dir()) {
        files.extend(pages(&folder));
    }
    let mut found = Vec::with_capacity(files.len());
    for file in &files {
        found.push(page(file, address(&copies.add(file, &shelf.folder)?)));
    }
    Ok(Filled { title: shelf.title.clone(), command: shelf.command.clone(), pages: found })
}

/// What is in a folder, by name; nothing if it cannot be read.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let found = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = found.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// The HTML files of a folder, its index first.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let html = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|e| e == "html");
    let mut files: Vec<PathBuf> = entries(folder).into_iter().filter(html).collect();
    files.sort_by_key(|file| !is_index(file));
    files
}

fn is_index(file: &Path) -> bool {
    file.file_name().is_some_and(|name| name == "index.html")
}

fn page(file: &Path, link: String) -> Found {
    let about = file.metadata().ok();
    let folder = match file.parent() {
        Some(folder) if is_index(file) => folder.to_owned(),
        _ => file.with_extension(""),
    };
    let name = folder.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    Found {
        title: title(file).unwrap_or(name),
        link,
        bytes: about.as_ref().map_or(0, fs::Metadata::len),
        time: about.and_then(|about| about.modified().ok()).map_or(0, seconds),
        picture: PICTURES.iter().find_map(|name| picture(&folder.join(name), PICTURE)),
    }
}

/// The title that a page gives itself.
fn title(file: &Path) -> Option<String> {
    use std::io::Read;
    let mut start = Vec::new();
    fs::File::open(file).ok()?.take(4096).read_to_end(&mut start).ok()?;
    let start = String::from_utf8_lossy(&start);
    let (_, after) = start.split_once("<title>")?;
    let (title, _) = after.split_once("</title>")?;
    let plain = title.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"");
    let plain = plain.replace("&#39;", "'").replace("&amp;", "&").trim().to_owned();
    (!plain.is_empty()).then_some(plain)
}

/// A picture as a data address, if it is one and no larger than `most` bytes.
pub(crate) fn picture(file: &Path, most: u64) -> Option<String> {
    let kind = match file.extension()?.to_str()? {
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "svg" => "image/svg+xml",
        _ => return None,
    };
    if file.metadata().ok()?.len() > most {
        return None;
    }
    Some(format!("data:{kind};base64,{}", STANDARD.encode(fs::read(file).ok()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_found_with_title_and_address() {
        let folder = tempfile::tempdir().unwrap();
        let shelf = folder.path().join("reproduce");
        let out = folder.path().join("dashboard/deep");
        fs::create_dir_all(&out).unwrap();
        let filled = |shelf: &Shelf| {
            let mut copies = Copies::new(&out).unwrap();
            let filled = fill(shelf, &mut copies).unwrap();
            copies.finish().unwrap();
            filled
        };
        let shelf_of = |folder: &Path| Shelf {
            title: "Scenes".into(),
            folder: folder.to_owned(),
            command: "make".into(),
        };
        assert_eq!(filled(&shelf_of(&shelf)).pages, []);
        for (name, text) in [("b, 100 %", "<title>A &lt;b&gt; &amp; c </title>"), ("a", "no title")]
        {
            fs::create_dir_all(shelf.join(name)).unwrap();
            fs::write(shelf.join(name).join("index.html"), text).unwrap();
        }
        fs::create_dir_all(shelf.join("empty")).unwrap();
        fs::write(shelf.join("a/viewer.html"), "<title>V</title>").unwrap();
        fs::write(shelf.join("empty.html"), "").unwrap();
        fs::write(shelf.join("index.html"), "<title>All</title>").unwrap();
        fs::write(shelf.join("table.md"), "").unwrap();
        fs::write(shelf.join("a/thumbnail.png"), "png").unwrap();
        fs::write(shelf.join("empty/steady.png"), "png").unwrap();
        let pages = filled(&shelf_of(&shelf)).pages;
        let told: Vec<_> = pages.iter().map(|p| (p.title.as_str(), p.link.as_str())).collect();
        let expected = [
            ("All", "pages/reproduce/index.html"),
            ("empty", "pages/reproduce/empty.html"),
            ("a", "pages/reproduce/a/index.html"),
            ("V", "pages/reproduce/a/viewer.html"),
            ("A <b> & c", "pages/reproduce/b%2C%20100%20%25/index.html"),
        ];
        assert_eq!(told, expected);
        let pictures: Vec<_> = pages.iter().map(|page| page.picture.as_deref()).collect();
        let data = Some("data:image/png;base64,cG5n");
        assert_eq!(pictures, [None, data, data, None, None]);
    }
}
