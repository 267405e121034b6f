//! Plan of a run: all data that a tile needs beside its own points.

pub(crate) mod cell_sizes;
mod cleared_areas;
pub(crate) mod estimate;
mod kept_survey;
pub(crate) mod make_plan;
pub(crate) mod prepared;
pub(crate) mod question;
pub(crate) mod record;
pub(crate) mod side_files;
pub(crate) mod stage;
pub(crate) mod survey;
pub(crate) mod window;

use crate::grid::{MapArea, TileGrid, TileId, block_area};
use crate::inputs::{InputFile, PointColumns, bytes_of_file, hash};
use crate::plan::cell_sizes::CellSizes;
use crate::plan::question::{BALLS, TileQuestion};
use crate::plan::side_files::{Others, SideFile, added_meshes, far_terrain};
use crate::sealed::{is_sound, sealed};
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::apps::ask::{Context, GridCells, Remark, density_at, remark_on_terrain};
use belvedere::apps::targets::{CellLevel, CellParams};
use belvedere::apps::tree_light::CrownLight;
use belvedere::apps::viewshed::cell_for;
use belvedere::cast::to_index;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::ground::{GroundPoints, MapGrid};
use belvedere::io::{Insistence, atomic};
use belvedere::model::{ClearedArea, ModelParams, SurveyBlock, SurveyStatistics};
use belvedere::query::{Coverage, FarTerrain};
use belvedere::shown::Address;
use belvedere::weather::CalendarDay;
use belvedere::{Bounds, Error, Frame, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Version of the layout of plans and records.
pub(crate) const LAYOUT: u32 = 14;
/// Plan: input files, tiles and statistics of the whole survey. The same files and parameters give the same plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    pub(crate) layout: u32,
    /// Name and version of the program that made the plan.
    pub program: String,
    /// Files of the survey.
    pub inputs: Vec<InputFile>,
    /// Reference system given by the user.
    pub(crate) crs: Option<String>,
    /// True if the given reference system holds against that of the files.
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) crs_override: bool,
    /// Day of the flight given by the user.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) flown: Option<String>,
    pub(crate) frame: PlanFrame,
    pub(crate) columns: PointColumns,
    /// Side of a tile, metres.
    pub tile_size: f64,
    /// Sides of the cells of results.
    pub cells: CellSizes,
    /// Level of cells, on the ground or on the surface, and height of targets above it.
    #[serde(default = "on_surface")]
    pub(crate) targets: CellParams,
    /// Kind of ground points: points of class 2, or detected points.
    pub(crate) ground: GroundPoints,
    /// True if the pulses that prove lines of sight free are kept.
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) proves: bool,
    /// Proof distance: maximum distance between a pulse and a place that it proves empty, metres.
    pub(crate) nearness: f64,
    /// Width of the margin around a tile within which points are read, metres.
    #[serde(rename = "halo")]
    pub buffer: f64,
    /// Questions that the run answers.
    pub questions: Vec<TileQuestion>,
    /// Meshes of planned objects, which block beside the surveyed objects.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) meshes: Vec<SideFile>,
    /// Areas cleared of their present objects.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) cleared: Vec<ClearedArea>,
    /// Elevation raster of the ground beyond the survey.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) terrain: Option<SideFile>,
    /// Horizon beyond the survey, the same for all places.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) horizon: Option<SideFile>,
    /// Treatment of light in crowns; `None` for opaque trees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) trees: Option<CrownLight>,
    /// Tiles that may contain points, from the south-west.
    pub tiles: Vec<TileId>,
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
    #[serde(rename = "facts")]
    pub(crate) statistics: SurveyStatistics,
    pub(crate) blocks: Vec<SurveyBlock>,
    /// Fingerprint of the file of the plan, by which records name their plan. Empty until the plan is read from a file.
    #[serde(skip)]
    pub(crate) name: String,
    /// Fingerprint of the plan without questions, by which records of balls name their plan. Empty as long as `name`
    /// is.
    #[serde(skip)]
    pub(crate) survey_name: String,
    /// Folder of balls that several plans of a survey share; `None` for the folder of the run.
    #[serde(skip)]
    pub(crate) shared_balls: Option<PathBuf>,
    /// Points of places all over the survey, local metres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) sample: Vec<[f64; 3]>,
    /// Remarks on the files and the questions from making the plan.
    #[serde(skip)]
    pub remarks: Vec<Remark>,
}

