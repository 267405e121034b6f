//! Report, headline and remarks on the way to an answer.

use super::remark::Remark;
use super::report::Report;
use belvedere_data::report::rounded;

/// Report, headline and remarks gathered on the way to an answer.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// All figures.
    pub report: Report,
    pub(super) headline: Vec<String>,
    pub(super) remarks: Vec<Remark>,
}

impl Context {
    /// Adds a remark, if there is one.
    pub fn add(&mut self, remark: Option<Remark>) {
        // what is found on two ways is said once
        self.remarks.extend(remark.filter(|remark| !self.remarks.contains(remark)));
    }

    /// Adds a line of the answer.
    pub fn headline(&mut self, line: String) {
        self.headline.push(line);
    }
}

/// Describes the statistics of values, such as "mean 5.3 hours (0 to 11.2)"; values that are not finite do not count.
pub(super) fn spread(values: &[f32], digits: i32, unit: &str) -> String {
    let known = || values.iter().filter(|value| value.is_finite()).map(|&value| f64::from(value));
    let count = known().count();
    if count == 0 {
        return "no target has an answer".to_owned();
    }
    let figures = [
        known().sum::<f64>() / count as f64,
        known().fold(f64::INFINITY, f64::min),
        known().fold(f64::NEG_INFINITY, f64::max),
    ];
    let [mean, low, high] = figures.map(|value| rounded(value, digits));
    let space = if unit.is_empty() || unit == "%" { "" } else { " " };
    match low < high {
        true => format!("mean {mean}{space}{unit} ({low} to {high})"),
        false => format!("{mean}{space}{unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_value_has_no_spread() {
        assert_eq!(spread(&[5.25, f32::NAN], 1, "hours"), "5.3 hours");
        assert_eq!(spread(&[5.0, 6.0], 1, "%"), "mean 5.5% (5 to 6)");
        assert_eq!(spread(&[f32::NAN], 1, "%"), "no target has an answer");
    }
}
