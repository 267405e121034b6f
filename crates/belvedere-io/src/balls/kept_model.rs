//! Files of a cache, as archives of arrays: a model with all that takes long to make, the points of a cloud, and
//! ground. They are no exchange format: only the program that wrote them reads them.

use super::npz::{read_arrays, write_arrays};
use crate::arrays::npz::{Number, array, has, invalid, open, rows, values, write_archive};
use crate::files::output::Output;
use crate::files::source::{Input, Source};
use belvedere_data::attribute_columns;
use belvedere_data::cloud::{CloudFile, FileRows, GpsTimeKind};
use belvedere_data::model::{DerivedParts, GroundParts, ModelParts, ProofParts, TreeParts};
use belvedere_data::raster::Raster;
use belvedere_data::{Error, Frame, PointCloud, Result};
use bytemuck::Pod;
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Seek, Write};
use std::path::PathBuf;
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
    let source = source.into();
    let name = source.name().to_owned();
    let malformed = |e: io::Error| Error::malformed(&name, format!("damaged: {e}"));
    // two threads read a file twice as fast as one
    let second = source.is_on_disk().then(|| Source::path(&name));
    let Input { reader, size, .. } = source.open()?;
    let mut archive = open(reader, size).map_err(malformed)?;
    let derived = |source: Source<'static>| {
        let Input { reader, size, .. } = source.open()?;
        open(reader, size).and_then(|mut archive| read_derived(&mut archive)).map_err(malformed)
    };
    let (parts, derived) = match second {
        Some(second) => rayon::join(|| read_arrays(&mut archive, &name), || derived(second)),
        None => (read_arrays(&mut archive, &name), read_derived(&mut archive).map_err(malformed)),
    };
    let (parts, derived) = (parts?, derived?);
    let notes = notes(&mut archive).map_err(malformed)?;
    Ok((parts, derived, notes))
}

/// Contents of a cloud beside its columns.
#[derive(Deserialize, Serialize)]
struct CloudNotes {
    /// Path, number of rows, other attributes and records of each file.
    files: Vec<(PathBuf, u64, Vec<String>, Vec<String>)>,
    has_all_rows: bool,
    is_adjusted_standard_time: bool,
}

/// Value of a column of a cloud.
trait ColumnValue: Pod {
    type Number: Number;
    const NUMBERS: u64 = (size_of::<Self>() / size_of::<Self::Number>()) as u64;
}

macro_rules! column_values {
    ($($value:ty: $number:ty,)*) => {
        $(impl ColumnValue for $value {
            type Number = $number;
        })*
    };
}

column_values! {
    u8: u8,
    u16: u16,
    u32: u32,
    u64: u64,
    f32: f32,
    f64: f64,
    [u16; 3]: u16,
    [u32; 3]: u32,
    [u64; 3]: u64,
    [f32; 2]: f32,
    [f32; 3]: f32,
}

fn write_column<T: ColumnValue, W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    column: &[T],
) -> io::Result<()> {
    let numbers: &[T::Number] = bytemuck::cast_slice(column);
    array(archive, name, &[column.len() as u64, T::NUMBERS], numbers.iter().copied())
}

fn read_column<T: ColumnValue, R: Read + Seek>(archive: &mut ZipArchive<R>, name: &str) -> io::Result<Vec<T>> {
    let (numbers, shape) = values::<T::Number, _>(archive, name, u64::MAX)?;
    match shape[..] {
        [_, count] if count == T::NUMBERS => Ok(bytemuck::try_cast_vec(numbers)
            .unwrap_or_else(|(_, numbers)| bytemuck::cast_slice::<T::Number, T>(&numbers).to_vec())),
        _ => Err(invalid(format!("the array {name} has shape {shape:?}, but must be (N, {})", T::NUMBERS))),
    }
}

