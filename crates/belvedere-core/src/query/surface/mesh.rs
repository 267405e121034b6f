//! Mesh targets: how much of each face and of each object a viewer sees.

use super::{Sides, SurfacePiece, SurfacePieces};
use crate::query::{Answer, Viewer};
use belvedere_data::vector::{dot, sub, to_f32};
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Treatment of faces that are turned away from the viewer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum BackFaces {
    /// They count as not visible: shares are those of the whole surface.
    #[default]
    NotVisible,
    /// They are not counted: shares are those of the faces turned to the viewer.
    LeftOut,
    /// They are queried as any other: for open surfaces and meshes whose triangles do not know their outside.
    BothSides,
}

/// Parameters of visibility queries for faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshTargetParams {
    /// Treatment of faces turned away from the viewer. Default: not visible.
    pub back_faces: BackFaces,
    /// Distance between a face and its target, on the side of the viewer, metres, 0 or more. Default 0.1: balls stand
    /// out by about as much where no pulse reached. On a simulated town this reduces the false-blocked share of facades
    /// in the sun from 15.7 to 9.6 %. The error of a building's share falls from 0.10 to 0.05. The false-visible share
    /// grows by a point on facades and three on roofs.
    pub lift: f64,
}

impl Default for MeshTargetParams {
    fn default() -> Self {
        Self { back_faces: BackFaces::default(), lift: 0.1 }
    }
}

impl MeshTargetParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a lift that is not finite or below zero.
    pub fn validate(&self) -> Result<()> {
        if !(self.lift >= 0.0 && self.lift.is_finite()) {
            return Err(Error::invalid(Parameter::SampleOffset, self.lift, "0 metres or more"));
        }
        Ok(())
    }
}

/// Visible area of a face, of an object, or of a set of them, m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeenArea {
    /// Area that counts; 0 where [`BackFaces::LeftOut`] leaves all of it out.
    pub area: f64,
    /// Visible part of it, m².
    pub visible: f64,
    /// Unproven part of it, m²: nothing blocks it, and it is not part of `visible`.
    pub unproven: f64,
    /// Square of the standard error of `visible`, m⁴.
    pub variance: f64,
}

impl SeenArea {
    /// Share of the area that is seen, 0 to 1; NaN without area.
    #[must_use]
    pub fn visible_share(&self) -> f64 {
        self.visible / self.area
    }

    /// Standard error of the visible area by sampling, m². Errors of the balls are not included.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.variance.sqrt()
    }

    fn add(&mut self, other: &Self) {
        self.area += other.area;
        self.visible += other.visible;
        self.unproven += other.unproven;
        self.variance += other.variance;
    }
}

impl SurfacePiece {
    /// Any vector from the plane of the piece to a common viewer.
    fn towards(&self, viewer: Viewer<'_>) -> [f64; 3] {
        match viewer {
            Viewer::Direction(direction) => direction,
            Viewer::Eye(eye) => sub(eye, self.corners[0].map(f64::from)),
            Viewer::Each(_) => [0.0; 3],
        }
    }

    /// The place moved `lift` metres off the plane of the piece to the side of a common viewer, local metres.
    #[must_use]
    pub fn lifted(&self, viewer: Viewer<'_>, lift: f64) -> [f32; 3] {
        self.lifted_along_normal(if self.is_before(viewer) { lift } else { -lift })
    }

    /// Returns true if the viewer is on the side that the normal points to, or edge-on.
    #[must_use]
    pub fn is_before(&self, viewer: Viewer<'_>) -> bool {
        !(dot(self.normal.map(f64::from), self.towards(viewer)) < 0.0)
    }

    /// The place moved by `lift` metres along the normal, local metres.
    #[must_use]
    pub fn lifted_along_normal(&self, lift: f64) -> [f32; 3] {
        std::array::from_fn(|i| to_f32(f64::from(self.place[i]) + lift * f64::from(self.normal[i])))
    }
}

/// Flags the pieces of `surface` that are turned to `viewer`. Pieces seen exactly edge-on are not; those of a surface
/// without a known outside all are.
///
/// # Errors
/// [`Error::UnsupportedViewer`] for [`Viewer::Each`], and those of [`Viewer::validate`].
pub fn facing(surface: &SurfacePieces, viewer: Viewer<'_>) -> Result<Vec<bool>> {
    viewer.validate()?;
    let turned = |piece: &SurfacePiece| dot(piece.normal.map(f64::from), piece.towards(viewer)) > 0.0;
    match (surface.sides, viewer) {
        (_, Viewer::Each(_)) => {
            Err(Error::UnsupportedViewer { method: "a surface", what: "from one eye or along one direction" })
        }
        (Sides::Both, _) => Ok(vec![true; surface.pieces.len()]),
        (Sides::Known, _) => Ok(surface.pieces.iter().map(turned).collect()),
    }
}

