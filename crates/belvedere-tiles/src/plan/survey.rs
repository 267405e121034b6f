//! One pass over all points: their places, their heights, and samples of them.

use crate::columns::append;
use crate::grid::{MapArea, block_of};
use crate::inputs::{NOWHERE, PIECE_ROWS, PieceCell, PointColumns, hold};
use belvedere::cast::to_i32;
use belvedere::control::Control;
use belvedere::ground::GroundPoints;
use belvedere::io::{CloudBatch, ReadOptions, read_batches};
use belvedere::model::SurveyExtremes;
use belvedere::{Bounds, PointCloud, Result};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

/// Maximum number of points in the sample along flight lines.
const MAX_SAMPLED: u64 = 4_000_000;
/// Number of places, along each side of the survey, with all points kept, and the side of a place, metres.
const PLACES: u32 = 5;
const PLACE_M: f64 = 40.0;
/// Height of the levels in which points are counted, metres. Points that are not isolated have two others within it.
const LEVEL_M: f32 = 4.0;
/// Minimum number of points in a level and its two neighbours; fewer are strays.
const FEWEST: u32 = 3;
/// Number of blocks of 64 m on each side of a block that its height is compared with.
const AROUND: i32 = 5;
/// LAS flag of withheld points, and classes of noise, which cleaning removes.
const WITHHELD: u8 = 4;
const NOISE: [u8; 2] = [7, 18];
/// ASPRS class of ground.
const GROUND: u8 = 2;

/// Points of a block of 64 m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SurveyBlock {
    /// Column east and row north of the block, from the origin of local coordinates.
    pub at: [i32; 2],
    /// Number of points.
    pub points: u64,
    /// Height of the lowest and the highest point without strays, local metres.
    pub heights: [f32; 2],
}

/// Result of a pass over a survey.
pub(crate) struct SurveyOverview {
    pub(crate) blocks: Vec<SurveyBlock>,
    pub(crate) bounds: Option<Bounds>,
    pub(crate) extremes: SurveyExtremes,
    /// Number of counted points, and of those with the class of ground.
    points: [u64; 2],
    /// Random sample of whole pulses.
    pub(crate) along_lines: PointCloud,
    /// All points of some places.
    pub(crate) places: PointCloud,
    /// Rectangles around the pieces of each file.
    pub(crate) pieces: HashMap<PathBuf, Vec<PieceCell>>,
}

impl SurveyOverview {
    /// Returns the kind of ground points for the whole survey, by the rule of [`GroundPoints::Auto`].
    pub(crate) fn ground_points(&self) -> GroundPoints {
        let [points, ground] = self.points;
        if ground < points.div_ceil(1000) { GroundPoints::Found } else { GroundPoints::Classed }
    }
}

#[derive(Default)]
struct PointCounts {
    points: u64,
    /// By number of the level: count of points, lowest and highest point.
    levels: BTreeMap<i32, (u32, f32, f32)>,
}

