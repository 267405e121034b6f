//! Window views: kinds and ranges of the surfaces seen from windows.

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::north::North;
use super::places::{Places, test_edge};
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LinesSection, NamedValues, ViewsSection, WindowsSection};
use super::seen_kinds::kinds_of_balls;
use super::windows::{GivenWindows, WindowTargets};
use crate::targets::{Measure, Window};
use crate::window_views::{
    ClassMeanings, Kinds, NamedView, Proving, SeenKind, VIEW_DIRECTIONS, VIEW_SPACING, WindowView, leave_out_level,
    leave_out_walled_up, view_directions, view_measures, views_by_name, window_views,
};
use belvedere_core::query::UnprovenAs;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Share of the things seen that are of no known kind from which on it is warned of, percent.
const OTHER_WARNING_PERCENT: f64 = 50.0;

/// Views from windows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct WindowViewsQuestion {
    /// The windows.
    #[serde(skip)]
    pub windows: GivenWindows,
    /// North of their azimuths.
    pub north: North,
    /// Longest side of the pieces that faces of a mesh are cut into, metres, above 0. Default 2.
    pub spacing: f64,
    /// Seed of the places on these pieces. Default 1.
    pub seed: u64,
    /// Number of directions in front of each place, 1 to 100 000. Default 1000.
    pub directions: usize,
    /// Meanings of classes of points that differ from ASPRS.
    pub classes: Vec<(u8, SeenKind)>,
    /// Treatment of unproven views: reported (`None` too), or visible. A given value needs pulses.
    pub unproven: Option<UnprovenAs>,
}

impl Default for WindowViewsQuestion {
    fn default() -> Self {
        Self {
            windows: GivenWindows::default(),
            north: North::True,
            spacing: VIEW_SPACING,
            seed: 1,
            directions: VIEW_DIRECTIONS,
            classes: Vec::new(),
            unproven: None,
        }
    }
}

/// Results for windows.
pub struct WindowViewsResults {
    /// Position and direction of each window.
    pub windows: Vec<Window>,
    /// Name of the object that each is a face of; empty where that is not known.
    pub names: Vec<String>,
    /// View from each window.
    pub views: Vec<WindowView>,
    /// Azimuth of grid north from the north that azimuths count from, radians.
    pub grid_north: f64,
}

impl WindowViewsResults {
    /// The mean views of the windows of each name; windows count by their area where they are faces.
    #[must_use]
    pub fn by_name(&self, names: &[String]) -> Vec<NamedView> {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let weights: Vec<f64> = self.windows.iter().map(|window| window.area.unwrap_or(1.0)).collect();
        views_by_name(&self.views, &names, &weights)
    }

    /// Azimuth that each looks to, degrees from the north of the question.
    #[must_use]
    pub fn azimuths_deg(&self) -> Vec<f64> {
        let azimuth = |window: &Window| (window.azimuth + self.grid_north).to_degrees().rem_euclid(360.0);
        self.windows.iter().map(azimuth).collect()
    }
}

impl WindowViewsQuestion {
    /// The windows of a scene, without roofs, floors and windows outside the cloud.
    fn targets(
        &self,
        scene: &Scene,
        grid_north: f64,
        directions: &[[f64; 3]],
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<WindowTargets> {
        let mut found = self.windows.targets(scene.frame(), grid_north, (self.spacing, self.seed))?;
        let mut section = WindowsSection {
            windows: found.windows.len(),
            targets: found.targets.len(),
            targets_on_roofs_and_floors: None,
        };
        if self.are_faces() {
            section.targets_on_roofs_and_floors = Some(leave_out_level(&mut found.targets));
        }
        context.report.windows = Some(section);
        found.leave_out_outside(scene, context)?;
        let upper = directions.get(..self.directions).unwrap_or(directions);
        test_edge(scene, &found.targets, upper, context, control)?;
        Ok(found)
    }

    fn are_faces(&self) -> bool {
        matches!(self.windows, GivenWindows::Faces(_))
    }
}

impl Ask for WindowViewsQuestion {
    type Found = WindowViewsResults;

    fn check(&self) -> Result<()> {
        if self.unproven == Some(UnprovenAs::Blocked) {
            let expected = "reported or visible: a view has no targets that could be blocked";
            return Err(Error::invalid(Parameter::UnprovenAs, "blocked", expected));
        }
        if !(self.spacing > 0.0 && self.spacing.is_finite()) {
            return Err(Error::invalid(Parameter::Spacing, self.spacing, "above zero metres"));
        }
        if let Some((class, seen)) = self.classes.iter().find(|(_, seen)| SeenKind::thing_called(seen.name()).is_none())
        {
            let value = format!("{class} as {}", seen.name());
            return Err(Error::invalid(Parameter::ClassMeaning, value, "vegetation, water, building, ground or other"));
        }
        view_directions(self.directions)?;
        self.windows.check()
    }

