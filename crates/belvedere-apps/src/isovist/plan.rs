//! The isovist in the level plane through the eye, as plans of buildings have it.

use super::params::IsovistParams;
use super::ranges::RadialStatistics;
use belvedere_data::view::to_sun;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Halvings of a step that tell a jump from a wall seen at a slant: 1° becomes a thousandth of it.
const HALVINGS: usize = 10;
/// Rays of the plan for each column of the panorama: the plane has few.
const RAYS_PER_STEP: usize = 4;

/// Visible area in the level plane through the eye.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanIsovist {
    /// Corners of the visible region: azimuth clockwise from north, radians, and range, metres, the maximum where
    /// nothing blocks. In rising order of azimuth; two corners close together stand on both sides of a jump.
    pub corners: Vec<[f64; 2]>,
    /// Area, m².
    pub area: f64,
    /// Perimeter, metres, including jumps and the border at the greatest range.
    pub perimeter: f64,
    /// Length of the jumps in range, metres: edges behind which something hides (occlusivity).
    pub occlusivity: f64,
    /// Share of the azimuths in which nothing blocks within the greatest range, 0 to 1.
    pub openness: f64,
    /// Ranges in all azimuths, open ones as the greatest range.
    pub ranges: RadialStatistics,
    /// Vector from the eye to the middle of the area: east and north, metres.
    pub drift: [f64; 2],
}

impl PlanIsovist {
    /// 4 π area / perimeter²: 1 for a circle, less for whatever is longer or more jagged.
    #[must_use]
    pub fn compactness(&self) -> f64 {
        2.0 * TAU * self.area / (self.perimeter * self.perimeter)
    }

    /// Length of [`PlanIsovist::drift`], metres.
    #[must_use]
    pub fn drift_length(&self) -> f64 {
        self.drift[0].hypot(self.drift[1])
    }
}

/// The plan from ranges in the plane, `width` · 4 at first, more where they jump.
pub(super) fn plan(
    range: &(impl Fn([f64; 3]) -> Option<f64> + Sync),
    width: usize,
    params: &IsovistParams,
) -> PlanIsovist {
    let count = width * RAYS_PER_STEP;
    let step = TAU / count as f64;
    let reach = params.max_range;
    let at = |azimuth: f64| range(to_sun(azimuth, 0.0));
    let ranges: Vec<Option<f64>> = (0..count).into_par_iter().map(|i| at(i as f64 * step)).collect();
    let finer: Vec<Vec<[f64; 2]>> = (0..count)
        .into_par_iter()
        .map(|i| {
            let from = [i as f64 * step, ranges[i].unwrap_or(reach)];
            let to = [(i + 1) as f64 * step, ranges[(i + 1) % count].unwrap_or(reach)];
            let mut corners = vec![from];
            refine(&|azimuth| at(azimuth).unwrap_or(reach), from, to, params.jump, HALVINGS, &mut corners);
            corners
        })
        .collect();
    let corners = finer.concat();
    let mut plan = PlanIsovist::default();
    let mut moments = [0.0; 2];
    // a jump stays between corners that close together; walls at a slant became small steps
    let narrow = 1.5 * step / f64::from(1 << HALVINGS);
    for (i, &[azimuth, range]) in corners.iter().enumerate() {
        let [mut next, next_range] = corners[(i + 1) % corners.len()];
        if i + 1 == corners.len() {
            next += TAU;
        }
        let [a, b] = [(azimuth, range), (next, next_range)]
            .map(|(azimuth, range)| [range * azimuth.sin(), range * azimuth.cos()]);
        // clockwise
        let twice = a[1] * b[0] - a[0] * b[1];
        plan.area += twice / 2.0;
        for axis in 0..2 {
            moments[axis] += twice * (a[axis] + b[axis]) / 6.0;
        }
        plan.perimeter += (b[0] - a[0]).hypot(b[1] - a[1]);
        let jump = (next_range - range).abs();
        if jump > params.jump && next - azimuth < narrow {
            plan.occlusivity += jump;
        }
    }
    if plan.area > 0.0 {
        plan.drift = moments.map(|v| v / plan.area);
    }
    let weighted: Vec<(f64, f64)> = ranges.iter().map(|range| (range.unwrap_or(reach), 1.0)).collect();
    plan.ranges = RadialStatistics::of(&weighted);
    plan.openness = ranges.iter().filter(|range| range.is_none()).count() as f64 / count as f64;
    plan.corners = corners;
    plan
}

/// Adds corners between two, the first of which is there already, until neighbours differ by no more than `jump` or no
/// angle is left between them.
fn refine(
    range: &impl Fn(f64) -> f64,
    from: [f64; 2],
    to: [f64; 2],
    jump: f64,
    halvings: usize,
    corners: &mut Vec<[f64; 2]>,
) {
    if halvings == 0 || (from[1] - to[1]).abs() <= jump {
        return;
    }
    let azimuth = (from[0] + to[0]) / 2.0;
    let middle = [azimuth, range(azimuth)];
    refine(range, from, middle, jump, halvings - 1, corners);
    corners.push(middle);
    refine(range, middle, to, jump, halvings - 1, corners);
}
