//! How far one sees from an eye along a direction.

use super::MedialScene;
use crate::ray_index::Ray;

impl MedialScene {
    /// The ball that an eye at `eye`, local metres, sees along the unit vector `direction` within `reach` metres (may be infinite): its row
    /// among the balls given and its range, metres. `None` where nothing blocks. Balls that hold the eye are left out,
    /// as for every line of sight; none gives way, since there is no target.
    #[must_use]
    pub fn seen_along(&self, eye: [f64; 3], direction: [f64; 3], reach: f64) -> Option<(usize, f64)> {
        let ray = Ray { origin: eye, direction, ranges: [0.0, reach] };
        let (number, range) = self.tree().index().nearest(&ray, |number| {
            self.tree().rule().meets_ray(*self.tree().balls().get(number)?, ray.origin, ray.direction)
        })?;
        Some((*self.tree().rows().get(number)? as usize, range))
    }
}
