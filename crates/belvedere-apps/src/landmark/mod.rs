//! Landmark visibility: how much of one thing is seen from many places.

mod expected;
mod extent;
mod measures;
mod points;
mod report;
mod view;

pub use measures::{LandmarkMeasure, measures};
pub use points::{LandmarkPoints, landmark_points};
pub use report::{BestView, LandmarkReport};
pub use view::{LandmarkParams, LandmarkView};

use belvedere_core::query::target_tree::TargetTree;
use belvedere_core::query::{Answer, BackFaces, EarthParams, MedialScene, Sides, SurfacePieces, UnprovenAs, Viewer};
use belvedere_data::control::Control;
use belvedere_data::vector::{cross, dot, length, sub, unit};
use belvedere_data::{Error, Result};
use extent::{Arcs, SkyBox, sky_box};
use rayon::prelude::*;
use view::NEAREST;

/// Pieces that a landmark is cut into where nothing is said: a share of it is then known to 1.6 % at worst, mostly to
/// much less.
const USUAL_PIECES: f64 = 1000.0;
/// Minimum default spacing, metres: balls represent walls to about a decimetre.
const MIN_SPACING: f64 = 0.25;

/// Default side of the cells that observers of a grid stand in, metres: a step or two.
const OBSERVER_CELL: f64 = 2.0;
/// Maximum number of cells of a default grid of observers: a thousand lines of sight each take about a minute.
const USUAL_OBSERVERS: f64 = 40_000.0;

/// Returns the side of the cells of a default grid of observers over the box in plan from `low` to `high`, metres: 2,
/// doubled until there are at most 40 000.
#[must_use]
pub fn observer_cell_for(low: [f64; 2], high: [f64; 2]) -> f64 {
    let area = (high[0] - low[0]).max(0.0) * (high[1] - low[1]).max(0.0);
    let mut cell = OBSERVER_CELL;
    while area / (cell * cell) > USUAL_OBSERVERS && cell < 1e9 {
        cell *= 2.0;
    }
    cell
}

/// The spacing at which a surface of `area` m² has about a thousand pieces, metres; 0.25 at least.
#[must_use]
pub fn spacing_for(area: f64) -> f64 {
    // most pieces are half a cell, whose diagonal is the spacing
    (4.0 * area / USUAL_PIECES).sqrt().max(MIN_SPACING)
}

/// Computes the visible part of `landmark` for an eye at `eye`, local metres.
///
/// Each piece counts as its place does; angles and ranges are those of whole pieces, so that they err outward by up to
/// a piece. The solid angle of a piece is exact. Lines of sight are those of [`MedialScene::sight_answer`]: the
/// landmark's own balls hide its far side.
///
/// # Source
/// Measures after Bartie, Reitsma, Kingham & Mills 2010 (Computers, Environment and Urban Systems 34), who took them
/// from rasters of heights. Solid angle of a triangle: Van Oosterom & Strackee 1983.
#[must_use]
pub fn landmark_view(
    scene: &MedialScene,
    landmark: &SurfacePieces,
    eye: [f64; 3],
    params: &LandmarkParams,
) -> LandmarkView {
    measured(landmark, eye, params, |_, place| scene.sight_answer(eye, place, &params.earth))
}

/// Computes the visible part of a landmark for an eye; `answer` returns the answer for the place of a piece, given its
/// row.
fn measured(
    landmark: &SurfacePieces,
    eye: [f64; 3],
    params: &LandmarkParams,
    answer: impl Fn(usize, [f64; 3]) -> Answer,
) -> LandmarkView {
    let mut view = LandmarkView::default();
    let mut arcs = Arcs::default();
    let mut seen: Option<SkyBox> = None;
    for (row, piece) in landmark.pieces.iter().enumerate() {
        let corners = piece.corners.map(|corner| sub(corner.map(f64::from), eye));
        let area = f64::from(piece.area);
        if !params.can_be_seen(landmark, piece, eye) {
            if params.faces.back_faces == BackFaces::NotVisible {
                view.area += area;
            }
            continue;
        }
        view.area += area;
        let place = piece.lifted(Viewer::Eye(eye), params.faces.lift).map(f64::from);
        let range = length(sub(place, eye));
        if !(range <= params.max_range && range > NEAREST) {
            continue;
        }
        match params.unproven.settle(answer(row, place)) {
            Answer::Visible => {}
            Answer::Unproven => {
                view.unproven_area += area;
                continue;
            }
            _ => continue,
        }
        view.visible_area += area;
        view.solid_angle += solid_angle(corners);
        let sky = sky_box(corners, sub(piece.place.map(f64::from), eye));
        arcs.add(sky.azimuths);
        seen = Some(seen.map_or(sky, |seen| seen.union(&sky)));
    }
    if let Some(seen) = seen {
        let (covered, span) = arcs.measure();
        view.horizon_share = covered / std::f64::consts::TAU;
        view.horizontal_extent = span;
        view.vertical_extent = seen.elevations[1] - seen.elevations[0];
        view.ranges = Some(seen.ranges);
    }
    view
}