/// Frame of the local coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanFrame {
    /// Origin, metres.
    pub origin: [f64; 3],
    /// Metres per unit of the files along each axis.
    pub metres_per_unit: [f64; 3],
    /// Reference system as text; empty if unknown.
    pub system: String,
    /// Content of the files that contradicts the reference system; `None` without a contradiction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubt: Option<String>,
}

/// Members that plans of all versions have.
#[derive(Deserialize)]
struct Version {
    layout: u32,
    program: String,
}

impl Plan {
    /// Returns the treatment of a given reference system that contradicts the files.
    pub(crate) fn insistence(&self) -> Insistence {
        if self.crs_override { Insistence::Insist } else { Insistence::Refuse }
    }

    /// Returns the day of the flight given by the user.
    pub(crate) fn flown(&self) -> Option<CalendarDay> {
        self.flown.as_deref().and_then(CalendarDay::parse)
    }

    /// Reads the plan of a run.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a folder without a plan, for a file that is no plan, and for a plan
    /// of another version.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = Self::path(folder);
        let refused = |what: String| Err(Error::malformed(&path, format!("{what} again with `belvedere city plan`")));
        let bytes = match bytes_of_file(&path) {
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
        plan.survey_name = plan.survey_fingerprint(&path)?;
        Ok(plan)
    }

    /// Returns a fingerprint of all data from which balls are made.
    pub(crate) fn survey_fingerprint(&self, path: &Path) -> Result<String> {
        let bare = Self {
            cells: CellSizes::default(),
            targets: on_surface(),
            ground: GroundPoints::Auto,
            questions: Vec::new(),
            meshes: Vec::new(),
            terrain: None,
            horizon: None,
            trees: None,
            tiles: Vec::new(),
            ..self.clone()
        };
        let text = sealed(&bare).map_err(|e| Error::malformed(path, format!("cannot be read: {e}")))?;
        Ok(hash(text.as_bytes()))
    }

    /// True if the survey has measured pulses that prove lines of sight free.
    pub(crate) fn can_prove(&self) -> bool {
        self.statistics.carves && !self.statistics.are_pulses_assumed() && self.cleared.is_empty()
    }

    /// Returns this plan with other cells for all results. `cells` gives their side, their level, the kind of ground
    /// points and the height of targets. [`GroundPoints::Auto`] keeps the kind of ground points of the plan.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a side or a height out of range.
    pub fn with_grid_cells(mut self, cells: &GridCells) -> Result<Self> {
        let (low, high) = self.bounds().on_map();
        self.cells = CellSizes::all(cells.cell.unwrap_or_else(|| cell_for(low, high)));
        self.cells.check()?;
        let targets = CellParams::default().with_level(cells.level);
        self.targets = cells.height.map_or(targets, |height| targets.with_height(height));
        if cells.ground != GroundPoints::Auto {
            self.ground = cells.ground;
        }
        self.tiles = self.tiles_with_cells();
        Ok(self)
    }

    /// Returns the cells of the result of a question, as one puts it to a scene.
    pub(crate) fn grid_cells(&self, question: &TileQuestion) -> GridCells {
        GridCells {
            cell: Some(self.cells.of(question)),
            level: self.targets.level,
            height: Some(self.targets.height),
            ground: self.ground,
            ..GridCells::default()
        }
    }

