//! The plan of a run: everything that a tile must know beside its own points.

use crate::cell_sizes::CellSizes;
use crate::grid::{MapArea, TileGrid, TileId, block_area};
use crate::inputs::{InputFile, NOWHERE, PIECE_ROWS, PointColumns, hash};
use crate::planned::{Others, SideFile, added_meshes, far_terrain};
use crate::question::TileQuestion;
use crate::sealed::{is_sound, sealed};
use crate::stage::Stage;
use crate::survey::{SurveyBlock, survey};
use crate::window;
use belvedere::apps::targets::{grid_around, set_on_ground};
use belvedere::apps::tree_light::CrownLight;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::ground::{Ground, GroundParams};
use belvedere::io::{Insistence, LasHead, atomic, cloud_files};
use belvedere::model::{ClearedArea, ModelParams, SurveyStatistics};
use belvedere::query::Coverage;
use belvedere::results::ResultKind;
use belvedere::{Bounds, Error, Frame, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Version of the layout of plans and records.
const LAYOUT: u32 = 9;
/// Corners that the origin of local coordinates is one of, metres: of blocks of 64 m, and few, so that neighbouring
/// surveys share it.
const ORIGIN_STEP: f64 = 1024.0;
/// Farthest that a point may lie from the origin, metres: up to here f32 keeps a millimetre.
const FARTHEST: f64 = 16_384.0;
/// Smallest and largest side of a tile, metres.
const MIN_TILE: f64 = 16.0;
const LARGEST_TILE: f64 = 8192.0;
/// Points around a place that its ground is taken from, metres, beside the usual ones.
const GROUND_AROUND: f64 = 32.0;
/// How a plan is made.
#[derive(Clone, Debug)]
pub struct PlanParams {
    /// Files, folders and catalogues of tiles.
    pub clouds: Vec<PathBuf>,
    /// Reference system of files that name none, or the same.
    pub crs: Option<String>,
    /// Whether it holds against the files and their coordinates. Default: contradictions are errors.
    pub crs_against_files: Insistence,
    /// Side of a tile, metres. Default 512: a multiple of the blocks of 64 m, so that no point is looked at for
    /// nothing.
    pub tile_size: f64,
    /// Sides of the cells of results. Default 1 m.
    pub cells: CellSizes,
    /// Places that the survey must hold, in its coordinates: one outside is refused before points are read. Default
    /// none.
    pub places: Vec<[f64; 2]>,
    /// Most memory that a tile may take, bytes: tiles are quartered until the largest fits. `None` for any.
    pub memory: Option<u64>,
    /// Name and version of the program.
    pub program: String,
}

impl Default for PlanParams {
    fn default() -> Self {
        Self {
            clouds: Vec::new(),
            crs: None,
            crs_against_files: Insistence::Refuse,
            tile_size: 512.0,
            cells: CellSizes::default(),
            places: Vec::new(),
            memory: None,
            program: String::new(),
        }
    }
}

/// A plan: input files, tiles and what is known of the whole survey. It is the same for the same files and parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    layout: u32,
    /// Name and version of the program that made it.
    pub program: String,
    /// Files of the survey.
    pub inputs: Vec<InputFile>,
    /// Reference system that was given.
    pub(crate) crs: Option<String>,
    /// Whether it holds against the files.
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) crs_override: bool,
    frame: PlanFrame,
    pub(crate) columns: PointColumns,
    /// Side of a tile, metres.
    pub tile_size: f64,
    /// Sides of the cells of results.
    pub cells: CellSizes,
    /// How far around a tile points are read, metres.
    #[serde(rename = "halo")]
    pub buffer: f64,
    /// The questions that are answered.
    pub questions: Vec<TileQuestion>,
    /// Meshes of what is planned, which block beside what was surveyed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<SideFile>,
    /// Areas without what stands there now.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) cleared: Vec<ClearedArea>,
    /// Heights of the ground beyond the survey.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    terrain: Option<SideFile>,
    /// Horizon beyond the survey, for all places alike.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    horizon: Option<SideFile>,
    /// Trees, where they let light through.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) trees: Option<CrownLight>,
    /// Tiles that may hold points, from the south-west.
    pub tiles: Vec<TileId>,
    low: [f32; 3],
    high: [f32; 3],
    #[serde(rename = "facts")]
    pub(crate) statistics: SurveyStatistics,
    pub(crate) blocks: Vec<SurveyBlock>,
    /// What records name the plan by that they belong to: a fingerprint of its file; empty before it was read from one.
    #[serde(skip)]
    pub(crate) name: String,
    /// What is odd about the files, while the plan is made.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// Where local coordinates lie.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanFrame {
    /// Origin, metres.
    pub origin: [f64; 3],
    /// Metres per unit of the files along each axis.
    pub metres_per_unit: [f64; 3],
    /// Reference system as text; empty where it is not known.
    pub system: String,
    /// What in the files speaks against it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubt: Option<String>,
}

