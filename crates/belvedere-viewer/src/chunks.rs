//! Points as the page gets them: squares of the map, positions in 16 bits, in random order.

use belvedere::PointCloud;
use belvedere::cast::{to_i64, to_index, to_u8};
use belvedere::random::uniform;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// Side of a square, metres: 16 bits then part it in steps of 2 mm.
const SIDE: f32 = 128.0;
/// Maximum number of points of a chunk, so that pictures appear while others are on their way.
const MAX: usize = 250_000;
/// Points of the first chunk of a square with many: these come before all others, so that the whole cloud is seen at
/// once.
const FIRST: usize = 20_000;
/// A square has many points from so many times [`FIRST`] on.
const MANY: usize = 5;
/// Steps of a chunk along each axis.
pub(crate) const STEPS: f32 = 65_535.0;
/// Share of the points whose intensity is shown as the brightest.
const BRIGHTEST: f64 = 0.02;

/// Some points of a square of the map.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PointChunk {
    /// Lowest corner, local metres.
    pub(crate) low: [f32; 3],
    /// Length of a step along each axis, metres.
    pub(crate) step: [f32; 3],
    /// Range of the points sent.
    pub(crate) points: Range<usize>,
}

/// All points in the order in which they are sent.
pub(crate) struct Chunks {
    pub(crate) chunks: Vec<PointChunk>,
    /// Row of each point sent in the cloud, (N).
    rows: Vec<u32>,
    /// Intensity that is shown as the brightest.
    brightest: u16,
}

impl Chunks {
    /// Parts the points of a cloud. The first points of a chunk are a fair sample of all of it, and the first chunks
    /// lie all over the cloud.
    pub(crate) fn new(cloud: &PointCloud) -> Self {
        let mut squares: BTreeMap<[i64; 2], Vec<u32>> = BTreeMap::new();
        for (row, position) in (0..).zip(&cloud.positions) {
            squares.entry(square(*position)).or_default().push(row);
        }
        let mut squares: Vec<Vec<u32>> = squares.into_values().collect();
        squares.par_iter_mut().for_each(|rows| {
            rows.sort_by_cached_key(|&row| (uniform(1, u64::from(row)).to_bits(), row));
        });
        let mut parts = Vec::new();
        for (number, rows) in (0..).zip(&squares) {
            let place = (uniform(2, number).to_bits(), number);
            parts.extend(parts_of(rows).enumerate().map(|(part, rows)| ((part, place), rows)));
        }
        parts.sort_unstable_by_key(|(order, _)| *order);
        let mut chunks = Vec::with_capacity(parts.len());
        let mut all = Vec::with_capacity(cloud.len());
        for (_, rows) in parts {
            chunks.push(chunk(cloud, rows, all.len()));
            all.extend_from_slice(rows);
        }
        let brightest = cloud.attributes.intensity.as_deref().map_or(1, brightest);
        Self { chunks, rows: all, brightest }
    }

    /// Eight bytes for each point of a chunk, little endian: its steps along x, y and z with 16 bits each, its class
    /// and its intensity.
    pub(crate) fn points(&self, number: usize, cloud: &PointCloud) -> Option<Vec<u8>> {
        let chunk = self.chunks.get(number)?;
        let rows = self.rows.get(chunk.points.clone())?;
        let of_point = |&row: &u32| {
            let row = row as usize;
            let mut bytes = [0; 8];
            for axis in 0..3 {
                let steps = ((cloud.positions[row][axis] - chunk.low[axis]) / chunk.step[axis]).round();
                bytes[2 * axis..2 * axis + 2].copy_from_slice(&to_steps(steps).to_le_bytes());
            }
            let attributes = &cloud.attributes;
            bytes[6] = attributes.classification.as_ref().map_or(0, |classes| classes[row]);
            bytes[7] = attributes.intensity.as_ref().map_or(0, |values| self.brightness(values[row]));
            bytes
        };
        // not on the threads that build balls meanwhile: they would let the page wait for seconds
        Some(rows.iter().flat_map(of_point).collect())
    }

    /// Two bytes for each point of a chunk: its colour with 5, 6 and 5 bits.
    pub(crate) fn colors(&self, number: usize, cloud: &PointCloud) -> Option<Vec<u8>> {
        let rows = self.rows.get(self.chunks.get(number)?.points.clone())?;
        let colors = cloud.attributes.color.as_ref()?;
        let of_point = |&row: &u32| {
            let [red, green, blue] = colors[row as usize];
            (red & 0xF800 | (green & 0xFC00) >> 5 | blue >> 11).to_le_bytes()
        };
        Some(rows.iter().flat_map(of_point).collect())
    }

    /// Row in the cloud of each point, in the order in which points are sent.
    pub(crate) fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Returns at most `max` points, the same share of each chunk.
    pub(crate) fn sample(self, max: usize) -> Self {
        if self.rows.len() <= max {
            return self;
        }
        let mut rows = Vec::with_capacity(max);
        let sampled = |chunk: &PointChunk| {
            let first = rows.len();
            rows.extend_from_slice(self.share(chunk, max));
            PointChunk { points: first..rows.len(), ..chunk.clone() }
        };
        let chunks = self.chunks.iter().map(sampled).collect();
        Self { chunks, rows, brightest: self.brightest }
    }

    /// Rows in the cloud of at most so many points, the same share of each chunk.
    pub(crate) fn sampled_rows(&self, max: usize) -> impl Iterator<Item = u32> {
        self.chunks.iter().flat_map(move |chunk| self.share(chunk, max)).copied()
    }

