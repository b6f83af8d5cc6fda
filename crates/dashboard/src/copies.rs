//! Copies of other commands' pages beside the dashboard, so that its folder is whole by itself.
//!
//! A page is copied with what its `href`, `src` and `poster` attributes name, and what those name in
//! turn, as far as it is there and lies in the page's shelf; places relative to each other stay. What
//! is named outside the shelf is remarked upon. Copies are made in a folder of their own, which
//! replaces that of an earlier dashboard once it is complete.
//!
//! Not handled: addresses that scripts and style sheets make up.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use tpb_film::atomic_write;

use crate::DashboardError;

/// The folder of copies.
pub(crate) const FOLDER: &str = "pages";

/// The folder while it is being filled.
const UNFINISHED: &str = "pages.unfinished";

/// The file by which the folder is known to be ours to replace.
const MARK: &str = "COPIES.txt";

/// What that file says.
const MARK_TEXT: &str =
    "Copies that `cargo xtask dashboard` made; its next run replaces this folder.\n";

/// Longest address that is looked at \[bytes\]: longer ones hold data.
const LONGEST: usize = 2000;

/// Attributes that name files.
const ATTRIBUTES: [&str; 3] = ["href", "src", "poster"];

/// Copies in the making.
pub(crate) struct Copies {
    out: PathBuf,
    /// Names of the shelves' folders, by where they are.
    shelves: BTreeMap<PathBuf, String>,
    done: BTreeSet<PathBuf>,
    bytes: u64,
    /// Files that are named and left out.
    pub(crate) remarks: Vec<String>,
}

impl Copies {
    /// Into the folder of a dashboard.
    ///
    /// # Errors
    /// [`DashboardError::Occupied`] if something else is in the place of the copies,
    /// [`DashboardError::Io`].
    pub(crate) fn new(out: &Path) -> Result<Self, DashboardError> {
        for name in [FOLDER, UNFINISHED] {
            let folder = out.join(name);
            let strange = folder.exists() && !folder.join(MARK).is_file();
            if strange {
                return Err(DashboardError::Occupied { path: folder });
            }
        }
        remove(&out.join(UNFINISHED))?;
        let unfinished = out.join(UNFINISHED);
        fs::create_dir_all(&unfinished).map_err(|e| DashboardError::io(&unfinished, e))?;
        atomic_write(&unfinished.join(MARK), |file| {
            io::Write::write_all(file, MARK_TEXT.as_bytes())
        })?;
        Ok(Self {
            out: out.to_owned(),
            shelves: BTreeMap::new(),
            done: BTreeSet::new(),
            bytes: 0,
            remarks: Vec::new(),
        })
    }

    /// Copies a page of a shelf and all that belongs to it. Returns where it will be, relative to the
    /// dashboard.
    pub(crate) fn add(&mut self, page: &Path, shelf: &Path) -> Result<PathBuf, DashboardError> {
        let whole = |path: &Path| path.canonicalize().map_err(|e| DashboardError::io(path, e));
        let (page, shelf) = (whole(page)?, whole(shelf)?);
        let name = self.name(&shelf);
        let place = |file: &Path| {
            let inside = file.strip_prefix(&shelf).ok()?;
            Some(Path::new(&name).join(inside))
        };
        let mut open = vec![page.clone()];
        while let Some(file) = open.pop() {
            let Some(to) = place(&file).filter(|_| !self.done.contains(&file)) else { continue };
            self.copy(&file, &self.out.join(UNFINISHED).join(to))?;
            self.done.insert(file.clone());
            for named in named_by(&file)? {
                if place(&named).is_some() {
                    open.push(named);
                } else {
                    self.remarks.push(format!(
                        "{} names {}, outside its folder: not copied",
                        file.display(),
                        named.display()
                    ));
                }
            }
        }
        let place = place(&page).unwrap_or_default();
        Ok(Path::new(FOLDER).join(place))
    }

    /// A name for the copy of a shelf's folder: its own, told apart by a number.
    fn name(&mut self, shelf: &Path) -> String {
        if let Some(name) = self.shelves.get(shelf) {
            return name.clone();
        }
        let own = shelf.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let taken = |name: &String| self.shelves.values().any(|other| other == name);
        let numbered = (1..).map(|n| if n == 1 { own.clone() } else { format!("{own}-{n}") });
        let name = numbered.into_iter().find(|name| !taken(name)).unwrap_or(own.clone());
        self.shelves.insert(shelf.to_owned(), name.clone());
        name
    }

