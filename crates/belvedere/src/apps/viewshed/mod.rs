//! Viewsheds: what one or many observers see of cells or points, from where a target is seen, and how high a thing must stand.

mod observers;

pub use observers::{Observer, SightLimits, places_along};

use crate::ground::Ground;
use crate::progress::Progress;
use crate::query::{Answer, EarthParams, MedialScene, UnprovenAs};
use crate::raster::Raster;
use crate::{Error, Result};
use rayon::prelude::*;

/// Targets handed to a thread at once.
const CHUNK: usize = 512;

/// How viewsheds are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewshedParams {
    /// How lines of sight run over the earth.
    pub earth: EarthParams,
    /// What to make of targets that nothing blocks but whose view is not proven. Default: reported.
    pub unproven: UnprovenAs,
    /// Whether to keep which observer sees which target. Default: counts only.
    pub masks: Masks,
}

impl Default for ViewshedParams {
    fn default() -> Self {
        Self { earth: EarthParams::default(), unproven: UnprovenAs::Reported, masks: Masks::NotKept }
    }
}

/// Whether it is kept which observer sees which target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Masks {
    /// One bit for each observer and target.
    Kept,
    /// Counts only.
    #[default]
    NotKept,
}

/// What observers see of targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewshed {
    /// The best of the observers' answers for each target: visible before unproven before blocked; [`Answer::OutsideView`] for what
    /// none of them is turned to, (M).
    pub answers: Vec<Answer>,
    /// How many observers see each target, (M).
    pub counts: Vec<u32>,
    /// Bands of 32 observers: bit i of band b tells whether observer 32 · b + i sees each target, (bands, M); empty where masks are not
    /// kept.
    pub masks: Vec<Vec<u32>>,
    /// Number of targets that each observer sees, (N).
    pub seen_counts: Vec<usize>,
}

/// Default height of an observer's eye above the ground, metres: a person's.
pub const OBSERVER_HEIGHT: f64 = 1.7;
/// Default height of targets above the ground, metres.
pub const TARGET_HEIGHT: f64 = 0.0;
/// Default side of a cell, metres: what points of usual airborne surveys (0.3 to 0.5 m apart) can tell.
pub const CELL: f64 = 0.5;

/// Most cells of a default grid.
const USUAL_CELLS: f64 = 4e6;

/// The side of the cells of a default grid over the box on the map from `low` to `high`, metres: [`CELL`], doubled until there are at
/// most 4 million cells.
#[must_use]
pub fn cell_for(low: [f64; 2], high: [f64; 2]) -> f64 {
    let area = (high[0] - low[0]).max(0.0) * (high[1] - low[1]).max(0.0);
    let mut cell = CELL;
    while area / (cell * cell) > USUAL_CELLS && cell < 1e9 {
        cell *= 2.0;
    }
    cell
}

/// A target in the middle of each cell of `ground`, `height` metres above it, (M, 3) local metres, rows from the north; NaN where no
/// ground is known.
#[must_use]
pub fn cell_targets(ground: &Ground, height: f64) -> Vec<[f32; 3]> {
    let grid = ground.grid;
    let target = |(cell, &ground): (usize, &f32)| {
        let [x, y] = grid.center(cell % grid.width.max(1), cell / grid.width.max(1));
        #[expect(clippy::cast_possible_truncation, reason = "local positions are f32")]
        let target = [x as f32, y as f32, (f64::from(ground) + height) as f32];
        target
    };
    ground.heights.values().par_iter().enumerate().with_min_len(CHUNK).map(target).collect()
}

/// What one observer sees of `targets`, (M, 3) local metres: the one place where the targets of an eye are answered. Targets that the
/// observer is not turned to, that are not finite or lie in the eye are [`Answer::OutsideView`].
#[must_use]
pub fn seen_by(scene: &MedialScene, observer: &Observer, targets: &[[f32; 3]], earth: &EarthParams) -> Vec<Answer> {
    let answer = |target: &[f32; 3]| {
        let target = target.map(f64::from);
        if !observer.limits.allow(observer.eye, target) {
            return Answer::OutsideView;
        }
        scene.sight_answer(observer.eye, target, earth)
    };
    targets.par_iter().with_min_len(CHUNK).map(answer).collect()
}