    /// Returns the location of the survey for questions about suns.
    #[must_use]
    pub fn whereabouts<'a>(&self, frame: &'a Frame) -> Whereabouts<'a> {
        let has_far_terrain = self.terrain.is_some() || self.horizon.is_some();
        Whereabouts { frame, bounds: self.bounds(), has_far_terrain }
    }

    /// Writes the plan into the folder of a run, and makes the folder. Any program may carry out the plan.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Malformed`] for a folder with results of another plan. Also [`Error::Malformed`] for
    /// files whose address had a user, a password or a key, because these are never written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let beside = self.meshes.iter().chain(&self.terrain).chain(&self.horizon).map(SideFile::path);
        let is_cut = |path: &&Path| path.to_str().and_then(Address::parse).is_some_and(|it| it.cut_number().is_some());
        if let Some(path) = self.inputs.iter().map(|input| input.path.as_path()).chain(beside).find(is_cut) {
            let what = "has a user, a password or a key in its address, which a plan for other programs does not keep; \
                        download the file, or ask the question with a plain command, which makes tiles by itself";
            return Err(Error::malformed(path, what));
        }
        self.write_here(folder)
    }

    /// Writes a plan that only this process carries out, because only this process knows the complete addresses.
    pub(crate) fn write_here(&self, folder: &Path) -> Result<()> {
        atomic::make_folder(folder)?;
        let path = Self::path(folder);
        let text = sealed(self).map_err(|e| Error::malformed(&path, format!("cannot be written: {e}")))?;
        let has_results =
            || folder.read_dir().is_ok_and(|mut entries| entries.any(|entry| entry.is_ok_and(|e| e.path().is_dir())));
        // A damaged plan may be the plan of the results.
        let is_other =
            |before: Vec<u8>| before != text.as_bytes() && serde_json::from_slice::<Version>(&before).is_ok();
        if bytes_of_file(&path).is_ok_and(is_other) && has_results() {
            let what = "is another plan, and its results are in the folder; give another folder, or remove this one";
            return Err(Error::malformed(&path, what));
        }
        atomic::write(&path, |file| file.write_all(text.as_bytes()).map_err(Error::io(&path)))
    }

    /// Returns the path of the plan of a run.
    #[must_use]
    pub fn path(folder: &Path) -> PathBuf {
        folder.join("plan.json")
    }

    /// Returns the frame of all tiles.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a reference system that this program does not know.
    pub fn frame(&self) -> Result<Frame> {
        self.frame.to_frame()
    }

    /// Returns the smallest box around the survey, local metres.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds { low: self.low, high: self.high }
    }

    /// Returns the rectangle around the survey.
    pub(crate) fn area(&self) -> MapArea {
        let (low, high) = self.bounds().on_map();
        MapArea { low, high }
    }

    /// Returns the cells of side `cell` of a tile.
    pub(crate) fn cells_of_tile(&self, tile: TileId, cell: f64) -> MapGrid {
        let core = self.grid().core(tile);
        let count = to_index((self.tile_size / cell).round());
        MapGrid { corner: [core.low[0], core.high[1]], cell, width: count, height: count }
    }

    /// Returns the grid of tiles.
    #[must_use]
    pub fn grid(&self) -> TileGrid {
        TileGrid { size: self.tile_size, origin: [self.frame.origin[0], self.frame.origin[1]] }
    }

    /// Returns the parameters of the model that makes the balls of tiles.
    #[must_use]
    pub fn model(&self) -> ModelParams {
        ModelParams::default().with_statistics(Some(Arc::new(self.statistics.clone())))
    }

    /// Returns the files that may have points in `area`.
    pub(crate) fn files_meeting(&self, area: &MapArea) -> impl Iterator<Item = &InputFile> {
        // Rounding of the bounds in headers, metres.
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

    /// Returns the area whose points a tile needs for its balls.
    pub(crate) fn window(&self, tile: TileId) -> MapArea {
        self.grid().core(tile).in_blocks().widened(self.buffer)
    }

    /// Returns the blocks of 64 m with points that meet `area`.
    pub(crate) fn blocks_in(&self, area: &MapArea) -> impl Iterator<Item = &SurveyBlock> {
        area.blocks().filter_map(|at| {
            let place = self.blocks.binary_search_by_key(&at, |block| block.at).ok()?;
            self.blocks.get(place)
        })
    }

    /// Returns the tiles with cells for the result of a question, from the south-west. Some tiles at the edge of the
    /// survey, which only larger cells reach, are left out.
    pub(crate) fn tiles_of(&self, question: &TileQuestion) -> Vec<TileId> {
        let cell = self.cells.of(question);
        self.tiles.iter().copied().filter(|&tile| self.has_cells(tile, cell)).collect()
    }

    /// Returns the tiles with cells for any result.
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

    /// True if cells of side `cell` may get a height on a tile, because points are near.
    pub(crate) fn has_cells(&self, tile: TileId, cell: f64) -> bool {
        let reach = self.reach(cell);
        let core = self.grid().core(tile);
        let (low, high) = self.bounds().on_map();
        (0..2).all(|axis| core.low[axis] <= high[axis] + reach && low[axis] - reach < core.high[axis])
            && self.blocks_in(&core.widened(reach)).next().is_some()
    }

    /// Returns this plan with other questions, and with remarks on their radiation and on leaves.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for two questions with the same folder of results and for parameters out of range.
    /// Also the errors of reading weather.
    pub fn with_questions(self, questions: Vec<TileQuestion>, control: &Control<'_>) -> Result<Self> {
        check_names(&questions)?;
        let mut context = Context::default();
        for question in &questions {
            let prepared = self.prepared(question, FarTerrain::default(), control)?;
            prepared.answers.remarks.into_iter().for_each(|remark| context.add(Some(remark)));
        }
        let proves = self.proves || self.can_prove() && questions.iter().any(TileQuestion::needs_proof);
        let remarks = self.remarks.into_iter().chain(context.into_answers().remarks).collect();
        Ok(Self { questions, remarks, proves, ..self })
    }

    /// Returns this plan with meshes of planned objects, such as buildings. Their triangles block exactly, beside the
    /// surveyed objects. Targets of cells below the meshes lie on top of them.
    ///
    /// # Errors
    /// Those of reading meshes, and [`Error::InvalidParameter`] for a mesh that does not lie on the survey.
    pub fn with_meshes(self, meshes: Vec<SideFile>) -> Result<Self> {
        added_meshes(&meshes, &self.frame()?, Coverage::of(self.bounds()).as_ref())?;
        Ok(Self { meshes, ..self })
    }

    /// Returns this plan with far terrain: an elevation raster and a horizon in the formats of
    /// [`read_terrain`](belvedere::io::read_terrain) and [`read_horizon`](belvedere::io::read_horizon). Far terrain
    /// blocks directions to the sun and the sky below its horizon. Terrain within the box of the survey, and within one
    /// cell of the raster around it, blocks nothing. A remark names places with a difference between the heights of the
    /// raster and of the ground.
    ///
    /// # Errors
    /// Those of reading the files. [`Error::InvalidParameter`] for terrain that does not reach the survey or lies far
    /// above or below it.
    pub fn with_far_terrain(self, terrain: Option<SideFile>, horizon: Option<SideFile>) -> Result<Self> {
        let frame = self.frame()?;
        let far = far_terrain(terrain.as_ref(), horizon.as_ref(), &frame, self.bounds())?;
        let heights = far.grid().and_then(|grid| remark_on_terrain(grid, self.sample.iter().copied(), frame.origin[2]));
        let remarks = self.remarks.into_iter().chain(heights).collect();
        Ok(Self { terrain, horizon, remarks, ..self })
    }

    /// Returns this plan with trees that let light through, for questions about light.
    ///
    /// # Errors
    /// [`Error::MissingAttribute`] for a survey without pulses that separate vegetation from other balls.
    pub fn with_light_through_trees(self, trees: CrownLight) -> Result<Self> {
        let is_known =
            if matches!(trees, CrownLight::Measured { .. }) { self.knows_crowns() } else { self.statistics.carves };
        if !is_known {
            return Err(Error::MissingAttribute {
                attribute: "pulses that carve",
                needed_for: "knowing which balls are vegetation",
                advice: "use a survey that has return numbers and GPS times, or opaque trees",
            });
        }
        Ok(Self { trees: Some(trees), ..self })
    }

    /// True if tiles have crowns as a medium.
    #[must_use]
    pub fn knows_crowns(&self) -> bool {
        self.statistics.know_crowns()
    }

    /// Returns the density of crowns on the days of the survey, at a latitude, radians, or else at the place of its
    /// reference system; `None` if the days or the place are not known.
    ///
    /// # Errors
    /// Those of [`Plan::frame`].
    pub fn crown_density(&self, latitude: Option<f64>) -> Result<Option<f64>> {
        Ok(density_at(&self.statistics.flight_days, latitude, &self.whereabouts(&self.frame()?)))
    }

    /// Returns the meshes of planned objects, and far terrain.
    ///
    /// # Errors
    /// Those of reading the files, and [`Error::Malformed`] for a file that changed after the plan was made.
    pub(crate) fn others(&self) -> Result<Others> {
        Ok(Others { added: added_meshes(&self.meshes, &self.frame()?, None)?, far_terrain: self.far_terrain()? })
    }

    /// Returns far terrain.
    ///
    /// # Errors
    /// Those of [`Plan::others`].
    pub(crate) fn far_terrain(&self) -> Result<FarTerrain> {
        far_terrain(self.terrain.as_ref(), self.horizon.as_ref(), &self.frame()?, self.bounds())
    }
}