/// What plans of all versions say.
#[derive(Deserialize)]
struct Version {
    layout: u32,
    program: String,
}

impl Plan {
    /// Looks at all points once, and plans the tiles, without a question.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for sizes out of range, places outside, a survey that is too wide for one frame, and
    /// memory into which no tile fits; those of reading the files, and of [`SurveyStatistics::estimate`].
    pub fn make(params: &PlanParams, control: &Control<'_>) -> Result<Self> {
        check_sizes(params)?;
        let (mut inputs, heads) = inputs(&params.clouds)?;
        let with_crs = heads.iter().position(|head| head.crs.epsg.is_some() || head.crs.wkt.is_some()).unwrap_or(0);
        let crs = system_of(params, &inputs, &heads, with_crs)?;
        let metres_per_unit = crs.metres_per_unit_xyz();
        let ends = |end: usize, axis: usize| {
            inputs.iter().filter(|file| file.points > 0).map(move |file| file.bounds[end][axis] * metres_per_unit[axis])
        };
        let low: [f64; 3] = std::array::from_fn(|axis| ends(0, axis).fold(f64::INFINITY, f64::min));
        let high: [f64; 3] = std::array::from_fn(|axis| ends(1, axis).fold(f64::NEG_INFINITY, f64::max));
        if low.iter().zip(&high).any(|(low, high)| !(low <= high)) {
            return Err(Error::NoPoints { what: "no file has a point".to_owned() });
        }
        if let Some(what) = crs.refusal(low.map(|v| v / metres_per_unit[0])) {
            return Err(Error::UnusableCrs { path: inputs[with_crs].path.clone(), what });
        }
        let holds = |place: &[f64; 2]| (0..2).all(|i| (low[i]..=high[i]).contains(&(place[i] * metres_per_unit[i])));
        if let Some([x, y]) = params.places.iter().find(|place| !holds(place)) {
            return Err(without_ground(format!("{x}, {y}")));
        }
        let origin: [f64; 3] =
            std::array::from_fn(|i| (f64::midpoint(low[i], high[i]) / ORIGIN_STEP).round() * ORIGIN_STEP);
        if (0..2).any(|i| low[i] - origin[i] < -FARTHEST || high[i] - origin[i] > FARTHEST) {
            let [width, height] = [0, 1].map(|i| ((high[i] - low[i]) / 1000.0).ceil());
            return Err(Error::InvalidParameter {
                parameter: Parameter::Extent,
                value: format!("{width} x {height} km"),
                expected: "at most 32 x 32 km; make a plan for each part, with the tiles around it",
            });
        }
        let system = crs.wkt.clone().or_else(|| crs.epsg.map(|code| format!("EPSG:{code}"))).unwrap_or_default();
        let frame = PlanFrame { origin, metres_per_unit, system, doubt: crs.doubt.clone() };
        if frame.to_frame().is_err() {
            let what =
                format!("its reference system, {}, is not known to this program; give it with --crs", crs.describe());
            return Err(Error::UnusableCrs { path: inputs[with_crs].path.clone(), what });
        }
        let columns = PointColumns::common(&heads);
        let of_file = |(file, head): (&InputFile, &LasHead)| {
            let path = file.path.display().to_string();
            head.notes.iter().map(|note| format!("{path}: {note}")).collect::<Vec<_>>()
        };
        let notes: Vec<String> = inputs.iter().zip(&heads).flat_map(of_file).collect();
        let files: Vec<PathBuf> = inputs.iter().map(|file| file.path.clone()).collect();
        let points = inputs.iter().map(|file| file.points).sum();
        let local = |v: [f64; 3]| [v[0] - origin[0], v[1] - origin[1]];
        let area = MapArea { low: local(low), high: local(high) };
        let options = window::options(params.crs.as_deref(), params.crs_against_files, frame.to_frame()?);
        let found = control.stage("surveying", usize::try_from(points).unwrap_or(0), || {
            survey(&files, &options, columns, points, &area, control)
        })?;
        for input in &mut inputs {
            input.pieces = found.pieces.get(&input.path).cloned().unwrap_or_default();
            // rows at the end may all have been left out
            input.pieces.resize(usize::try_from(input.points.div_ceil(PIECE_ROWS)).unwrap_or(0), NOWHERE);
        }
        let bounds = found.bounds.ok_or_else(|| Error::NoPoints { what: "all points are noise".to_owned() })?;
        let model = ModelParams::default();
        let statistics =
            SurveyStatistics::estimate(&files[0], &found.along_lines, &found.places, &found.extremes, &model, control)?;
        let mut plan = Self {
            layout: LAYOUT,
            program: params.program.clone(),
            inputs,
            crs: params.crs.clone(),
            crs_override: params.crs_against_files == Insistence::Insist,
            columns,
            tile_size: params.tile_size,
            cells: params.cells.clone(),
            // in steps, so that it does not look more exact than it is
            buffer: statistics.buffer(&model).ceil(),
            questions: Vec::new(),
            meshes: Vec::new(),
            cleared: Vec::new(),
            terrain: None,
            horizon: None,
            trees: None,
            tiles: Vec::new(),
            low: bounds.low,
            high: bounds.high,
            statistics,
            blocks: found.blocks,
            frame,
            name: String::new(),
            notes,
        };
        plan.tiles = plan.tiles_with_cells();
        match params.memory {
            Some(memory) => plan.fitting(memory),
            None => Ok(plan),
        }
    }

