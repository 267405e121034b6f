//! Questions on the cells of a survey that does not fit into memory: typed and written like those of one cloud, and
//! answered in tiles.

use super::city;
use super::extension;
use super::targets::HighestPoints;
use crate::arguments::{
    FarTerrainArguments, GroundChoice, MemoryAmount, MemoryArgument, SceneInput, SkyPlaces, ThroughTreesArguments,
    Usage,
};
use crate::memory::{self, in_gigabytes};
use crate::run::CommandContext;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::apps::ask::{self, Context, Remark, remark_on_unproven_light};
use belvedere::apps::targets::{CellLevel, Measure};
use belvedere::apps::viewshed::cell_for;
use belvedere::figures::{Picture, write_png};
use belvedere::io::Insistence;
use belvedere::report::percent;
use belvedere::results::{Pixels, ResultKind, ResultRaster, UNPROVEN_BAND, georeference, measure_map};
use belvedere_tiles::{
    CellSizes, Plan, PlanParams, RunParams, Shard, Steps, TileQuestion, Topic, memory_of_whole, run as run_tiles,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What was typed of a question about cells.
pub(crate) struct TypedCells<'a> {
    pub(crate) scene: &'a SceneInput,
    pub(crate) memory: Option<MemoryAmount>,
    pub(crate) level: CellLevel,
    pub(crate) cell: Option<f64>,
    /// Height of targets above what cells stand on, metres.
    pub(crate) height: Option<f64>,
    pub(crate) ground: &'a GroundChoice,
    pub(crate) far: Option<&'a FarTerrainArguments>,
    pub(crate) trees: Option<&'a ThroughTreesArguments>,
    pub(crate) outputs: &'a [PathBuf],
    /// Flags that tiles do not know, and whether each was typed.
    pub(crate) others: Vec<(&'static str, bool)>,
}

/// A survey whose tiles fit into memory.
pub(crate) struct TiledSurvey<'a> {
    typed: TypedCells<'a>,
    plan: Plan,
    /// Where its plan, its balls and its results lie.
    folder: PathBuf,
    /// Whether the folder goes when the answer is written.
    is_temporary: bool,
    /// Memory that may be used, bytes.
    limit: u64,
}

/// What was found, one measure after the other.
pub(crate) struct TiledResults<'a> {
    survey: TiledSurvey<'a>,
    questions: Vec<TileQuestion>,
    /// Of each question, and which answers of a single one are unproven.
    measures: Vec<Measure>,
    grid: belvedere::ground::MapGrid,
}

