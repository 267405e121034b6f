//! Plan of tiles from the files of a survey.

use crate::grid::{CELL, MapArea};
use crate::inputs::{InputFile, NOWHERE, PIECE_ROWS, PointColumns, remarks_on_file};
use crate::plan::cell_sizes::{CellSizes, MIN_TILE};
use crate::plan::survey::survey;
use crate::plan::window;
use crate::plan::window::without_ground;
use crate::plan::{LAYOUT, Plan, PlanFrame, on_surface};
use belvedere::apps::ask::Remark;
use belvedere::cloud::survey_origin;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{Insistence, LasHead, cloud_sources};
use belvedere::model::{ModelParams, SurveyStatistics};
use belvedere::query::nearness_of;
use belvedere::weather::CalendarDay;
use belvedere::{Error, Parameter, PointCloud, Result};
use std::path::{Path, PathBuf};

/// Maximum distance of a point from the origin, metres. Up to this distance f32 resolves a millimetre.
const FARTHEST: f64 = 16_384.0;
/// Maximum number of points that sample the ground.
const MAX_SAMPLE: usize = 4000;

/// Parameters of a plan.
#[derive(Clone, Debug)]
pub struct PlanParams {
    /// Files, folders and catalogues of tiles.
    pub clouds: Vec<PathBuf>,
    /// Reference system of files that name none, or that name the same one.
    pub crs: Option<String>,
    /// Treatment of a given reference system that contradicts the files or their coordinates. Default: contradictions
    /// are errors.
    pub crs_against_files: Insistence,
    /// Day of the flight for files with GPS times in seconds of a week. Default: unknown.
    pub flown: Option<CalendarDay>,
    /// Side of a tile, metres. Default 512, a multiple of the blocks of 64 m, so that no point is read in vain.
    pub tile_size: f64,
    /// Sides of the cells of results. Default 1 m.
    pub cells: CellSizes,
    /// Places that the survey must contain, in its coordinates. A place outside is refused before points are read.
    /// Default none.
    pub places: Vec<[f64; 2]>,
    /// Maximum memory for a tile, bytes. Tiles are made smaller until the largest fits. `None` for no limit.
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
            flown: None,
            tile_size: 512.0,
            cells: CellSizes::default(),
            places: Vec::new(),
            memory: None,
            program: String::new(),
        }
    }
}

impl Plan {
    /// Reads all points once and plans the tiles, without a question.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for sizes out of range, places outside, a survey too wide for one frame, and memory
    /// too small for any tile. Also those of reading the files, and of [`SurveyStatistics::estimate`].
    pub fn make(params: &PlanParams, control: &Control<'_>) -> Result<Self> {
        params.cells.check_tile(params.tile_size)?;
        let (mut inputs, heads, mut remarks) = inputs(&params.clouds)?;
        let with_crs = heads.iter().position(|head| head.crs.epsg.is_some() || head.crs.wkt.is_some()).unwrap_or(0);
        let crs = system_of(params, &inputs, &heads, with_crs)?;
        let (frame, [low, high]) = frame_of(&crs, params, &inputs, &inputs[with_crs].path)?;
        let columns = PointColumns::common(&heads);
        remarks.extend(inputs.iter().zip(&heads).flat_map(|(file, head)| remarks_on_file(&file.path, head)));
        let files: Vec<PathBuf> = inputs.iter().map(|file| file.path.clone()).collect();
        let points = inputs.iter().map(|file| file.points).sum();
        let local = |v: [f64; 3]| [v[0] - frame.origin[0], v[1] - frame.origin[1]];
        let area = MapArea { low: local(low), high: local(high) };
        let options = window::options(params.crs.as_deref(), params.crs_against_files, params.flown, frame.to_frame()?);
        let found = control.stage("surveying", usize::try_from(points).unwrap_or(0), || {
            survey(&files, &options, columns, points, &area, control)
        })?;
        for input in &mut inputs {
            input.pieces = found.pieces.get(&input.path).cloned().unwrap_or_default();
            // Rows at the end may all have been left out.
            input.pieces.resize(usize::try_from(input.points.div_ceil(PIECE_ROWS)).unwrap_or(0), NOWHERE);
        }
        let bounds = found.counts.bounds.ok_or_else(|| Error::NoPoints { what: "all points are noise".to_owned() })?;
        let model = ModelParams::default();
        let statistics = SurveyStatistics::estimate(
            &files[0],
            &found.along_lines,
            &found.places,
            &found.counts.extremes,
            &model,
            control,
        )?;
        let mut plan = Self {
            layout: LAYOUT,
            program: params.program.clone(),
            inputs,
            crs: params.crs.clone(),
            crs_override: params.crs_against_files == Insistence::Insist,
            flown: params.flown.map(|day| day.to_string()),
            columns,
            tile_size: params.tile_size,
            cells: params.cells.clone(),
            targets: on_surface(),
            ground: found.ground_points(),
            proves: false,
            nearness: nearness(&found.places),
            // Rounded up, because more digits would suggest too much accuracy.
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
            blocks: found.counts.blocks,
            frame,
            name: String::new(),
            survey_name: String::new(),
            shared_balls: None,
            sample: sample(&found.places.positions),
            remarks,
        };
        plan.tiles = plan.tiles_with_cells();
        match params.memory {
            Some(memory) => plan.fitting(memory),
            None => Ok(plan),
        }
    }

