//! How far one sees from an eye along a direction.

use super::MedialScene;
use crate::depth::Profile;
use crate::ray_index::Ray;
use belvedere_data::vector::{dot, sub};

impl MedialScene {
    /// The ball that an eye at `eye`, local metres, sees along the unit vector `direction` within `reach` metres (may be infinite): its row
    /// among the balls given and its range, metres. `None` where nothing blocks. Balls that hold the eye are left out,
    /// as for every line of sight; none gives way, since there is no target.
    #[must_use]
    pub fn seen_along(&self, eye: [f64; 3], direction: [f64; 3], reach: f64) -> Option<(usize, f64)> {
        let ray = Ray { origin: eye, direction, ranges: [0.0, reach] };
        let (number, range) = self.index.nearest(&ray, |number| self.entry(number, &ray))?;
        Some((*self.rows.get(number)? as usize, range))
    }

    /// Where a ray from an eye meets ball `number`, if that does not hold the eye.
    fn entry(&self, number: usize, ray: &Ray) -> Option<f64> {
        let &(center, radius) = self.balls.get(number)?;
        let (offset, radius) = (sub(center.map(f64::from), ray.origin), f64::from(radius));
        let along = dot(offset, ray.direction);
        let square = dot(offset, offset);
        let beside = (square - along * along).max(0.0);
        if along <= 0.0 || square <= radius * radius || beside >= radius * radius {
            return None;
        }
        Some(match self.params.profile {
            Profile::Sphere => along - (radius * radius - beside).sqrt(),
            Profile::PaperCone => (along - (radius - beside.sqrt())).max(0.0),
        })
    }
}
