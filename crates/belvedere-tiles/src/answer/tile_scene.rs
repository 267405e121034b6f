//! Survey around targets such as the cells of a tile, as questions look at it: part by part.

use crate::answer::how_sure::PartialEvidence;
use crate::answer::lines::{AreaLines, tiles};
use crate::answer::obstacles::ObstacleSearch;
use crate::answer::parts::TileObstacles;
use crate::answer::proof::{Line, unproven};
use crate::answer::sight::PartialSight;
use crate::answer::surroundings::TileSurroundings;
use crate::build::make_balls::make_missing;
use crate::grid::MapArea;
use crate::plan::Plan;
use crate::plan::side_files::Others;
use crate::plan::window::{self, GROUND_AROUND};
use belvedere::apps::ask::survey_parts::{Looks, SurveyParts};
use belvedere::apps::rows::ObstacleParts;
use belvedere::apps::shadow::ShadowSun;
use belvedere::apps::tree_light::{CrownLight, Season};
use belvedere::apps::viewshed::{SeenProbabilities, Viewshed, ViewshedParams};
use belvedere::control::Control;
use belvedere::ground::{GroundPoints, MapGrid};
use belvedere::medium::Medium;
use belvedere::query::{Answer, Certainty, VisibilityMatrix};
use belvedere::{Error, Parameter, PointCloud, Result};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

/// Survey as a scene of questions about some of its places, such as the cells of a tile.
pub(crate) struct SurveyScene {
    pub(crate) plan: Arc<Plan>,
    /// Folder of the run.
    pub(crate) run: PathBuf,
    /// Obstacles other than balls.
    pub(crate) others: Arc<Others>,
    /// Maximum number of balls that are tested together.
    pub(crate) max_balls: usize,
    /// Memory that points of places may take, bytes.
    pub(crate) memory: u64,
    /// True to make balls that no step made before.
    pub(crate) makes_balls: bool,
    /// Report on the balls.
    pub(crate) search: Arc<Mutex<ObstacleSearch>>,
}

impl SurveyScene {
    /// Returns the surroundings of targets, local metres.
    fn around(&self, targets: &[[f32; 3]]) -> Arc<TileSurroundings> {
        let known = || targets.iter().filter(|target| target.iter().all(|v| v.is_finite()));
        let areas = known().map(|target| MapArea::at(target.map(f64::from)));
        let cells = areas.reduce(|area, one| area.joined(&one)).unwrap_or_else(|| self.plan.area());
        Arc::new(TileSurroundings {
            plan: Arc::clone(&self.plan),
            run: self.run.clone(),
            tile: self.plan.grid().tile_of([0, 1].map(|axis| f64::midpoint(cells.low[axis], cells.high[axis]))),
            cells,
            lowest: known().map(|target| f64::from(target[2])).fold(f64::INFINITY, f64::min),
            others: Arc::clone(&self.others),
            max_balls: self.max_balls,
            search: Arc::clone(&self.search),
        })
    }

    /// Finds the balls that may block `lines`; missing ones are made where that is wanted.
    fn obstacles(
        &self,
        around: &Arc<TileSurroundings>,
        lines: &AreaLines<'_>,
        control: &Control<'_>,
    ) -> Result<TileObstacles> {
        if self.makes_balls {
            for tile in tiles(&self.plan, lines) {
                make_missing(&self.plan, &self.run, tile, control)?;
            }
        }
        TileObstacles::around(around, lines, control)
    }
}

impl SurveyParts for SurveyScene {
    fn crowns(&self) -> Option<CrownLight> {
        self.plan.trees
    }

    fn proves(&self) -> bool {
        self.plan.can_prove()
    }

    fn ground_points(&self) -> GroundPoints {
        self.plan.ground
    }

    fn points_over(&self, grid: &MapGrid, control: &Control<'_>) -> Result<Arc<PointCloud>> {
        let low = [grid.corner[0], grid.corner[1] - grid.cell * grid.height as f64];
        let high = [grid.corner[0] + grid.cell * grid.width as f64, grid.corner[1]];
        let area = MapArea { low, high }.widened(GROUND_AROUND);
        if self.plan.memory_for(&area) > self.memory {
            return Err(Error::invalid(
                Parameter::Position,
                "places without heights all over a large survey",
                "near each other, or with a height each: the ground between them does not fit into memory",
            ));
        }
        window::read(&self.plan, &area, control).map(Arc::new)
    }

