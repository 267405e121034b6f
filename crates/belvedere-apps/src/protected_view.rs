//! Protected views: how high one may build without entering the view of something from where it is seen today.

use crate::landmark::LandmarkParams;
use crate::solar_envelope::ConvexPolygon;
use belvedere_core::ground::{Ground, MapGrid};
use belvedere_core::query::{Answer, BackFaces, MedialScene, Sides, SurfacePiece, SurfacePieces, Viewer};
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{dot, length, sub, to_f32};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::Serialize;

/// Rows of cells that a thread lowers at once.
const BAND: usize = 16;
/// A face whose area on the map is below this share of the square of its longest side stands upright: its neighbours
/// bound the cells below it.
const THINNEST: f64 = 1e-9;

/// Protected lines of the view from one place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ViewpointReport {
    /// Pieces of the object whose lines of sight are free today; these are protected.
    pub lines_protected: usize,
    /// Number of protected lines that are not proven.
    pub lines_unproven: usize,
    /// Pieces that something hides, which are not protected.
    pub lines_blocked: usize,
    /// Pieces that are turned away from the viewpoint or too far from it.
    pub lines_not_tested: usize,
}

/// Height limits that protect a view.
#[derive(Clone, Debug, PartialEq)]
pub struct ProtectedView {
    /// Lowest height of the protected views over each cell, local metres; NaN where none passes.
    pub limits: Raster<f32>,
    /// Report for each viewpoint.
    pub viewpoints: Vec<ViewpointReport>,
}

impl ProtectedView {
    /// The limits above the ground of the same cells, metres, 0 where a view passes below it; NaN where no view passes
    /// and where no ground is known.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for a ground of other cells.
    pub fn above_ground(&self, ground: &Ground) -> Result<Raster<f32>> {
        let (limits, heights) = (self.limits.values(), ground.heights.values());
        check_length("cells of the ground", limits.len(), heights.len())?;
        let above = |(limit, height): (&f32, &f32)| match limit - height {
            room if room.is_nan() => f32::NAN,
            room => room.max(0.0),
        };
        Raster::from_values(self.limits.width(), self.limits.height(), limits.iter().zip(heights).map(above).collect())
    }
}

/// Computes the height limit of each cell of `grid` that protects the view of `object` from all `eyes`, local metres;
/// an eye that is not finite looks at nothing.
///
/// Each piece of the object that is visible today is protected as a whole: the pyramid from the eye over its three
/// corners stays free. The limit of a cell is the lowest height of all pyramids over its whole square, in closed form.
/// Buildings below it on every cell therefore enter none. Hidden pieces are not protected. Unproven lines count by
/// `params.unproven`; those that are reported are protected. Lines of sight are straight: the curvature of the earth is
/// not in the limits. Progress counts eyes.
///
/// # Errors
/// [`Error::InvalidParameter`] for a range that is not above zero, and [`Error::Cancelled`].
///
/// # Source
/// Protected vistas as planning has them (Greater London Authority 2012, London View Management Framework); the
/// pyramids and their limit over cells are this project's.
pub fn protected_view(
    scene: &MedialScene,
    object: &SurfacePieces,
    eyes: &[[f64; 3]],
    grid: &MapGrid,
    params: &LandmarkParams,
    control: &Control<'_>,
) -> Result<ProtectedView> {
    if !(params.max_range > 0.0) {
        return Err(Error::invalid(Parameter::MaxDistance, params.max_range, "above zero metres"));
    }
    let mut limits = vec![f64::INFINITY; grid.len()];
    let mut viewpoints = Vec::with_capacity(eyes.len());
    for &eye in eyes {
        control.check()?;
        let (faces, report) = protected_faces(scene, object, eye, params, control)?;
        lower(&mut limits, grid, &faces, control)?;
        viewpoints.push(report);
        control.advance(1);
    }
    let limits = limits.into_iter().map(|limit| if limit < f64::INFINITY { to_f32(limit) } else { f32::NAN }).collect();
    Ok(ProtectedView { limits: Raster::from_values(grid.width, grid.height, limits)?, viewpoints })
}

/// A triangle in space, local metres.
type FaceCorners = [[f64; 3]; 3];

