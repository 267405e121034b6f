//! Range of free sight from an eye along a direction.

use crate::query::blocker::nearest_blocker;
use crate::query::triangles::LineEnds;
use crate::query::{Blocker, MedialScene};
use crate::ray_index::Ray;
use belvedere_data::vector::{dot, sub};

/// The first surface before a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceBefore {
    /// What it is of.
    pub blocker: Blocker,
    /// Distance from the place, metres.
    pub range: f64,
    /// Unit normal of a face towards the place; `None` for a ball.
    pub normal: Option<[f64; 3]>,
}

impl MedialScene {
    /// Returns the first obstacle that an eye at `eye`, local metres, sees along the unit vector `direction` within
    /// `reach` metres (may be infinite), and its range, metres. `None` if nothing blocks. Balls that hold the eye are
    /// left out, as for every line of sight. The surface tolerance is not applied, since there is no target.
    ///
    /// A surface patch gives way to the eye only: places up to 0.15 m behind it still count as its surface for
    /// [`MedialScene::answer`].
    #[must_use]
    pub fn seen_along(&self, eye: [f64; 3], direction: [f64; 3], reach: f64) -> Option<(Blocker, f64)> {
        let ray = Ray { origin: eye, direction, ranges: [0.0, reach] };
        let ball = self.tree().index().nearest(&ray, |number| {
            self.tree().rule().meets_ray(*self.tree().balls().get(number)?, ray.origin, ray.direction)
        });
        let ball = ball.and_then(|(number, range)| Some((self.blocker_of_ball(number)?, range)));
        let ends = LineEnds { target: eye, viewer: None };
        nearest_blocker(ball, self.triangles().and_then(|triangles| triangles.nearest(&ray, &ends)))
    }

    /// Returns the first obstacle before a place on a surface, such as a window, along the unit vector `direction`, and
    /// its range, metres. `None` if nothing blocks.
    ///
    /// In contrast to [`MedialScene::seen_along`] the place is a target. Balls near it give way by
    /// [`BlockRule::shell`](crate::query::BlockRule::shell), so that the surface of the place does not hide its
    /// neighbourhood. An obstacle is found in exactly the directions that the visibility matrix has as blocked by balls
    /// and meshes. Of all balls that block, it is the one that the line enters first. The range is 0 in a ball that
    /// holds the place even with the shell.
    #[must_use]
    pub fn seen_from_surface(&self, place: [f64; 3], direction: [f64; 3]) -> Option<(Blocker, f64)> {
        self.surface_before(place, direction).map(|seen| (seen.blocker, seen.range))
    }

    /// Returns the same obstacle as [`MedialScene::seen_from_surface`], with the normal of a face.
    #[must_use]
    pub fn surface_before(&self, place: [f64; 3], direction: [f64; 3]) -> Option<SurfaceBefore> {
        // a ball may be entered before the bias, after which it must be left
        let from = self.tree().rule().bias.min(0.0);
        let ray = Ray { origin: place, direction, ranges: [from, f64::INFINITY] };
        let ball = self.tree().index().nearest(&ray, |number| {
            let exit = self.front(number, &ray)?;
            let middle = dot(sub(self.ball(number).center.map(f64::from), place), direction);
            Some((2.0 * middle - exit).max(0.0))
        });
        let ball = ball.and_then(|(number, range)| Some((self.blocker_of_ball(number)?, range)));
        let line = Ray { ranges: [0.0, f64::INFINITY], ..ray };
        let ends = LineEnds { target: place, viewer: None };
        let face = self.triangles().and_then(|triangles| triangles.nearest_face(&line, &ends));
        let normal = face.map(|(_, normal)| normal);
        let (blocker, range) = nearest_blocker(ball, face.map(|(face, _)| face))?;
        Some(SurfaceBefore { blocker, range, normal: normal.filter(|_| blocker.ball().is_none()) })
    }
}