    /// Returns this plan with smaller tiles, so that the largest fits into `memory`, bytes. The side of a tile stays a
    /// whole number of cells. The size of tiles changes no result.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for memory too small for any tile.
    pub fn fitting(mut self, memory: u64) -> Result<Self> {
        let (size, needed) = (self.tile_size, self.estimate().memory_bytes);
        while self.estimate().memory_bytes > memory || !self.cells.divide(self.tile_size) {
            let mut smaller = next_smaller(self.tile_size);
            while smaller >= MIN_TILE && !self.cells.divide(smaller) {
                smaller = next_smaller(smaller);
            }
            if smaller < MIN_TILE {
                let megabytes = |bytes: u64| bytes as f64 / 1e6;
                return Err(Error::invalid(
                    Parameter::TileMemory,
                    format!(
                        "{:.0} MB, but a tile of {size} m takes about {:.0} MB, and one of {} m {:.0} MB",
                        megabytes(memory),
                        megabytes(needed),
                        self.tile_size,
                        megabytes(self.estimate().memory_bytes)
                    ),
                    "enough for a small tile with what is around it",
                ));
            }
            self.tile_size = smaller;
            self.tiles = self.tiles_with_cells();
        }
        Ok(self)
    }
}

/// Returns the next smaller side of a tile, metres: whole blocks, which need the fewest points, or halves of one block.
fn next_smaller(size: f64) -> f64 {
    let blocks = (size / CELL).ceil() - 1.0;
    if blocks >= 1.0 { blocks * CELL } else { size / 2.0 }
}

/// Returns at most `MAX_SAMPLE` of the points, evenly spaced by their number.
fn sample(positions: &[[f32; 3]]) -> Vec<[f64; 3]> {
    let step = positions.len().div_ceil(MAX_SAMPLE).max(1);
    positions.iter().step_by(step).map(|p| p.map(f64::from)).collect()
}

/// Returns the proof distance, metres, from the first returns of some places all over a survey.
fn nearness(places: &PointCloud) -> f64 {
    let numbers = places.attributes.return_number.as_deref();
    let is_first = |(row, _): &(usize, &[f32; 3])| numbers.is_none_or(|numbers| numbers[*row] <= 1);
    nearness_of(places.positions.iter().enumerate().filter(is_first).map(|(_, &p)| p))
}

/// Returns the frame of a survey and the corners of its files, metres. The file `named_in` names the reference system.
fn frame_of(
    crs: &Crs,
    params: &PlanParams,
    inputs: &[InputFile],
    named_in: &Path,
) -> Result<(PlanFrame, [[f64; 3]; 2])> {
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
        return Err(Error::UnusableCrs { path: named_in.to_owned(), what });
    }
    let holds = |place: &[f64; 2]| (0..2).all(|i| (low[i]..=high[i]).contains(&(place[i] * metres_per_unit[i])));
    if let Some([x, y]) = params.places.iter().find(|place| !holds(place)) {
        return Err(without_ground(format!("{x}, {y}")));
    }
    let origin = survey_origin(low, high);
    if (0..2).any(|i| low[i] - origin[i] < -FARTHEST || high[i] - origin[i] > FARTHEST) {
        let [width, height] = [0, 1].map(|i| ((high[i] - low[i]) / 1000.0).ceil());
        return Err(Error::invalid(
            Parameter::Extent,
            format!("{width} x {height} km"),
            "at most 32 x 32 km; make a plan for each part, with the tiles around it",
        ));
    }
    let system = crs.wkt.clone().or_else(|| crs.epsg.map(|code| format!("EPSG:{code}"))).unwrap_or_default();
    let frame = PlanFrame { origin, metres_per_unit, system, doubt: crs.doubt.clone() };
    if frame.to_frame().is_err() {
        let what =
            format!("its reference system, {}, is not known to this program; give it with --crs", crs.describe());
        return Err(Error::UnusableCrs { path: named_in.to_owned(), what });
    }
    Ok((frame, [low, high]))
}

/// Returns the reference system of a survey. The given one takes its heights from the files if it names none. Without a
/// given one, it is the system of the file that names one.
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

/// Returns the files of a survey with their headers, and remarks on the catalogues that name them.
fn inputs(clouds: &[PathBuf]) -> Result<(Vec<InputFile>, Vec<LasHead>, Vec<Remark>)> {
    let (sources, contradictions) = cloud_sources(clouds)?;
    let found: Vec<(InputFile, LasHead)> = sources.into_iter().map(InputFile::new).collect::<Result<_>>()?;
    if let Some((first, rest)) = found.split_first()
        && let Some((other, _)) = rest.iter().find(|(_, head)| head.crs.contradicts(&first.1.crs))
    {
        let what = format!("is in another reference system than {}; convert one of them", first.0.path.display());
        return Err(Error::UnusableCrs { path: other.path.clone(), what });
    }
    let (files, heads) = found.into_iter().unzip();
    Ok((files, heads, contradictions.into_iter().filter_map(Remark::of_contradiction).collect()))
}
