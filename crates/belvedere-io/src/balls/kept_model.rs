//! Files of a cache, as archives of arrays: a model with all that takes long to make, and rasters. They are no exchange
//! format: only the program that wrote them reads them.

use super::npz::{read_arrays, write_arrays};
use crate::arrays::npz::{array, has, invalid, open, rows, values, write_archive};
use crate::files::output::Output;
use crate::files::source::{Input, Source};
use belvedere_data::model::{DerivedParts, ModelParts, ProofParts, TreeParts};
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Result};
use std::io::{self, Read, Seek, Write};
use zip::{ZipArchive, ZipWriter};

/// Writes a model, its derived data, and notes about both, so that [`read_kept_model`] reads the same numbers.
///
/// # Errors
/// [`Error::Io`].
pub fn write_kept_model<'a>(
    output: impl Into<Output<'a>>,
    parts: &ModelParts,
    derived: &DerivedParts,
    notes: &str,
) -> Result<()> {
    output.into().write(|path, output| {
        let arrays = |archive: &mut ZipWriter<_>| {
            write_arrays(archive, parts)?;
            write_derived(archive, derived)?;
            array(archive, "notes", &[notes.len() as u64], notes.bytes())
        };
        write_archive(output, arrays).map_err(Error::io(path))
    })
}

fn write_derived<W: Write + Seek>(archive: &mut ZipWriter<W>, derived: &DerivedParts) -> io::Result<()> {
    let DerivedParts { vegetation, normals, tree, proof } = derived;
    array(archive, "vegetation", &[vegetation.len() as u64], vegetation.iter().map(|&is_one| u8::from(is_one)))?;
    if let Some(normals) = normals {
        array(archive, "normals", &[normals.len() as u64, 3], normals.as_flattened().iter().copied())?;
    }
    if let Some(TreeParts { nodes, order, around }) = tree {
        array(archive, "tree_nodes", &[nodes.len() as u64, 20], nodes.as_flattened().iter().copied())?;
        array(archive, "tree_order", &[order.len() as u64], order.iter().copied())?;
        array(archive, "tree_around", &[2, 3], around.as_flattened().iter().copied())?;
    }
    if let Some(ProofParts { order, boxes, seen_space }) = proof {
        array(archive, "pulse_order", &[order.len() as u64], order.iter().copied())?;
        array(archive, "pulse_boxes", &[boxes.len() as u64, 10], boxes.as_flattened().iter().copied())?;
        array(archive, "seen_space", &[seen_space.len() as u64], seen_space.iter().copied())?;
    }
    Ok(())
}

/// Reads a file of [`write_kept_model`]. Every array has a checksum.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that is damaged.
pub fn read_kept_model<'a>(source: impl Into<Source<'a>>) -> Result<(ModelParts, DerivedParts, String)> {
    let Input { name, reader, size } = source.into().open()?;
    let path = name.as_path();
    let malformed = |e: io::Error| Error::malformed(path, format!("damaged: {e}"));
    let mut archive = open(reader, size).map_err(malformed)?;
    let parts = read_arrays(&mut archive, path)?;
    let derived = read_derived(&mut archive).map_err(malformed)?;
    let notes = notes(&mut archive).map_err(malformed)?;
    Ok((parts, derived, notes))
}

/// Writes rasters with notes, so that [`read_kept_rasters`] reads the same numbers.
///
/// # Errors
/// [`Error::Io`].
pub fn write_kept_rasters<'a>(output: impl Into<Output<'a>>, rasters: &[&Raster<f32>], notes: &str) -> Result<()> {
    output.into().write(|path, output| {
        let arrays = |archive: &mut ZipWriter<_>| {
            for (number, raster) in rasters.iter().enumerate() {
                let shape = [raster.height() as u64, raster.width() as u64];
                array(archive, &format!("raster_{number}"), &shape, raster.values().iter().copied())?;
            }
            array(archive, "notes", &[notes.len() as u64], notes.bytes())
        };
        write_archive(output, arrays).map_err(Error::io(path))
    })
}

/// Reads a file of [`write_kept_rasters`].
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that is damaged.
pub fn read_kept_rasters<'a>(source: impl Into<Source<'a>>) -> Result<(Vec<Raster<f32>>, String)> {
    let Input { name, reader, size } = source.into().open()?;
    let malformed = |e: io::Error| Error::malformed(&name, format!("damaged: {e}"));
    let mut archive = open(reader, size).map_err(malformed)?;
    let mut rasters = Vec::new();
    while has(&archive, &format!("raster_{}", rasters.len())) {
        let name = format!("raster_{}", rasters.len());
        let (values, shape) = values(&mut archive, &name, u64::MAX).map_err(malformed)?;
        let [height, width] = shape[..] else { return Err(malformed(invalid("a raster has no rows".to_owned()))) };
        let side = |side: u64| usize::try_from(side).unwrap_or(usize::MAX);
        rasters.push(Raster::from_values(side(width), side(height), values)?);
    }
    let notes = notes(&mut archive).map_err(malformed)?;
    Ok((rasters, notes))
}

/// Reads only the notes of [`write_kept_model`].
///
/// # Errors
/// Those of [`read_kept_model`].
pub fn read_kept_notes<'a>(source: impl Into<Source<'a>>) -> Result<String> {
    let Input { name, reader, size } = source.into().open()?;
    let notes = open(reader, size).and_then(|mut archive| notes(&mut archive));
    notes.map_err(|error| Error::malformed(&name, format!("damaged: {error}")))
}

fn notes<R: Read + Seek>(archive: &mut ZipArchive<R>) -> io::Result<String> {
    let bytes = values::<u8, _>(archive, "notes", u64::MAX)?.0;
    String::from_utf8(bytes).map_err(|_| invalid("its notes are no text".to_owned()))
}

fn read_derived<R: Read + Seek>(archive: &mut ZipArchive<R>) -> io::Result<DerivedParts> {
    let vegetation =
        values::<u8, _>(archive, "vegetation", u64::MAX)?.0.into_iter().map(|is_one| is_one != 0).collect();
    let normals = if has(archive, "normals") { Some(rows(archive, "normals")?) } else { None };
    let mut tree = None;
    if has(archive, "tree_nodes") {
        let around = rows(archive, "tree_around")?.try_into();
        tree = Some(TreeParts {
            nodes: rows(archive, "tree_nodes")?,
            order: values(archive, "tree_order", u64::MAX)?.0,
            around: around.map_err(|_| invalid("tree_around has not two rows".to_owned()))?,
        });
    }
    let mut proof = None;
    if has(archive, "pulse_order") {
        proof = Some(ProofParts {
            order: values(archive, "pulse_order", u64::MAX)?.0,
            boxes: rows(archive, "pulse_boxes")?,
            seen_space: values(archive, "seen_space", u64::MAX)?.0,
        });
    }
    Ok(DerivedParts { vegetation, normals, tree, proof })
}
