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
//! A steady film has `steady` alone; a film that kept its window alone has none of the last three.
//! Members are stored, not compressed: fast, and streamed
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
        self.write_members(path, false)
    }

    /// Likewise, without `before`, `after` and `steady`: of a film that kept its window alone.
    ///
    /// # Errors
    /// [`FilmError::Io`].
    pub fn write_window_npz(&self, path: &Path) -> Result<(), FilmError> {
        self.write_members(path, self.bins > 0)
    }

    fn write_members(&self, path: &Path, window_only: bool) -> Result<(), FilmError> {
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
            }
            if self.bins > 0 && !window_only {
                npz.put("before", &image, &self.before)?;
                npz.put("after", &image, &self.after)?;
            }
            if !window_only {
                npz.put("steady", &image, &self.steady)?;
            }
            npz.finish()
        })
    }

    /// Reads what [`Arrays::write_npz`] wrote, or [`Arrays::write_window_npz`], whose steady image is
    /// then the sum of the bins.
    ///
    /// # Errors
    /// [`FilmError::Io`] if the file cannot be read, [`FilmError::Format`] if it holds something
    /// else.
    pub fn read_npz(path: &Path) -> Result<Self, FilmError> {
        let mut reader = ArchiveReader::open(path)?;
        if let Some(arrays) = read_window(&mut reader, path)? {
            return Ok(arrays);
        }
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
        let bins = bins_of(&edges, path)?;
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

/// The number of bins between so many edges.
fn bins_of(edges: &[usize], path: &Path) -> Result<usize, FilmError> {
    match *edges {
        [edges] if edges >= 2 => Ok(edges - 1),
        _ => Err(FilmError::format(path, "`opl_edges` is not a list of bin edges")),
    }
}

/// What a film that kept its window alone left, if this is that.
fn read_window(reader: &mut ArchiveReader<'_>, path: &Path) -> Result<Option<Arrays>, FilmError> {
    for image in ["steady", "before", "after"] {
        if reader.optional::<f64>(image, None)?.is_some() {
            return Ok(None);
        }
    }
    let cells = reader.optional::<f32>("transient", None)?;
    let edges = reader.optional::<f64>("opl_edges", None)?;
    let (Some((shape, transient)), Some((edges, opl_edges))) = (cells, edges) else {
        return Ok(None);
    };
    let bins = bins_of(&edges, path)?;
    let &[height, width, cells, channels] = shape.as_slice() else {
        return Err(FilmError::format(path, "`transient` does not have 4 dimensions"));
    };
    if cells != bins || height * width * channels == 0 {
        let reason = format!("`transient` has shape {shape:?} and {bins} bins");
        return Err(FilmError::format(path, reason));
    }
    let variance = reader.optional("variance", Some(&shape))?.map(|(_, values)| values);
    let mut arrays = Arrays {
        width,
        height,
        bins,
        channels,
        quantity: Quantity::BinEnergy,
        opl_edges,
        transient,
        variance,
        before: Vec::new(),
        after: Vec::new(),
        steady: Vec::new(),
    };
    arrays.keep_window();
    Ok(Some(arrays))
}
