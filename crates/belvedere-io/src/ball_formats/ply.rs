//! Balls as PLY point clouds.

use std::path::Path;

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use super::{FileBall, as_cloud, index, metadata};
use crate::part::narrow;
use crate::ply::{PlyFile, scalar};
use crate::write_ply;
use belvedere_data::crs::text::{crs_from_comments, joined, pieces};
use belvedere_data::model::ModelParts;
use belvedere_data::{Error, Result};

/// Begins the comments that hold the metadata.
const METADATA_KEY: &str = "belvedere_balls";
const NEEDED: [&str; 5] = ["x", "y", "z", "radius", "touch"];

pub(crate) fn write_ply(path: &Path, parts: &ModelParts) -> Result<()> {
    let (cloud, columns) = as_cloud(parts);
    let json = metadata::to_json(parts, metadata::FILE_UNITS);
    let comments = pieces(METADATA_KEY, &in_ascii(&json));
    write_ply::write(path, &cloud, &columns, &comments).map(|_| ())
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

pub(crate) fn read_ply(path: &Path) -> Result<ModelParts> {
    let mut file = PlyFile::open(path)?;
    if !has_columns(&file) {
        let what = format!("holds no balls; the vertices need the properties {}", NEEDED.join(", "));
        return Err(Error::malformed(path, what));
    }
    let json = joined(METADATA_KEY, file.comments());
    let mut metadata = metadata::from_json(&json);
    if json.is_empty() {
        metadata.crs = crs_from_comments(file.comments()).unwrap_or_default();
    }
    let mut rows = Vec::new();
    file.for_each_vertex(|ball: FileBall| rows.push(ball))?;
    Ok(metadata.fill(&rows))
}

pub(crate) fn ply_has_balls(path: &Path) -> bool {
    PlyFile::open(path).is_ok_and(|file| has_columns(&file))
}

fn has_columns(file: &PlyFile<'_>) -> bool {
    file.vertex().is_some_and(|vertex| {
        // CloudCompare puts "scalar_" before the names of what it saves
        NEEDED.iter().all(|name| {
            vertex.properties.contains_key(*name) || vertex.properties.contains_key(&format!("scalar_{name}"))
        })
    })
}

impl PropertyAccess for FileBall {
    fn new() -> Self {
        Self {
            separation_angle: f32::NAN,
            source: u32::MAX,
            touch: u32::MAX,
            transmission: f32::NAN,
            ..Self::default()
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(value) = scalar(&property) else { return PropertyAccessResult::Ignored };
        match name.strip_prefix("scalar_").unwrap_or(name) {
            "x" => self.center[0] = value,
            "y" => self.center[1] = value,
            "z" => self.center[2] = value,
            "radius" => self.radius = value,
            "separation_angle" => self.separation_angle = narrow(value),
            "source" => self.source = index(value),
            "touch" => self.touch = index(value),
            "transmission" => self.transmission = narrow(value),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}