/// Reads all points of `files` in `area`. The files have about `point_count` points.
pub(crate) fn survey(
    files: &[PathBuf],
    options: &ReadOptions,
    columns: PointColumns,
    point_count: u64,
    area: &MapArea,
    control: &Control<'_>,
) -> Result<SurveyOverview> {
    let every = point_count.div_ceil(MAX_SAMPLED).max(1);
    let places = places(area);
    let mut blocks: BTreeMap<[i32; 2], PointCounts> = BTreeMap::new();
    let frame = options.frame.clone().unwrap_or_default();
    let mut along_lines = PointCloud::in_frame(frame.clone());
    let mut of_places = PointCloud::in_frame(frame);
    let mut extremes = SurveyExtremes { top: f32::NEG_INFINITY, ..SurveyExtremes::default() };
    let mut bounds: Option<Bounds> = None;
    let mut points = [0; 2];
    let mut pieces: HashMap<PathBuf, Vec<PieceCell>> = HashMap::new();
    // Sources must outlive the read.
    for batch in read_batches(files.to_vec(), &options.clone().with_row_numbers(), control)? {
        let CloudBatch { cloud, source, rows } = batch?;
        hold_rows(pieces.entry(source).or_default(), &rows, &cloud.positions);
        let flags = cloud.attributes.flags.as_deref().unwrap_or_default();
        let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
        let times = cloud.attributes.gps_time.as_deref().filter(|_| columns.gps_times);
        let (mut sampled, mut in_places) = (Vec::new(), Vec::new());
        for (number, (row, &p)) in (0_u32..).zip(cloud.positions.iter().enumerate()) {
            let class = classes.get(row).copied().unwrap_or(0);
            let chance = times.and_then(|times| times.get(row)).map_or(u64::from(number), |time| mixed(time.to_bits()));
            if chance % every == 0 {
                sampled.push(number);
            }
            if places.iter().any(|place| place.holds([p[0].into(), p[1].into()])) {
                in_places.push(number);
            }
            if !is_counted(p, class, flags.get(row).copied().unwrap_or(0)) {
                continue;
            }
            extremes.has_ground |= class == GROUND;
            points = [points[0] + 1, points[1] + u64::from(class == GROUND)];
            extremes.has_vegetation |= (3..=5).contains(&class);
            let block = blocks.entry(block_of([p[0], p[1]])).or_default();
            block.points += 1;
            let level = block.levels.entry(to_i32(f64::from((p[2] / LEVEL_M).floor()))).or_insert((0, p[2], p[2]));
            *level = (level.0.saturating_add(1), level.1.min(p[2]), level.2.max(p[2]));
            let own = Bounds { low: p, high: p };
            bounds = Some(bounds.map_or(own, |bounds| joined(&bounds, &own)));
        }
        append(&mut along_lines, cloud.select(&sampled), columns);
        append(&mut of_places, cloud.select(&in_places), columns);
    }
    let blocks: Vec<SurveyBlock> = blocks.into_iter().filter_map(|(at, counted)| counted.into_block(at)).collect();
    add_heights(&mut extremes, &blocks);
    Ok(SurveyOverview { blocks, bounds, extremes, points, along_lines, places: of_places, pieces })
}

/// Widens the rectangles of the pieces that contain `rows` of a file.
fn hold_rows(pieces: &mut Vec<PieceCell>, rows: &[u64], positions: &[[f32; 3]]) {
    for (&row, &p) in rows.iter().zip(positions) {
        let number = usize::try_from(row / PIECE_ROWS).unwrap_or(usize::MAX);
        if number >= pieces.len() {
            pieces.resize(number + 1, NOWHERE);
        }
        hold(&mut pieces[number], p);
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

/// Returns true if blocks count the point: it is neither noise nor withheld.
pub(crate) fn is_counted(p: [f32; 3], class: u8, flags: u8) -> bool {
    flags & WITHHELD == 0 && !NOISE.contains(&class) && p.iter().all(|v| v.is_finite())
}

impl PointCounts {
    fn into_block(self, at: [i32; 2]) -> Option<SurveyBlock> {
        let count = |level: i32| self.levels.get(&level).map_or(0, |level| level.0);
        let is_kept = |level: &i32| count(level - 1) + count(*level) + count(level + 1) >= FEWEST;
        let kept = || self.levels.iter().filter(|(level, _)| is_kept(level)).map(|(_, found)| found);
        let low = kept().map(|found| found.1).reduce(f32::min)?;
        let high = kept().map(|found| found.2).reduce(f32::max)?;
        Some(SurveyBlock { at, points: self.points, heights: [low, high] })
    }
}

fn joined(a: &Bounds, b: &Bounds) -> Bounds {
    Bounds {
        low: std::array::from_fn(|i| a.low[i].min(b.low[i])),
        high: std::array::from_fn(|i| a.high[i].max(b.high[i])),
    }
}

/// Returns squares spread evenly over `area`.
fn places(area: &MapArea) -> Vec<MapArea> {
    let side = |axis: usize| area.high[axis] - area.low[axis];
    let middle = |number: u32, axis: usize| area.low[axis] + (f64::from(number) + 0.5) / f64::from(PLACES) * side(axis);
    let numbers = (0..PLACES).flat_map(|north| (0..PLACES).map(move |east| (east, north)));
    let place = |(east, north)| {
        let middle = [middle(east, 0), middle(north, 1)];
        MapArea { low: middle.map(|v| v - PLACE_M / 2.0), high: middle.map(|v| v + PLACE_M / 2.0) }
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
