//! The part of space that a cloud says something about.

use super::{Answer, Viewer};
use belvedere_data::Bounds;
use rayon::prelude::*;

/// Distance beside and below its points up to which a cloud counts as known, metres. Points of airborne surveys lie up
/// to a metre apart, so that the edge of a cloud is no sharper.
const MARGIN: f64 = 1.0;
/// Maximum height of a position above the highest point, metres. The air there is free, so that an aircraft or a drone
/// may look from it; a higher position is a mistake in the coordinates.
pub(super) const CEILING: f64 = 10_000.0;
/// Targets handed to a thread at once.
const CHUNK: usize = 4096;

/// The space over which a cloud has points: nothing is known of objects beside it, and nobody is below its lowest
/// point.
///
/// It is the box around the points, 1 m wider on all sides and below, and 10 km higher.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    bounds: Bounds,
}

impl Coverage {
    /// The coverage of points with these bounds; `None` for bounds without extent on the map, which say nothing.
    #[must_use]
    pub fn of(bounds: Bounds) -> Option<Self> {
        let [x, y, _] = bounds.size();
        (bounds.is_finite() && x.max(y) > 0.0).then_some(Self { bounds })
    }

    /// The box around the points.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns true if `position`, local metres, lies over the cloud in plan, at any height.
    #[must_use]
    pub fn holds_on_map(&self, position: [f64; 3]) -> bool {
        let (low, high) = self.bounds.corners();
        (0..2).all(|i| (low[i] - MARGIN..=high[i] + MARGIN).contains(&position[i]))
    }

    /// Returns true if `position`, local metres, lies over the cloud. False for one that is not finite.
    #[must_use]
    pub fn holds(&self, position: [f64; 3]) -> bool {
        let (low, high) = self.bounds.corners();
        self.holds_on_map(position) && (low[2] - MARGIN..=high[2] + CEILING).contains(&position[2])
    }

    /// Returns true if lines of sight may end at `position`, local metres: over the cloud, or up to 10 km beside it and
    /// above all of it. The space between the two is unknown and counts as free, as everything beside the cloud.
    #[must_use]
    pub fn holds_end(&self, position: [f64; 3]) -> bool {
        let (low, high) = self.bounds.corners();
        let is_near = (0..2).all(|i| (low[i] - CEILING..=high[i] + CEILING).contains(&position[i]));
        self.holds(position) || (is_near && (high[2]..=high[2] + CEILING).contains(&position[2]))
    }

    /// Returns true if the box between two corners, local metres, meets the space over the cloud.
    #[must_use]
    pub fn meets(&self, low: [f64; 3], high: [f64; 3]) -> bool {
        let (first, last) = self.bounds.corners();
        let room = [MARGIN, MARGIN, CEILING];
        (0..3).all(|i| low[i] <= last[i] + room[i] && high[i] >= first[i] - MARGIN)
    }

    /// Number of finite `positions`, (N, 3) local metres, at which no line of sight may end ([`Coverage::holds_end`]).
    #[must_use]
    pub fn outside_count(&self, positions: &[[f32; 3]]) -> usize {
        let is_off = |&&position: &&[f32; 3]| self.is_outside(position) && !self.holds_end(position.map(f64::from));
        positions.par_iter().with_min_len(CHUNK).filter(is_off).count()
    }

    /// Number of `positions`, (N, 3) local metres, in the air beside the cloud, at which lines of sight may end.
    #[must_use]
    pub fn beside_count(&self, positions: &[[f32; 3]]) -> usize {
        let is_beside = |&&position: &&[f32; 3]| self.is_outside(position) && self.holds_end(position.map(f64::from));
        positions.par_iter().with_min_len(CHUNK).filter(is_beside).count()
    }

    /// Returns true if a finite `position`, local metres, does not lie over the cloud.
    #[must_use]
    pub fn is_outside(&self, position: [f32; 3]) -> bool {
        position.iter().all(|v| v.is_finite()) && !self.holds(position.map(f64::from))
    }

