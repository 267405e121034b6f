//! The places of questions: from a user's input to targets, with the places left out and why.

use super::cells::GridCells;
use super::context::Context;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::PlacesReport;
use super::single_places::positions;
use super::standing::{Reach, Standing};
use super::viewer::remark_on_outside;
use crate::edge::{EdgeReport, near_edge};
use crate::targets::{AreaMeans, MeshParams, TargetLayout, Targets};
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::MedialScene;
use belvedere_data::control::Control;
use belvedere_data::report::percent;
use belvedere_data::{Error, Mesh, Parameter, PointCloud, Result};
use std::sync::Arc;

/// Share of targets near the edge of the cloud from which on it is warned of, percent.
pub(super) const EDGE_WARNING_PERCENT: f64 = 1.0;
const NEAR_EDGE: &str = "are near the edge of the cloud: objects beyond it, as high as its highest point, could take some of their sun or sky";

/// Places of a question.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Places {
    /// The scene as a whole.
    Scene,
    /// The cells of a grid.
    Cells(GridCells),
    /// The points of the scene itself, in their order.
    Own(Turned),
    /// Points in local metres, with the unit normals that they are turned to, (N, 3) each.
    Points(Vec<[f32; 3]>, Option<Vec<[f32; 3]>>),
    /// Single places: one without a height lies above the ground, or above what covers the ground there.
    At(Vec<Standing>, GroundPoints),
    /// The points of a cloud, with the unit normals that they are turned to.
    Cloud(Arc<PointCloud>, Option<Vec<[f32; 3]>>),
    /// The faces of a mesh in metres.
    Mesh(Arc<Mesh>, MeshParams),
    /// Targets that were made before.
    Targets(Arc<Targets>),
    /// Observers.
    Eyes(Vec<Standing>),
    /// Observers and targets, two by two.
    Pairs(Vec<[Standing; 2]>),
    /// Places of which each two may see each other.
    Network(NetworkPlaces),
}

/// Places of a network of lines of sight.
#[derive(Clone, Debug, Default)]
pub struct NetworkPlaces {
    /// The places.
    pub places: Vec<Standing>,
    /// Their names, for reports; empty for their numbers.
    pub names: Vec<String>,
    /// Horizontal distance up to which two places are a pair, metres, above 0; `None` for no limit.
    pub max_distance: Option<f64>,
}

/// Orientation of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turned {
    /// The zenith. Default.
    #[default]
    Level,
    /// Their normals.
    Normals,
}

impl Places {
    /// The same places, with cells and single places that have no height of their own `height` metres above the ground,
    /// or what covers it.
    pub(super) fn at_height(&self, height: f64) -> Self {
        let mut places = self.clone();
        match &mut places {
            Self::Cells(cells) => cells.height = cells.height.or(Some(height)),
            Self::At(single, _) => single.iter_mut().for_each(|place| place.height = place.height.or(Some(height))),
            _ => {}
        }
        places
    }

    /// The targets of a scene, without those outside its cloud.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for parameters out of range, places of another reference system, and a ball file
    /// without points where points are needed; those of computing the ground.
    pub fn targets(&self, scene: &Scene, context: &mut Context, control: &Control<'_>) -> Result<Arc<Targets>> {
        self.targets_within(Reach::Cloud, scene, context, control)
    }

