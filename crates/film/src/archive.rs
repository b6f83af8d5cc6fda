//! NumPy archives (`.npz`): arrays in the members of a ZIP file, streamed both ways.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Seek, Write};
use std::path::Path;

use npyz::{AutoSerialize, Deserialize, NpyFile, NpyHeader, Order, WriterBuilder};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::FilmError;

/// The ZIP format needs to know in advance of members beyond 4 GiB.
const LARGE_BYTES: usize = 0xfff0_0000;

/// How much is written at a time.
const WRITE_BYTES: usize = 1 << 18;

/// Whether members of an archive are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// As they are: fast.
    Stored,
    /// Deflated: small.
    Deflated,
}

/// Writes arrays one after the other.
pub struct ArchiveWriter<W: Write + Seek> {
    zip: ZipWriter<W>,
    compression: Compression,
}

impl<W: Write + Seek> ArchiveWriter<W> {
    /// An archive without arrays.
    pub fn new(file: W, compression: Compression) -> Self {
        Self { zip: ZipWriter::new(file), compression }
    }

    /// Adds an array in C order; `shape` multiplies to the number of values.
    ///
    /// # Errors
    /// Those of writing.
    pub fn put<T: AutoSerialize + Copy>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: &[T],
    ) -> io::Result<()> {
        let method = match self.compression {
            Compression::Stored => CompressionMethod::Stored,
            Compression::Deflated => CompressionMethod::Deflated,
        };
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .large_file(size_of_val(values) >= LARGE_BYTES);
        let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
        self.zip.start_file(member_name(name), options)?;
        // The archive checks and counts each write, and values are written one by one.
        let mut buffer = BufWriter::with_capacity(WRITE_BYTES, &mut self.zip);
        let mut member = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&shape)
            .writer(&mut buffer)
            .begin_nd()?;
        member.extend(values.iter().copied())?;
        member.finish()?;
        buffer.flush()
    }

    /// Ends the archive.
    ///
    /// # Errors
    /// Those of writing.
    pub fn finish(self) -> io::Result<()> {
        self.zip.finish()?;
        Ok(())
    }
}

/// The member of the archive that holds an array.
fn member_name(array: &str) -> String {
    format!("{array}.npy")
}

/// Reads arrays by their names.
pub struct ArchiveReader<'a> {
    path: &'a Path,
    zip: ZipArchive<BufReader<File>>,
}

/// Shape and values of one array.
pub type Array<T> = (Vec<usize>, Vec<T>);

impl<'a> ArchiveReader<'a> {
    /// Opens an archive.
    ///
    /// # Errors
    /// [`FilmError::Io`] if it cannot be read, [`FilmError::Format`] if it is none.
    pub fn open(path: &'a Path) -> Result<Self, FilmError> {
        let file = File::open(path).map_err(|e| FilmError::io(path, e))?;
        let zip = ZipArchive::new(BufReader::new(file))
            .map_err(|e| FilmError::format(path, e.to_string()))?;
        Ok(Self { path, zip })
    }

    /// An array, if it is there; `expected` is the shape that it must have.
    ///
    /// # Errors
    /// [`FilmError::Format`] for another shape, order or type, or a damaged member.
    pub fn optional<T: Deserialize>(
        &mut self,
        name: &str,
        expected: Option<&[usize]>,
    ) -> Result<Option<Array<T>>, FilmError> {
        let path = self.path;
        let broken = |e: io::Error| FilmError::format(path, format!("`{name}`: {e}"));
        let mut member = match self.zip.by_name(&member_name(name)) {
            Ok(member) => member,
            Err(ZipError::FileNotFound) => return Ok(None),
            Err(error) => return Err(broken(error.into())),
        };
        let header = NpyHeader::from_reader(&mut member).map_err(broken)?;
        let shape: Vec<usize> = header.shape().iter().map(|&n| n as usize).collect();
        if header.order() != Order::C && shape.len() > 1 {
            return Err(FilmError::format(path, format!("`{name}` is not in C order")));
        }
        if expected.is_some_and(|expected| expected != shape) {
            let reason = format!("`{name}` has shape {shape:?} instead of {expected:?}");
            return Err(FilmError::format(path, reason));
        }
        let count = shape.iter().try_fold(size_of::<T>(), |bytes, &n| bytes.checked_mul(n));
        if count.is_none_or(|bytes| bytes as u64 > member.size()) {
            let reason = format!("`{name}` is shorter than its shape {shape:?}");
            return Err(FilmError::format(path, reason));
        }
        let values = NpyFile::with_header(header, &mut member).into_vec().map_err(broken)?;
        // Only at the end of a member does the archive compare its checksum.
        if io::copy(&mut member, &mut io::sink()).map_err(broken)? > 0 {
            return Err(FilmError::format(path, format!("`{name}` is longer than its shape")));
        }
        Ok(Some((shape, values)))
    }

    /// An array that must be there.
    ///
    /// # Errors
    /// Those of [`ArchiveReader::optional`], and [`FilmError::Format`] if it is missing.
    pub fn required<T: Deserialize>(
        &mut self,
        name: &str,
        expected: Option<&[usize]>,
    ) -> Result<Array<T>, FilmError> {
        let path = self.path;
        let missing = || FilmError::format(path, format!("has no array `{name}`"));
        self.optional(name, expected)?.ok_or_else(missing)
    }
}
