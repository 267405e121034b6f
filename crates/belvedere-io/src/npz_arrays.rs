//! Arrays of NumPy's archive format, written and read with every promise of a header held against what is really there.

use std::io::{self, Read, Seek, Write};

use npyz::npz::{NpzArchive, NpzWriter};
use npyz::zip::write::FileOptions;
use npyz::{AutoSerialize, Deserialize, Order, WriterBuilder};

/// Appends an array to an archive.
pub(crate) fn array<T: AutoSerialize, W: Write + Seek>(
    archive: &mut NpzWriter<W>,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = T>,
) -> io::Result<()> {
    // stored, as NumPy does: floats hardly shrink, and loading stays a copy; without the time of day, so that the same
    // balls give the same bytes
    let options = FileOptions::default()
        .compression_method(npyz::zip::CompressionMethod::Stored)
        .last_modified_time(npyz::zip::DateTime::default())
        .large_file(true);
    let mut writer = archive.array(name, options)?.default_dtype().shape(shape).begin_nd()?;
    writer.extend(values)?;
    writer.finish()
}

/// The rows of an array of shape (M, N).
pub(crate) fn rows<T: Deserialize + Clone, const N: usize, R: Read + Seek>(
    archive: &mut NpzArchive<R>,
    name: &str,
) -> io::Result<Vec<[T; N]>> {
    let (values, shape) = values(archive, name, u64::MAX)?;
    if shape.len() != 2 || shape[1] != N as u64 {
        return Err(invalid(format!("the array {name} has shape {shape:?}, but must be (M, {N})")));
    }
    Ok(values.as_chunks::<N>().0.to_vec())
}

pub(crate) fn has<R: Read + Seek>(archive: &NpzArchive<R>, name: &str) -> bool {
    archive.array_names().any(|found| found == name)
}

pub(crate) fn invalid(what: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

/// Values and shape of an array of at most `most` values.
pub(crate) fn values<T: Deserialize, R: Read + Seek>(
    archive: &mut NpzArchive<R>,
    name: &str,
    most: u64,
) -> io::Result<(Vec<T>, Vec<u64>)> {
    let Some(array) = archive.by_name(name)? else {
        return Err(invalid(format!("there is no array {name}")));
    };
    let shape = array.shape().to_vec();
    let count = shape.iter().try_fold(1_u64, |product, &n| product.checked_mul(n)).unwrap_or(u64::MAX);
    if count > most {
        return Err(invalid(format!("the array {name} is too large")));
    }
    if array.order() == Order::Fortran && shape.len() > 1 {
        return Err(invalid(format!("the array {name} is in Fortran order; save it with numpy.ascontiguousarray")));
    }
    let reader = array.data::<T>().map_err(|e| invalid(format!("array {name}: {e}")))?;
    // the shape is not to be trusted with an allocation: the vector grows with what is really there
    let mut values = Vec::new();
    for value in reader {
        values.push(value?);
    }
    Ok((values, shape))
}
