//! Values of targets, with the data to write and draw them.

use super::ResultKind;
use belvedere_data::report::rounded;
use belvedere_data::result_columns::ResultColumn;
use serde::Serialize;

/// One figure for each target.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Name of its column and of its raster, of 15 letters at most.
    pub name: String,
    /// Description with its unit, at most 31 letters.
    pub description: &'static str,
    /// Unit of its values, such as `h`; `1` for values without one. Default: `1`.
    pub unit: &'static str,
    /// Subject that separates it from measures alike, such as the sun of a shadow; rasters have it behind the
    /// description. Empty if there is only one.
    pub subject: String,
    /// Names and texts of the metadata of its raster, such as the time of a sun.
    pub tags: Vec<(String, String)>,
    /// Digits after the point in tables.
    pub decimals: usize,
    /// Range of a legend; `None` for the range of the values.
    pub range: Option<[f64; 2]>,
    /// Kind of its values, which decides the type of its raster. Default: numbers.
    pub kind: ResultKind,
    /// (M), NaN where there is none.
    pub values: Vec<f32>,
}

/// Statistics of the values of a measure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeasureStatistics {
    /// Mean of the values, all counting alike.
    pub mean: f64,
    /// Minimum value.
    pub min: f64,
    /// Maximum value.
    pub max: f64,
}

impl Measure {
    /// Values with the name of their column; four digits in tables, and a legend that spans the values.
    #[must_use]
    pub fn new(name: &str, values: Vec<f32>) -> Self {
        let (name, kind) = (name.to_owned(), ResultKind::Number);
        let (subject, tags) = (String::new(), Vec::new());
        Self { name, description: "", unit: "1", subject, tags, decimals: 4, range: None, kind, values }
    }

    /// This with another description.
    #[must_use]
    pub fn with_description(self, description: &'static str) -> Self {
        Self { description, ..self }
    }

    /// This with the unit of its values.
    #[must_use]
    pub fn with_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// This with metadata of its raster.
    #[must_use]
    pub fn with_tags(self, tags: &[(String, String)]) -> Self {
        Self { tags: tags.to_vec(), ..self }
    }

    /// This with a subject that tells it from similar ones.
    #[must_use]
    pub fn with_subject(self, subject: &str) -> Self {
        Self { subject: subject.to_owned(), ..self }
    }

    /// This with another number of digits after the point.
    #[must_use]
    pub fn with_decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    /// This with another span of its legend.
    #[must_use]
    pub fn with_range(self, range: Option<[f64; 2]>) -> Self {
        Self { range, ..self }
    }

    /// This with another kind of values.
    #[must_use]
    pub fn with_kind(self, kind: ResultKind) -> Self {
        Self { kind, ..self }
    }

    /// The same measure of no target.
    #[must_use]
    pub fn without_values(&self) -> Self {
        let (name, subject, tags) = (self.name.clone(), self.subject.clone(), self.tags.clone());
        Self { name, subject, tags, values: Vec::new(), ..*self }
    }

    /// Its values as a column of a table.
    #[must_use]
    pub fn to_column(&self) -> ResultColumn {
        ResultColumn::real(&self.name, self.values.iter().map(|&value| f64::from(value)), self.decimals)
    }

    /// Returns the statistics of the known values; `None` if no target has a value.
    #[must_use]
    pub fn statistics(&self) -> Option<MeasureStatistics> {
        let known = || self.values.iter().filter(|v| v.is_finite()).map(|&v| f64::from(v));
        let count = known().count();
        (count > 0).then(|| MeasureStatistics {
            mean: known().sum::<f64>() / count as f64,
            min: known().fold(f64::INFINITY, f64::min),
            max: known().fold(f64::NEG_INFINITY, f64::max),
        })
    }

    /// The same, rounded to the digits of the measure.
    #[must_use]
    pub fn rounded_statistics(&self) -> Option<MeasureStatistics> {
        let digits = i32::try_from(self.decimals).unwrap_or(3);
        self.statistics().map(|found| MeasureStatistics {
            mean: rounded(found.mean, digits),
            min: rounded(found.min, digits),
            max: rounded(found.max, digits),
        })
    }

    /// Returns the range of a legend for `values` of this measure: its own, or theirs.
    #[must_use]
    pub fn span(&self, values: &[f64]) -> [f64; 2] {
        self.range.unwrap_or_else(|| {
            let known = || values.iter().copied().filter(|v| v.is_finite());
            let (low, high) = (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
            if low < high { [low, high] } else { [low.min(0.0), low.max(0.0) + 1.0] }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(values: &[f32]) -> Measure {
        Measure::new("m", values.to_vec()).with_decimals(1)
    }

    #[test]
    fn statistics_are_those_of_known_values() {
        let found = measure(&[1.0, f32::NAN, 4.0, f32::INFINITY]).statistics().unwrap();
        assert_eq!((found.mean, found.min, found.max), (2.5, 1.0, 4.0));
        assert_eq!(measure(&[f32::NAN]).statistics(), None);
    }

    #[test]
    fn a_legend_of_equal_values_still_spans_something() {
        assert_eq!(measure(&[]).span(&[2.0, 5.0, f64::NAN]), [2.0, 5.0]);
        assert_eq!(measure(&[]).span(&[3.0, 3.0]), [0.0, 4.0]);
        assert_eq!(Measure { range: Some([0.0, 1.0]), ..measure(&[]) }.span(&[3.0]), [0.0, 1.0]);
    }
}
