//! Where a ray crosses an implicit surface: the samples whose balls it meets, swept from near to far.

use super::{ImplicitSurfaceParams, NormalSigns, SurfaceSample};
use belvedere::ray_index::{Ray, RayIndex};
use belvedere::vector::{dot, length, sub};

/// Halvings of the step in which the sign changes: of a step of 0.2 m they leave a millimetre.
const HALVINGS: usize = 8;

/// How near the surface the aim of a local plane must come, as a share of the step: of 0.025 and 0.1 the latter missed
/// fewer shadows of a simulated town (2.4 instead of 2.7 % of those in free space) at equal false ones.
const AIM_TOLERANCE: f64 = 0.1;

/// A sample met by a ray, and the ranges between which the ray is in its ball.
#[derive(Clone, Copy)]
struct Met {
    enter: f64,
    leave: f64,
    row: usize,
}

/// The formula at a place.
#[derive(Clone, Copy)]
struct Value {
    range: f64,
    /// f, metres; its sign goes with that of `normal`.
    distance: f64,
    /// Weighted mean of the normals, of any length up to one.
    normal: [f64; 3],
    on_surface: OnSurface,
}

/// Whether the surface exists where the formula is zero.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OnSurface {
    Supported,
    BeyondEdge,
}

/// Crossings of one ray with the surface, from near to far.
pub(super) struct Crossings<'a> {
    samples: &'a [SurfaceSample],
    ray: &'a Ray,
    params: &'a ImplicitSurfaceParams,
    /// By range of entry.
    met: Vec<Met>,
    /// The next of `met` to be entered.
    next: usize,
    /// Samples entered and not yet left.
    active: Vec<Met>,
    range: f64,
    last: Option<Value>,
}

impl<'a> Crossings<'a> {
    pub(super) fn new(
        samples: &'a [SurfaceSample],
        index: &RayIndex,
        ray: &'a Ray,
        params: &'a ImplicitSurfaceParams,
    ) -> Self {
        let mut met = Vec::new();
        index.each(ray, |row| {
            let sample = &samples[row];
            let to_center = sub(sample.position.map(f64::from), ray.origin);
            let middle = dot(to_center, ray.direction);
            let support = f64::from(sample.support);
            let half = (support * support - (dot(to_center, to_center) - middle * middle)).max(0.0).sqrt();
            let (enter, leave) = ((middle - half).max(ray.ranges[0]), (middle + half).min(ray.ranges[1]));
            if enter < leave {
                met.push(Met { enter, leave, row });
            }
        });
        // rows break ties, so that sums do not depend on the order in which the tree gives them
        met.sort_unstable_by(|a, b| a.enter.total_cmp(&b.enter).then(a.row.cmp(&b.row)));
        Self { samples, ray, params, met, next: 0, active: Vec::new(), range: ray.ranges[0], last: None }
    }

    /// Moves to the next place where the formula is evaluated; false at the end.
    fn advance(&mut self) -> bool {
        let step = self.active.iter().map(|met| self.samples[met.row].support).fold(f32::INFINITY, f32::min);
        let farthest = self.active.iter().map(|met| met.leave).fold(f64::NEG_INFINITY, f64::max);
        let onward = (self.range + f64::from(step) * self.params.step).min(farthest);
        if onward > self.range {
            self.range = onward;
        } else {
            // all are left: nothing until the next is entered, and no sign to compare with
            let Some(next) = self.met.get(self.next) else { return false };
            self.range = self.range.max(next.enter);
            self.last = None;
        }
        true
    }

