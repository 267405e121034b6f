//! Viewsheds: cells or points that one or many observers see, places from where a target is seen, and the height at
//! which an object becomes visible.

mod far;
mod measures;
mod observers;
mod probabilities;

pub use far::{far_targets, far_viewshed, terrain_within_reach};
pub use measures::seen_words;
pub use observers::{Observer, SightLimits, places_along};
pub use probabilities::{SeenProbabilities, add_known, seen_probabilities};

use crate::targets::Measure;
use belvedere_core::ground::Ground;
use belvedere_core::query::target_tree::TargetTree;
use belvedere_core::query::{Answer, EarthParams, MedialScene, UnprovenAs, Viewer};
use belvedere_data::cast::to_row;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::raster::Raster;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Targets handed to a thread at once.
const CHUNK: usize = 512;

/// Parameters of viewsheds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ViewshedParams {
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Treatment of unproven targets that nothing blocks. Default: reported.
    pub unproven: UnprovenAs,
    /// Choice to keep a mask of the targets of each observer. Default: counts only.
    pub masks: Masks,
}

belvedere_data::setters!(ViewshedParams {
    with_earth(earth: EarthParams),
    with_unproven(unproven: UnprovenAs),
    with_masks(masks: Masks),
});

impl Default for ViewshedParams {
    fn default() -> Self {
        Self { earth: EarthParams::default(), unproven: UnprovenAs::Reported, masks: Masks::NotKept }
    }
}

/// Choice to keep a mask of the targets of each observer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Masks {
    /// One bit for each observer and target.
    Kept,
    /// Counts only.
    #[default]
    NotKept,
}

/// Targets that observers see.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewshed {
    /// The best of the observers' answers for each target: visible before unproven before blocked;
    /// [`Answer::OutsideView`] for targets outside the limits of all of them, (M).
    pub answers: Vec<Answer>,
    /// Number of observers that see each target, (M).
    pub counts: Vec<u32>,
    /// Number of further observers with an unproven line of sight to each target that nothing blocks, (M); empty if
    /// proof is not tested.
    pub unproven_counts: Vec<u32>,
    /// Bands of 32 observers: bit i of band b tells whether observer 32 · b + i sees each target, (bands, M); empty
    /// where masks are not kept.
    pub masks: Vec<Vec<u32>>,
    /// Number of targets that each observer sees, (N).
    pub seen_counts: Vec<usize>,
}

/// Default height of an observer's eye above the ground, metres: a person's.
pub const OBSERVER_HEIGHT: f64 = 1.7;
/// Height above the ground at which targets on it are tested, metres. The height of the ground is accurate to a few
/// centimetres, and balls bulge by as much between its points. Over tens of metres a line of sight at the ground itself
/// would run in and out of them. On simulated towns 0.05 halves the false-blocked cells (6.9 to 3.7 %); 0.1 gains no
/// more and sees more of the hidden cells.
pub const GROUND_TOLERANCE: f64 = 0.05;

/// The height above the ground at which a target of `height` metres is tested: no lower than [`GROUND_TOLERANCE`].
#[must_use]
pub fn tested_height(height: f64) -> f64 {
    height.max(GROUND_TOLERANCE)
}

/// Description of a raster of the cells that one observer sees.
pub const SEEN: &str = "1 nothing blocks it, 0 blocked, 255 nodata";
/// Description of a raster of several observers.
pub const SEEN_BY: &str = "number of observers from which nothing blocks the cell, 65535 nodata";

/// Title of a map of the cells that one or several observers see, or of cells from which a target is seen.
#[must_use]
pub fn title_of_cells(is_of_one: bool, is_reverse: bool) -> &'static str {
    match (is_reverse, is_of_one) {
        (true, _) => "Cells from which the target is visible",
        (false, true) => "Visible from the observer",
        (false, false) => "Number of observers that see the cell",
    }
}

/// The best answers of observers, from bands of how many see each cell past all that blocks, NaN for no target, and of
/// how many of these no pulse proves.
#[must_use]
pub fn answers_of_bands(bands: &[Measure]) -> Vec<Answer> {
    let Some((free, rest)) = bands.split_first() else { return Vec::new() };
    let unproven = rest.first();
    let answer = |(cell, &free): (usize, &f32)| {
        let unproven = unproven.and_then(|band| band.values.get(cell)).copied().unwrap_or(0.0);
        match free {
            free if free.is_nan() => Answer::OutsideView,
            0.0 => Answer::Blocked,
            free if free > unproven => Answer::Visible,
            _ => Answer::Unproven,
        }
    };
    free.values.iter().enumerate().map(answer).collect()
}

/// Default side of a cell, metres: the resolution of points of usual airborne surveys (0.3 to 0.5 m apart).
pub const CELL: f64 = 0.5;

/// Maximum number of cells of a default grid.
const USUAL_CELLS: f64 = 4e6;

