//! Balls as PLY point clouds.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Header, Property, PropertyAccess, PropertyAccessResult};

use super::{FileBall, as_cloud, fill, metadata};
use crate::io::balls::SavedBalls;
use crate::io::{crs_text, write_ply};
use crate::{Error, Result};

/// Begins the comments that hold the metadata.
const METADATA_KEY: &str = "belvedere_balls";
const NEEDED: [&str; 5] = ["x", "y", "z", "radius", "touch"];

pub(crate) fn write_ply(path: &Path, balls: &SavedBalls) -> Result<()> {
    let (cloud, columns) = as_cloud(balls);
    let json = metadata::to_json(balls, "file units, radians; origin in metres");
    let comments = crs_text::pieces(METADATA_KEY, &in_ascii(&json));
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

pub(crate) fn read_ply(path: &Path) -> Result<SavedBalls> {
    let malformed = |what: String| Error::malformed(path, what);
    let mut reader = Reader::new(BufReader::new(File::open(path).map_err(Error::io(path))?));
    let parser = Parser::<FileBall>::new();
    let header = parser.read_header(&mut reader).map_err(|e| malformed(format!("not a PLY file: {e}")))?;
    if !has_columns(&header) {
        return Err(malformed(format!("holds no balls; the vertices need the properties {}", NEEDED.join(", "))));
    }
    let mut json = String::new();
    for comment in &header.comments {
        if let Some((METADATA_KEY, piece)) = comment.trim().split_once(' ') {
            json.push_str(piece.trim());
        }
    }
    let (mut balls, origin) = metadata::from_json(&json);
    if json.is_empty() {
        balls.crs = crs_text::crs_from_comments(header.comments.iter().map(String::as_str));
    }
    for (name, element) in &header.elements {
        let rows = parser
            .read_payload_for_element(&mut reader, element, &header)
            .map_err(|e| malformed(format!("damaged: {e}")))?;
        if name == "vertex" {
            return Ok(fill(balls, origin, &rows));
        }
    }
    Err(malformed("has no vertices".to_owned()))
}

pub(crate) fn ply_has_balls(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    Parser::<FileBall>::new().read_header(&mut Reader::new(BufReader::new(file))).is_ok_and(|h| has_columns(&h))
}

fn has_columns(header: &Header) -> bool {
    header.elements.get("vertex").is_some_and(|vertex| {
        // CloudCompare puts "scalar_" before the names of what it saves
        NEEDED.iter().all(|name| {
            vertex.properties.contains_key(*name) || vertex.properties.contains_key(&format!("scalar_{name}"))
        })
    })
}

impl PropertyAccess for FileBall {
    fn new() -> Self {
        Self { separation_angle: f32::NAN, source: u32::MAX, touch: u32::MAX, ..Self::default() }
    }

    #[expect(clippy::cast_possible_truncation, reason = "radius and angle are f32 in memory")]
    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let value = match property {
            Property::Char(v) => f64::from(v),
            Property::UChar(v) => f64::from(v),
            Property::Short(v) => f64::from(v),
            Property::UShort(v) => f64::from(v),
            Property::Int(v) => f64::from(v),
            Property::UInt(v) => f64::from(v),
            Property::Float(v) => f64::from(v),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::Ignored,
        };
        match name.strip_prefix("scalar_").unwrap_or(name) {
            "x" => self.center[0] = value,
            "y" => self.center[1] = value,
            "z" => self.center[2] = value,
            "radius" => self.radius = value,
            "separation_angle" => self.separation_angle = value as f32,
            "source" => self.source = index(value),
            "touch" => self.touch = index(value),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

/// An index that was stored as a signed number: what is negative in 32 bits stands above 2³¹.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked against the range; NaN gives none"
)]
fn index(value: f64) -> u32 {
    if value >= f64::from(i32::MIN) && value < 0.0 {
        (value as i32).cast_unsigned()
    } else if value >= 0.0 && value <= f64::from(u32::MAX) {
        value as u32
    } else {
        u32::MAX
    }
}
