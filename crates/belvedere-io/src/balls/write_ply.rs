//! Balls as PLY point clouds.

use super::{as_cloud, metadata};
use crate::files::output::Output;
use crate::ply::write_ply::{self, PlyElement};
use belvedere_data::Result;
use belvedere_data::crs::text::pieces;
use belvedere_data::model::ModelParts;

/// Begins the comments that hold the metadata.
pub(super) const METADATA_KEY: &str = "belvedere_balls";
/// The element that holds the surface patches.
pub(super) const PATCH: &str = "patch";
/// Coordinates of their corners.
pub(super) const PATCH_CORNERS: [[&str; 3]; 3] = [["x1", "y1", "z1"], ["x2", "y2", "z2"], ["x3", "y3", "z3"]];
/// Name of the property of a patch that gives its kind.
pub(super) const PATCH_KIND: &str = "kind";

pub(crate) fn write_ply(output: Output<'_>, parts: &ModelParts) -> Result<()> {
    let (cloud, columns) = as_cloud(parts);
    let json = metadata::to_json(parts, metadata::FILE_UNITS);
    let comments = pieces(METADATA_KEY, &in_ascii(&json));
    write_ply::write(output, &cloud, &columns, &comments, &patch_element(parts)).map(|_| ())
}

/// The surface patches as an element of their own: the corners of triangles in the unit of the file, and their kinds.
fn patch_element(parts: &ModelParts) -> PlyElement {
    if parts.patches.is_empty() {
        return PlyElement::default();
    }
    let coordinates: String =
        PATCH_CORNERS.as_flattened().iter().map(|name| format!("property double {name}\n")).collect();
    let header = format!("element {PATCH} {}\n{coordinates}property uchar {PATCH_KIND}\n", parts.patches.len());
    let mut bytes = Vec::new();
    for (triangle, kind) in parts.patches.iter() {
        let corners = triangle.map(|corner| parts.frame.to_file_coordinates(corner));
        bytes.extend(corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
        bytes.push(kind.code());
    }
    PlyElement { header, bytes }
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
