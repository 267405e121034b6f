//! Arrays of NumPy's archive format, written and read. Every size in a header is checked against the size of the data.

use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};

use bytemuck::Pod;
use npyz::{AutoSerialize, Deserialize, Order, WriteOptions, WriterBuilder};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::arrays::header::read_header;

/// Writes an archive, whose arrays `body` appends.
pub(crate) fn write_archive<W: Write + Seek, E: From<io::Error>>(
    output: W,
    body: impl FnOnce(&mut ZipWriter<ArchiveFile<W>>) -> Result<(), E>,
) -> Result<(), E> {
    let mut archive = ZipWriter::new(ArchiveFile { output, has_failed: false });
    if let Err(error) = body(&mut archive) {
        // dropped, the writer of the crate would end the archive all the same
        std::mem::forget(archive);
        return Err(error);
    }
    Ok(archive.finish().map_err(io::Error::from)?.flush()?)
}

/// The file of an archive. After a failure all further writes seem to succeed: the writer of the crate tries again when
/// it is dropped, and prints the failure then.
pub(crate) struct ArchiveFile<W> {
    output: W,
    has_failed: bool,
}

impl<W> ArchiveFile<W> {
    fn noting_failure<T>(&mut self, done: io::Result<T>) -> io::Result<T> {
        self.has_failed |= done.as_ref().is_err_and(|error| error.kind() != io::ErrorKind::Interrupted);
        done
    }
}

impl<W: Write> Write for ArchiveFile<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.has_failed {
            return Ok(bytes.len());
        }
        let written = self.output.write(bytes);
        self.noting_failure(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.has_failed {
            return Ok(());
        }
        let flushed = self.output.flush();
        self.noting_failure(flushed)
    }
}

impl<W: Seek> Seek for ArchiveFile<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        if self.has_failed {
            return Ok(0);
        }
        let found = self.output.seek(to);
        self.noting_failure(found)
    }
}

/// Appends an array to an archive.
pub(crate) fn array<T: AutoSerialize, W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = T>,
) -> io::Result<()> {
    // stored, as NumPy does: floats hardly shrink, and loading stays a copy; without the time of day, so that the same
    // balls give the same bytes
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        .last_modified_time(zip::DateTime::default())
        .large_file(true);
    archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
    let mut writer = WriteOptions::new().writer(archive).default_dtype().shape(shape).begin_nd()?;
    writer.extend(values)?;
    writer.finish()
}

/// Bytes that all arrays of an archive may hold together, whatever its size.
const MAX_BYTES_OF_SMALL: u64 = 1 << 26;
/// Bytes that all arrays may hold for each byte of the archive. Compressed balls hold 2 to 4, matrices of open land at
/// most 20.
const MAX_BYTES_FOR_EACH: u64 = 100;
/// Bytes of an entry that are read at once.
const BUFFER_BYTES: usize = 1 << 16;
/// Values of an array that are read first; then as many again as are there.
const VALUES_AT_ONCE: usize = 1 << 16;
/// The record that ends an archive without a comment.
const END_BYTES: usize = 22;

/// Opens an archive of `size` bytes whose directory does not contradict itself, and whose arrays are not far larger
/// than the archive.
///
/// # Errors
/// [`io::ErrorKind::InvalidData`] where it is damaged or would expand beyond reason.
pub(crate) fn open<R: Read + Seek>(mut reader: R, size: u64) -> io::Result<ZipArchive<R>> {
    let mut end = [0; END_BYTES];
    if size >= END_BYTES as u64 {
        reader.seek(SeekFrom::Start(size - END_BYTES as u64))?;
        reader.read_exact(&mut end)?;
        reader.seek(SeekFrom::Start(0))?;
    }
    // the directory counts its entries twice; the crate reads as many as the first says and would not miss the others
    if end.starts_with(b"PK\x05\x06") && end[8..10] != end[10..12] {
        return Err(invalid("its directory is damaged: two counts of its entries differ".to_owned()));
    }
    let mut entries = ZipArchive::new(reader).map_err(|error| invalid(error.to_string()))?;
    if let Some(name) = entries.file_names().find(|name| !name.ends_with(".npy")) {
        return Err(invalid(format!("its entry {name:?} is not an array")));
    }
    let mut bytes = 0_u64;
    for index in 0..entries.len() {
        bytes = bytes.saturating_add(entries.by_index_raw(index)?.size());
    }
    let max = size.saturating_mul(MAX_BYTES_FOR_EACH).max(MAX_BYTES_OF_SMALL);
    if bytes > max {
        return Err(invalid(format!(
            "its {size} bytes would expand to {bytes}, more than {MAX_BYTES_FOR_EACH} times as many"
        )));
    }
    Ok(entries)
}

