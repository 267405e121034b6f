//! Parameters of a scene model.

use super::statistics::SurveyStatistics;
use crate::clean::CleanParams;
use crate::medial::{CarvedParams, ShrinkMethod, ShrinkParams};
use crate::normals::estimate::Neighborhood;
use crate::pulses::{FreeSegmentParams, LocateParams, Means};
use crate::strips::StripParams;
use belvedere_data::trajectory::Trajectory;
use belvedere_data::{Frame, Mesh, Result};
use std::sync::Arc;

/// Parameters of a scene model. Belvedere uses [`ModelParams::default`] unless anything else is requested.
///
/// ```
/// use belvedere_core::medial::ShrinkParams;
/// use belvedere_core::model::{BallParams, ModelParams, OrientBy};
///
/// let params = ModelParams::default().with_orient(OrientBy::Up).with_balls(BallParams::Shrunk(ShrinkParams::tau()));
/// assert_eq!(params.balls.name(), "tau");
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ModelParams {
    /// Points to leave out.
    pub clean: CleanParams,
    /// Number of neighbours from which a normal is estimated.
    pub neighborhood: Neighborhood,
    /// Orientation of normals, and source of the scanner position.
    pub orient: OrientBy,
    /// Parameters of the search for the scanner.
    pub locate: LocateParams,
    /// Parameters of free segments.
    pub free_segments: FreeSegmentParams,
    /// Treatment of flight lines whose heights differ. Default: they are fitted to each other.
    pub strips: StripHeights,
    /// Parameters of balls.
    pub balls: BallParams,
    /// Statistics of the survey that the cloud is a part of. Default: none, and the cloud is a whole.
    pub statistics: Option<Arc<SurveyStatistics>>,
}

belvedere_data::setters!(ModelParams {
    with_clean(clean: CleanParams),
    with_neighborhood(neighborhood: Neighborhood),
    with_orient(orient: OrientBy),
    with_locate(locate: LocateParams),
    with_free_segments(free_segments: FreeSegmentParams),
    with_strips(strips: StripHeights),
    with_balls(balls: BallParams),
    with_statistics(statistics: Option<Arc<SurveyStatistics>>),
});

/// Treatment of flight lines whose heights differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StripHeights {
    /// They are fitted to each other where they differ beyond the tolerance.
    Fitted(StripParams),
    /// They are compared, and stay.
    Kept(StripParams),
}

impl Default for StripHeights {
    fn default() -> Self {
        Self::Fitted(StripParams::default())
    }
}

impl StripHeights {
    /// Returns the parameters of the comparison of heights.
    #[must_use]
    pub fn params(&self) -> &StripParams {
        match self {
            Self::Fitted(params) | Self::Kept(params) => params,
        }
    }
}

/// Source of the outward side of normals. Sources with a scanner position also give the direction of pulses.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub enum OrientBy {
    /// By pulses if the scanner can be found and the balls are to be carved; otherwise the normals of the cloud;
    /// otherwise towards its scanner positions; otherwise up.
    #[default]
    Auto,
    /// Normals of the cloud.
    Given,
    /// Upward.
    Up,
    /// Towards the scanner positions in the cloud.
    Scanner,
    /// Towards one scanner at this place, in the coordinates of the cloud's file.
    ScannerAt([f64; 3]),
    /// Towards the scanner position of each point, (N, 3), local metres, NaN where it is not known.
    ScannerOfEachPoint(Vec<[f32; 3]>),
    /// Towards the station of each point: point source ids, and positions in the metres of the cloud's reference
    /// system.
    Stations(Vec<(u16, [f64; 3])>),
    /// Towards the scanner's place on this trajectory.
    Trajectory(Trajectory),
    /// Towards where the pulses say that the scanner was.
    Pulses,
    /// Faces of this mesh, in the metres of the cloud's reference system.
    Mesh(Mesh),
}

impl OrientBy {
    /// Returns the means of finding the scanner of a cloud in `frame`, unless it is given for each point.
    #[must_use]
    pub fn means(&self, frame: &Frame) -> Means<'_> {
        match self {
            Self::Trajectory(trajectory) => Means::Trajectory(trajectory),
            Self::ScannerAt(position) => Means::Position(frame.from_file_coordinates(*position)),
            Self::Stations(stations) => Means::Stations(stations),
            Self::Scanner => Means::Poses,
            Self::Pulses => Means::Pulses,
            _ => Means::Automatic,
        }
    }
}

/// Construction of balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallParams {
    /// Points alone.
    Shrunk(ShrinkParams),
    /// Points and pulses. Building fails if the scanner is not known.
    Carved(CarvedParams),
    /// Points and pulses, or the points alone if pulses cannot carve: they are only assumed, and few.
    CarvedIfPossible(CarvedParams, ShrinkParams),
}

impl Default for BallParams {
    fn default() -> Self {
        Self::CarvedIfPossible(CarvedParams::default(), ShrinkParams::tau_by_spacing())
    }
}

/// Need for pulses.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Carving {
    /// Carving, or building fails.
    Wanted,
    /// Carving, if they can.
    IfPossible,
    /// No need.
    Unwanted,
}

impl BallParams {
    pub(super) fn carving(&self) -> Carving {
        match self {
            Self::Shrunk(_) => Carving::Unwanted,
            Self::Carved(_) => Carving::Wanted,
            Self::CarvedIfPossible(..) => Carving::IfPossible,
        }
    }

    /// Returns true if points that are carved are moved onto their surface first.
    pub(super) fn smooths(&self) -> bool {
        matches!(self, Self::Carved(carved) | Self::CarvedIfPossible(carved, _) if carved.smoothing.is_some())
    }

    /// Checks the parameters of shrinking, before a cloud is there.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) for the first that is out of its range.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Shrunk(shrunk) => shrunk.check(),
            Self::Carved(carved) => carved.shrinking().check(),
            Self::CarvedIfPossible(carved, shrunk) => carved.shrinking().check().and_then(|()| shrunk.check()),
        }
    }

    /// Returns the parameters of balls from the points alone, before carving or without it.
    #[must_use]
    pub fn shrinking(&self) -> ShrinkParams {
        match self {
            Self::Shrunk(shrunk) | Self::CarvedIfPossible(_, shrunk) => *shrunk,
            Self::Carved(carved) => carved.shrinking(),
        }
    }

    /// Returns the parameters of balls from the points if these statistics decide whether pulses carve.
    pub(super) fn shrinking_by(&self, statistics: &SurveyStatistics) -> ShrinkParams {
        match self {
            Self::CarvedIfPossible(carved, _) if statistics.carves => carved.shrinking(),
            other => other.shrinking(),
        }
    }

    /// Short name of the method: `carved`, `tau` or `angles`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Carved(_) | Self::CarvedIfPossible(..) => "carved",
            Self::Shrunk(ShrinkParams { method: ShrinkMethod::Tau { .. }, .. }) => "tau",
            Self::Shrunk(ShrinkParams { method: ShrinkMethod::Angles { .. }, .. }) => "angles",
        }
    }
}
