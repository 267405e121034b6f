//! Probability that the cells of a tile are lit or visible. The evidence is gathered part by part from obstacles, and
//! block by block from pulses.

use crate::answer::lines::AreaLines;
use crate::answer::obstacles::rule;
use crate::answer::parts::TileObstacles;
use crate::answer::proof::{self, Line, sampled_lengths};
use crate::answer::surroundings::TileSurroundings;
use belvedere::Result;
use belvedere::apps::ask::survey_parts::Looks;
use belvedere::apps::eyes::skip_unfit_eyes;
use belvedere::apps::shadow::ShadowSun;
use belvedere::apps::viewshed::{Observer, SeenProbabilities, add_known};
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockedLines, Certainty, Evidence, MedialScene};
use belvedere::vector::{dot, sub};
use rayon::prelude::*;

/// Number of targets that a thread takes at once.
const CHUNK: usize = 256;

/// Evidence for lines of sight from targets to a sun or to observers, past one part of the obstacles after the other.
pub(crate) struct PartialEvidence<'a> {
    viewers: Viewers,
    targets: &'a [[f32; 3]],
    /// Lines that all parts so far block, for each viewer.
    blocked: Vec<Vec<BlockedLines>>,
    /// Lines that all parts except vegetation block, for a sun behind measured crowns; otherwise empty.
    solid: Vec<BlockedLines>,
    /// Optical depth of the crowns before each target; as long as `solid`.
    depths: Vec<f64>,
}

enum Viewers {
    Sun(ShadowSun),
    /// Observers. The eye of an observer inside an obstacle is not finite, except in a reverse viewshed.
    Observers {
        observers: Vec<Observer>,
        is_reverse: bool,
    },
}

impl Viewers {
    fn count(&self) -> usize {
        match self {
            Self::Sun(_) => 1,
            Self::Observers { observers, .. } => observers.len(),
        }
    }

    /// Returns the line of sight from a target, local metres, to viewer `number`; `None` without an answer.
    fn line(&self, number: usize, target: [f32; 3]) -> Option<Line> {
        let target = target.map(f64::from);
        if !target.iter().all(|v| v.is_finite()) {
            return None;
        }
        match self {
            Self::Sun(sun) => Some(Line { target, towards: sun.to_sun, range: f64::INFINITY }),
            Self::Observers { observers, .. } => {
                let Observer { eye, limits } = observers.get(number)?;
                let way = sub(*eye, target);
                let range = dot(way, way).sqrt();
                let is_allowed = range > 0.0 && range.is_finite() && limits.allow(*eye, target);
                is_allowed.then(|| Line { target, towards: way.map(|v| v / range), range })
            }
        }
    }
}

impl<'a> PartialEvidence<'a> {
    /// Creates empty evidence for a sun.
    pub(crate) fn of_sun(sun: ShadowSun, targets: &'a [[f32; 3]]) -> Self {
        Self::new(Viewers::Sun(sun), targets)
    }

    /// Creates empty evidence for observers.
    pub(crate) fn of_observers(looks: &Looks<'_>, targets: &'a [[f32; 3]]) -> Self {
        let viewers = Viewers::Observers { observers: looks.observers.to_vec(), is_reverse: looks.is_reverse };
        Self::new(viewers, targets)
    }

    fn new(viewers: Viewers, targets: &'a [[f32; 3]]) -> Self {
        let blocked = vec![vec![BlockedLines::NONE; targets.len()]; viewers.count()];
        Self { viewers, targets, blocked, solid: Vec::new(), depths: Vec::new() }
    }

    /// Adds the evidence of all `parts` and of the other obstacles.
    pub(crate) fn gather(&mut self, parts: &TileObstacles, lines: &AreaLines<'_>, control: &Control<'_>) -> Result<()> {
        let TileSurroundings { plan, others, .. } = &*parts.tile;
        if let (Viewers::Sun(sun), Some(medium)) = (&self.viewers, parts.medium()) {
            let factor = parts.crowns().map_or(1.0, |crowns| crowns.factor(sun.season));
            self.solid = vec![BlockedLines::NONE; self.targets.len()];
            let depth = |target: &[f32; 3]| match target.iter().all(|v| v.is_finite()) {
                true => factor * medium.optical_depth(target.map(f64::from), sun.to_sun, f64::INFINITY),
                false => 0.0,
            };
            self.depths = self.targets.par_iter().with_min_len(CHUNK).map(depth).collect();
        }
        parts.each_scene(lines, control, |scene, solid| self.look(scene, solid, control))?;
        let beside = MedialScene::new(&MedialBalls::default(), &rule(plan))?
            .with_triangles(others.added.clone())
            .with_far_terrain(others.far_terrain.clone());
        self.look(&beside, Some(&beside), control)
    }

