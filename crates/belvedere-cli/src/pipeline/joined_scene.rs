//! A scene that is made in tiles, where one model at once takes more memory than is allowed.

use super::read_counted;
use crate::arguments::{Rectangle, SceneInput, UpChoice, refuse};
use crate::in_tiles::{PROGRAM, TilesFolder};
use crate::memory;
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::io::{Insistence, ReadReport};
use belvedere::model::SceneModel;
use belvedere::{Error, PointCloud};
use belvedere_tiles::{JoinedSurvey, Plan, PlanParams, TooLarge};

/// Places in the coordinates of the files, and a distance from them in metres, within which a question needs its scene.
pub(crate) type ScenePart<'a> = (&'a [[f64; 2]], f64);

impl SceneInput {
    /// Returns the memory of one model that is made at once, if it is more than may be used.
    pub(crate) fn too_large(&self) -> Option<TooLarge> {
        // a part that was typed is one model
        let limit = memory::limit(&self.memory).filter(|_| self.input.bounds.is_none())?;
        TooLarge::of(&self.input.clouds, limit)
    }

    /// Returns the flag of a scene that tiles do not know, if one was typed.
    pub(crate) fn not_in_tiles(&self) -> Option<&'static str> {
        let Self { input, balls, .. } = self;
        let flags = [
            ("--up", !matches!(input.up, UpChoice::Z)),
            ("--skip-distant", input.skip_distant),
            ("--lines", !input.flight_lines.is_empty()),
            ("--dates", input.dates.is_some()),
            ("--only-classes", !input.only_classes.is_empty()),
            ("--trees", balls.trees.is_some()),
            ("--orient", balls.orient.is_some()),
            ("--scene-config", balls.config.scene_config.is_some()),
        ];
        flags.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// Returns the parameters of the plan of its tiles.
    pub(crate) fn plan_params(&self) -> PlanParams {
        let input = &self.input;
        PlanParams {
            clouds: input.clouds.clone(),
            crs: input.crs.clone(),
            crs_against_files: if input.crs_override { Insistence::Insist } else { Insistence::Refuse },
            flown: input.flown,
            program: PROGRAM.to_owned(),
            ..PlanParams::default()
        }
    }
}

/// Makes a scene, or the part of it that a question needs, in tiles; `None` where one model is made at once.
pub(super) fn joined_scene(
    scene: &SceneInput,
    part: Option<ScenePart<'_>>,
    run: &mut CommandContext,
) -> Result<Option<(SceneModel, PointCloud, ReadReport)>> {
    let Some(large) = scene.too_large() else { return Ok(None) };
    let is_typed = scene.memory.memory.is_some();
    if let Some(flag) = scene.not_in_tiles() {
        return match is_typed {
            true => {
                let large = large.in_words();
                refuse(format!("{flag} is not there in tiles, and {large}; leave it out, or allow more memory"))
            }
            // one model is tried, as if there were no tiles
            false => Ok(None),
        };
    }
    let folder = TilesFolder::of(scene, &[], run)?;
    let kept = Plan::kept_in(folder.path(), &scene.plan_params(), &run.control());
    let plan = match kept {
        Err(Error::Cancelled) => return Err(Error::Cancelled.into()),
        // tiles do not know scans from the ground; what else is wrong, reading the files says as well
        Err(_) if !is_typed => return Ok(None),
        plan => plan?.fitting(large.limit)?,
    };
    run.summary.remarks([large.remark_on_balls(plan.tile_size)]);
    run.summary.remarks(plan.remarks.clone());
    let survey = JoinedSurvey::new(plan, folder.path(), part, if is_typed { large.limit } else { u64::MAX })?;
    survey.make_balls(&run.control())?;
    let mut input = scene.input.clone();
    input.bounds = survey.part.map(Rectangle);
    let options = input.read_options().with_frame(survey.frame.clone());
    let (cloud, report) = read_counted(&input, &options, run)?;
    let model = survey.model(&cloud, &run.control())?;
    folder.finish(run);
    run.summary.add("scene", "joined from tiles");
    Ok(Some((model, cloud, report)))
}
