//! Ball parameters: flags, and the file of `--scene-config` that completes them.

use crate::arguments::{
    BallShape, BallsArguments, Cleaning, OrientedPoints, Orienting, ProfileChoice, SceneBalls, SceneConfig, Shrinking,
    Usage, refuse,
};
use crate::help::BALL_FLAGS;
use crate::parameter_flags::flags_of;
use anyhow::{Context, Result};
use belvedere::Parameter;
use belvedere::depth::Profile;
use clap::Command;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Ball parameters: typed values, completed by the file.
#[derive(Clone, Default)]
pub(crate) struct BallParameters {
    pub(crate) cleaning: Cleaning,
    pub(crate) orienting: Orienting,
    pub(crate) shrinking: Shrinking,
    profile: Option<ProfileChoice>,
    file: Option<File>,
}

/// The file, and the keys it has.
#[derive(Clone)]
struct File {
    path: PathBuf,
    keys: Vec<String>,
}

/// The only key that has no group of flags.
#[derive(Default, Deserialize)]
#[serde(default)]
struct SceneShape {
    ball_profile: Option<ProfileChoice>,
}

impl BallsArguments {
    /// Returns the ball parameters.
    pub(crate) fn parameters(&self) -> Result<BallParameters> {
        let (cleaning, orienting) = (self.cleaning.clone(), self.orienting.clone());
        let shrinking = self.shrinking.clone();
        BallParameters { cleaning, orienting, shrinking, ..BallParameters::default() }.completed(&self.config)
    }
}

impl OrientedPoints {
    /// Returns the parameters of preparing points.
    pub(crate) fn parameters(&self) -> Result<BallParameters> {
        let (cleaning, orienting) = (self.cleaning.clone(), self.orienting.clone());
        BallParameters { cleaning, orienting, ..BallParameters::default() }.completed(&self.config)
    }
}

impl SceneBalls {
    /// Returns the ball parameters.
    pub(crate) fn parameters(&self) -> Result<BallParameters> {
        let mut typed = BallParameters::default();
        typed.orienting.orient.clone_from(&self.orient);
        typed.shrinking.trees = self.trees;
        typed.completed(&self.config)
    }
}

impl BallShape {
    /// The shape of balls: what was typed, or else what the file of a scene says.
    pub(crate) fn of(&self, scene: &SceneBalls) -> Result<Profile> {
        match self.profile {
            Some(typed) => Ok(typed.into()),
            None => Ok(scene.parameters()?.profile()),
        }
    }
}

impl BallParameters {
    /// The shape of balls.
    pub(crate) fn profile(&self) -> Profile {
        self.profile.unwrap_or(ProfileChoice::Sphere).into()
    }

    /// The same for points of which none may go.
    pub(crate) fn keeping_all(mut self) -> Self {
        self.cleaning = Cleaning::nothing();
        self
    }

    /// Refuses a file with parameters of balls that are made already, in the ball file at `path`.
    pub(crate) fn refuse_file(&self, path: &Path) -> Result<()> {
        let Some(file) = &self.file else { return Ok(()) };
        let Some(key) = file.keys.iter().find(|key| *key != "ball_profile") else { return Ok(()) };
        let (config, path) = (file.path.display(), path.display());
        refuse(format!("--scene-config {config}: {key} is for building balls from a cloud, but {path} is a ball file"))
    }

    /// Names the file and its keys in an error about flags that were not typed.
    pub(crate) fn naming<T>(&self, result: Result<T>) -> Result<T> {
        let Some(file) = &self.file else { return result };
        let key_of = |parameter: Parameter| {
            let keys = flags_of(parameter).iter().map(|flag| flag.trim_start_matches("--").replace('-', "_"));
            keys.into_iter().find(|key| file.keys.contains(key))
        };
        result.map_err(|error| match error.downcast_ref() {
            Some(&belvedere::Error::InvalidParameter { parameter, .. }) if key_of(parameter).is_some() => {
                let key = key_of(parameter).unwrap_or_default();
                Usage(format!("{}: {key}: {error}", file.path.display())).into()
            }
            None => match error.downcast_ref() {
                Some(Usage(text)) => {
                    let key = |word: &str| match word.strip_prefix("--") {
                        Some(flag) => flag.replace('-', "_"),
                        None => word.to_owned(),
                    };
                    let text: Vec<String> = text.split(' ').map(key).collect();
                    Usage(format!("{}: {}", file.path.display(), text.join(" "))).into()
                }
                None => error,
            },
            _ => error,
        })
    }

