//! The header of a NumPy array, checked before the crate `npyz` sees it.
//!
//! That crate allocates the length that a header claims, descends into brackets without limit, and multiplies the sides
//! of the array without looking for overflow.

use std::io::{self, Read};

use npyz::NpyHeader;

/// Headers that NumPy writes have some hundred bytes.
const MAX_HEADER: usize = 1 << 16;

/// A header is a dictionary that holds a tuple; descriptions of structures nest a little deeper.
const MAX_NESTING: usize = 8;

/// The header of the array that `reader` holds from its present position on; leaves the reader at the numbers.
///
/// # Errors
/// [`io::ErrorKind::InvalidData`] for data that are no array, and those of reading.
pub(crate) fn read_header(reader: &mut impl Read) -> io::Result<NpyHeader> {
    let invalid = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what.to_owned());
    let mut start = [0; 8];
    reader.read_exact(&mut start)?;
    if !start.starts_with(b"\x93NUMPY") {
        return Err(invalid("it does not begin with \\x93NUMPY"));
    }
    let mut header = start.to_vec();
    let length = if start[6] >= 2 {
        let mut bytes = [0; 4];
        reader.read_exact(&mut bytes)?;
        header.extend(bytes);
        usize::try_from(u32::from_le_bytes(bytes)).unwrap_or(usize::MAX)
    } else {
        let mut bytes = [0; 2];
        reader.read_exact(&mut bytes)?;
        header.extend(bytes);
        usize::from(u16::from_le_bytes(bytes))
    };
    if length > MAX_HEADER {
        return Err(invalid("its header is damaged"));
    }
    let mut text = vec![0; length];
    reader.read_exact(&mut text)?;
    if !is_shallow(&text) || !sides_multiply(&String::from_utf8_lossy(&text)) {
        return Err(invalid("its header is damaged"));
    }
    header.extend(text);
    NpyHeader::from_reader(header.as_slice())
}

fn is_shallow(text: &[u8]) -> bool {
    let mut depth = 0_usize;
    text.iter().all(|byte| {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth <= MAX_NESTING
    })
}

/// Returns true if the product of the sides fits 64 bits.
fn sides_multiply(header: &str) -> bool {
    let sides = header
        .split_once("shape")
        .and_then(|(_, after)| after.split_once('('))
        .and_then(|(_, after)| after.split_once(')'))
        .map_or("", |(sides, _)| sides);
    let sides = sides.split(',').map(str::trim).filter(|side| !side.is_empty());
    sides.map(|side| side.parse::<u64>().ok()).try_fold(1_u64, |product, side| product.checked_mul(side?)).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(header: &str) -> Option<Vec<u64>> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
        bytes.extend(header.bytes());
        read_header(&mut bytes.as_slice()).ok().map(|header| header.shape().to_vec())
    }

    #[test]
    fn headers_that_would_overflow_are_refused() {
        let header = |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        assert_eq!(opened(&header("(60, 3)")), Some(vec![60, 3]));
        assert_eq!(opened(&header("(7,)")), Some(vec![7]));
        assert_eq!(opened(&header("()")), Some(vec![]));
        assert_eq!(opened(&header("(4294967296, 4294967296)")), None);
        assert_eq!(opened(&header("(99999999999999999999, 3)")), None);
        assert_eq!(opened(&"(".repeat(60_000)), None);
        assert!(read_header(&mut &b"\x93NUMPY\x02\x00\xff\xff\xff\xff"[..]).is_err());
    }
}
