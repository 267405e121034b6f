//! Results of observers for each kind of targets, in numbers and words.

use super::question::ViewshedQuestion;
use crate::ask::cells::cells_of;
use crate::ask::context::Context;
use crate::ask::remark::Remark;
use crate::ask::scene::Scene;
use crate::ask::sections::SeenSection;
use crate::ask::viewer::remark_on_outside;
use crate::targets::{CellParams, Measure, Targets};
use crate::viewshed::{
    Masks, Observer, Viewshed as Seen, ViewshedParams, far_viewshed, min_visible_heights, seen_probabilities,
    tested_height, viewshed,
};
use belvedere_core::ground::Ground;
use belvedere_core::query::{Answer, AnswerCounts, MedialScene, UnprovenAs, Viewer};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::report::{percent, rounded};
use belvedere_data::{ElevationGrid, Result};

/// Lines of sight whose ends are looked at, where an eye sees nothing.
const SAMPLE: usize = 200;

/// Results for far terrain.
pub struct FarSeen {
    /// An answer for each node.
    pub seen: Seen,
    /// The terrain within reach.
    pub terrain: ElevationGrid,
}

/// Description of the counted targets.
pub(super) struct Things {
    pub(super) where_to: &'static str,
    pub(super) name: &'static str,
    /// Area of each, square metres, if it has one.
    pub(super) area: Option<f64>,
}

impl Things {
    /// Cells of a side, metres.
    pub(super) fn cells(side: f64) -> Self {
        Self { where_to: "", name: "cells", area: Some(side * side) }
    }
}

impl SeenSection {
    /// Counts the visible targets, and those whose views pulses prove or do not; reports them in `context`.
    pub(super) fn of(answers: &[Answer], is_tested: bool, things: &Things, context: &mut Context) -> Self {
        let counts = AnswerCounts::of(answers);
        let targets = answers.len() - counts.outside_view - counts.outside_cloud;
        let unproven = is_tested.then_some(counts.unproven);
        let section = Self {
            targets,
            visible: counts.visible,
            unproven,
            unproven_percent: unproven.map(|count| percent(count, targets)),
            blocked: counts.blocked,
            inside_obstacle: None,
            outside_view: counts.outside_view,
            outside_cloud: counts.outside_cloud,
            visible_percent: percent(counts.visible, targets),
            visible_m2: things.area.map(|area| rounded(counts.visible as f64 * area, 1)),
        };
        let (where_to, name) = (things.where_to, things.name);
        let mut line = format!("{where_to}visible {} % of {targets} {name}", section.visible_percent);
        if let Some(area) = section.visible_m2 {
            line.push_str(&format!(" ({area} m²)"));
        }
        if let Some(unproven) = section.unproven_percent {
            line.push_str(&format!(", unproven {unproven} %"));
        }
        context.headline(line);
        section
    }
}

/// Returns a note on targets inside obstacles; `name` is what the targets are.
pub(super) fn remark_on_inside(count: usize, targets: usize, name: &str) -> Option<Remark> {
    let so = "lie inside an obstacle, and count as blocked";
    Remark::of_share("targets-inside-obstacle", count, targets, name, so).map(Remark::into_note)
}

/// Observers and the obstacles before them.
pub(super) struct Sights<'a> {
    pub(super) question: &'a ViewshedQuestion,
    pub(super) scene: &'a Scene,
    pub(super) blockers: &'a MedialScene,
    pub(super) observers: &'a [Observer],
    pub(super) params: ViewshedParams,
}

