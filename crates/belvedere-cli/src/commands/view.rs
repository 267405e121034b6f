//! `belvedere view`.

use crate::arguments::{
    CloudInput, Global, MapPosition, MethodChoice, SceneInput, UpChoice, ViewPage, refuse, refuse_given,
};
use crate::environment::words;
use crate::interrupt;
use crate::memory::available_bytes;
use crate::outputs::formats::check_output;
use crate::pipeline::{self, KeepPoints, is_file, params};
use crate::run::CommandContext;
use crate::summary::{Summary, note};
use crate::written_files::check_input;
use anyhow::{Context, Result, anyhow};
use belvedere::apps::ask::{self, SunPlace};
use belvedere::apps::sun::{Date, Site, Zone};
use belvedere::io::{Source, atomic, has_point_results, is_ball_file, is_mesh};
use belvedere::model::SceneModel;
use belvedere::results::file_name;
use belvedere::{Bounds, Error, Frame, PointCloud};
use belvedere_tiles::{Plan, merged_within};
use belvedere_viewer::{
    ExportParams, Loading, PageServer, PointsOf, ReadingChoice, SceneText, UpAxisChoice, ViewerParams, are_results,
    export, quoted,
};
use serde_json::Value;
use std::borrow::Cow;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Memory that making balls takes beside the cloud, bytes for each of its points: 600 were measured with 10 million
/// points of AHN3.
const BYTES_PER_POINT: u64 = 650;
/// Maximum time for a page to open and to read why nothing is shown.
const PATIENCE: Duration = Duration::from_secs(3);
/// Interval of checks for Ctrl-C.
const POLL: Duration = Duration::from_millis(20);

pub(crate) fn run(arguments: &ViewPage, global: &Global) -> Result<Summary> {
    let files = &arguments.scene.input.clouds;
    files.iter().try_for_each(|path| check_input(path))?;
    let files = Files::of(files)?;
    refuse_flags_of_files(arguments)?;
    MapPosition::refuse_twice("--observer", &arguments.observer)?;
    if let Some(output) = &arguments.export {
        return write_page(output, arguments, &files, global);
    }
    let scene = SceneText { input: files.typed(Folders::Shown), cloud_beside: files.cloud_beside(Folders::Shown) };
    let title = title(&arguments.scene.input.clouds);
    let params = ViewerParams { port: arguments.port.unwrap_or(0), scene, title };
    let viewer = PageServer::start(&params).context("--port: the program cannot listen there")?;
    print_url(&viewer.url(), global)?;
    if !arguments.no_browser
        && let Err(error) = viewer.open_browser()
    {
        note(&format!("the browser cannot be opened ({error}): open the address above"));
    }
    let loading = viewer.loading();
    // what is typed is not offered, and a file of balls is in metres with z up
    let is_open = |input: &CloudInput| input.crs.is_none() && input.up == UpChoice::Z && input.bounds.is_none();
    if files.balls.is_none() && files.runs.is_empty() && is_open(&arguments.scene.input) {
        loading.offer_reading(ReadingChoice::default());
    }
    let mut run = CommandContext::watched(global, loading.clone());
    show(&arguments.scene, &files, &loading, &mut run, global)?;
    note("ready; Ctrl-C ends it");
    let mut before = ReadingChoice::default();
    while !interrupt::is_requested() {
        std::thread::sleep(POLL);
        if let Some(choice) = loading.take_requested_reading() {
            let mut scene = arguments.scene.clone();
            scene.input.up = if choice.up == UpAxisChoice::Y { UpChoice::Y } else { UpChoice::Z };
            scene.input.crs = choice.crs().or(scene.input.crs);
            match show(&scene, &files, &loading, &mut CommandContext::watched(global, loading.clone()), global) {
                Ok(()) => before = choice,
                Err(error) if choice == before => return Err(error),
                // the page says why, and shows the cloud as before when it is loaded again
                Err(_) => _ = loading.read_again(before.clone()),
            }
        }
    }
    drop(viewer);
    Ok(Summary::default())
}

/// Shows what was typed, and offers to read it in another way where its files may not tell how.
fn show(scene: &SceneInput, files: &Files, loading: &Loading, run: &mut CommandContext, global: &Global) -> Result<()> {
    match load(scene, files, loading, &|_, _| Ok(()), run) {
        Ok((_, model)) => {
            run.summary.print_remarks(global);
            loading.remark(run.summary.remarks_so_far());
            loading.finish(model);
            Ok(())
        }
        Err(error) if error.is::<TooManyPoints>() => {
            run.summary.warn("balls-not-built", format!("only the points are shown: {error}")).print_remarks(global);
            loading.fail(format!("Only the points are shown: {error}."));
            Ok(())
        }
        Err(error) => {
            // the page says it too, if there is one
            loading.fail(format!("{error:#}"));
            let failed = Instant::now();
            while !loading.is_failure_read() && failed.elapsed() < PATIENCE && !interrupt::is_requested() {
                std::thread::sleep(POLL);
            }
            // what was read is on its way
            std::thread::sleep(Duration::from_millis(250));
            Err(error)
        }
    }
}

