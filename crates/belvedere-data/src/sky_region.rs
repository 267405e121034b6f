//! Regions in which the pulses of a scan met nothing up to the sky.

/// The directions of one scan in which pulses returned nothing and see the sky, on a regular grid of angles about its
/// scanner. These pulses have no point; they prove that their way is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkyRegion {
    /// Index into [`PointCloud::scanner_positions`](crate::PointCloud::scanner_positions).
    pub scanner: u16,
    /// Distance from the scanner up to which the pulses prove space empty, metres: at this range it still received
    /// returns.
    pub range: f32,
    /// The axes of the scan in local coordinates: its direction d is Σ axesᵢ dᵢ.
    pub axes: [[f64; 3]; 3],
    /// Azimuth of the first column and step to the next, radians about the third axis, from the first to the second.
    pub azimuth: [f64; 2],
    /// Elevation of the first row and step to the next, radians above the plane of the first two axes.
    pub elevation: [f64; 2],
    /// Number of columns.
    pub columns: usize,
    /// True for cells whose pulses see the sky, row by row, (R × C).
    pub is_open: Vec<bool>,
}

impl SkyRegion {
    /// Rows and columns of the cells that see the sky, row by row.
    pub fn open_cells(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let columns = self.columns.max(1);
        let open = self.is_open.iter().enumerate().filter(|(_, is_open)| **is_open);
        open.map(move |(cell, _)| [cell / columns, cell % columns])
    }

    /// Elevation of a row above the plane of the first two axes, radians.
    #[must_use]
    pub fn elevation_of(&self, row: usize) -> f64 {
        self.elevation[0] + self.elevation[1] * row as f64
    }

    /// Unit vector of the pulse in the middle of a cell, away from the scanner, in local coordinates.
    #[must_use]
    pub fn direction(&self, [row, column]: [usize; 2]) -> [f64; 3] {
        let (sin, cos) = (self.azimuth[0] + self.azimuth[1] * column as f64).sin_cos();
        let (up, level) = self.elevation_of(row).sin_cos();
        let of_scan = [level * cos, level * sin, up];
        std::array::from_fn(|i| (0..3).map(|axis| self.axes[axis][i] * of_scan[axis]).sum())
    }
}
