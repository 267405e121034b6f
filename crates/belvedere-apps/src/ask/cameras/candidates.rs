//! Positions of cameras.

use super::site::CameraSite;
use crate::ask::cells::GridCells;
use crate::ask::context::Context;
use crate::ask::observers::skip_unfit;
use crate::ask::standing::Reach;
use crate::cameras::{Mount, ground_places, roof_places};
use crate::eyes::{EyesReport, skip_unfit_eyes};
use crate::targets::set_on_ground;
use belvedere_core::ground::{Ground, GroundPoints};
use belvedere_data::Result;
use belvedere_data::control::Control;
use serde::{Deserialize, Serialize};

/// Side of the cells that cameras stand in unless said otherwise, metres.
const SPACING: f64 = 5.0;

/// Possible positions of cameras.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Candidates {
    /// Above the ground, in the middle of each cell of this side, metres. Default: 5.
    Ground(f64),
    /// Above roofs, in the middle of each cell of this side, metres.
    Roofs(f64),
    /// Given positions.
    #[serde(skip)]
    Given(Vec<GivenCamera>),
}

impl Default for Candidates {
    fn default() -> Self {
        Self::Ground(SPACING)
    }
}

/// A place for cameras, with the settings given for it; the others are as in [`CameraLens`](super::CameraLens).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GivenCamera {
    /// Local metres; the height is NaN where it follows from the ground.
    pub place: [f64; 3],
    /// Height above the ground, metres; `None` for that of the question.
    pub height: Option<f64>,
    /// The only heading, degrees clockwise from the north of the question.
    pub heading_deg: Option<f64>,
    /// The only angle below the horizon, degrees.
    pub tilt_deg: Option<f64>,
    /// Horizontal field of view, degrees.
    pub fov_deg: Option<f64>,
    /// Minimum and maximum horizontal distance, metres.
    pub distance: [Option<f64>; 2],
    /// Azimuths that it can be turned to, degrees.
    pub azimuth_deg: Option<[f64; 2]>,
    /// Elevations that it can be tilted to, degrees.
    pub elevation_deg: Option<[f64; 2]>,
    /// The number of the line that it is a place on, where there are lines.
    pub line: Option<usize>,
}

impl GivenCamera {
    pub(super) fn mount(&self, eye: [f64; 3], grid_north: f64) -> Mount {
        let in_grid = |azimuth: f64| azimuth.to_radians() - grid_north;
        Mount {
            eye,
            heading: self.heading_deg.map(in_grid),
            tilt: self.tilt_deg.map(f64::to_radians),
            width: self.fov_deg.map(f64::to_radians),
            distance: self.distance,
            azimuth: self.azimuth_deg.map(|range| range.map(in_grid)),
            elevation: self.elevation_deg.map(|range| range.map(f64::to_radians)),
        }
    }
}

impl Candidates {
    /// Returns the eyes of the candidates, and the number that cannot look, which are NaN. Eyes are `height` metres
    /// above the ground or the roof, unless given for one of them.
    pub(in crate::ask) fn eyes(
        &self,
        (height, points): (f64, GroundPoints),
        site: &CameraSite<'_>,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<(Vec<[f64; 3]>, EyesReport)> {
        let cell = match self {
            Self::Given(given) => {
                let (reach, looking) = (Reach::Cloud, (site.blockers, Some(site.ground)));
                let eyes = given_eyes(given, height, site.ground);
                let eyes = skip_unfit(eyes, ("candidate", reach), looking, (site.scene, context), control)?;
                return Ok((eyes.eyes, eyes.report));
            }
            Self::Ground(cell) | Self::Roofs(cell) => *cell,
        };
        let scene = site.scene;
        let cells = GridCells { cell: Some(cell), ..GridCells::default() };
        let known = scene.ground(cells.grid(scene)?, points, control)?;
        let (cloud, ground) = (scene.ground_cloud()?, known.ground.clone());
        let mut eyes = control.stage("finding places for candidates", 0, || match self {
            Self::Roofs(_) => roof_places(cloud, ground, height, control),
            _ => ground_places(cloud, ground, height, control),
        })?;
        // places of a grid are nobody's choice, and nobody is warned of those that do not fit
        let report = control.stage("testing candidates", eyes.len(), || {
            skip_unfit_eyes(site.blockers, Some(site.ground), &mut eyes, control)
        })?;
        Ok((eyes, report))
    }
}

/// Places as they are given, those without a height on the ground.
pub(super) fn given_eyes(given: &[GivenCamera], usual: f64, ground: &Ground) -> Vec<[f64; 3]> {
    let mut eyes: Vec<[f64; 3]> = given.iter().map(|one| one.place).collect();
    let heights = given.iter().map(|one| one.height.unwrap_or(usual));
    set_on_ground(eyes.iter_mut().zip(heights), ground);
    eyes
}