impl<'a> TypedCells<'a> {
    /// Cells of a question about sun and sky; `others` are its flags that tiles do not know.
    pub(crate) fn of_sky(
        (scene, memory): (&'a SceneInput, &MemoryArgument),
        places: &'a SkyPlaces,
        trees: &'a ThroughTreesArguments,
        outputs: (&'a [PathBuf], Option<&Path>),
        others: &[(&'static str, bool)],
    ) -> Self {
        let (outputs, measures) = outputs;
        let own = [
            ("--self", places.places.own),
            ("--targets", places.places.targets.is_some()),
            ("--edge-mask", places.edge_mask.is_some()),
            ("--measures", measures.is_some()),
        ];
        Self {
            scene,
            memory: memory.memory,
            level: if places.places.surface { CellLevel::Surface } else { CellLevel::Ground },
            cell: places.cell,
            height: places.height.map(f64::from),
            ground: &places.ground,
            far: Some(&places.far),
            trees: Some(trees),
            outputs,
            others: own.iter().chain(others).copied().collect(),
        }
    }

    /// The survey, if one model of it does not fit into the memory that may be used, and tiles do.
    pub(crate) fn survey(self, run: &mut CommandContext) -> Result<Option<TiledSurvey<'a>>> {
        let input = &self.scene.input;
        let limit = memory::limit(self.memory);
        let (Some(limit), Some(whole)) = (limit, memory_of_whole(&input.clouds)) else { return Ok(None) };
        if whole <= limit {
            return Ok(None);
        }
        if let Some(flag) = self.unknown_flag()? {
            let Some(MemoryAmount(limit)) = self.memory else { return Ok(None) };
            let [whole, limit] = [whole, limit].map(in_gigabytes);
            let what = format!(
                "{flag} does not work in tiles, and without tiles this survey takes about {whole} GB, more than the {limit} GB of --memory; \
                 leave it out, or allow more memory"
            );
            return Err(Usage(what).into());
        }
        let kept = run.cache.as_ref().and_then(|cache| cache.survey_folder(&input.clouds, &input.read_options()));
        let is_temporary = kept.is_none();
        let beside = || self.outputs.first().map(|output| output.with_extension("tiles"));
        let Some(folder) = kept.or_else(beside) else { return Ok(None) };
        if is_temporary && folder.exists() && !Plan::path(&folder).is_file() {
            let folder = folder.display();
            return Err(
                Usage(format!("{folder}: tiles would be made there, but it is there already; move it away")).into()
            );
        }
        let params = PlanParams {
            clouds: input.clouds.clone(),
            crs: input.crs.clone(),
            crs_against_files: if input.crs_override { Insistence::Insist } else { Insistence::Refuse },
            memory: Some(limit),
            program: concat!("belvedere ", env!("CARGO_PKG_VERSION")).to_owned(),
            ..PlanParams::default()
        };
        let plan = Plan::kept_in(&folder, &params, &run.control())?;
        let (low, high) = plan.bounds().on_map();
        let cells = CellSizes::all(self.cell.unwrap_or_else(|| cell_for(low, high)));
        let plan = plan.with_cells(cells)?.with_cells_on(self.level, self.height);
        let plan = match self.ground {
            GroundChoice::OfScene(points) => plan.with_ground(*points),
            GroundChoice::Cloud(_) => plan,
        };
        let plan = city::planned(plan, &self.scene.plan, self.far, self.trees)?;
        run.summary.remarks(plan.remarks.clone());
        run.summary.remarks([Remark::note(
            "in-tiles",
            format!(
                "one model of this survey takes about {} GB of memory, and {} GB may be used: answered in tiles of {} m",
                in_gigabytes(whole),
                in_gigabytes(limit),
                plan.tile_size
            ),
        )
        .with("tile_size_m", plan.tile_size)]);
        Ok(Some(TiledSurvey { typed: self, plan, folder, is_temporary, limit }))
    }

    /// A flag that was typed and that tiles do not know.
    fn unknown_flag(&self) -> Result<Option<String>> {
        let SceneInput { input, balls, .. } = self.scene;
        let is_unknown = |output: &&PathBuf| !["tif", "tiff", "png"].contains(&extension(output).as_str());
        let others = [
            ("--up", !matches!(input.up, crate::arguments::UpChoice::Z)),
            ("--skip-distant", input.skip_distant),
            ("--trees", balls.trees.is_some()),
            ("--orient", balls.orient.is_some()),
            ("--scene-config", balls.config.scene_config.is_some()),
            ("--ground cloud=FILE", matches!(self.ground, GroundChoice::Cloud(_))),
        ];
        let given = others.iter().chain(&self.others).find(|(_, is_given)| *is_given);
        let output = self.outputs.iter().find(is_unknown).map(|output| format!("-o {}", output.display()));
        Ok(given.map(|(flag, _)| (*flag).to_owned()).or(output))
    }
}

impl<'a> TiledSurvey<'a> {
    /// The questions that one question comes to.
    pub(crate) fn questions(&self, question: &ask::Question, run: &mut CommandContext) -> Result<Vec<TileQuestion>> {
        self.with_whereabouts(run, |whereabouts, context| Ok(TileQuestion::of(question, whereabouts, context)?))
    }

    /// What `ask` finds out of the place of the survey; its figures and remarks are reported.
    pub(crate) fn with_whereabouts<T>(
        &self,
        run: &mut CommandContext,
        ask: impl FnOnce(&Whereabouts<'_>, &mut Context) -> Result<T>,
    ) -> Result<T> {
        let frame = self.plan.frame()?;
        let has_far_terrain = self.typed.far.is_some_and(|far| far.terrain.is_some() || far.horizon.is_some());
        let mut context = Context::default();
        let found = ask(&Whereabouts { frame: &frame, bounds: self.plan.bounds(), has_far_terrain }, &mut context)?;
        run.answered(&context.into_answers());
        Ok(found)
    }

    /// Answers the questions, tile by tile: what is done already is taken over.
    pub(crate) fn answer(
        self,
        questions: Vec<TileQuestion>,
        title: &str,
        run: &mut CommandContext,
    ) -> Result<TiledResults<'a>> {
        let Self { typed, plan, folder, is_temporary, limit } = self;
        check_size(&plan, &questions, limit)?;
        let plan = plan.with_questions(questions.clone(), &run.control())?;
        run.summary.remarks(plan.remarks.clone());
        let (plan, results) = plan.ready_in(&folder)?;
        let start = Instant::now();
        let params = RunParams {
            shard: Shard::default(),
            steps: Steps::All,
            max_balls: None,
            seconds: &|| start.elapsed().as_secs_f64(),
        };
        let report = run_tiles(&plan, &results, &params, &run.control())?;
        city::refuse_failed(&report, "run the command again to try them again")?;
        if let (Some(cache), false) = (&run.cache, is_temporary) {
            cache.make_room_beside(&folder);
        }
        run.summary.add_report(&report);
        run.summary.remarks(report.remarks());
        let (mut measures, mut grid) = (Vec::new(), None);
        let control = run.control();
        for question in &questions {
            grid = Some(plan.cells_of(question)?);
            measures.extend(measures_of(&plan, &results, question, questions.len() == 1, &control)?);
        }
        let Some(grid) = grid else { return Err(Usage("there is no question".to_owned()).into()) };
        let cells = measures.first().map_or(0, |measure| measure.values.iter().filter(|v| v.is_finite()).count());
        run.summary.add("tiles", plan.tiles.len()).add("cells", cells).add("cell_m", rounded(grid.cell, 4));
        let on_cells = format!("{cells} cells of {} m", grid.cell);
        run.summary.answer(&if title.is_empty() { on_cells } else { format!("{title}: {on_cells}") });
        for measure in &measures {
            let Some(found) = measure.rounded_statistics() else { continue };
            run.summary.add(&measure.name, Summary::of(&found));
            if measure.name == UNPROVEN_BAND {
                let [all, unproven] = [&measures[0], measure].map(positive_count);
                run.summary.answer(&format!("unproven: {} % of these", percent(unproven, all)));
                if questions[0].topic() == Topic::Shadow {
                    run.summary.remarks(remark_on_unproven_light(unproven, all));
                }
                continue;
            }
            let (name, mean) = (measure.name.replace('_', " "), rounded(100.0 * found.mean, 1));
            run.summary.answer(&match measure.kind {
                ResultKind::Answer => format!("{name}: {mean} %"),
                _ => format!("{name}: mean {}, {} to {}", found.mean, found.min, found.max),
            });
        }
        Ok(TiledResults { survey: Self { typed, plan, folder, is_temporary, limit }, questions, measures, grid })
    }
}

impl TiledResults<'_> {
    /// Writes all measures to each output; `map` draws the first over shaded relief.
    pub(crate) fn write(
        self,
        map: &dyn Fn(&[Measure], &HighestPoints) -> belvedere::Result<Picture>,
        run: &mut CommandContext,
    ) -> Result<()> {
        let Self { survey, questions, measures, grid } = self;
        let place = georeference(&grid, &survey.plan.frame()?);
        let mut written = Vec::new();
        for output in survey.typed.outputs {
            let control = run.control();
            if extension(output) == "png" {
                let heights = run.stage("reading relief", 0, |control| survey.plan.highest_points(&grid, control))?;
                let relief = HighestPoints { heights, cell: grid.cell, place: place.clone() };
                run.stage("writing", 0, |_| write_png(output, &map(&measures, &relief)?))?;
            } else {
                control.check()?;
                let pixels = Pixels::of_measures(&measures, [grid.width, grid.height])?;
                let names = measures.iter().map(|measure| measure.name.clone()).collect();
                let description = questions.first().map_or("", TileQuestion::description).to_owned();
                let raster = ResultRaster { pixels, names, description };
                run.stage("writing", 0, |_| raster.write_cog(output, &place))?;
            }
            written.push(output.display().to_string());
        }
        if survey.is_temporary {
            remove(&survey.folder);
        }
        run.summary.add("written", written);
        Ok(())
    }
}

/// Bytes of each value of the raster of all results while it is put together.
const BYTES_PER_VALUE: u64 = 10;

/// Refuses results that would not fit into memory together, before hours of work go into them.
fn check_size(plan: &Plan, questions: &[TileQuestion], limit: u64) -> Result<()> {
    let mut values = 0;
    for question in questions {
        let grid = plan.cells_of(question)?;
        values += grid.len() as u64;
    }
    if values.saturating_mul(BYTES_PER_VALUE) <= limit {
        return Ok(());
    }
    let [needed, limit] = [values * BYTES_PER_VALUE, limit].map(in_gigabytes);
    Err(Usage(format!(
        "--memory: {values} values of {} results take about {needed} GB, more than the {limit} GB that may be used; \
         give larger cells (--cell), fewer suns, or more memory, or use `belvedere city`, which writes each result on its own",
        questions.len()
    ))
    .into())
}

/// Cells whose value is above zero.
fn positive_count(measure: &Measure) -> usize {
    measure.values.iter().filter(|&&value| value > 0.0).count()
}

/// A map of the first of several measures.
pub(crate) fn map_of_first(measures: &[Measure], relief: &HighestPoints, title: &str) -> belvedere::Result<Picture> {
    let HighestPoints { heights, cell, place } = relief;
    measure_map(&measures[0], heights, *cell, place, title)
}

/// The measures of a question: its values, and of a single question what of them is unproven.
fn measures_of(
    plan: &Plan,
    folder: &Path,
    question: &TileQuestion,
    is_single: bool,
    control: &belvedere::control::Control<'_>,
) -> Result<Vec<Measure>> {
    let pixels = plan.results_of(folder, question, control)?;
    let kind = pixels.kind();
    let names = if is_single { question.band_names(kind) } else { vec![question.name().to_owned()] };
    let range = (kind == ResultKind::Answer).then_some([0.0, 1.0]);
    let of_band = |(name, band): (String, belvedere::raster::Raster<f32>)| {
        let what = if name == UNPROVEN_BAND { "1: so, but unproven" } else { question.description() };
        Measure::new(&name, band.values().to_vec()).with_description(what).with_kind(kind).with_range(range)
    };
    Ok(names.into_iter().zip(pixels.to_numbers()?).map(of_band).collect())
}

/// Removes the folder of a survey that is not kept; what cannot be removed does no harm.
fn remove(folder: &Path) {
    let _ = fs::remove_dir_all(folder);
}
