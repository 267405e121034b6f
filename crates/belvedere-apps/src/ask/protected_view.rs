//! Protected views: how high one may build without entering the view of a landmark.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::known_ground::KnownGround;
use super::observers::{Eyes, note_enclosed, skip_unfit, stand};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LinesSection, ObserversSection, ProtectedViewSection};
use super::shared::SharedObject;
use super::standing::{Reach, Standing};
use crate::landmark::LandmarkParams;
use crate::protected_view::{self as limits, ViewpointReport, protected_view};
use crate::viewshed::OBSERVER_HEIGHT;
use belvedere_core::query::{SurfacePieces, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::report::rounded;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Maximum number of viewpoints that the report lists one by one.
const MAX_LISTED: usize = 10;

/// Maximum building height on cells of the ground ([`Places::Cells`]) outside the view of a landmark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ProtectedViewQuestion {
    /// The landmark.
    #[serde(skip)]
    pub landmark: Option<SharedObject<SurfacePieces>>,
    /// Positions from which it is visible today.
    #[serde(skip)]
    pub observers: Vec<Standing>,
    /// Height of observers above the ground, metres. Default 1.7.
    pub observer_height: f64,
    /// Maximum distance from an observer to the landmark, metres, above 0; `None` for no limit.
    pub max_distance: Option<f64>,
    /// Treatment of unproven lines that nothing blocks: reported, the default, and visible ones are protected. A given
    /// value needs pulses.
    pub unproven: Option<UnprovenAs>,
}

impl Default for ProtectedViewQuestion {
    fn default() -> Self {
        let observer_height = OBSERVER_HEIGHT;
        Self { landmark: None, observers: Vec::new(), observer_height, max_distance: None, unproven: None }
    }
}

/// Height limits of buildings.
pub struct ProtectedViewResults {
    /// Maximum heights above the ground, metres; NaN where no protected view passes and where no ground is known.
    pub heights: Raster<f32>,
    /// The same in the vertical system of the file.
    pub tops: Raster<f32>,
    /// The cells.
    pub ground: Arc<KnownGround>,
    /// Observers.
    pub eyes: Eyes,
}

impl ProtectedViewQuestion {
    /// Figures of the limits found on cells of `cell` metres, and the answer in words.
    fn sum_up(&self, found: &limits::ProtectedView, heights: &Raster<f32>, cell: f64, context: &mut Context) {
        let sum = |of: fn(&ViewpointReport) -> usize| found.viewpoints.iter().map(of).sum::<usize>();
        let known: Vec<f64> = heights.values().iter().filter(|v| v.is_finite()).map(|&v| f64::from(v)).collect();
        let lowest = known.iter().copied().reduce(f64::min);
        let mean = lowest.map(|_| known.iter().sum::<f64>() / known.len() as f64);
        let area = rounded(known.len() as f64 * cell * cell, 2);
        let is_reported = self.unproven.is_none_or(|choice| choice == UnprovenAs::Reported);
        let section = ProtectedViewSection {
            lines_protected: sum(|one| one.lines_protected),
            lines_unproven: is_reported.then(|| sum(|one| one.lines_unproven)),
            lines_blocked: sum(|one| one.lines_blocked),
            lines_not_tested: sum(|one| one.lines_not_tested),
            cells_limited: known.len(),
            area_limited_m2: area,
            lowest_limit_m: lowest.map(|limit| rounded(limit, 3)),
            mean_limit_m: mean.map(|limit| rounded(limit, 3)),
            viewpoint: if found.viewpoints.len() <= MAX_LISTED { found.viewpoints.clone() } else { Vec::new() },
        };
        let (free, blocked) = (section.lines_protected, section.lines_blocked);
        context.headline(format!("{free} of {} lines of sight to the landmark are free and protected", free + blocked));
        context.headline(match (section.lowest_limit_m, section.mean_limit_m) {
            (Some(lowest), Some(mean)) => {
                format!("they limit buildings on {area} m²: to {lowest} m above the ground at the lowest, {mean} m on average")
            }
            _ => "they limit buildings nowhere".to_owned(),
        });
        if free == 0 {
            let text = "no observer sees any part of the landmark today: nothing is protected";
            context.add(Some(Remark::warning("nothing-protected", text)));
        }
        context.report.protected_view = Some(section);
    }
}

impl Ask for ProtectedViewQuestion {
    type Found = ProtectedViewResults;

    fn check(&self) -> Result<()> {
        if let Some(distance) = self.max_distance.filter(|distance| !(*distance > 0.0)) {
            return Err(Error::invalid(Parameter::MaxDistance, distance, "above zero metres"));
        }
        if !self.observer_height.is_finite() {
            return Err(Error::invalid(Parameter::HeightAboveGround, self.observer_height, "finite"));
        }
        Ok(())
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let Places::Cells(cells) = places else {
            let what = "what protected views limit are the cells of a grid";
            return Err(Error::UnsupportedTargets { method: "protected view", what });
        };
        let Some(landmark) = &self.landmark else {
            return Err(Error::MissingAttribute {
                attribute: "landmark",
                needed_for: "protected views",
                advice: "give its mesh, class or polygon",
            });
        };
        if self.unproven.is_some() {
            scene.check_proof()?;
        }
        let unproven = self.unproven.unwrap_or(UnprovenAs::Reported);
        let standing = stand(&self.observers, (self.observer_height, cells.ground), scene, context, control)?;
        let ground = scene.ground(cells.grid(scene)?, cells.ground, control)?;
        context.ground(scene.frame(), &ground);
        let blockers = scene.blockers(unproven, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let eyes =
            skip_unfit(standing, ("observer", Reach::Cloud), (&blockers, None), (scene, &mut *context), control)?;
        note_enclosed(&blockers, &eyes.eyes, "observer", context);
        context.report.observers = Some(ObserversSection { eyes: eyes.report.clone(), ..ObserversSection::default() });
        let params = LandmarkParams::default()
            .with_unproven(unproven)
            .with_max_range(self.max_distance.unwrap_or(f64::INFINITY));
        let grid = &ground.ground.grid;
        let found = control.stage("computing limits", eyes.eyes.len(), || {
            protected_view(&blockers, landmark, &eyes.eyes, grid, &params, control)
        })?;
        let heights = found.above_ground(&ground.ground)?;
        self.sum_up(&found, &heights, grid.cell, context);
        let mut tops = found.limits;
        for top in tops.values_mut() {
            *top = to_f32(scene.frame().file_from_local([0.0, 0.0, f64::from(*top)])[2]);
        }
        Ok(Answers::new(ProtectedViewResults { heights, tops, ground, eyes }, Vec::new()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_and_heights_that_cannot_be_are_refused() {
        let usual = ProtectedViewQuestion::default;
        assert!(usual().check().is_ok());
        for wrong in [
            ProtectedViewQuestion { max_distance: Some(0.0), ..usual() },
            ProtectedViewQuestion { max_distance: Some(f64::NAN), ..usual() },
            ProtectedViewQuestion { observer_height: f64::INFINITY, ..usual() },
        ] {
            assert!(matches!(wrong.check(), Err(Error::InvalidParameter { .. })), "{wrong:?}");
        }
    }
}
