//! Targets of cameras, and places that must stay private.

use super::site::CameraSite;
use crate::ask::cells::GridCells;
use crate::ask::context::Context;
use crate::ask::places::{Places, leave_out_outside};
use crate::ask::standing::{Reach, Standing};
use crate::cameras::{CAMERA_TARGET_HEIGHT, WeightedArea, keep_within};
use crate::targets::{Targets, set_on_ground};
use belvedere_core::ground::GroundPoints;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Targets of cameras beside [`Places`], and places that must stay private.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct CameraTargets {
    /// Height of cells, and of points without a height, above the ground, metres. Default 1.5.
    pub height: f64,
    /// Source of ground points.
    #[serde(skip)]
    pub ground: GroundPoints,
    /// Points that may stand on the ground, in place of [`Places`].
    #[serde(skip)]
    pub points: Vec<Standing>,
    /// Weight of each point, 0 or more; empty for equal weights.
    #[serde(skip)]
    pub weights: Vec<f64>,
    /// Areas on the map: cells beside them are no targets. Empty for all cells.
    #[serde(skip)]
    pub areas: Vec<WeightedArea>,
    /// Places that no camera may have in its picture.
    #[serde(skip)]
    pub private: PrivatePlaces,
}

/// Places that no camera may have in its picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PrivatePlaces {
    /// None. Default.
    #[default]
    Nowhere,
    /// Points, which may stand on the ground.
    Points(Vec<Standing>),
    /// The cells in areas on the map.
    Areas(Vec<WeightedArea>),
}

impl Default for CameraTargets {
    fn default() -> Self {
        Self {
            height: CAMERA_TARGET_HEIGHT,
            ground: GroundPoints::Auto,
            points: Vec::new(),
            weights: Vec::new(),
            areas: Vec::new(),
            private: PrivatePlaces::Nowhere,
        }
    }
}

impl CameraTargets {
    pub(super) fn check(&self) -> Result<()> {
        let weights = self.weights.iter().copied().chain(self.areas.iter().map(|area| area.weight));
        match weights.into_iter().find(|weight| !(*weight >= 0.0 && weight.is_finite())) {
            Some(weight) => Err(Error::invalid(Parameter::TargetWeight, weight, "a number, 0 or more")),
            None => Ok(()),
        }
    }

    /// The targets of a scene, `cells` where they are that.
    pub(super) fn of(
        &self,
        (places, cells): (&Places, &GridCells),
        site: &CameraSite<'_>,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Targets> {
        let mut targets = match places {
            _ if !self.points.is_empty() => {
                let mut targets = self.on_ground(&self.points, site);
                leave_out_outside(&mut targets, Reach::Cloud, site.scene, context);
                targets
            }
            Places::Cells(_) => {
                let mut targets = of_cells(cells, &self.areas, site, context, control)?;
                leave_out_outside(&mut targets, Reach::Cloud, site.scene, context);
                targets
            }
            _ => Targets::clone(&*places.targets(site.scene, context, control)?),
        };
        if !self.weights.is_empty() {
            check_length("weights of targets", targets.len(), self.weights.len())?;
            targets.weights.clone_from(&self.weights);
        }
        if targets.target_count() == 0 {
            let what = "are they in the coordinates of the cloud, on known ground?".to_owned();
            return Err(Error::NoObserver { who: "target", what });
        }
        Ok(targets)
    }

    /// The places that no camera may see; `None` where there are none.
    pub(super) fn private_of(
        &self,
        cells: &GridCells,
        site: &CameraSite<'_>,
        control: &Control<'_>,
    ) -> Result<Option<Targets>> {
        let targets = match &self.private {
            PrivatePlaces::Nowhere => return Ok(None),
            PrivatePlaces::Points(points) => self.on_ground(points, site),
            PrivatePlaces::Areas(areas) => of_cells(cells, areas, site, &mut Context::default(), control)?,
        };
        if targets.target_count() == 0 {
            let what = "are they in the coordinates of the cloud, and larger than a cell?".to_owned();
            return Err(Error::NoObserver { who: "private place", what });
        }
        Ok(Some(targets))
    }

    fn on_ground(&self, points: &[Standing], site: &CameraSite<'_>) -> Targets {
        let mut places: Vec<[f64; 3]> = points.iter().map(|point| point.place).collect();
        let heights = points.iter().map(|point| point.height.unwrap_or(self.height));
        set_on_ground(places.iter_mut().zip(heights), site.ground);
        Targets::of_places(&places, site.scene.frame().clone())
    }
}

/// The cells of the ground that are not under a roof; in areas where there are any.
fn of_cells(
    cells: &GridCells,
    areas: &[WeightedArea],
    site: &CameraSite<'_>,
    context: &mut Context,
    control: &Control<'_>,
) -> Result<Targets> {
    let mut targets = Targets::clone(&*Places::Cells(cells.clone()).targets(site.scene, context, control)?);
    if !areas.is_empty() {
        keep_within(&mut targets, areas);
    }
    Ok(targets)
}
