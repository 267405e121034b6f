//! One pass over all points: where they lie, how high, and samples of them.

use crate::columns::append;
use crate::grid::{MapArea, block_of};
use crate::inputs::{NOWHERE, PIECE_ROWS, PieceCell, PointColumns, hold};
use belvedere::control::Control;
use belvedere::ground::GroundPoints;
use belvedere::io::{CloudBatch, ReadOptions, read_batches};
use belvedere::model::SurveyExtremes;
use belvedere::{Bounds, PointCloud, Result};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

/// Most points of the sample along flight lines.
const MAX_SAMPLED: u64 = 4_000_000;
/// Places whose points are all kept, along each side of the survey, and their side, metres.
const PLACES: u32 = 5;
const PLACE_M: f64 = 40.0;
/// Height of the levels that points are counted in, metres. Points that are not isolated have two others within it.
const LEVEL_M: f32 = 4.0;
/// Fewest points of a level and those next to it for it to count as more than strays.
const FEWEST: u32 = 3;
/// Blocks of 64 m around a block that its height is compared with.
const AROUND: i32 = 5;
/// LAS flag of withheld points, and classes of noise: what cleaning leaves out.
const WITHHELD: u8 = 4;
const NOISE: [u8; 2] = [7, 18];
/// ASPRS class of ground.
const GROUND: u8 = 2;

/// The points of a block of 64 m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SurveyBlock {
    /// Number east and north from the origin of local coordinates.
    pub at: [i32; 2],
    /// Number of points.
    pub points: u64,
    /// Lowest and highest point, strays left out, local metres.
    pub heights: [f32; 2],
}

/// What a pass over a survey found.
pub(crate) struct SurveyOverview {
    pub(crate) blocks: Vec<SurveyBlock>,
    pub(crate) bounds: Option<Bounds>,
    pub(crate) extremes: SurveyExtremes,
    /// Points that count, and those of them of the class of ground.
    points: [u64; 2],
    /// Whole pulses at random.
    pub(crate) along_lines: PointCloud,
    /// All points of some places.
    pub(crate) places: PointCloud,
    /// The rectangles around the pieces of each file.
    pub(crate) pieces: HashMap<PathBuf, Vec<PieceCell>>,
}

impl SurveyOverview {
    /// Which points are ground, by the rule of [`GroundPoints::Auto`] for all of the survey.
    pub(crate) fn ground_points(&self) -> GroundPoints {
        let [points, ground] = self.points;
        if ground < points.div_ceil(1000) { GroundPoints::Found } else { GroundPoints::Classed }
    }
}

#[derive(Default)]
struct PointCounts {
    points: u64,
    /// By number of the level: points, lowest and highest.
    levels: BTreeMap<i32, (u32, f32, f32)>,
}

/// Looks at all points of `files`, which hold about `point_count`, in `area`.
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
    // sources live as long as the work
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
            #[expect(clippy::cast_possible_truncation, reason = "heights of a planet; `as` saturates")]
            let level = block.levels.entry((p[2] / LEVEL_M).floor() as i32).or_insert((0, p[2], p[2]));
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

/// Widens the cells of the pieces that `rows` of a file belong to.
fn hold_rows(pieces: &mut Vec<PieceCell>, rows: &[u64], positions: &[[f32; 3]]) {
    for (&row, &p) in rows.iter().zip(positions) {
        let number = usize::try_from(row / PIECE_ROWS).unwrap_or(usize::MAX);
        if number >= pieces.len() {
            pieces.resize(number + 1, NOWHERE);
        }
        hold(&mut pieces[number], p);
    }
}

/// The top of all blocks, and the largest height of one above the lowest around it.
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

/// Whether a point is one of those that blocks count: neither noise nor withheld.
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

/// Squares spread evenly over `area`.
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

/// Bits in which those of similar numbers have nothing in common.
///
/// # Source
/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
fn mixed(bits: u64) -> u64 {
    let bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}