impl PlanFrame {
    /// Converts a place in the coordinates of the files into local metres.
    pub(crate) fn place_in_metres(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| place[axis] * self.metres_per_unit[axis] - self.origin[axis])
    }

    /// Converts an area from local metres into the coordinates of the files.
    pub(crate) fn area_in_files(&self, area: &MapArea) -> [[f64; 2]; 2] {
        let in_files = |v: f64, axis: usize| (v + self.origin[axis]) / self.metres_per_unit[axis];
        [area.low, area.high].map(|corner| [0, 1].map(|axis| in_files(corner[axis], axis)))
    }

    pub(crate) fn to_frame(&self) -> Result<Frame> {
        let named = if self.system.is_empty() { Crs::default() } else { Crs::parse(&self.system)? };
        // Units may come from another record than the reference system.
        let crs = Crs {
            metres_per_unit: self.metres_per_unit[0],
            vertical_metres_per_unit: self.metres_per_unit[2],
            doubt: self.doubt.clone(),
            ..named
        };
        Ok(Frame { origin: self.origin, crs })
    }
}

/// Returns cells on the surface, on top of the present objects.
pub(crate) fn on_surface() -> CellParams {
    CellParams::default().with_level(CellLevel::Surface)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde calls")]
fn is_false(value: &bool) -> bool {
    !value
}

/// Refuses questions with the same folder of results, and folders that do not lie below the folder of the run.
fn check_names(questions: &[TileQuestion]) -> Result<()> {
    let mut names = BTreeSet::from([BALLS]);
    for name in questions.iter().map(|question| question.name.as_str()) {
        let is_plain = |c: char| c.is_alphanumeric() || "_-+.".contains(c);
        let refused = |value: String, expected| Err(Error::invalid(Parameter::Questions, value, expected));
        if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
            return refused(format!("{name:?}"), "names of letters, digits, _, -, + and ., which are those of folders");
        }
        if !names.insert(name) {
            return refused(format!("{name} twice"), "each question once");
        }
    }
    Ok(())
}

/// Checks the numbers of a plan that must lie within limits; `None` for a damaged plan.
fn check_numbers(plan: &Plan) -> Option<()> {
    let own = [&plan.buffer, &plan.tile_size, &plan.nearness];
    let finite = plan.frame.origin.iter().chain(&plan.frame.metres_per_unit).chain(own);
    let are_whole = plan.inputs.iter().all(InputFile::has_sound_pieces);
    let are_sorted = plan.blocks.windows(2).all(|pair| pair[0].at < pair[1].at);
    let is_sound = finite.clone().all(|v| v.is_finite())
        && plan.buffer > 0.0
        && plan.buffer < 1e4
        && plan.nearness > 0.0
        && are_sorted
        && are_whole;
    (is_sound && plan.has_sound_areas(plan.frame.origin) && plan.cells.check_tile(plan.tile_size).is_ok()).then_some(())
}
