//! Heights of flight lines (strips), compared with each other and fitted.
//!
//! Lines of one survey lie within a few centimetres of each other. Surveys that were not adjusted, or lines of
//! different flights, differ by decimetres. Pulses of the lower line then end below the surface of the higher one, and
//! balls block lines of sight that pulses saw.

use belvedere_data::cast::{to_cell, to_u32};
use belvedere_data::control::Control;
use belvedere_data::vector::to_f32;
use belvedere_data::{PointCloud, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Parameters of the comparison of flight-line heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripParams {
    /// Side of the cells in which lines are compared, metres, above 0. Default 2: at 2 pulses per m², of which half
    /// are of one line, four of its points.
    pub cell: f64,
    /// Minimum number of points of each line in a cell. Default 3.
    pub min_points: usize,
    /// Maximum root mean square distance of the points of two lines in a cell from two parallel planes, metres. Default
    /// 0.08: noise of usual scanners, and no plants.
    pub max_rms: f64,
    /// Steepest slope of these planes, metres a metre. Default 0.5: on steep slopes errors on the map show as heights.
    pub max_slope: f64,
    /// Fewest cells that show the difference of two lines. Default 30.
    pub min_cells: usize,
    /// Cells that are looked at, about. Default 20 000: the median of a thousand is known to a few millimetres.
    pub max_cells: usize,
    /// Differences of two lines that are left as they are, metres. Default 0.05, which adjusted surveys keep.
    pub tolerance: f64,
}

impl Default for StripParams {
    fn default() -> Self {
        Self {
            cell: 2.0,
            min_points: 3,
            max_rms: 0.08,
            max_slope: 0.5,
            min_cells: 30,
            max_cells: 20_000,
            tolerance: 0.05,
        }
    }
}

/// Heights of flight lines against each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StripReport {
    /// Pairs of lines that meet.
    pub pairs: Vec<StripPair>,
    /// Lines and how far their heights are moved. Empty where no pair differs beyond the tolerance.
    pub moved: Vec<StripOffset>,
}

/// Two lines where they meet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StripPair {
    /// Their point source ids.
    pub lines: [u16; 2],
    /// Cells that show both.
    pub cells: usize,
    /// Median height of the second above the first, metres.
    pub rise_m: f64,
    /// Standard deviation of a single cell, metres, from the median deviation.
    pub deviation_m: f64,
}

/// A line, and how far it is moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StripOffset {
    /// Its point source id.
    pub line: u16,
    /// Offset added to its heights, metres, whole millimetres.
    pub up_m: f64,
}

/// A pair differs by chance up to so many standard deviations of its median.
const MAX_DEVIATIONS: f64 = 4.0;
/// Maximum deviation of a pair that counts, metres: a larger one is not a height difference of lines.
const MAX_DEVIATION: f64 = 0.15;
/// Weight of each line's own height, in cells, so that lines that meet no other stay and the mean of all does.
const OWN_WEIGHT: f64 = 1e-3;
/// Standard deviations in a median absolute deviation of normal errors.
const SD_OF_MAD: f64 = 1.4826;

/// A point of a cell, with its line.
type OfLine = ([i32; 2], u16, [f32; 3]);

/// Compares the lines of a cloud, by point source ids; `None` where it has no two of them.
///
/// The result does not depend on the order of points.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
///
/// # Source
/// Strip differences as in Kager 2004, "Discrepancies between overlapping laser scanner strips"; heights only, by
/// parallel planes through the points of two lines in a cell. Ours.
pub fn compare_strips(cloud: &PointCloud, params: &StripParams, control: &Control<'_>) -> Result<Option<StripReport>> {
    let Some(lines) = cloud.attributes.point_source_id.as_deref() else { return Ok(None) };
    let first = lines.first();
    if lines.iter().all(|line| Some(line) == first) {
        return Ok(None);
    }
    let mut points = points_of_cells(cloud, lines, params);
    control.check()?;
    points.sort_unstable_by(|a, b| {
        let by_place = || (0..3).fold(std::cmp::Ordering::Equal, |order, i| order.then(a.2[i].total_cmp(&b.2[i])));
        (a.0, a.1).cmp(&(b.0, b.1)).then_with(by_place)
    });
    let mut rises: BTreeMap<[u16; 2], Vec<f64>> = BTreeMap::new();
    for cell in points.chunk_by(|a, b| a.0 == b.0) {
        let of_lines: Vec<&[OfLine]> =
            cell.chunk_by(|a, b| a.1 == b.1).filter(|line| line.len() >= params.min_points.max(3)).collect();
        for (number, a) in of_lines.iter().enumerate() {
            for b in &of_lines[number + 1..] {
                if let Some(rise) = rise(a, b, params) {
                    rises.entry([a[0].1, b[0].1]).or_default().push(rise);
                }
            }
        }
    }
    control.check()?;
    let pairs: Vec<StripPair> = rises.into_iter().filter_map(|(lines, rises)| pair(lines, rises, params)).collect();
    let differs = |pair: &StripPair| {
        let chance = MAX_DEVIATIONS * pair.deviation_m / (pair.cells as f64).sqrt();
        pair.deviation_m <= MAX_DEVIATION && pair.rise_m.abs() > params.tolerance.max(chance)
    };
    let moved = if pairs.iter().any(differs) { offsets(&pairs) } else { Vec::new() };
    Ok(Some(StripReport { pairs, moved }))
}

