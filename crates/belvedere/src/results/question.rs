//! Metadata of rasters: the question that they answer.

use crate::apps::ask::Question;
use serde_json::Value;
use std::path::Path;

/// Maximum length of a question in the metadata of a raster, bytes. Longer ones hold shapes or weather.
const MAX_QUESTION: usize = 8192;

/// Returns the metadata of rasters that answer a question. `QUESTION` is itself as JSON, without fields that were not
/// given and without the folders of files; left out if long. `TIME_ZONE` is the zone of its clock.
#[must_use]
pub fn question_tags(question: &Question, time_zone: Option<&str>) -> Vec<(String, String)> {
    let text = serde_json::to_value(question).map(shortened).unwrap_or_default().to_string();
    let text = Some(text).filter(|text| text.len() <= MAX_QUESTION);
    let tags = [("QUESTION", text), ("TIME_ZONE", time_zone.map(str::to_owned))];
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