    /// Makes the answers for `targets`, (M, 3) local metres, seen by `viewer`, [`Answer::OutsideCloud`] where no line
    /// of sight may end at the target or at its eye ([`Coverage::holds_end`]). Answers of targets that are not finite
    /// stay.
    pub fn mark_outside(&self, viewer: Viewer<'_>, targets: &[[f32; 3]], answers: &mut [Answer]) {
        let is_off = |end: [f32; 3]| end.iter().all(|v| v.is_finite()) && !self.holds_end(end.map(f64::from));
        let is_eye_outside = |row: usize| match viewer {
            Viewer::Direction(_) => false,
            Viewer::Eye(eye) => !self.holds_end(eye),
            Viewer::Each(eyes) => eyes.get(row).is_some_and(|&eye| is_off(eye)),
        };
        let pairs = answers.par_iter_mut().zip(targets).enumerate().with_min_len(CHUNK);
        pairs.for_each(|(row, (answer, &target))| {
            let is_finite = target.iter().all(|v| v.is_finite());
            if is_finite && (is_eye_outside(row) || is_off(target)) {
                *answer = Answer::OutsideCloud;
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloud_covers_the_air_above_it_and_nothing_beside_or_below_it() {
        let coverage = Coverage::of(Bounds { low: [0.0, 0.0, -2.0], high: [100.0, 50.0, 30.0] }).unwrap();
        for inside in [[0.0, 0.0, -2.0], [-0.9, 50.9, 0.0], [50.0, 25.0, 130.0], [50.0, 25.0, 9_000.0]] {
            assert!(coverage.holds(inside), "{inside:?}");
        }
        for outside in
            [[3_100.0, 25.0, 10.0], [50.0, -1.1, 10.0], [50.0, 25.0, -3.1], [50.0, 25.0, 1e30], [f64::NAN; 3]]
        {
            assert!(!coverage.holds(outside), "{outside:?}");
            assert!(!coverage.holds_end(outside), "{outside:?}");
        }
        // a drone beside the cloud, and one whose coordinates are a mistake
        let beside = [600.0, 25.0, 530.0];
        assert!(!coverage.holds(beside) && coverage.holds_end(beside));
        assert!(!coverage.holds_end([600_000.0, 25.0, 530.0]) && !coverage.holds_end([600.0, 25.0, 29.0]));
        assert_eq!(Coverage::of(Bounds::default()), None);
    }

    #[test]
    fn a_line_of_sight_has_an_answer_only_if_both_of_its_ends_lie_over_the_cloud() {
        use Answer::{Blocked, OutsideCloud, OutsideView, Unproven, Visible};
        let coverage = Coverage::of(Bounds { low: [0.0; 3], high: [10.0; 3] }).unwrap();
        let targets = [[5.0; 3], [5.0, 5.0, -9.0], [f32::NAN; 3], [90.0, 5.0, 5.0]];
        let marked = |viewer| {
            let mut answers = [Visible, Blocked, OutsideView, Unproven];
            coverage.mark_outside(viewer, &targets, &mut answers);
            answers
        };
        assert_eq!(marked(Viewer::Direction([0.0, 0.0, 1.0])), [Visible, OutsideCloud, OutsideView, OutsideCloud]);
        assert_eq!(marked(Viewer::Eye([1.0, 1.0, 300.0])), [Visible, OutsideCloud, OutsideView, OutsideCloud]);
        assert_eq!(marked(Viewer::Eye([99.0, 1.0, 300.0]))[0], Visible);
        assert_eq!(marked(Viewer::Eye([99.0, 1.0, 3.0])), [OutsideCloud, OutsideCloud, OutsideView, OutsideCloud]);
        let eyes = [[99.0, 5.0, 5.0], [5.0; 3], [5.0; 3], [5.0; 3]];
        assert_eq!(marked(Viewer::Each(&eyes))[0], OutsideCloud);
        assert_eq!((coverage.outside_count(&targets), coverage.beside_count(&targets)), (2, 0));
        // in the air above all of the cloud, a target has an answer
        let high = [[90.0, 5.0, 50.0], [5.0, 5.0, 50.0], [90.0, 5.0, 5.0], [f32::NAN; 3]];
        assert_eq!((coverage.outside_count(&high), coverage.beside_count(&high)), (1, 1));
    }
}
