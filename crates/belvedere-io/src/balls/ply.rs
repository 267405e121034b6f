//! Balls from PLY point clouds.

use belvedere_data::vector::to_f32;
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use super::patches::kinds_of_codes;
use super::write_ply::{METADATA_KEY, PATCH, PATCH_CORNERS, PATCH_KIND};
use super::{FileBall, index, metadata};
use crate::files::source::Input;
use crate::ply::read::{PlyFile, scalar};
use belvedere_data::cloud::to_local;
use belvedere_data::crs::text::{crs_from_comments, joined};
use belvedere_data::model::ModelParts;
use belvedere_data::{Error, Result, SurfacePatches};

const NEEDED: [&str; 5] = ["x", "y", "z", "radius", "touch"];

pub(crate) fn read_ply(input: Input<'_>) -> Result<ModelParts> {
    let mut file = PlyFile::open(input)?;
    if !has_columns(&file) {
        let what = format!("holds no balls; the vertices need the properties {}", NEEDED.join(", "));
        return Err(Error::malformed(file.name(), what));
    }
    let json = joined(METADATA_KEY, file.comments());
    let mut metadata = metadata::from_json(&json).map_err(|e| Error::malformed(file.name(), e))?;
    if json.is_empty() {
        metadata.crs = crs_from_comments(file.comments()).unwrap_or_default();
    }
    let check_patches = metadata.patch_check();
    let mut rows = Vec::new();
    file.for_each_vertex(|ball: FileBall| {
        rows.push(ball);
        Ok(())
    })?;
    let mut parts = metadata.fill(&rows);
    let (mut corners, mut codes) = (Vec::new(), Vec::new());
    let units = parts.frame.crs.metres_per_unit_xyz();
    file.for_each_row(PATCH, |patch: FilePatch| {
        let metres = |corner: [f64; 3]| std::array::from_fn(|axis| corner[axis] * units[axis]);
        corners.push(patch.corners.map(|corner| to_local(metres(corner), parts.frame.origin)));
        codes.push(patch.kind);
        Ok(())
    })?;
    let malformed = |e: String| Error::malformed(file.name(), e);
    parts.patches = SurfacePatches { triangles: corners, kinds: kinds_of_codes(&codes).map_err(malformed)? };
    check_patches(&parts.patches).map_err(malformed)?;
    Ok(parts)
}

/// A surface patch as the file gives it.
struct FilePatch {
    /// In the system and unit of the file.
    corners: [[f64; 3]; 3],
    kind: u8,
}

impl PropertyAccess for FilePatch {
    fn new() -> Self {
        // what lacks a coordinate or a kind is refused
        Self { corners: [[f64::NAN; 3]; 3], kind: u8::MAX }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(value) = scalar(&property) else { return PropertyAccessResult::Ignored };
        let names = PATCH_CORNERS.as_flattened();
        match (names.iter().position(|own| *own == name), property) {
            (Some(place), _) => self.corners[place / 3][place % 3] = value,
            (None, Property::UChar(code)) if name == PATCH_KIND => self.kind = code,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

pub(crate) fn ply_has_balls(input: Input<'_>) -> bool {
    PlyFile::open(input).is_ok_and(|file| has_columns(&file))
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
            "separation_angle" => self.separation_angle = to_f32(value),
            "source" => self.source = index(value),
            "touch" => self.touch = index(value),
            "transmission" => self.transmission = to_f32(value),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}