    /// [`Places::targets`] of lines of sight of this extent: single places and points may lie on the terrain beyond the
    /// cloud.
    pub(super) fn targets_within(
        &self,
        reach: Reach,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Arc<Targets>> {
        let frame = || scene.frame().clone();
        let of_points = |positions: Vec<[f32; 3]>, normals| {
            Targets::of_points(&PointCloud { positions, ..PointCloud::in_frame(frame()) }, normals)
        };
        let mut targets = match self {
            Self::Scene => of_points(Vec::new(), None),
            Self::Targets(targets) => return Ok(Arc::clone(targets)),
            Self::Eyes(_) | Self::Pairs(_) | Self::Network(_) => {
                return other(Parameter::Targets, "observers", "cells, points or a mesh");
            }
            Self::Cells(cells) => return Ok(Arc::new(cells.targets(scene, context, control)?)),
            Self::Own(turned) => own_points(scene, *turned)?,
            Self::Points(positions, normals) => of_points(positions.clone(), normals.clone()),
            Self::At(places, points) => of_points(positions(places, *points, scene, context, control)?, None),
            Self::Cloud(cloud, normals) => of_points(moved(cloud, scene)?, normals.clone()),
            Self::Mesh(mesh, params) => {
                control.stage("sampling mesh", 0, || Targets::of_mesh(mesh, scene.frame(), params))?
            }
        };
        leave_out_outside(&mut targets, reach, scene, context);
        Ok(Arc::new(targets))
    }

    /// The observers.
    pub(super) fn eyes(&self) -> Result<&[Standing]> {
        match self {
            Self::Eyes(eyes) => Ok(eyes),
            _ => other(Parameter::Observer, "missing", "given: the question is about observers"),
        }
    }

    /// Observers and targets, two by two.
    pub(super) fn pairs(&self) -> Result<&[[Standing; 2]]> {
        match self {
            Self::Pairs(pairs) => Ok(pairs),
            _ => other(Parameter::Observer, "missing", "given with a target each: the question is about pairs"),
        }
    }
}

/// Refuses places of another kind than a question is about.
pub(super) fn other<T>(parameter: Parameter, value: &str, expected: &'static str) -> Result<T> {
    Err(Error::invalid(parameter, value, expected))
}

/// Leaves out targets outside the cloud, and outside the terrain beyond it where lines of sight reach so far, which is
/// reported and warned of.
pub(super) fn leave_out_outside(targets: &mut Targets, reach: Reach, scene: &Scene, context: &mut Context) {
    let count = targets.target_count();
    let terrain = scene.model().far_terrain().grid().filter(|_| reach == Reach::FarTerrain);
    let is_beyond = |place: [f32; 3]| {
        terrain.is_some_and(|terrain| terrain.height_at([place[0], place[1]].map(f64::from)).is_some())
    };
    let outside = scene.model().coverage().map_or(0, |coverage| {
        targets.leave_out(|place| {
            let is_on_terrain = !coverage.holds_on_map(place.map(f64::from)) && is_beyond(place);
            coverage.is_outside(place) && !is_on_terrain
        })
    });
    context.report.places.targets_outside_cloud = Some(outside);
    context.add(remark_on_outside(outside, count, "targets"));
}

impl Targets {
    /// Leaves out targets inside obstacles, where nobody stands, which is reported and noted.
    pub(super) fn leave_out_inside(
        &mut self,
        blockers: &MedialScene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<()> {
        let count = self.target_count();
        let inside = control.stage("testing targets", 0, || self.leave_out_enclosed(blockers, control))?;
        context.report.places.targets_inside_obstacle = Some(inside);
        let so = "are inside an obstacle, and have no answer";
        context.add(Remark::of_share("targets-inside-obstacle", inside, count, "targets", so).map(Remark::into_note));
        Ok(())
    }
}

fn own_points(scene: &Scene, turned: Turned) -> Result<Targets> {
    let cloud = scene.cloud();
    let invalid = |value: &str, expected| Err(Error::invalid(Parameter::Targets, value, expected));
    if cloud.is_empty() {
        return invalid("the points of a ball file", "points: a ball file has none; give its cloud");
    }
    let normals = match turned {
        Turned::Level => None,
        Turned::Normals => match scene.model().normals() {
            Some(normals) if normals.len() == cloud.len() => Some(normals.to_vec()),
            _ => return invalid("points without normals", "points with normals, which `belvedere normals` estimates"),
        },
    };
    Ok(Targets::of_points(cloud, normals))
}

/// Positions of a cloud in the frame of a scene.
///
/// # Errors
/// [`Error::InvalidParameter`] for a cloud in another reference system.
pub fn moved(cloud: &PointCloud, scene: &Scene) -> Result<Vec<[f32; 3]>> {
    let frame = scene.frame();
    if cloud.frame.crs.contradicts(&frame.crs) {
        let expected = "that of the scene; convert one of them";
        return Err(Error::invalid(Parameter::ReferenceSystem, cloud.frame.crs.describe(), expected));
    }
    if cloud.frame == *frame {
        return Ok(cloud.positions.clone());
    }
    let bare = PointCloud { positions: cloud.positions.clone(), ..PointCloud::in_frame(cloud.frame.clone()) };
    Ok(bare.moved_to(frame).positions)
}

/// Flags the targets near the edge of the cloud for light from `directions`. Reports their number, with a warning if
/// they are many.
pub(super) fn test_edge(
    scene: &Scene,
    targets: &Targets,
    directions: &[[f64; 3]],
    context: &mut Context,
    control: &Control<'_>,
) -> Result<Vec<Option<bool>>> {
    let Some(coverage) = scene.model().coverage() else { return Ok(vec![None; targets.len()]) };
    let flags = control.stage("testing the edge of the cloud", targets.len(), || {
        near_edge(&coverage, &targets.positions, directions, control)
    })?;
    let report = EdgeReport::of(&flags);
    context.report.places.edge = Some(report);
    context.add(remark_on_edge(report.targets_near_edge, targets.target_count()));
    Ok(flags)
}

/// A warning of areas over which no cell has a value.
#[must_use]
pub fn remark_on_empty_areas(areas: &[AreaMeans]) -> Option<Remark> {
    let empty = areas.iter().filter(|area| area.cells == 0).count();
    let so = "hold no cell with a value: they lie outside the scene, under roofs, or are smaller than cells";
    Remark::of_share("areas-without-cells", empty, areas.len(), "areas", so)
}

/// A warning that `near` of `count` targets are near the edge of the cloud; `None` where they are few.
#[must_use]
pub fn remark_on_edge(near: usize, count: usize) -> Option<Remark> {
    let is_many = percent(near, count) >= EDGE_WARNING_PERCENT;
    Remark::of_share("targets-near-edge", near, count, "targets", NEAR_EDGE).filter(|_| is_many)
}

impl PlacesReport {
    pub(super) fn cells_in_words(count: usize, cell: f64) -> String {
        format!("{count} cells of {cell} m")
    }

    /// Targets in words, such as "14400 cells of 1 m".
    pub(super) fn in_words(targets: &Targets) -> String {
        let count = targets.target_count();
        match &targets.layout {
            TargetLayout::Cells(ground) => Self::cells_in_words(count, ground.grid.cell),
            TargetLayout::Points if count == 1 => "1 point".to_owned(),
            TargetLayout::Points => format!("{count} points"),
            TargetLayout::Surface(_) => format!("{} faces", targets.groups.len()),
        }
    }
}