    fn look(&mut self, scene: &MedialScene, solid: Option<&MedialScene>, control: &Control<'_>) -> Result<()> {
        if let Viewers::Observers { observers, is_reverse: false } = &mut self.viewers {
            let mut eyes: Vec<[f64; 3]> = observers.iter().map(|observer| observer.eye).collect();
            skip_unfit_eyes(scene, None, &mut eyes, control)?;
            observers.iter_mut().zip(eyes).for_each(|(observer, eye)| observer.eye = eye);
        }
        let Self { viewers, targets, blocked, .. } = self;
        if let (Some(solid), Viewers::Sun(sun)) = (solid, &*viewers) {
            let rows = self.solid.par_iter_mut().zip(targets.par_iter()).with_min_len(CHUNK);
            rows.filter(|(_, target)| target.iter().all(|v| v.is_finite())).for_each(|(blocked, target)| {
                *blocked = solid.blocked_lines(*blocked, target.map(f64::from), sun.to_sun, f64::INFINITY);
            });
        }
        for (number, blocked) in blocked.iter_mut().enumerate() {
            control.stage("computing probabilities", 0, || {
                blocked.par_iter_mut().zip(targets.par_iter()).with_min_len(CHUNK).try_for_each(|(blocked, target)| {
                    control.check()?;
                    if let Some(Line { target, towards, range }) = viewers.line(number, *target) {
                        *blocked = scene.blocked_lines(*blocked, target, towards, range);
                    }
                    Ok(())
                })
            })?;
        }
        Ok(())
    }

    /// Returns the probability that each target is free for the viewer, or for several viewers their expected number,
    /// and how many of the answers miss `certainty`. Targets without an answer are NaN, and so are those that missing
    /// balls may block.
    pub(crate) fn probabilities(
        &self,
        tile: &TileSurroundings,
        certainty: Option<Certainty>,
        control: &Control<'_>,
    ) -> Result<SeenProbabilities> {
        let TileSurroundings { plan, run, .. } = tile;
        let mut balls = tile.found();
        let mut expected = vec![f32::NAN; self.targets.len()];
        let mut uncertain = expected.clone();
        let top = proof::top(plan);
        for (number, blocked) in self.blocked.iter().enumerate() {
            let of_row = |row: usize| Some((row, self.viewers.line(number, self.targets[row])?));
            let (rows, lines): (Vec<usize>, Vec<Line>) = (0..self.targets.len()).filter_map(of_row).unzip();
            let unseen =
                control.stage("testing pulses", 0, || sampled_lengths((plan, run), &lines, &mut balls, control))?;
            for ((row, line), unseen) in rows.into_iter().zip(&lines).zip(unseen) {
                let &Line { target, towards, range } = line;
                if !balls.missing.is_empty() && balls.is_unknown(target, towards, range) {
                    continue;
                }
                let end_height = target[2] + range * towards[2];
                let is_between_places = range.is_finite() && target[2] <= top && end_height <= top;
                let evidence = Evidence::from_the_air(blocked[row], is_between_places, unseen);
                let probability = match (self.solid.get(row), self.depths.get(row)) {
                    (Some(solid), Some(depth)) => evidence.probability_among_crowns(*solid, *depth),
                    _ => evidence.probability(),
                };
                add_known(&mut expected[row], probability);
                let is_uncertain = certainty.is_some_and(|certainty| certainty.is_missed_by(probability));
                add_known(&mut uncertain[row], f32::from(u8::from(is_uncertain)));
            }
        }
        Ok(SeenProbabilities { expected, uncertain: certainty.map(|_| uncertain) })
    }
}
