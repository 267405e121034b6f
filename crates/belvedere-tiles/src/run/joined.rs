//! A survey, or a part of it, as one model that is joined from tiles. It is the model of the same cloud and takes less
//! memory to make.

use crate::answer::lines::MAX_BALL;
use crate::answer::obstacles::ObstacleSearch;
use crate::answer::proof::{reach_of_pulses, top};
use crate::build::make_balls::make_missing;
use crate::grid::{MapArea, TileId};
use crate::plan::Plan;
use crate::plan::record::{TileOutcome, TileRecord};
use crate::plan::stage::Stage;
use crate::plan::window::GROUND_AROUND;
use crate::run::any_size::{SurveyPart, size_in_words};
use belvedere::control::Control;
use belvedere::medial::LIMIT_TOUCH;
use belvedere::model::{ModelParts, SceneModel};
use belvedere::pulses::FreeSegmentColumns;
use belvedere::{Error, ExtinctionVoxels, Frame, Parameter, PointCloud, Result};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Memory of a joined model with its points for each point, and without any point, bytes, as measured in docs/scale.md.
const BYTES_PER_POINT: f64 = 330.0;
const MIN_BYTES: f64 = 100e6;
/// Additional width around a part, metres, so that rounding leaves out no point at its edge.
const EDGE: f64 = 0.01;

/// Tiles of a survey whose obstacles are joined into one model.
pub struct JoinedSurvey {
    plan: Plan,
    /// Folder of the tiles.
    run: PathBuf,
    /// Tiles, from the south-west.
    tiles: Vec<TileId>,
    /// Area that they cover, in the coordinates of the files; `None` for all of the survey.
    pub part: Option<SurveyPart>,
    /// Frame that its points must have.
    pub frame: Frame,
}

impl JoinedSurvey {
    /// Takes the survey of a plan that is kept in `folder`: all of it, or the tiles that lines of sight between places
    /// and within a distance of these, metres, may meet. Places are in the coordinates of the files. The model and its
    /// points may take `memory` bytes.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a model that takes more. Also those of writing the plan.
    pub fn new(plan: Plan, folder: &Path, within: Option<(&[[f64; 2]], f64)>, memory: u64) -> Result<Self> {
        let proves = plan.can_prove();
        let (plan, run) = Plan { proves, ..plan }.ready_in(folder)?;
        let area = within.and_then(|(places, distance)| area_of_tiles(&plan, places, distance));
        let needed = plan.memory_at(area.as_ref().unwrap_or(&plan.area()), [MIN_BYTES, BYTES_PER_POINT]);
        if needed > memory {
            let [needed, memory] = [needed, memory].map(size_in_words);
            return Err(Error::invalid(
                Parameter::TileMemory,
                format!("{memory}, but the scene takes {needed}, although its balls are made in tiles"),
                "enough for the scene: allow more memory, or limit the question to places and a distance from them",
            ));
        }
        let is_in = |tile: &TileId| area.is_none_or(|area| plan.grid().core(*tile).meets(&area));
        let tiles = plan.tiles.iter().copied().filter(is_in).collect();
        let part = area.map(|area| plan.frame.area_in_files(&area.widened(EDGE)));
        Ok(Self { frame: plan.frame()?, plan, run, tiles, part })
    }

    /// Makes the balls of its tiles, if they are missing.
    ///
    /// # Errors
    /// Those of [`make_balls`](crate::make_balls).
    pub fn make_balls(&self, control: &Control<'_>) -> Result<()> {
        self.tiles.iter().try_for_each(|&tile| make_missing(&self.plan, &self.run, tile, control))
    }

    /// Joins the obstacles of its tiles. `cloud` has the points of [`JoinedSurvey::part`] in the order of their files.
    /// A ball that touches a point of another tile counts as cut to a limit ([`LIMIT_TOUCH`]).
    ///
    /// # Errors
    /// [`Error::NoPoints`] for balls that could not be made or belong to other points. Also those of
    /// [`SceneModel::joined`].
    pub fn model(&self, cloud: &PointCloud, control: &Control<'_>) -> Result<SceneModel> {
        let Self { plan, run, tiles, frame, .. } = self;
        let mut rows: HashMap<TileId, Vec<u32>> = HashMap::new();
        for (row, p) in (0..).zip(&cloud.positions) {
            rows.entry(plan.grid().tile_of([p[0].into(), p[1].into()])).or_default().push(row);
        }
        let mut found = ObstacleSearch::default();
        let mut joined = JoinedParts::default();
        control.stage("reading balls", tiles.len(), || {
            tiles.iter().try_for_each(|&tile| {
                control.check()?;
                let rows = rows.remove(&tile).unwrap_or_default();
                let record = TileRecord::read(plan, run, Stage::Balls, tile);
                let has_balls = record.is_none_or(|record| record.outcome != TileOutcome::Nothing);
                if let Some(parts) = has_balls.then(|| found.read(plan, run, tile, control)).transpose()?.flatten() {
                    joined.add(parts, &rows).ok_or_else(|| without_balls("belong to other points"))?;
                }
                if let Some(pulses) = found.pulses(plan, run, tile, control)? {
                    joined.add_pulses(pulses);
                }
                joined.voxels.extend(found.crowns((plan, run, tile), control)?);
                Ok(())
            })
        })?;
        if !found.missing.is_empty() {
            return Err(without_balls("could not be built"));
        }
        let (parts, counts) = joined.into_parts();
        let parts = ModelParts { frame: frame.clone(), bounds: plan.bounds(), ..parts };
        SceneModel::joined(parts, &counts, cloud, &plan.statistics)
    }
}

