//! JSON schema of questions, from the types that read them.

use super::placed_question::PlacedQuestion;
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{Schema, SchemaGenerator};

/// Returns the JSON schema (draft 2020-12) of a question with its places. Its texts are those of the types, and its
/// defaults are the values of fields that are left out.
#[must_use]
pub fn question_schema() -> Schema {
    let settings = SchemaSettings::draft2020_12();
    let mut schema = SchemaGenerator::new(settings).into_root_schema_for::<PlacedQuestion>();
    RecursiveTransform(in_words_of_json).transform(&mut schema);
    schema
}

/// Refuses unknown fields, as the reader does, and gives a text the words of JSON.
fn in_words_of_json(schema: &mut Schema) {
    if schema.get("properties").is_some() {
        schema.insert("additionalProperties".to_owned(), false.into());
    }
    if let Some(text) = schema.get("description").and_then(|text| text.as_str()) {
        let text = text.replace("`None`", "null").replace(['[', ']', '`'], "").replace('\n', " ");
        schema.insert("description".to_owned(), text.into());
    }
}
