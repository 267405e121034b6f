//! Conversions of numbers that lose digits or saturate on purpose.

/// Returns the nearest number with 32 bits; infinite beyond their range.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "the nearest number is what is wanted")]
pub const fn to_f32(value: f64) -> f32 {
    value as f32
}

/// Returns the nearest numbers with 32 bits.
#[inline]
#[must_use]
pub fn to_f32s<const N: usize>(values: [f64; N]) -> [f32; N] {
    values.map(to_f32)
}

/// Returns the whole part of a number, as an index: 0 for negative numbers and NaN, `usize::MAX` at most.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
pub const fn to_index(value: f64) -> usize {
    value as usize
}

/// Returns a number without its fraction: 0 for NaN, limited to the range of `i32`.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
pub const fn to_i32(value: f64) -> i32 {
    value as i32
}

/// Returns a number without its fraction: 0 for NaN, limited to the range of `i64`.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
pub const fn to_i64(value: f64) -> i64 {
    value as i64
}

/// Returns a number without its fraction: 0 for negative numbers and NaN, `u8::MAX` at most.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
pub const fn to_u8(value: f64) -> u8 {
    value as u8
}

/// Returns a number without its fraction: 0 for negative numbers and NaN, `u32::MAX` at most.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
pub const fn to_u32(value: f64) -> u32 {
    value as u32
}

/// Returns the number of the cell that a place, in cells, lies in: clear of the ends of `i32`, so that cells around it
/// exist.
#[inline]
#[must_use]
pub fn to_cell(place: f64) -> i32 {
    to_i32(place.floor()).clamp(i32::MIN / 4, i32::MAX / 4)
}

/// Returns an index or a count with 32 bits, as rows of clouds and balls are numbered: `u32::MAX` at most.
#[inline]
#[must_use]
pub fn to_row(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

/// Returns bits that ascend as numbers do, below zero too.
#[inline]
#[must_use]
pub const fn to_ascending_bits(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversions_saturate() {
        assert_eq!(to_f32s([0.1, 1e300]), [0.1, f32::INFINITY]);
        assert_eq!([to_index(-2.5), to_index(f64::NAN), to_index(3.99)], [0, 0, 3]);
        assert_eq!([to_i32(-1e10), to_i32(-1.9)], [i32::MIN, -1]);
        assert_eq!([to_i64(f64::INFINITY), to_i64(2.5)], [i64::MAX, 2]);
        assert_eq!([to_u8(256.0), to_u8(-1.0)], [255, 0]);
        assert_eq!([to_u32(1e10), to_u32(-1.0)], [u32::MAX, 0]);
        assert_eq!([to_cell(-0.5), to_cell(2.9), to_cell(1e12)], [-1, 2, i32::MAX / 4]);
        assert!([-f32::INFINITY, -2.0, -0.5, 0.0, 1e-40, 3.0].map(to_ascending_bits).is_sorted());
        assert_eq!([to_row(7), to_row(usize::MAX)], [7, u32::MAX]);
    }
}