    fn answer(&self, scene: &Scene, _: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        if self.unproven.is_some() {
            scene.check_proof()?;
        }
        let directions = view_directions(self.directions)?;
        let north = self.north.of_scene(scene);
        context.north(&north);
        let WindowTargets { mut targets, windows, names } =
            self.targets(scene, north.of_grid, &directions, context, control)?;
        let meanings = self.classes.iter().fold(ClassMeanings::default(), |all, &(class, seen)| all.with(class, seen));
        let kinds = kinds_of_balls(scene, &meanings, context)?;
        let blockers = scene.blockers(self.unproven.unwrap_or(UnprovenAs::Reported), control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let count = targets.target_count();
        let inside = control.stage("testing targets", 0, || leave_out_walled_up(&mut targets, &blockers, control))?;
        if targets.target_count() == 0 {
            let what = "all are outside the cloud, inside obstacles, or faces of roofs and floors. Are they in the coordinates of the cloud?";
            return Err(Error::NoObserver { who: "window", what: what.to_owned() });
        }
        context.report.places.targets_inside_obstacle = Some(inside);
        // walls between houses are faces of a mesh, and nothing to warn of
        if !self.are_faces() {
            let so = "are inside an obstacle and have no view";
            context.add(Remark::of_share("targets-inside-obstacle", inside, count, "targets", so));
        }
        let views = control.stage("testing views", targets.len(), || {
            let kinds = Kinds { balls: &kinds, meshes: &[] };
            window_views(&blockers, &targets, kinds, &directions, control)
        })?;
        let proving = if blockers.proof().is_some() { Proving::Tested } else { Proving::NotTested };
        let measures = view_measures(&views, proving);
        self.sum_up(&views, &measures, context);
        Ok(Answers::new(WindowViewsResults { windows, names, views, grid_north: north.of_grid }, measures))
    }
}

impl WindowViewsQuestion {
    /// Figures, the answer in words, and a warning where most things seen are of no known kind.
    fn sum_up(&self, views: &[WindowView], measures: &[Measure], context: &mut Context) {
        let statistics = measures.iter().map(|measure| (measure.name.clone(), measure.rounded_statistics()));
        context.report.views =
            Some(ViewsSection { directions: self.directions, measures: NamedValues(statistics.collect()) });
        let known = || views.iter().filter(|view| view.shares[SeenKind::Sky as usize].is_finite());
        context.headline(format!(
            "view from {} of {} windows, in percent of what is in front",
            known().count(),
            views.len()
        ));
        for seen in [SeenKind::Sky, SeenKind::Vegetation, SeenKind::Building] {
            if let Some(measure) = measures.iter().find(|measure| measure.name == seen.name()) {
                context.headline(format!("{}: {}", seen.name(), spread(&measure.values, 1, "%")));
            }
        }
        let sum = |seen: SeenKind| known().map(|view| view.shares[seen as usize]).sum::<f64>();
        let is_thing = |seen: &SeenKind| SeenKind::thing_called(seen.name()).is_some();
        let things: f64 = SeenKind::ALL.into_iter().filter(is_thing).map(sum).sum();
        let other = 100.0 * sum(SeenKind::Other) / things;
        if other >= OTHER_WARNING_PERCENT {
            let other = rounded(other, 1);
            let text = format!(
                "{other} % of the things seen are of no known kind: do the classes of the cloud mean something else than ASPRS says?"
            );
            context.add(Some(Remark::warning("seen-things-of-no-kind", text).with("percent", other)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_that_cannot_be_are_refused_before_a_scene_is_needed() {
        let usual = WindowViewsQuestion::default;
        assert!(usual().check().is_ok());
        for wrong in [
            WindowViewsQuestion { directions: 0, ..usual() },
            WindowViewsQuestion { directions: 1_000_000, ..usual() },
            WindowViewsQuestion { spacing: 0.0, ..usual() },
            WindowViewsQuestion { classes: vec![(6, SeenKind::Building), (7, SeenKind::Sky)], ..usual() },
            WindowViewsQuestion { unproven: Some(UnprovenAs::Blocked), ..usual() },
        ] {
            assert!(matches!(wrong.check(), Err(Error::InvalidParameter { .. })), "{wrong:?}");
        }
        let other = WindowViewsQuestion {
            classes: vec![(26, SeenKind::Ground)],
            unproven: Some(UnprovenAs::Visible),
            ..usual()
        };
        assert!(other.check().is_ok());
    }
}
