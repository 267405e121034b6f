//! Viewshed of a survey of which only parts are in memory.

use super::{ViewshedQuestion, ViewshedResults};
use crate::ask::answers::{Answered, Answers};
use crate::ask::context::Context;
use crate::ask::known_ground::KnownGround;
use crate::ask::places::{Places, other};
use crate::ask::scene::Scene;
use crate::ask::survey_parts::{Looks, SurveyParts};
use crate::targets::{Measure, TargetLayout};
use crate::viewshed::{Observer, SightLimits, Viewshed as Seen, ViewshedParams};
use belvedere_core::ground::GroundReport;
use belvedere_core::query::Answer;
use belvedere_data::control::Control;
use belvedere_data::{Parameter, Result};
use std::sync::Arc;

impl ViewshedQuestion {
    /// Computes the viewshed of cells that were made before, part by part. Observers have heights.
    pub(super) fn answer_in_parts(
        &self,
        parts: &dyn SurveyParts,
        limits: Vec<SightLimits>,
        places: &Places,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Answered<Self> {
        let targets = places.targets(scene, context, control)?;
        let TargetLayout::Cells(ground) = &targets.layout else {
            return other(Parameter::Targets, "other places", "cells of a grid");
        };
        let eyes = self.standing().map(|(eye, _)| eye);
        let observers: Vec<Observer> = eyes.zip(limits).map(|(eye, limits)| Observer { eye, limits }).collect();
        let looks = Looks { observers: &observers, is_reverse: self.reverse };
        let params = ViewshedParams::default().with_earth(self.earth).with_unproven(self.unproven());
        let seen = parts.viewshed(&looks, &targets.positions, &params, control)?;
        let cells_sure = self.sure_of_parts(parts, &looks, (&seen, &targets.positions), control)?;
        let measures = [seen.to_measures(), cells_sure.clone()].concat();
        let ground = Arc::new(KnownGround { ground: (**ground).clone(), report: GroundReport::default() });
        let results = ViewshedResults {
            eyes: observers.iter().map(|observer| observer.eye).collect(),
            reverse: self.reverse,
            ground,
            cells: Some(seen),
            cells_sure,
            points: None,
            points_sure: Vec::new(),
            far: None,
            heights: None,
        };
        Ok(Answers::new(results, measures))
    }

    fn sure_of_parts(
        &self,
        parts: &dyn SurveyParts,
        looks: &Looks<'_>,
        (seen, targets): (&Seen, &[[f32; 3]]),
        control: &Control<'_>,
    ) -> Result<Vec<Measure>> {
        let how_sure = &self.how_sure;
        if !how_sure.is_wanted() {
            return Ok(Vec::new());
        }
        let found = parts.seen_probabilities(looks, targets, how_sure.certainty()?, control)?;
        if looks.observers.len() != 1 {
            return Ok(how_sure.measures_of_many(found));
        }
        let is_unproven = |row: usize| seen.answers.get(row) == Some(&Answer::Unproven);
        let uncertain = how_sure.uncertain(&found.expected, is_unproven)?;
        Ok(how_sure.measures(found.expected, uncertain, ""))
    }
}