    /// Whether the reference system that was given holds against the files.
    pub(crate) fn insistence(&self) -> Insistence {
        if self.crs_override { Insistence::Insist } else { Insistence::Refuse }
    }

    /// Reads the plan of a run.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a folder without a plan, for what is no plan, and for one of another
    /// version.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = Self::path(folder);
        let refused = |what: String| Err(Error::malformed(&path, format!("{what} again with `belvedere city plan`")));
        let bytes = match std::fs::read(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let what = "is not there: make a plan first with `belvedere city plan`";
                return Err(Error::malformed(&path, what));
            }
            read => read.map_err(Error::io(&path))?,
        };
        if let Ok(Version { layout, program }) = serde_json::from_slice(&bytes)
            && layout != LAYOUT
        {
            return refused(format!(
                "is a plan of {program} in layout {layout}, but this program reads layout {LAYOUT}; make it, in another folder,"
            ));
        }
        if !is_sound(&bytes) {
            return refused("is no plan, or a damaged or edited one: its checksum does not fit; make it".to_owned());
        }
        let mut plan: Self = match serde_json::from_slice(&bytes) {
            Ok(plan) => plan,
            Err(error) => return refused(format!("is no plan, or a damaged one ({error}); make it")),
        };
        if let Err(error) = check_names(&plan.questions) {
            return refused(format!("is a damaged plan: {error}; make it"));
        }
        if check_numbers(&plan).is_none() {
            return refused("is a damaged plan: its numbers cannot be; make it".to_owned());
        }
        plan.name = hash(&bytes);
        Ok(plan)
    }

    /// Writes the plan into the folder of a run, which is made.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a folder with results of another plan.
    pub fn write(&self, folder: &Path) -> Result<()> {
        atomic::make_folder(folder)?;
        let path = Self::path(folder);
        let text = sealed(self).map_err(|e| Error::malformed(&path, format!("cannot be written: {e}")))?;
        let has_results =
            || folder.read_dir().is_ok_and(|mut entries| entries.any(|entry| entry.is_ok_and(|e| e.path().is_dir())));
        // a damaged plan may be that of the results
        let is_other =
            |before: Vec<u8>| before != text.as_bytes() && serde_json::from_slice::<Version>(&before).is_ok();
        if std::fs::read(&path).is_ok_and(is_other) && has_results() {
            let what = "is another plan, and its results are in the folder; give another folder, or remove this one";
            return Err(Error::malformed(&path, what));
        }
        atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))
    }

    /// Where the plan of a run lies.
    #[must_use]
    pub fn path(folder: &Path) -> PathBuf {
        folder.join("plan.json")
    }

    /// The frame of all tiles.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a reference system that this program does not know.
    pub fn frame(&self) -> Result<Frame> {
        self.frame.to_frame()
    }

    /// The smallest box around the survey, local metres.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds { low: self.low, high: self.high }
    }

    /// The grid of tiles.
    #[must_use]
    pub fn grid(&self) -> TileGrid {
        TileGrid { size: self.tile_size, origin: [self.frame.origin[0], self.frame.origin[1]] }
    }

    /// How balls of tiles are made.
    pub(crate) fn model(&self) -> ModelParams {
        ModelParams::default().with_statistics(Some(Arc::new(self.statistics.clone())))
    }

    /// Files that may have points in `area`.
    pub(crate) fn files_meeting(&self, area: &MapArea) -> impl Iterator<Item = &InputFile> {
        // what headers round bounds by
        let area = area.widened(0.1);
        let PlanFrame { origin, metres_per_unit, .. } = &self.frame;
        let local = move |v: f64, axis: usize| v * metres_per_unit[axis] - origin[axis];
        self.inputs.iter().filter(move |file| {
            file.points > 0
                && (0..2).all(|axis| {
                    local(file.bounds[0][axis], axis) <= area.high[axis]
                        && area.low[axis] <= local(file.bounds[1][axis], axis)
                })
        })
    }

    /// The area whose points a tile needs for its balls.
    pub(crate) fn window(&self, tile: TileId) -> MapArea {
        self.grid().core(tile).in_blocks().widened(self.buffer)
    }

    /// Blocks of 64 m with points that meet `area`.
    pub(crate) fn blocks_in(&self, area: &MapArea) -> impl Iterator<Item = &SurveyBlock> {
        area.blocks().filter_map(|at| {
            let place = self.blocks.binary_search_by_key(&at, |block| block.at).ok()?;
            self.blocks.get(place)
        })
    }

    /// The tiles with cells for the result of a question, from the south-west: all but some at the edge of the survey
    /// that only larger cells reach.
    pub(crate) fn tiles_of(&self, question: &TileQuestion) -> Vec<TileId> {
        let cell = self.cells.of(question);
        self.tiles.iter().copied().filter(|&tile| self.has_cells(tile, cell)).collect()
    }

    /// Tiles with cells for any result.
    pub(crate) fn tiles_with_cells(&self) -> Vec<TileId> {
        let (grid, cell) = (self.grid(), self.cells.largest());
        let of_block = |block: &SurveyBlock| {
            let area = block_area(block.at).widened(self.reach(cell));
            let (first, last) = (grid.tile_of(area.low), grid.tile_of(area.high));
            (first.north..=last.north)
                .flat_map(move |north| (first.east..=last.east).map(move |east| TileId { east, north }))
        };
        let tiles: BTreeSet<TileId> = self.blocks.iter().flat_map(of_block).collect();
        tiles.into_iter().filter(|&tile| self.has_cells(tile, cell)).collect()
    }

    /// Whether cells of a side may get a height on a tile: it is near points.
    pub(crate) fn has_cells(&self, tile: TileId, cell: f64) -> bool {
        let reach = self.reach(cell);
        let core = self.grid().core(tile);
        let (low, high) = self.bounds().on_map();
        (0..2).all(|axis| core.low[axis] <= high[axis] + reach && low[axis] - reach < core.high[axis])
            && self.blocks_in(&core.widened(reach)).next().is_some()
    }

    /// This with other questions.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for two questions whose results would lie in one folder and for parameters outside
    /// their range; those of reading weather.
    pub fn with_questions(self, questions: Vec<TileQuestion>, control: &Control<'_>) -> Result<Self> {
        check_names(&questions)?;
        questions.iter().try_for_each(|question| question.prepare(self.trees, control).map(|_| ()))?;
        Ok(Self { questions, ..self })
    }

    /// This with meshes of what is planned, such as buildings: their triangles block exactly, beside what was surveyed,
    /// and targets of cells below them lie on top of them.
    ///
    /// # Errors
    /// Those of reading meshes, and [`Error::InvalidParameter`] for one that does not lie on the survey.
    pub fn with_meshes(self, meshes: Vec<SideFile>) -> Result<Self> {
        added_meshes(&meshes, &self.frame()?, Coverage::of(self.bounds()).as_ref())?;
        Ok(Self { meshes, ..self })
    }

    /// This before far terrain, an elevation raster and a horizon as [`read_terrain`](belvedere::io::read_terrain) and
    /// [`read_horizon`](belvedere::io::read_horizon) take them: directions to the sun and the sky below it are blocked.
    /// Within the box of the survey, and a cell of the raster around it, terrain blocks nothing.
    ///
    /// # Errors
    /// Those of reading the files, and [`Error::InvalidParameter`] for terrain that does not reach the survey or lies
    /// far above or below it.
    pub fn with_far_terrain(self, terrain: Option<SideFile>, horizon: Option<SideFile>) -> Result<Self> {
        far_terrain(terrain.as_ref(), horizon.as_ref(), &self.frame()?, self.bounds())?;
        Ok(Self { terrain, horizon, ..self })
    }

    /// This with trees that let light through, where questions ask for light.
    ///
    /// # Errors
    /// [`Error::MissingAttribute`] for a survey whose pulses do not say what vegetation is.
    pub fn with_light_through_trees(self, trees: CrownLight) -> Result<Self> {
        if !(self.statistics.carves && self.statistics.measures_crowns) {
            return Err(Error::MissingAttribute {
                attribute: "return numbers and GPS times",
                needed_for: "knowing which balls are vegetation",
                advice: "use a survey that has them, or opaque trees",
            });
        }
        Ok(Self { trees: Some(trees), ..self })
    }

    /// Share of the pulses that get through crowns, in the places that the plan looked at.
    #[must_use]
    pub fn share_of_pulses_through_crowns(&self) -> f64 {
        self.statistics.whole.transmission
    }

    /// The meshes of what is planned, and far terrain.
    ///
    /// # Errors
    /// Those of reading them, and [`Error::Malformed`] for a file that changed since the plan was made.
    pub(crate) fn others(&self) -> Result<Others> {
        let frame = self.frame()?;
        Ok(Others {
            added: added_meshes(&self.meshes, &frame, None)?,
            far_terrain: far_terrain(self.terrain.as_ref(), self.horizon.as_ref(), &frame, self.bounds())?,
        })
    }

    /// What the values of a result are.
    pub(crate) fn kind_of(&self, question: &TileQuestion) -> ResultKind {
        question.kind(self.trees.is_none())
    }

    /// Puts places on the map, local metres, on the ground: each that has no height gets `height` metres above the
    /// ground there.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a place without ground, those of reading the files and of [`Ground::of_cloud`].
    pub fn set_on_ground(&self, places: &mut [[f64; 3]], height: f64, control: &Control<'_>) -> Result<()> {
        let origin = self.frame.origin;
        for place in places {
            let Some(grid) = grid_around([*place], origin)? else { continue };
            let corner = [grid.corner[0], grid.corner[1] - grid.cell * grid.height as f64];
            let area = MapArea { low: corner, high: [corner[0] + grid.cell * grid.width as f64, grid.corner[1]] };
            let cloud = window::read(self, &area.widened(GROUND_AROUND), control)?;
            let ground = match Ground::of_cloud(&cloud, grid, &GroundParams::default(), control) {
                Err(error) if !window::is_nothing(&error) => return Err(error),
                ground => ground.ok(),
            };
            let unknown = ground.map(|(ground, _)| set_on_ground([(&mut *place, height)], &ground));
            if unknown.is_none_or(|unknown| !unknown.is_empty()) {
                return Err(without_ground(format!("{}, {}", place[0] + origin[0], place[1] + origin[1])));
            }
        }
        Ok(())
    }

    /// This with tiles that are quartered until the largest fits into the memory, bytes: their size changes no result.
    fn fitting(mut self, memory: u64) -> Result<Self> {
        let (size, needed) = (self.tile_size, self.estimate().memory_bytes);
        while self.estimate().memory_bytes > memory {
            if self.tile_size / 2.0 < MIN_TILE || !self.cells.divide(self.tile_size / 2.0) {
                let megabytes = |bytes: u64| bytes as f64 / 1e6;
                return Err(Error::InvalidParameter {
                    parameter: Parameter::TileMemory,
                    value: format!(
                        "{:.0} MB, but a tile of {size} m takes about {:.0} MB, and one of {} m {:.0} MB",
                        megabytes(memory),
                        megabytes(needed),
                        self.tile_size,
                        megabytes(self.estimate().memory_bytes)
                    ),
                    expected: "enough for a small tile with what is around it",
                });
            }
            self.tile_size /= 2.0;
            self.tiles = self.tiles_with_cells();
        }
        Ok(self)
    }
}

