//! Questions as JSON: in files, and in the metadata of the rasters that answer them.

use crate::apps::ask::{GivenCells, GivenPlaces, PlacedQuestion, Places, Question};
use crate::{Error, Result};
use serde_json::{Map, Value};
use std::path::Path;

/// Maximum length of a question in the metadata of a raster, bytes. Longer ones hold shapes or weather.
const MAX_QUESTION: usize = 8192;

/// Names of the tags of a question and of its places.
const QUESTION_TAG: &str = "QUESTION";
const PLACES_TAG: &str = "PLACES";

/// Returns the metadata of rasters that answer a question. `QUESTION` is itself as JSON, without fields that were not
/// given and without the folders of files; left out if long. `PLACES` are its cells, if they are those of a whole
/// scene. `TIME_ZONE` is the zone of its clock.
#[must_use]
pub fn question_tags(question: &Question, places: &Places, time_zone: Option<&str>) -> Vec<(String, String)> {
    let in_json = |value: serde_json::Result<Value>| value.map(shortened).unwrap_or_default().to_string();
    let text = Some(in_json(serde_json::to_value(question))).filter(|text| text.len() <= MAX_QUESTION);
    let cells = match places {
        Places::Cells(cells) => GivenCells::of_grid(cells).map(GivenPlaces::Cells),
        _ => None,
    };
    let places = cells.map(|cells| in_json(serde_json::to_value(cells)));
    let tags = [(QUESTION_TAG, text), (PLACES_TAG, places), ("TIME_ZONE", time_zone.map(str::to_owned))];
    tags.into_iter().filter_map(|(name, text)| Some((name.to_owned(), text?))).collect()
}

/// This without the fields that were not given, and without the folders of files.
fn shortened(value: Value) -> Value {
    match value {
        Value::Object(fields) => {
            let given = fields.into_iter().filter(|(_, value)| !value.is_null());
            let short = |(name, value): (String, Value)| match value {
                Value::String(path) if name == "file" => (name, Value::String(file_name(&path))),
                other => (name, shortened(other)),
            };
            Value::Object(given.map(short).collect())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(shortened).collect()),
        other => other,
    }
}

/// Returns the name of a file, without its folder, and without the parameters of an address of the web, which may be
/// private.
#[must_use]
pub fn file_name(path: &str) -> String {
    let file = path.split('?').next().unwrap_or_default();
    Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads a question with its places from JSON: `{"question": …, "places": …}`, or the question alone, which is about
/// cells then. `file` is where it comes from, for errors.
///
/// # Errors
/// [`Error::Malformed`] for what is no question, and for fields that a question does not have.
pub fn read_question(text: &str, file: &Path) -> Result<PlacedQuestion> {
    let wrong = |error: serde_json::Error| Error::malformed(file, format!("not a question: {error}"));
    let given: Value = serde_json::from_str(text).map_err(wrong)?;
    let placed = match given.get("question") {
        // from the text, so that errors say the line
        Some(_) => serde_json::from_str(text).map_err(wrong)?,
        None => PlacedQuestion { question: serde_json::from_str(text).map_err(wrong)?, places: GivenPlaces::default() },
    };
    let known = match given.get("question") {
        Some(_) => serde_json::to_value(&placed),
        None => serde_json::to_value(&placed.question),
    };
    match unknown_field(&given, &known.unwrap_or_default()) {
        Some(what) => Err(Error::malformed(file, what)),
        None => Ok(placed),
    }
}

/// Reads the question that a raster answers, and its places, from the metadata of the raster.
///
/// # Errors
/// [`Error::Malformed`] for other files, and for rasters without a question. The question may lack what JSON does not
/// hold.
#[cfg(feature = "tiff")]
pub fn question_of_raster(path: &Path) -> Result<PlacedQuestion> {
    let [question, places] = crate::io::read_tif_tags(path, [QUESTION_TAG, PLACES_TAG])?;
    let Some(question) = question else {
        let what = "no question in its metadata (tag QUESTION): give a raster of Belvedere, or a question in JSON";
        return Err(Error::malformed(path, what));
    };
    let placed = read_question(&question, path)?;
    match places {
        Some(places) => {
            let places = serde_json::from_str(&places);
            let wrong = |error| Error::malformed(path, format!("tag {PLACES_TAG}: {error}"));
            Ok(PlacedQuestion { places: places.map_err(wrong)?, ..placed })
        }
        None => Ok(placed),
    }
}

/// Returns the first field of `given` that `known`, which was read from it, does not have, in words.
fn unknown_field(given: &Value, known: &Value) -> Option<String> {
    match (given, known) {
        (Value::Object(given), Value::Object(known)) => {
            let inner = |(name, value): (&String, &Value)| match known.get(name) {
                Some(known) => unknown_field(value, known).map(|what| match what.starts_with("no field") {
                    true => format!("{name}: {what}"),
                    false => format!("{name}.{what}"),
                }),
                None => Some(no_field(name, known)),
            };
            given.iter().find_map(inner)
        }
        (Value::Array(given), Value::Array(known)) => {
            given.iter().zip(known).find_map(|(given, known)| unknown_field(given, known))
        }
        _ => None,
    }
}

/// Refuses a field, with those that are known in its place.
fn no_field(name: &str, known: &Map<String, Value>) -> String {
    let known = known.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
    format!("no field \"{name}\"; there are {known}")
}
