//! Questions for a survey of any size. A survey too large for one model in memory is answered tile by tile, with the
//! answer of one model.

use crate::plan::Plan;
use crate::plan::question::TileQuestion;
use crate::run::{RunParams, RunReport, Shard, Steps, run};
use belvedere::Frame;
use belvedere::apps::ask::{self, Answers, Context, HowSure, NamedSun, Remark, summarise_parts};
use belvedere::apps::difference::described;
use belvedere::apps::sum_errors::INTERVAL_MEASURES;
use belvedere::apps::targets::Measure;
use belvedere::apps::viewshed::SeenProbabilities;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::ground::MapGrid;
use belvedere::io::{MetadataTag, cloud_files, read_las_head, web_address};
use belvedere::raster::Raster;
use belvedere::results::{ResultKind, ResultRaster, UNPROVEN_BAND, georeference};
use belvedere::{Error, Parameter, Result};
use std::path::{Path, PathBuf};

/// Memory of a model of a whole cloud for each point, and without any point, bytes, as measured in docs/costs.md.
const BYTES_PER_POINT: u64 = 600;
const MIN_BYTES: u64 = 100_000_000;
/// Memory for each value while the results of all tiles are joined, bytes.
const BYTES_PER_VALUE: u64 = 10;
/// Maximum number of files on a server whose headers are read, because each file needs one or two requests.
const MAX_REMOTE: usize = 64;
/// Width of the margin around places within which points are read, metres. Balls of usual surveys depend on points up
/// to this distance.
const AROUND: f64 = 128.0;

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

    /// Returns the part of the survey that a question about `places` needs, with a note that no other points are read.
    /// Places are in the coordinates of the files, and `distance` is in metres on the map. `None` without places.
    ///
    /// # Errors
    /// Those of the given reference system and of reading the header of a file.
    pub fn part_around(
        &self,
        (clouds, crs): (&[PathBuf], Option<&str>),
        places: &[[f64; 2]],
        distance: f64,
    ) -> Result<Option<(SurveyPart, Remark)>> {
        let Some(&first) = places.first() else { return Ok(None) };
        let metres_per_unit = match (crs, cloud_files(clouds)?.first()) {
            (Some(crs), _) => Crs::parse(crs)?.metres_per_unit,
            (None, Some(file)) => read_las_head(file.as_path())?.crs.metres_per_unit,
            (None, None) => 1.0,
        };
        let around = distance + AROUND;
        let join = |[low, high]: SurveyPart, place: &[f64; 2]| {
            [[0, 1].map(|axis| low[axis].min(place[axis])), [0, 1].map(|axis| high[axis].max(place[axis]))]
        };
        let [low, high] = places.iter().fold([first, first], join);
        let by = around / metres_per_unit;
        let text = format!("{}: only points within {around:.0} m of the question were read", self.in_words());
        let remark = Remark::note("part-of-survey", text).with("around_m", around);
        Ok(Some(([low.map(|v| v - by), high.map(|v| v + by)], remark)))
    }
}

/// Question about the cells of a survey, ready to be run tile by tile.
pub struct SurveyQuestion {
    plan: Plan,
    /// Folder of its results.
    folder: PathBuf,
    question: ask::Question,
    /// Suns of a question about shadows.
    suns: Vec<NamedSun>,
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
    description: &'static str,
}

