//! Parts common to questions about sun and sky: targets, obstacles, and light through trees.

use super::context::Context;
use super::places::{Places, test_edge};
use super::remark::Remark;
use super::scene::Scene;
use super::sections::LinesSection;
use super::trees::ThroughTrees;
use crate::rows::Obstacles;
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
    pub(super) blockers: Arc<MedialScene>,
    pub(super) trees: Option<TreeLight>,
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
    let so = format!(
        "are inside an obstacle, up to {deepest:.2} m deep, and get no light there: check x, y and the height, or give \
         a place outside"
    );
    Remark::of_share("places-inside-obstacle", depths.len(), targets.target_count(), "places", &so)
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
        let blockers = scene.blockers(unproven, control)?;
        if matches!(places, Places::At(..)) {
            context.add(remark_on_enclosed(&targets, &blockers));
        }
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, Some(directions.len())));
        let trees = trees.of((scene, latitude), context, control)?;
        Ok(Self { targets, near_edge, blockers, trees })
    }

    /// Returns the transmission of crowns; `None` for opaque ones.
    pub(super) fn crowns(&self) -> Option<CrownLight> {
        self.trees.as_ref().map(|trees| trees.crowns)
    }

    pub(super) fn obstacles(&self) -> Obstacles<'_> {
        Obstacles { scene: &self.blockers, trees: self.trees.as_ref() }
    }

    /// Number of steps of the progress: targets, once or twice each.
    pub(super) fn steps(&self) -> usize {
        self.targets.len() * self.obstacles().matrix_count()
    }

    pub(super) fn titled(self, title: String) -> OnTargets {
        OnTargets { targets: self.targets, near_edge: self.near_edge, title }
    }
}