/// What `observers` see of `targets`, (M, 3) local metres; progress counts observers.
///
/// A reverse viewshed, from where a target is seen, is the viewshed of an observer in its place, of the eyes that might see it: a
/// line of sight is the same both ways. Balls that hold the target are then left out, and those at the eyes give way.
///
/// # Errors
/// [`Error::InvalidParameter`] for an eye that is not finite and for parameters outside their range.
pub fn viewshed(
    scene: &MedialScene,
    observers: &[Observer],
    targets: &[[f32; 3]],
    params: &ViewshedParams,
    progress: Progress<'_>,
) -> Result<Viewshed> {
    check(observers, &params.earth)?;
    let bands = if params.masks == Masks::Kept { observers.len().div_ceil(32) } else { 0 };
    let mut result = Viewshed {
        answers: vec![Answer::OutsideView; targets.len()],
        counts: vec![0; targets.len()],
        masks: vec![vec![0; targets.len()]; bands],
        seen_counts: Vec::with_capacity(observers.len()),
    };
    for (number, observer) in observers.iter().enumerate() {
        let answers: Vec<Answer> = seen_by(scene, observer, targets, &params.earth)
            .into_iter()
            .map(|answer| params.unproven.settle(answer))
            .collect();
        for ((best, count), &answer) in result.answers.iter_mut().zip(&mut result.counts).zip(&answers) {
            if worth(answer) > worth(*best) {
                *best = answer;
            }
            *count += u32::from(answer == Answer::Visible);
        }
        if let Some(band) = result.masks.get_mut(number / 32) {
            for (bits, _) in band.iter_mut().zip(&answers).filter(|(_, answer)| **answer == Answer::Visible) {
                *bits |= 1 << (number % 32);
            }
        }
        result.seen_counts.push(answers.iter().filter(|answer| **answer == Answer::Visible).count());
        progress.advance(1);
    }
    Ok(result)
}

/// How high above the ground a thing must reach in each cell for its top to be seen by one of the observers, metres: 0 where the
/// ground is seen, +∞ where nothing up to `ceiling` metres is, NaN where no ground is known or no observer is turned to the
/// cell. At most 2 mm above the exact figure for the balls; pulses are not asked. Limits of elevation are asked of the ground.
///
/// # Errors
/// As [`viewshed`], and for a ceiling below zero.
pub fn least_visible_heights(
    scene: &MedialScene,
    observers: &[Observer],
    ground: &Ground,
    ceiling: f64,
    earth: &EarthParams,
    progress: Progress<'_>,
) -> Result<Raster<f32>> {
    check(observers, earth)?;
    if !(ceiling >= 0.0) {
        return Err(Error::InvalidParameter {
            name: "greatest height to look at",
            value: ceiling.to_string(),
            expected: "0 metres or more",
        });
    }
    let feet = cell_targets(ground, 0.0);
    let mut heights = Raster::filled(ground.grid.width, ground.grid.height, f32::NAN);
    for observer in observers {
        heights.values_mut().par_iter_mut().with_min_len(CHUNK).zip(&feet).for_each(|(height, foot)| {
            let foot = foot.map(f64::from);
            if !observer.limits.allow(observer.eye, foot) {
                return;
            }
            // another observer sees it lower already, or nobody looked yet
            let bound = if height.is_finite() { f64::from(*height) } else { ceiling };
            let seen = scene.least_visible_height(observer.eye, foot, bound, earth);
            #[expect(clippy::cast_possible_truncation, reason = "metres above the ground")]
            let seen = seen.map_or(f32::INFINITY, |seen| seen as f32);
            if !(*height <= seen) {
                *height = seen;
            }
        });
        progress.advance(1);
    }
    Ok(heights)
}

fn check(observers: &[Observer], earth: &EarthParams) -> Result<()> {
    earth.validate()?;
    for observer in observers {
        observer.limits.validate()?;
        if !observer.eye.iter().all(|v| v.is_finite()) {
            let value = format!("{:?}", observer.eye);
            return Err(Error::InvalidParameter { name: "eye of an observer", value, expected: "finite" });
        }
    }
    Ok(())
}

fn worth(answer: Answer) -> u8 {
    match answer {
        Answer::OutsideView => 0,
        Answer::Blocked => 1,
        Answer::Unproven => 2,
        Answer::Visible => 3,
    }
}
