//! What observers see of each kind of targets, in numbers and words.

use super::ViewshedQuestion;
use crate::ask::places::cells_of;
use crate::ask::{Context, Remark, Scene, remark_on_outside};
use crate::targets::{CellParams, Targets};
use crate::viewshed::{
    Masks, Observer, Viewshed as Seen, ViewshedParams, far_viewshed, min_visible_heights, tested_height, viewshed,
};
use belvedere_core::ground::Ground;
use belvedere_core::query::{Answer, AnswerCounts, MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::report::{percent, rounded};
use belvedere_data::{ElevationGrid, Result};
use serde::Serialize;

/// What was seen of far terrain.
pub struct FarSeen {
    /// An answer for each node.
    pub seen: Seen,
    /// The terrain within reach.
    pub terrain: ElevationGrid,
}

/// How many targets are seen, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeenSection {
    targets: usize,
    visible: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    unproven: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unproven_percent: Option<f64>,
    blocked: usize,
    outside_view: usize,
    outside_cloud: usize,
    visible_percent: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    visible_m2: Option<f64>,
}

/// What is counted.
struct Things {
    where_to: &'static str,
    name: &'static str,
    /// Of each, square metres, where it has one.
    area: Option<f64>,
}

/// Observers before what blocks.
pub(super) struct Sights<'a> {
    pub(super) question: &'a ViewshedQuestion,
    pub(super) scene: &'a Scene,
    pub(super) blockers: &'a MedialScene,
    pub(super) observers: &'a [Observer],
    pub(super) params: ViewshedParams,
}

impl Sights<'_> {
    /// The cells that are targets: neither under a cover nor inside what was added.
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
        let things = Things { where_to: "", name: "cells", area: Some(cell * cell) };
        context.report.cells = Some(self.counted(&seen.answers, &things, context));
        self.remark_on_blind(&seen, context);
        Ok(seen)
    }

    pub(super) fn of_points(&self, context: &mut Context, control: &Control<'_>) -> Result<Seen> {
        let Self { scene, blockers, observers, params, .. } = *self;
        let positions = &scene.ground_cloud()?.positions;
        let seen = control
            .stage("testing points", observers.len(), || viewshed(blockers, observers, positions, &params, control))?;
        let things = Things { where_to: "", name: "points", area: None };
        let section = self.counted(&seen.answers, &things, context);
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
        context.report.far_cells = Some(self.counted(&known, &things, context));
        Ok(FarSeen { seen, terrain })
    }

    pub(super) fn heights(&self, max_height: f64, ground: &Ground, control: &Control<'_>) -> Result<Raster<f32>> {
        let Self { blockers, observers, params, .. } = *self;
        control.stage("computing visible heights", observers.len(), || {
            min_visible_heights(blockers, observers, ground, max_height, &params.earth, control)
        })
    }

    /// Remarks on observers that see nothing.
    fn remark_on_blind(&self, seen: &Seen, context: &mut Context) {
        let observers = self.observers;
        let is_seen = |answer: &Answer| matches!(answer, Answer::Visible | Answer::Unproven);
        if observers.len() == 1 && !seen.answers.iter().any(is_seen) {
            let text = match self.question.reverse {
                true => "no cell sees the target: is it below or inside an obstacle?",
                false => "the observer sees no cell: does it stand below a tree or between obstacles?",
            };
            context.add(Some(Remark::warning("nothing-seen", text)));
        }
        let is_blind = |(observer, count): &(&Observer, &usize)| **count == 0 && observer.eye[0].is_finite();
        let blind = observers.iter().zip(&seen.seen_counts).filter(is_blind).count();
        if observers.len() > 1 {
            context.add(Remark::of_share("observers-see-nothing", blind, observers.len(), "observers", "see no cell"));
        }
    }

    /// How many targets are seen.
    fn counted(&self, answers: &[Answer], things: &Things, context: &mut Context) -> SeenSection {
        let counts = AnswerCounts::of(answers);
        let targets = answers.len() - counts.outside_view - counts.outside_cloud;
        let unproven = (self.params.unproven == UnprovenAs::Reported).then_some(counts.unproven);
        let section = SeenSection {
            targets,
            visible: counts.visible,
            unproven,
            unproven_percent: unproven.map(|count| percent(count, targets)),
            blocked: counts.blocked,
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
