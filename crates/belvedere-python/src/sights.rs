//! Who sees what: pairs, and many targets of one eye.

use crate::arrays::{Places, to_1d, to_2d};
use crate::errors::{exception, wrong};
use crate::mesh::{Faces, rows_of};
use crate::scene::{Scene, unproven_as};
use crate::targets::Wanted;
use crate::work::run;
use belvedere::apps::ask;
use belvedere::query::{
    Answer, Blocker, Curvature, EarthParams, MeshTargetParams, RadioWave, SurfacePieces, UnprovenAs, Viewer, seen_faces,
};
use belvedere::results::FaceRows;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// How lines of sight run over the earth; what is not given is the library's default.
pub(crate) fn earth(curvature: Option<&str>, refraction: Option<f64>) -> PyResult<EarthParams> {
    let usual = EarthParams::default();
    let curvature = match curvature {
        None => usual.curvature,
        Some("auto") => Curvature::Auto,
        Some("on") => Curvature::On,
        Some("off") => Curvature::Off,
        Some(other) => return Err(wrong("curvature", &format!("'{other}'"), "use 'auto', 'on' or 'off'")),
    };
    let params = EarthParams { curvature, refraction: refraction.unwrap_or(usual.refraction), ..usual };
    params.validate().map_err(exception)?;
    Ok(params)
}

#[pymethods]
impl Scene {
    /// An answer for each target of one eye.
    fn visible<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        targets: Wanted<'py>,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let unproven = unproven_as(unproven)?;
        let inner = Arc::clone(&self.0);
        let places = targets.chosen(py, &inner)?.places;
        let answers = run(py, progress, move |control| {
            // targets outside the cloud have an answer of their own
            let positions = match places {
                ask::Places::Points(positions, _) => positions,
                ask::Places::Cloud(cloud, _) => ask::places::moved(&cloud, &inner)?,
                other => other.targets(&inner, &mut ask::Context::default(), control)?.positions.clone(),
            };
            let scene = inner.blockers(unproven, control)?;
            let eye = Viewer::Eye(inner.frame().local_from_file(eye));
            let answers =
                control.stage("testing targets", positions.len(), || scene.visible_from(eye, &positions, control))?;
            Ok(answers.into_iter().map(|answer| unproven.settle(answer) as u8).collect::<Vec<u8>>())
        })?;
        Ok(to_1d(py, answers).into_any())
    }

    /// How much one eye sees of each face and object of a mesh.
    fn seen_of_mesh<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        faces: Faces,
        unproven: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let unproven = unproven_as(unproven)?;
        let inner = Arc::clone(&self.0);
        let (mesh, params) = faces.owned(&inner)?;
        let of_work = Arc::clone(&mesh);
        let seen = run(py, progress, move |control| {
            let surface = SurfacePieces::of_mesh(&of_work, inner.frame().origin, params.spacing, params.seed)?;
            let scene = inner.blockers(unproven, control)?;
            let eye = Viewer::Eye(inner.frame().local_from_file(eye));
            seen_faces(&surface, eye, &MeshTargetParams::default(), |places| {
                let answers =
                    control.stage("testing targets", places.len(), || scene.visible_from(eye, places, control))?;
                Ok(answers.into_iter().map(|answer| unproven.settle(answer)).collect())
            })
        })?;
        rows_of(py, FaceRows::of_seen(&mesh, &seen))
    }

    /// What is known of the line of sight of each pair.
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn lines_of_sight<'py>(
        &self,
        py: Python<'py>,
        observers: Places<'py>,
        targets: Places<'py>,
        unproven: &str,
        curvature: Option<&str>,
        refraction: Option<f64>,
        frequency: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let unproven = unproven_as(unproven)?;
        let wave = frequency.map(RadioWave::of_frequency).transpose().map_err(exception)?;
        let earth = earth(curvature, refraction)?;
        let [observers, targets] = [observers.rows("observers")?, targets.rows("targets")?];
        if observers.len() != targets.len() {
            let value = format!("an array of {} rows", targets.len());
            return Err(wrong("targets", &value, &format!("give a row for each of the {} observers", observers.len())));
        }
        let inner = Arc::clone(&self.0);
        let of_work = Arc::clone(&inner);
        let (sights, fresnel) = run(py, progress, move |control| {
            let frame = of_work.frame();
            let local = |place: [f64; 3]| frame.local_from_file(place);
            let pairs: Vec<[[f64; 3]; 2]> =
                observers.into_iter().zip(targets).map(|(a, b)| [local(a), local(b)]).collect();
            let scene = of_work.blockers(unproven, control)?;
            let sights = control
                .stage("testing lines of sight", pairs.len(), || scene.lines_of_sight(&pairs, &earth, control))?;
            let fresnel = match wave {
                Some(wave) => Some(control.stage("testing Fresnel zones", pairs.len(), || {
                    scene.fresnel_clearances(&pairs, &sights, wave, &earth, control)
                })?),
                None => None,
            };
            Ok((sights, fresnel))
        })?;
        let dict = PyDict::new(py);
        let answer = |sight: &Option<belvedere::query::LineOfSight>| {
            sight.map_or(Answer::OutsideView, |sight| unproven.settle(sight.answer)) as u8
        };
        dict.set_item("answer", to_1d(py, sights.iter().map(answer).collect()))?;
        let block = |i: usize| sights[i].and_then(|sight| sight.first_block);
        let each = || 0..sights.len();
        dict.set_item(
            "first_block_range_m",
            to_1d(py, each().map(|i| block(i).map_or(f64::NAN, |block| block.range)).collect()),
        )?;
        if inner.model().pulses().is_some() && unproven != UnprovenAs::Visible {
            let free = |i: usize| sights[i].filter(|sight| sight.first_block.is_none());
            dict.set_item(
                "unproven_m",
                to_1d(py, each().map(|i| free(i).map_or(f64::NAN, |sight| sight.unproven_length)).collect()),
            )?;
        }
        if let Some(free) = fresnel {
            let percent = free.into_iter().map(|free| 100.0 * free).collect();
            dict.set_item("fresnel_free_percent", to_1d::<f64>(py, percent))?;
        }
        let place = |i: usize| block(i).map_or([f64::NAN; 3], |block| inner.frame().file_from_local(block.place));
        dict.set_item("block", to_2d(py, &each().map(place).collect::<Vec<_>>())?)?;
        let ball_of = |i: usize| block(i).and_then(|block| block.blocker.ball());
        let ball = |i: usize| ball_of(i).map_or(-1, |row| i64::try_from(row).unwrap_or(-1));
        dict.set_item("block_ball", to_1d(py, each().map(ball).collect()))?;
        let source = |i: usize| {
            ball_of(i).and_then(|row| inner.model().balls().source.get(row)).map_or(-1, |&row| i64::from(row))
        };
        dict.set_item("block_source", to_1d(py, each().map(source).collect()))?;
        if inner.model().far_terrain().grid().is_some() {
            let is_terrain = |i: usize| block(i).is_some_and(|block| block.blocker == Blocker::Terrain);
            dict.set_item("block_terrain", to_1d(py, each().map(is_terrain).collect()))?;
        }
        Ok(dict)
    }
}