    fn copy(&mut self, from: &Path, to: &Path) -> Result<(), DashboardError> {
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder).map_err(|e| DashboardError::io(folder, e))?;
        }
        let mut source = File::open(from).map_err(|e| DashboardError::io(from, e))?;
        let mut bytes = 0;
        atomic_write(to, |file| {
            bytes = io::copy(&mut source, file)?;
            Ok(())
        })?;
        self.bytes += bytes;
        Ok(())
    }

    /// Puts the copies into the place of earlier ones. Returns their size \[bytes\].
    pub(crate) fn finish(self) -> Result<u64, DashboardError> {
        let (from, to) = (self.out.join(UNFINISHED), self.out.join(FOLDER));
        remove(&to)?;
        fs::rename(&from, &to).map_err(|e| DashboardError::io(&to, e))?;
        Ok(self.bytes)
    }
}

/// Removes a folder, if it is there.
fn remove(folder: &Path) -> Result<(), DashboardError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(DashboardError::io(folder, error))
        }
        _ => Ok(()),
    }
}

/// The files that a page names and that are there; none if it is no page.
fn named_by(file: &Path) -> Result<Vec<PathBuf>, DashboardError> {
    let is_page = file.extension().is_some_and(|ending| ending == "html" || ending == "htm");
    let Some(folder) = file.parent().filter(|_| is_page) else { return Ok(Vec::new()) };
    let bytes = fs::read(file).map_err(|e| DashboardError::io(file, e))?;
    let text = String::from_utf8_lossy(&bytes);
    let mut found = BTreeSet::new();
    for address in addresses(&text) {
        let Some(path) = path_of(address) else { continue };
        let mut named = folder.join(path);
        if named.is_dir() {
            named.push("index.html");
        }
        // Scripts hold patterns of addresses; what is not there cannot be copied.
        if named.is_file()
            && let Ok(named) = named.canonicalize()
        {
            found.insert(named);
        }
    }
    Ok(found.into_iter().collect())
}

/// The values of attributes that name files.
fn addresses(page: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for attribute in ATTRIBUTES {
        for (at, _) in page.match_indices(attribute) {
            let before = page[..at].chars().next_back();
            if !before.is_none_or(char::is_whitespace) {
                continue;
            }
            let Some(value) = page[at + attribute.len()..].trim_start().strip_prefix('=') else {
                continue;
            };
            let value = value.trim_start();
            let Some(quote) = value.chars().next().filter(|quote| matches!(quote, '"' | '\''))
            else {
                continue;
            };
            let value = &value[1..];
            if let Some(end) = value.bytes().take(LONGEST).position(|b| b == quote as u8) {
                found.push(&value[..end]);
            }
        }
    }
    found
}

/// The relative path that an address names, if it names one.
fn path_of(address: &str) -> Option<PathBuf> {
    let address = address.split(['#', '?']).next()?.replace("&amp;", "&");
    let has_scheme = address.split('/').next().is_some_and(|first| first.contains(':'));
    if address.is_empty() || address.starts_with('/') || has_scheme {
        return None;
    }
    let path = PathBuf::from(decode(&address));
    path.is_relative().then_some(path)
}

/// An address with `%20` and the like undone.
fn decode(address: &str) -> String {
    let mut out = Vec::with_capacity(address.len());
    let mut rest = address.as_bytes();
    while let [first, others @ ..] = rest {
        let hex = others.get(..2).and_then(|hex| std::str::from_utf8(hex).ok());
        let byte = hex.filter(|_| *first == b'%').and_then(|hex| u8::from_str_radix(hex, 16).ok());
        out.push(byte.unwrap_or(*first));
        rest = if byte.is_some() { &others[2..] } else { others };
    }
    String::from_utf8_lossy(&out).into_owned()
}

/// A relative path as an address.
pub(crate) fn address(path: &Path) -> String {
    let parts = path.components().map(|part| match part {
        Component::Normal(name) => encode(&name.to_string_lossy()),
        other => encode(&other.as_os_str().to_string_lossy()),
    });
    parts.collect::<Vec<_>>().join("/")
}

