//! Balls in NumPy's archive format, without loss.

use std::io::{self, Read, Seek, Write};
use std::path::Path;
use zip::{ZipArchive, ZipWriter};

use super::metadata;
use super::outlines::{OUTLINE_ARRAYS, read_outlines, write_outlines};
use super::patches::{in_corners, kinds_of_codes};
use crate::arrays::npz::{array, array_names, has, invalid, open, rows, values, write_archive};
use crate::files::output::Output;
use crate::files::source::Input;
use belvedere_data::ExtinctionVoxels;
use belvedere_data::free_segments::FreeSegmentColumns;
use belvedere_data::model::ModelParts;
use belvedere_data::{Error, Result, SurfacePatches};

const UNITS: &str = "metres relative to origin, radians; coordinates in the crs are \
                     (origin + centers) / metres_per_unit";
/// Arrays that files with pulses have.
const PULSE_ARRAYS: [&str; 3] = ["pulse_starts", "pulse_slopes", "pulse_top"];
/// Arrays that files with surface patches have.
const PATCH_ARRAYS: [&str; 2] = ["patch_corners", "patch_kinds"];
/// Arrays that all or some files have beside these.
const OTHER_ARRAYS: [&str; 12] = [
    "centers",
    "origin",
    "radii",
    "source",
    "touch",
    "separation_angles",
    "transmission",
    "pulse_lengths",
    "pulse_ways",
    "metadata",
    "crown_voxels",
    "crown_extinction",
];
/// Metadata longer than this is not ours.
const MAX_METADATA_BYTES: u64 = 1 << 24;

pub(crate) fn write_npz(output: Output<'_>, parts: &ModelParts) -> Result<()> {
    output.write(|path, output| write_archive(output, |archive| write_arrays(archive, parts)).map_err(Error::io(path)))
}

pub(super) fn write_arrays<W: Write + Seek>(archive: &mut ZipWriter<W>, parts: &ModelParts) -> io::Result<()> {
    let metadata = metadata::to_json(parts, UNITS);
    let n = parts.balls.centers.len() as u64;
    array(archive, "centers", &[n, 3], parts.balls.centers.iter().flatten().copied())?;
    array(archive, "origin", &[3], parts.frame.origin.into_iter())?;
    array(archive, "radii", &[n], parts.balls.radii.iter().copied())?;
    array(archive, "source", &[n], parts.balls.source.iter().copied())?;
    array(archive, "touch", &[n], parts.balls.touch.iter().copied())?;
    array(archive, "separation_angles", &[n], parts.balls.separation_angles.iter().copied())?;
    if !parts.transmission.is_empty() {
        array(archive, "transmission", &[n], parts.transmission.iter().copied())?;
    }
    if !parts.patches.is_empty() {
        let SurfacePatches { triangles, kinds } = &parts.patches;
        let t = triangles.len() as u64;
        array(archive, "patch_corners", &[t, 3, 3], triangles.as_flattened().as_flattened().iter().copied())?;
        array(archive, "patch_kinds", &[t], kinds.iter().map(|kind| kind.code()))?;
    }
    if !parts.outlines.is_empty() {
        write_outlines(archive, &parts.outlines)?;
    }
    if let Some(ExtinctionVoxels { voxels, extinction }) = &parts.medium {
        let v = voxels.len() as u64;
        array(archive, "crown_voxels", &[v, 3], voxels.as_flattened().iter().copied())?;
        array(archive, "crown_extinction", &[v], extinction.iter().copied())?;
    }
    if let Some(FreeSegmentColumns { starts, ways, slopes, lengths, top }) = &parts.pulses {
        let p = starts.len() as u64;
        array(archive, "pulse_starts", &[p, 3], starts.iter().flatten().copied())?;
        array(archive, "pulse_slopes", &[p, 2], slopes.iter().flatten().copied())?;
        array(archive, "pulse_top", &[1], [*top].into_iter())?;
        if !lengths.is_empty() {
            array(archive, "pulse_lengths", &[p], lengths.iter().copied())?;
        }
        if !ways.is_empty() {
            array(archive, "pulse_ways", &[p], ways.iter().copied())?;
        }
    }
    array(archive, "metadata", &[metadata.len() as u64], metadata.bytes())
}

pub(crate) fn read_npz(input: Input<'_>) -> Result<ModelParts> {
    let Input { name, reader, size } = input;
    let path = name.as_path();
    let malformed = |e: io::Error| Error::malformed(path, format!("damaged, or not a ball file: {e}"));
    let mut archive = open(reader, size).map_err(malformed)?;
    if let Some(unknown) = unknown(&archive) {
        let what = format!("damaged, or not a ball file: no ball file has an array {unknown:?}");
        return Err(Error::malformed(path, what));
    }
    read_arrays(&mut archive, path)
}

