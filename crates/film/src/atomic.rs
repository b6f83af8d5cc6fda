//! Files that appear whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::FilmError;

/// Writes a file beside its final name and renames it: whoever looks finds the old file or the new
/// one, never a part. On an error nothing is left behind. Links are followed; what is no regular
/// file (a pipe, a device) is written to as it stands.
///
/// # Errors
/// [`FilmError::Io`] with the final path: no permission, no such folder, disk full, or whatever
/// `write` returns.
pub fn atomic_write(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<(), FilmError> {
    let attempt = || -> io::Result<()> {
        if path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "is a directory"));
        }
        let target = match path.symlink_metadata() {
            Ok(found) if found.is_symlink() => path.canonicalize()?,
            _ => path.to_path_buf(),
        };
        let path = target.as_path();
        if path.metadata().is_ok_and(|found| !found.is_file()) {
            let file = File::options().write(true).open(path)?;
            let mut buffer = BufWriter::new(&file);
            write(&mut buffer)?;
            return buffer.flush();
        }
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".unfinished-");
        #[cfg(unix)]
        {
            // What File::create would give; the umask still applies.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        // The temporary file's name would be in the error.
        let file = builder.tempfile_in(folder).map_err(|e| io::Error::from(e.kind()))?;
        let mut buffer = BufWriter::with_capacity(1 << 16, file.as_file());
        write(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    };
    attempt().map_err(|source| FilmError::io(path, source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        atomic_write(&path, |w| w.write_all(b"old")).unwrap();
        let error = atomic_write(&path, |w| {
            w.write_all(&vec![0; 100_000])?;
            Err(io::Error::new(io::ErrorKind::StorageFull, "no space left"))
        });
        let message = error.unwrap_err().to_string();
        assert!(message.contains("result") && message.contains("no space left"), "{message}");
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// Regression: a pipe became a file, a link lost its target, `-o /dev/null` lost the device.
    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_pipes_stay_pipes() {
        use std::io::Read;
        use std::os::unix::fs::{FileTypeExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        std::fs::write(&target, b"old").unwrap();
        symlink(&target, &link).unwrap();
        atomic_write(&link, |w| w.write_all(b"new")).unwrap();
        assert_eq!(std::fs::read(&target).unwrap(), b"new");
        assert!(link.symlink_metadata().unwrap().is_symlink());

        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || {
                let mut text = String::new();
                File::open(pipe).unwrap().read_to_string(&mut text).unwrap();
                text
            }
        });
        atomic_write(&pipe, |w| w.write_all(b"through")).unwrap();
        assert_eq!(reader.join().unwrap(), "through");
        assert!(pipe.metadata().unwrap().file_type().is_fifo());
    }

    #[test]
    fn a_missing_folder_is_an_error_that_names_the_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nowhere").join("result");
        let message = atomic_write(&path, |w| w.write_all(b"x")).unwrap_err().to_string();
        assert!(message.contains("nowhere"), "{message}");
        assert!(atomic_write(folder.path(), |w| w.write_all(b"x")).is_err(), "a folder");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