/// The faces of the pyramids from an eye over the pieces that it sees.
fn protected_faces(
    scene: &MedialScene,
    object: &SurfacePieces,
    eye: [f64; 3],
    params: &LandmarkParams,
    control: &Control<'_>,
) -> Result<(Vec<FaceCorners>, ViewpointReport)> {
    let answer = |piece: &SurfacePiece| {
        control.check()?;
        let is_turned_away = object.sides == Sides::Known
            && params.faces.back_faces != BackFaces::BothSides
            && !(dot(piece.normal.map(f64::from), sub(eye, piece.corners[0].map(f64::from))) > 0.0);
        let place = piece.lifted(Viewer::Eye(eye), params.faces.lift).map(f64::from);
        // an eye that is not finite has no range
        if is_turned_away || !(length(sub(place, eye)) <= params.max_range) {
            return Ok(Answer::OutsideView);
        }
        Ok(params.unproven.settle(scene.sight_answer(eye, place, &params.earth)))
    };
    let answers: Vec<Answer> = object.pieces.par_iter().map(answer).collect::<Result<_>>()?;
    let (mut faces, mut report) = (Vec::new(), ViewpointReport::default());
    for (piece, answer) in object.pieces.iter().zip(answers) {
        match answer {
            Answer::Visible | Answer::Unproven => {
                let [a, b, c] = piece.corners.map(|corner| corner.map(f64::from));
                faces.extend([[eye, a, b], [eye, b, c], [eye, c, a], [a, b, c]]);
                report.lines_protected += 1;
                report.lines_unproven += usize::from(answer == Answer::Unproven);
            }
            Answer::Blocked => report.lines_blocked += 1,
            _ => report.lines_not_tested += 1,
        }
    }
    Ok((faces, report))
}

/// Lowers the limit of every cell below `faces` to them.
fn lower(limits: &mut [f64], grid: &MapGrid, faces: &[FaceCorners], control: &Control<'_>) -> Result<()> {
    let slopes: Vec<Slope> = faces.iter().filter_map(Slope::new).collect();
    limits.par_chunks_mut(BAND * grid.width.max(1)).enumerate().try_for_each(|(band, limits)| {
        control.check()?;
        let first = band * BAND;
        for slope in &slopes {
            slope.lower(limits, grid, first);
        }
        Ok(())
    })
}

/// A face as a height over the map.
struct Slope {
    shape: ConvexPolygon,
    /// Slope from south to north.
    span: [f64; 2],
    /// Place where `height` is known, and its slope to the east and to the north.
    start: [f64; 2],
    height: f64,
    change: [f64; 2],
    /// Minimum and maximum height of the corners.
    range: [f64; 2],
}

impl Slope {
    fn new(face: &FaceCorners) -> Option<Self> {
        let [a, b, c] = *face;
        let (u, v) = (sub(b, a), sub(c, a));
        let doubled = u[0] * v[1] - u[1] * v[0];
        let longest = [u, v, sub(c, b)].map(|side| side[0].hypot(side[1])).into_iter().fold(0.0, f64::max);
        if !(doubled.abs() > THINNEST * longest * longest) {
            return None;
        }
        let change = [(u[2] * v[1] - v[2] * u[1]) / doubled, (v[2] * u[0] - u[2] * v[0]) / doubled];
        let on_map = |p: [f64; 3]| [p[0], p[1]];
        let shape = match doubled > 0.0 {
            true => ConvexPolygon::new(&[a, b, c].map(on_map)),
            false => ConvexPolygon::new(&[a, c, b].map(on_map)),
        };
        let heights = [a[2], b[2], c[2]];
        let range =
            [heights.into_iter().fold(f64::INFINITY, f64::min), heights.into_iter().fold(f64::NEG_INFINITY, f64::max)];
        Some(Self { shape, span: shape.span(1), start: on_map(a), height: a[2], change, range })
    }

    /// Height over a place of its shape.
    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let height = self.height + self.change[0] * (x - self.start[0]) + self.change[1] * (y - self.start[1]);
        // rounding must not take a steep face beyond its corners
        height.clamp(self.range[0], self.range[1])
    }

    /// Lowers `limits`, whole rows of `grid` from `first` on.
    fn lower(&self, limits: &mut [f64], grid: &MapGrid, first: usize) {
        let north_of = |row: usize| grid.corner_at([0, row])[1];
        let (south, north) = self.span.into();
        let rows = limits.len() / grid.width.max(1);
        if south > north_of(first) || north < north_of(first + rows) {
            return;
        }
        let at = |value: f64, max: usize| to_index(value).min(max);
        let from = at((grid.corner[1] - north) / grid.cell - first as f64, rows);
        let to = at(((grid.corner[1] - south) / grid.cell - first as f64).floor() + 1.0, rows);
        for row in from..to {
            let (low, high) = (north_of(first + row + 1), north_of(first + row));
            let strip = self.shape.clipped(|p| p[1] - low).clipped(|p| high - p[1]);
            let [west, east] = strip.span(0);
            let begin = at((west - grid.corner[0]) / grid.cell, grid.width);
            let end = at(((east - grid.corner[0]) / grid.cell).floor() + 1.0, grid.width);
            for column in begin..end {
                let [left, right] = [column, column + 1].map(|column| grid.corner_at([column, 0])[0]);
                let part = strip.clipped(|p| p[0] - left).clipped(|p| right - p[0]);
                let lowest = part.corners().iter().map(|&place| self.at(place)).fold(f64::INFINITY, f64::min);
                let limit = &mut limits[row * grid.width + column];
                *limit = limit.min(lowest);
            }
        }
    }
}
