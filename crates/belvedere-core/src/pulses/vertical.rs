//! Pulses that are assumed to fall straight down, where the position of the scanner is unknown.

use super::flight_parts::check_range;
use belvedere_data::Result;
use belvedere_data::cast::to_cell;
use belvedere_data::control::{Control, Stop};
use rayon::prelude::*;

/// Height of the assumed scanner above its point, metres: a usual flying height, above everything.
const HEIGHT: f32 = 1000.0;

/// Minimum share of points with nothing above them for which vertical pulses are assumed. Clouds of aircraft have three
/// quarters or more. Where the scanner stood among walls it is a fifth, and carving by wrong pulses blocks most of the
/// visible space.
pub(crate) const MIN_ASSUMED_SHARE: f64 = 0.5;

/// Selection of points that count as ends of vertical pulses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerticalParams {
    /// Horizontal distance within which a point above hides another, metres, 0.05 to 10. Default 0.2, half the spacing
    /// of usual surveys. On simulated towns, 0.5 keeps so many pulses off walls that facades lose 9 points; 0.2 loses
    /// 3, and 0.1 lets pulses through crowns.
    pub reach: f32,
    /// Minimum height of that other point above this one, metres, 0 to 100. Default 0.5: with less, the slope of a roof
    /// hides itself.
    pub rise: f32,
}

impl Default for VerticalParams {
    fn default() -> Self {
        Self { reach: 0.2, rise: 0.5 }
    }
}

/// Assumed scanner of each of `positions`, (N, 3) local metres: a kilometre above the points that no other stands
/// above, NaN for the rest.
///
/// # Errors
/// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) for parameters outside their ranges,
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn vertical_pulses(
    positions: &[[f32; 3]],
    params: &VerticalParams,
    control: &Control<'_>,
) -> Result<Vec<[f32; 3]>> {
    let stop = Stop::new(control);
    check_range("search radius of points above", params.reach, 0.05..=10.0, "0.05 to 10 m")?;
    check_range("minimum height of points above", params.rise, 0.0..=100.0, "0 to 100 m")?;
    let cell = |p: &[f32; 3]| [p[0], p[1]].map(|v| to_cell(f64::from(v / params.reach)));
    // by cell, the highest of each first
    let mut cells: Vec<([i32; 2], [f32; 3])> = positions.par_iter().map(|p| (cell(p), *p)).collect();
    cells.par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1[2].total_cmp(&a.1[2])));
    let is_hidden = |p: &[f32; 3]| {
        let [column, row] = cell(p);
        let limit = p[2] + params.rise;
        (column - 1..=column + 1).any(|column| {
            let from = cells.partition_point(|(at, _)| *at < [column, row - 1]);
            let mut rest = cells.get(from..).unwrap_or_default();
            // three cells of a column follow each other
            while let Some((at, highest)) = rest.first()
                && *at <= [column, row + 1]
            {
                let own = rest.partition_point(|(other, _)| other <= at);
                if highest[2] > limit
                    && rest.iter().take(own).take_while(|(_, q)| q[2] > limit).any(|(_, q)| {
                        let (x, y) = (q[0] - p[0], q[1] - p[1]);
                        x * x + y * y <= params.reach * params.reach
                    })
                {
                    return true;
                }
                rest = rest.get(own..).unwrap_or_default();
            }
            false
        })
    };
    let above = |p: &[f32; 3]| if stop.is_set() || is_hidden(p) { [f32::NAN; 3] } else { [p[0], p[1], p[2] + HEIGHT] };
    let scanner = positions.par_iter().map(above).collect();
    stop.check()?;
    Ok(scanner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    #[test]
    fn what_stands_above_hides_as_in_a_search_through_all_pairs() {
        let mut count = 0;
        let mut next = |size: f64| {
            count += 1;
            to_f32(size * uniform(3, count))
        };
        let points: Vec<[f32; 3]> = (0..2000).map(|_| [next(20.0) - 10.0, next(20.0) - 10.0, next(5.0)]).collect();
        let params = VerticalParams::default();
        let found = vertical_pulses(&points, &params, &Control::none()).unwrap();
        let mut hidden_count = 0;
        for (p, scanner) in points.iter().zip(&found) {
            let hidden = points.iter().any(|q| {
                let (x, y) = (q[0] - p[0], q[1] - p[1]);
                q[2] > p[2] + params.rise && x * x + y * y <= params.reach * params.reach
            });
            assert_eq!(scanner[2].is_nan(), hidden, "{p:?}");
            assert!(hidden || scanner[2] > 900.0);
            hidden_count += usize::from(hidden);
        }
        assert!((200..1900).contains(&hidden_count), "{hidden_count}");
    }

    #[test]
    fn parameters_out_of_range_are_refused() {
        for params in [VerticalParams { reach: 0.0, rise: 0.5 }, VerticalParams { reach: 0.5, rise: f32::NAN }] {
            assert!(matches!(
                vertical_pulses(&[], &params, &Control::none()),
                Err(belvedere_data::Error::InvalidParameter { .. })
            ));
        }
    }
}
