//! Files of one JSON object per line that grow at their end.
//!
//! A writer that is stopped leaves a torn line. Writing after it begins a new line, so that only
//! the torn one is lost; reading skips what is no object of the kind, and counts it. A line is
//! handed to the system in one piece at the file's end: two writers do not mix theirs.
//!
//! Not handled: files without end; all lines are held in memory.

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::DashboardError;

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines<T> {
    /// In the file's order.
    pub values: Vec<T>,
    /// Lines that could not be read: torn, or of another kind.
    pub torn: usize,
}

impl<T> Default for Lines<T> {
    fn default() -> Self {
        Self { values: Vec::new(), torn: 0 }
    }
}

/// Reads a file; one that does not exist has no lines.
///
/// # Errors
/// [`DashboardError::Io`] if it exists and cannot be read.
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<Lines<T>, DashboardError> {
    let bytes = match fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Lines::default()),
        Err(error) => return Err(DashboardError::io(path, error)),
    };
    let mut lines = Lines::default();
    for line in bytes.split(|&byte| byte == b'\n').filter(|line| !line.trim_ascii().is_empty()) {
        match serde_json::from_slice(line) {
            Ok(value) => lines.values.push(value),
            Err(_) => lines.torn += 1,
        }
    }
    Ok(lines)
}

/// Adds values at the end of a file, which is made if need be, with its folder.
///
/// # Errors
/// [`DashboardError::Io`], [`DashboardError::Json`].
pub fn append<T: Serialize>(path: &Path, values: &[T]) -> Result<(), DashboardError> {
    if values.is_empty() {
        return Ok(());
    }
    let mut text = Vec::new();
    for value in values {
        serde_json::to_writer(&mut text, value)?;
        text.push(b'\n');
    }
    let io = |error| DashboardError::io(path, error);
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|error| DashboardError::io(folder, error))?;
    }
    let mut file =
        OpenOptions::new().read(true).append(true).create(true).open(path).map_err(io)?;
    if torn(&mut file).map_err(io)? {
        text.insert(0, b'\n');
    }
    file.write_all(&text).map_err(io)
}

/// Whether a file ends within a line.
fn torn(file: &mut fs::File) -> std::io::Result<bool> {
    if file.seek(SeekFrom::End(0))? == 0 {
        return Ok(false);
    }
    file.seek(SeekFrom::End(-1))?;
    let mut last = [0];
    file.read_exact(&mut last)?;
    Ok(last[0] != b'\n')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_in_the_order_in_which_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/history.jsonl");
        assert_eq!(read::<(u32, String)>(&path).unwrap(), Lines::default());
        let value = |number: u32| (number, format!("line\n{number}"));
        append(&path, &[value(1)]).unwrap();
        append::<(u32, String)>(&path, &[]).unwrap();
        append(&path, &[value(2), value(3)]).unwrap();
        let lines = read::<(u32, String)>(&path).unwrap();
        assert_eq!(lines, Lines { values: vec![value(1), value(2), value(3)], torn: 0 });
    }

    #[test]
    fn a_torn_line_is_lost_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.jsonl");
        append(&path, &[1, 2]).unwrap();
        let whole = fs::read(&path).unwrap();
        // Stopped within a line, in the middle of a letter of two bytes; then a line of bytes.
        for rest in [&b"[3, \"\xc3"[..], b"\"", b"{", b"[3,\n\xff\xfe\n\n \n{\"other\": 1}"] {
            fs::write(&path, [&whole[..], rest].concat()).unwrap();
            append(&path, &[4]).unwrap();
            let lines = read::<u32>(&path).unwrap();
            assert_eq!(lines.values, [1, 2, 4], "{rest:?}");
            assert_eq!(lines.torn, if rest.contains(&b'\n') { 3 } else { 1 });
        }
    }

    #[test]
    fn writers_at_the_same_time_keep_their_lines_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.jsonl");
        append(&path, &["first"]).unwrap();
        std::thread::scope(|scope| {
            for writer in 0..4 {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..50 {
                        append(path, &[format!("{writer}").repeat(2000)]).unwrap();
                    }
                });
            }
        });
        let lines = read::<String>(&path).unwrap();
        assert_eq!((lines.values.len(), lines.torn), (201, 0));
    }
}
