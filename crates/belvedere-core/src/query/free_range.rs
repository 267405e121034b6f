//! How far one sees from an eye along a direction.

use super::added::Ends;
use super::medial_scene::nearer;
use super::{Blocker, MedialScene};
use crate::ray_index::Ray;

impl MedialScene {
    /// What an eye at `eye`, local metres, sees along the unit vector `direction` within `reach` metres (may be infinite), and its range,
    /// metres. `None` where nothing blocks. Balls that hold the eye are left out,
    /// as for every line of sight; none gives way, since there is no target.
    #[must_use]
    pub fn seen_along(&self, eye: [f64; 3], direction: [f64; 3], reach: f64) -> Option<(Blocker, f64)> {
        let ray = Ray { origin: eye, direction, ranges: [0.0, reach] };
        let ball = self.tree().index().nearest(&ray, |number| {
            self.tree().rule().meets_ray(*self.tree().balls().get(number)?, ray.origin, ray.direction)
        });
        let ball = ball.and_then(|(number, range)| Some((self.blocker_of_ball(number)?, range)));
        let ends = Ends { target: eye, viewer: None };
        nearer(ball, self.added().and_then(|added| added.nearest(&ray, &ends)))
    }
}
