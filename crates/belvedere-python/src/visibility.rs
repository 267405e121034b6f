//! Visibility of pairs, and of many targets of one eye.

use crate::arrays::{to_1d, to_2d};
use crate::mesh::{Faces, rows_of};
use crate::observers::{standing, standing_pairs};
use crate::question::Data;
use crate::remarks::{Remarks, remarks_of};
use crate::scene::PyScene;
use crate::targets::RequestedTargets;
use crate::work::run;
use belvedere::apps::ask;
use belvedere::query::{AnswerCounts, MeshTargetParams, SurfacePieces, UnprovenAs, Viewer, seen_faces};
use belvedere::results::FaceRows;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Columns of pairs, where their targets are, and remarks.
type SightsReply<'py> = (Bound<'py, PyDict>, Bound<'py, PyAny>, Remarks<'py>);

impl PyScene {
    /// Returns remarks on the scene, on an eye, local metres, and on targets of which some are outside the cloud.
    fn remarks_on_viewer<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        (outside, count): (usize, usize),
        things: &str,
    ) -> PyResult<Remarks<'py>> {
        let model = self.0.model();
        let of_eye = ask::remark_on_eye(model.coverage().as_ref(), eye);
        let of_model = ask::remarks_on_model(model);
        remarks_of(py, of_model.iter().chain(&of_eye).chain(&ask::remark_on_outside(outside, count, things)))
    }
}

