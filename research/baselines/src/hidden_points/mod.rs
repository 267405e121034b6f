//! Hidden point removal: which points of a cloud an eye sees, without any surface.

mod flip;
mod hull;
mod radius;

use std::collections::HashMap;
use std::sync::OnceLock;

use belvedere::query::{Answer, Sight, Viewer, Visibility};
use belvedere::{Error, Parameter, Result};

use crate::MethodInput;
use flip::FlippedView;
pub use radius::RadiusChoice;

/// How far away the eye of a direction is put, in diagonals of the cloud: lines of sight then differ by at most 1/400
/// rad = 0.14° from parallel, less than the 0.27° that the sun is in radius, and the flipped coordinates, some 1e12 m,
/// still hold a tenth of a millimetre.
const FAR_EYE_DIAGONALS: f64 = 200.0;

/// Highest elevation of the direction that another one from above is compared with, radians: two that both come from
/// near the zenith see the same points.
const HIGHEST_OPPOSITE: f64 = std::f64::consts::FRAC_PI_3;

/// How the radius of the sphere is chosen, as the exponent γ of R = 10^γ · range of the farthest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlipRadius {
    /// Katz's rule: the radius that makes most points visible from exactly one of two opposite viewpoints.
    OppositeViews,
    /// This exponent, 0 to 10; the larger, the more points are visible.
    Exponent(f64),
}

/// What becomes of targets that are no points of the cloud.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForeignTargets {
    /// [`Error::UnsupportedTargets`]: the method as published knows only the points of the cloud.
    Refuse,
    /// Each is put into the cloud alone, as if it had been scanned.
    Insert,
}

/// How [`HiddenPoints`] decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenPointsParams {
    /// Radius of the sphere. Default: by Katz's rule, for each view.
    pub radius: FlipRadius,
    /// Bound of the noise along a line of sight, metres, 0 to 10. 0 is the operator of Katz, more that of Mehra: a
    /// point whose image lies no deeper than twice the bound below the hull counts as visible. Default 0.
    pub noise: f64,
    /// Targets that are no points of the cloud. Default: refused.
    pub foreign_targets: ForeignTargets,
}

impl Default for HiddenPointsParams {
    fn default() -> Self {
        Self { radius: FlipRadius::OppositeViews, noise: 0.0, foreign_targets: ForeignTargets::Refuse }
    }
}

/// Hidden point removal on the points of a cloud.
///
/// Every point moves along its ray from the eye to the other side of a sphere that holds the whole cloud; those that
/// become corners of the convex hull of all images and the eye are visible. Two points at the same place get the same
/// answer, a point at the eye is visible, and a target that is not finite gets [`Answer::OutsideView`].
///
/// Answers do not depend on the order of the points, nor on the number of threads.
///
/// # Source
/// Katz, Tal & Basri 2007, sections 3 and 4. Noise: after Mehra, Tripathi, Sheffer & Mitra 2010.
pub struct HiddenPoints<'a> {
    positions: &'a [[f32; 3]],
    params: HiddenPointsParams,
    rows: OnceLock<HashMap<[u32; 3], u32>>,
}

impl<'a> HiddenPoints<'a> {
    /// The method on the cloud of `survey`; nothing is computed yet.
    ///
    /// # Errors
    /// [`Error::NoPoints`], [`Error::InvalidParameter`] for a parameter outside its range, a position that is not
    /// finite, and more than 2^30 points.
    pub fn new(survey: &MethodInput<'a>, params: HiddenPointsParams) -> Result<Self> {
        survey.cloud.validate()?;
        if survey.cloud.is_empty() {
            return Err(Error::NoPoints { what: "hidden point removal needs the points of a cloud".to_owned() });
        }
        if survey.cloud.len() > hull::MAX_POINTS {
            return Err(invalid("number of points", survey.cloud.len(), "at most 2^30"));
        }
        if !(0.0..=10.0).contains(&params.noise) {
            return Err(invalid("noise bound", params.noise, "0 to 10 m"));
        }
        if let FlipRadius::Exponent(exponent) = params.radius
            && !(0.0..=10.0).contains(&exponent)
        {
            return Err(invalid("exponent of the flip radius", exponent, "0 to 10"));
        }
        Ok(Self { positions: &survey.cloud.positions, params, rows: OnceLock::new() })
    }

