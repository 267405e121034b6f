//! Questions on the cells of a survey that does not fit into memory: typed and written like those of one cloud, and
//! answered in tiles.

use crate::arguments::{
    FarTerrainArguments, GroundChoice, MemoryArgument, PlanArguments, SceneInput, SkyOutputs, SkyPlaces,
    ThroughTreesArguments, UpChoice, Usage, refuse,
};
use crate::memory;
use crate::outputs::formats::extension;
use crate::outputs::targets::{HighestPoints, remark_on_first};
use crate::pipeline::areas;
use crate::run::CommandContext;
use anyhow::{Result, bail};
use belvedere::Error;
use belvedere::apps::ask::{Answers, GridCells, Question};
use belvedere::cache::SurveyFolder;
use belvedere::figures::{Picture, write_png};
use belvedere::io::Insistence;
use belvedere::results::{georeference, measure_map};
use belvedere_tiles::{Plan, PlanParams, RunReport, SideFile, SurveyCells, SurveyQuestion, TileQuestion, TooLarge};
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
    pub(crate) memory: &'a MemoryArgument,
    pub(crate) cells: GridCells,
    /// Terrain beyond the survey.
    pub(crate) far: Option<&'a FarTerrainArguments>,
    pub(crate) trees: Option<&'a ThroughTreesArguments>,
    pub(crate) output: &'a [PathBuf],
    /// Flags of the command that tiles do not know, and whether each was typed.
    pub(crate) others: Vec<(&'static str, bool)>,
}

/// A survey that is answered in tiles.
pub(crate) struct PlannedSurvey {
    pub(crate) plan: Plan,
    folder: SurveyFolder,
    /// True if nobody keeps the tiles.
    is_temporary: bool,
    /// Memory that may be used, bytes.
    limit: u64,
}

/// Draws answers over shaded relief.
pub(crate) type DrawnMap<'a> = &'a dyn Fn(&Answers<SurveyCells>, &HighestPoints) -> belvedere::Result<Picture>;

