//! Kinds of results: one pixel type and one value for no data for each, whoever writes them.

/// Kind of the values of a result, which decides the type of its pixels and their nodata value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ResultKind {
    /// Yes or no, such as lit, visible or a rule that is met: u8, 1 or 0, [`ResultKind::NO_ANSWER`] where there is
    /// none.
    Answer,
    /// Numbers of observers or cameras: u16, [`ResultKind::NO_COUNT`] where there is none.
    Count,
    /// Measured numbers, such as shares, hours, factors and metres: f32, [`ResultKind::NO_NUMBER`] where there is none.
    /// Default.
    #[default]
    Number,
}

impl ResultKind {
    /// The pixel of no answer.
    pub const NO_ANSWER: u8 = u8::MAX;
    /// The pixel of no count.
    pub const NO_COUNT: u16 = u16::MAX;
    /// The pixel of no number.
    pub const NO_NUMBER: f32 = -9999.0;

    /// Returns the GDAL name of the type of its pixels, and their nodata value.
    #[must_use]
    pub fn in_gdal(self) -> (&'static str, f64) {
        match self {
            Self::Answer => ("Byte", Self::NO_ANSWER.into()),
            Self::Count => ("UInt16", Self::NO_COUNT.into()),
            Self::Number => ("Float32", Self::NO_NUMBER.into()),
        }
    }

    /// The pixel of an answer.
    #[must_use]
    pub fn answer(answer: Option<bool>) -> u8 {
        answer.map_or(Self::NO_ANSWER, u8::from)
    }

    /// The pixel of a count; one that does not fit is the highest that does.
    #[must_use]
    pub fn count(count: Option<u32>) -> u16 {
        let stored = |count: u32| u16::try_from(count).unwrap_or(Self::NO_COUNT).min(Self::NO_COUNT - 1);
        count.map_or(Self::NO_COUNT, stored)
    }

    /// The pixel of a number; one that is not finite is none.
    #[must_use]
    pub fn number(number: f32) -> f32 {
        if number.is_finite() { number } else { Self::NO_NUMBER }
    }
}
