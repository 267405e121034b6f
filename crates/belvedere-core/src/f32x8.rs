//! Eight numbers at once in WebAssembly, in two halves, for the tests of boxes, points and balls by indexes in a
//! browser.

use core::arch::wasm32::*;

/// Eight numbers.
#[derive(Clone, Copy)]
pub(crate) struct Eight([v128; 2]);

impl Eight {
    #[inline(always)]
    pub(crate) fn of(values: &[f32; 8]) -> Self {
        let [a, b, c, d, e, f, g, h] = *values;
        Self([f32x4(a, b, c, d), f32x4(e, f, g, h)])
    }

    /// Bytes as numbers.
    #[inline(always)]
    pub(crate) fn of_bytes(bytes: [u8; 8]) -> Self {
        let words = u16x8_extend_low_u8x16(i64x2(i64::from_le_bytes(bytes), 0));
        let numbers = |words| f32x4_convert_u32x4(words);
        Self([numbers(u32x4_extend_low_u16x8(words)), numbers(u32x4_extend_high_u16x8(words))])
    }

    /// The same number eight times.
    #[inline(always)]
    pub(crate) fn all(value: f32) -> Self {
        Self([f32x4_splat(value); 2])
    }

    #[inline(always)]
    pub(crate) fn into_array(self) -> [f32; 8] {
        let four = |v| {
            (
                f32x4_extract_lane::<0>(v),
                f32x4_extract_lane::<1>(v),
                f32x4_extract_lane::<2>(v),
                f32x4_extract_lane::<3>(v),
            )
        };
        let ((a, b, c, d), (e, f, g, h)) = (four(self.0[0]), four(self.0[1]));
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn with(self, other: Self, both: impl Fn(v128, v128) -> v128) -> Self {
        Self([both(self.0[0], other.0[0]), both(self.0[1], other.0[1])])
    }

    /// The larger of each two, as `if a < b { b } else { a }` gives it.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        self.with(other, |a, b| f32x4_pmax(a, b))
    }

    /// The smaller of each two, as `if b < a { b } else { a }` gives it.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        self.with(other, |a, b| f32x4_pmin(a, b))
    }

    /// Returns a bit mask of the lanes in which it is at most the other.
    #[inline(always)]
    pub(crate) fn at_most(self, other: Self) -> u32 {
        let [low, high] = self.with(other, |a, b| f32x4_le(a, b)).0.map(|mask| u32::from(i32x4_bitmask(mask)));
        low | high << 4
    }

    /// Returns a bit mask of the lanes in which it is below the other.
    #[inline(always)]
    pub(crate) fn less_than(self, other: Self) -> u32 {
        let [low, high] = self.with(other, |a, b| f32x4_lt(a, b)).0.map(|mask| u32::from(i32x4_bitmask(mask)));
        low | high << 4
    }
}

impl std::ops::Add for Eight {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| f32x4_add(a, b))
    }
}

impl std::ops::Sub for Eight {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| f32x4_sub(a, b))
    }
}

impl std::ops::Mul for Eight {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| f32x4_mul(a, b))
    }
}

impl std::ops::Div for Eight {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| f32x4_div(a, b))
    }
}
