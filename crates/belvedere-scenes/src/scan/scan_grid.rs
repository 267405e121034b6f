//! Scan from a tripod as the grid of its pulses.

use std::fmt::Write as _;

use crate::scan::Scan;
use crate::scan::terrestrial::TerrestrialParams;
use crate::vector::sub;

/// All pulses of one place of a tripod, including pulses without a return.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScanGrid {
    /// Centre of the instrument, metres, absolute.
    pub station: [f64; 3],
    /// Number of rows, from below upwards; columns go around.
    pub rows: usize,
    /// First return of each pulse, metres, absolute, column by column, (C × R).
    pub returns: Vec<Option<[f64; 3]>>,
}

impl ScanGrid {
    /// Returns PTX text of the scan, with positions relative to the station in tenths of a millimetre. Pulses without a
    /// return are zeros.
    #[must_use]
    pub fn to_ptx(&self) -> String {
        let [x, y, z] = self.station;
        let columns = self.returns.len() / self.rows.max(1);
        let place = format!("{x:.4} {y:.4} {z:.4}");
        let mut text = format!("{columns}\n{}\n{place}\n1 0 0\n0 1 0\n0 0 1\n", self.rows);
        text.push_str("1 0 0 0\n0 1 0 0\n0 0 1 0\n");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{place} 1");
        for found in &self.returns {
            let [x, y, z] = found.map_or([0.0; 3], |position| sub(position, self.station));
            let _ = writeln!(text, "{x:.4} {y:.4} {z:.4} 0.5");
        }
        text
    }
}

impl TerrestrialParams {
    /// Returns the pulses of `scan`, made by these parameters, as a grid for each place of the tripod.
    #[must_use]
    pub fn grids(&self, scan: &Scan) -> Vec<ScanGrid> {
        let [columns, rows] = self.grid().map(|count| count as usize);
        let empty = |&station| ScanGrid { station, rows, returns: vec![None; columns * rows] };
        let mut grids: Vec<ScanGrid> = scan.stations.iter().map(empty).collect();
        for row in (0..scan.len()).filter(|&row| scan.return_number[row] == 1) {
            let number = usize::from(scan.point_source_id[row]).wrapping_sub(1);
            let Some(grid) = grids.get_mut(number) else { continue };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number of a pulse")]
            let pulse = ((scan.gps_time[row] - self.start_of(number)) * self.pulse_rate).round() as usize;
            if let Some(found) = grid.returns.get_mut(pulse) {
                *found = Some([scan.x[row], scan.y[row], scan.z[row]]);
            }
        }
        grids
    }
}
