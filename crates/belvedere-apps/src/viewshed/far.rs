//! Viewshed of the terrain beyond a cloud, and reverse viewshed of a target from there.

use super::{Observer, Viewshed, ViewshedParams, box_within_reach, check, tests_proof};
use belvedere_core::query::{Answer, MedialScene};
use belvedere_data::control::Control;
use belvedere_data::{ElevationGrid, Error, Parameter, Result};
use rayon::prelude::*;

/// The part of `terrain` that is within reach of any of `observers`, and all of it where none has a limit.
///
/// # Errors
/// [`Error::InvalidParameter`] where that holds no 2 x 2 nodes, or none with a height.
pub fn terrain_within_reach(terrain: &ElevationGrid, observers: &[Observer]) -> Result<ElevationGrid> {
    let reaches = observers.iter().filter(|observer| observer.eye.iter().all(|v| v.is_finite()));
    let reaches = reaches.map(|observer| ([observer.eye[0], observer.eye[1]], observer.limits.distance[1]));
    terrain.part(box_within_reach(terrain.on_map(), reaches)).ok_or_else(|| {
        Error::invalid(
            Parameter::MaxDistance,
            "one within which the terrain has no 2 x 2 cells with heights",
            "more than the cells of the terrain",
        )
    })
}

/// The nodes of `terrain` that lie beyond the cloud of `scene`, local metres.
pub fn far_targets(scene: &MedialScene, terrain: &ElevationGrid) -> impl Iterator<Item = [f64; 3]> {
    let [width, height] = [terrain.heights().width(), terrain.heights().height()];
    let nodes = (0..width * height).filter_map(move |i| terrain.node(i % width, i / width));
    nodes.filter(|node| is_beyond(scene, *node))
}

fn is_beyond(scene: &MedialScene, node: [f64; 3]) -> bool {
    scene.coverage().is_none_or(|coverage| !coverage.holds_on_map(node))
}

/// Computes which nodes of `terrain` beyond the cloud of `scene` `observers` see, at `height` metres above them, in the
/// order of the nodes; control counts rows. The answers are those of [`MedialScene::far_sight_answer`]. Nodes over the
/// cloud or without a height are not tested and are [`Answer::OutsideCloud`]. Nodes that no observer is turned to are
/// [`Answer::OutsideView`]. Masks are not kept.
///
/// As for [`viewshed`](super::viewshed), an observer whose eye is not finite sees nothing, and from where a target is
/// seen is the viewshed of an observer in its place.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range, and [`Error::Cancelled`].
pub fn far_viewshed(
    scene: &MedialScene,
    observers: &[Observer],
    terrain: &ElevationGrid,
    height: f64,
    params: &ViewshedParams,
    control: &Control<'_>,
) -> Result<Viewshed> {
    check(observers, &params.earth)?;
    if !(height >= 0.0 && height.is_finite()) {
        let (parameter, value) = (Parameter::HeightAboveGround, height.to_string());
        return Err(Error::invalid(parameter, value, "0 metres or more"));
    }
    let width = terrain.heights().width();
    let mut answers = vec![Answer::OutsideCloud; terrain.heights().values().len()];
    let mut counts = vec![0; answers.len()];
    let mut unproven_counts = vec![0; answers.len()];
    let of_rows = answers.par_chunks_mut(width).zip(counts.par_chunks_mut(width));
    let rows = of_rows.zip(unproven_counts.par_chunks_mut(width)).enumerate();
    let none_seen = || vec![0; observers.len()];
    let seen_counts = rows
        .map(|(row, ((answers, counts), unproven_counts))| {
            let mut seen_counts = none_seen();
            for (column, ((answer, count), unproven)) in answers.iter_mut().zip(counts).zip(unproven_counts).enumerate()
            {
                control.check()?;
                let Some(node) = terrain.node(column, row).filter(|node| is_beyond(scene, *node)) else { continue };
                let target = [node[0], node[1], node[2] + height];
                *answer = Answer::OutsideView;
                for (observer, seen) in observers.iter().zip(&mut seen_counts) {
                    if !observer.eye.iter().all(|v| v.is_finite()) || !observer.limits.allow(observer.eye, target) {
                        continue;
                    }
                    let sight = scene.far_sight_answer(observer.eye, target, &params.earth);
                    let sight = params.unproven.settle(sight);
                    *unproven += u32::from(sight == Answer::Unproven);
                    match (sight, *answer) {
                        (Answer::Visible, _) => {
                            *answer = Answer::Visible;
                            *count += 1;
                            *seen += 1;
                        }
                        (Answer::Unproven, Answer::OutsideView | Answer::Blocked) => *answer = Answer::Unproven,
                        (Answer::Blocked, Answer::OutsideView) => *answer = Answer::Blocked,
                        _ => {}
                    }
                }
            }
            control.advance(1);
            Ok(seen_counts)
        })
        .try_reduce(none_seen, |a, b| Ok(a.into_iter().zip(b).map(|(a, b)| a + b).collect()))?;
    if !tests_proof(scene, params) {
        unproven_counts = Vec::new();
    }
    Ok(Viewshed { answers, counts, unproven_counts, masks: Vec::new(), seen_counts })
}
