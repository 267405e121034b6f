//! Scenes that were built before, kept in a folder, so that the next question of the same cloud finds them.
//!
//! An entry is named after everything that a scene follows from: the contents of the cloud, the parameters, and the
//! program. What does not fit is not found, so that nothing in the folder can be out of date. Entries appear whole and
//! have checksums; one that is damaged is made again. Several programs may use one folder. What was not used for
//! longest goes where the folder outgrows its bound.

mod folder;
mod key;
mod mark;
mod survey;

pub use folder::{CacheEntry, ReadBefore, SceneCache};
pub use key::CloudKey;
#[cfg(feature = "figures")]
pub(crate) use key::file_hash;
pub use survey::SurveyFolder;

use crate::apps::ask::Remark;
use crate::control::Control;
use crate::io::read_balls;
use crate::model::{ModelParams, SceneModel};
use crate::{Error, PointCloud, Result};
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::path::Path;

/// A model that was built or found.
#[derive(Debug)]
pub struct BuiltScene {
    /// The model.
    pub model: SceneModel,
    /// The report on building it, as JSON: that of [`SceneModel::build`].
    pub report: Map<String, Value>,
    /// Source of the model.
    pub origin: SceneOrigin,
    /// The contents of its cloud, where a cache was given.
    pub cloud: Option<CloudKey>,
}

/// Source of a model.
#[derive(Debug)]
pub enum SceneOrigin {
    /// It was found in the cache.
    Found,
    /// It was built, and is kept for next time.
    Kept,
    /// It was built, and could not be kept.
    NotKept(Error),
    /// It was built without a cache.
    Built,
}

impl SceneOrigin {
    /// In a word: found, kept, not kept, built.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::Kept => "kept",
            Self::NotKept(_) => "not kept",
            Self::Built => "built",
        }
    }

    /// A warning where a scene could not be kept.
    #[must_use]
    pub fn remark(&self) -> Option<Remark> {
        let Self::NotKept(error) = self else { return None };
        let advice = "free some room, or have it kept in another folder or not at all";
        let text = format!("the scene could not be kept for the next question: {error}; {advice}");
        Some(Remark::warning("scene-not-kept", text))
    }
}

/// The model of `cloud`: found in `cache`, or built and kept there. Of an owned cloud the memory is freed on the way,
/// as [`SceneModel::build_owned`] does it, and the model has no normals.
///
/// # Errors
/// Those of [`SceneModel::build`]. A cache that cannot be read or written is none ([`SceneOrigin::NotKept`]).
pub fn scene_model(
    cloud: Cow<'_, PointCloud>,
    params: &ModelParams,
    cache: Option<&SceneCache>,
    control: &Control<'_>,
) -> Result<BuiltScene> {
    let needs_normals = matches!(cloud, Cow::Borrowed(_));
    let key = cache.map(|_| CloudKey::of(&cloud));
    if let (Some(cache), Some(key)) = (cache, &key)
        && let Some(found) = cache.find(key, params, needs_normals, control)
    {
        return Ok(found);
    }
    let name = name_of(&cloud);
    let (mut model, report) = match cloud {
        Cow::Borrowed(cloud) => SceneModel::build(cloud, params, control)?,
        Cow::Owned(cloud) => SceneModel::build_owned(cloud, params, control)?,
    };
    let report = match serde_json::to_value(&report) {
        Ok(Value::Object(entries)) => entries,
        // reports are maps of numbers and texts, which JSON holds
        _ => Map::new(),
    };
    let (Some(cache), Some(key)) = (cache, key) else {
        return Ok(BuiltScene { model, report, origin: SceneOrigin::Built, cloud: None });
    };
    // every question needs the tree, and most of them what the pulses prove
    model.index(control)?;
    model.index_proof(control)?;
    let kept = control.stage("keeping scene", 0, || cache.keep(&key, params, &model, &report, &name));
    let origin = kept.map_or_else(SceneOrigin::NotKept, |()| SceneOrigin::Kept);
    Ok(BuiltScene { model, report, origin, cloud: Some(key) })
}

/// The model of a ball file: found in `cache` with the trees that questions need, or read, indexed and kept there.
///
/// # Errors
/// Those of reading ball files and of [`SceneModel::from_parts`].
pub fn model_of_balls(path: &Path, cache: Option<&SceneCache>, control: &Control<'_>) -> Result<SceneModel> {
    let read = || control.stage("reading balls", 0, || SceneModel::from_parts(read_balls(path)?));
    let Some((cache, key)) = cache.zip(CloudKey::of_file(path)) else { return read() };
    let params = ModelParams::default();
    if let Some(found) = cache.find(&key, &params, false, control) {
        return Ok(found.model);
    }
    let mut model = read()?;
    model.index(control)?;
    model.index_proof(control)?;
    let name = path.display().to_string();
    // balls that cannot be kept are indexed again
    let _ = control.stage("keeping scene", 0, || cache.keep(&key, &params, &model, &Map::new(), &name));
    Ok(model)
}

/// The files of a cloud, as a list of scenes shows them.
fn name_of(cloud: &PointCloud) -> String {
    let names: Vec<String> = cloud.files.files.iter().map(|file| file.path.display().to_string()).collect();
    if names.is_empty() { format!("a cloud of {} points", cloud.len()) } else { names.join(", ") }
}