    /// Where the eye of `viewer` is, local metres, and the viewpoint opposite it that Katz's rule compares with.
    ///
    /// For an eye that is its image in the centre of the cloud. For a direction from above it is the same elevation, at
    /// most [`HIGHEST_OPPOSITE`], in the opposite azimuth: seen from straight below, all the ground would be visible,
    /// from both sides, and the rule would take a radius ten times too small.
    fn viewpoints(&self, viewer: Viewer<'_>) -> Result<[[f64; 3]; 2]> {
        viewer.validate()?;
        let (centre, diagonal) = radius::extent(self.positions);
        match viewer {
            Viewer::Eye(eye) => Ok([eye, std::array::from_fn(|i| 2.0 * centre[i] - eye[i])]),
            Viewer::Direction(direction) => {
                let unit = belvedere::vector::unit(direction).unwrap_or_default();
                let far = |unit: [f64; 3]| -> [f64; 3] {
                    std::array::from_fn(|i| centre[i] + FAR_EYE_DIAGONALS * diagonal.max(1.0) * unit[i])
                };
                Ok([far(unit), far(opposite_direction(unit))])
            }
            Viewer::Each(_) => Err(Error::UnsupportedViewer {
                method: "hidden point removal",
                what: "an eye or a direction that all targets share",
            }),
        }
    }

    /// The exponent that Katz's rule gives for `viewer`, and what was tried.
    ///
    /// # Errors
    /// As [`Visibility::seen_from`].
    pub fn choose_radius(&self, viewer: Viewer<'_>) -> Result<RadiusChoice> {
        Ok(radius::by_opposite_views(self.positions, self.viewpoints(viewer)?))
    }

    /// The answer for each point of the cloud, and what answers for others.
    fn view(&self, viewer: Viewer<'_>) -> Result<(FlippedView, Vec<bool>)> {
        let viewpoints = self.viewpoints(viewer)?;
        let exponent = match self.params.radius {
            FlipRadius::Exponent(exponent) => exponent,
            FlipRadius::OppositeViews => radius::by_opposite_views(self.positions, viewpoints).exponent,
        };
        let view = FlippedView::new(self.positions, viewpoints[0], exponent);
        let mut visible = view.corners(self.positions);
        if let Some(tolerance) = self.tolerance() {
            let within = view.outside(self.positions, Some(tolerance));
            visible.iter_mut().zip(within).for_each(|(visible, within)| *visible |= within);
        }
        Ok((view, visible))
    }

    /// How far below the hull an image may lie, metres: the point may be too far by the bound, and those that make the
    /// hull too near by it. Flipping keeps lengths along the ray, so the radius does not enter.
    fn tolerance(&self) -> Option<f64> {
        (self.params.noise > 0.0).then_some(2.0 * self.params.noise)
    }

    /// For each target the point of the cloud at exactly its place.
    fn own_rows(&self, targets: &[[f32; 3]]) -> Vec<Option<u32>> {
        if targets == self.positions {
            return (0..).take(targets.len()).map(Some).collect();
        }
        let rows = self.rows.get_or_init(|| self.positions.iter().map(|&p| place(p)).zip(0..).collect());
        targets.iter().map(|&t| rows.get(&place(t)).copied()).collect()
    }
}

impl Visibility for HiddenPoints<'_> {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        let (view, visible) = self.view(viewer)?;
        Ok(Box::new(move |targets| {
            let own = self.own_rows(targets);
            let is_foreign = |row: usize| own[row].is_none() && targets[row].iter().all(|v| v.is_finite());
            let foreign: Vec<usize> = (0..targets.len()).filter(|&row| is_foreign(row)).collect();
            if !foreign.is_empty() && self.params.foreign_targets == ForeignTargets::Refuse {
                return Err(Error::UnsupportedTargets {
                    method: "hidden point removal",
                    what: "points of the cloud itself; use ForeignTargets::Insert for others",
                });
            }
            let answer = |visible: bool| if visible { Answer::Visible } else { Answer::Blocked };
            let own_answer = |row: &Option<u32>| row.and_then(|row| visible.get(row as usize)).map(|&v| answer(v));
            let mut answers: Vec<Answer> =
                own.iter().map(|row| own_answer(row).unwrap_or(Answer::OutsideView)).collect();
            let places: Vec<[f32; 3]> = foreign.iter().map(|&row| targets[row]).collect();
            for (row, outside) in foreign.into_iter().zip(view.outside(&places, self.tolerance())) {
                answers[row] = answer(outside);
            }
            Ok(answers)
        }))
    }
}

/// The direction that Katz's rule compares `unit` with.
fn opposite_direction(unit: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = unit;
    if z <= 0.0 {
        return [-x, -y, -z];
    }
    let elevation = z.atan2(x.hypot(y)).min(HIGHEST_OPPOSITE);
    let (sin, cos) = (-y).atan2(-x).sin_cos();
    [elevation.cos() * cos, elevation.cos() * sin, elevation.sin()]
}

/// A place as a key: −0 and 0 are the same.
fn place(p: [f32; 3]) -> [u32; 3] {
    p.map(|v| (v + 0.0).to_bits())
}

fn invalid(what: &str, value: impl std::fmt::Display, expected: &'static str) -> Error {
    Error::InvalidParameter { parameter: Parameter::MethodSetting, value: format!("{value} for the {what}"), expected }
}
