//! Questions for a survey of any size. A survey too large for one model in memory is answered tile by tile, with the
//! answer of one model.

use crate::plan::Plan;
use crate::plan::prepared::PreparedQuestion;
use crate::plan::question::TileQuestion;
use crate::run::{RunParams, RunReport, Shard, Steps, run};
use belvedere::Frame;
use belvedere::apps::ask::{
    Answers, Context, EXPECTED, HowSure, NamedSun, OnTargets, PROBABILITY, Question, Remark, summarise_parts,
};
use belvedere::apps::edge::EdgeReport;
use belvedere::apps::targets::{Measure, TargetLayout, Targets};
use belvedere::cast::to_f32s;
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid};
use belvedere::io::{MetadataTag, cloud_files, read_las_head, web_address};
use belvedere::raster::Raster;
use belvedere::results::{ADDED_BAND, ResultRaster, georeference};
use belvedere::{Error, Parameter, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Memory of a model of a whole cloud for each point, and without any point, bytes, as measured in docs/costs.md.
const BYTES_PER_POINT: u64 = 600;
const MIN_BYTES: u64 = 100_000_000;
/// Memory for each value while the results of all tiles are joined, bytes.
const BYTES_PER_VALUE: u64 = 10;
/// Maximum number of files on a server whose headers are read, because each file needs one or two requests.
const MAX_REMOTE: usize = 64;

/// Survey too large for one model: the model takes more memory than the limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// Memory for one model, bytes.
    pub whole: u64,
    /// Memory limit, bytes.
    pub limit: u64,
}

/// South-west and north-east corners of the part of a survey that is read, in the coordinates of its files.
pub type SurveyPart = [[f64; 2]; 2];

impl TooLarge {
    /// Returns the memory of one model of these files if it exceeds `limit` bytes, otherwise `None`. Also `None` for
    /// files without tiles, such as tables of points, and for many files on servers.
    #[must_use]
    pub fn of(clouds: &[PathBuf], limit: u64) -> Option<Self> {
        let files = cloud_files(clouds).ok()?;
        if files.iter().filter(|file| web_address(file).is_some()).count() > MAX_REMOTE {
            return None;
        }
        let points = files.iter().map(|file| Some(read_las_head(file.as_path()).ok()?.points));
        let points: u64 = points.sum::<Option<u64>>()?;
        let whole = points.saturating_mul(BYTES_PER_POINT).saturating_add(MIN_BYTES);
        (whole > limit).then_some(Self { whole, limit })
    }

    /// Returns the memory and its limit in words.
    #[must_use]
    pub fn in_words(&self) -> String {
        let [whole, limit] = [self.whole, self.limit].map(size_in_words);
        format!("one model of this survey takes about {whole} of memory, and {limit} may be used")
    }

    /// Returns a note that the survey is answered in tiles.
    #[must_use]
    pub fn remark_on_tiles(&self, tile_size: f64) -> Remark {
        let text = format!("{}: answered in tiles of {tile_size} m", self.in_words());
        Remark::note("in-tiles", text).with("tile_size_m", tile_size)
    }

    /// Returns a note that the balls of the survey, or of a part of it, are made in tiles.
    #[must_use]
    pub fn remark_on_balls(&self, tile_size: f64) -> Remark {
        let text = format!("{}: balls are made in tiles of {tile_size} m", self.in_words());
        Remark::note("balls-in-tiles", text).with("tile_size_m", tile_size)
    }
}

/// Question about the cells of a survey, ready to be run tile by tile.
pub struct SurveyQuestion {
    plan: Plan,
    /// Folder of its results.
    folder: PathBuf,
    of_survey: Question,
    /// The same question to tiles, and the answer for no cell.
    question: TileQuestion,
    prepared: PreparedQuestion,
    context: Context,
}