    fn light(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<Box<dyn ObstacleParts>> {
        let around = self.around(targets);
        let lines = AreaLines::towards(directions, around.cells, around.lowest);
        Ok(Box::new(TileLight(self.obstacles(&around, &lines, control)?)))
    }

    fn viewshed(
        &self,
        looks: &Looks<'_>,
        targets: &[[f32; 3]],
        params: &ViewshedParams,
        control: &Control<'_>,
    ) -> Result<Viewshed> {
        let around = self.around(targets);
        let lines = AreaLines::to_observers((looks.observers, &params.earth), around.cells, around.lowest);
        let parts = self.obstacles(&around, &lines, control)?;
        let mut sight = PartialSight::new(looks, targets, *params);
        sight.look_past(&parts, &lines, control)?;
        let seen = sight.answered(&around, control)?;
        let are_inside = parts.are_inside_obstacles(targets, control)?;
        let is_counted = |(answer, is_inside): (&Answer, &bool)| *answer == Answer::Blocked && *is_inside;
        around.found().inside_cells = seen.answers.iter().zip(&are_inside).filter(|pair| is_counted(*pair)).count();
        Ok(seen)
    }

    fn seen_probabilities(
        &self,
        looks: &Looks<'_>,
        targets: &[[f32; 3]],
        certainty: Option<Certainty>,
        control: &Control<'_>,
    ) -> Result<SeenProbabilities> {
        let earth = ViewshedParams::default().earth;
        let around = self.around(targets);
        let lines = AreaLines::to_observers((looks.observers, &earth), around.cells, around.lowest);
        let parts = self.obstacles(&around, &lines, control)?;
        let mut evidence = PartialEvidence::of_observers(looks, targets);
        evidence.gather(&parts, &lines, control)?;
        evidence.probabilities(&around, certainty, control)
    }
}

/// Obstacles to light on its way to the cells of a tile.
struct TileLight(TileObstacles);

impl ObstacleParts for TileLight {
    fn crowns(&self) -> Option<CrownLight> {
        self.0.crowns()
    }

    fn medium(&self) -> Option<&Medium> {
        self.0.medium()
    }

    fn look(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> Result<(VisibilityMatrix, Option<VisibilityMatrix>)> {
        self.0.look(targets, directions, control)
    }

    fn are_inside_obstacles(&self, targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<bool>> {
        self.0.are_inside_obstacles(targets, control)
    }

    fn unproven_light(
        &self,
        targets: &[[f32; 3]],
        to_sun: [f64; 3],
        lit: &[f32],
        control: &Control<'_>,
    ) -> Result<Option<Vec<f32>>> {
        let TileSurroundings { plan, run, .. } = &*self.0.tile;
        if !plan.proves {
            return Ok(None);
        }
        let is_lit = |(row, target): (usize, &[f32; 3])| (lit[row] > 0.0).then_some((row, target.map(f64::from)));
        let (rows, lines): (Vec<usize>, Vec<Line>) = targets
            .iter()
            .enumerate()
            .filter_map(is_lit)
            .map(|(row, target)| (row, Line { target, towards: to_sun, range: f64::INFINITY }))
            .unzip();
        let mut doubts = vec![0.0; targets.len()];
        let unproven = unproven((plan, run), &lines, &mut self.0.tile.found(), control)?;
        rows.into_iter().zip(unproven).filter(|(_, is_unproven)| *is_unproven).for_each(|(row, _)| doubts[row] = 1.0);
        Ok(Some(doubts))
    }

    fn lit_probabilities(
        &self,
        targets: &[[f32; 3]],
        to_sun: [f64; 3],
        season: Option<Season>,
        control: &Control<'_>,
    ) -> Result<Vec<f32>> {
        if to_sun[2] <= 0.0 {
            return Ok(targets.iter().map(|target| if target[2].is_finite() { 0.0 } else { f32::NAN }).collect());
        }
        let directions = [to_sun];
        let lines = AreaLines::towards(&directions, self.0.tile.cells, self.0.tile.lowest);
        let mut evidence = PartialEvidence::of_sun(ShadowSun { to_sun, season }, targets);
        evidence.gather(&self.0, &lines, control)?;
        Ok(evidence.probabilities(&self.0.tile, None, control)?.expected)
    }
}