    fn share(&self, chunk: &PointChunk, max: usize) -> &[u32] {
        let whole = self.rows.len().max(1);
        // the product needs more than 32 bits
        let share = chunk.points.len() as u128 * max.min(whole) as u128 / whole as u128;
        let share = share as usize;
        &self.rows[chunk.points.start..chunk.points.start + share]
    }

    /// Number of points sent.
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Local positions in the order in which points are sent.
    pub(crate) fn positions(&self, cloud: &PointCloud) -> Vec<[f32; 3]> {
        self.rows.iter().map(|&row| cloud.positions[row as usize]).collect()
    }

    fn brightness(&self, intensity: u16) -> u8 {
        let share = f32::from(intensity) / f32::from(self.brightest.max(1));
        to_u8(f64::from((share.min(1.0) * 255.0).round()))
    }
}

/// The points of a square, chunk by chunk.
fn parts_of(rows: &[u32]) -> impl Iterator<Item = &[u32]> {
    let (first, rest) = rows.split_at(if rows.len() > MANY * FIRST { FIRST } else { 0 });
    Some(first).into_iter().filter(|first| !first.is_empty()).chain(rest.chunks(MAX))
}

fn square([x, y, _]: [f32; 3]) -> [i64; 2] {
    [x, y].map(|v| to_i64(f64::from((v / SIDE).floor())))
}

fn chunk(cloud: &PointCloud, rows: &[u32], first: usize) -> PointChunk {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for position in rows.iter().map(|&row| cloud.positions[row as usize]) {
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    // a flat chunk must not part by zero
    let step = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / STEPS).max(1e-6));
    PointChunk { low, step, points: first..first + rows.len() }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 16 bits")]
pub(crate) fn to_steps(steps: f32) -> u16 {
    steps.clamp(0.0, STEPS) as u16
}

fn brightest(intensities: &[u16]) -> u16 {
    let mut values = intensities.to_vec();
    let place = to_index(values.len() as f64 * (1.0 - BRIGHTEST));
    if place >= values.len() {
        return 1;
    }
    *values.select_nth_unstable(place).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> PointCloud {
        let coordinates: Vec<[f64; 3]> =
            (0..5000).map(|i| [f64::from(i) * 0.1, 300.0 * uniform(7, i as u64), f64::from(i % 37)]).collect();
        let mut cloud = PointCloud::from_coordinates(&coordinates).0;
        cloud.attributes.classification = Some((0..5000).map(|i| (i % 7) as u8).collect());
        cloud
    }

    #[test]
    fn each_point_is_sent_once_to_within_two_millimetres() {
        let cloud = cloud();
        let chunks = Chunks::new(&cloud);
        assert!(chunks.chunks.len() > 4);
        let mut rows = chunks.rows.clone();
        rows.sort_unstable();
        assert_eq!(rows, (0..5000).collect::<Vec<u32>>());
        for (number, chunk) in chunks.chunks.iter().enumerate() {
            let bytes = chunks.points(number, &cloud).unwrap();
            assert_eq!(bytes.len(), 8 * chunk.points.len());
            for (point, &row) in bytes.chunks(8).zip(&chunks.rows[chunk.points.clone()]) {
                for axis in 0..3 {
                    let steps = u16::from_le_bytes([point[2 * axis], point[2 * axis + 1]]);
                    let sent = chunk.low[axis] + f32::from(steps) * chunk.step[axis];
                    assert!((sent - cloud.positions[row as usize][axis]).abs() < 0.0011);
                }
                assert_eq!(u32::from(point[6]), row % 7);
            }
        }
        assert_eq!(chunks.points(chunks.chunks.len(), &cloud), None);
        let some = chunks.sample(1000);
        assert!((900..=1000).contains(&some.len()) && some.positions(&cloud).len() == some.len());
    }

    #[test]
    fn the_first_chunks_lie_all_over_the_cloud() {
        // two squares with many points, and three with few
        let places = [(-400.0, 120_000), (10.0, 130_000), (140.0, 50), (270.0, 40), (500.0, 30)];
        let coordinates: Vec<[f64; 3]> = places
            .iter()
            .flat_map(|&(x, count)| (0..count).map(move |i| [x + f64::from(i) * 1e-4, 0.0, 0.0]))
            .collect();
        let chunks = Chunks::new(&PointCloud::from_coordinates(&coordinates).0).chunks;
        let mut first: Vec<usize> = chunks[..5].iter().map(|chunk| chunk.points.len()).collect();
        let wests: Vec<f32> = chunks[..5].iter().map(|chunk| chunk.low[0]).collect();
        assert!(!wests.is_sorted(), "in random order");
        first.sort_unstable();
        assert_eq!(first, [30, 40, 50, FIRST, FIRST]);
        assert_eq!(chunks.iter().map(|chunk| chunk.points.len()).sum::<usize>(), coordinates.len());
    }

    #[test]
    fn the_first_points_of_a_chunk_lie_all_over_it() {
        let coordinates: Vec<[f64; 3]> = (0..20_000).map(|i| [f64::from(i) * 0.005, 0.0, 0.0]).collect();
        let cloud = PointCloud::from_coordinates(&coordinates).0;
        let chunks = Chunks::new(&cloud);
        for chunk in &chunks.chunks {
            let some = &chunks.rows[chunk.points.clone()][..chunk.points.len() / 20];
            let mean =
                some.iter().map(|&row| f64::from(cloud.positions[row as usize][0])).sum::<f64>() / some.len() as f64;
            let middle = f64::from(chunk.low[0] + chunk.step[0] * STEPS / 2.0);
            // five standard errors of a mean of even numbers
            let bound = 5.0 * f64::from(chunk.step[0] * STEPS) / (12.0 * some.len() as f64).sqrt();
            assert!((mean - middle).abs() < bound, "{mean} {middle}");
        }
    }
}
