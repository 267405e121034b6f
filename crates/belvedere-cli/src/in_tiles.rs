//! Questions on the cells of a survey that does not fit into memory: typed and written like those of one cloud, and
//! answered in tiles.

use crate::arguments::{
    FarTerrainArguments, GroundChoice, PlanArguments, SceneInput, SkyOutputs, SkyPlaces, TilesArguments, Usage, refuse,
};
use crate::outputs::formats::{check_folder, extension};
use crate::outputs::targets::TargetOutput;
use crate::pipeline::areas;
use crate::run::CommandContext;
use crate::summary::rounded;
use anyhow::{Result, bail};
use belvedere::Error;
use belvedere::apps::ask::{Answers, GridCells, OnTargets, Places, Question, Scene, ThroughTrees};
use belvedere::cache::SurveyFolder;
use belvedere_tiles::{Plan, RunReport, SideFile, SurveyCells, SurveyPlaces, SurveyQuestion, TileQuestion};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Name and version of the program, as plans say them.
pub(crate) const PROGRAM: &str = concat!("belvedere ", env!("CARGO_PKG_VERSION"));
/// Maximum number of failures that are listed one by one.
const MAX_LISTED: usize = 10;

/// Typed arguments of a question about cells.
pub(crate) struct TypedCells<'a> {
    pub(crate) scene: &'a SceneInput,
    pub(crate) tiles: &'a TilesArguments,
    pub(crate) cells: GridCells,
    /// Terrain beyond the survey.
    pub(crate) far: Option<&'a FarTerrainArguments>,
    pub(crate) trees: Option<ThroughTrees>,
    pub(crate) output: &'a [PathBuf],
    /// Flags of the command that tiles do not know, and whether each was typed.
    pub(crate) others: Vec<(&'static str, bool)>,
    /// Flags that only cells in tiles do not know, and whether each was typed.
    pub(crate) of_points: Vec<(&'static str, bool)>,
}

/// A survey that is answered in tiles.
pub(crate) struct PlannedSurvey {
    pub(crate) plan: Plan,
    folder: TilesFolder,
    /// Memory that may be used, bytes.
    limit: u64,
    /// Cells of the question.
    cells: GridCells,
}

/// Answers in tiles, to be written as those of one scene.
pub(crate) struct TiledAnswers {
    pub(crate) answers: Answers<SurveyCells>,
    on: OnTargets,
}

impl TiledAnswers {
    /// Returns the cells to be written.
    pub(crate) fn shown(&self) -> TargetOutput<'_> {
        TargetOutput::of_survey(&self.on, &self.answers.found)
    }
}

