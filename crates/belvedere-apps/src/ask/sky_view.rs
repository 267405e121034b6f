//! Sky view: how much of the sky places see.

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::how_sure::{check_interval, check_interval_scene};
use super::places::Places;
use super::scene::{Scene, Whereabouts};
use super::sections::{MeasuresSection, PlacesReport};
use super::sun_and_sky::{Light, OnTargets};
use super::trees::{ThroughTrees, remark_on_leaves};
use crate::sky_view::{SKY_DIRECTIONS, SkyDirections, scene_sky_view};
use crate::sum_errors::Intervals;
use crate::targets::Measure;
use belvedere_core::query::UnprovenAs;
use belvedere_data::Result;
use belvedere_data::control::Control;
use serde::{Deserialize, Serialize};

/// Visible part of the sky.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SkyViewQuestion {
    /// The directions of the sky.
    pub sky: SkyParts,
    /// Light through trees.
    pub trees: ThroughTrees,
    /// True to give the expected value and an interval that holds 90 %. Only for opaque trees. Default: false.
    pub interval: bool,
}

/// Division of the sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SkyParts {
    /// Number of directions, evenly spread, 1 to 100 000. Default 577.
    Even(usize),
    /// The middles of 145 patches (Tregenza 1987).
    Tregenza,
    /// The middles of 577 patches (Reinhart 2001).
    Reinhart,
}

impl Default for SkyParts {
    fn default() -> Self {
        Self::Even(SKY_DIRECTIONS)
    }
}

impl SkyParts {
    /// The directions.
    ///
    /// # Errors
    /// Those of [`SkyDirections::even`].
    pub fn directions(self) -> Result<SkyDirections> {
        match self {
            Self::Even(count) => SkyDirections::even(count),
            Self::Tregenza => SkyDirections::patches(1),
            Self::Reinhart => SkyDirections::patches(2),
        }
    }
}

impl Ask for SkyViewQuestion {
    type Found = OnTargets;

    fn check(&self) -> Result<()> {
        check_interval(self.interval, &self.trees)?;
        self.sky.directions().map(|_| ())
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        check_interval_scene(self.interval, scene, control)?;
        let sky = self.sky.directions()?;
        let trees = (&self.trees, None, UnprovenAs::Visible);
        let light = Light::resolve(places, &sky.directions, trees, scene, context, control)?;
        context.add(light.crowns().and_then(|crowns| remark_on_leaves(crowns, crowns.known_factors([None]))));
        let seen = control.stage("testing sky", light.steps(), || {
            scene_sky_view(light.obstacles(), &light.targets, &sky, Intervals::wanted(self.interval), control)
        })?;
        let measures = seen.into_measures();
        context.report.measures = Some(MeasuresSection::of(&light.targets, &measures));
        summarise(&measures, &PlacesReport::in_words(&light.targets), context);
        Ok(Answers::new(light.titled(title(&scene.whereabouts())), measures))
    }
}

pub(super) fn title(whereabouts: &Whereabouts<'_>) -> String {
    format!("Sky view{}", whereabouts.far_in_words())
}

/// Reports the sky seen.
pub(super) fn summarise(measures: &[Measure], places: &str, context: &mut Context) {
    context.headline(format!("sky seen from {places}"));
    for measure in measures {
        context.headline(format!("{}: {}", measure.name.replace('_', " "), spread(&measure.values, 2, "")));
    }
}
