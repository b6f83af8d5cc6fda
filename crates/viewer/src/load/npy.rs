//! NumPy arrays of numbers, of any size, byte order and memory order, from files and archive members.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use half::f16;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use tpb_film::FilmError;
use zip::ZipArchive;

use crate::ViewerError;

/// Bytes that are read at once; a multiple of all sizes.
const CHUNK: usize = 1 << 16;

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

/// Why a stream of bytes is no array of numbers.
fn read(mut bytes: impl Read, length: u64) -> Result<Array, String> {
    let header = NpyHeader::from_reader(&mut bytes).map_err(|e| e.to_string())?;
    let shape: Vec<usize> = header.shape().iter().map(|&n| n as usize).collect();
    let dtype = header.dtype();
    let plain = match &dtype {
        DType::Plain(kind) => Some((kind.type_char(), kind.size_field(), kind.endianness())),
        _ => None,
    };
    let number = plain.filter(|&(kind, size, _)| match kind {
        TypeChar::Float => matches!(size, 2 | 4 | 8),
        TypeChar::Int | TypeChar::Uint => matches!(size, 1 | 2 | 4 | 8),
        TypeChar::Bool => size == 1,
        _ => false,
    });
    let Some((kind, size, endianness)) = number else {
        return Err(format!(
            "holds {}: cubes are numbers of at most 64 bits, such as float32",
            dtype.descr()
        ));
    };
    let expected = shape.iter().try_fold(size, |bytes, &n| bytes.checked_mul(n as u64));
    // Before memory is asked for it.
    if expected.is_none_or(|bytes| bytes > length) {
        return Err(format!("is shorter than its shape {shape:?}"));
    }
    let mut data = Data { bytes, shape: &shape, order: header.order(), endianness };
    let values = match (kind, size) {
        (TypeChar::Float, 2) => data.single(|b| f16::from_le_bytes(b).to_f32())?,
        (TypeChar::Float, 4) => data.single(f32::from_le_bytes)?,
        (TypeChar::Float, _) => data.double(f64::from_le_bytes)?,
        (TypeChar::Int, 1) => data.single(|b| f32::from(i8::from_le_bytes(b)))?,
        (TypeChar::Int, 2) => data.single(|b| f32::from(i16::from_le_bytes(b)))?,
        (TypeChar::Int, 4) => data.double(|b| f64::from(i32::from_le_bytes(b)))?,
        (TypeChar::Int, _) => data.double(|b| i64::from_le_bytes(b) as f64)?,
        (TypeChar::Uint, 2) => data.single(|b| f32::from(u16::from_le_bytes(b)))?,
        (TypeChar::Uint, 4) => data.double(|b| f64::from(u32::from_le_bytes(b)))?,
        (TypeChar::Uint, 8) => data.double(|b| u64::from_le_bytes(b) as f64)?,
        _ => data.single(|[byte]| f32::from(byte))?,
    };
    // Only at the end of a member does an archive compare its checksum.
    if io::copy(&mut data.bytes, &mut io::sink()).map_err(|e| e.to_string())? > 0 {
        return Err(format!("is longer than its shape {shape:?}"));
    }
    Ok(Array { shape, values })
}

/// The numbers of an array, as they lie in the file.
struct Data<'a, R> {
    bytes: R,
    shape: &'a [usize],
    order: Order,
    endianness: Endianness,
}

impl<R: Read> Data<'_, R> {
    fn single<const N: usize>(&mut self, of: impl Fn([u8; N]) -> f32) -> Result<Values, String> {
        self.numbers(of).map(Values::Single)
    }

    fn double<const N: usize>(&mut self, of: impl Fn([u8; N]) -> f64) -> Result<Values, String> {
        self.numbers(of).map(Values::Double)
    }

    /// In C order; `of` takes the bytes of a number, the lowest first.
    fn numbers<const N: usize, T: Copy>(
        &mut self,
        of: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>, String> {
        let count = self.shape.iter().product();
        let mut values = room(count)?;
        let mut buffer = vec![0; CHUNK.min(count * N)];
        while values.len() < count {
            let part = &mut buffer[..CHUNK.min((count - values.len()) * N)];
            self.bytes.read_exact(part).map_err(|e| match e.kind() {
                io::ErrorKind::UnexpectedEof => {
                    format!("is shorter than its shape {:?}", self.shape)
                }
                _ => e.to_string(),
            })?;
            values.extend(part.as_chunks::<N>().0.iter().map(|&number| {
                let mut number = number;
                if self.endianness == Endianness::Big {
                    number.reverse();
                }
                of(number)
            }));
        }
        in_c_order(values, self.shape, self.order)
    }
}

/// An empty list with room for so many values; a file may claim, and have, more than there is memory.
fn room<T>(count: usize) -> Result<Vec<T>, String> {
    let mut values = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    values
        .try_reserve_exact(count)
        .map_err(|_| format!("needs {:.3e} bytes of memory, which there are not", bytes as f64))?;
    Ok(values)
}

/// Values with the last index running fastest.
fn in_c_order<T: Copy>(values: Vec<T>, shape: &[usize], order: Order) -> Result<Vec<T>, String> {
    if order == Order::C || values.is_empty() {
        return Ok(values);
    }
    // In Fortran order the first index runs fastest: its stride is 1.
    let mut strides = Vec::with_capacity(shape.len());
    let mut stride = 1;
    for &n in shape {
        strides.push(stride);
        stride *= n;
    }
    let mut index = vec![0; shape.len()];
    let mut out = room(values.len())?;
    loop {
        out.push(values[index.iter().zip(&strides).map(|(i, s)| i * s).sum::<usize>()]);
        let mut axis = shape.len();
        loop {
            if axis == 0 {
                return Ok(out);
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

/// What a member of an archive says of itself.
pub(super) struct Member {
    /// The number of its dimensions.
    pub(super) dimensions: usize,
    /// Whether it holds numbers of 64 bits, as images of ours do.
    pub(super) is_double: bool,
}

/// The header of an array of an archive.
///
/// # Errors
/// [`ViewerError::Cube`], which names the array, if it cannot be read.
pub(super) fn member(path: &Path, name: &str) -> Result<Member, ViewerError> {
    let mut archive = archive(path)?;
    let broken =
        |reason: String| ViewerError::cube(path, format!("`{name}` cannot be read: {reason}"));
    let bytes = archive.by_name(&format!("{name}.npy")).map_err(|e| broken(e.to_string()))?;
    let header = NpyHeader::from_reader(bytes).map_err(|e| broken(e.to_string()))?;
    let is_double = match header.dtype() {
        DType::Plain(kind) => (kind.type_char(), kind.size_field()) == (TypeChar::Float, 8),
        _ => false,
    };
    Ok(Member { dimensions: header.shape().len(), is_double })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression: a sparse file of the claimed size made the program abort.
    #[test]
    fn more_than_there_is_memory_is_an_error() {
        // More than addresses have bits for, so that no system hopes to find it.
        let shape = format!("(1, 2, {})", 1_u64 << 58);
        let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
        let bytes = format!("{header:<117}\n");
        let bytes = [b"\x93NUMPY\x01\x00\x76\x00", bytes.as_bytes()].concat();
        let endless = bytes.chain(io::repeat(0));
        let message = read(endless, u64::MAX).map(drop).unwrap_err();
        assert!(message.contains("bytes of memory"), "{message}");
    }
}