/// A cloud that is shown, but whose balls do not fit into memory.
#[derive(Debug)]
struct TooManyPoints {
    points: usize,
    free: u64,
}

impl TooManyPoints {
    /// Refuses a cloud where the system says that it has too little memory for its balls.
    fn check(points: usize, available: Option<u64>) -> std::result::Result<(), Self> {
        match available {
            Some(free) if points as u64 * BYTES_PER_POINT > free => Err(Self { points, free }),
            _ => Ok(()),
        }
    }
}

impl std::fmt::Display for TooManyPoints {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let gigabytes = |bytes: u64| bytes.div_ceil(1_000_000_000);
        let needed = gigabytes(self.points as u64 * BYTES_PER_POINT);
        let free = self.free / 1_000_000_000;
        write!(
            f,
            "making the balls of {} points needs about {needed} GB of memory, and {free} GB are free. To ask questions, open a smaller part, such as one tile; for \
             maps of the whole cloud, use `belvedere city`",
            self.points
        )
    }
}

impl std::error::Error for TooManyPoints {}

/// The parser lets these pass beside a flag that --export does not go with.
fn refuse_flags_of_files(arguments: &ViewPage) -> Result<()> {
    let given = [
        ("--date", arguments.date.is_some()),
        ("--zone", arguments.zone.is_some()),
        ("--observer", !arguments.observer.is_empty()),
    ];
    if arguments.export.is_none() { refuse_given(&given, "needs --export") } else { Ok(()) }
}

/// Returns the title of the page: the name of its first file.
fn title(files: &[PathBuf]) -> String {
    files.first().and_then(|path| path.file_name()).unwrap_or_default().to_string_lossy().into_owned()
}

/// Writes the page as one file.
fn write_page(output: &Path, arguments: &ViewPage, files: &Files, global: &Global) -> Result<Summary> {
    check_output("--export", output, &["html"])?;
    let date = arguments.date.as_deref().map(Date::parse).transpose()?;
    let place = SunPlace { zone: arguments.zone.clone(), ..SunPlace::default() };
    place.check()?;
    let loading = Loading::default();
    let mut run = CommandContext::new(global);
    let day = |frame: &Frame, bounds: &Bounds| -> Result<Option<(Date, Zone)>> {
        Ok(match date {
            None => None,
            Some(date) => {
                let site = Site::of_scene(frame, bounds, None, None).map_err(|error| match error {
                    Error::MissingAttribute { .. } => {
                        anyhow!(
                            "--date needs the location of the scene: give its reference system with --crs EPSG:CODE"
                        )
                    }
                    other => other.into(),
                })?;
                Some((date, place.zone_at(&site.0, [])?))
            }
        })
    };
    let check = |frame: &Frame, bounds: &Bounds| day(frame, bounds).map(|_| ());
    let (cloud, model) = load(&arguments.scene, files, &loading, &check, &mut run)?;
    let Some(cloud) = cloud else {
        return refuse("--export needs a cloud; a ball file has no points");
    };
    let day = day(model.frame(), &model.bounds())?;
    let params = ExportParams {
        title: title(&arguments.scene.input.clouds),
        scene: SceneText { input: files.typed(Folders::Hidden), cloud_beside: files.cloud_beside(Folders::Hidden) },
        day,
        remarks: without_folders(run.summary.remarks_so_far(), &arguments.scene.input.clouds),
        viewpoints: arguments.observer.iter().map(|&MapPosition([x, y], z)| [x, y, z.unwrap_or(f64::NAN)]).collect(),
    };
    let (page, report) = run.stage("making the page", 0, |control| export(&cloud, model, &params, control))?;
    run.stage("writing", 0, |_| {
        atomic::write(output, |file| file.write_all(page.as_bytes()).map_err(Error::io(output)))
    })?;
    run.summary
        .add_report(&report)
        .add("written", output.display().to_string())
        .headline("a page with <points> points, <suns> suns and <viewpoints> viewpoints");
    Ok(run.finish())
}

/// Returns remarks in which files have no folders: a page that is sent says nothing of the disk of its sender.
fn without_folders(remarks: &[Value], files: &[PathBuf]) -> Vec<Value> {
    let folders = files.iter().filter_map(|path| path.parent()).filter(|folder| !folder.as_os_str().is_empty());
    let folders: Vec<String> = folders.map(|folder| folder.join("").display().to_string()).collect();
    let mut remarks = remarks.to_vec();
    for text in remarks.iter_mut().filter_map(|remark| remark.get_mut("text")) {
        if let Value::String(text) = text {
            *text = folders.iter().fold(std::mem::take(text), |text, folder| text.replace(folder, ""));
        }
    }
    remarks
}