/// Cells of a survey with the answer to a question.
pub struct SurveyCells {
    plan: Plan,
    /// Grid of the cells, local metres.
    pub grid: MapGrid,
    /// Frame of the local coordinates.
    pub frame: Frame,
    /// Description of the answer, for the title of a map.
    pub title: String,
    /// Suns of a question about shadows. The first measures belong to them, one each.
    pub suns: Vec<NamedSun>,
    /// Eyes of viewsheds, local metres.
    pub eyes: Vec<[f64; 3]>,
    /// Cells that stand on a planned object; empty without any.
    on_added: Vec<bool>,
}

impl SurveyQuestion {
    /// Prepares a question about the cells of a survey, whose plan is kept in `folder`. All results together may take
    /// `limit` bytes of memory.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a question that tiles do not answer, and for results over the limit. Also those
    /// of [`Plan::with_questions`] and [`Plan::write`].
    pub fn new(plan: Plan, folder: &Path, of_survey: Question, limit: u64, control: &Control<'_>) -> Result<Self> {
        let question = TileQuestion::of_survey(&of_survey, &plan, control)?;
        let prepared = plan.prepared(&question, plan.far_terrain()?, control)?;
        let (results, cells) = (prepared.answers.measures.len(), plan.cells_of(&question)?.len());
        let needed = (results as u64).saturating_mul(cells as u64).saturating_mul(BYTES_PER_VALUE);
        if needed > limit {
            let [needed, limit] = [needed, limit].map(size_in_words);
            return Err(Error::invalid(
                Parameter::TileMemory,
                format!("{limit}, but {results} results of {cells} cells take {needed} together"),
                "enough for the answer: give larger cells, fewer suns or more memory, or plan a run in tiles, which writes each result on its own",
            ));
        }
        let mut context = Context::default();
        context.report = prepared.answers.report.clone();
        if let Question::Viewshed(view) = &of_survey {
            let (frame, eyes) = (plan.frame()?, question.eyes());
            let above_ground = match eyes[..] {
                [[x, y, z]] => {
                    let mut feet = [[x, y, f64::NAN]];
                    let is_known = plan.set_on_ground(&mut feet, 0.0, control).is_ok();
                    is_known.then_some(z - feet[0][2])
                }
                _ => None,
            };
            view.report_eyes_of_parts(&eyes, above_ground, &frame, &mut context);
        }
        let plan = plan.with_questions(vec![question.clone()], control)?;
        plan.remarks.iter().for_each(|remark| context.add(Some(remark.clone())));
        let (plan, folder) = plan.ready_in(folder)?;
        Ok(Self { plan, folder, of_survey, question, prepared, context })
    }

    /// Computes all missing results. `seconds` is a clock of the program.
    ///
    /// # Errors
    /// Those of [`run`].
    pub fn run(&self, seconds: &dyn Fn() -> f64, control: &Control<'_>) -> Result<RunReport> {
        let params = RunParams { shard: Shard::default(), steps: Steps::All, max_balls: None, seconds };
        run(&self.plan, &self.folder, &params, control)
    }