/// Writes the points of a cloud with all their attributes, so that [`read_kept_cloud`] reads the same numbers. The
/// frame is not written, and neither are sky regions.
///
/// # Errors
/// [`Error::Io`].
pub fn write_kept_cloud<'a>(output: impl Into<Output<'a>>, cloud: &PointCloud) -> Result<()> {
    let of_file = |file: &CloudFile| {
        let CloudFile { path, row_count, other_attributes, records } = file.clone();
        (path, row_count, other_attributes, records)
    };
    let notes = CloudNotes {
        files: cloud.files.files.iter().map(of_file).collect(),
        has_all_rows: cloud.files.rows == FileRows::All,
        is_adjusted_standard_time: cloud.attributes.gps_time_kind == GpsTimeKind::AdjustedStandard,
    };
    output.into().write(|path, output| {
        let arrays = |archive: &mut ZipWriter<_>| {
            write_column(archive, "positions", &cloud.positions)?;
            macro_rules! columns {
                ($($(#[$doc:meta])* $column:ident: $value:ty,)*) => {
                    $(if let Some(column) = &cloud.attributes.$column {
                        write_column(archive, stringify!($column), column)?;
                    })*
                };
            }
            attribute_columns!(columns);
            write_column(archive, "scanner_positions", &cloud.scanner_positions)?;
            write_column(archive, "cleared_places", &cloud.cleared_places)?;
            if let FileRows::Of(rows) = &cloud.files.rows {
                write_column(archive, "file_rows", rows)?;
            }
            let notes = serde_json::to_vec(&notes)?;
            array(archive, "notes", &[notes.len() as u64], notes.into_iter())
        };
        write_archive(output, arrays).map_err(Error::io(path))
    })
}

/// Reads a file of [`write_kept_cloud`].
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that is damaged.
pub fn read_kept_cloud<'a>(source: impl Into<Source<'a>>, frame: Frame) -> Result<PointCloud> {
    let Input { name, reader, size } = source.into().open()?;
    let read = || {
        let archive = &mut open(reader, size)?;
        let notes: CloudNotes = serde_json::from_str(&notes(archive)?)?;
        let mut cloud = PointCloud::in_frame(frame);
        cloud.positions = read_column(archive, "positions")?;
        macro_rules! columns {
            ($($(#[$doc:meta])* $column:ident: $value:ty,)*) => {
                $(if has(archive, stringify!($column)) {
                    cloud.attributes.$column = Some(read_column(archive, stringify!($column))?);
                })*
            };
        }
        attribute_columns!(columns);
        if notes.is_adjusted_standard_time {
            cloud.attributes.gps_time_kind = GpsTimeKind::AdjustedStandard;
        }
        cloud.scanner_positions = read_column(archive, "scanner_positions")?;
        cloud.cleared_places = read_column(archive, "cleared_places")?;
        let file =
            |(path, row_count, other_attributes, records)| CloudFile { path, row_count, other_attributes, records };
        cloud.files.files = notes.files.into_iter().map(file).collect();
        cloud.files.rows = match notes.has_all_rows {
            true => FileRows::All,
            false if has(archive, "file_rows") => FileRows::Of(read_column(archive, "file_rows")?),
            false => FileRows::Unknown,
        };
        let lengths = cloud.attributes.columns();
        match lengths.into_iter().find(|(_, length)| *length != cloud.len()) {
            Some((column, _)) => Err(invalid(format!("its column {column} does not fit its points"))),
            None => Ok(cloud),
        }
    };
    read().map_err(|error: io::Error| Error::malformed(&name, format!("damaged: {error}")))
}

/// Calls `$apply!` with the fields of [`GroundParts`] that are columns.
macro_rules! ground_columns {
    ($apply:ident) => {
        $apply!(points, triangles, large, starts, triangles_of_squares, points_of_squares, returns)
    };
}

/// Writes the ground of a cloud with notes, so that [`read_kept_ground`] reads the same numbers.
///
/// # Errors
/// [`Error::Io`].
pub fn write_kept_ground<'a>(output: impl Into<Output<'a>>, parts: &GroundParts, notes: &str) -> Result<()> {
    output.into().write(|path, output| {
        let arrays = |archive: &mut ZipWriter<_>| {
            macro_rules! columns {
                ($($column:ident),*) => {
                    $(write_column(archive, stringify!($column), &parts.$column)?;)*
                };
            }
            ground_columns!(columns);
            write_column(archive, "squares", &parts.squares)?;
            array(archive, "notes", &[notes.len() as u64], notes.bytes())
        };
        write_archive(output, arrays).map_err(Error::io(path))
    })
}

/// Reads a file of [`write_kept_ground`].
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for a file that is damaged.
pub fn read_kept_ground<'a>(source: impl Into<Source<'a>>) -> Result<(GroundParts, String)> {
    let Input { name, reader, size } = source.into().open()?;
    let read = || {
        let archive = &mut open(reader, size)?;
        let mut parts = GroundParts::default();
        macro_rules! columns {
            ($($column:ident),*) => {
                $(parts.$column = read_column(archive, stringify!($column))?;)*
            };
        }
        ground_columns!(columns);
        let squares = read_column::<f64, _>(archive, "squares")?.try_into();
        parts.squares = squares.map_err(|_| invalid("it has no squares".to_owned()))?;
        Ok((parts, notes(archive)?))
    };
    read().map_err(|error: io::Error| Error::malformed(&name, format!("damaged: {error}")))
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