    /// Completed by a file. What was typed goes first.
    fn completed(self, config: &SceneConfig) -> Result<Self> {
        let Some(path) = &config.scene_config else { return Ok(self) };
        let keys = read(path)?;
        let part = |error: serde_json::Error| Usage(format!("{}: {error}", path.display()));
        let object = Value::Object(keys.clone());
        let cleaning = Cleaning::deserialize(&object).map_err(part)?;
        let orienting = Orienting::deserialize(&object).map_err(part)?;
        let shrinking = Shrinking::deserialize(&object).map_err(part)?;
        let shape = SceneShape::deserialize(&object).map_err(part)?;
        Ok(Self {
            cleaning: self.cleaning.or(&cleaning),
            orienting: self.orienting.or(orienting),
            shrinking: self.shrinking.or(shrinking),
            profile: self.profile.or(shape.ball_profile),
            file: Some(File { path: path.clone(), keys: keys.into_iter().map(|(key, _)| key).collect() }),
        })
    }
}

impl Cleaning {
    fn or(&self, other: &Self) -> Self {
        Self {
            keep_noise: self.keep_noise || other.keep_noise,
            keep_duplicates: self.keep_duplicates || other.keep_duplicates,
            keep_isolated: self.keep_isolated || other.keep_isolated,
            keep_strips: self.keep_strips || other.keep_strips,
        }
    }
}

impl Orienting {
    fn or(self, other: Self) -> Self {
        Self { neighbors: self.neighbors.or(other.neighbors), orient: self.orient.or(other.orient) }
    }
}

impl Shrinking {
    fn or(self, other: Self) -> Self {
        Self {
            method: self.method.or(other.method),
            trees: self.trees.or(other.trees),
            without: if self.without.is_empty() { other.without } else { self.without },
            initial_radius: self.initial_radius.or(other.initial_radius),
            max_radius: self.max_radius.or(other.max_radius),
            penetration: self.penetration.or(other.penetration),
            first_angle: self.first_angle.or(other.first_angle),
            next_angle: self.next_angle.or(other.next_angle),
        }
    }
}

/// The keys of a file and their values, each of the type that it needs. A key without a value is as if it was not
/// there.
fn read(path: &Path) -> Result<Map<String, Value>> {
    let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let refused = |what: String| Usage(format!("{}: {what}", path.display()));
    let keys: Map<String, Value> = match serde_json::from_str(&text) {
        Ok(Value::Object(keys)) => keys.into_iter().filter(|(_, value)| !value.is_null()).collect(),
        Ok(_) => return Err(refused("expected a JSON object".to_owned()).into()),
        Err(error) => return Err(refused(error.to_string()).into()),
    };
    for (key, value) in &keys {
        if !BALL_FLAGS.contains(&key.as_str()) {
            let known = BALL_FLAGS.join(", ");
            return Err(refused(format!("unknown key {key:?}; the keys are {known}")).into());
        }
        check(key, value).map_err(|error| refused(format!("{key}: {error}")))?;
    }
    Ok(keys)
}

/// Checks that a value alone can be used. An error of the whole object would not name its key.
fn check(key: &str, value: &Value) -> serde_json::Result<()> {
    let alone = Value::Object(Map::from_iter([(key.to_owned(), value.clone())]));
    Cleaning::deserialize(&alone)?;
    Orienting::deserialize(&alone)?;
    Shrinking::deserialize(&alone)?;
    SceneShape::deserialize(&alone).map(drop)
}

fn flag(key: &str) -> String {
    format!("--{}", key.replace('_', "-"))
}

/// Says where a flag of balls belongs, if it is the one that a command does not know.
pub(crate) fn advised(mut error: clap::Error, program: &Command, typed: &[OsString]) -> clap::Error {
    let has_file = |command: &Command| command.get_arguments().any(|argument| argument.get_id() == "scene_config");
    let command = typed.iter().filter_map(|word| program.find_subcommand(word)).next();
    let unknown = match (error.kind(), error.get(ContextKind::InvalidArg)) {
        (ErrorKind::UnknownArgument, Some(ContextValue::String(unknown))) => unknown.clone(),
        _ => return error,
    };
    let key = BALL_FLAGS.iter().find(|key| flag(key) == unknown);
    if let (Some(key), Some(command)) = (key, command.filter(|command| has_file(command))) {
        let name = command.get_name();
        let tip = format!(
            "'{name}' takes this from a file, --scene-config FILE with the key \"{key}\", or from the balls of `belvedere balls`"
        );
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}
