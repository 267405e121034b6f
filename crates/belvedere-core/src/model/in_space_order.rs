//! Points in the order of space: those near each other on the map are near each other in memory.
//!
//! Every stage looks around each point. Scanners write points that follow each other on the ground. Where a program has
//! mixed them, what a stage finds lies anywhere in memory, and fetching it takes most of the time.

use belvedere_data::{Attributes, PointCloud};
use rayon::prelude::*;

/// Side of the squares within which points keep their order, metres.
const SIDE: f64 = 4.0;

/// Share of the points far from the one before from which on a cloud counts as mixed: seven of nine open surveys have
/// 7 % at most, the other two and shuffled ones 74 % and more.
const MIXED_SHARE: f64 = 0.2;

/// Whether points that follow each other in a cloud lie far apart on the map, so that it is worth sorting.
fn is_mixed(cloud: &PointCloud) -> bool {
    let far = |pair: &[[f32; 3]]| {
        let [x, y] = [0, 1].map(|axis| f64::from(pair[1][axis]) - f64::from(pair[0][axis]));
        x.hypot(y) > 2.0 * SIDE
    };
    let count = cloud.positions.par_windows(2).filter(|pair| far(pair)).count();
    count as f64 > MIXED_SHARE * cloud.len() as f64
}

/// Rows of a cloud in the order of space, where its points are mixed; `None` where they follow each other.
pub(super) fn order_of_mixed(cloud: &PointCloud) -> Option<Vec<u32>> {
    // columns of other lengths are refused by cleaning
    let is_whole = cloud.attributes.columns().iter().all(|(_, length)| *length == cloud.len());
    (is_whole && is_mixed(cloud)).then(|| rows_in_space_order(cloud))
}

/// Rows of a cloud, square by square: squares come along a Z-order curve, which seldom leaves a neighbourhood (Morton
/// 1966). The rows of a square ascend. A point has the same square in every part of a survey.
fn rows_in_space_order(cloud: &PointCloud) -> Vec<u32> {
    let [east, north, _] = cloud.frame.origin;
    let square = |place: f32, origin: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
        let number = ((f64::from(place) + origin) / SIDE).floor() as i64;
        // squares 262 km apart share a number, which costs time and nothing else
        (number & 0xFFFF) as u32
    };
    let key = |(row, [x, y, _]): (u32, [f32; 3])| {
        let morton = spread(square(x, east)) | spread(square(y, north)) << 1;
        u64::from(morton) << 32 | u64::from(row)
    };
    #[expect(clippy::cast_possible_truncation, reason = "rows of a cloud are numbered with 32 bits everywhere")]
    let mut keys: Vec<u64> = cloud.positions.par_iter().enumerate().map(|(row, p)| key((row as u32, *p))).collect();
    keys.par_sort_unstable();
    #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
    keys.into_par_iter().map(|key| key as u32).collect()
}

/// The points of `cloud` at `rows`, with what models are made from: neither colours nor where they come from.
pub(super) fn points_at(cloud: &PointCloud, rows: &[u32]) -> PointCloud {
    let PointCloud { frame, positions, scanner_positions, sky_regions, cleared_places, .. } = cloud;
    let attributes = &cloud.attributes;
    let (color, intensity) = (None, None);
    PointCloud {
        frame: frame.clone(),
        positions: rows.par_iter().filter_map(|&row| positions.get(row as usize).copied()).collect(),
        attributes: Attributes { color, intensity, ..attributes.select(rows) },
        scanner_positions: scanner_positions.clone(),
        sky_regions: sky_regions.clone(),
        cleared_places: cleared_places.clone(),
        ..PointCloud::default()
    }
}

/// The 16 lower bits of a number, with a zero between each two.
fn spread(number: u32) -> u32 {
    let steps = [(8, 0x00FF_00FF), (4, 0x0F0F_0F0F), (2, 0x3333_3333), (1, 0x5555_5555)];
    steps.into_iter().fold(number & 0xFFFF, |bits, (shift, mask)| (bits | bits << shift) & mask)
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::Frame;
    use belvedere_data::random::uniform;

    #[test]
    fn every_row_comes_once_and_squares_come_whole() {
        let at = |i: u64, k: u64| 200.0 * uniform(7, 2 * i + k) - 100.0;
        #[expect(clippy::cast_possible_truncation, reason = "places of a test")]
        let positions: Vec<[f32; 3]> = (0..5000).map(|i| [at(i, 0) as f32, at(i, 1) as f32, 0.0]).collect();
        let frame = Frame { origin: [85_000.0, 446_000.0, 0.0], ..Frame::default() };
        let cloud = PointCloud { positions, frame, ..PointCloud::default() };
        let rows = rows_in_space_order(&cloud);
        let mut sorted = rows.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..5000).collect::<Vec<u32>>());
        let square = |row: u32| [0, 1].map(|axis| (cloud.positions[row as usize][axis] / 4.0).floor());
        let runs: Vec<&[u32]> = rows.chunk_by(|a, b| square(*a) == square(*b)).collect();
        let mut squares: Vec<[f32; 2]> = runs.iter().map(|run| square(run[0])).collect();
        squares.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let count = squares.len();
        squares.dedup();
        assert_eq!(squares.len(), count, "a square comes twice");
        assert!(runs.iter().all(|run| run.is_sorted()) && count > 2000);
        // most squares lie beside the one before
        let beside = runs.windows(2).filter(|pair| {
            let [a, b] = [square(pair[0][0]), square(pair[1][0])];
            (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1.5
        });
        assert!(beside.count() > 2 * count / 3);
    }

    #[test]
    fn lines_of_a_scanner_are_in_order_and_mixed_points_are_not() {
        #[expect(clippy::cast_precision_loss, reason = "a thousand points")]
        let line = |i: usize| [0.4 * (i % 100) as f32, 0.5 * (i / 100) as f32, 0.0];
        let in_lines = PointCloud { positions: (0..1000).map(line).collect(), ..PointCloud::default() };
        let mixed = in_lines.select(&(0..1000).map(|i| i * 337 % 1000).collect::<Vec<u32>>());
        assert!(!is_mixed(&in_lines) && is_mixed(&mixed) && !is_mixed(&PointCloud::default()));
        assert!(!is_mixed(&mixed.select(&rows_in_space_order(&mixed))));
    }

    #[test]
    fn bits_are_spread() {
        assert_eq!([spread(0), spread(1), spread(0b1011), spread(0xFFFF)], [0, 1, 0b100_0101, 0x5555_5555]);
    }
}
