//! Columns of tables of results.

use crate::Frame;

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultColumn {
    /// Its name, with the unit.
    pub name: String,
    /// A value for each row.
    pub values: ResultValues,
}

/// Values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum ResultValues {
    /// Numbers, and the decimals that say something.
    Real(Vec<f64>, usize),
    /// Hours of the day; NaN where there is none.
    Clock(Vec<f64>),
    /// Whole numbers, where there is one.
    Whole(Vec<Option<u64>>),
    /// Words.
    Words(Vec<String>),
}

impl ResultColumn {
    /// A column of numbers with so many decimals.
    #[must_use]
    pub fn real(name: impl Into<String>, values: impl IntoIterator<Item = f64>, decimals: usize) -> Self {
        Self { name: name.into(), values: ResultValues::Real(values.into_iter().collect(), decimals) }
    }

    /// A column of hours of the day.
    #[must_use]
    pub fn clock(name: impl Into<String>, hours: impl IntoIterator<Item = f64>) -> Self {
        Self { name: name.into(), values: ResultValues::Clock(hours.into_iter().collect()) }
    }

    /// A column of counts and numbers of rows.
    #[must_use]
    pub fn whole(name: impl Into<String>, values: impl IntoIterator<Item: Into<Option<usize>>>) -> Self {
        let values = values.into_iter().map(|value| value.into().map(|value| value as u64));
        Self { name: name.into(), values: ResultValues::Whole(values.collect()) }
    }

    /// A column of words.
    #[must_use]
    pub fn words(name: impl Into<String>, values: impl IntoIterator<Item: Into<String>>) -> Self {
        Self { name: name.into(), values: ResultValues::Words(values.into_iter().map(Into::into).collect()) }
    }

    /// Returns its numbers; none of a column of whole numbers or words.
    #[must_use]
    pub fn numbers(&self) -> &[f64] {
        match &self.values {
            ResultValues::Real(values, _) | ResultValues::Clock(values) => values,
            ResultValues::Whole(_) | ResultValues::Words(_) => &[],
        }
    }

    /// Columns x, y and z of places in local metres, in the coordinates of the file.
    #[must_use]
    pub fn coordinates(frame: &Frame, places: &[[f64; 3]]) -> [Self; 3] {
        let axis = |axis: usize| places.iter().map(move |&place| frame.file_from_local(place)[axis]);
        [0, 1, 2].map(|i| Self::real(["x", "y", "z"][i], axis(i), 3))
    }
}