/// Returns the area of each face of `surface` that `viewer` sees, (faces). `ask` answers for places, (M, 3) local
/// metres, such as [`crate::query::Visibility::visible`] for the same viewer. Answers other than [`Answer::Visible`] or
/// [`Answer::Unproven`] count as not visible.
///
/// Each piece counts as its place does. The standard error of a face follows from pairs of neighbouring pieces that
/// differ (collapsed strata), and tends to be too large. A face of one piece has the greatest possible error, half its
/// area. Areas and squared errors of faces add up to those of objects.
///
/// # Errors
/// Those of [`facing`], of [`MeshTargetParams::validate`] and of `ask`, and [`Error::LengthMismatch`] where it answers
/// for another number of places.
///
/// # Source
/// Cochran 1977, Sampling Techniques, section 5A.12 (one unit per stratum).
pub fn seen_faces(
    surface: &SurfacePieces,
    viewer: Viewer<'_>,
    params: &MeshTargetParams,
    ask: impl FnOnce(&[[f32; 3]]) -> Result<Vec<Answer>>,
) -> Result<Vec<SeenArea>> {
    params.validate()?;
    let back_faces = params.back_faces;
    let turned = facing(surface, viewer)?;
    let facing = if back_faces == BackFaces::BothSides { vec![true; turned.len()] } else { turned };
    let queried: Vec<usize> = (0..surface.pieces.len()).filter(|&row| facing[row]).collect();
    let places: Vec<[f32; 3]> = queried.iter().map(|&row| surface.pieces[row].lifted(viewer, params.lift)).collect();
    let given = ask(&places)?;
    if given.len() != places.len() {
        return Err(Error::LengthMismatch { what: "answers", expected: places.len(), found: given.len() });
    }
    let mut answers = vec![Answer::Blocked; surface.pieces.len()];
    for (&row, answer) in queried.iter().zip(given) {
        answers[row] = answer;
    }
    let mut faces = vec![SeenArea::default(); surface.face_count];
    let mut row = 0;
    for group in surface.pieces.chunk_by(|a, b| a.face == b.face) {
        let answers = &answers[row..row + group.len()];
        let is_facing = facing[row];
        row += group.len();
        let Some(face) = group.first().and_then(|piece| faces.get_mut(piece.face as usize)) else { continue };
        if is_facing || back_faces != BackFaces::LeftOut {
            *face = seen_of(group, answers, is_facing);
        }
    }
    Ok(faces)
}

/// Returns the visible area of the pieces of one face.
fn seen_of(pieces: &[SurfacePiece], answers: &[Answer], is_queried: bool) -> SeenArea {
    let mut seen = SeenArea::default();
    for (piece, answer) in pieces.iter().zip(answers) {
        let area = f64::from(piece.area);
        seen.area += area;
        match answer {
            Answer::Visible => seen.visible += area,
            Answer::Unproven => seen.unproven += area,
            _ => {}
        }
    }
    let differ = |a: usize, b: usize| {
        if (answers[a] == Answer::Visible) == (answers[b] == Answer::Visible) {
            return 0.0;
        }
        (f64::from(pieces[a].area).powi(2) + f64::from(pieces[b].area).powi(2)) / 2.0
    };
    let last = pieces.len() - 1;
    seen.variance = match last {
        _ if !is_queried => 0.0,
        0 => seen.area * seen.area / 4.0,
        _ => {
            let pairs: f64 = (0..pieces.len() / 2).map(|pair| differ(2 * pair, 2 * pair + 1)).sum();
            // an odd one is compared with its neighbour, which then counts twice
            pairs + if last.is_multiple_of(2) { differ(last - 1, last) } else { 0.0 }
        }
    };
    seen
}

/// Returns the visible area of each of `count` objects, given the object of each face, (faces); faces of others are
/// left out.
#[must_use]
pub fn seen_objects(faces: &[SeenArea], objects: &[u32], count: usize) -> Vec<SeenArea> {
    let mut seen = vec![SeenArea::default(); count];
    for (face, &object) in faces.iter().zip(objects) {
        if let Some(sum) = seen.get_mut(object as usize) {
            sum.add(face);
        }
    }
    seen
}

/// Returns the visible area of all faces together.
#[must_use]
pub fn seen_in_all(faces: &[SeenArea]) -> SeenArea {
    let mut sum = SeenArea::default();
    faces.iter().for_each(|face| sum.add(face));
    sum
}
