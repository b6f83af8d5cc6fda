//! NumPy arrays of floats, of any byte order and memory order, from files and archive members.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use npyz::{DType, NpyFile, NpyHeader, Order, TypeChar};
use tpb_film::FilmError;
use zip::ZipArchive;

use crate::ViewerError;

/// Numbers of one of two sizes.
pub(super) enum Values {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

/// An array in C order.
pub(super) struct Array {
    pub(super) shape: Vec<usize>,
    pub(super) values: Values,
}

impl Array {
    /// The values in 64 bits.
    pub(super) fn into_f64(self) -> Vec<f64> {
        match self.values {
            Values::Single(values) => values.into_iter().map(f64::from).collect(),
            Values::Double(values) => values,
        }
    }

    /// The values in 32 bits; what is larger becomes infinite.
    pub(super) fn into_f32(self) -> Vec<f32> {
        match self.values {
            Values::Single(values) => values,
            Values::Double(values) => values.into_iter().map(|value| value as f32).collect(),
        }
    }
}

/// Why a stream of bytes is no array of floats.
fn read(mut bytes: impl Read, length: u64) -> Result<Array, String> {
    let header = NpyHeader::from_reader(&mut bytes).map_err(|e| e.to_string())?;
    let shape: Vec<usize> = header.shape().iter().map(|&n| n as usize).collect();
    let order = header.order();
    let dtype = header.dtype();
    let size = match &dtype {
        DType::Plain(kind) if kind.type_char() == TypeChar::Float => kind.size_field(),
        _ => 0,
    };
    if size != 4 && size != 8 {
        return Err(format!("holds {}: cubes are float32 or float64", dtype.descr()));
    }
    let short = || format!("is shorter than its shape {shape:?}");
    let expected = shape.iter().try_fold(size, |bytes, &n| bytes.checked_mul(n as u64));
    // Before memory is asked for it.
    if expected.is_none_or(|bytes| bytes > length) {
        return Err(short());
    }
    let file = NpyFile::with_header(header, &mut bytes);
    let failed = |e: io::Error| match e.kind() {
        io::ErrorKind::UnexpectedEof => short(),
        _ => e.to_string(),
    };
    let values = if size == 4 {
        Values::Single(in_c_order(file.into_vec().map_err(failed)?, &shape, order))
    } else {
        Values::Double(in_c_order(file.into_vec().map_err(failed)?, &shape, order))
    };
    // Only at the end of a member does an archive compare its checksum.
    if io::copy(&mut bytes, &mut io::sink()).map_err(failed)? > 0 {
        return Err(format!("is longer than its shape {shape:?}"));
    }
    Ok(Array { shape, values })
}

/// Values with the last index running fastest.
fn in_c_order<T: Copy>(values: Vec<T>, shape: &[usize], order: Order) -> Vec<T> {
    if order == Order::C || values.is_empty() {
        return values;
    }
    // In Fortran order the first index runs fastest: its stride is 1.
    let mut strides = Vec::with_capacity(shape.len());
    let mut stride = 1;
    for &n in shape {
        strides.push(stride);
        stride *= n;
    }
    let mut index = vec![0; shape.len()];
    let mut out = Vec::with_capacity(values.len());
    loop {
        out.push(values[index.iter().zip(&strides).map(|(i, s)| i * s).sum::<usize>()]);
        let mut axis = shape.len();
        loop {
            if axis == 0 {
                return out;
            }
            axis -= 1;
            index[axis] += 1;
            if index[axis] < shape[axis] {
                break;
            }
            index[axis] = 0;
        }
    }
}

fn io_error(path: &Path, source: io::Error) -> ViewerError {
    ViewerError::Film(FilmError::Io { path: path.to_owned(), source })
}

/// The array of a `.npy` file.
pub(super) fn of_file(path: &Path) -> Result<Array, ViewerError> {
    let file = File::open(path).map_err(|e| io_error(path, e))?;
    let length = file.metadata().map_err(|e| io_error(path, e))?.len();
    read(BufReader::new(file), length).map_err(|reason| ViewerError::cube(path, reason))
}

fn archive(path: &Path) -> Result<ZipArchive<BufReader<File>>, ViewerError> {
    let file = File::open(path).map_err(|e| io_error(path, e))?;
    ZipArchive::new(BufReader::new(file)).map_err(|e| ViewerError::cube(path, e.to_string()))
}

/// The names of the arrays of an archive.
pub(super) fn names(path: &Path) -> Result<Vec<String>, ViewerError> {
    let archive = archive(path)?;
    let arrays = archive.file_names().filter_map(Result::ok);
    let mut names: Vec<String> =
        arrays.filter_map(|name| Some(name.strip_suffix(".npy")?.to_owned())).collect();
    names.sort();
    Ok(names)
}

/// An array of an archive.
pub(super) fn of_member(path: &Path, name: &str) -> Result<Array, ViewerError> {
    let mut archive = archive(path)?;
    let broken = |reason: String| ViewerError::cube(path, format!("`{name}` {reason}"));
    let member = archive.by_name(&format!("{name}.npy")).map_err(|e| broken(e.to_string()))?;
    let length = member.size();
    read(member, length).map_err(broken)
}

/// The number of dimensions of an array of an archive; `None` if it holds no array.
pub(super) fn dimensions(path: &Path, name: &str) -> Result<Option<usize>, ViewerError> {
    let mut archive = archive(path)?;
    let member = archive.by_name(&format!("{name}.npy"));
    let member = member.map_err(|e| ViewerError::cube(path, format!("`{name}`: {e}")))?;
    Ok(NpyHeader::from_reader(member).ok().map(|header| header.shape().len()))
}
