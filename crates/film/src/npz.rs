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

use std::path::Path;

use crate::archive::{ArchiveReader, ArchiveWriter, Compression};
use crate::arrays::{Arrays, Quantity};
use crate::{FilmError, atomic_write};

impl Arrays {
    /// Writes all arrays to one file, whole or not at all.
    ///
    /// # Errors
    /// [`FilmError::Io`].
    pub fn write_npz(&self, path: &Path) -> Result<(), FilmError> {
        atomic_write(path, |file| {
            let mut npz = ArchiveWriter::new(file, Compression::Stored);
            let (height, width, channels) = (self.height, self.width, self.channels);
            let image = [height, width, channels];
            if self.bins > 0 {
                let cube = [height, width, self.bins, channels];
                let edges = [self.bins + 1];
                let key = match self.quantity {
                    Quantity::BinEnergy => "transient",
                    Quantity::RadianceAtUpperEdges => "radiance",
                };
                npz.put(key, &cube, &self.transient)?;
                if let Some(variance) = &self.variance {
                    npz.put("variance", &cube, variance)?;
                }
                npz.put("opl_edges", &edges, &self.opl_edges)?;
                npz.put("time_edges", &edges, &self.time_edges())?;
                npz.put("before", &image, &self.before)?;
                npz.put("after", &image, &self.after)?;
            }
            npz.put("steady", &image, &self.steady)?;
            npz.finish()
        })
    }

    /// Reads what [`Arrays::write_npz`] wrote.
    ///
    /// # Errors
    /// [`FilmError::Io`] if the file cannot be read, [`FilmError::Format`] if it holds something
    /// else.
    pub fn read_npz(path: &Path) -> Result<Self, FilmError> {
        let mut reader = ArchiveReader::open(path)?;
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
