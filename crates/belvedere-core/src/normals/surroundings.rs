//! The highest points in the surroundings, which show on which side of a steep surface the building is.

use belvedere_data::cast::to_cell;
use rayon::prelude::*;

/// Width of a cell: about the spacing of the sparsest clouds worth orienting, and a tenth of a small house.
const CELL_M: f64 = 0.5;

/// Horizontal reach of the vote, metres: most of a small house, less than a street.
const REACH_M: f64 = 3.0;

/// Heights must differ by this much for one side to count as building and the other as ground: half a storey.
const MIN_RELIEF_M: f32 = 2.0;

/// Highest point of every occupied cell of a horizontal grid, sorted by cell.
pub(super) struct HighestPointGrid {
    cells: Vec<((i32, i32), f32)>,
}

impl HighestPointGrid {
    /// Surroundings of local positions, (N, 3), metres.
    pub(super) fn new(positions: &[[f32; 3]]) -> Self {
        let mut cells: Vec<((i32, i32), f32)> =
            positions.par_iter().map(|p| ((cell(p[1].into()), cell(p[0].into())), p[2])).collect();
        // by cell and then downward, so that the highest of a cell comes first
        cells.par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
        cells.dedup_by_key(|entry| entry.0);
        // one cell is left for two or three points
        cells.shrink_to_fit();
        Self { cells }
    }

    /// Horizontal unit vector from the high half of the surroundings of a local position to the low half, or `None`
    /// where they are about level.
    ///
    /// # Source
    /// Above a facade is roof (inside), and below it ground (outside). Halves of the local relief instead of fixed
    /// offsets from the point serve points near the ground and near the eaves alike.
    pub(super) fn downhill(&self, position: [f32; 3]) -> Option<[f64; 2]> {
        let (x, y) = (f64::from(position[0]), f64::from(position[1]));
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for (_, z) in self.cells_around(x, y) {
            low = low.min(z);
            high = high.max(z);
        }
        if high - low < MIN_RELIEF_M {
            return None;
        }
        let middle = low + (high - low) / 2.0;
        // sum of x, sum of y and number of cells: low half, high half
        let mut halves = [[0.0; 3]; 2];
        for ((row, column), z) in self.cells_around(x, y) {
            let half = &mut halves[usize::from(z > middle)];
            half[0] += (column as f64 + 0.5) * CELL_M - x;
            half[1] += (row as f64 + 0.5) * CELL_M - y;
            half[2] += 1.0;
        }
        let [low, high] = halves.map(|half| [half[0] / half[2], half[1] / half[2]]);
        let (dx, dy) = (low[0] - high[0], low[1] - high[1]);
        let length = dx.hypot(dy);
        (length > 1e-6 && length.is_finite()).then(|| [dx / length, dy / length])
    }

    fn cells_around(&self, x: f64, y: f64) -> impl Iterator<Item = ((i32, i32), f32)> + '_ {
        let (left, right) = (cell(x - REACH_M), cell(x + REACH_M));
        (cell(y - REACH_M)..=cell(y + REACH_M)).flat_map(move |row| {
            let start = self.cells.partition_point(|entry| entry.0 < (row, left));
            self.cells[start..].iter().take_while(move |entry| entry.0 <= (row, right)).copied()
        })
    }
}

fn cell(coordinate: f64) -> i32 {
    to_cell(coordinate / CELL_M)
}