#[pymethods]
impl PyScene {
    /// An answer for each target of one eye, and remarks.
    fn visible<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        targets: RequestedTargets<'py>,
        unproven: Data<Option<UnprovenAs>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Remarks<'py>)> {
        let unproven = unproven.0.unwrap_or(UnprovenAs::Reported);
        let inner = Arc::clone(&self.0);
        let eye = inner.frame().local_from_file(eye);
        let places = targets.chosen(py, &inner)?.places;
        let (answers, of_obstacles) = run(py, progress, move |control| {
            // targets outside the cloud have an answer of their own
            let positions = match places {
                ask::Places::Points(positions, _) => positions,
                ask::Places::Cloud(cloud, _) => ask::places::moved(&cloud, &inner)?,
                other => other.targets(&inner, &mut ask::Context::default(), control)?.positions.clone(),
            };
            let scene = inner.blockers(unproven, control)?;
            let viewer = Viewer::Eye(eye);
            let mut answers = control
                .stage("testing targets", positions.len(), || scene.visible_from(viewer, &positions, control))?;
            scene.mark_inside_obstacles(viewer, &positions, &mut answers, control)?;
            let inside = AnswerCounts::of(&answers).inside_obstacle;
            let remarks =
                [ask::remark_on_inside(&scene, eye, "eye"), ask::remark_on_targets_inside(inside, answers.len())];
            let answers: Vec<_> = answers.into_iter().map(|answer| unproven.settle(answer)).collect();
            Ok((answers, remarks))
        })?;
        let outside = AnswerCounts::of(&answers).outside_cloud;
        let mut remarks = self.remarks_on_viewer(py, eye, (outside, answers.len()), "targets")?;
        remarks.extend(remarks_of(py, of_obstacles.iter().flatten())?);
        let codes: Vec<u8> = answers.into_iter().map(|answer| answer as u8).collect();
        Ok((to_1d(py, codes).into_any(), remarks))
    }

    /// Returns the visible area of each face and object of a mesh for one eye, and remarks.
    fn seen_of_mesh<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        faces: Faces,
        unproven: Data<Option<UnprovenAs>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyDict>, Remarks<'py>)> {
        let unproven = unproven.0.unwrap_or(UnprovenAs::Reported);
        let inner = Arc::clone(&self.0);
        let eye = inner.frame().local_from_file(eye);
        let (mesh, params) = faces.owned(&inner)?;
        let of_work = Arc::clone(&mesh);
        let things = "sample points of the mesh";
        let (seen, outside, beside) = run(py, progress, move |control| {
            let surface = SurfacePieces::of_mesh(&of_work, inner.frame().origin, params.spacing, params.seed)?;
            let scene = inner.blockers(unproven, control)?;
            let places: Vec<[f32; 3]> = surface.pieces.iter().map(|piece| piece.place).collect();
            let outside = inner.model().coverage().map_or(0, |coverage| coverage.outside_count(&places));
            let beside = ask::remark_on_targets_beside(inner.model().coverage().as_ref(), &places, things);
            let eye = Viewer::Eye(eye);
            let seen = seen_faces(&surface, eye, &MeshTargetParams::default(), |places| {
                let answers =
                    control.stage("testing targets", places.len(), || scene.visible_from(eye, places, control))?;
                Ok(answers.into_iter().map(|answer| unproven.settle(answer)).collect())
            })?;
            Ok((seen, (outside, places.len()), beside))
        })?;
        let mut remarks = self.remarks_on_viewer(py, eye, outside, things)?;
        remarks.extend(remarks_of(py, &beside)?);
        Ok((rows_of(py, FaceRows::of_seen(&mesh, &seen))?, remarks))
    }

    /// Returns the result for the line of sight of each pair, the position of its target, and remarks. Without targets
    /// the pairs are those of a network of the observers, within `max_distance`. Heights of NaN follow from the
    /// ground.
    fn lines_of_sight<'py>(
        &self,
        py: Python<'py>,
        question: Data<ask::LinesOfSightQuestion>,
        observers: PyReadonlyArray2<'py, f64>,
        targets: Option<PyReadonlyArray2<'py, f64>>,
        max_distance: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<SightsReply<'py>> {
        let scene = &self.0;
        let places = match targets {
            None => ask::Places::Network(ask::NetworkPlaces {
                places: standing(&observers, "observers", scene)?,
                max_distance,
                ..ask::NetworkPlaces::default()
            }),
            Some(targets) => standing_pairs(&observers, &targets, scene)?,
        };
        let answers = self.ask(py, progress, question.0, places)?;
        let found = &answers.found;
        let columns = found.columns(scene);
        let dict = PyDict::new(py);
        if let Some(network) = &found.network {
            for (end, name) in ["a", "b"].into_iter().enumerate() {
                let rows = network.pairs.iter().map(|pair| i64::try_from(pair[end]).unwrap_or(-1)).collect();
                dict.set_item(name, to_1d::<i64>(py, rows))?;
            }
            let length = |&[a, b]: &[[f64; 3]; 2]| belvedere::vector::length(belvedere::vector::sub(b, a));
            dict.set_item("length_m", to_1d::<f64>(py, found.pairs.iter().map(length).collect()))?;
        }
        dict.set_item("answer", to_1d(py, found.answers.iter().map(|&answer| answer as u8).collect()))?;
        dict.set_item("first_block_range_m", to_1d(py, columns.ranges))?;
        if let Some(lengths) = columns.unproven {
            dict.set_item("unproven_m", to_1d(py, lengths))?;
        }
        for measure in &found.sure {
            dict.set_item(&measure.name, to_1d(py, measure.values.clone()))?;
        }
        if let Some(percent) = columns.fresnel_free_percent {
            dict.set_item("fresnel_free_percent", to_1d(py, percent))?;
        }
        dict.set_item("block", to_2d(py, &columns.places)?)?;
        let ball = |row: Option<usize>| row.map_or(-1, |row| i64::try_from(row).unwrap_or(-1));
        dict.set_item("block_ball", to_1d::<i64>(py, columns.balls.into_iter().map(ball).collect()))?;
        let source = |row: Option<u32>| row.map_or(-1, i64::from);
        dict.set_item("block_source", to_1d::<i64>(py, columns.sources.into_iter().map(source).collect()))?;
        if let Some(surfaces) = columns.surfaces {
            dict.set_item("block_surface", surfaces)?;
        }
        if let Some(is_terrain) = columns.is_terrain {
            let is_terrain = is_terrain.into_iter().map(Option::unwrap_or_default).collect();
            dict.set_item("block_terrain", to_1d::<bool>(py, is_terrain))?;
        }
        let targets: Vec<[f64; 3]> =
            found.pairs.iter().map(|[_, target]| scene.frame().file_from_local(*target)).collect();
        Ok((dict, to_2d(py, &targets)?.into_any(), remarks_of(py, &answers.remarks)?))
    }
}