/// The rows of an array of shape (M, N).
pub(crate) fn rows<T: Number, const N: usize, R: Read + Seek>(
    archive: &mut ZipArchive<R>,
    name: &str,
) -> io::Result<Vec<[T; N]>> {
    let (values, shape) = values(archive, name, u64::MAX)?;
    if shape.len() != 2 || shape[1] != N as u64 {
        return Err(invalid(format!("the array {name} has shape {shape:?}, but must be (M, {N})")));
    }
    Ok(bytemuck::try_cast_vec(values).unwrap_or_else(|(_, values)| values.as_chunks::<N>().0.to_vec()))
}

/// Numbers of arrays. In a file of the processor's byte order they are the bytes of memory.
pub(crate) trait Number: Deserialize + AutoSerialize + Pod {}

impl<T: Deserialize + AutoSerialize + Pod> Number for T {}

/// Names of the arrays of an archive.
pub(crate) fn array_names<R: Read + Seek>(archive: &ZipArchive<R>) -> impl Iterator<Item = &str> {
    archive.file_names().filter_map(npyz::npz::array_name_from_file_name)
}

pub(crate) fn has<R: Read + Seek>(archive: &ZipArchive<R>, name: &str) -> bool {
    array_names(archive).any(|found| found == name)
}

pub(crate) fn invalid(what: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

/// Reads values and shape of an array of at most `max` values, and checks the sum of the whole.
pub(crate) fn values<T: Number, R: Read + Seek>(
    archive: &mut ZipArchive<R>,
    name: &str,
    max: u64,
) -> io::Result<(Vec<T>, Vec<u64>)> {
    if !has(archive, name) {
        return Err(invalid(format!("there is no array {name}")));
    }
    let file = archive.by_name(&npyz::npz::file_name_from_array_name(name)).map_err(io::Error::from);
    let file = file?;
    let size = file.size();
    // what is compressed may go on beyond the size that its entry states
    let mut file = file.take(size.saturating_add(1));
    let header = read_header(&mut file).map_err(|e| invalid(format!("array {name}: {e}")))?;
    let shape = header.shape().to_vec();
    let count = shape.iter().try_fold(1_u64, |product, &n| product.checked_mul(n));
    let bytes_of_values = count.zip(header.dtype().num_bytes()).and_then(|(n, each)| n.checked_mul(each as u64));
    if bytes_of_values.is_none() || bytes_of_values != file.limit().checked_sub(1) {
        return Err(invalid(format!("array {name} is damaged: its shape {shape:?} does not fit its {size} bytes")));
    }
    if header.order() == Order::Fortran && shape.len() > 1 {
        let what = format!("the array {name} is in Fortran order; save it with numpy.ascontiguousarray");
        return Err(invalid(what));
    }
    let Some(count) = count.and_then(|count| usize::try_from(count).ok()).filter(|&count| count as u64 <= max) else {
        return Err(invalid(format!("the array {name} is too large")));
    };
    let mut file = BufReader::with_capacity(BUFFER_BYTES, file);
    let mut values = Vec::new();
    if header.dtype() == T::default_dtype() {
        // the shape was checked against the size of the entry, but that size not yet against the data: step by step
        while values.len() < count {
            let start = values.len();
            values.resize(count.min(start + start.max(VALUES_AT_ONCE)), T::zeroed());
            file.read_exact(bytemuck::cast_slice_mut(&mut values[start..]))?;
        }
    } else {
        let data = npyz::NpyFile::with_header(header, &mut file).data::<T>();
        for value in data.map_err(|e| invalid(format!("array {name}: {e}")))? {
            values.push(value?);
        }
    }
    // the checksum of an entry is tested at its end, which the values alone do not reach
    let beyond = io::copy(&mut file, &mut io::sink()).map_err(|e| invalid(format!("array {name} is damaged: {e}")))?;
    if beyond > 0 {
        return Err(invalid(format!("array {name} is damaged: it is longer than the {size} bytes stated")));
    }
    Ok((values, shape))
}
