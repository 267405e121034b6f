//! Points in an order that follows from where they are and not from their file: those near each other on the map are
//! near each other in memory.
//!
//! Every stage looks around each point, and takes the first of several that are equally near. In this order it takes
//! the same one whatever the order of the file. Where a program has mixed the points of a scanner, neighbours would
//! also lie anywhere in memory, and fetching them would take most of the time.

use belvedere_data::cast::{to_i64, to_row};
use belvedere_data::vector::compare_places;
use belvedere_data::{Attributes, PointCloud};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Side of the squares that the points are sorted by first, metres.
const SIDE: f64 = 4.0;

/// Rows of a cloud in the order of space; `None` where they are in it, or columns have other lengths, which cleaning
/// refuses.
pub(super) fn space_order(cloud: &PointCloud) -> Option<Vec<u32>> {
    let is_whole = cloud.attributes.columns().iter().all(|(_, length)| *length == cloud.len());
    let rows = is_whole.then(|| rows_in_space_order(cloud))?;
    let is_in_order = (0..).zip(&rows).all(|(place, row): (u32, &u32)| place == *row);
    (!is_in_order).then_some(rows)
}

/// Rows of a cloud, square by square: squares come along a Z-order curve, which seldom leaves a neighbourhood (Morton
/// 1966). Within a square points are sorted by their coordinates, and those in one place by their attributes. A point
/// has the same square in every part of a survey.
fn rows_in_space_order(cloud: &PointCloud) -> Vec<u32> {
    let [east, north, _] = cloud.frame.origin;
    let square = |place: f32, origin: f64| {
        let number = to_i64(((f64::from(place) + origin) / SIDE).floor());
        // squares 262 km apart share a number, which costs time and nothing else
        (number & 0xFFFF) as u32
    };
    let key = |(row, [x, y, _]): (u32, [f32; 3])| {
        let morton = spread(square(x, east)) | spread(square(y, north)) << 1;
        u64::from(morton) << 32 | u64::from(row)
    };
    let mut keys: Vec<u64> = cloud.positions.par_iter().enumerate().map(|(row, p)| key((to_row(row), *p))).collect();
    keys.par_sort_unstable();
    #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
    let row = |key: u64| key as u32;
    let of_square = keys.par_chunk_by_mut(|a, b| a >> 32 == b >> 32);
    of_square.for_each(|keys| keys.sort_unstable_by(|&a, &b| compare(cloud, row(a), row(b)).then(a.cmp(&b))));
    keys.into_par_iter().map(row).collect()
}

/// Compares two points of a cloud by all that a model is made from.
fn compare(cloud: &PointCloud, a: u32, b: u32) -> Ordering {
    let [a, b] = [a, b].map(|row| row as usize);
    let PointCloud { positions, attributes, .. } = cloud;
    let places = compare_places(&positions[a], &positions[b]);
    if places.is_ne() {
        return places;
    }
    let Attributes {
        normals,
        classification,
        gps_time,
        return_number,
        return_count,
        scan_angle,
        point_source_id,
        scanner_channel,
        flags,
        scanner_index,
        // no model is made from these
        intensity: _,
        color: _,
        gps_time_kind: _,
    } = attributes;
    let times = gps_time.as_ref().map_or(Ordering::Equal, |times| times[a].total_cmp(&times[b]));
    times
        .then_with(|| of_column(return_number.as_deref(), a, b))
        .then_with(|| of_column(return_count.as_deref(), a, b))
        .then_with(|| of_column(classification.as_deref(), a, b))
        .then_with(|| of_column(point_source_id.as_deref(), a, b))
        .then_with(|| of_column(scanner_channel.as_deref(), a, b))
        .then_with(|| of_column(flags.as_deref(), a, b))
        .then_with(|| of_column(scanner_index.as_deref(), a, b))
        .then_with(|| scan_angle.as_ref().map_or(Ordering::Equal, |angles| angles[a].total_cmp(&angles[b])))
        .then_with(|| normals.as_ref().map_or(Ordering::Equal, |normals| compare_places(&normals[a], &normals[b])))
}

fn of_column<T: Ord>(values: Option<&[T]>, a: usize, b: usize) -> Ordering {
    values.map_or(Ordering::Equal, |values| values[a].cmp(&values[b]))
}

/// The points of `cloud` at `rows`, with the columns from which models are made: neither colours nor sources.
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
    use belvedere_data::vector::to_f32;

    #[test]
    fn every_row_comes_once_and_squares_come_whole() {
        let at = |i: u64, k: u64| 200.0 * uniform(7, 2 * i + k) - 100.0;
        let positions: Vec<[f32; 3]> = (0..5000).map(|i| [to_f32(at(i, 0)), to_f32(at(i, 1)), 0.0]).collect();
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
        let east = |row: &u32| cloud.positions[*row as usize][0];
        assert!(runs.iter().all(|run| run.is_sorted_by_key(east)) && count > 2000);
        // most squares lie beside the one before
        let beside = runs.windows(2).filter(|pair| {
            let [a, b] = [square(pair[0][0]), square(pair[1][0])];
            (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1.5
        });
        assert!(beside.count() > 2 * count / 3);
    }

    #[test]
    fn the_order_is_that_of_places_and_attributes_whatever_the_file_has() {
        // points on a grid of 2 m, each place twice with two classes
        let row = |i: u32| ([2.0 * (i % 9) as f32 - 8.0, 2.0 * (i / 9 % 9) as f32, 0.0], u8::from(i >= 81));
        let cloud = |numbers: &[u32]| PointCloud {
            positions: numbers.iter().map(|&i| row(i).0).collect(),
            attributes: Attributes {
                classification: Some(numbers.iter().map(|&i| row(i).1).collect()),
                ..Attributes::default()
            },
            ..PointCloud::default()
        };
        let sorted = |cloud: PointCloud| match space_order(&cloud) {
            Some(rows) => points_at(&cloud, &rows),
            None => cloud,
        };
        let numbers: Vec<u32> = (0..162).collect();
        let expected = sorted(cloud(&numbers));
        assert!(space_order(&expected).is_none() && space_order(&PointCloud::default()).is_none());
        for step in [5, 25, 125] {
            let mut mixed: Vec<u32> = numbers.iter().map(|i| i * step % 162).collect();
            mixed.dedup();
            let found = sorted(cloud(&mixed));
            assert_eq!(found.positions, expected.positions);
            assert_eq!(found.attributes.classification, expected.attributes.classification);
        }
    }

    #[test]
    fn bits_are_spread() {
        assert_eq!([spread(0), spread(1), spread(0b1011), spread(0xFFFF)], [0, 1, 0b100_0101, 0x5555_5555]);
    }
}