/// Folders of files on command lines.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Folders {
    /// As they were typed.
    Shown,
    /// Left out: a page that is sent to others says nothing of the disk of the sender.
    Hidden,
}

impl Folders {
    /// A typed word.
    fn shown(self, word: &str) -> String {
        let (key, value) = word.split_once('=').map_or(("", word), |(key, value)| (&word[..=key.len()], value));
        match self == Self::Hidden && Path::new(value).exists() {
            true => quoted(&format!("{key}{}", file_name(value))),
            false => quoted(word),
        }
    }
}

/// The files that were typed, by what they hold.
struct Files {
    balls: Option<PathBuf>,
    clouds: Vec<PathBuf>,
    meshes: Vec<PathBuf>,
    /// Results of other commands.
    results: Vec<PathBuf>,
    /// Folders of `belvedere city`.
    runs: Vec<PathBuf>,
}

impl Files {
    fn of(files: &[PathBuf]) -> Result<Self> {
        let (mut balls, mut clouds, mut meshes, mut results) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut runs = Vec::new();
        for path in files {
            if Plan::path(path).is_file() {
                &mut runs
            } else if is_file(path) && is_mesh(path.as_path()) {
                &mut meshes
            } else if is_file(path) && is_ball_file(path)? {
                &mut balls
            } else if is_file(path) && !(clouds.is_empty() && is_las(path)) && are_results(|| Source::path(path)) {
                &mut results
            } else {
                &mut clouds
            }
            .push(path.clone());
        }
        if let (Some(run), true) = (runs.first(), clouds.is_empty() && balls.is_empty()) {
            clouds = Plan::read(run)?.inputs.into_iter().map(|file| file.path).collect();
        }
        let refused = |what: &str| refuse(what);
        match (balls.len(), clouds.len()) {
            (2.., _) => refused("only one ball file can be shown at a time"),
            (1, 2..) => refused("a ball file can be shown with one cloud: give a single file or a folder"),
            (0, 0) => refused("meshes, rasters and shapes are shown with a cloud or a ball file: give one too"),
            _ => Ok(Self { balls: balls.pop(), clouds, meshes, results, runs }),
        }
    }

    /// The scene as other commands take it: its files, and the flags that were typed unless a ball file holds what they
    /// say.
    fn typed(&self, folders: Folders) -> String {
        if let Some(balls) = &self.balls {
            return folders.shown(&balls.to_string_lossy());
        }
        let beside = self.meshes.iter().chain(&self.results).chain(&self.runs);
        let rest = typed(&beside.map(|path| path.to_string_lossy().into_owned()).collect::<Vec<_>>(), folders);
        let is_typed = |path: &PathBuf| words().iter().any(|word| word == path.as_os_str());
        let of_runs =
            self.clouds.iter().filter(|path| !is_typed(path)).map(|path| folders.shown(&path.to_string_lossy()));
        of_runs.chain(Some(rest).filter(|rest| !rest.is_empty())).collect::<Vec<_>>().join(" ")
    }

    /// The cloud that shows the ground of a ball file.
    fn cloud_beside(&self, folders: Folders) -> Option<String> {
        let cloud = self.clouds.first().filter(|_| self.balls.is_some())?;
        Some(folders.shown(&cloud.to_string_lossy()))
    }
}

/// Refuses a cloud, by its frame and bounds, before balls are built.
type Check<'a> = dyn Fn(&Frame, &Bounds) -> Result<()> + 'a;

/// Reads what was typed and builds its balls; shows the cloud as soon as it is there.
fn load(
    arguments: &SceneInput,
    files: &Files,
    loading: &Loading,
    check: &Check<'_>,
    run: &mut CommandContext,
) -> Result<(Option<Arc<PointCloud>>, SceneModel)> {
    if !arguments.plan.clear.is_empty() {
        return refuse("--clear: the page shows the cloud as it is; use the commands for maps");
    }
    let mut input = arguments.clone();
    input.input.clouds.clone_from(&files.clouds);
    let Some(balls) = &files.balls else {
        let parameters = arguments.balls.parameters()?;
        let params = parameters.balls(MethodChoice::Carved)?;
        let cloud = Arc::new(pipeline::read(&input.input, run)?);
        loading.show(&cloud);
        let bounds = cloud.bounds().unwrap_or_default();
        check(&cloud.frame, &bounds)?;
        show_meshes(files, &arguments.plan.add, (&cloud.frame, &bounds), loading, run)?;
        show_results(files, &cloud.frame, &bounds, loading, run)?;
        TooManyPoints::check(cloud.len(), available_bytes())?;
        let crs = &cloud.frame.crs;
        let params = params::model(&parameters, params, crs, run)?;
        let model = pipeline::model_of(Cow::Borrowed(&*cloud), &params, &input.input, run)?;
        return Ok((Some(cloud), pipeline::planned(model, &arguments.plan, run)?));
    };
    input.input.clouds = vec![balls.clone()];
    let scene = pipeline::scene(&input, KeepPoints::Keep, run)?;
    let bounds = scene.model.bounds();
    show_meshes(files, &arguments.plan.add, (scene.model.frame(), &bounds), loading, run)?;
    show_results(files, scene.model.frame(), &bounds, loading, run)?;
    let mut shown = None;
    if !files.clouds.is_empty() {
        input.input.clouds.clone_from(&files.clouds);
        let cloud = pipeline::read(&input.input, run)?;
        let frame = scene.model.frame();
        cloud.frame.crs.check_for(&frame.crs, "cloud", &files.clouds[0])?;
        let cloud = Arc::new(cloud.moved_to(frame));
        loading.show(&cloud);
        shown = Some(cloud);
    }
    Ok((shown, scene.model))
}

