//! The folder of kept scenes.

use super::key::{CloudKey, of_files};
use super::mark::{is_marked, is_plain_file, is_plain_folder, make_marked, make_private};
use super::survey::{PLAN, SurveyFolder};
use super::{BuiltScene, SceneOrigin};
use crate::apps::ask::Remark;
use crate::apps::ask::scene::{GroundStore, KnownGround};
use crate::control::Control;
use crate::ground::{Ground, GroundBySquares, GroundParams, GroundReport, MapGrid};
use crate::io::{
    ReadOptions, read_balls, read_kept_cloud, read_kept_ground, read_kept_model, read_kept_notes, read_kept_rasters,
    write_balls, write_kept_cloud, write_kept_ground, write_kept_model, write_kept_rasters,
};
use crate::model::{DerivedParts, ModelParams, ModelParts, SceneModel};
use crate::raster::Raster;
use crate::{Error, Frame, PointCloud, Result};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

/// Bytes that a cache may take, unless it is given another bound.
const MAX_BYTES: u64 = 10_000_000_000;
/// Endings of the names of entries: scenes, their points and ground, and reports of reading files.
const SCENE: &str = "scene.npz";
const POINTS: &str = "points.npz";
const GROUND: &str = "ground.npz";
const READING: &str = "reading.npz";
/// The folder of surveys in tiles, each a folder of its own.
const TILES: &str = "tiles";
/// Hexadecimal digits of the name of an entry.
const KEY_DIGITS: usize = 32;
/// Names of the notes of an entry for what reading gave.
const CLOUD: &str = "cloud";
const NOTES: &str = "notes";

/// Scenes in a folder.
#[derive(Clone, Debug)]
pub struct SceneCache {
    folder: PathBuf,
    max_bytes: u64,
}

/// Information on files that were read before.
#[derive(Debug)]
pub struct ReadBefore {
    /// Frame of local coordinates.
    pub frame: Frame,
    /// The contents of the cloud.
    pub cloud: CloudKey,
    /// Report of reading, as given to [`SceneCache::keep_reading`].
    pub notes: Map<String, Value>,
    /// Name of its entries.
    key: String,
}

impl ReadBefore {
    /// The result of reading files: contents and frame of a cloud, and a report.
    #[must_use]
    pub fn new(cloud: CloudKey, frame: Frame, notes: Map<String, Value>) -> Self {
        Self { frame, cloud, notes, key: String::new() }
    }
}

/// A scene of a cache.
#[derive(Clone, Debug, PartialEq)]
pub struct CacheEntry {
    /// Name of its subject, such as that of a file.
    pub name: String,
    /// Its size, bytes.
    pub bytes: u64,
    /// Time of the last use.
    pub used: SystemTime,
}

