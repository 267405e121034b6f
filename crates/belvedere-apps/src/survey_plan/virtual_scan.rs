//! A scan of the model from one place.

use super::scanner::{STATION_HEIGHT, ScannerParams};
use belvedere_core::ground::Ground;
use belvedere_core::pulses::FreeSegmentParams;
use belvedere_core::query::{MedialScene, Proof};
use belvedere_data::cast::to_index;
use belvedere_data::vector::{cross, dot, length, sub, to_f32, unit};
use belvedere_data::view::panorama_direction;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, TAU};
use std::sync::atomic::{AtomicU8, Ordering};

/// Columns of the ways of a simulated scan: half a degree. Within 80 m they are nearer to each other than a pulse must
/// pass.
const COLUMNS: usize = 720;
const ROWS: usize = COLUMNS / 2;
/// Rings of ways that are tried around a place: radius as a share of how near they must pass, and number.
const RINGS: [(f64, u32); 3] = [(0.0, 1), (0.5, 6), (0.9, 12)];
/// Through how much space that no pulse saw a way runs, metres: at most so much for each level.
pub(super) const LEVELS: [f64; 3] = [4.0, 12.0, f64::INFINITY];
/// Minimum side of the cells that hold whether pulses saw space, metres.
const CELL: f64 = 1.0;
/// Maximum number of these cells, 64 MB; a larger scene has larger ones.
const MAX_CELLS: f64 = 64e6;

/// Cells of space of which it is found out when first needed whether a pulse came near to their middle.
pub(super) struct SeenCells<'a> {
    proof: &'a Proof,
    low: [f64; 3],
    side: f64,
    size: [usize; 3],
    /// Row by row, layer by layer.
    cells: Vec<AtomicU8>,
}

const UNKNOWN: u8 = 0;
const SEEN: u8 = 1;
const UNSEEN: u8 = 2;

impl<'a> SeenCells<'a> {
    /// Cells over the box around places that are finite.
    pub(super) fn around<'p>(proof: &'a Proof, places: impl Iterator<Item = &'p [f64; 3]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for place in places.filter(|place| place.iter().all(|v| v.is_finite())) {
            low = std::array::from_fn(|i| low[i].min(place[i]));
            high = std::array::from_fn(|i| high[i].max(place[i]));
        }
        let extent = [0, 1, 2].map(|i| (high[i] - low[i]).max(0.0));
        let side = extent.iter().map(|extent| extent + CELL).product::<f64>() / MAX_CELLS;
        let side = side.cbrt().max(CELL);
        let size = extent.map(|extent| to_index(extent / side) + 1);
        let cells = (0..size.iter().product()).map(|_| AtomicU8::new(UNKNOWN)).collect();
        Self { proof, low, side, size, cells }
    }

    /// Returns true if no pulse came near to the middle of the cell of a place; false outside of all cells.
    fn is_unseen(&self, place: [f64; 3]) -> bool {
        let mut cell = [0; 3];
        for axis in 0..3 {
            let at = (place[axis] - self.low[axis]) / self.side;
            let index = to_index(at);
            if !(at >= 0.0) || index >= self.size[axis] {
                return false;
            }
            cell[axis] = index;
        }
        let Some(known) = self.cells.get((cell[2] * self.size[1] + cell[1]) * self.size[0] + cell[0]) else {
            return false;
        };
        // whichever thread finds it out first, it is the same
        match known.load(Ordering::Relaxed) {
            UNKNOWN => {
                let middle = std::array::from_fn(|i| self.low[i] + (cell[i] as f64 + 0.5) * self.side);
                let found = if self.proof.is_seen(middle) { SEEN } else { UNSEEN };
                known.store(found, Ordering::Relaxed);
                found == UNSEEN
            }
            known => known == UNSEEN,
        }
    }

    /// Returns the distance of a path of `range` metres at which its unseen length exceeds each level.
    fn limits(&self, eye: [f64; 3], direction: [f64; 3], range: f64) -> [f32; LEVELS.len()] {
        let mut limits = [to_f32(range); LEVELS.len()];
        let (mut unseen, mut level) = (0.0, 0);
        let steps = (0..).map(|step| (f64::from(step) + 0.5) * self.side).take_while(|at| *at < range);
        for at in steps {
            if self.is_unseen(std::array::from_fn(|i| eye[i] + at * direction[i])) {
                unseen += self.side;
            }
            while unseen > LEVELS[level] {
                limits[level] = to_f32(at - self.side / 2.0);
                level += 1;
            }
        }
        limits
    }
}

/// Ways around the one to a place: right and up, as shares of how near they must pass.
pub(super) fn ways_around() -> Vec<[f64; 2]> {
    let ring = |(radius, count): (f64, u32)| {
        (0..count).map(move |number| {
            let (sin, cos) = (TAU * f64::from(number) / f64::from(count)).sin_cos();
            [radius * cos, radius * sin]
        })
    };
    RINGS.into_iter().flat_map(ring).collect()
}

/// Space that all scans share.
pub(super) struct ScannedSpace<'a> {
    pub(super) scene: &'a MedialScene,
    pub(super) ground: Option<&'a Ground>,
    pub(super) seen: SeenCells<'a>,
    pub(super) params: &'a ScannerParams,
    pub(super) nearness: f64,
    pub(super) around: Vec<[f64; 2]>,
}

