//! Converts arguments to clouds, scene models and views. Calls the library; decides and computes nothing itself.

mod joined_scene;
mod loaded_scene;
pub(crate) mod params;
mod plan;

pub(crate) use joined_scene::ScenePart;
pub(crate) use loaded_scene::LoadedScene;
pub(crate) use plan::{areas, mesh_in, planned};

use joined_scene::joined_scene;

use crate::arguments::{
    CloudInput, MethodChoice, PlanArguments, ProfileChoice, SceneInput, UnprovenChoice, UpChoice, refuse,
};
use crate::device::with_device;
use crate::run::CommandContext;
use crate::scene_config::BallParameters;
use crate::summary::Summary;
use anyhow::{Result, anyhow, bail};
use belvedere::apps::ask::{self};
use belvedere::cache::{BuiltScene, ReadBefore, model_of_balls, scene_model};
use belvedere::depth::Profile;
use belvedere::io::{ReadOptions, ReadReport, UpAxis, is_ball_file, read_cloud, web_address};
use belvedere::model::{BallParams, ModelParams, SceneModel};
use belvedere::query::UnprovenAs;
use belvedere::vector::to_f32;
use belvedere::{Bounds, Error, Parameter, PointCloud};
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// Reads the cloud and reports on it.
pub(crate) fn read(input: &CloudInput, run: &mut CommandContext) -> Result<PointCloud> {
    Ok(read_counted(input, &input.read_options(), run)?.0)
}

/// Reads the cloud for results whose rows belong to the rows of the file, which a point left out would shift.
pub(crate) fn read_every_row(input: &CloudInput, run: &mut CommandContext) -> Result<PointCloud> {
    let (cloud, report) = read_counted(input, &input.read_options(), run)?;
    refuse_part(input)?;
    check_every_row(&report)?;
    Ok(cloud)
}

/// The error of reading these clouds, with the flag that left no point of them.
pub(crate) fn named_for_part(input: &CloudInput, error: Error) -> anyhow::Error {
    match error {
        Error::NoPoints { .. } => match input.part_flag() {
            Some(flag) => anyhow::Error::new(error).context(flag),
            None => error.into(),
        },
        _ => error.into(),
    }
}

/// Refuses a part of a cloud.
pub(crate) fn refuse_part(input: &CloudInput) -> Result<()> {
    match input.part_flag() {
        None => Ok(()),
        Some(flag) => {
            let what = format!(
                "{flag}: this result has a row for each row of the file, of which only a part is read; leave it out, \
                 or give a format with coordinates"
            );
            refuse(what)
        }
    }
}

/// Refuses a cloud of which points were left out.
pub(crate) fn check_every_row(report: &ReadReport) -> Result<()> {
    let Some((file, left_out)) = report.files.iter().find_map(|file| Some((file, file.left_out.first()?))) else {
        return Ok(());
    };
    bail!(
        "{}: {} rows cannot be used ({}), so results would not match the rows of the file; repair or remove these rows",
        file.path.display(),
        report.left_out_count(),
        left_out.reason
    )
}

fn read_counted(
    input: &CloudInput,
    options: &ReadOptions,
    run: &mut CommandContext,
) -> Result<(PointCloud, ReadReport)> {
    let read = run.stage("reading", 0, |control| read_cloud(&input.clouds, options, control));
    let (cloud, report) = read.map_err(|error| named_for_part(input, error))?;
    run.summary.add("points", cloud.len());
    run.summary.add("reading", Summary::of(&report));
    warn_of_files(&report, &mut run.summary);
    Ok((cloud, report))
}

/// Warns of files that hold fewer points than their headers announce, of what speaks against their reference system,
/// and of what contradicts each other in them.
pub(crate) fn warn_of_files(report: &ReadReport, summary: &mut Summary) {
    let missing = report.files.iter().map(|file| (file.path.display().to_string(), file.missing_points));
    summary.remarks(ask::remarks_on_reading(report.doubt.as_deref(), missing, report.contradictions()));
}

/// The error of building a model of these clouds, with their names where they have too few points, and with the flags
/// that help.
pub(crate) fn advised(input: &CloudInput, error: Error) -> anyhow::Error {
    let names = || input.names().join(", ");
    match error {
        Error::NoPoints { what } => {
            let what = format!("{what}; see --keep-noise and --keep-isolated of `belvedere balls`, or --scene-config");
            anyhow::Error::from(Error::NoPoints { what }).context(names())
        }
        Error::NoSurface { .. } => anyhow::Error::from(error).context(names()),
        other => other.into(),
    }
}

/// Choice to keep the points that the balls of a scene were made from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum KeepPoints {
    Keep,
    LetGo,
}

/// The scene of a ball file, or of a cloud, as it will be with what is planned.
pub(crate) fn scene(arguments: &SceneInput, points: KeepPoints, run: &mut CommandContext) -> Result<LoadedScene> {
    scene_in_reach(arguments, None, points, run)
}