    /// The formula at `range`, of the samples in reach there; of normals without a sign, that which
    /// goes with `along`.
    fn value(&self, range: f64, along: Option<[f64; 3]>) -> Option<Value> {
        let place = self.ray.at(range);
        let agreeing = self.params.signs == NormalSigns::Agreeing;
        // (1 − d²/h²)³ reaches zero smoothly at the surface of the ball
        let weighted = self.active.iter().filter_map(|met| {
            let sample = &self.samples[met.row];
            let offset = sub(sample.position.map(f64::from), place);
            let share = 1.0 - dot(offset, offset) / f64::from(sample.support).powi(2);
            (share > 0.0).then_some((share, offset, sample))
        });
        // of the samples around, the relatively nearest says which way normals point
        let reference = weighted.clone().max_by(|a, b| a.0.total_cmp(&b.0))?.2.normal.map(f64::from);
        let (mut weight_sum, mut count, mut support) = (0.0, 0, 0.0);
        let (mut offset_sum, mut normal_sum) = ([0.0; 3], [0.0; 3]);
        for (share, offset, sample) in weighted {
            let weight = share * share * share;
            let normal = sample.normal.map(f64::from);
            let sign = if agreeing && dot(normal, reference) < 0.0 { -1.0 } else { 1.0 };
            weight_sum += weight;
            count += 1;
            support += weight * f64::from(sample.support);
            for axis in 0..3 {
                offset_sum[axis] += weight * offset[axis];
                normal_sum[axis] += weight * sign * normal[axis];
            }
        }
        // weights that vanish say nothing
        if !(weight_sum > f64::MIN_POSITIVE) {
            return None;
        }
        let to_mean = offset_sum.map(|v| v / weight_sum);
        if agreeing && along.is_some_and(|along| dot(along, normal_sum) < 0.0) {
            normal_sum = normal_sum.map(|v| -v);
        }
        let normal = normal_sum.map(|v| v / weight_sum);
        let supported = count >= self.params.min_samples && length(to_mean) <= self.params.edge * support / weight_sum;
        Some(Value {
            range,
            distance: -dot(normal, to_mean),
            normal,
            on_surface: if supported { OnSurface::Supported } else { OnSurface::BeyondEdge },
        })
    }

    /// Where the local plane of either end of a step meets the ray, if that is within the step and nearly on the
    /// surface: at ridges and corners, signs that agree along the ray cannot distinguish the two sides.
    fn aimed_at(&self, near: Value, far: Value) -> Option<Value> {
        let tolerance = AIM_TOLERANCE * (far.range - near.range);
        [near, far].into_iter().find_map(|end| {
            let range = end.range - end.distance / dot(end.normal, self.ray.direction);
            if !(near.range..=far.range).contains(&range) {
                return None;
            }
            let value = self.value(range, Some(end.normal))?;
            (value.distance.abs() <= tolerance && value.on_surface == OnSurface::Supported).then_some(value)
        })
    }

    /// The crossing between two values of unlike sign.
    fn bisect(&self, mut near: Value, mut far: Value) -> Value {
        for _ in 0..HALVINGS {
            let Some(middle) = self.value((near.range + far.range) / 2.0, Some(near.normal)) else { break };
            if (middle.distance < 0.0) == (near.distance < 0.0) {
                near = middle;
            } else {
                far = middle;
            }
        }
        far
    }
}

impl Iterator for Crossings<'_> {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        while self.advance() {
            let since = self.last.map_or(self.range, |last| last.range);
            self.active.retain(|met| met.leave >= since);
            while let Some(&met) = self.met.get(self.next).filter(|met| met.enter <= self.range) {
                self.active.push(met);
                self.next += 1;
            }
            let value = self.value(self.range, self.last.map(|last| last.normal));
            let before = std::mem::replace(&mut self.last, value);
            let (Some(near), Some(far)) = (before, value) else { continue };
            let crossing = if (near.distance < 0.0) == (far.distance < 0.0) {
                self.aimed_at(near, far)
            } else {
                Some(self.bisect(near, far)).filter(|crossing| crossing.on_surface == OnSurface::Supported)
            };
            if let Some(crossing) = crossing {
                return Some(crossing.range);
            }
        }
        None
    }
}
