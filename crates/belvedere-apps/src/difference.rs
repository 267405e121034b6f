//! Difference between two results on the same cells: before and after a plan.

use crate::viewshed::SEEN;
use belvedere_data::Result;
use belvedere_data::contradiction::{DIFFERENT_QUANTITIES, DIFFERENT_SUNS, FoundContradiction};
use belvedere_data::error::check_length;
use belvedere_data::report::rounded;
use serde::Serialize;

/// Maximum change, as a share of the largest one, that counts as none: the rounding of equal values.
const ROUNDING: f64 = 1e-6;

/// Separator between the description of a raster and its subject.
const SUBJECT: &str = "; ";

/// The description of a raster of one of several things alike, such as the shadow of one of several suns.
#[must_use]
pub fn described(description: &str, subject: &str) -> String {
    if subject.is_empty() { description.to_owned() } else { format!("{description}{SUBJECT}{subject}") }
}

/// Returns the contradiction between the descriptions of two named rasters: other quantities, or the same of other
/// suns. `None` if one of them is not described.
#[must_use]
pub fn contradiction_of(before: [&str; 2], after: [&str; 2]) -> Option<FoundContradiction> {
    let [[before, first], [after, second]] = [before, after];
    let parts = |text: &str| -> [String; 2] {
        let (description, subject) = text.split_once(SUBJECT).unwrap_or((text, ""));
        [description, subject].map(str::to_owned)
    };
    let [[first, of_first], [second, of_second]] = [first, second].map(parts);
    if first != second && !first.is_empty() && !second.is_empty() {
        let text = format!(
            "{before} holds \"{first}\" and {after} \"{second}\"; a difference of different quantities means nothing"
        );
        return Some(DIFFERENT_QUANTITIES.found(text));
    }
    let text = format!(
        "{before} is \"{of_first}\", and {after} \"{of_second}\": what changes is the sun as well, and not only what stands there"
    );
    (of_first != of_second && !of_first.is_empty() && !of_second.is_empty()).then(|| DIFFERENT_SUNS.found(text))
}

/// The change of each cell, and its sums.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// After less before, one for each cell; NaN where either has no value.
    pub values: Vec<f32>,
    /// Sums over all cells.
    pub report: DifferenceReport,
}

/// Sums over the cells of two results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DifferenceReport {
    /// Cells with a value before and after.
    pub cells: usize,
    /// Cells with a higher value after.
    pub cells_gain: usize,
    /// Cells with a lower value after.
    pub cells_loss: usize,
    /// Cells with a value before only, such as those below a new building.
    pub cells_only_before: usize,
    /// Cells with a value after only.
    pub cells_only_after: usize,
    /// Area of the cells with a higher value, m².
    pub area_gain_m2: f64,
    /// Area of the cells with a lower value, m².
    pub area_loss_m2: f64,
    /// Mean before, over the cells with a value before and after.
    pub mean_before: f64,
    /// Mean after, over the same cells.
    pub mean_after: f64,
    /// Sum of all gains times the area of a cell, in the unit of the values times m².
    pub sum_gain: f64,
    /// Sum of all losses times the area of a cell, below zero.
    pub sum_loss: f64,
    /// Largest gain of a cell.
    pub largest_gain: f64,
    /// Largest loss of a cell, below zero.
    pub largest_loss: f64,
}