/// A scan from one place, whose ways are followed when they are first needed.
pub(super) struct VirtualScan<'a> {
    space: &'a ScannedSpace<'a>,
    eye: [f64; 3],
    /// Height of the ground below, local metres.
    floor: f64,
    /// Free length of each direction, metres: infinite if its pulse does not return, NaN if it is not known yet.
    ranges: Vec<f32>,
    /// Length that a pulse proves along each way, for each level, metres: 0 where it does not return, NaN where it is
    /// not known yet.
    lengths: Vec<[f32; LEVELS.len()]>,
}

impl<'a> VirtualScan<'a> {
    /// `None` for an eye that is not finite.
    pub(super) fn new(space: &'a ScannedSpace<'a>, eye: [f64; 3]) -> Option<Self> {
        // who looks at what nobody saw may stand on ground that nobody saw
        let known = space.ground.and_then(|ground| ground.height_at([eye[0], eye[1]]));
        let floor = known.unwrap_or(eye[2] - STATION_HEIGHT);
        let ranges = vec![f32::NAN; COLUMNS * ROWS];
        let lengths = vec![[f32::NAN; LEVELS.len()]; COLUMNS * ROWS];
        eye.iter().all(|v| v.is_finite()).then_some(Self { space, eye, floor, ranges, lengths })
    }

    /// The lowest level at which a pulse passes near to a place and returns.
    pub(super) fn level(&mut self, place: [f64; 3]) -> Option<usize> {
        let ScannedSpace { params, nearness, around, .. } = self.space;
        let offset = sub(place, self.eye);
        let distance = length(offset);
        // a way represents the pulse nearest to it, which runs up to half a diagonal of their grid beside it
        let near = nearness - FRAC_1_SQRT_2 * params.angular_step * distance;
        if !(near > 0.0 && distance <= params.max_range) {
            return None;
        }
        let ahead = unit(offset)?;
        let right = unit(cross(ahead, [0.0, 0.0, 1.0])).unwrap_or([1.0, 0.0, 0.0]);
        let up = cross(right, ahead);
        let mut found = None;
        for [x, y] in around {
            let towards = std::array::from_fn(|i| offset[i] + near * (x * right[i] + y * up[i]));
            let (direction, lengths) = self.way(towards);
            let passes = |length: f32| {
                let at = dot(offset, direction).clamp(0.0, f64::from(length));
                let beside = sub(offset, direction.map(|v| at * v));
                length > 0.0 && dot(beside, beside) <= near * near
            };
            let level = lengths.into_iter().position(passes);
            found = level.into_iter().chain(found).min();
            if found == Some(0) {
                break;
            }
        }
        found
    }

    /// The way nearest to a direction: its unit vector, and the length that its pulse proves at each level, metres.
    fn way(&mut self, towards: [f64; 3]) -> ([f64; 3], [f32; LEVELS.len()]) {
        let [x, y, z] = towards;
        let step = TAU / COLUMNS as f64;
        let cell = |angle: f64, count: usize| to_index(angle / step).min(count - 1);
        let column = cell(x.atan2(y) + PI, COLUMNS);
        let row = cell(FRAC_PI_2 - z.atan2(x.hypot(y)), ROWS);
        let direction = panorama_direction(COLUMNS, [column, row]);
        let number = row * COLUMNS + column;
        if self.lengths[number][0].is_nan() {
            self.lengths[number] = self.space.seen.limits(self.eye, direction, self.proven_length([column, row]));
        }
        (direction, self.lengths[number])
    }

    /// Returns the length that the pulse of a direction proves, metres. It is at most that of the neighbouring
    /// directions. Balls do not close far walls of a coarse scan, and a pulse through such a gap alone does not pass in
    /// truth.
    fn proven_length(&mut self, [column, row]: [usize; 2]) -> f64 {
        if self.range([column, row]).is_infinite() {
            return 0.0;
        }
        let rows = row.saturating_sub(1)..=(row + 1).min(ROWS - 1);
        let beside = rows.flat_map(|row| [COLUMNS - 1, 0, 1].map(|shift| [(column + shift) % COLUMNS, row]));
        let range = beside.map(|way| self.range(way)).fold(f32::INFINITY, f32::min);
        (f64::from(range) - f64::from(FreeSegmentParams::default().end_margin)).max(0.0)
    }

    fn range(&mut self, [column, row]: [usize; 2]) -> f32 {
        let number = row * COLUMNS + column;
        if self.ranges[number].is_nan() {
            let direction = panorama_direction(COLUMNS, [column, row]);
            let seen = self.space.scene.seen_along(self.eye, direction, self.space.params.max_range);
            let range = seen.map(|(_, range)| range).or_else(|| self.beyond_the_model(direction));
            self.ranges[number] = to_f32(range.unwrap_or(f64::INFINITY));
        }
        self.ranges[number]
    }

    /// Returns the length of a pulse that meets nothing in the model. A falling pulse meets the ground, or unseen space
    /// before that, at the latest where the cloud ends; a rising one does not return.
    fn beyond_the_model(&self, direction: [f64; 3]) -> Option<f64> {
        if !(direction[2] < 0.0) {
            return None;
        }
        let to_floor = (self.eye[2] - self.floor).max(0.0) / -direction[2];
        let mut range = to_floor.min(self.space.params.max_range);
        if let Some(coverage) = self.space.scene.coverage() {
            let (low, high) = coverage.bounds().corners();
            for axis in (0..2).filter(|&axis| direction[axis] != 0.0) {
                let side = if direction[axis] > 0.0 { high[axis] } else { low[axis] };
                range = range.min(((side - self.eye[axis]) / direction[axis]).max(0.0));
            }
        }
        Some(range)
    }
}
