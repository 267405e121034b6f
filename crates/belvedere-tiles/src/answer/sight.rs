//! Visibility of the cells of a tile from observers, past one part of the obstacles after the other.

use crate::answer::lines::AreaLines;
use crate::answer::obstacles::{ObstacleSearch, rule};
use crate::answer::parts::TileObstacles;
use crate::answer::proof::{Line, unproven};
use crate::answer::surroundings::TileSurroundings;
use belvedere::Result;
use belvedere::apps::ask::survey_parts::Looks;
use belvedere::apps::eyes::skip_unfit_eyes;
use belvedere::apps::viewshed::{Masks, Observer, Viewshed, ViewshedParams, viewshed};
use belvedere::cast::to_row;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, MedialScene, UnprovenAs};
use belvedere::vector::{dot, sub};
use rayon::prelude::*;

/// Number of targets that a thread takes at once.
const CHUNK: usize = 1024;

/// Visibility of targets from observers, past one part of the obstacles after the other.
pub(crate) struct PartialSight<'a> {
    /// Observers. The eye of an observer inside an obstacle is not finite, except in a reverse viewshed.
    observers: Vec<Observer>,
    is_reverse: bool,
    targets: &'a [[f32; 3]],
    params: ViewshedParams,
    /// Visibility past all parts so far; `None` before the first part.
    seen: Option<Viewshed>,
}

impl<'a> PartialSight<'a> {
    pub(crate) fn new(looks: &Looks<'_>, targets: &'a [[f32; 3]], params: ViewshedParams) -> Self {
        let params = params.with_masks(Masks::Kept);
        Self { observers: looks.observers.to_vec(), is_reverse: looks.is_reverse, targets, params, seen: None }
    }

    /// Removes the targets that any of `parts` blocks, or a planned object.
    ///
    /// # Errors
    /// Those of reading balls, and [`belvedere::Error::Cancelled`].
    pub(crate) fn look_past(
        &mut self,
        parts: &TileObstacles,
        lines: &AreaLines<'_>,
        control: &Control<'_>,
    ) -> Result<()> {
        let TileSurroundings { plan, others, .. } = &*parts.tile;
        if !lines.is_empty() {
            parts.each_scene(lines, control, |scene, _| self.look(scene, control))?;
        }
        let planned = MedialScene::new(&MedialBalls::default(), &rule(plan))?.with_triangles(others.added.clone());
        self.look(&planned, control)
    }

    /// Removes the targets that `scene` blocks.
    fn look(&mut self, scene: &MedialScene, control: &Control<'_>) -> Result<()> {
        if !self.is_reverse {
            let mut eyes: Vec<[f64; 3]> = self.observers.iter().map(|observer| observer.eye).collect();
            skip_unfit_eyes(scene, None, &mut eyes, control)?;
            self.observers.iter_mut().zip(eyes).for_each(|(observer, eye)| observer.eye = eye);
        }
        let look = || viewshed(scene, &self.observers, self.targets, &self.params, control);
        let mut seen = control.stage("testing lines of sight", self.observers.len(), look)?;
        if let Some(before) = &self.seen {
            for (bits, before) in seen.masks.iter_mut().flatten().zip(before.masks.iter().flatten()) {
                *bits &= before;
            }
        }
        self.seen = Some(seen);
        Ok(())
    }

    /// Returns the visibility past all parts. A free line is unproven where no pulse proves it, which counts as the
    /// parameters say. A target that missing balls may hide has no answer.
    ///
    /// # Errors
    /// Those of reading pulses, and [`belvedere::Error::Cancelled`].
    pub(crate) fn answered(self, tile: &TileSurroundings, control: &Control<'_>) -> Result<Viewshed> {
        let mut balls = tile.found();
        balls.skipped_observers =
            self.observers.iter().filter(|observer| !observer.eye.iter().all(|v| v.is_finite())).count();
        let is_tested = tile.plan.proves && self.params.unproven != UnprovenAs::Visible;
        let bare = match is_tested {
            true => self.without_proof(tile, &mut balls, control)?,
            false => Vec::new(),
        };
        Ok(self.settled(&mut balls, &bare, is_tested))
    }

    /// Flags for each observer the visible targets that no pulse proves.
    fn without_proof(
        &self,
        tile: &TileSurroundings,
        balls: &mut ObstacleSearch,
        control: &Control<'_>,
    ) -> Result<Vec<Vec<bool>>> {
        let Some(seen) = &self.seen else { return Ok(Vec::new()) };
        let of_observer = |(number, observer): (usize, &Observer)| {
            let line = |row: usize| {
                let target = self.targets[row].map(f64::from);
                let way = sub(observer.eye, target);
                let range = dot(way, way).sqrt();
                Line { target, towards: way.map(|v| v / range), range }
            };
            let rows: Vec<usize> = (0..self.targets.len()).filter(|&row| sees(&seen.masks, row, number)).collect();
            let lines: Vec<Line> = rows.iter().map(|&row| line(row)).collect();
            let of_run = (&*tile.plan, tile.run.as_path());
            let found = control.stage("testing pulses", 0, || unproven(of_run, &lines, balls, control))?;
            let mut are_bare = vec![false; self.targets.len()];
            rows.into_iter().zip(found).for_each(|(row, is_unproven)| are_bare[row] = is_unproven);
            Ok(are_bare)
        };
        self.observers.iter().enumerate().map(of_observer).collect()
    }

