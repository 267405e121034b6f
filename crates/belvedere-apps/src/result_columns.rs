//! Columns of tables of results.

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
    pub fn real(name: impl Into<String>, values: Vec<f64>, decimals: usize) -> Self {
        Self { name: name.into(), values: ResultValues::Real(values, decimals) }
    }

    /// A column of words.
    #[must_use]
    pub fn words(name: impl Into<String>, values: Vec<String>) -> Self {
        Self { name: name.into(), values: ResultValues::Words(values) }
    }
}
