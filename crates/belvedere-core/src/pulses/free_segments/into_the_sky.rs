//! The ways of pulses that returned nothing because they went into the sky.

use super::FreeSegments;
use super::segment::{FreeSegment, SegmentsByAxis};
use super::tree::SegmentAxis;
use belvedere_data::control::Control;
use belvedere_data::sky_region::SkyRegion;
use belvedere_data::vector::box_around;
use belvedere_data::{PointCloud, Result};

/// Spacing of the far ends of these pulses, metres. Every place between them is then within 0.36 m of a pulse, half of
/// the distance at which a pulse counts as near. Boxes of seen space find one pulse for each place.
const SPACING: f64 = 0.5;

impl FreeSegments {
    /// The ways of pulses of `cloud` that met nothing up to the sky, as free segments with the same upper limit of
    /// height as those of this survey. They begin at the scanner, and end where it receives no more returns.
    ///
    /// These pulses met nothing with the whole of their beam. They prove and need not carve: along their way there are
    /// no points, and so no balls. There are only as many as it takes for them to be half a metre apart at their far
    /// ends.
    ///
    /// A scanner outside of the box around the returns, as of a cloud that was cut, gives none.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    ///
    /// # Source
    /// This project's own.
    pub fn into_the_sky(&self, cloud: &PointCloud, control: &Control<'_>) -> Result<Self> {
        let mut by_way = SegmentsByAxis::default();
        let [low, high] = box_around(self.lower_ends().map(|start| start.map(f64::from)));
        for region in &cloud.sky_regions {
            control.check()?;
            let Some(&scanner) = cloud.scanner_positions.get(usize::from(region.scanner)) else { continue };
            let scanner = scanner.map(f64::from);
            if (0..2).all(|axis| (low[axis]..=high[axis]).contains(&scanner[axis])) {
                self.add_region(region, scanner, &mut by_way);
            }
        }
        Self::index(by_way, None, self.top, control)
    }

    fn add_region(&self, region: &SkyRegion, scanner: [f64; 3], by_way: &mut SegmentsByAxis) {
        for cell in region.open_cells() {
            let direction = region.direction(cell);
            let to_top = (f64::from(self.top) - scanner[2]) / direction[2];
            let length = to_top.min(f64::from(region.range));
            if !(direction[2] > 0.0 && length > 0.0) {
                continue;
            }
            // of every so many rows and columns one
            let step = [region.elevation[1], region.azimuth[1] * region.elevation_of(cell[0]).cos()];
            let is_kept = (0..2).all(|i| cell[i].is_multiple_of(stride(SPACING / length / step[i].abs())));
            if is_kept && let Some(way) = SegmentAxis::of(direction) {
                by_way[way.number()].push(FreeSegment::new(scanner, direction, length));
            }
        }
    }
}

/// The largest power of two that is at most `count`, so that those of neighbouring rows fit; at least 1.
fn stride(count: f64) -> usize {
    let mut stride = 1;
    while 2.0 * stride as f64 <= count && stride < 1 << 16 {
        stride *= 2;
    }
    stride
}