impl DifferenceReport {
    /// Each figure with its name, as in a table.
    #[must_use]
    pub fn figures(&self) -> [(&'static str, f64); 13] {
        [
            ("cells", self.cells as f64),
            ("cells_gain", self.cells_gain as f64),
            ("cells_loss", self.cells_loss as f64),
            ("cells_only_before", self.cells_only_before as f64),
            ("cells_only_after", self.cells_only_after as f64),
            ("area_gain_m2", self.area_gain_m2),
            ("area_loss_m2", self.area_loss_m2),
            ("mean_before", self.mean_before),
            ("mean_after", self.mean_after),
            ("sum_gain", self.sum_gain),
            ("sum_loss", self.sum_loss),
            ("largest_gain", self.largest_gain),
            ("largest_loss", self.largest_loss),
        ]
    }
}

/// Clears the values of unproven cells, and returns their number: in rasters of the view of one observer, which
/// `description` names, they are neither visible nor hidden. `unproven`, (M), is above 0 where a value is not proven.
pub fn clear_unproven(values: &mut [f32], unproven: &[f32], description: Option<&str>) -> usize {
    if description.is_none_or(|text| text.split(SUBJECT).next() != Some(SEEN)) {
        return 0;
    }
    let cells = values.iter_mut().zip(unproven).filter(|(_, unproven)| **unproven > 0.0);
    cells.map(|(value, _)| *value = f32::NAN).count()
}

/// Clears the values of cells on top of added meshes, before and after, and returns their number: they are other places
/// than before. `added`, (M), is above 0 there.
pub fn clear_added(before: &mut [f32], after: &mut [f32], added: &[f32]) -> usize {
    let pairs = before.iter_mut().zip(after).zip(added).filter(|(_, added)| **added > 0.0);
    pairs.map(|((before, after), _)| (*before, *after) = (f32::NAN, f32::NAN)).count()
}

/// The change from `before` to `after`, one value for each cell of `cell_area` m²; NaN for a cell without a value.
///
/// # Errors
/// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) where the numbers of cells differ.
pub fn difference(before: &[f32], after: &[f32], cell_area: f64) -> Result<Difference> {
    check_length("cells after the change", before.len(), after.len())?;
    let mut values: Vec<f32> = before.iter().zip(after).map(|(before, after)| after - before).collect();
    let scale =
        before.iter().chain(after).filter(|v| v.is_finite()).fold(0.0_f64, |max, v| max.max(f64::from(v.abs())));
    values.iter_mut().filter(|v| f64::from(v.abs()) <= ROUNDING * scale).for_each(|v| *v = 0.0);
    let mut report = DifferenceReport::default();
    let mut means = [0.0, 0.0];
    for ((&before, &after), &change) in before.iter().zip(after).zip(&values) {
        match (before.is_finite(), after.is_finite()) {
            (true, false) => report.cells_only_before += 1,
            (false, true) => report.cells_only_after += 1,
            (false, false) => {}
            (true, true) => {
                report.cells += 1;
                means = [means[0] + f64::from(before), means[1] + f64::from(after)];
                let change = f64::from(change);
                if change > 0.0 {
                    report.cells_gain += 1;
                    report.sum_gain += change;
                    report.largest_gain = report.largest_gain.max(change);
                } else if change < 0.0 {
                    report.cells_loss += 1;
                    report.sum_loss += change;
                    report.largest_loss = report.largest_loss.min(change);
                }
            }
        }
    }
    let count = report.cells.max(1) as f64;
    let round = |value: f64| rounded(value, 4);
    report.mean_before = round(means[0] / count);
    report.mean_after = round(means[1] / count);
    report.area_gain_m2 = round(report.cells_gain as f64 * cell_area);
    report.area_loss_m2 = round(report.cells_loss as f64 * cell_area);
    report.sum_gain = round(report.sum_gain * cell_area);
    report.sum_loss = round(report.sum_loss * cell_area);
    report.largest_gain = round(report.largest_gain);
    report.largest_loss = round(report.largest_loss);
    Ok(Difference { values, report })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rasters_of_other_quantities_and_of_other_suns_are_said() {
        let lit = |subject: &str| described("1: lit", subject);
        let [noon, evening] =
            ["Shadow, sun at azimuth 180, elevation 60 degrees", "Shadow, sun at azimuth 290, elevation 9 degrees"];
        let said = |first: &str, second: &str| {
            contradiction_of(["a.tif", first], ["b.tif", second]).map(|found| found.row.key)
        };
        assert_eq!(said(&lit(noon), &lit(noon)), None);
        assert_eq!(said(&lit(noon), &lit("")), None);
        assert_eq!(said(&lit(noon), ""), None);
        assert_eq!(said(&lit(noon), &lit(evening)), Some("different-suns"));
        assert_eq!(said(&lit(noon), "hours of sun a day"), Some("different-quantities"));
    }

    #[test]
    fn gains_and_losses_are_summed_apart_and_cells_without_a_value_counted() {
        let none = f32::NAN;
        let before = [1.0, 2.0, 3.0, none, 4.0, none, 5.0];
        let after = [1.0, 4.5, 1.0, 7.0, none, none, 4.0];
        let Difference { values, report } = difference(&before, &after, 0.25).unwrap();
        assert_eq!((values[..3].to_vec(), values[6]), (vec![0.0, 2.5, -2.0], -1.0));
        assert!(values[3..6].iter().all(|v| v.is_nan()));
        assert_eq!((report.cells, report.cells_gain, report.cells_loss), (4, 1, 2));
        assert_eq!((report.cells_only_before, report.cells_only_after), (1, 1));
        assert_eq!(
            (report.sum_gain, report.sum_loss, report.largest_gain, report.largest_loss),
            (0.625, -0.75, 2.5, -2.0)
        );
        assert_eq!((report.mean_before, report.mean_after, report.area_loss_m2), (2.75, 2.625, 0.5));
        assert!(difference(&before, &after[1..], 1.0).is_err());
        for (description, count) in [(Some(SEEN), 2), (Some("hours of sun a day"), 0), (None, 0)] {
            let mut values = [0.0, 1.0, 1.0, f32::NAN, 1.0];
            let unproven = [0.0, 1.0, 0.0, f32::NAN, 1.0];
            assert_eq!(clear_unproven(&mut values, &unproven, description), count);
            assert_eq!(values.iter().filter(|v| v.is_nan()).count(), 1 + count);
        }
        let (mut before, mut after) = ([1.0, 2.0, 3.0], [4.0, 9.0, 3.0]);
        assert_eq!(clear_added(&mut before, &mut after, &[0.0, 1.0, f32::NAN]), 1);
        let report = difference(&before, &after, 1.0).unwrap().report;
        assert_eq!((report.cells_gain, report.sum_gain, report.cells_only_before), (1, 3.0, 0));
        // what f32 rounds is no change
        assert_eq!(difference(&[1000.0], &[1000.0001], 1.0).unwrap().report.cells_gain, 0);
    }
}
