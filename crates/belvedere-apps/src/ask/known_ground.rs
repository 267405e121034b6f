//! The ground of a scene, and reports on it.

use super::context::Context;
use super::remark::Remark;
use super::sections::GroundSection;
use belvedere_core::ground::{Ground, GroundPoints, GroundReport, GroundShift, ShiftEvidence};
use belvedere_data::Frame;
use belvedere_data::report::rounded;

/// The ground on a grid, and where it came from.
pub struct KnownGround {
    /// Its heights.
    pub ground: Ground,
    /// The points that show it.
    pub report: GroundReport,
}

impl GroundSection {
    /// Describes a ground.
    #[must_use]
    pub fn of(known: &KnownGround) -> Self {
        let grid = known.ground.grid;
        let source = match known.report.from {
            GroundPoints::Found => "detected points (no class 2)",
            _ => "class 2",
        };
        Self {
            source,
            points: known.report.point_count,
            points_not_believed: known.report.doubted_count,
            grid_columns: grid.width,
            grid_rows: grid.height,
            cell_m: rounded(grid.cell, 4),
            cells_without_ground: grid.len() - known.report.cell_count,
        }
    }
}

impl Context {
    /// Reports on the ground of a scene, and warns of points that say they are ground and contradict others.
    pub(super) fn ground(&mut self, frame: &Frame, known: &KnownGround) {
        self.report.ground = Some(GroundSection::of(known));
        let GroundReport { doubted_count, point_count, .. } = known.report;
        let so = "lie metres below or above the ground around, and are not believed";
        let count = doubted_count + point_count;
        let is_new = self.remarks.iter().all(|remark| remark.key != "ground-not-believed");
        self.add(
            Remark::of_share("ground-not-believed", doubted_count, count, "points of class 2", so).filter(|_| is_new),
        );
        self.add(known.report.shift.map(|shift| remark_on_shift(&shift, frame)));
    }
}

/// A warning of ground points that lie off over an area.
fn remark_on_shift(shift: &GroundShift, frame: &Frame) -> Remark {
    let GroundShift { point_count, rise, low, high, against } = *shift;
    let corner = |[x, y]: [f32; 2]| {
        let [x, y, _] = frame.file_from_local([f64::from(x), f64::from(y), 0.0]);
        [x, y].map(|v| rounded(v, 1))
    };
    let [[west, south], [east, north]] = [low, high].map(corner);
    let rise = rounded(f64::from(rise), 2);
    let lie = format!("lie {:.2} m {}", rise.abs(), if rise < 0.0 { "below" } else { "above" });
    let which = match against {
        ShiftEvidence::SecondLevel => format!("{lie} others of class 2 at the same places"),
        ShiftEvidence::Strips { shifted, other } => {
            format!("(point source {shifted}) {lie} those of point source {other} where the two meet")
        }
    };
    let text = format!(
        "{point_count} points of class 2 {which}, between {west}, {south} and {east}, {north}: heights of the ground \
         are wrong there; correct the heights or the class of these points"
    );
    let remark = Remark::warning("ground-shifted", text).with("count", point_count as f64).with("rise_m", rise);
    remark.with("west", west).with("south", south).with("east", east).with("north", north)
}
