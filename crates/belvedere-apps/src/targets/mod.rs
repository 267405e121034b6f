//! Targets, for which results are computed: cells of a grid, points, pieces of a surface, places along routes and on
//! windows, all as one type.
//!
//! | targets | made by |
//! |---|---|
//! | cells on ground or obstacles | [`Targets::ground_cells`], [`Targets::of_cells`] |
//! | points of a cloud or of a file | [`Targets::of_points`], [`Targets::of_places`] |
//! | faces of a mesh, in pieces | [`Targets::of_mesh`] |
//! | places along routes | [`Targets::along_routes`] |
//! | windows with a size, faces as windows | [`Targets::of_windows`], [`Targets::of_window_faces`] |
//!
//! Results are [`Measure`]s with a value for each target. A target without a position (NaN: no ground is known, or it
//! lies inside an obstacle) has no value.

mod area_means;
mod cells;
mod measure;
mod on_ground;
mod result_kind;
mod routes;
mod surfaces;
mod windows;

pub use area_means::{AreaMeans, AreaResult};
pub use cells::{CellLevel, CellParams, CellReport};
pub use measure::{Measure, MeasureStatistics};
pub use on_ground::{grid_around, set_on_ground, set_on_terrain};
pub use result_kind::ResultKind;
pub use routes::Route;
pub use surfaces::{FaceMeans, Facing, MeshParams, object_areas};
pub use windows::{Window, objects_of_windows};

use belvedere_core::ground::Ground;
use belvedere_core::query::{MedialScene, SurfacePieces};
use belvedere_data::control::Control;
use belvedere_data::frame::Frame;
use belvedere_data::vector::to_f32;
use belvedere_data::{PointCloud, Result};
use rayon::prelude::*;
use std::ops::Range;

/// Default distance of targets from the ground, roof, facade or window that they lie on, metres. It is twice the noise
/// of usual airborne surveys, and the height of the rails of panels. Points of surfaces lie up to a few centimetres
/// below the balls around them.
pub const TARGET_LIFT: f64 = 0.1;
/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// Places for which results are computed, and their groups.
#[derive(Clone, Debug)]
pub struct Targets {
    /// Frame of local coordinates.
    pub frame: Frame,
    /// Local metres, (M, 3); NaN for a target that is left out.
    pub positions: Vec<[f32; 3]>,
    /// Outward unit normals, (M, 3); `None` where targets are level.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Weight of each target, (M): metres of a route, square metres of a surface; empty for equal weights.
    pub weights: Vec<f64>,
    /// Rows of the targets of each route, window or object; empty where each target is on its own.
    pub groups: Vec<Range<usize>>,
    /// Layout of the targets.
    pub layout: TargetLayout,
    /// True for targets on top of an added mesh, (M); empty if there is none.
    pub on_added: Vec<bool>,
}

/// Layout of targets, as needed to write their values.
#[derive(Clone, Debug)]
pub enum TargetLayout {
    /// Cells of a grid, row by row from the north, and the heights that they stand on.
    Cells(Box<Ground>),
    /// Points.
    Points,
    /// Pieces of a surface.
    Surface(SurfacePieces),
}

impl Targets {
    /// The points of `cloud`, all of them and in their order. They are turned as `normals`, (M, 3), say; level without.
    #[must_use]
    pub fn of_points(cloud: &PointCloud, normals: Option<Vec<[f32; 3]>>) -> Self {
        Self::at(cloud.frame.clone(), cloud.positions.clone(), normals, TargetLayout::Points)
    }

    /// Places in local metres, level; one that is not finite is left out.
    #[must_use]
    pub fn of_places(places: &[[f64; 3]], frame: Frame) -> Self {
        Self::at(frame, places.iter().map(|place| place.map(to_f32)).collect(), None, TargetLayout::Points)
    }

    /// Targets at positions, (M, 3) local metres, NaN where one is left out, with normals or level.
    #[must_use]
    pub fn at(frame: Frame, positions: Vec<[f32; 3]>, normals: Option<Vec<[f32; 3]>>, layout: TargetLayout) -> Self {
        Self { frame, positions, normals, weights: Vec::new(), groups: Vec::new(), layout, on_added: Vec::new() }
    }

    /// Number of targets, including those that are left out.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns true if there is no target.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns true if results are computed for a target: it has a position.
    #[must_use]
    pub fn is_target(&self, row: usize) -> bool {
        self.positions.get(row).is_some_and(|position| position.iter().all(|v| v.is_finite()))
    }

    /// Number of targets that have a position.
    #[must_use]
    pub fn target_count(&self) -> usize {
        (0..self.len()).filter(|&row| self.is_target(row)).count()
    }

    /// The ground below cells; `None` where targets are no cells.
    #[must_use]
    pub fn ground(&self) -> Option<&Ground> {
        match &self.layout {
            TargetLayout::Cells(ground) => Some(ground),
            _ => None,
        }
    }

    /// The ground below cells, without heights in cells that are no targets; `None` where targets are no cells.
    #[must_use]
    pub fn open_ground(&self) -> Option<Ground> {
        let mut ground = self.ground()?.clone();
        self.clear_unasked(ground.heights.values_mut());
        Some(ground)
    }

    /// Makes the values of targets without a position NaN.
    pub fn clear_unasked(&self, values: &mut [f32]) {
        values.par_iter_mut().zip(&self.positions).with_min_len(CHUNK).for_each(|(value, position)| {
            if !position.iter().all(|v| v.is_finite()) {
                *value = f32::NAN;
            }
        });
    }