impl SceneCache {
    /// The cache in `folder`, which is made when something is kept. It takes at most 10 GB.
    #[must_use]
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), max_bytes: MAX_BYTES }
    }

    /// The same, which takes at most `max_bytes`.
    #[must_use]
    pub fn with_max_bytes(self, max_bytes: u64) -> Self {
        Self { max_bytes, ..self }
    }

    /// Returns the default folder of a user's cache on the system; `variable` reads the environment. It is in
    /// `XDG_CACHE_HOME`, `LOCALAPPDATA` on Windows, `~/Library/Caches` on a Mac, else `~/.cache`. `None` without a
    /// home.
    #[must_use]
    pub fn usual_folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
        let path = |name: &str| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let home = || path("HOME");
        let caches = path("XDG_CACHE_HOME").or_else(|| {
            if cfg!(windows) {
                path("LOCALAPPDATA")
            } else if cfg!(target_os = "macos") {
                home().map(|home| home.join("Library/Caches"))
            } else {
                home().map(|home| home.join(".cache"))
            }
        });
        caches.map(|caches| caches.join("belvedere"))
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The scene of a cloud, if it was kept. One that is damaged is removed.
    #[must_use]
    pub fn find(
        &self,
        cloud: &CloudKey,
        params: &ModelParams,
        needs_normals: bool,
        control: &Control<'_>,
    ) -> Option<BuiltScene> {
        // who needs no normals can use a scene with them
        let mut names = [true, false].into_iter().filter(|&has_normals| has_normals || !needs_normals);
        let path = names.find_map(|has_normals| self.entry(&cloud.of_scene(params, has_normals), SCENE))?;
        match control.stage("reading kept scene", 0, || scene_in(&path)) {
            Ok((model, report)) => {
                mark_as_used(&path);
                Some(BuiltScene { model, report, origin: SceneOrigin::Found, cloud: Some(cloud.clone()) })
            }
            Err(_) => {
                let _ = fs::remove_file(&path);
                None
            }
        }
    }

    /// Keeps the scene of a cloud, and makes room for it. `name` says in the list what it is of.
    ///
    /// # Errors
    /// [`Error::Io`] where it cannot be written; nothing is then left of it.
    pub fn keep(
        &self,
        cloud: &CloudKey,
        params: &ModelParams,
        model: &SceneModel,
        report: &Map<String, Value>,
        name: &str,
    ) -> Result<()> {
        let derived = model.derived();
        let path = self.place(&cloud.of_scene(params, derived.normals.is_some()), SCENE)?;
        let notes = json!({ "name": name, "report": report }).to_string();
        write_kept_model(&path, model.parts(), &derived, &notes)?;
        self.make_room(&path);
        Ok(())
    }

    /// Returns the earlier result of reading these files. `None` if it is not known, they changed, or lie on a server.
    #[must_use]
    pub fn read_before(&self, paths: &[PathBuf], options: &ReadOptions) -> Option<ReadBefore> {
        let key = of_files(paths, options)?;
        let path = self.entry(&key, READING)?;
        let mut parts = read_balls(&path).ok()?;
        let notes = serde_json::from_str(&parts.provenance.remove(NOTES)?).ok()?;
        mark_as_used(&path);
        Some(ReadBefore { frame: parts.frame, cloud: CloudKey(parts.provenance.remove(CLOUD)?), notes, key })
    }

    /// Keeps what reading these files gave, with the points if they are given. Points of scans
    /// that know open sky are not kept.
    ///
    /// # Errors
    /// [`Error::Io`] where it cannot be written.
    pub fn keep_reading(
        &self,
        paths: &[PathBuf],
        options: &ReadOptions,
        found: &ReadBefore,
        points: Option<&PointCloud>,
    ) -> Result<()> {
        let Some(name) = of_files(paths, options) else { return Ok(()) };
        if self.entry(&name, READING).is_none() {
            let path = self.place(&name, READING)?;
            let parts = ModelParts { frame: found.frame.clone(), ..ModelParts::default() };
            let notes = Value::Object(found.notes.clone()).to_string();
            write_balls(path, &parts.with_provenance(CLOUD, &found.cloud.0).with_provenance(NOTES, notes))?;
        }
        let points = points.filter(|points| points.sky_regions.is_empty());
        if let Some(points) = points.filter(|_| self.entry(&name, POINTS).is_none()) {
            let path = self.place(&name, POINTS)?;
            write_kept_cloud(&path, points)?;
            self.make_room(&path);
        }
        Ok(())
    }

    /// Returns the points that reading files gave before, if they were kept. A file of them that is damaged is removed.
    #[must_use]
    pub fn points(&self, before: &ReadBefore) -> Option<PointCloud> {
        let path = self.entry(&before.key, POINTS)?;
        mark_as_used(&path);
        match read_kept_cloud(&path, before.frame.clone()) {
            Ok(cloud) => Some(cloud),
            Err(_) => {
                let _ = fs::remove_file(&path);
                None
            }
        }
    }

    /// The folder in which tiles of a survey of these files are kept, with all that belongs to them; its `plan.json`
    /// names the files. `None` where these lie on a server or cannot be read, and where it cannot be made or is not
    /// the program's. It counts as used now.
    #[must_use]
    pub fn survey_folder(&self, paths: &[PathBuf], options: &ReadOptions) -> Option<SurveyFolder> {
        let key = of_files(paths, options)?;
        make_marked(&self.folder).ok()?;
        let tiles = self.folder.join(TILES);
        make_private(&tiles).ok().filter(|()| is_plain_folder(&tiles))?;
        let folder = SurveyFolder::make(tiles.join(key)).ok()?;
        mark_as_used(&folder.path().join(PLAN));
        Some(folder)
    }

    /// Makes room for what was kept in the folder of a survey.
    pub fn make_room_beside(&self, survey: &SurveyFolder) {
        self.make_room(survey.path());
    }

    /// A store for the ground of a cloud.
    #[must_use]
    pub fn ground_of(&self, cloud: &CloudKey) -> Arc<dyn GroundStore> {
        Arc::new(GroundOfCloud { cache: self.clone(), cloud: cloud.clone() })
    }

    /// The scenes, the one used last first.
    ///
    /// # Errors
    /// [`Error::Io`] for a folder that cannot be read; one that is not there is empty.
    pub fn entries(&self) -> Result<Vec<CacheEntry>> {
        let scenes = self.files()?.into_iter().filter(|file| file.survey.is_some() || is_named(&file.path, SCENE));
        let mut entries: Vec<CacheEntry> = scenes
            .map(|file| {
                let is_survey = file.survey.is_some();
                let name = if is_survey { name_of_survey(&file.path) } else { name_of_scene(&file.path) };
                CacheEntry { name: name.unwrap_or_else(|| "damaged".to_owned()), bytes: file.bytes, used: file.used }
            })
            .collect();
        entries.sort_by(|a, b| (b.used, &a.name).cmp(&(a.used, &b.name)));
        Ok(entries)
    }

    /// Bytes of all that is kept: scenes, their points and ground, and what reading gave.
    ///
    /// # Errors
    /// Those of [`SceneCache::entries`].
    pub fn bytes(&self) -> Result<u64> {
        Ok(self.files()?.iter().map(|file| file.bytes).sum())
    }

    /// Removes all that is kept; returns how many bytes that was. Other files of the folder stay, and all of a folder
    /// that the program did not make.
    ///
    /// # Errors
    /// [`Error::Io`] for what cannot be removed.
    pub fn clear(&self) -> Result<u64> {
        let mut bytes = 0;
        for file in self.files()? {
            match file.remove() {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(Error::io(&file.path)(error)),
                _ => bytes += file.bytes,
            }
        }
        Ok(bytes)
    }

    /// A warning where the folder holds files, but the program did not make it: nothing is kept or removed there.
    #[must_use]
    pub fn remark(&self) -> Option<Remark> {
        let holds_files = || self.folder.read_dir().is_ok_and(|mut rows| rows.next().is_some());
        (!is_marked(&self.folder) && holds_files()).then(|| {
            let text =
                "the folder has no mark of this program: nothing is kept there, and none of its files is removed";
            Remark::warning("cache-of-others", text)
        })
    }

    fn path(&self, key: &str, kind: &str) -> PathBuf {
        self.folder.join(format!("{key}.{kind}"))
    }

    /// An entry that is there.
    fn entry(&self, key: &str, kind: &str) -> Option<PathBuf> {
        Some(self.path(key, kind)).filter(|path| is_plain_file(path) && is_marked(&self.folder))
    }

    /// Returns the path of a new entry, and creates the folder.
    fn place(&self, key: &str, kind: &str) -> Result<PathBuf> {
        make_marked(&self.folder)?;
        let path = self.path(key, kind);
        // writing would go through a link, and wait for the reader of a pipe
        if path.symlink_metadata().is_ok_and(|found| !found.is_file()) {
            return Err(Error::malformed(&path, "is not a file; remove it, or have scenes kept in another folder"));
        }
        Ok(path)
    }

    /// The entries of all kinds.
    fn files(&self) -> Result<Vec<KeptFile>> {
        let rows = match self.folder.read_dir() {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            rows => rows.map_err(Error::io(&self.folder))?,
        };
        if !is_marked(&self.folder) {
            return Ok(Vec::new());
        }
        let files = rows.filter_map(|row| {
            let path = row.ok()?.path();
            let is_own =
                [SCENE, POINTS, GROUND, READING].iter().any(|kind| is_named(&path, kind)) && is_plain_file(&path);
            // another program may have removed it meanwhile
            let metadata = path.symlink_metadata().ok().filter(|_| is_own)?;
            Some(KeptFile { bytes: metadata.len(), used: metadata.modified().ok()?, survey: None, path })
        });
        let tiles = self.folder.join(TILES);
        let surveys = is_plain_folder(&tiles).then(|| tiles.read_dir()).into_iter().flatten().flatten();
        let surveys = surveys.filter_map(|row| {
            let row = row.ok()?;
            let survey = SurveyFolder::find(row.path()).filter(|_| row.file_name().to_str().is_some_and(is_key))?;
            let used = row.path().join(PLAN).symlink_metadata().ok()?.modified().ok()?;
            Some(KeptFile { bytes: survey.bytes(), used, path: row.path(), survey: Some(survey) })
        });
        Ok(files.chain(surveys).collect())
    }

    /// Removes what was not used for longest, until the rest is small enough; never `newest`.
    fn make_room(&self, newest: &Path) {
        let Ok(mut files) = self.files() else { return };
        let mut bytes: u64 = files.iter().map(|file| file.bytes).sum();
        files.sort_by_key(|file| file.used);
        for file in files.iter().filter(|file| file.path != newest) {
            if bytes <= self.max_bytes {
                break;
            }
            if file.remove().is_ok() {
                bytes -= file.bytes;
            }
        }
    }
}