/// The side of the cells of a default grid over the box on the map from `low` to `high`, metres: [`CELL`], doubled
/// until there are at most 4 million cells.
#[must_use]
pub fn cell_for(low: [f64; 2], high: [f64; 2]) -> f64 {
    let area = (high[0] - low[0]).max(0.0) * (high[1] - low[1]).max(0.0);
    let mut cell = CELL;
    while area / (cell * cell) > USUAL_CELLS && cell < 1e9 {
        cell *= 2.0;
    }
    cell
}

/// The part of a box on the map, `low` and `high` corner, that is within reach, metres, of any of the places, local
/// metres; the whole box where none is.
#[must_use]
pub fn box_within_reach(
    (low, high): ([f64; 2], [f64; 2]),
    places: impl IntoIterator<Item = ([f64; 2], f64)>,
) -> ([f64; 2], [f64; 2]) {
    let (mut from, mut to) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (place, reach) in places {
        for axis in 0..2 {
            from[axis] = from[axis].min(place[axis] - reach);
            to[axis] = to[axis].max(place[axis] + reach);
        }
    }
    let within = ([0, 1].map(|i| low[i].max(from[i])), [0, 1].map(|i| high[i].min(to[i])));
    let is_some = (0..2).all(|i| within.0[i] <= within.1[i]);
    if is_some { within } else { (low, high) }
}

/// A target in the middle of each cell of `ground`, `height` metres above it, (M, 3) local metres, rows from the north;
/// NaN where no ground is known.
#[must_use]
pub fn cell_targets(ground: &Ground, height: f64) -> Vec<[f32; 3]> {
    let grid = ground.grid;
    let target = |(cell, &ground): (usize, &f32)| {
        let [x, y] = grid.center(cell % grid.width.max(1), cell / grid.width.max(1));
        [to_f32(x), to_f32(y), to_f32(f64::from(ground) + height)]
    };
    ground.heights.values().par_iter().enumerate().with_min_len(CHUNK).map(target).collect()
}

/// Computes which of `targets`, (M, 3) local metres, `observers` see; control counts observers. An observer whose eye
/// is not finite ([`crate::eyes::skip_unfit_eyes`]) sees nothing and keeps its number. Observers may stand on far
/// terrain ([`MedialScene::is_on_far_terrain`]); for targets there, see [`far_viewshed`].
///
/// A reverse viewshed finds the eyes that might see a target. It is the viewshed of an observer in the place of the
/// target, since a line of sight is the same both ways. Balls that hold the target are then left out, and those at the
/// eyes give way.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range, and [`Error::Cancelled`].
pub fn viewshed(
    scene: &MedialScene,
    observers: &[Observer],
    targets: &[[f32; 3]],
    params: &ViewshedParams,
    control: &Control<'_>,
) -> Result<Viewshed> {
    viewshed_among(scene, observers, targets, &TargetTree::new(targets), params, control)
}

/// The viewshed of targets that are ordered in a tree already, which saves most of the time where the same targets are
/// queried again and again.
///
/// # Errors
/// Those of [`viewshed`], and [`Error::LengthMismatch`] for a tree of other targets.
pub fn viewshed_among(
    scene: &MedialScene,
    observers: &[Observer],
    targets: &[[f32; 3]],
    tree: &TargetTree,
    params: &ViewshedParams,
    control: &Control<'_>,
) -> Result<Viewshed> {
    check(observers, &params.earth)?;
    check_length("tree of targets", targets.len(), tree.len())?;
    let queried = ViewshedTree { scene, tree, targets, params };
    let mut result = Viewshed {
        answers: queried.before_anybody_sees(observers),
        counts: vec![0; targets.len()],
        unproven_counts: if tests_proof(scene, params) { vec![0; targets.len()] } else { Vec::new() },
        masks: Vec::new(),
        seen_counts: Vec::with_capacity(observers.len()),
    };
    // few observers share the threads, each of many has one to itself; as many bands at once as there are threads bound
    // the memory, and more of small ones leave no thread waiting
    let threads = rayon::current_num_threads();
    let at_once = if targets.len() <= SMALL { 4 * threads } else { threads };
    let (threading, at_once) =
        if observers.len() < 2 * threads { (Threading::Shared, 1) } else { (Threading::OneEach, at_once) };
    let bands: Vec<&[Observer]> = observers.chunks(BAND).collect();
    for round in bands.chunks(at_once) {
        let seen: Result<Vec<ObserverBand>> =
            round.par_iter().map(|band| queried.band(band, threading, control)).collect();
        for band in seen? {
            add(&mut result, band, params.masks);
        }
    }
    Ok(result)
}

/// Returns true if unproven lines of sight have an answer of their own.
fn tests_proof(scene: &MedialScene, params: &ViewshedParams) -> bool {
    params.unproven == UnprovenAs::Reported && scene.proof().is_some()
}