impl Sights<'_> {
    /// The cells that are targets: neither under a cover nor inside added meshes.
    pub(super) fn cells(&self, ground: &Ground, context: &mut Context, control: &Control<'_>) -> Result<Targets> {
        let [_, height] = self.question.heights();
        let params = CellParams::default().with_height(tested_height(height));
        cells_of(self.scene, ground.clone(), &params, context, control)
    }

    pub(super) fn of_cells(
        &self,
        (targets, cell): (&Targets, f64),
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Seen> {
        let Self { question, blockers, observers, params, .. } = *self;
        let params = params.with_masks(if question.masks { Masks::Kept } else { Masks::NotKept });
        let seen = control.stage("testing cells", observers.len(), || {
            viewshed(blockers, observers, &targets.positions, &params, control)
        })?;
        let things = Things::cells(cell);
        let counts = self.count(&seen.answers, &targets.positions, &things, context, control)?;
        context.report.cells = Some(counts);
        self.remark_on_blind(&seen, &targets.positions, context);
        Ok(seen)
    }

    /// Computes the certainty of the answers for `targets`, if wanted.
    pub(super) fn sure_of(
        &self,
        seen: &Seen,
        targets: &[[f32; 3]],
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<Measure>> {
        let Self { question, scene, observers, .. } = *self;
        let how_sure = &question.how_sure;
        let Some(blockers) = how_sure.blockers(scene, context, control)? else { return Ok(Vec::new()) };
        let found = control.stage("computing probabilities", observers.len() * targets.len(), || {
            seen_probabilities(&blockers, observers, targets, how_sure.certainty()?, control)
        })?;
        if observers.len() == 1 {
            let is_unproven = |row: usize| seen.answers.get(row) == Some(&Answer::Unproven);
            let uncertain = how_sure.uncertain(&found.expected, is_unproven)?;
            how_sure.summarise(&found.expected, uncertain.as_deref(), ["visible", "blocked"], context);
            return Ok(how_sure.measures(found.expected, uncertain, ""));
        }
        Ok(how_sure.measures_of_many(found))
    }

    pub(super) fn of_points(&self, context: &mut Context, control: &Control<'_>) -> Result<Seen> {
        let Self { scene, blockers, observers, params, .. } = *self;
        let positions = &scene.ground_cloud()?.positions;
        let seen = control
            .stage("testing points", observers.len(), || viewshed(blockers, observers, positions, &params, control))?;
        let things = Things { where_to: "", name: "points", area: None };
        let section = self.count(&seen.answers, positions, &things, context, control)?;
        let (outside, count) = (section.outside_cloud, seen.answers.len());
        context.add(remark_on_outside(outside, count, "points"));
        context.report.cloud_points = Some(section);
        Ok(seen)
    }

    pub(super) fn of_terrain(
        &self,
        terrain: ElevationGrid,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<FarSeen> {
        let Self { question, blockers, observers, params, .. } = *self;
        let [_, height] = question.heights();
        let seen = control.stage("testing terrain", terrain.heights().height(), || {
            far_viewshed(blockers, observers, &terrain, height, &params, control)
        })?;
        let known: Vec<Answer> = seen.answers.iter().copied().filter(|&one| one != Answer::OutsideCloud).collect();
        let [width, depth] = terrain.cell();
        let things = Things { where_to: "beyond the cloud ", name: "cells", area: Some(width * depth) };
        context.report.far_cells = Some(self.section(&known, &things, context));
        Ok(FarSeen { seen, terrain })
    }

    pub(super) fn heights(&self, max_height: f64, ground: &Ground, control: &Control<'_>) -> Result<Raster<f32>> {
        let Self { blockers, observers, params, .. } = *self;
        control.stage("computing visible heights", observers.len(), || {
            min_visible_heights(blockers, observers, ground, max_height, &params.earth, control)
        })
    }

    /// Remarks on observers that see nothing, and why.
    fn remark_on_blind(&self, seen: &Seen, targets: &[[f32; 3]], context: &mut Context) {
        let observers = self.observers;
        let is_seen = |answer: &Answer| matches!(answer, Answer::Visible | Answer::Unproven);
        if let [observer] = observers
            && !seen.answers.iter().any(is_seen)
        {
            let who = self.question.who_is_blind();
            let (why, range) = self.why_blind(observer.eye, seen, targets);
            let remark = Remark::warning("nothing-seen", format!("{who}: {why}"));
            context.add(Some(match range {
                Some(range) => remark.with("blocked_within_m", range),
                None => remark,
            }));
        }
        let is_blind = |(observer, count): &(&Observer, &usize)| **count == 0 && observer.eye[0].is_finite();
        let blind = observers.iter().zip(&seen.seen_counts).filter(is_blind).count();
        if observers.len() > 1 {
            context.add(Remark::of_share("observers-see-nothing", blind, observers.len(), "observers", "see no cell"));
        }
    }

    /// Why an eye is not connected to any of `targets`, and within which range all lines of sight end where that is so.
    fn why_blind(&self, eye: [f64; 3], seen: &Seen, targets: &[[f32; 3]]) -> (String, Option<f64>) {
        let Self { question, blockers, params, .. } = *self;
        if blockers.is_inside_obstacle(eye) {
            let depth = blockers.enclosure(eye).depth;
            return (
                format!("it is inside an obstacle, {depth:.2} m deep; give a place outside, or a height above it"),
                None,
            );
        }
        let blocked: Vec<[f64; 3]> = seen
            .answers
            .iter()
            .zip(targets)
            .filter(|(answer, _)| **answer == Answer::Blocked)
            .map(|(_, target)| target.map(f64::from))
            .collect();
        if blocked.is_empty() {
            return ("there is none within the limits of sight".to_owned(), None);
        }
        let some = blocked.iter().step_by(blocked.len().div_ceil(SAMPLE));
        let first = |target: &[f64; 3]| Some(blockers.line_of_sight(eye, *target, &params.earth)?.first_block?.range);
        let farthest = some.filter_map(first).fold(0.0, f64::max);
        let give = question.way_to_see();
        (format!("all lines of sight end within {farthest:.2} m of it; {give}"), Some(rounded(farthest, 3)))
    }

    /// Counts the visible `targets`, with those that lie inside an obstacle.
    fn count(
        &self,
        answers: &[Answer],
        targets: &[[f32; 3]],
        things: &Things,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<SeenSection> {
        let mut marked = answers.to_vec();
        // of observers only those that are not inside look at all
        let anywhere = Viewer::Direction([0.0, 0.0, 1.0]);
        self.blockers.mark_inside_obstacles(anywhere, targets, &mut marked, control)?;
        let inside_obstacle = AnswerCounts::of(&marked).inside_obstacle;
        let section = SeenSection { inside_obstacle: Some(inside_obstacle), ..self.section(answers, things, context) };
        context.add(remark_on_inside(inside_obstacle, section.targets, things.name));
        Ok(section)
    }

    fn section(&self, answers: &[Answer], things: &Things, context: &mut Context) -> SeenSection {
        SeenSection::of(answers, self.params.unproven == UnprovenAs::Reported, things, context)
    }
}