impl PlanFrame {
    fn to_frame(&self) -> Result<Frame> {
        let named = if self.system.is_empty() { Crs::default() } else { Crs::parse(&self.system)? };
        // units may follow from another record than the system
        let crs = Crs {
            metres_per_unit: self.metres_per_unit[0],
            vertical_metres_per_unit: self.metres_per_unit[2],
            doubt: self.doubt.clone(),
            ..named
        };
        Ok(Frame { origin: self.origin, crs })
    }
}

/// The reference system of a survey: the one that is given, with the heights of the files where it names none, or that
/// of the file that names one.
fn system_of(params: &PlanParams, inputs: &[InputFile], heads: &[LasHead], with_crs: usize) -> Result<Crs> {
    let of_files = &heads[with_crs].crs;
    let Some(text) = &params.crs else { return Ok(of_files.clone()) };
    let given = Crs::parse(text)?;
    if params.crs_against_files == Insistence::Insist {
        return Ok(given);
    }
    for (input, head) in inputs.iter().zip(heads).filter(|(_, head)| head.points > 0) {
        let middle = [0, 1].map(|axis| f64::midpoint(head.bounds[0][axis], head.bounds[1][axis]));
        given.check_given(&head.crs, middle, &input.path)?;
    }
    Ok(given.with_heights_of(of_files))
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde calls")]
fn is_false(value: &bool) -> bool {
    !value
}

fn without_ground(value: String) -> Error {
    let expected = "a place of the survey with ground, or with its height as a third coordinate";
    Error::InvalidParameter { parameter: Parameter::Observer, value, expected }
}

fn inputs(clouds: &[PathBuf]) -> Result<(Vec<InputFile>, Vec<LasHead>)> {
    let found: Vec<(InputFile, LasHead)> =
        cloud_files(clouds)?.iter().map(|file| InputFile::new(file)).collect::<Result<_>>()?;
    if let Some((first, rest)) = found.split_first()
        && let Some((other, _)) = rest.iter().find(|(_, head)| head.crs.contradicts(&first.1.crs))
    {
        let what = format!("is in another reference system than {}; convert one of them", first.0.path.display());
        return Err(Error::UnusableCrs { path: other.path.clone(), what });
    }
    Ok(found.into_iter().unzip())
}

fn check_sizes(params: &PlanParams) -> Result<()> {
    params.cells.check()?;
    let size = params.tile_size;
    if !((MIN_TILE..=LARGEST_TILE).contains(&size) && params.cells.divide(size)) {
        let expected = "16 to 8192 m, and a whole number of cells";
        return Err(Error::InvalidParameter { parameter: Parameter::TileSize, value: format!("{size} m"), expected });
    }
    Ok(())
}

/// Refuses questions whose results would lie in one folder, or in one that is not below that of the run.
fn check_names(questions: &[TileQuestion]) -> Result<()> {
    let mut names = BTreeSet::from([Stage::Balls.name()]);
    for name in questions.iter().map(TileQuestion::name) {
        let is_plain = |c: char| c.is_alphanumeric() || "_-+.".contains(c);
        let refused =
            |value: String, expected| Err(Error::InvalidParameter { parameter: Parameter::Questions, value, expected });
        if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
            return refused(format!("{name:?}"), "names of letters, digits, _, -, + and ., which are those of folders");
        }
        if !names.insert(name) {
            return refused(format!("{name} twice"), "each question once");
        }
    }
    Ok(())
}

/// The numbers of a plan that must not be anything.
fn check_numbers(plan: &Plan) -> Option<()> {
    let finite = plan.frame.origin.iter().chain(&plan.frame.metres_per_unit).chain([&plan.buffer, &plan.tile_size]);
    let sizes = PlanParams { tile_size: plan.tile_size, cells: plan.cells.clone(), ..PlanParams::default() };
    let are_whole = plan.inputs.iter().all(InputFile::has_sound_pieces);
    let are_sorted = plan.blocks.windows(2).all(|pair| pair[0].at < pair[1].at);
    let is_sound =
        finite.clone().all(|v| v.is_finite()) && plan.buffer > 0.0 && plan.buffer < 1e4 && are_sorted && are_whole;
    (is_sound && plan.has_sound_areas(plan.frame.origin) && check_sizes(&sizes).is_ok()).then_some(())
}
