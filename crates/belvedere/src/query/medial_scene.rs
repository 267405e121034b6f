//! A union of medial balls that exact lines of sight are cut with.

use super::{Answer, Sight, Viewer, Visibility};
use crate::Result;
use crate::depth::Profile;
use crate::medial::{MedialBalls, NO_TOUCH};
use crate::ray_index::{Ray, RayIndex};
use rayon::prelude::*;

/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// Medial balls indexed for exact lines of sight, for any number of viewers.
///
/// A target is blocked if its line of sight to the viewer leaves a ball more than `depth_bias` metres on: the same rule as
/// for a depth map ([`super::query_points`]), without pixels. Balls that hold the viewer are left out for that line of
/// sight, so that one wrong ball does not blind an observer; balls that hold the target are not.
pub struct MedialScene {
    index: RayIndex,
    /// Centre and radius in the order of the index.
    balls: Vec<([f32; 3], f32)>,
    profile: Profile,
    depth_bias: f64,
}

impl MedialScene {
    /// Indexes `balls`. Those that never shrank, or whose centre or radius is not finite, are left out.
    ///
    /// `profile` says which surface stands for a ball; the cone of the paper has its tip where the line of sight through the
    /// centre leaves the ball. `depth_bias`, metres, 0 or more, is how far a target may lie inside a ball, along its line of
    /// sight, and still count as visible.
    ///
    /// # Errors
    /// Only those of [`RayIndex::new`], which balls of finite size do not cause.
    pub fn new(balls: &MedialBalls, profile: Profile, depth_bias: f64) -> Result<Self> {
        let usable = |&i: &usize| {
            balls.touch[i] != NO_TOUCH
                && balls.radii[i].is_finite()
                && balls.radii[i] > 0.0
                && balls.centers[i].iter().all(|v| v.is_finite())
        };
        let rows: Vec<usize> = (0..balls.len()).filter(usable).collect();
        let boxes: Vec<[[f32; 3]; 2]> = rows
            .iter()
            .map(|&i| {
                let (center, radius) = (balls.centers[i], balls.radii[i]);
                // a step outward, since the sums are rounded
                [center.map(|c| (c - radius).next_down()), center.map(|c| (c + radius).next_up())]
            })
            .collect();
        let index = RayIndex::new(&boxes)?;
        let in_order = index.order().iter().map(|&row| {
            let i = rows[row as usize];
            (balls.centers[i], balls.radii[i])
        });
        let balls = in_order.collect();
        Ok(Self { index, balls, profile, depth_bias })
    }

    /// Whether any ball lies between a target and its viewer at `range` along the unit vector `towards`.
    fn blocked(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        let ray = Ray { origin: target, direction: towards, ranges: [self.depth_bias, range] };
        self.index.any(&ray, |row| {
            let Some(&(center, radius)) = self.balls.get(row) else { return false };
            let radius = f64::from(radius);
            let mut along = 0.0;
            let mut square = 0.0;
            for ((center, target), towards) in center.into_iter().zip(target).zip(towards) {
                let offset = f64::from(center) - target;
                along += offset * towards;
                square += offset * offset;
            }
            let beside = (square - along * along).max(0.0);
            if beside >= radius * radius {
                return false;
            }
            let front = along + (radius * radius - beside).sqrt();
            if front >= range {
                return false;
            }
            let front = match self.profile {
                Profile::Sphere => front,
                Profile::PaperCone => along + (radius - beside.sqrt()),
            };
            front > self.depth_bias
        })
    }
}

impl Visibility for MedialScene {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        viewer.validate()?;
        Ok(Box::new(move |targets| {
            viewer.validate_count(targets)?;
            let answer = |(index, &target): (usize, &[f32; 3])| match viewer.line_of_sight(index, target) {
                None => Answer::OutsideView,
                Some((towards, range)) if self.blocked(target.map(f64::from), towards, range) => Answer::Blocked,
                Some(_) => Answer::Visible,
            };
            Ok(targets.par_iter().enumerate().with_min_len(CHUNK).map(answer).collect())
        }))
    }
}
