//! Pages that other commands write: what is there is linked, what is missing is named with the
//! command that makes it.

use std::fmt::Write;
use std::fs;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use crate::benchmarks::seconds;

/// Where a command leaves its pages.
#[derive(Clone, Debug, PartialEq)]
pub struct Shelf {
    /// What the pages are, as a heading.
    pub title: String,
    /// The folder; pages are the HTML files in it and in its folders.
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
    /// Its address, relative to the dashboard's.
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
const PICTURES: [&str; 4] = ["thumbnail.png", "thumbnail.svg", "sequence.png", "steady.png"];

/// Looks for the pages of a shelf; `from` is the folder from which they are linked.
pub(crate) fn fill(shelf: &Shelf, from: &Path) -> Filled {
    let mut files = pages(&shelf.folder);
    for folder in entries(&shelf.folder).into_iter().filter(|path| path.is_dir()) {
        files.extend(pages(&folder));
    }
    Filled {
        title: shelf.title.clone(),
        command: shelf.command.clone(),
        pages: files.iter().filter_map(|file| page(file, from)).collect(),
    }
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

fn page(file: &Path, from: &Path) -> Option<Found> {
    let about = file.metadata().ok()?;
    let folder = if is_index(file) { file.parent()?.to_owned() } else { file.with_extension("") };
    let name = folder.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    Some(Found {
        title: title(file).unwrap_or(name),
        link: relative(file, from)?,
        bytes: about.len(),
        time: about.modified().map_or(0, seconds),
        picture: PICTURES.iter().find_map(|name| picture(&folder.join(name), PICTURE)),
    })
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

/// The address of a file relative to a folder; both exist.
pub(crate) fn relative(file: &Path, from: &Path) -> Option<String> {
    let (file, from) = (file.canonicalize().ok()?, from.canonicalize().ok()?);
    let shared = file.components().zip(from.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(shared).map(|_| "..".to_owned());
    let down = file.components().skip(shared).map(|part| match part {
        Component::Normal(name) => encode(&name.to_string_lossy()),
        other => encode(&other.as_os_str().to_string_lossy()),
    });
    Some(up.chain(down).collect::<Vec<_>>().join("/"))
}

/// A part of a path as it stands in an address.
fn encode(part: &str) -> String {
    let mut out = String::with_capacity(part.len());
    for byte in part.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte) {
            out.push(char::from(byte));
        } else {
            // Writing to a text cannot fail.
            let _ = write!(out, "%{byte:02X}");
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_found_with_title_and_address() {
        let folder = tempfile::tempdir().unwrap();
        let shelf = folder.path().join("reproduce");
        let from = folder.path().join("dashboard/deep");
        fs::create_dir_all(&from).unwrap();
        let shelf_of = |folder: &Path| Shelf {
            title: "Scenes".into(),
            folder: folder.to_owned(),
            command: "make".into(),
        };
        assert_eq!(fill(&shelf_of(&shelf), &from).pages, []);
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
        let pages = fill(&shelf_of(&shelf), &from).pages;
        let told: Vec<_> = pages.iter().map(|p| (p.title.as_str(), p.link.as_str())).collect();
        let expected = [
            ("All", "../../reproduce/index.html"),
            ("empty", "../../reproduce/empty.html"),
            ("a", "../../reproduce/a/index.html"),
            ("V", "../../reproduce/a/viewer.html"),
            ("A <b> & c", "../../reproduce/b%2C%20100%20%25/index.html"),
        ];
        assert_eq!(told, expected);
        let pictures: Vec<_> = pages.iter().map(|page| page.picture.as_deref()).collect();
        let data = Some("data:image/png;base64,cG5n");
        assert_eq!(pictures, [None, data, data, None, None]);
    }
}
