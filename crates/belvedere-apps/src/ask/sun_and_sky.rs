//! Parts common to questions about sun and sky: targets, obstacles, and light through trees.

use super::context::Context;
use super::places::{Places, test_edge};
use super::remark::Remark;
use super::scene::Scene;
use super::sections::LinesSection;
use super::survey_parts::needs_whole;
use super::trees::ThroughTrees;
use crate::rows::{ObstacleParts, Obstacles, SkyObstacles};
use crate::shadow::{ShadowSun, lit_before_sun, lit_probabilities, unproven_light};
use crate::targets::Targets;
use crate::tree_light::{CrownLight, TreeLight};
use belvedere_core::query::{MedialScene, UnprovenAs};
use belvedere_data::Result;
use belvedere_data::control::Control;
use std::sync::Arc;

/// Targets, the obstacles of their light, and the share of it that trees let through.
pub(super) struct Light {
    pub(super) targets: Arc<Targets>,
    pub(super) near_edge: Vec<Option<bool>>,
    around: Around,
}

/// Obstacles of the light of targets.
enum Around {
    /// The scene in one piece, with the trees that let a share of the light through.
    Whole(Arc<MedialScene>, Option<TreeLight>),
    /// Part by part.
    InParts(Box<dyn ObstacleParts>),
}

/// Targets of which a question found something.
#[derive(Clone, Debug)]
pub struct OnTargets {
    /// The targets.
    pub targets: Arc<Targets>,
    /// True near the edge of the cloud; `None` if that is not known.
    pub near_edge: Vec<Option<bool>>,
    /// Subject of the answer, for the title of a map.
    pub title: String,
}

/// A warning of single places inside an obstacle, which get no light whatever stands around.
fn remark_on_enclosed(targets: &Targets, blockers: &MedialScene) -> Option<Remark> {
    let places = targets.positions.iter().filter(|place| place[2].is_finite()).map(|place| place.map(f64::from));
    let depths: Vec<f64> = places
        .filter(|place| blockers.is_inside_obstacle(*place))
        .map(|place| blockers.enclosure(place).depth)
        .collect();
    let deepest = depths.iter().copied().fold(0.0, f64::max);
    remark_on_inside(depths.len(), targets, &format!(", up to {deepest:.2} m deep,"))
}

fn remark_on_inside(count: usize, targets: &Targets, how_deep: &str) -> Option<Remark> {
    let so = format!(
        "are inside an obstacle{how_deep} and get no light there: check x, y and the height, or give a place outside"
    );
    Remark::of_share("places-inside-obstacle", count, targets.target_count(), "places", &so)
}

impl Light {
    /// Resolves targets and obstacles for light from `directions`, through trees at a latitude, radians, if a question
    /// has one. Pulses are loaded unless unproven answers count as visible.
    pub(super) fn resolve(
        places: &Places,
        directions: &[[f64; 3]],
        (trees, latitude, unproven): (&ThroughTrees, Option<f64>, UnprovenAs),
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Self> {
        let targets = places.targets(scene, context, control)?;
        let near_edge = test_edge(scene, &targets, directions, context, control)?;
        if let Some(parts) = scene.parts() {
            let upward: Vec<[f64; 3]> = directions.iter().copied().filter(|direction| direction[2] > 0.0).collect();
            let parts = parts.light(&targets.positions, &upward, control)?;
            if matches!(places, Places::At(..)) {
                let inside = parts.are_inside_obstacles(&targets.positions, control)?;
                let count = inside.into_iter().filter(|is_inside| *is_inside).count();
                context.add(remark_on_inside(count, &targets, ""));
            }
            return Ok(Self { targets, near_edge, around: Around::InParts(parts) });
        }
        let blockers = scene.blockers(unproven, control)?;
        if matches!(places, Places::At(..)) {
            context.add(remark_on_enclosed(&targets, &blockers));
        }
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, Some(directions.len())));
        let trees = trees.of((scene, latitude), context, control)?;
        Ok(Self { targets, near_edge, around: Around::Whole(blockers, trees) })
    }

    /// Returns the transmission of crowns; `None` for opaque ones.
    pub(super) fn crowns(&self) -> Option<CrownLight> {
        self.obstacles().crowns()
    }

    pub(super) fn obstacles(&self) -> SkyObstacles<'_> {
        match &self.around {
            Around::Whole(scene, trees) => Obstacles { scene, trees: trees.as_ref() }.into(),
            Around::InParts(parts) => SkyObstacles::InParts(&**parts),
        }
    }

    /// Returns the obstacles in one piece, with the trees that let a share of the light through.
    ///
    /// # Errors
    /// [`needs_whole`] for a survey of which only parts are in memory.
    pub(super) fn whole(&self) -> Result<(&Arc<MedialScene>, Option<&TreeLight>)> {
        match &self.around {
            Around::Whole(blockers, trees) => Ok((blockers, trees.as_ref())),
            Around::InParts(_) => Err(needs_whole()),
        }
    }

    /// Returns 1 for each target that is lit, (M), but unproven, else 0; `None` if pulses are not known or not loaded.
    pub(super) fn unproven(&self, sun: ShadowSun, lit: &[f32], control: &Control<'_>) -> Result<Option<Vec<f32>>> {
        let test = |look: &mut dyn FnMut() -> Result<Option<Vec<f32>>>| control.stage("testing pulses", 0, look);
        match &self.around {
            Around::Whole(blockers, _) if blockers.proof().is_none() => Ok(None),
            Around::Whole(blockers, _) => test(&mut || unproven_light(blockers, &self.targets, sun, lit, control)),
            Around::InParts(parts) => {
                test(&mut || parts.unproven_light(&self.targets.positions, sun.to_sun, lit, control))
            }
        }
    }

    /// Returns the probability that each target is lit by a sun, where `proving` has the pulses of a whole scene.
    pub(super) fn lit_probabilities(
        &self,
        proving: Option<&MedialScene>,
        sun: ShadowSun,
        control: &Control<'_>,
    ) -> Result<Vec<f32>> {
        match (&self.around, proving) {
            (Around::InParts(parts), _) => {
                let found = parts.lit_probabilities(&self.targets.positions, sun.to_sun, sun.season, control)?;
                lit_before_sun(found, &self.targets, sun)
            }
            (Around::Whole(blockers, trees), proving) => {
                lit_probabilities((proving.unwrap_or(blockers), trees.as_ref()), &self.targets, sun, control)
            }
        }
    }

    /// Number of steps of the progress: targets, once or twice each.
    pub(super) fn steps(&self) -> usize {
        self.targets.len() * self.obstacles().matrix_count()
    }

    pub(super) fn titled(self, title: String) -> OnTargets {
        OnTargets { targets: self.targets, near_edge: self.near_edge, title }
    }
}
