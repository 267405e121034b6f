//! Point targets against a depth map: constant time each.

use crate::blocking::Profile;
use crate::depth::DepthMap;
use belvedere_data::cast::to_index;
use belvedere_data::random;
use belvedere_data::vector::to_f32;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Visibility of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[repr(u8)]
pub enum Answer {
    /// A ball lies before it.
    Blocked = 0,
    /// Visible: nothing lies before it.
    Visible = 1,
    /// Unproven: nothing lies before it, but too much of the line of sight runs through space that no pulse came near
    /// to.
    Unproven = 2,
    /// It lies beside the picture or behind its plane, or its position is not finite: the view says nothing of it.
    OutsideView = 3,
    /// The target or its eye lies beside or below the cloud, of which nothing is known ([`super::Coverage`]).
    OutsideCloud = 4,
    /// The target or its eye lies inside an obstacle, deeper than balls give way
    /// ([`super::MedialScene::is_inside_obstacle`]): nothing is seen from there, and nothing there is seen.
    InsideObstacle = 5,
}

/// Treatment of [`Answer::Unproven`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum UnprovenAs {
    /// An answer of its own.
    Reported,
    /// [`Answer::Visible`].
    Visible,
    /// [`Answer::Blocked`].
    Blocked,
}

impl UnprovenAs {
    /// `answer`, or its replacement if it is [`Answer::Unproven`].
    #[must_use]
    pub fn settle(self, answer: Answer) -> Answer {
        match (answer, self) {
            (Answer::Unproven, Self::Visible) => Answer::Visible,
            (Answer::Unproven, Self::Blocked) => Answer::Blocked,
            _ => answer,
        }
    }
}

/// Number of targets for each answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AnswerCounts {
    /// [`Answer::Visible`].
    pub visible: usize,
    /// [`Answer::Blocked`].
    pub blocked: usize,
    /// [`Answer::Unproven`].
    pub unproven: usize,
    /// [`Answer::OutsideView`].
    pub outside_view: usize,
    /// [`Answer::OutsideCloud`].
    pub outside_cloud: usize,
    /// [`Answer::InsideObstacle`].
    pub inside_obstacle: usize,
}

impl AnswerCounts {
    /// Counts `answers`.
    #[must_use]
    pub fn of(answers: &[Answer]) -> Self {
        let count = |answer| answers.iter().filter(|&&a| a == answer).count();
        Self {
            visible: count(Answer::Visible),
            blocked: count(Answer::Blocked),
            unproven: count(Answer::Unproven),
            outside_view: count(Answer::OutsideView),
            outside_cloud: count(Answer::OutsideCloud),
            inside_obstacle: count(Answer::InsideObstacle),
        }
    }
}

/// Targets handed to a thread at once.
const CHUNK: usize = 16_384;

/// The answer for each of `targets`, (M, 3) local metres, in the same order.
///
/// A target is visible if it lies nearer than the depth of its pixel plus `depth_bias` metres; see
/// [`DepthMap::default_depth_bias`].
///
/// # Source
/// Peters, Ledoux & Biljecki 2015, section 3.3 and Algorithm 2 (`QUERYPOINT`); Williams 1978. The bias is not in the
/// paper.
#[must_use]
pub fn query_points(map: &DepthMap, targets: &[[f32; 3]], depth_bias: f32) -> Vec<Answer> {
    let [near, far] = map.view.limits().map(to_f32);
    // the paper's picture plane has no behind
    let min_depth = match map.profile {
        Profile::Sphere => near,
        Profile::PaperCone => f32::NEG_INFINITY,
    };
    targets
        .par_iter()
        .with_min_len(CHUNK)
        .map(|&target| {
            let Some([x, y, z]) = map.view.project(target) else { return Answer::OutsideView };
            let z = to_f32(z);
            // beside the picture or beyond its limits, or not a number
            if !(x >= 0.0 && y >= 0.0 && z + depth_bias >= min_depth && z <= far) {
                return Answer::OutsideView;
            }
            match map.depth.get(to_index(x), to_index(y)) {
                None => Answer::OutsideView,
                Some(depth) if z < depth + depth_bias => Answer::Visible,
                Some(_) => Answer::Blocked,
            }
        })
        .collect()
}

/// Maximum number of random targets of one run, which needs some 100 bytes for each. More come from runs with other
/// seeds.
pub const MAX_RANDOM_TARGETS: usize = 50_000_000;
/// Maximum number of random pairs of one run, which needs some 400 bytes for each.
pub const MAX_RANDOM_PAIRS: usize = 10_000_000;

/// `count` positions spread evenly at random over the local box from `low` to `high`: the paper's experiment. The same
/// seed gives the same positions for any number of threads.
#[must_use]
pub fn random_targets(low: [f32; 3], high: [f32; 3], count: usize, seed: u64) -> Vec<[f32; 3]> {
    (0..count)
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|i| {
            std::array::from_fn(|axis| {
                let share = random::uniform(seed, 3 * i as u64 + axis as u64);
                let (low, high) = (f64::from(low[axis]), f64::from(high[axis]));
                to_f32(low + share * (high - low))
            })
        })
        .collect()
}