/// Targets of which a band takes little memory: 4 MB.
const SMALL: usize = 1_000_000;
/// Observers of a band of masks.
const BAND: usize = 32;

/// Targets in a tree, and the parameters of their queries.
struct ViewshedTree<'a> {
    scene: &'a MedialScene,
    tree: &'a TargetTree,
    targets: &'a [[f32; 3]],
    params: &'a ViewshedParams,
}

/// Use of threads: shared by all observers, or one each.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Threading {
    /// All threads work for one observer.
    Shared,
    /// An observer is one thread's.
    OneEach,
}

/// Targets that up to 32 observers see.
struct ObserverBand {
    /// Bit i: observer i sees the target, (M).
    seen: Vec<u32>,
    /// Rows of targets that one of them sees without proof, once for each that does.
    unproven: Vec<u32>,
    seen_counts: Vec<usize>,
}

impl ViewshedTree<'_> {
    /// Blocked for targets within the limits of an observer, otherwise outside the view; outside the cloud for targets
    /// there.
    fn before_anybody_sees(&self, observers: &[Observer]) -> Vec<Answer> {
        let lookers: Vec<&Observer> =
            observers.iter().filter(|observer| !self.scene.is_outside(observer.eye)).collect();
        let is_looked_at = |&target: &[f32; 3]| {
            let target = target.map(f64::from);
            lookers.iter().any(|observer| observer.eye != target && observer.limits.allow(observer.eye, target))
        };
        let answer = |target: &[f32; 3]| match is_looked_at(target) {
            true if self.scene.is_outside_cloud(target.map(f64::from)) => Answer::OutsideCloud,
            true => Answer::Blocked,
            false => Answer::OutsideView,
        };
        self.targets.par_iter().with_min_len(CHUNK).map(answer).collect()
    }

    fn band(&self, observers: &[Observer], threading: Threading, control: &Control<'_>) -> Result<ObserverBand> {
        let (mut seen, mut unproven) = (vec![0; self.targets.len()], Vec::new());
        let mut seen_counts = vec![0; observers.len()];
        let mut note = |number: usize, row: usize, answer: Answer| match self.params.unproven.settle(answer) {
            Answer::Visible => {
                seen[row] |= 1 << number;
                seen_counts[number] += 1;
            }
            Answer::Unproven => unproven.push(to_row(row)),
            _ => {}
        };
        let can_look = |observer: &Observer| observer.eye.iter().all(|v| v.is_finite());
        let is_single = |observer: &Observer| can_look(observer) && self.needs_single_lines(observer);
        if threading == Threading::Shared || observers.iter().any(is_single) {
            for (number, observer) in observers.iter().enumerate() {
                control.check()?;
                if can_look(observer) {
                    let answers = self.seen_by(observer, control)?;
                    answers.into_iter().enumerate().for_each(|(row, answer)| note(number, row, answer));
                }
                control.advance(1);
            }
        } else {
            let eyes: Vec<[f64; 3]> = observers.iter().map(|observer| observer.eye).collect();
            let visit = |number: usize, place: usize| {
                let (observer, target) = (&observers[number], self.tree.positions()[place].map(f64::from));
                if observer.limits.allow(observer.eye, target) {
                    let answer = match self.params.unproven {
                        UnprovenAs::Visible => Answer::Visible,
                        _ => self.scene.answer_unblocked_from(observer.eye, target),
                    };
                    note(number, self.tree.rows()[place] as usize, answer);
                }
            };
            self.scene.visible_among_each(&eyes, self.tree, control, visit, |_| control.advance(1))?;
        }
        Ok(ObserverBand { seen, unproven, seen_counts })
    }

    /// Returns true if any line of sight of an observer is curved, or crosses far terrain.
    fn needs_single_lines(&self, observer: &Observer) -> bool {
        self.scene.is_on_far_terrain(observer.eye)
            || self.tree.any_corner(|corner| self.params.earth.bends(corner, observer.eye))
    }

    /// Returns the answers of one observer, with all threads at work, (M); blocked where the observer does not look.
    fn seen_by(&self, observer: &Observer, control: &Control<'_>) -> Result<Vec<Answer>> {
        let allowed = |target: [f32; 3]| observer.limits.allow(observer.eye, target.map(f64::from));
        if !self.needs_single_lines(observer) {
            let mut answers = self.scene.answer_among(Viewer::Eye(observer.eye), self.tree, control)?;
            let targets = self.targets.par_iter().with_min_len(CHUNK);
            answers.par_iter_mut().zip(targets).filter(|(_, target)| !allowed(**target)).for_each(|(answer, _)| {
                *answer = Answer::Blocked;
            });
            return Ok(answers);
        }
        let answer = |&target: &[f32; 3]| {
            if !allowed(target) {
                return Answer::Blocked;
            }
            let target = target.map(f64::from);
            match self.scene.is_outside_cloud(target) {
                true => Answer::OutsideCloud,
                false => self.scene.sight_answer(observer.eye, target, &self.params.earth),
            }
        };
        let chunks = self.targets.par_chunks(CHUNK).map(|targets| {
            control.check()?;
            Ok(targets.iter().map(answer).collect::<Vec<Answer>>())
        });
        Ok(chunks.collect::<Result<Vec<_>>>()?.concat())
    }
}

