//! A survey that does not fit into memory, as a scene of questions: the few ways to look at it part by part.

use crate::rows::ObstacleParts;
use crate::tree_light::CrownLight;
use crate::viewshed::{Observer, SeenProbabilities, Viewshed, ViewshedParams};
use belvedere_core::ground::{GroundPoints, MapGrid};
use belvedere_core::query::Certainty;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use std::sync::Arc;

/// Obstacles of a survey of any size around the targets of a question. Only parts of them are in memory at a time.
pub trait SurveyParts: Send + Sync {
    /// Returns the transmissivity of crowns; `None` if trees are opaque.
    fn crowns(&self) -> Option<CrownLight>;

    /// Returns true if measured pulses from the air prove lines of sight free.
    fn proves(&self) -> bool;

    /// Returns the kind of points that show the ground all over the survey.
    fn ground_points(&self) -> GroundPoints;

    /// Returns the points that show the ground of a grid, and what covers it.
    ///
    /// # Errors
    /// Those of reading the points, and [`Error::InvalidParameter`] for a grid with more points than fit into memory.
    fn points_over(&self, grid: &MapGrid, control: &Control<'_>) -> Result<Arc<PointCloud>>;

    /// Returns the obstacles to light from `directions`, (D, 3) unit vectors, to `targets`, (M, 3) local metres.
    ///
    /// # Errors
    /// Those of reading the parts.
    fn light(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<Box<dyn ObstacleParts>>;

    /// Returns the visibility of each of `targets`, (M, 3) local metres, from `observers`.
    ///
    /// # Errors
    /// Those of [`viewshed`](crate::viewshed::viewshed) and of reading the parts.
    fn viewshed(
        &self,
        looks: &Looks<'_>,
        targets: &[[f32; 3]],
        params: &ViewshedParams,
        control: &Control<'_>,
    ) -> Result<Viewshed>;

    /// Returns the probability that `observers` see each of `targets`, (M, 3) local metres.
    ///
    /// # Errors
    /// Those of [`seen_probabilities`](crate::viewshed::seen_probabilities) and of reading the parts.
    fn seen_probabilities(
        &self,
        looks: &Looks<'_>,
        targets: &[[f32; 3]],
        certainty: Option<Certainty>,
        control: &Control<'_>,
    ) -> Result<SeenProbabilities>;
}

/// Observers of a viewshed.
#[derive(Clone, Copy)]
pub struct Looks<'a> {
    /// Their eyes and limits. Eyes inside obstacles see nothing, except in a reverse viewshed.
    pub observers: &'a [Observer],
    /// True for a reverse viewshed, whose eye is a target.
    pub is_reverse: bool,
}

/// Returns the error of a question that needs all of a survey in memory.
pub(super) fn needs_whole() -> Error {
    let expected = "one that tiles answer, or a smaller part of the survey, or more memory";
    Error::invalid(Parameter::Questions, "one that needs all of a survey in memory", expected)
}