impl<'a> TypedCells<'a> {
    /// Collects the arguments of a question about sun and sky.
    pub(crate) fn of_sky(
        (scene, tiles): (&'a SceneInput, &'a TilesArguments),
        places: &'a SkyPlaces,
        trees: ThroughTrees,
        outputs: &'a SkyOutputs,
        others: &[(&'static str, bool)],
    ) -> Self {
        let of_places = [
            ("--ground cloud=FILE", matches!(places.ground, GroundChoice::Cloud(_))),
            ("--self", places.places.own),
            ("--edge-mask", places.edge_mask.is_some()),
        ];
        let of_points = vec![("--targets", places.places.targets.is_some()), ("--at", !places.places.at.is_empty())];
        Self {
            scene,
            tiles,
            cells: places.cells(),
            far: Some(&places.far),
            trees: Some(trees),
            output: &outputs.output,
            others: of_places.into_iter().chain(others.iter().copied()).collect(),
            of_points,
        }
    }

    /// Returns the scene of a question about places: a survey of which only those tiles are built that may block their
    /// light, where one model has no memory; else that of `whole`.
    pub(crate) fn scene(
        &self,
        question: impl Into<Question>,
        whole: impl FnOnce(&mut CommandContext) -> Result<Scene>,
        run: &mut CommandContext,
    ) -> Result<SceneOfPlaces> {
        let question = question.into();
        let survey = if self.are_places(&question) { self.survey_of(&question, run)? } else { None };
        let Some(PlannedSurvey { plan, folder, limit, .. }) = survey else {
            return Ok(SceneOfPlaces::Whole(Box::new(whole(run)?)));
        };
        run.summary.remarks(plan.remarks.clone());
        let survey = SurveyPlaces::new(plan, folder.path(), limit)?;
        Ok(SceneOfPlaces::Tiles { survey: Box::new(survey), folder })
    }

    /// Returns the scene of a question about places under sun and sky.
    pub(crate) fn scene_of_sky(
        &self,
        question: impl Into<Question>,
        (places, shell): (&SkyPlaces, Option<f32>),
        run: &mut CommandContext,
    ) -> Result<SceneOfPlaces> {
        self.scene(question, |run| places.scene(self.scene, shell, places.needed_points(), run), run)
    }

    /// Plans tiles, or answers in tiles what one model has no memory for and passes it to `write`; `false` where one
    /// model is to be made.
    pub(crate) fn answered(
        &self,
        question: impl Into<Question>,
        write: impl FnOnce(&TiledAnswers, &mut CommandContext) -> Result<()>,
        run: &mut CommandContext,
    ) -> Result<bool> {
        let question = question.into();
        let complete = |_: &Plan, _: &mut CommandContext| Ok(question.clone());
        self.completed(&question, complete, write, run)
    }

    /// Answers as [`TypedCells::answered`] a question that `complete` completes for a plan.
    pub(crate) fn completed(
        &self,
        question: &Question,
        complete: impl FnOnce(&Plan, &mut CommandContext) -> Result<Question>,
        write: impl FnOnce(&TiledAnswers, &mut CommandContext) -> Result<()>,
        run: &mut CommandContext,
    ) -> Result<bool> {
        if let Some(folder) = &self.tiles.plan {
            self.plan((question, folder), complete, run)?;
            return Ok(true);
        }
        let Some(survey) = self.survey(question, run)? else { return Ok(false) };
        let question = complete(&survey.plan, run)?;
        write(&Self::answer(survey, question, run)?, run)?;
        Ok(true)
    }

    /// Plans tiles for many computers.
    fn plan(
        &self,
        (question, folder): (&Question, &Path),
        complete: impl FnOnce(&Plan, &mut CommandContext) -> Result<Question>,
        run: &mut CommandContext,
    ) -> Result<()> {
        let bounds = self.scene.input.bounds.is_some().then(|| "--bounds".to_owned());
        if let Some(what) = bounds.or_else(|| self.unknown(question)) {
            return refuse(format!("--plan: {what} is not there in tiles; leave it out"));
        }
        if let Some(output) = self.output.first() {
            return refuse(format!("--plan: -o {} comes later, with `belvedere city merge`", output.display()));
        }
        check_folder(folder)?;
        let plan = Plan::make(&self.scene.plan_params(), &run.control())?.with_grid_cells(&self.cells)?;
        let plan = match self.scene.memory.memory {
            Some(memory) => plan.fitting(memory.0)?,
            None => plan,
        };
        let plan = self.changed(plan, question)?;
        let question = TileQuestion::of_survey(&complete(&plan, run)?, &plan, &run.control())?;
        let plan = plan.with_questions(vec![question], &run.control())?;
        plan.write(folder)?;
        report_plan(&plan, folder, run);
        Ok(())
    }

    fn changed(&self, plan: Plan, question: &Question) -> Result<Plan> {
        planned(plan, &self.scene.plan, self.far, self.trees.map(|trees| (trees, latitude(question))))
    }

    /// The plan of a survey whose cells are answered in tiles; `None` where one model answers.
    pub(crate) fn survey(&self, question: &Question, run: &mut CommandContext) -> Result<Option<PlannedSurvey>> {
        match self.are_places(question) || self.unknown(question).is_some() {
            true => Ok(None),
            false => self.survey_of(question, run),
        }
    }

    fn survey_of(&self, question: &Question, run: &mut CommandContext) -> Result<Option<PlannedSurvey>> {
        let Some(large) = self.scene.too_large() else { return Ok(None) };
        let folder = TilesFolder::of(self.scene, self.output, run)?;
        let plan = Plan::kept_in(folder.path(), &self.scene.plan_params(), &run.control())?;
        let plan = plan.with_grid_cells(&self.cells)?.fitting(large.limit)?;
        run.summary.remarks([large.remark_on_tiles(plan.tile_size)]);
        let plan = self.changed(plan, question)?;
        Ok(Some(PlannedSurvey { plan, folder, limit: large.limit, cells: self.cells.clone() }))
    }

    /// Answers a question tile by tile.
    pub(crate) fn answer(survey: PlannedSurvey, question: Question, run: &mut CommandContext) -> Result<TiledAnswers> {
        let PlannedSurvey { plan, folder, limit, cells } = survey;
        let survey = SurveyQuestion::new(plan, folder.path(), question.clone(), limit, &run.control())?;
        let start = Instant::now();
        let report = survey.run(&|| start.elapsed().as_secs_f64(), &run.control())?;
        refuse_failed(&report, "run the command again to try them again")?;
        run.summary.add_report(&report);
        let answers = survey.answers(&report, &run.control())?;
        run.name_question(&question, &Places::Cells(cells), answers.time_zone());
        run.answered(&answers);
        folder.finish(run);
        let on = answers.found.on_targets(&answers.measures[0]);
        Ok(TiledAnswers { answers, on })
    }

    /// Returns the typed arguments that cells in tiles do not support.
    fn unknown(&self, question: &Question) -> Option<String> {
        let flag = self.of_points.iter().find(|(_, is_given)| *is_given).map(|(flag, _)| (*flag).to_owned());
        let is_unknown = |output: &&PathBuf| !["tif", "tiff", "png"].contains(&extension(output).as_str());
        let output = || Some(format!("-o {}", self.output.iter().find(is_unknown)?.display()));
        self.unknown_of_places(question).or(flag).or_else(output)
    }

    /// Returns true for places that tiles answer.
    fn are_places(&self, question: &Question) -> bool {
        self.of_points.iter().any(|(_, is_given)| *is_given) && self.unknown_of_places(question).is_none()
    }

    /// Returns the typed arguments that places in tiles do not support.
    fn unknown_of_places(&self, question: &Question) -> Option<String> {
        let of_question = || self.others.iter().find(|(_, is_given)| *is_given).map(|(flag, _)| *flag);
        let flag = self.scene.not_in_tiles().or_else(of_question).map(str::to_owned);
        flag.or_else(|| question.needs_whole().map(|what| format!("what was typed ({what})")))
    }
}

/// Scene of a question about places.
pub(crate) enum SceneOfPlaces {
    /// One model.
    Whole(Box<Scene>),
    /// A survey of which only some tiles are built.
    Tiles { survey: Box<SurveyPlaces>, folder: TilesFolder },
}

impl SceneOfPlaces {
    pub(crate) fn scene(&self) -> &Scene {
        match self {
            Self::Whole(scene) => scene,
            Self::Tiles { survey, .. } => &survey.scene,
        }
    }

    /// Refuses answers that missing tiles may change, and removes tiles that nobody keeps.
    pub(crate) fn finish(&self, run: &CommandContext) -> Result<()> {
        let Self::Tiles { survey, folder } = self else { return Ok(()) };
        folder.finish(run);
        Ok(survey.check()?)
    }
}

/// The latitude that was typed with a question, radians.
fn latitude(question: &Question) -> Option<f64> {
    let place = match question {
        Question::Shadow(shadow) => &shadow.place,
        Question::SunHours(hours) => &hours.place,
        Question::Irradiance(energy) => &energy.place,
        _ => return None,
    };
    place.location.map(|[latitude, _]| latitude.to_radians())
}

/// Folder of the tiles of a survey.
pub(crate) struct TilesFolder {
    folder: SurveyFolder,
    lifetime: TilesLifetime,
}

/// Lifetime of the tiles of a survey.
#[derive(Clone, Copy, PartialEq, Eq)]
enum TilesLifetime {
    /// For later questions, in the cache.
    InCache,
    /// Until the result beside them is written. A command that failed goes on with them, if there are any.
    UntilResult,
    /// Until the command ends.
    UntilEnd,
}

impl Drop for TilesFolder {
    fn drop(&mut self) {
        let has_tiles = || Plan::path(self.path()).exists();
        if self.lifetime == TilesLifetime::UntilEnd || self.lifetime == TilesLifetime::UntilResult && !has_tiles() {
            self.folder.remove();
        }
    }
}

impl TilesFolder {
    /// Returns the kept folder of the tiles of a scene. Without a cache it is a new one beside the first of `outputs`,
    /// or among temporary files.
    pub(crate) fn of(scene: &SceneInput, outputs: &[PathBuf], run: &CommandContext) -> Result<Self> {
        let (clouds, options) = (&scene.input.clouds, scene.input.read_options());
        if let Some(folder) = run.cache.as_ref().and_then(|cache| cache.survey_folder(clouds, &options)) {
            return Ok(Self { folder, lifetime: TilesLifetime::InCache });
        }
        let (path, lifetime) = match outputs.first() {
            Some(output) => (output.with_extension("tiles"), TilesLifetime::UntilResult),
            None => {
                let name = format!("belvedere-{}.tiles", std::process::id());
                (std::env::temp_dir().join(name), TilesLifetime::UntilEnd)
            }
        };
        let folder = SurveyFolder::make(&path).map_err(|error| match error {
            Error::Io { source, .. } if source.kind() == ErrorKind::AlreadyExists => {
                let what = "tiles would be made there, but it is there already, and not made by this program";
                Usage(format!("{}: {what}; move it away", path.display())).into()
            }
            error => anyhow::Error::from(error),
        })?;
        Ok(Self { folder, lifetime })
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Removes tiles that nobody keeps, and otherwise older scenes of a full cache.
    pub(crate) fn finish(&self, run: &CommandContext) {
        match (&run.cache, self.lifetime) {
            (Some(cache), TilesLifetime::InCache) => cache.make_room_beside(&self.folder),
            _ => self.folder.remove(),
        }
    }
}

/// The plan with what will be built, before far terrain, and with light through trees at a latitude, radians, where one
/// was typed.
pub(crate) fn planned(
    plan: Plan,
    changes: &PlanArguments,
    far: Option<&FarTerrainArguments>,
    trees: Option<(ThroughTrees, Option<f64>)>,
) -> Result<Plan> {
    let meshes = changes.add.iter().map(|path| SideFile::new(path)).collect::<belvedere::Result<Vec<_>>>()?;
    let plan = plan.with_meshes(meshes)?;
    let frame = plan.frame()?;
    let mut cleared = Vec::new();
    for choice in &changes.clear {
        cleared.extend(areas(choice, &frame)?);
    }
    let plan = plan.with_cleared(cleared)?;
    let side = |path: &Option<PathBuf>| path.as_deref().map(SideFile::new).transpose();
    let plan = match far {
        Some(far) => plan.with_far_terrain(side(&far.terrain)?, side(&far.horizon)?)?,
        None => plan,
    };
    let Some((trees, latitude)) = trees else { return Ok(plan) };
    match trees.crowns(plan.knows_crowns(), plan.crown_density(latitude)?)? {
        Some(crowns) => Ok(plan.with_light_through_trees(crowns)?),
        None => Ok(plan),
    }
}

/// Reports a plan that was written into a folder.
pub(crate) fn report_plan(plan: &Plan, folder: &Path, run: &mut CommandContext) {
    run.summary.remarks(plan.remarks.clone());
    let estimate = plan.estimate();
    run.summary
        .add("files", plan.inputs.len())
        .add("tiles", plan.tiles.len())
        .add("tile_size_m", plan.tile_size)
        .add("halo_m", plan.buffer)
        .add("results", plan.questions.iter().map(|one| one.name.as_str()).collect::<Vec<_>>())
        .add("points", estimate.points)
        .add("points_read_with_halo", estimate.points_with_buffer)
        .add("points_of_the_largest_tile", estimate.max_points_of_a_tile)
        .add("estimated_memory_gb", rounded(estimate.memory_bytes as f64 / 1e9, 2))
        .add("estimated_disk_gb", rounded(estimate.disk_bytes as f64 / 1e9, 2))
        .add("written", folder.display().to_string())
        .headline("<tiles> tiles of <tile_size_m> m, <points> points")
        .headline("results: <results>")
        .headline("estimated: <estimated_memory_gb> GB of memory, <estimated_disk_gb> GB on disk");
}

/// The error of a run of which something failed, with what to do.
pub(crate) fn refuse_failed(report: &RunReport, advice: &str) -> Result<()> {
    if let Some((first, _)) = report.failed.split_first() {
        let listed = report.failed.iter().take(MAX_LISTED).map(|why| format!("\n  {why}")).collect::<String>();
        let more = report.failed.len().saturating_sub(MAX_LISTED);
        let more = if more > 0 { format!("\n  and {more} more (belvedere city status)") } else { String::new() };
        if report.failed.len() == 1 {
            bail!("{first}; all else is done; {advice}");
        }
        bail!("{} steps failed; all else is done; {advice}:{listed}{more}", report.failed.len());
    }
    Ok(())
}