/// Moves the heights of lines.
pub fn move_strips(cloud: &mut PointCloud, moved: &[StripOffset]) {
    let Some(lines) = cloud.attributes.point_source_id.as_deref() else { return };
    let by_line: BTreeMap<u16, f64> = moved.iter().map(|strip| (strip.line, strip.up_m)).collect();
    for (p, line) in cloud.positions.iter_mut().zip(lines) {
        if let Some(up) = by_line.get(line) {
            p[2] = to_f32(f64::from(p[2]) + up);
        }
    }
}

/// Points that may show the heights of lines, in cells that are a fair sample of all.
fn points_of_cells(cloud: &PointCloud, lines: &[u16], params: &StripParams) -> Vec<OfLine> {
    let Some(bounds) = cloud.bounds() else { return Vec::new() };
    let (low, high) = bounds.on_map();
    let cells = (0..2).map(|i| ((high[i] - low[i]) / params.cell).ceil().max(1.0)).product::<f64>();
    let every = to_u32((cells / params.max_cells.max(1) as f64).ceil().max(1.0));
    let (classes, counts) = (cloud.attributes.classification.as_deref(), cloud.attributes.return_count.as_deref());
    let mut found = Vec::new();
    for (row, (p, &line)) in cloud.positions.iter().zip(lines).enumerate() {
        let class = classes.and_then(|classes| classes.get(row)).copied().unwrap_or_default();
        // plants, noise and water change from flight to flight
        let is_fixed = !matches!(class, 3..=5 | 7 | 9 | 18) && counts.is_none_or(|counts| counts.get(row) <= Some(&1));
        let cell = [0, 1].map(|i| to_cell(f64::from(p[i]) / params.cell));
        if is_fixed && hash(cell).is_multiple_of(every) {
            found.push((cell, line, *p));
        }
    }
    found
}

/// A number that looks random, for a cell.
fn hash([x, y]: [i32; 2]) -> u32 {
    let mut v = x.cast_unsigned().wrapping_mul(0x9E37_79B1) ^ y.cast_unsigned().wrapping_mul(0x85EB_CA77);
    v ^= v >> 15;
    v = v.wrapping_mul(0x2C1B_3C6D);
    v ^ (v >> 13)
}

/// Height of the second line above the first in one cell, by two parallel planes; `None` where these do not fit.
fn rise(a: &[OfLine], b: &[OfLine], params: &StripParams) -> Option<f64> {
    let mean = |points: &[OfLine]| -> [f64; 3] {
        std::array::from_fn(|i| points.iter().map(|p| f64::from(p.2[i])).sum::<f64>() / points.len() as f64)
    };
    let (at, bt) = (mean(a), mean(b));
    // xx, xy, yy, xz, yz, zz about the mean of each line
    let mut m = [0.0; 6];
    for (points, mean) in [(a, at), (b, bt)] {
        for p in points {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|i| f64::from(p.2[i]) - mean[i]);
            for (sum, v) in m.iter_mut().zip([x * x, x * y, y * y, x * z, y * z, z * z]) {
                *sum += v;
            }
        }
    }
    let determinant = m[0] * m[2] - m[1] * m[1];
    if !(determinant > 1e-3 * (m[0] + m[2]).powi(2)) {
        return None;
    }
    let slope = [(m[3] * m[2] - m[4] * m[1]) / determinant, (m[4] * m[0] - m[3] * m[1]) / determinant];
    let free = (a.len() + b.len()) as f64 - 4.0;
    let rms = ((m[5] - slope[0] * m[3] - slope[1] * m[4]).max(0.0) / free.max(1.0)).sqrt();
    let fits = rms <= params.max_rms && slope[0].hypot(slope[1]) <= params.max_slope;
    fits.then(|| bt[2] - at[2] - slope[0] * (bt[0] - at[0]) - slope[1] * (bt[1] - at[1]))
}

