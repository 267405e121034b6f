//! One pass over the points of a survey: samples of them, and extremes, from which its statistics are estimated.

use super::SurveyExtremes;
use belvedere_data::cast::{to_cell, to_f32, to_i32};
use belvedere_data::{Attributes, Bounds, PointCloud};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Maximum number of points in the sample along flight lines.
const MAX_SAMPLED: u64 = 4_000_000;
/// Number of places, along each side of the survey, with all points kept, and the side of a place, metres.
const PLACES: u32 = 5;
const PLACE_M: f64 = 30.0;
/// Side of the blocks in which points are counted, metres.
const BLOCK_M: f64 = 64.0;
/// Height of the levels in which points are counted, metres. Points that are not isolated have two others within it.
const LEVEL_M: f32 = 4.0;
/// Minimum number of points in a level and its two neighbours; fewer are strays.
const FEWEST: u32 = 3;
/// Number of blocks on each side of a block that its height is compared with.
const AROUND: i32 = 5;
/// LAS flag of withheld points, and classes of noise, which cleaning removes.
const WITHHELD: u8 = 4;
const NOISE: [u8; 2] = [7, 18];
/// ASPRS class of ground.
const GROUND: u8 = 2;

/// Points of a block of 64 m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurveyBlock {
    /// Column east and row north of the block, from the origin of local coordinates.
    pub at: [i32; 2],
    /// Number of points.
    pub points: u64,
    /// Height of the lowest and the highest point without strays, local metres.
    pub heights: [f32; 2],
}

/// Pass over the points of a survey, some of them at a time. Neither their parts nor the files that they come from
/// change its result, only their order.
pub struct SurveySampler {
    /// One pulse of so many is sampled along flight lines.
    every: u64,
    /// Lowest and highest corners of the places, local metres.
    places: Vec<[[f64; 2]; 2]>,
    blocks: BTreeMap<[i32; 2], BlockPoints>,
    extremes: SurveyExtremes,
    bounds: Option<Bounds>,
    /// Number of points that were passed.
    passed: u64,
    counted: u64,
    ground: u64,
}

/// Points of a cloud that are part of samples, by row.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SampledRows {
    /// Whole pulses at random.
    pub along_lines: Vec<u32>,
    /// All points of some places.
    pub in_places: Vec<u32>,
}

/// Extremes and counts of a survey.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurveyCounts {
    /// Extremes of all points.
    pub extremes: SurveyExtremes,
    /// Blocks with points, by place.
    pub blocks: Vec<SurveyBlock>,
    /// The smallest box around the points that are neither noise nor withheld; `None` without any.
    pub bounds: Option<Bounds>,
    /// Number of these points.
    pub points: u64,
    /// Number of those with the class of ground.
    pub ground: u64,
}

#[derive(Default)]
struct BlockPoints {
    points: u64,
    /// By number of the level: count of points, lowest and highest point.
    levels: BTreeMap<i32, (u32, f32, f32)>,
}

impl SurveySampler {
    /// Begins a pass over about `point_count` points between two corners on the map, local metres.
    #[must_use]
    pub fn new([low, high]: [[f64; 2]; 2], point_count: u64) -> Self {
        Self {
            every: point_count.div_ceil(MAX_SAMPLED).max(1),
            places: places([low, high]),
            blocks: BTreeMap::new(),
            extremes: SurveyExtremes { top: f32::NEG_INFINITY, ..SurveyExtremes::default() },
            bounds: None,
            passed: 0,
            counted: 0,
            ground: 0,
        }
    }

    /// Counts the points of `cloud`, and returns those that are sampled. Points with the same of `times` come from one
    /// pulse.
    pub fn pass(&mut self, cloud: &PointCloud, times: Option<&[f64]>) -> SampledRows {
        let mut sampled = SampledRows::default();
        for (number, (row, &p)) in (0_u32..).zip(cloud.positions.iter().enumerate()) {
            let time = times.and_then(|times| times.get(row));
            let chance = time.map_or(self.passed, |time| mixed(time.to_bits()));
            self.passed += 1;
            if chance.is_multiple_of(self.every) {
                sampled.along_lines.push(number);
            }
            let at = [p[0], p[1]].map(f64::from);
            if self.places.iter().any(|[low, high]| (0..2).all(|i| (low[i]..high[i]).contains(&at[i]))) {
                sampled.in_places.push(number);
            }
            if is_counted(p, row, &cloud.attributes) {
                self.count(p, cloud.attributes.class_of(row).unwrap_or(0));
            }
        }
        sampled
    }

    fn count(&mut self, p: [f32; 3], class: u8) {
        self.extremes.has_ground |= class == GROUND;
        self.extremes.has_vegetation |= (3..=5).contains(&class);
        self.counted += 1;
        self.ground += u64::from(class == GROUND);
        let own = Bounds { low: p, high: p };
        self.bounds = Some(self.bounds.map_or(own, |bounds| bounds.joined(&own)));
        let block = self.blocks.entry([p[0], p[1]].map(|v| to_cell(f64::from(v) / BLOCK_M))).or_default();
        block.points += 1;
        let level = block.levels.entry(to_i32(f64::from((p[2] / LEVEL_M).floor()))).or_insert((0, p[2], p[2]));
        *level = (level.0.saturating_add(1), level.1.min(p[2]), level.2.max(p[2]));
    }

    /// Ends the pass.
    #[must_use]
    pub fn finish(self) -> SurveyCounts {
        let Self { blocks, mut extremes, bounds, counted, ground, .. } = self;
        let blocks: Vec<SurveyBlock> = blocks.into_iter().filter_map(|(at, counted)| counted.into_block(at)).collect();
        add_heights(&mut extremes, &blocks);
        SurveyCounts { extremes, blocks, bounds, points: counted, ground }
    }
}

