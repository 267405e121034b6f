//! View of a landmark, and its parameters.

use belvedere_core::query::{BackFaces, EarthParams, MeshTargetParams, Sides, SurfacePiece, SurfacePieces, UnprovenAs};
use belvedere_data::vector::{dot, sub};
use belvedere_data::{Error, Parameter, Result};

/// Minimum range of a measured piece, metres: a piece that touches the eye would fill half of its view.
pub(super) const NEAREST: f64 = 1e-3;

/// Parameters of views of landmarks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LandmarkParams {
    /// Treatment of its faces. Default: those turned away are not visible, so that shares are those of the whole
    /// landmark.
    pub faces: MeshTargetParams,
    /// Treatment of unproven pieces that nothing blocks. Default: reported apart from the visible.
    pub unproven: UnprovenAs,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Maximum range of pieces that count, metres, above 0. Default: infinite.
    pub max_range: f64,
    /// True to compute the expected visible area; needs pulses. Default: false.
    pub has_expected: bool,
}

belvedere_data::setters!(LandmarkParams {
    with_faces(faces: MeshTargetParams),
    with_unproven(unproven: UnprovenAs),
    with_earth(earth: EarthParams),
    with_max_range(max_range: f64),
    with_expected(has_expected: bool),
});

impl LandmarkParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        self.earth.validate()?;
        self.faces.validate()?;
        if !(self.max_range > 0.0) {
            return Err(Error::invalid(Parameter::MaxDistance, self.max_range, "above zero metres"));
        }
        Ok(())
    }

    /// Returns true if a piece is turned to an eye, or both of its sides count.
    pub(super) fn can_be_seen(&self, landmark: &SurfacePieces, piece: &SurfacePiece, eye: [f64; 3]) -> bool {
        let backs_count = self.faces.back_faces == BackFaces::BothSides || landmark.sides == Sides::Both;
        backs_count || dot(piece.normal.map(f64::from), sub(piece.corners[0].map(f64::from), eye)) < 0.0
    }
}

impl Default for LandmarkParams {
    fn default() -> Self {
        Self {
            faces: MeshTargetParams::default(),
            unproven: UnprovenAs::Reported,
            earth: EarthParams::default(),
            max_range: f64::INFINITY,
            has_expected: false,
        }
    }
}

/// Visible part of a landmark for one observer. Angles are those at the eye; all are 0 if nothing is visible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LandmarkView {
    /// Area seen, m².
    pub visible_area: f64,
    /// Area that nothing blocks but is not proven, m²; not among the visible.
    pub unproven_area: f64,
    /// Area that counts, m²: the whole landmark, or the faces turned to the observer ([`BackFaces::LeftOut`]).
    pub area: f64,
    /// Solid angle of the visible parts, steradians.
    pub solid_angle: f64,
    /// Share of the full circle of azimuths in which some of it is seen, 0 to 1.
    pub horizon_share: f64,
    /// Angle on the map between the outermost visible parts, hidden parts between them included, radians, 0 to 2π.
    pub horizontal_extent: f64,
    /// Elevation of the highest part seen minus that of the lowest, radians, 0 to π.
    pub vertical_extent: f64,
    /// Range of the nearest and of the farthest part seen, metres; `None` where nothing is seen.
    pub ranges: Option<[f64; 2]>,
    /// Expected area seen, m², from the probability of each part; `None` if probabilities were not required.
    pub expected_area: Option<f64>,
}

impl LandmarkView {
    /// Share of the area that is seen, 0 to 1; NaN without area.
    #[must_use]
    pub fn visible_share(&self) -> f64 {
        self.visible_area / self.area
    }
}
