//! Files that appear whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

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
        let target = match Target::of(path)? {
            Target::Stream(stream) => {
                let mut buffer = BufWriter::new(&stream);
                write(&mut buffer)?;
                return buffer.flush();
            }
            Target::File(target) => target,
        };
        let file = beside(&target)?;
        let mut buffer = BufWriter::with_capacity(1 << 16, file.as_file());
        write(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        file.persist(target).map_err(|e| e.error)?;
        Ok(())
    };
    attempt().map_err(|source| FilmError::io(path, source))
}

/// The same for what is written by name, by another program: `write` gets the name of an empty
/// file beside the final one, to be overwritten in place.
///
/// # Errors
/// What `write` returns; [`FilmError::Io`] with the final path for all else.
pub fn atomic_path<E: From<FilmError>>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let failed = |source| E::from(FilmError::io(path, source));
    match Target::of(path).map_err(failed)? {
        Target::Stream(mut stream) => {
            let file = tempfile::NamedTempFile::new().map_err(failed)?;
            write(file.path())?;
            let mut whole = File::open(file.path()).map_err(failed)?;
            io::copy(&mut whole, &mut stream).map_err(failed)?;
        }
        Target::File(target) => {
            let file = beside(&target).map_err(failed)?.into_temp_path();
            write(&file)?;
            file.persist(&target).map_err(|e| failed(e.error))?;
        }
    }
    Ok(())
}

/// Where a file goes.
enum Target {
    /// A regular file, or none yet: replaced.
    File(PathBuf),
    /// A pipe or device, open for writing.
    Stream(File),
}

impl Target {
    fn of(path: &Path) -> io::Result<Self> {
        if path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "is a directory"));
        }
        let target = match path.symlink_metadata() {
            Ok(found) if found.is_symlink() => path.canonicalize()?,
            _ => path.to_path_buf(),
        };
        if target.metadata().is_ok_and(|found| !found.is_file()) {
            return Ok(Self::Stream(File::options().write(true).open(target)?));
        }
        Ok(Self::File(target))
    }
}

/// An empty file in the folder of another.
fn beside(target: &Path) -> io::Result<NamedTempFile> {
    let folder = match target.parent() {
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
    builder.tempfile_in(folder).map_err(|e| io::Error::from(e.kind()))
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

    #[test]
    fn files_written_by_name_appear_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        let write = |text: &'static str| {
            move |name: &Path| {
                std::fs::write(name, text).unwrap();
                Ok::<(), FilmError>(())
            }
        };
        atomic_path(&path, write("old")).unwrap();
        let failed = atomic_path(&path, |name| {
            std::fs::write(name, "part").unwrap();
            Err(FilmError::Unsuitable("no"))
        });
        assert!(matches!(failed, Err(FilmError::Unsuitable("no"))));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        atomic_path(&path, write("new")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let nowhere = folder.path().join("nowhere").join("result");
        let message = atomic_path(&nowhere, write("x")).unwrap_err().to_string();
        assert!(message.contains("nowhere"), "{message}");
    }
}
