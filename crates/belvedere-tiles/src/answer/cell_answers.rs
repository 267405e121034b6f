//! Answer to a question on the cells of a tile: that of `ask`, written as a raster.

use crate::answer::lines::AreaLines;
use crate::answer::obstacles::ObstacleSearch;
use crate::answer::surface_cells::SharedSurfaces;
use crate::answer::tile_scene::SurveyScene;
use crate::grid::TileId;
use crate::plan::Plan;
use crate::plan::prepared::{PreparedQuestion, SightLines};
use crate::plan::question::TileQuestion;
use crate::plan::record::{Stamp, TileOutcome, TileRecord};
use crate::plan::side_files::Others;
use crate::plan::stage::Stage;
use belvedere::Result;
use belvedere::apps::ask::{Places, ask_in_parts};
use belvedere::apps::targets::{TargetLayout, Targets};
use belvedere::control::Control;
use belvedere::io::atomic;
use belvedere::results::{ResultRaster, georeference};
use rayon::prelude::*;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Number of targets that a thread takes at once.
const CHUNK: usize = 1024;

/// Question about tiles, with the data that its answer needs.
#[derive(Clone)]
pub(crate) struct TileTask<'a> {
    pub(crate) plan: Arc<Plan>,
    pub(crate) question: &'a TileQuestion,
    pub(crate) prepared: &'a PreparedQuestion,
    /// Obstacles other than balls.
    pub(crate) others: Arc<Others>,
    /// Maximum number of balls that are tested together.
    pub(crate) max_balls: usize,
}

/// Answers a question for the cells of a tile, and writes the answer; the caller writes the record next. It uses the
/// balls in the folder of the run. Cells that missing balls can change have no value. `surfaces` keeps the surfaces of
/// earlier answers.
///
/// # Errors
/// Those of reading the files and the balls, and of writing.
pub(crate) fn answer(
    run: &Path,
    task: &TileTask<'_>,
    tile: TileId,
    surfaces: &mut SharedSurfaces,
    control: &Control<'_>,
) -> Result<TileRecord> {
    let TileTask { plan, question, prepared, others, max_balls } = task;
    let stage = Stage::Answer(question);
    atomic::make_folder(&stage.folder(plan, run))?;
    let core = plan.grid().core(tile);
    let nothing = |points: usize| Ok(TileRecord { points, ..TileRecord::default() });
    // at night cells have values without any line; beyond the reach of observers they have none
    if matches!(prepared.lines, SightLines::Observers(..)) && AreaLines::of(&prepared.lines, core, 0.0).is_empty() {
        return nothing(0);
    }
    let surface = surfaces.of_tile(plan, (tile, plan.cells.of(question)), others, control)?;
    let (points, covered, targets) = (surface.points, surface.covered, Arc::clone(&surface.targets));
    let (cells, TargetLayout::Cells(ground)) = (targets.target_count(), &targets.layout) else {
        return nothing(points);
    };
    if cells == 0 {
        return nothing(points);
    }
    let search: Arc<Mutex<ObstacleSearch>> = Arc::default();
    let survey = SurveyScene {
        plan: Arc::clone(plan),
        run: run.to_owned(),
        others: Arc::clone(others),
        max_balls: *max_balls,
        memory: u64::MAX,
        makes_balls: false,
        search: Arc::clone(&search),
    };
    let scene = plan.scene(Arc::new(survey), others.far_terrain.clone())?;
    let places = Places::Targets(Arc::clone(&targets));
    let mut answers = ask_in_parts(&prepared.question, &scene, &places, control)?;
    question.keep(&mut answers.measures);
    let mut balls = std::mem::take(&mut *search.lock().unwrap_or_else(PoisonError::into_inner));
    let unknown = unknown_towards(&balls, &targets, prepared.lines.directions());
    balls.unknown_cells += unknown.len();
    for measure in &mut answers.measures {
        unknown.iter().for_each(|&row| measure.values[row] = f32::NAN);
    }
    answers.measures.extend(plan.added_band(&answers.measures, &targets.on_added));
    let near_edge_cells = answers.report.places.edge.map(|edge| edge.targets_near_edge);
    let raster = ResultRaster::of_measures(&answers.measures, [ground.grid.width, ground.grid.height])?;
    if raster.pixels.are_nothing() && balls.unknown_cells == 0 {
        return Ok(TileRecord { points, covered_cells: covered, damaged: balls.damaged, ..TileRecord::default() });
    }
    let path = stage.result(plan, run, tile);
    raster.write(&path, Some(&georeference(&ground.grid, &targets.frame)))?;
    Ok(TileRecord {
        outcome: TileOutcome::Done,
        result: Some(Stamp::of(&path)?),
        damaged: balls.damaged,
        points,
        balls: balls.ball_count,
        max_balls: balls.max_held,
        cells,
        covered_cells: covered,
        unproven_cells: balls.unknown_cells,
        near_edge_cells,
        skipped_observers: balls.skipped_observers,
        inside_cells: balls.inside_cells,
        ..TileRecord::default()
    })
}

/// Returns the rows of targets that missing balls may block in any of `directions`.
fn unknown_towards(balls: &ObstacleSearch, targets: &Targets, directions: &[[f64; 3]]) -> Vec<usize> {
    if balls.missing.is_empty() {
        return Vec::new();
    }
    let is_unknown = |position: &[f32; 3]| {
        let position = position.map(f64::from);
        position.iter().all(|v| v.is_finite())
            && directions.iter().any(|&direction| balls.is_unknown(position, direction, f64::INFINITY))
    };
    let rows = targets.positions.par_iter().enumerate().with_min_len(CHUNK);
    rows.filter(|(_, position)| is_unknown(position)).map(|(row, _)| row).collect()
}