/// Computes the visible part of `landmark` for each of `eyes`, (N) local metres; control counts eyes. An eye that is
/// not finite sees nothing and has an area of 0.
///
/// # Errors
/// [`Error::NoPoints`] for a landmark without area, [`Error::InvalidParameter`] for parameters outside their range,
/// [`Error::Cancelled`].
pub fn landmark_views(
    scene: &MedialScene,
    landmark: &SurfacePieces,
    eyes: &[[f64; 3]],
    params: &LandmarkParams,
    control: &Control<'_>,
) -> Result<Vec<LandmarkView>> {
    params.validate()?;
    if landmark.pieces.is_empty() {
        return Err(Error::NoPoints { what: "the landmark has no surface".to_owned() });
    }
    let places = LandmarkPieces::new(landmark, params);
    let look = |&eye: &[f64; 3]| {
        control.check()?;
        let mut view = if !eye.iter().all(|v| v.is_finite()) {
            LandmarkView::default()
        } else if places.bend(eye, &params.earth) {
            landmark_view(scene, landmark, eye, params)
        } else {
            let unblocked = places.unblocked_from(scene, landmark, eye, control)?;
            measured(landmark, eye, params, |row, place| match (unblocked[row], params.unproven) {
                (false, _) => Answer::Blocked,
                (true, UnprovenAs::Visible) => Answer::Visible,
                (true, _) => scene.answer_unblocked_from(eye, place),
            })
        };
        if params.has_expected && view.area > 0.0 {
            view.expected_area = expected::area(scene, landmark, eye, params, &view);
        }
        control.advance(1);
        Ok(view)
    };
    eyes.par_iter().map(look).collect()
}

/// Target places of the pieces of a landmark, in trees that are used for all eyes.
struct LandmarkPieces {
    /// For eyes before the face of a piece.
    fronts: TargetTree,
    /// For eyes behind it, where these count.
    backs: TargetTree,
}

impl LandmarkPieces {
    fn new(landmark: &SurfacePieces, params: &LandmarkParams) -> Self {
        let both = params.faces.back_faces == BackFaces::BothSides || landmark.sides == Sides::Both;
        let lifted = |side: f64| -> Vec<[f32; 3]> {
            landmark.pieces.iter().map(|piece| piece.lifted_along_normal(side * params.faces.lift)).collect()
        };
        let backs = if both { lifted(-1.0) } else { Vec::new() };
        Self { fronts: TargetTree::new(&lifted(1.0)), backs: TargetTree::new(&backs) }
    }

    /// Returns true if any line of sight from `eye` is curved.
    fn bend(&self, eye: [f64; 3], earth: &EarthParams) -> bool {
        [&self.fronts, &self.backs].into_iter().any(|tree| tree.any_corner(|corner| earth.bends(corner, eye)))
    }

    /// Flags the pieces whose place nothing blocks on the side of `eye`.
    fn unblocked_from(
        &self,
        scene: &MedialScene,
        landmark: &SurfacePieces,
        eye: [f64; 3],
        control: &Control<'_>,
    ) -> Result<Vec<bool>> {
        let viewer = Viewer::Eye(eye);
        let mut unblocked = vec![false; landmark.pieces.len()];
        for (tree, is_front) in [(&self.fronts, true), (&self.backs, false)] {
            scene.visible_among(viewer, tree, control, |place| {
                let row = tree.rows()[place] as usize;
                unblocked[row] |= landmark.pieces[row].is_before(viewer) == is_front;
            })?;
        }
        Ok(unblocked)
    }
}

/// Solid angle of a triangle whose corners are given from the eye, steradians, 0 to 2π.
fn solid_angle(corners: [[f64; 3]; 3]) -> f64 {
    let [Some(a), Some(b), Some(c)] = corners.map(unit) else { return 0.0 };
    let volume = dot(a, cross(b, c)).abs();
    let angle = 2.0 * volume.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a));
    if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere_and_far_triangles_are_their_area_over_the_square_of_the_range() {
        let octant = solid_angle([[2.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!((octant - FRAC_PI_2).abs() < 1e-12, "{octant}");
        // seen square on from 1 km: what is left is of the order of (1 m / 1 km)²
        let far = solid_angle([[1000.0, 0.0, 0.0], [1000.0, 1.0, 0.0], [1000.0, 0.0, 1.0]]);
        assert!((far / 0.5e-6 - 1.0).abs() < 1e-5, "{far}");
        // wider than a quarter of the sphere: all but flat before the eye
        let wide = solid_angle([[1e-9, 2.0, 0.0], [1e-9, -1.0, 1.7], [1e-9, -1.0, -1.7]]);
        assert!((wide - std::f64::consts::TAU).abs() < 1e-6, "{wide}");
    }
}
