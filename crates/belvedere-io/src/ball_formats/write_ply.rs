//! Balls as PLY point clouds.

use super::{as_cloud, metadata};
use crate::output::Output;
use crate::write_ply;
use belvedere_data::Result;
use belvedere_data::crs::text::pieces;
use belvedere_data::model::ModelParts;

/// Begins the comments that hold the metadata.
pub(super) const METADATA_KEY: &str = "belvedere_balls";

pub(crate) fn write_ply(output: Output<'_>, parts: &ModelParts) -> Result<()> {
    let (cloud, columns) = as_cloud(parts);
    let json = metadata::to_json(parts, metadata::FILE_UNITS);
    let comments = pieces(METADATA_KEY, &in_ascii(&json));
    write_ply::write(output, &cloud, &columns, &comments).map(|_| ())
}

/// JSON with the characters beyond ASCII, which PLY headers must not hold, as escapes.
fn in_ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        if c.is_ascii() {
            text.push(c);
        } else {
            for unit in c.encode_utf16(&mut [0; 2]) {
                text.push_str(&format!("\\u{unit:04x}"));
            }
        }
    }
    text
}