fn pair(lines: [u16; 2], mut rises: Vec<f64>, params: &StripParams) -> Option<StripPair> {
    if rises.len() < params.min_cells.max(1) {
        return None;
    }
    let median = |values: &mut Vec<f64>| {
        values.sort_unstable_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let rise_m = median(&mut rises);
    let mut deviations: Vec<f64> = rises.iter().map(|rise| (rise - rise_m).abs()).collect();
    Some(StripPair { lines, cells: rises.len(), rise_m, deviation_m: SD_OF_MAD * median(&mut deviations) })
}

/// Returns the offset of each line so that pairs fit best, by least squares with a weight of one for each cell.
fn offsets(pairs: &[StripPair]) -> Vec<StripOffset> {
    let believed = || pairs.iter().filter(|pair| pair.deviation_m <= MAX_DEVIATION);
    let mut lines: Vec<u16> = believed().flat_map(|pair| pair.lines).collect();
    lines.sort_unstable();
    lines.dedup();
    let n = lines.len();
    let row_of = |line: u16| lines.binary_search(&line).unwrap_or_default();
    let mut matrix = vec![vec![0.0; n + 1]; n];
    for (row, values) in matrix.iter_mut().enumerate() {
        values[row] = OWN_WEIGHT;
    }
    for pair in believed() {
        let [a, b] = pair.lines.map(row_of);
        let weight = pair.cells as f64;
        for (i, j, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            matrix[i][i] += weight;
            matrix[i][j] -= weight;
            matrix[i][n] += sign * weight * pair.rise_m;
        }
    }
    // positive definite: elimination needs no pivots
    for i in 0..n {
        let (above, below) = matrix.split_at_mut(i + 1);
        let own = &above[i];
        for row in below {
            let factor = row[i] / own[i];
            if factor != 0.0 {
                for (v, w) in row.iter_mut().zip(own).skip(i) {
                    *v -= factor * w;
                }
            }
        }
    }
    let mut up = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| matrix[i][j] * up[j]).sum();
        up[i] = (matrix[i][n] - known) / matrix[i][i];
    }
    let in_millimetres = |up: f64| (1000.0 * up).round() / 1000.0;
    lines.iter().zip(up).map(|(&line, up)| StripOffset { line, up_m: in_millimetres(up) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::Attributes;

    /// A slope of 60 m that lines 1 to 3 measure, the rise of each above it given, with noise of 2 cm.
    fn lines(rises: [f32; 3]) -> PointCloud {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f32::from(u16::try_from(state >> 16).unwrap()) / 65_536.0
        };
        let (mut positions, mut source) = (Vec::new(), Vec::new());
        for (number, rise) in (1_u16..).zip(rises) {
            for _ in 0..14_400 {
                let [x, y] = [60.0 * random(), 60.0 * random()];
                let noise = 0.02 * (random() + random() + random() - 1.5) * 2.0;
                positions.push([x, y, 0.1 * x + rise + noise]);
                source.push(number);
            }
        }
        let attributes = Attributes { point_source_id: Some(source), ..Attributes::default() };
        PointCloud { positions, attributes, ..PointCloud::default() }
    }

    #[test]
    fn lines_that_differ_are_moved_to_their_mean_and_others_stay() {
        let control = Control::none();
        let params = StripParams::default();
        let level = compare_strips(&lines([0.0, 0.02, -0.01]), &params, &control).unwrap().unwrap();
        assert!(level.pairs.len() == 3 && level.moved.is_empty(), "{level:?}");
        let mut cloud = lines([0.0, 0.3, 0.03]);
        let found = compare_strips(&cloud, &params, &control).unwrap().unwrap();
        let up: Vec<f64> = found.moved.iter().map(|strip| strip.up_m).collect();
        // the mean rise is 0.11 m; medians of hundreds of cells are known to 2 mm
        for (up, truth) in up.iter().zip([0.11, -0.19, 0.08]) {
            assert!((up - truth).abs() < 0.006, "{up} {truth}");
        }
        move_strips(&mut cloud, &found.moved);
        let again = compare_strips(&cloud, &params, &control).unwrap().unwrap();
        assert!(again.moved.is_empty() && again.pairs.iter().all(|pair| pair.rise_m.abs() < 0.006), "{again:?}");
        // in any order
        let rows: Vec<u32> = (0..43_200).rev().collect();
        assert_eq!(compare_strips(&lines([0.0, 0.3, 0.03]).select(&rows), &params, &control).unwrap(), Some(found));
    }

    #[test]
    fn one_line_has_none_to_be_compared_with() {
        let mut cloud = lines([0.0; 3]);
        cloud.attributes.point_source_id = Some(vec![1; 43_200]);
        assert_eq!(compare_strips(&cloud, &StripParams::default(), &Control::none()).unwrap(), None);
        cloud.attributes.point_source_id = None;
        assert_eq!(compare_strips(&cloud, &StripParams::default(), &Control::none()).unwrap(), None);
    }
}
