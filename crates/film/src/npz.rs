//! `transient.npz`: the arrays, as NumPy reads them.
//!
//! | key | type and shape | meaning |
//! | --- | --- | --- |
//! | `transient` | f4 (H, W, T, C) | time-integrated radiance per bin \[W m^-2 sr^-1\] |
//! | `radiance` | f4 (H, W, T, C) | in its place, for continuous emission: radiance at upper edges |
//! | `variance` | f4 (H, W, T, C) | variance of the mean over passes, if asked for |
//! | `opl_edges`, `time_edges` | f8 (T + 1) | edges of the bins \[m\], \[s\] |
//! | `before`, `after` | f8 (H, W, C) | what arrived outside the window |
//! | `steady` | f8 (H, W, C) | the steady image |
//!
//! A steady film has `steady` alone. Members are stored, not compressed: fast, and streamed
//! without a second copy.

use std::fs::File;
use std::io::{self, BufReader, BufWriter};
use std::path::Path;

use npyz::{AutoSerialize, Deserialize, NpyFile, NpyHeader, Order, WriterBuilder};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::arrays::{Arrays, Quantity};
use crate::{FilmError, atomic_write};

/// The ZIP format needs to know in advance of members beyond 4 GiB.
const LARGE_BYTES: usize = 0xfff0_0000;

impl Arrays {
    /// Writes all arrays to one file, whole or not at all.
    ///
    /// # Errors
    /// [`FilmError::Io`].
    pub fn write_npz(&self, path: &Path) -> Result<(), FilmError> {
        atomic_write(path, |file| {
            let mut npz = ZipWriter::new(file);
            let (height, width, channels) = (self.height, self.width, self.channels);
            let image = [height, width, channels];
            if self.bins > 0 {
                let cube = [height, width, self.bins, channels];
                let edges = [self.bins + 1];
                let key = match self.quantity {
                    Quantity::BinEnergy => "transient",
                    Quantity::RadianceAtUpperEdges => "radiance",
                };
                put(&mut npz, key, &cube, &self.transient)?;
                if let Some(variance) = &self.variance {
                    put(&mut npz, "variance", &cube, variance)?;
                }
                put(&mut npz, "opl_edges", &edges, &self.opl_edges)?;
                put(&mut npz, "time_edges", &edges, &self.time_edges())?;
                put(&mut npz, "before", &image, &self.before)?;
                put(&mut npz, "after", &image, &self.after)?;
            }
            put(&mut npz, "steady", &image, &self.steady)?;
            npz.finish()?;
            Ok(())
        })
    }

    /// Reads what [`Arrays::write_npz`] wrote.
    ///
    /// # Errors
    /// [`FilmError::Io`] if the file cannot be read, [`FilmError::Format`] if it holds something
    /// else.
    pub fn read_npz(path: &Path) -> Result<Self, FilmError> {
        let file = File::open(path).map_err(|e| FilmError::io(path, e))?;
        let broken = |e: ZipError| FilmError::format(path, e.to_string());
        let mut reader =
            Reader { path, npz: ZipArchive::new(BufReader::new(file)).map_err(broken)? };

        let (shape, steady) = reader.required::<f64>("steady", None)?;
        let &[height, width, channels] = shape.as_slice() else {
            return Err(FilmError::format(path, "`steady` does not have 3 dimensions"));
        };
        let mut arrays = Self {
            width,
            height,
            bins: 0,
            channels,
            quantity: Quantity::BinEnergy,
            opl_edges: Vec::new(),
            transient: Vec::new(),
            variance: None,
            before: Vec::new(),
            after: Vec::new(),
            steady,
        };
        let Some((edges, opl_edges)) = reader.optional::<f64>("opl_edges", None)? else {
            return Ok(arrays);
        };
        let bins = match edges.as_slice() {
            &[edges] if edges >= 2 => edges - 1,
            _ => return Err(FilmError::format(path, "`opl_edges` is not a list of bin edges")),
        };
        let (image, cube) = ([height, width, channels], [height, width, bins, channels]);
        arrays.bins = bins;
        arrays.opl_edges = opl_edges;
        arrays.before = reader.required("before", Some(&image))?.1;
        arrays.after = reader.required("after", Some(&image))?.1;
        arrays.transient = if let Some((_, radiance)) = reader.optional("radiance", Some(&cube))? {
            arrays.quantity = Quantity::RadianceAtUpperEdges;
            radiance
        } else {
            reader.required("transient", Some(&cube))?.1
        };
        arrays.variance = reader.optional("variance", Some(&cube))?.map(|(_, values)| values);
        Ok(arrays)
    }
}

fn put<T: AutoSerialize + Copy>(
    npz: &mut ZipWriter<&mut BufWriter<&File>>,
    name: &str,
    shape: &[usize],
    values: &[T],
) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .large_file(size_of_val(values) >= LARGE_BYTES);
    let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
    npz.start_file(member_name(name), options)?;
    let mut member =
        npyz::WriteOptions::new().default_dtype().shape(&shape).writer(npz).begin_nd()?;
    member.extend(values.iter().copied())?;
    member.finish()
}

/// The member of the archive that holds an array.
fn member_name(array: &str) -> String {
    format!("{array}.npy")
}

struct Reader<'a> {
    path: &'a Path,
    npz: ZipArchive<BufReader<File>>,
}

/// Shape and values of one array.
type Array<T> = (Vec<usize>, Vec<T>);

impl Reader<'_> {
    fn optional<T: Deserialize>(
        &mut self,
        name: &str,
        expected: Option<&[usize]>,
    ) -> Result<Option<Array<T>>, FilmError> {
        let path = self.path;
        let broken = |e: io::Error| FilmError::format(path, format!("`{name}`: {e}"));
        let mut member = match self.npz.by_name(&member_name(name)) {
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

    fn required<T: Deserialize>(
        &mut self,
        name: &str,
        expected: Option<&[usize]>,
    ) -> Result<Array<T>, FilmError> {
        let path = self.path;
        let missing = || FilmError::format(path, format!("has no array `{name}`"));
        self.optional(name, expected)?.ok_or_else(missing)
    }
}