impl<'a> TypedCells<'a> {
    /// Collects the arguments of a question about sun and sky.
    pub(crate) fn of_sky(
        (scene, memory): (&'a SceneInput, &'a MemoryArgument),
        places: &'a SkyPlaces,
        trees: &'a ThroughTreesArguments,
        outputs: &'a SkyOutputs,
        others: &[(&'static str, bool)],
    ) -> Self {
        let of_places = [
            ("--ground cloud=FILE", matches!(places.ground, GroundChoice::Cloud(_))),
            ("--self", places.places.own),
            ("--targets", places.places.targets.is_some()),
            ("--at", !places.places.at.is_empty()),
            ("--edge-mask", places.edge_mask.is_some()),
            ("--measures", outputs.measures.is_some()),
            ("--by-area", outputs.by_area.by_area.is_some()),
        ];
        Self {
            scene,
            memory,
            cells: places.cells(),
            far: Some(&places.far),
            trees: Some(trees),
            output: &outputs.output,
            others: of_places.into_iter().chain(others.iter().copied()).collect(),
        }
    }

    /// Answers in tiles what one model has no memory for, and writes it, with `map` or maps of the first measure;
    /// `None` where one model is to be made.
    pub(crate) fn answered(
        &self,
        question: Question,
        map: Option<DrawnMap<'_>>,
        run: &mut CommandContext,
    ) -> Result<Option<Answers<SurveyCells>>> {
        let Some(survey) = self.survey(&question, run)? else { return Ok(None) };
        self.answer(survey, question, map, run).map(Some)
    }

    /// The plan of a survey that one model has no memory for; `None` where one model is to be made.
    pub(crate) fn survey(&self, question: &Question, run: &mut CommandContext) -> Result<Option<PlannedSurvey>> {
        let input = &self.scene.input;
        // a part that was typed is one model
        let Some(limit) = memory::limit(self.memory).filter(|_| input.bounds.is_none()) else { return Ok(None) };
        let Some(large) = TooLarge::of(&input.clouds, limit) else { return Ok(None) };
        if let Some(what) = self.unknown(question) {
            return match self.memory.memory {
                // one model is tried, as if there were no tiles
                None => Ok(None),
                Some(_) => refuse(format!(
                    "{what} is not there in tiles, and {}; leave it out, or allow more memory",
                    large.in_words()
                )),
            };
        }
        let options = input.read_options();
        let kept = run.cache.as_ref().and_then(|cache| cache.survey_folder(&input.clouds, &options));
        let beside = self.output.first().map(|output| output.with_extension("tiles"));
        let is_temporary = kept.is_none();
        let folder = match (kept, beside) {
            (Some(kept), _) => kept,
            (None, Some(beside)) => made_beside(&beside)?,
            (None, None) => return Ok(None),
        };
        let params = PlanParams {
            clouds: input.clouds.clone(),
            crs: input.crs.clone(),
            crs_against_files: if input.crs_override { Insistence::Insist } else { Insistence::Refuse },
            flown: input.flown,
            program: PROGRAM.to_owned(),
            ..PlanParams::default()
        };
        let plan = Plan::kept_in(folder.path(), &params, &run.control())?;
        let plan = plan.with_grid_cells(&self.cells)?.fitting(limit)?;
        run.summary.remarks([large.remark_on_tiles(plan.tile_size)]);
        let plan = planned(plan, &self.scene.plan, self.far, self.trees.map(|trees| (trees, latitude(question))))?;
        Ok(Some(PlannedSurvey { plan, folder, is_temporary, limit }))
    }

    /// Answers a question tile by tile, and writes it.
    pub(crate) fn answer(
        &self,
        survey: PlannedSurvey,
        question: Question,
        map: Option<DrawnMap<'_>>,
        run: &mut CommandContext,
    ) -> Result<Answers<SurveyCells>> {
        let PlannedSurvey { plan, folder, is_temporary, limit } = survey;
        let survey = SurveyQuestion::new(plan, folder.path(), question.clone(), limit, &run.control())?;
        let start = Instant::now();
        let report = survey.run(&|| start.elapsed().as_secs_f64(), &run.control())?;
        refuse_failed(&report, "run the command again to try them again")?;
        run.summary.add_report(&report);
        let answers = survey.answers(&report, &run.control())?;
        run.name_question(&question, answers.time_zone());
        run.answered(&answers);
        self.write(&answers, map, run)?;
        match (&run.cache, is_temporary) {
            (Some(cache), false) => cache.make_room_beside(&folder),
            _ => folder.remove(),
        }
        Ok(answers)
    }

    /// Returns the typed arguments that tiles do not support.
    fn unknown(&self, question: &Question) -> Option<String> {
        let SceneInput { input, balls, .. } = self.scene;
        let flags = [
            ("--up", !matches!(input.up, UpChoice::Z)),
            ("--skip-distant", input.skip_distant),
            ("--trees", balls.trees.is_some()),
            ("--orient", balls.orient.is_some()),
            ("--scene-config", balls.config.scene_config.is_some()),
        ];
        let flag = flags.iter().chain(&self.others).find(|(_, is_given)| *is_given).map(|(flag, _)| (*flag).to_owned());
        let is_unknown = |output: &&PathBuf| !["tif", "tiff", "png"].contains(&extension(output).as_str());
        let output = || Some(format!("-o {}", self.output.iter().find(is_unknown)?.display()));
        let part = || TileQuestion::not_in_tiles(question).map(|what| format!("what was typed ({what})"));
        flag.or_else(output).or_else(part)
    }

    fn write(&self, answers: &Answers<SurveyCells>, map: Option<DrawnMap<'_>>, run: &mut CommandContext) -> Result<()> {
        let mut written = Vec::new();
        for output in self.output {
            if extension(output) == "png" {
                let cells = &answers.found;
                let heights = run.stage("reading relief", 0, |control| cells.relief(control))?;
                let place = georeference(&cells.grid, &cells.frame);
                let relief = HighestPoints { heights, cell: cells.grid.cell, place };
                let picture = match map {
                    Some(map) => map(answers, &relief)?,
                    None => {
                        run.summary.remarks(remark_on_first(output, &answers.measures));
                        map_of_first(answers, &relief)?
                    }
                };
                run.stage("writing", 0, |_| write_png(output, &picture))?;
            } else {
                run.stage("writing", 0, |_| answers.found.write_cog(output, &answers.measures, &run.tags))?;
            }
            written.push(output.display().to_string());
        }
        run.summary.add("written", written);
        Ok(())
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

/// The folder of tiles that nobody keeps, beside the result.
fn made_beside(folder: &Path) -> Result<SurveyFolder> {
    SurveyFolder::make(folder).map_err(|error| match error {
        Error::Io { source, .. } if source.kind() == ErrorKind::AlreadyExists => {
            let what = "tiles would be made there, but it is there already, and not made by this program";
            Usage(format!("{}: {what}; move it away", folder.display())).into()
        }
        error => error.into(),
    })
}

/// A map of the first measure.
fn map_of_first(answers: &Answers<SurveyCells>, relief: &HighestPoints) -> belvedere::Result<Picture> {
    let HighestPoints { heights, cell, place } = relief;
    measure_map(&answers.measures[0], heights, *cell, place, &answers.found.title)
}

/// The plan with what will be built, before far terrain, and with light through trees at a latitude, radians, where one
/// was typed.
pub(crate) fn planned(
    plan: Plan,
    changes: &PlanArguments,
    far: Option<&FarTerrainArguments>,
    trees: Option<(&ThroughTreesArguments, Option<f64>)>,
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
    match trees.choice()?.crowns(plan.knows_crowns(), plan.crown_density(latitude)?)? {
        Some(crowns) => Ok(plan.with_light_through_trees(crowns)?),
        None => Ok(plan),
    }
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