    /// Returns the visibility past all parts, unproven where `bare` has a flag for the observer. A target that missing
    /// `balls` may hide has no answer.
    fn settled(self, balls: &mut ObstacleSearch, bare: &[Vec<bool>], is_tested: bool) -> Viewshed {
        let Self { observers, targets, params, seen, .. } = self;
        let (answers, masks) = seen.map(|seen| (seen.answers, seen.masks)).unwrap_or_default();
        let may_be_hidden = |target: [f32; 3], eye: [f64; 3]| {
            let target = target.map(f64::from);
            !balls.missing.is_empty() && balls.is_unknown(target, sub(eye, target), 1.0)
        };
        let is_bare = |row: usize, number: usize| bare.get(number).is_some_and(|rows| rows.get(row) == Some(&true));
        // Number of observers that see a target, of these the unproven ones, and of these the ones with missing balls.
        let counts = |row: usize| {
            let seen_by = || observers.iter().enumerate().filter(|(number, _)| sees(&masks, row, *number));
            let unproven = seen_by().filter(|(number, _)| is_bare(row, *number)).count();
            let missing = seen_by().filter(|(_, observer)| may_be_hidden(targets[row], observer.eye)).count();
            [seen_by().count() - unproven, unproven, missing].map(to_row)
        };
        let counts: Vec<[u32; 3]> = (0..targets.len()).into_par_iter().with_min_len(CHUNK).map(counts).collect();
        let is_target = |answer: Answer| !matches!(answer, Answer::OutsideView | Answer::OutsideCloud);
        let answer = |(answer, counts): (Answer, &[u32; 3])| match counts {
            _ if !is_target(answer) => answer,
            [_, _, missing] if *missing > 0 => Answer::OutsideView,
            [0, 0, _] => Answer::Blocked,
            [0, ..] => params.unproven.settle(Answer::Unproven),
            _ => Answer::Visible,
        };
        balls.unknown_cells = counts.iter().filter(|counts| counts[2] > 0).count();
        let is_reported = is_tested && params.unproven == UnprovenAs::Reported;
        Viewshed {
            answers: answers.into_iter().zip(&counts).map(answer).collect(),
            unproven_counts: if is_reported { counts.iter().map(|counts| counts[1]).collect() } else { Vec::new() },
            counts: counts.iter().map(|counts| counts[0]).collect(),
            masks: Vec::new(),
            seen_counts: vec![0; observers.len()],
        }
    }
}

/// True if observer `number` sees the target in row `row`.
fn sees(masks: &[Vec<u32>], row: usize, number: usize) -> bool {
    masks.get(number / 32).and_then(|band| band.get(row)).is_some_and(|bits| bits >> (number % 32) & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::MapArea;
    use belvedere::apps::viewshed::SightLimits;
    use belvedere::blocking::BlockRule;

    #[test]
    fn views_that_missing_tiles_may_block_have_no_answer() {
        // A ball of 2 m in the east, and an unknown area in the north.
        let mut east = MedialBalls::default();
        east.push(0, [10.0, 0.0, 2.0], 2.0, 0);
        let scene = MedialScene::new(&east, &BlockRule::carved()).unwrap();
        let nothing = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
        let missing = vec![(MapArea { low: [-5.0, 10.0], high: [5.0, 20.0] }, 30.0)];
        let mut balls = ObstacleSearch { missing, ..ObstacleSearch::default() };
        let positions = vec![
            [-20.0, 0.0, 2.0],  // visible
            [20.0, 0.0, 2.0],   // behind the ball
            [0.0, 40.0, 2.0],   // behind the unknown area
            [0.0, 5.0, 2.0],    // in front of it
            [0.0, 40.0, 200.0], // high above it
            [-90.0, 0.0, 2.0],  // too far away
            [f32::NAN; 3],
        ];
        // The parts of the obstacles in any order.
        let mut see = |observers: &[Observer], parts: [&MedialScene; 2]| {
            let looks = Looks { observers, is_reverse: false };
            let mut sight = PartialSight::new(&looks, &positions, ViewshedParams::default());
            parts.into_iter().for_each(|scene| sight.look(scene, &Control::none()).unwrap());
            let skipped = sight.observers.iter().filter(|observer| observer.eye[0].is_nan()).count();
            let seen = sight.settled(&mut balls, &[], false);
            assert!(seen.unproven_counts.is_empty());
            let values = seen.to_measures().swap_remove(0).values;
            (values.into_iter().map(|value| value.is_finite().then_some(value)).collect::<Vec<_>>(), skipped)
        };
        let limits = SightLimits { distance: [0.0, 50.0], ..SightLimits::default() };
        let low = Observer { eye: [0.0, 0.0, 2.0], limits };
        let several = [low, Observer { eye: [0.0, 0.0, 80.0], limits }, Observer { eye: [10.0, 0.0, 2.0], limits }];
        for parts in [[&scene, &nothing], [&nothing, &scene]] {
            let (found, _) = see(&[low], parts);
            assert_eq!(found, [Some(1.0), Some(0.0), None, Some(1.0), Some(1.0), None, None]);
            // Two more observers: one high above, and one inside the ball, which sees nothing.
            let (found, skipped) = see(&several, parts);
            assert_eq!(found, [Some(2.0), Some(1.0), None, Some(2.0), Some(2.0), None, None]);
            assert_eq!(skipped, 1);
        }
    }
}
