//! `belvedere view`.

use super::check_output;
use crate::arguments::{Global, MethodChoice, SceneInput, Usage, ViewPage};
use crate::interrupt;
use crate::pipeline::{self, Points, flagged, params};
use crate::progress::Stages;
use crate::summary::{Summary, note};
use anyhow::{Context, Result, bail};
use belvedere::PointCloud;
use belvedere::apps::sun::{Date, Site, Zone};
use belvedere::io::{atomic, is_ball_file};
use belvedere::model::SceneModel;
use belvedere_viewer::{ExportParams, Loading, Viewer, ViewerParams, export};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// How often Ctrl-C is looked for.
const POLL: Duration = Duration::from_millis(20);

pub(crate) fn run(arguments: &ViewPage, global: &Global) -> Result<Summary> {
    let files = &arguments.scene.input.clouds;
    for path in files {
        path.metadata().map_err(belvedere::Error::io(path))?;
    }
    let (balls, clouds) = parted(files)?;
    if let Some(output) = &arguments.export {
        return write_page(output, arguments, global);
    }
    let title = title(files);
    let params = ViewerParams { port: arguments.port.unwrap_or(0), input: typed(), title };
    let viewer = Viewer::start(&params).context("--port: the program cannot listen there")?;
    print_url(&viewer.url(), global)?;
    if !arguments.no_browser
        && let Err(error) = viewer.open_browser()
    {
        note(&format!("the browser cannot be opened ({error}): open the address above"));
    }
    let loading = viewer.loading();
    let mut summary = Summary::default();
    let mut stages = Stages::new(global).told_also(loading.clone());
    match load(&arguments.scene, balls, clouds, &loading, &mut stages, &mut summary) {
        Ok((_, model)) => loading.finish(model),
        Err(error) => {
            // the page says it too, and looks for it four times a second
            loading.fail(format!("{error:#}"));
            std::thread::sleep(Duration::from_secs(1));
            return Err(error);
        }
    }
    note("ready; Ctrl-C ends it");
    while !interrupt::is_requested() {
        std::thread::sleep(POLL);
    }
    drop(viewer);
    Ok(Summary::default())
}

/// What the page is called: the name of its first file.
fn title(files: &[PathBuf]) -> String {
    files.first().and_then(|path| path.file_name()).unwrap_or_default().to_string_lossy().into_owned()
}

/// Writes the page as one file.
fn write_page(output: &Path, arguments: &ViewPage, global: &Global) -> Result<Summary> {
    check_output("--export", output, &["html"])?;
    let date = arguments.date.as_deref().map(|date| flagged("--date", Date::parse(date))).transpose()?;
    let zone = arguments.zone.as_deref().map(|zone| flagged("--zone", Zone::parse(zone))).transpose()?;
    let loading = Loading::default();
    let (mut stages, mut summary) = (Stages::new(global), Summary::default());
    let (balls, clouds) = parted(&arguments.scene.input.clouds)?;
    let (cloud, model) = load(&arguments.scene, balls, clouds, &loading, &mut stages, &mut summary)?;
    let Some(cloud) = cloud else {
        return Err(Usage("--export needs a cloud; a ball file has no points".to_owned()).into());
    };
    let day = match (date, zone) {
        (None, _) => None,
        (Some(date), Some(zone)) => Some((date, zone)),
        (Some(date), None) => {
            let site = Site::of_scene(model.frame(), &model.bounds(), None, None)
                .context("--date needs the location of the scene: give its reference system with --crs EPSG:CODE")?;
            Some((date, Zone::mean_solar(&site.0)))
        }
    };
    let params = ExportParams { title: title(&arguments.scene.input.clouds), input: typed(), day };
    let exported = stages.run("making the page", 0, |control| export(&cloud, model, &params, control));
    let (page, report) = exported?;
    stages.run("writing", 0, |_| {
        atomic::write(output, |file| file.write_all(page.as_bytes()).map_err(belvedere::Error::io(output)))
    })?;
    summary.add_report(&report).add("written", output.display().to_string());
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

/// Ball files and clouds.
fn parted(files: &[PathBuf]) -> Result<(Option<PathBuf>, Vec<PathBuf>)> {
    let (mut balls, mut clouds) = (Vec::new(), Vec::new());
    for path in files {
        let is_balls = path.is_file() && is_ball_file(path)?;
        if is_balls { &mut balls } else { &mut clouds }.push(path.clone());
    }
    match &balls[..] {
        [_, _, ..] => Err(Usage("only one ball file can be shown at a time".to_owned()).into()),
        _ => Ok((balls.pop(), clouds)),
    }
}

/// Reads what was typed and builds its balls; shows the cloud as soon as it is there.
fn load(
    arguments: &SceneInput,
    balls: Option<PathBuf>,
    clouds: Vec<PathBuf>,
    loading: &Loading,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<(Option<Arc<PointCloud>>, SceneModel)> {
    let mut input = arguments.clone();
    let Some(balls) = balls else {
        let params = arguments.shrinking.params(MethodChoice::Carved)?;
        let cloud = Arc::new(pipeline::read(&arguments.input, stages, summary)?);
        loading.show(&cloud);
        let crs = &cloud.frame.crs;
        let params = params::model(&arguments.cleaning, &arguments.orienting, params, crs, stages)?;
        let built = SceneModel::build(&cloud, &params, &stages.control());
        let model = built.map_err(pipeline::advised)?.0;
        return Ok((Some(cloud), model));
    };
    input.input.clouds = vec![balls];
    let scene = pipeline::scene(&input, Points::Keep, stages, summary)?;
    let mut shown = None;
    if !clouds.is_empty() {
        input.input.clouds = clouds;
        let cloud = pipeline::read(&input.input, stages, summary)?;
        let frame = scene.model.frame();
        if cloud.frame.crs.contradicts(&frame.crs) {
            let (cloud, balls) = (cloud.frame.crs.describe(), frame.crs.describe());
            bail!("the cloud is in {cloud}, but the balls are in {balls}; convert one of them");
        }
        let cloud = Arc::new(cloud.moved_to(frame));
        loading.show(&cloud);
        shown = Some(cloud);
    }
    Ok((shown, scene.model))
}

/// The files and flags of the scene as they were typed, for a shell.
fn typed() -> String {
    let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let mut kept = Vec::new();
    let mut skips = false;
    for word in words {
        let is_of_page = ["view", "--no-browser", "--quiet", "--verbose", "-v", "--json"].contains(&word.as_str());
        let has_value = ["--port", "--export", "--date", "--zone", "--threads", "--seed", "--progress"];
        if std::mem::take(&mut skips) || is_of_page {
            continue;
        }
        if has_value.contains(&word.as_str()) {
            skips = true;
        } else if !has_value.iter().any(|flag| word.starts_with(&format!("{flag}="))) {
            kept.push(quoted(&word));
        }
    }
    kept.join(" ")
}

/// A word as a shell takes it for one.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-/=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

fn print_url(url: &str, global: &Global) -> Result<()> {
    let line = if global.json { serde_json::json!({ "url": url }).to_string() } else { url.to_owned() };
    let mut output = std::io::stdout().lock();
    writeln!(output, "{line}").and_then(|()| output.flush()).context("standard output")
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_are_quoted_only_where_a_shell_would_part_them() {
        assert_eq!(quoted("demo/town.laz"), "demo/town.laz");
        assert_eq!(quoted("my town.laz"), "'my town.laz'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
    }
}