/// Sets the top of all blocks, and the largest height of a block above the lowest point around it.
fn add_heights(extremes: &mut SurveyExtremes, blocks: &[SurveyBlock]) {
    let by_place: BTreeMap<[i32; 2], f32> = blocks.iter().map(|block| (block.at, block.heights[0])).collect();
    for block in blocks {
        extremes.top = extremes.top.max(block.heights[1]);
        let [east, north] = block.at;
        let around = (north - AROUND..=north + AROUND)
            .flat_map(|north| (east - AROUND..=east + AROUND).map(move |east| [east, north]));
        let lowest = around.filter_map(|at| by_place.get(&at)).copied().fold(f32::INFINITY, f32::min);
        extremes.relief = extremes.relief.max(f64::from(block.heights[1]) - f64::from(lowest));
    }
}

/// Returns true if blocks count a point: it is neither noise nor withheld.
#[must_use]
pub fn is_counted(p: [f32; 3], row: usize, attributes: &Attributes) -> bool {
    let flags = attributes.flags.as_deref().and_then(|flags| flags.get(row)).copied().unwrap_or(0);
    let is_noise = attributes.class_of(row).is_some_and(|class| NOISE.contains(&class));
    flags & WITHHELD == 0 && !is_noise && p.iter().all(|v| v.is_finite())
}

impl BlockPoints {
    fn into_block(self, at: [i32; 2]) -> Option<SurveyBlock> {
        let count = |level: i32| self.levels.get(&level).map_or(0, |level| level.0);
        let is_kept = |level: &i32| count(level - 1) + count(*level) + count(level + 1) >= FEWEST;
        let kept = || self.levels.iter().filter(|(level, _)| is_kept(level)).map(|(_, found)| found);
        let low = kept().map(|found| found.1).reduce(f32::min)?;
        let high = kept().map(|found| found.2).reduce(f32::max)?;
        Some(SurveyBlock { at, points: self.points, heights: [low, high] })
    }
}

/// Returns squares spread evenly between two corners. These count as f32, as positions of points do.
fn places([low, high]: [[f64; 2]; 2]) -> Vec<[[f64; 2]; 2]> {
    let [low, high] = [low, high].map(|corner| corner.map(|v| f64::from(to_f32(v))));
    let middle =
        |number: u32, axis: usize| low[axis] + (f64::from(number) + 0.5) / f64::from(PLACES) * (high[axis] - low[axis]);
    let numbers = (0..PLACES).flat_map(|north| (0..PLACES).map(move |east| (east, north)));
    let place = |(east, north)| {
        let middle = [middle(east, 0), middle(north, 1)];
        [-0.5, 0.5].map(|by| middle.map(|v| v + by * PLACE_M))
    };
    numbers.map(place).collect()
}

/// Mixes bits so that similar numbers give independent bits.
///
/// # Source
/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
fn mixed(bits: u64) -> u64 {
    let bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::Frame;
    use belvedere_data::cast::to_row;

    /// Returns a cloud of 300 x 20 m with a point a metre, two of each time, noise, and a stray high above.
    fn cloud() -> PointCloud {
        let mut positions: Vec<[f32; 3]> =
            (0..6000_u16).map(|i| [f32::from(i % 300), f32::from(i / 300), f32::from(i % 7)]).collect();
        positions.push([150.5, 10.5, 300.0]);
        let count = positions.len();
        let classification = (0..count).map(|row| if row % 50 == 1 { 7 } else { 2 }).collect();
        let gps_time = (0..count).map(|row| (row / 2) as f64).collect();
        let attributes =
            Attributes { classification: Some(classification), gps_time: Some(gps_time), ..Attributes::default() };
        PointCloud { frame: Frame::default(), positions, attributes, ..PointCloud::default() }
    }

    #[test]
    fn parts_of_a_survey_give_the_samples_of_all() {
        let all = cloud();
        let times = all.attributes.gps_time.as_deref();
        let corners = [[0.0, 0.0], [299.0, 19.0]];
        // one pulse of three
        let count = 3 * MAX_SAMPLED;
        let mut whole = SurveySampler::new(corners, count);
        let expected = whole.pass(&all, times);
        let expected_counts = whole.finish();
        let mut parts = SurveySampler::new(corners, count);
        let mut found = SampledRows::default();
        for rows in [0..2500, 2500..to_row(all.len())] {
            let first = rows.start;
            let part = all.select(&rows.collect::<Vec<u32>>());
            let SampledRows { along_lines, in_places } = parts.pass(&part, part.attributes.gps_time.as_deref());
            found.along_lines.extend(along_lines.iter().map(|row| first + row));
            found.in_places.extend(in_places.iter().map(|row| first + row));
        }
        assert_eq!(found, expected);
        assert_eq!(parts.finish(), expected_counts);
        // whole pulses, and about a third of them
        let sampled = &expected.along_lines;
        assert!(sampled.chunk_by(|a, b| a / 2 == b / 2).all(|pulse| pulse.len() == 2 || pulse[0] == 6000));
        assert!((1600..2400).contains(&sampled.len()), "{}", sampled.len());
        assert!(expected.in_places.len() > 2000, "{}", expected.in_places.len());
        // neither noise nor the stray counts for heights
        assert_eq!((expected_counts.points, expected_counts.extremes.top), (5881, 6.0));
        assert!(expected_counts.extremes.has_ground && expected_counts.points == expected_counts.ground);
    }
}