/// Adds the cells that a band sees.
fn add(result: &mut Viewshed, band: ObserverBand, masks: Masks) {
    for row in band.unproven {
        let answer = &mut result.answers[row as usize];
        if *answer != Answer::Visible {
            *answer = Answer::Unproven;
        }
        if let Some(count) = result.unproven_counts.get_mut(row as usize) {
            *count += 1;
        }
    }
    let targets = result.answers.par_iter_mut().zip(&mut result.counts).zip(&band.seen).with_min_len(CHUNK);
    targets.filter(|(_, bits)| **bits != 0).for_each(|((answer, count), bits)| {
        *answer = Answer::Visible;
        *count += bits.count_ones();
    });
    result.seen_counts.extend(band.seen_counts);
    if masks == Masks::Kept {
        result.masks.push(band.seen);
    }
}

/// Computes the minimum height above the ground, metres, at which an object in each cell is visible to one of the
/// observers. It is 0 where the ground is visible, and +∞ where nothing up to `ceiling` metres is. It is NaN where no
/// ground is known or no observer is turned to the cell. The result exceeds the exact figure for the balls by at most 2
/// mm, and is 0 where targets on the ground are visible ([`GROUND_TOLERANCE`]); pulses are not used. Limits of
/// elevation are those of the ground.
///
/// # Errors
/// As [`viewshed`], and for a ceiling below zero, and for an observer on far terrain: the terrain before it is not
/// tested here.
pub fn min_visible_heights(
    scene: &MedialScene,
    observers: &[Observer],
    ground: &Ground,
    ceiling: f64,
    earth: &EarthParams,
    control: &Control<'_>,
) -> Result<Raster<f32>> {
    check(observers, earth)?;
    if !(ceiling >= 0.0) {
        return Err(Error::invalid(Parameter::MaxHeight, ceiling, "0 metres or more"));
    }
    if let Some(row) = observers.iter().position(|observer| scene.is_on_far_terrain(observer.eye)) {
        return Err(Error::invalid(
            Parameter::Observer,
            format!("number {}, on the terrain beyond the cloud", row + 1),
            "observers in the cloud",
        ));
    }
    let feet = cell_targets(ground, 0.0);
    let mut heights = Raster::filled(ground.grid.width, ground.grid.height, f32::NAN);
    for observer in observers {
        let lower = |(height, foot): (&mut f32, &[f32; 3])| {
            let foot = foot.map(f64::from);
            if !observer.limits.allow(observer.eye, foot) {
                return;
            }
            // another observer sees it lower already, or nobody looked yet
            let bound = if height.is_finite() { f64::from(*height) } else { ceiling };
            // from where targets on the ground are tested, so that 0 is what a viewshed calls visible
            let lowest = [foot[0], foot[1], foot[2] + GROUND_TOLERANCE];
            let seen = scene.min_visible_height(observer.eye, lowest, (bound - GROUND_TOLERANCE).max(0.0), earth);
            let seen = seen.map(|above| if above > 0.0 { above + GROUND_TOLERANCE } else { 0.0 });
            let seen = seen.map_or(f32::INFINITY, to_f32);
            if !(*height <= seen) {
                *height = seen;
            }
        };
        heights.values_mut().par_chunks_mut(CHUNK).zip(feet.par_chunks(CHUNK)).try_for_each(|(heights, feet)| {
            control.check()?;
            heights.iter_mut().zip(feet).for_each(lower);
            Ok(())
        })?;
        control.advance(1);
    }
    Ok(heights)
}

fn check(observers: &[Observer], earth: &EarthParams) -> Result<()> {
    earth.validate()?;
    for observer in observers {
        observer.limits.validate()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_cut_to_what_is_within_reach_of_anybody() {
        let whole = ([0.0, 0.0], [100.0, 50.0]);
        assert_eq!(box_within_reach(whole, [([20.0, 20.0], 10.0), ([40.0, 30.0], 5.0)]), ([10.0, 10.0], [45.0, 35.0]));
        assert_eq!(box_within_reach(whole, [([20.0, 20.0], f64::INFINITY)]), whole);
        // no observer is near: the whole box remains
        assert_eq!(box_within_reach(whole, [([500.0, 20.0], 10.0)]), whole);
        assert_eq!(box_within_reach(whole, []), whole);
    }
}