/// The ground of a cloud in a cache.
struct GroundOfCloud {
    cache: SceneCache,
    cloud: CloudKey,
}

/// Notes on kept ground.
#[derive(Serialize, Deserialize)]
struct GroundNotes {
    corner: [f64; 2],
    cell: f64,
    report: GroundReport,
}

impl GroundStore for GroundOfCloud {
    fn find(&self, grid: &MapGrid, params: &GroundParams) -> Option<KnownGround> {
        let path = self.cache.entry(&self.cloud.of_ground(grid, params), GROUND)?;
        let (rasters, notes) = read_kept_rasters(&path).ok()?;
        let GroundNotes { corner, cell, report } = serde_json::from_str(&notes).ok()?;
        let [heights, gaps]: [Raster<f32>; 2] = rasters.try_into().ok()?;
        let kept = MapGrid { corner, cell, width: heights.width(), height: heights.height() };
        let is_sound = kept == *grid && (gaps.width(), gaps.height()) == (grid.width, grid.height);
        mark_as_used(&path);
        is_sound.then_some(KnownGround { ground: Ground { grid: kept, heights, gaps }, report })
    }

    fn find_index(&self, params: &GroundParams) -> Option<GroundBySquares> {
        let path = self.cache.entry(&self.cloud.of_ground_index(params), GROUND)?;
        let (parts, notes) = read_kept_ground(&path).ok()?;
        mark_as_used(&path);
        GroundBySquares::from_parts(params, serde_json::from_str(&notes).ok()?, parts).ok()
    }