/// Reads or makes the scene of a question that needs only a part of it, as [`scene`].
pub(crate) fn scene_in_reach(
    arguments: &SceneInput,
    part: Option<ScenePart<'_>>,
    points: KeepPoints,
    run: &mut CommandContext,
) -> Result<LoadedScene> {
    let points = if arguments.plan.clear.is_empty() { points } else { KeepPoints::Keep };
    let present = present_scene(arguments, part, points, run)?;
    as_planned(present, &arguments.plan, run)
}

/// The scene as it will be, on the device that was chosen.
fn as_planned(mut scene: LoadedScene, plan: &PlanArguments, run: &mut CommandContext) -> Result<LoadedScene> {
    if !plan.clear.is_empty() {
        plan::clear(&mut scene, plan, run)?;
    }
    scene.model = with_device(planned(scene.model, plan, run)?);
    Ok(scene)
}

/// The scene as it is, and as it will be; `None` where nothing is planned. Both have their points.
pub(crate) fn present_and_planned(
    arguments: &SceneInput,
    run: &mut CommandContext,
) -> Result<(LoadedScene, Option<LoadedScene>)> {
    let mut present = present_scene(arguments, None, KeepPoints::Keep, run)?;
    let plan = &arguments.plan;
    let is_planned = !plan.add.is_empty() || !plan.clear.is_empty();
    let planned = is_planned.then(|| as_planned(present.clone(), plan, run)).transpose()?;
    present.model = with_device(present.model);
    Ok((present, planned))
}

/// Returns true if a path is a file, or the address of one.
pub(crate) fn is_file(path: &Path) -> bool {
    path.is_file() || web_address(path).is_some()
}

/// The scene of a ball file, or of a cloud, as it is.
fn present_scene(
    arguments: &SceneInput,
    part: Option<ScenePart<'_>>,
    points: KeepPoints,
    run: &mut CommandContext,
) -> Result<LoadedScene> {
    let parameters = arguments.balls.parameters()?;
    let profile = parameters.profile();
    if let [path] = &arguments.input.clouds[..]
        && is_file(path)
        && is_ball_file(path)?
    {
        refuse_flags_of_clouds(arguments, &parameters, path)?;
        let model = model_of_balls(path, run.cache.as_ref(), &run.control())
            .map_err(|error| with_file_of_exterior_balls(error, path))?;
        run.summary.add("balls_read", model.balls().len());
        return Ok(LoadedScene::without_points(model, profile));
    }
    if let Some((model, cloud, left_out)) = joined_scene(arguments, part, run)? {
        return Ok(LoadedScene { model, cloud: Arc::new(cloud), left_out, profile, ground_store: None });
    }
    let balls = parameters.balls(MethodChoice::Carved)?;
    if points == KeepPoints::LetGo
        && let Some(model) = kept_scene(&arguments.input, &parameters, balls, run)?
    {
        return Ok(LoadedScene::without_points(model, profile));
    }
    let kept = kept_points(&arguments.input, run);
    let is_read = kept.is_none();
    let (mut cloud, left_out, notes) = match kept {
        Some((cloud, notes)) => (cloud, ReadReport::default(), notes),
        None => {
            let options = arguments.input.read_options();
            let (read, notes) = run.aside(|run| read_counted(&arguments.input, &options, run));
            let (cloud, left_out) = read?;
            (cloud, left_out, notes.into_entries())
        }
    };
    run.summary.add_report(&notes);
    let frame = cloud.frame.clone();
    let params = params::model(&parameters, balls, &frame.crs, run)?;
    let given = match points {
        KeepPoints::Keep => Cow::Borrowed(&cloud),
        KeepPoints::LetGo => Cow::Owned(std::mem::replace(&mut cloud, PointCloud::in_frame(frame))),
    };
    let built = built_of(given, &params, &arguments.input, run)?;
    if let (Some(cache), Some(contents), true) = (&run.cache, &built.cloud, is_read) {
        let before = ReadBefore::new(contents.clone(), cloud.frame.clone(), notes);
        let (files, options) = (&arguments.input.clouds, arguments.input.read_options());
        let is_whole = points == KeepPoints::Keep && left_out.left_out_count() == 0;
        // what fails here has failed for the scene as well, which says it
        let _ = run
            .stage("keeping points", 0, |_| cache.keep_reading(files, &options, &before, is_whole.then_some(&cloud)));
    }
    let kept = run.cache.as_ref().zip(built.cloud.as_ref()).map(|(cache, contents)| cache.ground_of(contents));
    // the ground that is kept is that of lines fitted to each other
    let ground_store = kept.filter(|_| !parameters.cleaning.keep_strips);
    Ok(LoadedScene { model: reported(built, run), cloud: Arc::new(cloud), left_out, profile, ground_store })
}