/// A part of a path as it stands in an address.
fn encode(part: &str) -> String {
    use std::fmt::Write;
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
    fn addresses_become_paths() {
        let page = "<a href=\"a%20b/c.html?x=1&amp;y#z\"><img src = 'p&amp;q.png'> data-href=\"no\" \
                    <a href=\"#top\"><a href=\"https://e.org/x\"><a href=\"data:,\"> \
                    <video\nposter=\"still.png\" src=\"../up/v.mp4\"></video> <a href=\"/root\">\
                    <a href=bare> <a href=\"\"> <i src=\"open";
        let paths: Vec<_> = addresses(page).into_iter().filter_map(path_of).collect();
        let expected = ["a b/c.html", "p&q.png", "../up/v.mp4", "still.png"];
        assert_eq!(paths, expected.map(PathBuf::from));
        assert_eq!(decode("100%25 %zz %"), "100% %zz %");
        assert_eq!(address(Path::new("b, 100 %/ü.html")), "b%2C%20100%20%25/%C3%BC.html");
    }

    fn put(folder: &Path, name: &str, text: &str) -> PathBuf {
        let file = folder.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, text).unwrap();
        file
    }

    #[test]
    fn a_page_brings_along_what_it_shows_and_links() {
        let folder = tempfile::tempdir().unwrap();
        let (shelf, out) = (folder.path().join("gallery"), folder.path().join("out"));
        let page = put(
            &shelf,
            "index.html",
            "<a href=\"room/page.html#bin=3\"><img src=\"room/a%20b.png\"><a href=\"gone.html\">\
             <a href=\"../secret.txt\"><a href=\"room\">",
        );
        put(&shelf, "room/page.html", "<a href=\"../index.html\"><video src=\"v.mp4\">");
        put(&shelf, "room/index.html", "<a href=\"page.html\">");
        put(&shelf, "room/a b.png", "picture");
        put(&shelf, "room/v.mp4", "video");
        put(&shelf, "room/large.npz", "arrays that no page names");
        put(folder.path(), "secret.txt", "not for others");
        fs::create_dir(&out).unwrap();
        for _ in 0..2 {
            let mut copies = Copies::new(&out).unwrap();
            assert_eq!(copies.add(&page, &shelf).unwrap(), Path::new("pages/gallery/index.html"));
            let remarks = std::mem::take(&mut copies.remarks);
            let bytes = copies.finish().unwrap();
            assert!(bytes > 100, "{bytes}");
            assert!(remarks.len() == 1 && remarks[0].contains("secret.txt"), "{remarks:?}");
            let copied = out.join("pages/gallery");
            for name in ["index.html", "room/page.html", "room/index.html", "room/v.mp4"] {
                assert_eq!(
                    fs::read(copied.join(name)).unwrap(),
                    fs::read(shelf.join(name)).unwrap()
                );
            }
            assert!(
                copied.join("room/a b.png").exists() && !copied.join("room/large.npz").exists()
            );
            assert!(!out.join(UNFINISHED).exists());
            // What an earlier dashboard had and this one has not is gone the second time.
            put(&copied, "old.html", "");
        }
        let mut copies = Copies::new(&out).unwrap();
        copies.add(&page, &shelf).unwrap();
        copies.finish().unwrap();
        assert!(!out.join("pages/gallery/old.html").exists());
    }

    #[test]
    fn shelves_of_one_name_stay_apart_and_other_folders_unharmed() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        fs::create_dir(&out).unwrap();
        let shelves = ["a/same", "b/same"].map(|name| folder.path().join(name));
        let mut copies = Copies::new(&out).unwrap();
        let places = shelves.each_ref().map(|shelf| {
            let page = put(shelf, "index.html", "");
            copies.add(&page, shelf).unwrap().display().to_string()
        });
        assert_eq!(places, ["pages/same/index.html", "pages/same-2/index.html"]);
        copies.finish().unwrap();
        let other = folder.path().join("other");
        let mine = put(&other, "pages/thesis.html", "years of work");
        assert!(matches!(Copies::new(&other), Err(DashboardError::Occupied { .. })));
        assert!(mine.exists());
    }
}
