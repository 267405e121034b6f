//! Balls as LAS and LAZ point clouds with extra bytes.

use ::las::Vlr;
use belvedere_data::vector::to_f32;

use super::{FileBall, as_cloud, index, metadata, patches};
use crate::files::output::Output;
use crate::files::source::Input;
use crate::las::LasFile;
use crate::las::extra::ExtraField;
use crate::las::header::RecordSize;
use crate::las::laz::LazFields;
use crate::las::write_las;
use belvedere_data::model::ModelParts;
use belvedere_data::{Error, Result};

/// Identity of the record that holds the metadata.
const RECORD_USER: &str = "belvedere";
const RECORD_ID: u16 = 1;
/// Number of the record that holds the surface patches.
const PATCHES_ID: u16 = 3;

pub(crate) fn write_las(output: Output<'_>, parts: &ModelParts) -> Result<()> {
    let (cloud, columns) = as_cloud(parts);
    let record = Vlr {
        user_id: RECORD_USER.to_owned(),
        record_id: RECORD_ID,
        description: "medial balls".to_owned(),
        data: metadata::to_json(parts, metadata::FILE_UNITS).into_bytes(),
    };
    let mut records = vec![record];
    if !parts.patches.is_empty() {
        records.push(Vlr {
            user_id: RECORD_USER.to_owned(),
            record_id: PATCHES_ID,
            description: "surface patches".to_owned(),
            data: patches::to_bytes(&parts.patches, parts.frame.origin),
        });
    }
    write_las::write(output, &cloud, &columns, &records).map(|_| ())
}

pub(crate) fn read_las(input: Input<'_>) -> Result<ModelParts> {
    let name = input.name.clone();
    let path = name.as_path();
    let file = LasFile::open_with(input, RecordSize::Any)?;
    let Some(fields) = BallFields::of(&file) else {
        return Err(Error::malformed(path, "holds no balls; it needs the extra bytes radius and touch"));
    };
    let text = file.header.record(RECORD_USER, RECORD_ID).unwrap_or_default();
    let metadata = metadata::from_json(String::from_utf8_lossy(text).trim_end_matches('\0'))
        .map_err(|e| Error::malformed(path, e))?;
    let check_patches = metadata.patch_check();
    let kept = match file.header.record(RECORD_USER, PATCHES_ID) {
        Some(bytes) => Some(patches::from_bytes(bytes).map_err(|e| Error::malformed(path, e))?),
        None => None,
    };
    let (announced, present) = (file.header.points, file.points_in_file());
    if present < announced {
        return Err(Error::malformed(path, format!("ends after {present} of {announced} balls")));
    }
    let mut rows = Vec::new();
    let mut batches = file.batches(LazFields::AttributesAndExtraBytes)?;
    while let Some(batch) = batches.next()? {
        let records = batch.raw_bytes().chunks_exact(batch.record_len().max(1));
        let centers = batch.x().zip(batch.y()).zip(batch.z());
        rows.extend(centers.zip(records).map(|(((x, y), z), record)| fields.ball([x, y, z], record)));
    }
    let mut parts = metadata.fill(&rows);
    if let Some((patches, origin)) = kept {
        parts.patches = patches::moved(patches, origin, parts.frame.origin);
    }
    check_patches(&parts.patches).map_err(|e| Error::malformed(path, e))?;
    Ok(parts)
}

pub(crate) fn las_has_balls(input: Input<'_>) -> bool {
    LasFile::open(input).is_ok_and(|file| BallFields::of(&file).is_some())
}

/// The extra columns of a ball file.
struct BallFields {
    radius: ExtraField,
    touch: ExtraField,
    separation_angle: Option<ExtraField>,
    source: Option<ExtraField>,
    transmission: Option<ExtraField>,
}

impl BallFields {
    /// `None` where radius or touch is missing.
    fn of(file: &LasFile<'_>) -> Option<Self> {
        let [radius, touch, separation_angle, source, transmission] =
            file.columns(["radius", "touch", "separation_angle", "source", "transmission"]);
        Some(Self { radius: radius?, touch: touch?, separation_angle, source, transmission })
    }

    fn ball(&self, center: [f64; 3], record: &[u8]) -> FileBall {
        let number = |field: ExtraField| field.value(record).unwrap_or(f64::NAN);
        FileBall {
            center,
            radius: number(self.radius),
            separation_angle: self.separation_angle.map_or(f32::NAN, |field| to_f32(number(field))),
            source: self.source.map_or(u32::MAX, |field| index(number(field))),
            touch: index(number(self.touch)),
            transmission: self.transmission.map_or(f32::NAN, |field| to_f32(number(field))),
        }
    }
}