    /// Leaves out targets at places, local metres, that are `outside`; returns how many.
    pub fn leave_out(&mut self, outside: impl Fn([f32; 3]) -> bool + Sync) -> usize {
        let positions = self.positions.par_iter_mut().with_min_len(CHUNK);
        let outside = positions.filter(|position| outside(**position));
        outside.map(|position| *position = [f32::NAN; 3]).count()
    }

    /// Leaves out targets that lie inside an obstacle of `scene` ([`MedialScene::is_inside_obstacle`]); returns how
    /// many.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn leave_out_enclosed(&mut self, scene: &MedialScene, control: &Control<'_>) -> Result<usize> {
        let is_enclosed = |position: &[f32; 3]| {
            control.check()?;
            let is_target = position.iter().all(|v| v.is_finite());
            Ok(is_target && scene.is_inside_obstacle(position.map(f64::from)))
        };
        let enclosed: Vec<bool> = self.positions.par_iter().map(is_enclosed).collect::<Result<_>>()?;
        for (position, _) in self.positions.iter_mut().zip(&enclosed).filter(|(_, is_enclosed)| **is_enclosed) {
            *position = [f32::NAN; 3];
        }
        Ok(enclosed.into_iter().filter(|&is_enclosed| is_enclosed).count())
    }

    /// Returns the weight of a target.
    #[must_use]
    pub fn weight(&self, row: usize) -> f64 {
        if self.weights.is_empty() { 1.0 } else { self.weights.get(row).copied().unwrap_or(0.0) }
    }

    /// Returns the weight of each group.
    #[must_use]
    pub fn group_weights(&self) -> Vec<f64> {
        self.groups.iter().map(|group| group.clone().map(|row| self.weight(row)).sum()).collect()
    }

    /// Mean of `values`, (M), over each group, by the weights of its targets; targets without a value do not count, and
    /// a group without any value has NaN.
    #[must_use]
    pub fn group_means(&self, values: &[f32]) -> Vec<f64> {
        let mean = |group: &Range<usize>| {
            let known = || self.known_values(group, values);
            known().map(|(value, weight)| value * weight).sum::<f64>() / known().map(|(_, weight)| weight).sum::<f64>()
        };
        self.groups.iter().map(mean).collect()
    }

    /// Returns the minimum of `values`, (M), in each group; NaN for a group without any value.
    #[must_use]
    pub fn group_minima(&self, values: &[f32]) -> Vec<f64> {
        self.group_extremes(values, f64::min)
    }

    /// Returns the maximum of `values`, (M), in each group; NaN for a group without any value.
    #[must_use]
    pub fn group_maxima(&self, values: &[f32]) -> Vec<f64> {
        self.group_extremes(values, f64::max)
    }

    fn group_extremes(&self, values: &[f32], pick: fn(f64, f64) -> f64) -> Vec<f64> {
        let of_group =
            |group: &Range<usize>| self.known_values(group, values).map(|(v, _)| v).reduce(pick).unwrap_or(f64::NAN);
        self.groups.iter().map(of_group).collect()
    }

    fn known_values<'a>(&'a self, group: &Range<usize>, values: &'a [f32]) -> impl Iterator<Item = (f64, f64)> + 'a {
        let value = move |row: usize| Some((f64::from(*values.get(row)?), self.weight(row)));
        group.clone().filter_map(value).filter(|(value, _)| value.is_finite())
    }
}

/// Mean of `values` by `weights`; values that are not finite do not count. `None` where nothing counts.
#[must_use]
pub fn weighted_mean(values: &[f64], weights: &[f64]) -> Option<f64> {
    let known = || values.iter().zip(weights).filter(|(value, _)| value.is_finite());
    let whole: f64 = known().map(|(_, weight)| weight).sum();
    (whole > 0.0).then(|| known().map(|(value, weight)| value * weight).sum::<f64>() / whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_weigh_their_known_targets_and_keep_their_extremes() {
        let mut targets = Targets::at(Frame::default(), vec![[0.0; 3]; 6], None, TargetLayout::Points);
        targets.groups = vec![0..3, 3..5, 5..6];
        let values = [1.0, 4.0, f32::NAN, 2.0, 6.0, f32::NAN];
        // without weights all count alike
        assert_eq!(targets.group_means(&values)[..2], [2.5, 4.0]);
        targets.weights = vec![3.0, 1.0, 50.0, 1.0, 3.0, 1.0];
        assert_eq!(targets.group_means(&values)[..2], [7.0 / 4.0, 5.0]);
        assert_eq!(targets.group_minima(&values)[..2], [1.0, 2.0]);
        assert_eq!(targets.group_maxima(&values)[..2], [4.0, 6.0]);
        assert!(targets.group_means(&values)[2].is_nan() && targets.group_minima(&values)[2].is_nan());
        assert_eq!(targets.group_weights(), [54.0, 4.0, 1.0]);
        assert_eq!(weighted_mean(&[1.0, f64::NAN, 4.0], &[1.0, 9.0, 2.0]), Some(3.0));
        assert_eq!(weighted_mean(&[f64::NAN], &[1.0]), None);
    }

    #[test]
    fn targets_without_a_position_have_no_value() {
        let positions = vec![[0.0; 3], [f32::NAN, 0.0, 0.0], [1.0, 2.0, f32::INFINITY]];
        let targets = Targets::at(Frame::default(), positions, None, TargetLayout::Points);
        let mut values = [1.0, 2.0, 3.0];
        targets.clear_unasked(&mut values);
        assert!(values[0] == 1.0 && values[1].is_nan() && values[2].is_nan());
        assert_eq!((targets.len(), targets.target_count()), (3, 1));
    }
}
