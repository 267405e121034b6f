//! Order of the points of a scan in a file.

use rayon::prelude::*;

use crate::random::Random;
use crate::scan::Scan;

/// Order of the points of a file. Surveys are delivered in any of these orders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PointOrder {
    /// Order of measurement: by strip, time and return number.
    #[default]
    Flight,
    /// Order of squares of 20 m, row by row from the south-west; within a square the order of measurement.
    Squares,
    /// Random order.
    Shuffled,
}

/// Side of the squares of [`PointOrder::Squares`], metres.
const SQUARE: f64 = 20.0;

impl PointOrder {
    /// All orders.
    pub const ALL: [Self; 3] = [Self::Flight, Self::Squares, Self::Shuffled];

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Squares => "squares",
            Self::Shuffled => "shuffled",
        }
    }
}

impl Scan {
    /// Returns the scan with its columns in another order; the path and the counts stay. Another `seed` shuffles
    /// differently. The order of flight leaves a new scan unchanged.
    #[must_use]
    pub fn in_order(mut self, order: PointOrder, seed: u64) -> Self {
        let mut rows: Vec<usize> = (0..self.len()).collect();
        match order {
            PointOrder::Flight => return self,
            PointOrder::Squares => {
                let square = |row: usize| [self.y[row], self.x[row]].map(|v| whole(v / SQUARE));
                rows.par_sort_by_key(|&row| square(row));
            }
            // Every point draws its place from its own stream, so that threads need not share one.
            PointOrder::Shuffled => rows.par_sort_by_cached_key(|&row| Random::new(seed, row as u64).next_u64()),
        }
        reorder(&mut self.x, &rows);
        reorder(&mut self.y, &rows);
        reorder(&mut self.z, &rows);
        reorder(&mut self.gps_time, &rows);
        reorder(&mut self.return_number, &rows);
        reorder(&mut self.return_count, &rows);
        reorder(&mut self.scan_angle_deg, &rows);
        reorder(&mut self.point_source_id, &rows);
        reorder(&mut self.classification, &rows);
        reorder(&mut self.intensity, &rows);
        reorder(&mut self.triangle, &rows);
        reorder(&mut self.exact_positions, &rows);
        self
    }
}

fn reorder<T: Copy>(column: &mut Vec<T>, rows: &[usize]) {
    *column = rows.iter().map(|&row| column[row]).collect();
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates far outside any town")]
fn whole(value: f64) -> i64 {
    value.floor() as i64
}