    /// Returns the answers of a complete run.
    ///
    /// # Errors
    /// Those of reading the results.
    pub fn answers(mut self, report: &RunReport, control: &Control<'_>) -> Result<Answers<SurveyCells>> {
        let frame = self.plan.frame()?;
        let mut measures = self.measures(control)?;
        let grid = self.plan.cells_of(&self.question)?;
        let on_added = measures.pop_if(|last| last.name == ADDED_BAND);
        let on_added = on_added.map(|band| band.values.iter().map(|value| *value > 0.0).collect());
        report.remarks().into_iter().for_each(|remark| self.context.add(Some(remark)));
        let places = &mut self.context.report.places;
        places.cells_under_cover_left_out = report.cells_under_cover;
        if matches!(self.of_survey, Question::Viewshed(_)) {
            places.targets_inside_obstacle = Some(report.inside_cells);
        }
        if let Some(edge) = &mut places.edge {
            *edge = EdgeReport::of_counts(report.cells_near_edge, report.cells_of_light);
        }
        if let Some(section) = &mut self.context.report.observers {
            section.eyes.skipped = report.skipped_observers;
        }
        let (title, suns) = {
            let whereabouts = self.plan.whereabouts(&frame);
            let suns = match &self.of_survey {
                Question::Shadow(shadow) => {
                    shadow.suns.resolve(&shadow.place, &whereabouts, &mut Context::default())?
                }
                _ => Vec::new(),
            };
            (summarise_parts(&self.of_survey, (&measures, grid.cell), &whereabouts, &mut self.context)?, suns)
        };
        let how_sure = match &self.of_survey {
            Question::Shadow(shadow) => shadow.how_sure,
            Question::Viewshed(view) => view.how_sure,
            _ => HowSure::default(),
        };
        if !how_sure.probability {
            let is_likelihood = |name: &str| [PROBABILITY, EXPECTED].iter().any(|one| name.starts_with(one));
            measures.retain(|measure| !is_likelihood(&measure.name));
        }
        let Self { plan, question, context, .. } = self;
        let Answers { headline, remarks, report, .. } = context.into_answers();
        let found = SurveyCells {
            plan,
            grid,
            frame,
            title,
            suns,
            eyes: question.eyes(),
            on_added: on_added.unwrap_or_default(),
        };
        Ok(Answers { found, measures, headline, remarks, report })
    }

    /// Returns the measures of all tiles.
    fn measures(&self, control: &Control<'_>) -> Result<Vec<Measure>> {
        let pixels = self.plan.results_of(&self.folder, (&self.question, &self.prepared.bands()?), control)?;
        let measures = self.prepared.answers.measures.iter().cloned().zip(pixels.to_numbers()?);
        Ok(measures.map(|(measure, band)| Measure { values: band.values().to_vec(), ..measure }).collect())
    }
}

impl SurveyCells {
    /// Returns the cells with a value of a measure as targets, whose heights are not kept.
    #[must_use]
    pub fn on_targets(&self, measure: &Measure) -> OnTargets {
        let MapGrid { width, height, .. } = self.grid;
        let unknown = || Raster::filled(width, height, f32::NAN);
        let place = |(cell, value): (usize, &f32)| {
            let [x, y] = to_f32s(self.grid.center(cell % width.max(1), cell / width.max(1)));
            if value.is_finite() { [x, y, 0.0] } else { [f32::NAN; 3] }
        };
        let positions = measure.values.iter().enumerate().map(place).collect();
        let ground = Ground { grid: self.grid, heights: unknown(), gaps: unknown() };
        let layout = TargetLayout::Cells(Box::new(ground));
        let mut targets = Targets::at(self.frame.clone(), positions, None, layout);
        if self.on_added.contains(&true) {
            targets.on_added.clone_from(&self.on_added);
        }
        OnTargets { targets: Arc::new(targets), near_edge: Vec::new(), title: self.title.clone() }
    }

    /// Writes measures as one cloud-optimised GeoTIFF, with one band each, and with `tags` as metadata of the whole.
    ///
    /// # Errors
    /// Those of writing.
    pub fn write_cog(&self, path: &Path, measures: &[Measure], tags: &[MetadataTag]) -> Result<()> {
        let added = self.plan.added_band(measures, &self.on_added).filter(|_| self.on_added.contains(&true));
        let bands: Vec<Measure> = measures.iter().cloned().chain(added).collect();
        let raster = ResultRaster::of_measures(&bands, [self.grid.width, self.grid.height])?.with_tags(tags);
        raster.write_cog(path, &georeference(&self.grid, &self.frame))
    }

    /// Returns the height of the highest point in each cell, for maps.
    ///
    /// # Errors
    /// Those of [`Plan::highest_points`].
    pub fn relief(&self, control: &Control<'_>) -> Result<Raster<f32>> {
        self.plan.highest_points(&self.grid, control)
    }
}

pub(crate) fn size_in_words(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{:.0} MB", bytes as f64 / 1e6),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}