impl SurveyQuestion {
    /// Prepares a question about the cells of a survey, whose plan is kept in `folder`. All results together may take
    /// `limit` bytes of memory.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a question that tiles do not answer, and for results over the limit. Also those
    /// of [`Plan::with_questions`] and [`Plan::write`].
    pub fn new(plan: Plan, folder: &Path, question: ask::Question, limit: u64, control: &Control<'_>) -> Result<Self> {
        let frame = plan.frame()?;
        let whereabouts = plan.whereabouts(&frame);
        let mut context = Context::default();
        whereabouts.remark(&mut context);
        let (suns, how_sure) = match &question {
            ask::Question::Shadow(about) => {
                (about.suns.resolve(&about.place, &whereabouts, &mut Context::default())?, about.how_sure)
            }
            _ => (Vec::new(), HowSure::default()),
        };
        let is_up = |sun: &NamedSun| sun.sun.to_sun[2] > 0.0;
        let mut questions = TileQuestion::of(&question, (&plan, &whereabouts), &mut context, control)?;
        if suns.iter().any(is_up) {
            // At night nothing is lit, so that no tile is needed.
            questions = TileQuestion::of_suns(suns.iter().filter(|&sun| is_up(sun)), &how_sure);
        }
        let mut values = 0_u64;
        for own in &questions {
            values += plan.cells_of(own)?.len() as u64;
        }
        let needed = values.saturating_mul(BYTES_PER_VALUE);
        if needed > limit {
            let [needed, limit] = [needed, limit].map(size_in_words);
            return Err(Error::invalid(
                Parameter::TileMemory,
                format!("{limit}, but the {values} values of {} results take {needed} together", questions.len()),
                "enough for the answer: give larger cells, fewer suns or more memory, or plan a run in tiles, which writes each result on its own",
            ));
        }
        if let (ask::Question::Viewshed(view), Some(TileQuestion::Viewshed { eyes, .. })) =
            (&question, questions.first())
        {
            let above_ground = match eyes[..] {
                [[x, y, z]] => {
                    let mut feet = [[x, y, f64::NAN]];
                    let is_known = plan.set_on_ground(&mut feet, 0.0, control).is_ok();
                    is_known.then_some(z - feet[0][2])
                }
                _ => None,
            };
            view.report_eyes_of_parts(eyes, above_ground, &frame, &mut context);
        }
        let plan = plan.with_questions(questions, control)?;
        plan.remarks.iter().for_each(|remark| context.add(Some(remark.clone())));
        let (plan, folder) = plan.ready_in(folder)?;
        Ok(Self { plan, folder, question, suns, context })
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
        let first = self.plan.questions.first();
        let (Some(first), false) = (first, measures.is_empty()) else {
            return Err(Error::NoPoints { what: "the question has no result".to_owned() });
        };
        let (grid, description) = (self.plan.cells_of(first)?, first.description());
        let eyes = if let TileQuestion::Viewshed { eyes, .. } = first { eyes.clone() } else { Vec::new() };
        report.remarks().into_iter().for_each(|remark| self.context.add(Some(remark)));
        self.context.report.places.cells_under_cover_left_out = report.cells_under_cover;
        if let Some(section) = &mut self.context.report.observers {
            section.eyes.skipped = report.skipped_observers;
        }
        let title = {
            let whereabouts = self.plan.whereabouts(&frame);
            summarise_parts(&self.question, (&measures, grid.cell), &whereabouts, &mut self.context)?
        };
        if !self.wanted_sureness().probability {
            let is_likelihood = |name: &str| [ask::PROBABILITY, ask::EXPECTED].iter().any(|one| name.starts_with(one));
            measures.retain(|measure| !is_likelihood(&measure.name));
        }
        let Self { plan, suns, context, .. } = self;
        let Answers { headline, remarks, report, .. } = context.into_answers();
        let found = SurveyCells { plan, grid, frame, title, suns, eyes, description };
        Ok(Answers { found, measures, headline, remarks, report })
    }