/// The balls of an archive; `path` names it in errors.
pub(super) fn read_arrays<R: Read + Seek>(archive: &mut ZipArchive<R>, path: &Path) -> Result<ModelParts> {
    let malformed = |e: io::Error| Error::malformed(path, format!("damaged, or not a ball file: {e}"));
    let text = if has(archive, "metadata") {
        values::<u8, _>(archive, "metadata", MAX_METADATA_BYTES).map_err(malformed)?.0
    } else {
        Vec::new()
    };
    let metadata = metadata::from_json(&String::from_utf8_lossy(&text)).map_err(|e| Error::malformed(path, e))?;
    let check_patches = metadata.patch_check();
    let centers = rows::<f32, 3, _>(archive, "centers").map_err(malformed)?;
    let (origin, _) = values::<f64, _>(archive, "origin", 3).map_err(malformed)?;
    let origin = <[f64; 3]>::try_from(origin.as_slice())
        .map_err(|_| Error::malformed(path, format!("origin has {} numbers, but must have 3", origin.len())))?;
    let mut parts = metadata.balls(origin, centers);
    if text.is_empty() {
        let what = "the ball file has lost its metadata: no reference system is known, and its bounds are those of its balls; make it again";
        parts.frame.crs = parts.frame.crs.doubted(what.to_owned());
    }
    parts.balls.radii = values(archive, "radii", u64::MAX).map_err(malformed)?.0;
    parts.balls.source = values(archive, "source", u64::MAX).map_err(malformed)?.0;
    parts.balls.touch = values(archive, "touch", u64::MAX).map_err(malformed)?.0;
    parts.balls.separation_angles = values(archive, "separation_angles", u64::MAX).map_err(malformed)?.0;
    if has(archive, "transmission") {
        parts.transmission = values(archive, "transmission", u64::MAX).map_err(malformed)?.0;
    }
    if PATCH_ARRAYS.iter().any(|name| has(archive, name)) {
        parts.patches = patches(archive).map_err(malformed)?;
    }
    check_patches(&parts.patches).map_err(|e| Error::malformed(path, e))?;
    parts.outlines = read_outlines(archive).map_err(malformed)?;
    if has(archive, "crown_voxels") || has(archive, "crown_extinction") {
        parts.medium = Some(crowns(archive).map_err(malformed)?);
    }
    if PULSE_ARRAYS.iter().any(|name| has(archive, name)) {
        parts.pulses = Some(pulses(archive).map_err(malformed)?);
    }
    Ok(parts)
}

fn patches<R: Read + Seek>(archive: &mut ZipArchive<R>) -> io::Result<SurfacePatches> {
    let (corners, shape) = values::<f32, _>(archive, "patch_corners", u64::MAX)?;
    let [_, 3, 3] = shape[..] else {
        return Err(invalid(format!("the array patch_corners has shape {shape:?}, but must be (M, 3, 3)")));
    };
    let kinds = values::<u8, _>(archive, "patch_kinds", u64::MAX)?.0;
    let triangles = corners.as_chunks::<9>().0.iter().map(in_corners).collect();
    Ok(SurfacePatches { triangles, kinds: kinds_of_codes(&kinds).map_err(invalid)? })
}

fn crowns<R: Read + Seek>(archive: &mut ZipArchive<R>) -> io::Result<ExtinctionVoxels> {
    let voxels = rows::<i32, 3, _>(archive, "crown_voxels")?;
    Ok(ExtinctionVoxels { voxels, extinction: values(archive, "crown_extinction", u64::MAX)?.0 })
}

fn pulses<R: Read + Seek>(archive: &mut ZipArchive<R>) -> io::Result<FreeSegmentColumns> {
    let lengths =
        if has(archive, "pulse_lengths") { values(archive, "pulse_lengths", u64::MAX)?.0 } else { Vec::new() };
    let ways = if has(archive, "pulse_ways") { values(archive, "pulse_ways", u64::MAX)?.0 } else { Vec::new() };
    let top = values::<f32, _>(archive, "pulse_top", 1)?.0;
    Ok(FreeSegmentColumns {
        starts: rows::<f32, 3, _>(archive, "pulse_starts")?,
        ways,
        slopes: rows::<i16, 2, _>(archive, "pulse_slopes")?,
        lengths,
        top: top.first().copied().ok_or_else(|| invalid("pulse_top is empty".to_owned()))?,
    })
}

/// An array of another name: a damaged name of one that is not in every file would not be missed.
fn unknown<R: Read + Seek>(archive: &ZipArchive<R>) -> Option<String> {
    let known = [&PULSE_ARRAYS[..], &PATCH_ARRAYS, &OUTLINE_ARRAYS, &OTHER_ARRAYS].concat();
    let is_known = |name: &&str| known.contains(name);
    array_names(archive).find(|name| !is_known(name)).map(str::to_owned)
}