/// Adds the name of the file to the error about exterior balls.
fn with_file_of_exterior_balls(error: Error, path: &Path) -> anyhow::Error {
    match error {
        Error::InvalidParameter { parameter: Parameter::BallSide, .. } => anyhow!(
            "{}: these are exterior balls (--side exterior), which block nothing; use interior balls",
            path.display()
        ),
        error => error.into(),
    }
}

/// The model of a cloud that was read from `input`: found in the cache, or built and kept there.
pub(crate) fn model_of(
    cloud: Cow<'_, PointCloud>,
    params: &ModelParams,
    input: &CloudInput,
    run: &mut CommandContext,
) -> Result<SceneModel> {
    let built = built_of(cloud, params, input, run)?;
    Ok(reported(built, run))
}

fn built_of(
    cloud: Cow<'_, PointCloud>,
    params: &ModelParams,
    input: &CloudInput,
    run: &CommandContext,
) -> Result<BuiltScene> {
    let built = scene_model(cloud, params, run.cache.as_ref(), &run.control());
    built.map_err(|error| advised(input, error))
}

/// Reports on a model that was built or found.
fn reported(built: BuiltScene, run: &mut CommandContext) -> SceneModel {
    run.summary.add("scene", built.origin.name());
    run.summary.remarks(built.origin.remark());
    run.summary.add_report(&built.report);
    built.model
}

/// The scene of files that were read before and have not changed, if it was kept.
fn kept_scene(
    input: &CloudInput,
    parameters: &BallParameters,
    balls: BallParams,
    run: &mut CommandContext,
) -> Result<Option<SceneModel>> {
    let Some(cache) = run.cache.clone() else { return Ok(None) };
    let Some(before) = cache.read_before(&input.clouds, &input.read_options()) else { return Ok(None) };
    let params = params::model(parameters, balls, &before.frame.crs, run)?;
    let Some(found) = cache.find(&before.cloud, &params, false, &run.control()) else { return Ok(None) };
    run.summary.add_report(&before.notes);
    Ok(Some(reported(found, run)))
}

/// Returns the points of files that were read before and have not changed, if they were kept, and the notes of reading.
fn kept_points(input: &CloudInput, run: &CommandContext) -> Option<(PointCloud, Map<String, Value>)> {
    let cache = run.cache.as_ref()?;
    let before = cache.read_before(&input.clouds, &input.read_options())?;
    let cloud = cache.points(&before)?;
    Some((cloud, before.notes))
}

/// Flags that say how to make balls are of no use where they are made already.
fn refuse_flags_of_clouds(arguments: &SceneInput, parameters: &BallParameters, path: &Path) -> Result<()> {
    let given = [
        ("--crs", arguments.input.crs.is_some()),
        ("--up", arguments.input.up != UpChoice::Z),
        ("--bounds", arguments.input.bounds.is_some()),
        ("--lines", !arguments.input.flight_lines.is_empty()),
        ("--dates", arguments.input.dates.is_some()),
        ("--flown", arguments.input.flown.is_some()),
        ("--only-classes", !arguments.input.only_classes.is_empty()),
        ("--orient", arguments.balls.orient.is_some()),
        ("--trees", arguments.balls.trees.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some(("--crs", _)) => {
            let path = path.display();
            refuse(format!(
                "--crs is for building balls from a cloud, but {path} is a ball file: give --location LAT,LON where the sun needs a place, \
                 or make the ball file again with --crs"
            ))
        }
        Some((flag, _)) => {
            let path = path.display();
            refuse(format!("{flag} is for building balls from a cloud, but {path} is a ball file"))
        }
        None => parameters.refuse_file(path),
    }
}

/// Lowest and highest corner of a cloud that has points.
pub(crate) fn bounds_of(cloud: &PointCloud) -> Result<Bounds> {
    Ok(cloud.bounds().ok_or_else(|| Error::NoPoints { what: "none was read".to_owned() })?)
}

impl From<UnprovenChoice> for UnprovenAs {
    fn from(choice: UnprovenChoice) -> Self {
        match choice {
            UnprovenChoice::Report => Self::Reported,
            UnprovenChoice::AsVisible => Self::Visible,
            UnprovenChoice::AsBlocked => Self::Blocked,
        }
    }
}

impl From<UpChoice> for UpAxis {
    fn from(choice: UpChoice) -> Self {
        match choice {
            UpChoice::Z => Self::Z,
            UpChoice::Y => Self::Y,
        }
    }
}

impl From<ProfileChoice> for Profile {
    fn from(choice: ProfileChoice) -> Self {
        match choice {
            ProfileChoice::Sphere => Self::Sphere,
            ProfileChoice::PaperCone => Self::PaperCone,
        }
    }
}

/// Local positions as f32 in file coordinates, which is what masbcpp's folders hold.
pub(crate) fn file_coordinates(cloud: &PointCloud, local: &[[f32; 3]]) -> Vec<[f32; 3]> {
    local.iter().map(|&p| cloud.frame.to_file_coordinates(p).map(to_f32)).collect()
}