    /// Returns a measure for each sun or result. A single result also has its unproven part, and all have probabilities
    /// if wanted.
    fn measures(&self, control: &Control<'_>) -> Result<Vec<Measure>> {
        let (mut results, mut likely) = (Vec::new(), Vec::new());
        let is_likely = |question: &&TileQuestion| matches!(question, TileQuestion::Probability { .. });
        let answers = self.plan.questions.iter().filter(|question| !is_likely(question)).count();
        let is_single = self.suns.len().max(answers) == 1;
        for question in &self.plan.questions {
            let pixels = self.plan.results_of(&self.folder, question, control)?;
            let kind = pixels.kind();
            let bands = question.band_names(kind).into_iter().zip(pixels.to_numbers()?);
            if is_likely(&question) {
                likely.push(bands.map(|(_, band)| band.values().to_vec()).collect());
                continue;
            }
            let description = question.description();
            let range = (kind == ResultKind::Answer).then_some([0.0, 1.0]);
            let of_band = |(name, band): (String, Raster<f32>)| {
                let of_interval = INTERVAL_MEASURES.iter().find(|(end, _)| name.ends_with(&format!("_{end}")));
                let description = match (name == UNPROVEN_BAND, self.suns.is_empty()) {
                    (false, _) => of_interval.map_or(description, |(_, text)| *text),
                    (true, false) => "1: lit, but unproven",
                    (true, true) => "from how many nothing blocks it, but no pulse proves it",
                };
                Measure::new(&name, band.values().to_vec())
                    .with_description(description)
                    .with_unit(if name == UNPROVEN_BAND { "1" } else { question.unit() })
                    .with_kind(kind)
                    .with_range(range)
            };
            let has_all = is_single || kind == ResultKind::Number;
            results.extend(bands.map(of_band).take(if has_all { usize::MAX } else { 1 }));
        }
        if self.suns.is_empty() {
            let sure = likely.into_iter().next().map(|bands| self.how_sure(bands, &results, "")).transpose()?;
            return Ok(results.into_iter().chain(sure.into_iter().flatten()).collect());
        }
        let Some(cells) = results.first().map(|first: &Measure| first.values.clone()) else { return Ok(results) };
        let night = || cells.iter().map(|value| if value.is_nan() { f32::NAN } else { 0.0 }).collect();
        let (mut results, mut likely) = (results.into_iter(), likely.into_iter());
        let (mut of_suns, mut sure) = (Vec::new(), Vec::new());
        for sun in &self.suns {
            let is_up = sun.sun.to_sun[2] > 0.0;
            let lit = if is_up { results.next() } else { None };
            let lit = lit.unwrap_or_else(|| {
                Measure::new("", night()).with_kind(ResultKind::Answer).with_range(Some([0.0, 1.0]))
            });
            of_suns.push(Measure { name: sun.column.clone(), tags: sun.tags.clone(), ..lit });
            let bands = if is_up { likely.next() } else { Some(vec![night()]) };
            let suffix = if self.suns.len() == 1 { String::new() } else { format!("_{}", sun.column) };
            sure.push((bands, suffix));
        }
        of_suns.extend(results);
        for (bands, suffix) in sure {
            let measures = bands.map(|bands| self.how_sure(bands, &of_suns, &suffix)).transpose()?;
            of_suns.extend(measures.into_iter().flatten());
        }
        Ok(of_suns)
    }

    fn wanted_sureness(&self) -> HowSure {
        match &self.question {
            ask::Question::Shadow(about) => about.how_sure,
            ask::Question::Viewshed(about) => about.how_sure,
            _ => HowSure::default(),
        }
    }

    /// Returns the measures of probability from `bands`. `answers` may contain the unproven part of a single answer.
    fn how_sure(&self, bands: Vec<Vec<f32>>, answers: &[Measure], suffix: &str) -> Result<Vec<Measure>> {
        // The summary needs probabilities, even if they are not written.
        let how_sure = HowSure { probability: true, ..self.wanted_sureness() };
        let is_of_many = matches!(&self.question, ask::Question::Viewshed(about) if about.observers.len() > 1);
        let mut bands = bands.into_iter();
        let Some(expected) = bands.next() else { return Ok(Vec::new()) };
        if is_of_many {
            return Ok(how_sure.measures_of_many(SeenProbabilities { expected, uncertain: bands.next() }));
        }
        let doubts = answers.iter().find(|measure| measure.name == UNPROVEN_BAND);
        let is_unproven =
            |row: usize| doubts.and_then(|doubts| doubts.values.get(row)).is_some_and(|&doubt| doubt > 0.0);
        let uncertain = how_sure.uncertain(&expected, is_unproven)?;
        Ok(how_sure.measures(expected, uncertain, suffix))
    }
}

impl SurveyCells {
    /// Writes measures as one cloud-optimised GeoTIFF, with one band each, and with `tags` as metadata of the whole.
    ///
    /// # Errors
    /// Those of writing.
    pub fn write_cog(&self, path: &Path, measures: &[Measure], tags: &[MetadataTag]) -> Result<()> {
        let raster = ResultRaster::of_measures(measures, [self.grid.width, self.grid.height])?.with_tags(tags);
        let subject = if self.suns.is_empty() { "" } else { self.title.as_str() };
        let raster = ResultRaster { description: described(self.description, subject), ..raster };
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

fn size_in_words(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{:.0} MB", bytes as f64 / 1e6),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}