fn show_meshes(
    files: &Files,
    planned: &[PathBuf],
    (frame, bounds): (&Frame, &Bounds),
    loading: &Loading,
    run: &mut CommandContext,
) -> Result<()> {
    for path in files.meshes.iter().chain(planned) {
        let mesh = pipeline::mesh_in(path, &frame.crs, run)?;
        // one that is planned is refused with the scene
        if !planned.contains(path) {
            run.summary.remarks(ask::remark_on_mesh(&mesh, &path.display().to_string(), frame, bounds));
        }
        loading.show_mesh(&mesh, frame);
    }
    Ok(())
}

fn show_results(
    files: &Files,
    frame: &Frame,
    bounds: &Bounds,
    loading: &Loading,
    run: &mut CommandContext,
) -> Result<()> {
    for path in &files.results {
        run.stage("reading results", 0, |_| loading.show_results(path, PointsOf::Other, frame, bounds))?;
    }
    let on_map = |corner: [f32; 3]| [0, 1].map(|i| f64::from(corner[i]) + frame.origin[i]);
    for folder in &files.runs {
        let plan = Plan::read(folder)?;
        for question in &plan.questions {
            let area = (on_map(bounds.low), on_map(bounds.high));
            let raster =
                run.stage("reading results", 0, |control| merged_within(&plan, folder, question, area, control));
            loading.show_raster(&folder.join(&question.name), raster?, frame, bounds)?;
        }
    }
    // the columns of the cloud itself come last
    let own =
        files.clouds.first().filter(|path| is_file(path) && is_las(path) && has_point_results(*path).unwrap_or(false));
    if let Some(path) = own {
        run.stage("reading results", 0, |_| loading.show_results(path, PointsOf::Cloud, frame, bounds))?;
    }
    Ok(())
}

fn is_las(path: &Path) -> bool {
    ["las", "laz"].contains(&Source::path(path).extension().as_str())
}

/// The files and flags of the scene as they were typed, for a shell, without the files named.
fn typed(without: &[String], folders: Folders) -> String {
    let words = words().into_iter().skip(1).map(|word| word.to_string_lossy().into_owned());
    let mut kept = Vec::new();
    let mut skips = false;
    for word in words {
        let is_of_page = ["view", "--no-browser", "--quiet", "--verbose", "-v", "--json"].contains(&word.as_str());
        let has_value =
            ["--port", "--export", "--date", "--zone", "--observer", "--threads", "--device", "--seed", "--progress"];
        if std::mem::take(&mut skips) || is_of_page {
            continue;
        }
        if has_value.contains(&word.as_str()) {
            skips = true;
        } else if !without.contains(&word) && !has_value.iter().any(|flag| word.starts_with(&format!("{flag}="))) {
            kept.push(folders.shown(&word));
        }
    }
    kept.join(" ")
}

fn print_url(url: &str, global: &Global) -> Result<()> {
    let line = if global.json { serde_json::json!({ "url": url }).to_string() } else { url.to_owned() };
    let mut output = std::io::stdout().lock();
    writeln!(output, "{line}").and_then(|()| output.flush()).context("standard output")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloud_without_memory_for_its_balls_is_refused_with_advice() {
        let refusal = TooManyPoints::check(50_000_000, Some(21_900_000_000)).unwrap_err().to_string();
        assert!(
            refusal.contains("33 GB of memory, and 21 GB are free. To ask questions, open a smaller part"),
            "{refusal}"
        );
        assert!(TooManyPoints::check(30_000_000, Some(21_900_000_000)).is_ok());
        // where the system does not tell, nothing is refused
        assert!(TooManyPoints::check(usize::MAX, None).is_ok());
    }
}
