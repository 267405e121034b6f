//! Views of windows summed up by the building that they belong to.

use super::{SeenKind, WindowView};
use crate::result_columns::ResultColumn;
use serde::Serialize;

/// The mean view from the windows of one building, by their weight.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedView {
    /// Name of the building.
    pub name: String,
    /// Number of its windows, those without a view left out.
    pub windows: usize,
    /// Mean share of each of [`SeenKind::ALL`], 0 to 1; NaN where no window has a view.
    pub shares: [f64; SeenKind::ALL.len()],
    /// Minimum and maximum share of vegetation and water of a window: the green and blue of the worst and of the best
    /// view.
    pub green_and_blue: [f64; 2],
}

/// Returns the mean of `views`, (W), for each name, (W), weighted by `weights`, (W), such as the area of a window.
/// Names are in the order of their first occurrence.
#[must_use]
pub fn views_by_name(views: &[WindowView], names: &[&str], weights: &[f64]) -> Vec<NamedView> {
    let mut rows: std::collections::HashMap<&str, usize> = std::collections::HashMap::new();
    let mut found: Vec<(NamedView, f64)> = Vec::new();
    for ((view, &name), &weight) in views.iter().zip(names).zip(weights) {
        let row = *rows.entry(name).or_insert(found.len());
        if row == found.len() {
            let (shares, green_and_blue) = ([0.0; SeenKind::ALL.len()], [f64::INFINITY, f64::NEG_INFINITY]);
            found.push((NamedView { name: name.to_owned(), windows: 0, shares, green_and_blue }, 0.0));
        }
        let (named, whole) = &mut found[row];
        if view.shares.iter().all(|share| share.is_finite()) {
            named.windows += 1;
            *whole += weight;
            named.shares.iter_mut().zip(view.shares).for_each(|(sum, share)| *sum += weight * share);
            let pleasant = view.shares[SeenKind::Vegetation as usize] + view.shares[SeenKind::Water as usize];
            named.green_and_blue = [named.green_and_blue[0].min(pleasant), named.green_and_blue[1].max(pleasant)];
        }
    }
    let finished = |(mut named, whole): (NamedView, f64)| {
        named.shares = named.shares.map(|sum| sum / whole);
        if named.windows == 0 {
            named.green_and_blue = [f64::NAN; 2];
        }
        named
    };
    found.into_iter().map(finished).collect()
}

/// The figures of buildings by name, percent: mean shares of each of [`SeenKind::ALL`], then the green and blue of the
/// worst and of the best view.
#[must_use]
pub fn named_columns(views: &[NamedView]) -> Vec<ResultColumn> {
    let percent = |name: &str, share: &dyn Fn(&NamedView) -> f64| {
        ResultColumn::real(name, views.iter().map(|named| 100.0 * share(named)), 3)
    };
    let shares = SeenKind::ALL.iter().enumerate().map(|(i, seen)| percent(seen.name(), &|named| named.shares[i]));
    let pleasant = ["least_green_and_blue", "most_green_and_blue"].into_iter().enumerate();
    shares.chain(pleasant.map(|(i, name)| percent(name, &|named| named.green_and_blue[i]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buildings_have_the_means_of_their_windows_by_weight() {
        let view = |shares: [f64; 7]| WindowView {
            shares,
            cosine_shares: shares,
            mean_range: 1.0,
            median_range: 1.0,
            unproven: 0.0,
        };
        let views = [
            view([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            view([0.5, 0.25, 0.25, 0.0, 0.0, 0.0, 0.0]),
            view([f64::NAN; 7]),
            view([0.0, 0.1, 0.0, 0.9, 0.0, 0.0, 0.0]),
            view([f64::NAN; 7]),
        ];
        let named = views_by_name(&views, &["b", "a", "b", "b", "c"], &[3.0, 1.0, 9.0, 1.0, 1.0]);
        let names: Vec<(&str, usize)> = named.iter().map(|named| (named.name.as_str(), named.windows)).collect();
        assert_eq!(names, [("b", 2), ("a", 1), ("c", 0)]);
        assert!((named[0].shares[0] - 0.75).abs() < 1e-12 && (named[0].shares[3] - 0.225).abs() < 1e-12);
        assert_eq!((named[0].green_and_blue, named[1].green_and_blue), ([0.0, 0.1], [0.5, 0.5]));
        assert!(named[2].shares[0].is_nan() && named[2].green_and_blue[0].is_nan());
    }
}