/// Returns the area of the tiles that lines of sight between `places` and within `distance` metres of these may meet,
/// local metres; `None` for places beside the survey.
fn area_of_tiles(plan: &Plan, places: &[[f64; 2]], distance: f64) -> Option<MapArea> {
    let places = places.iter().map(|place| plan.frame.place_in_metres(*place));
    let area = places.map(|[x, y]| MapArea::at([x, y, 0.0])).reduce(|all, one| all.joined(&one))?;
    let pulses = if plan.can_prove() { reach_of_pulses(plan, top(plan)) } else { 0.0 };
    let area = area.widened(distance + pulses.max(MAX_BALL).max(GROUND_AROUND)).common(&plan.area().widened(EDGE))?;
    let grid = plan.grid();
    Some(grid.core(grid.tile_of(area.low)).joined(&grid.core(grid.tile_of(area.high))))
}

/// Returns the error of a tile without the balls of its points.
fn without_balls(why: &str) -> Error {
    Error::NoPoints { what: format!("balls of a tile {why}; ask again to make them once more") }
}

/// Obstacles of tiles, one after the other.
#[derive(Default)]
struct JoinedParts {
    parts: ModelParts,
    /// Number of balls of each tile.
    counts: Vec<usize>,
    /// Triangles of patches so far, as bits: several tiles may have the same.
    triangles: HashSet<[[u32; 3]; 3]>,
    voxels: BTreeMap<[i32; 3], f32>,
}

impl JoinedParts {
    /// Adds the obstacles of a tile, whose points have these `rows`; `None` for balls of other points.
    fn add(&mut self, tile: ModelParts, rows: &[u32]) -> Option<()> {
        let ModelParts { mut balls, mut transmission, patches, provenance, .. } = tile;
        for (source, touch) in balls.source.iter_mut().zip(&mut balls.touch) {
            *source = *rows.get(*source as usize)?;
            if *touch < LIMIT_TOUCH {
                *touch = *rows.get(*touch as usize)?;
            }
        }
        let own = &mut self.parts;
        self.counts.push(balls.len());
        // vegetation is known of all tiles or of none
        transmission.resize(balls.len(), f32::NAN);
        own.transmission.append(&mut transmission);
        own.balls.centers.append(&mut balls.centers);
        own.balls.radii.append(&mut balls.radii);
        own.balls.source.append(&mut balls.source);
        own.balls.touch.append(&mut balls.touch);
        own.balls.separation_angles.append(&mut balls.separation_angles);
        for (corners, kind) in patches.iter() {
            if self.triangles.insert(corners.map(|corner| corner.map(f32::to_bits))) {
                own.patches.push(*corners, kind);
            }
        }
        if own.provenance.is_empty() {
            own.provenance = provenance;
            own.provenance.remove("tile");
        }
        Some(())
    }

    fn add_pulses(&mut self, pulses: FreeSegmentColumns) {
        match &mut self.parts.pulses {
            Some(own) => own.append(pulses),
            none => *none = Some(pulses),
        }
    }

    /// Returns the obstacles of all tiles, and the number of balls of each.
    fn into_parts(self) -> (ModelParts, Vec<usize>) {
        let Self { parts, counts, voxels, .. } = self;
        let is_known = parts.transmission.iter().any(|share| !share.is_nan());
        let (voxels, extinction) = voxels.into_iter().unzip();
        let medium = ExtinctionVoxels { voxels, extinction };
        let parts = ModelParts {
            transmission: if is_known { parts.transmission } else { Vec::new() },
            medium: (!medium.is_empty()).then_some(medium),
            pulses: parts.pulses.map(FreeSegmentColumns::in_order),
            ..parts
        };
        (parts, counts)
    }
}