    fn keep_index(&self, index: &GroundBySquares) {
        let (report, parts) = index.to_parts();
        let Ok(path) = self.cache.place(&self.cloud.of_ground_index(index.params()), GROUND) else { return };
        let write = |notes: String| write_kept_ground(&path, &parts, &notes);
        if serde_json::to_string(&report).is_ok_and(|notes| write(notes).is_ok()) {
            self.cache.make_room(&path);
        }
    }

    fn keep(&self, params: &GroundParams, known: &KnownGround) {
        let KnownGround { ground: Ground { grid, heights, gaps }, report } = known;
        let notes = GroundNotes { corner: grid.corner, cell: grid.cell, report: *report };
        let Ok(path) = self.cache.place(&self.cloud.of_ground(grid, params), GROUND) else { return };
        let write = |notes: String| write_kept_rasters(&path, &[heights, gaps], &notes);
        if serde_json::to_string(&notes).is_ok_and(|notes| write(notes).is_ok()) {
            self.cache.make_room(&path);
        }
    }
}

/// A file of the cache, or the folder of a survey.
struct KeptFile {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
    survey: Option<SurveyFolder>,
}

impl KeptFile {
    fn remove(&self) -> std::io::Result<()> {
        match &self.survey {
            Some(survey) => {
                survey.remove();
                Ok(())
            }
            None => fs::remove_file(&self.path),
        }
    }
}

fn name_of_scene(path: &Path) -> Option<String> {
    let notes: Value = serde_json::from_str(&read_kept_notes(path).ok()?).ok()?;
    Some(notes["name"].as_str()?.to_owned())
}

fn name_of_survey(folder: &Path) -> Option<String> {
    let plan = Some(folder.join(PLAN)).filter(|plan| is_plain_file(plan))?;
    let plan: Value = serde_json::from_slice(&fs::read(plan).ok()?).ok()?;
    let names: Vec<&str> = plan["inputs"].as_array()?.iter().filter_map(|file| file["path"].as_str()).collect();
    Some(format!("{}, in tiles", names.join(", ")))
}

/// Returns true if a path has the name of an entry of this kind.
fn is_named(path: &Path, kind: &str) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.and_then(|name| name.strip_suffix(kind)?.strip_suffix('.')).is_some_and(is_key)
}

fn is_key(name: &str) -> bool {
    name.len() == KEY_DIGITS && name.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// The time of a file says when it was used. Where that cannot be set, it counts from when it was made.
fn mark_as_used(path: &Path) {
    if !is_plain_file(path) {
        return;
    }
    let _ = File::options().write(true).open(path).and_then(|file| file.set_modified(SystemTime::now()));
}

fn scene_in(path: &Path) -> Result<(SceneModel, Map<String, Value>)> {
    let (parts, derived, notes): (ModelParts, DerivedParts, String) = read_kept_model(path)?;
    let damaged = |what: String| Error::malformed(path, what);
    let mut notes: Value = serde_json::from_str(&notes).map_err(|error| damaged(error.to_string()))?;
    let Value::Object(report) = notes["report"].take() else { return Err(damaged("it has no report".to_owned())) };
    Ok((SceneModel::from_kept(parts, derived)?, report))
}
