//! The formats of ball files.

#![cfg_attr(
    not(all(feature = "las", feature = "ply", feature = "npy")),
    allow(dead_code, reason = "a build without some formats uses a part of it")
)]

pub(crate) mod files;
#[cfg(feature = "npy")]
mod kept_model;
#[cfg(feature = "las")]
mod las;
mod metadata;
#[cfg(feature = "npy")]
mod npz;
#[cfg(feature = "npy")]
mod outlines;
mod patches;
#[cfg(feature = "ply")]
mod ply;
mod write_ply;

#[cfg(feature = "npy")]
pub use kept_model::{
    read_kept_cloud, read_kept_ground, read_kept_model, read_kept_notes, read_kept_rasters, write_kept_cloud,
    write_kept_ground, write_kept_model, write_kept_rasters,
};
#[cfg(feature = "las")]
pub(crate) use las::{las_has_balls, read_las, write_las};
#[cfg(feature = "npy")]
pub(crate) use npz::{read_npz, write_npz};
#[cfg(feature = "ply")]
pub(crate) use ply::{ply_has_balls, read_ply};
pub(crate) use write_ply::write_ply;

use crate::points::columns::{Column, ColumnValues};
use belvedere_data::PointCloud;
use belvedere_data::model::ModelParts;
use belvedere_data::vector::to_f32;

/// The centres as a cloud and the rest as columns, for formats that hold points. Indices are signed there, so that
/// viewers show −1 and not four thousand million for "none".
fn as_cloud(parts: &ModelParts) -> (PointCloud, Vec<Column<'_>>) {
    let cloud =
        PointCloud { frame: parts.frame.clone(), positions: parts.balls.centers.clone(), ..PointCloud::default() };
    let unit = parts.frame.crs.metres_per_unit;
    let radii = parts.balls.radii.iter().map(|&r| to_f32(f64::from(r) / unit)).collect();
    let signed = |indices: &[u32]| ColumnValues::I32(indices.iter().map(|&i| i.cast_signed()).collect());
    let column = |name, description, values| Column { name, description, values };
    let mut columns = vec![
        column("radius".into(), "in the unit of x and y".into(), ColumnValues::F32(radii)),
        column("separation_angle".into(), "radians".into(), ColumnValues::F32((&parts.balls.separation_angles).into())),
        column("source".into(), "index of the tangent point".into(), signed(&parts.balls.source)),
        column("touch".into(), "point q, -2 pulse, -3 limit".into(), signed(&parts.balls.touch)),
    ];
    if !parts.transmission.is_empty() {
        columns.push(column(
            "transmission".into(),
            "share of pulses that passed".into(),
            ColumnValues::F32((&parts.transmission).into()),
        ));
    }
    (cloud, columns)
}

/// A ball as the formats that hold points give it.
#[derive(Clone, Copy, Debug, Default)]
struct FileBall {
    /// In the system and unit of the file.
    center: [f64; 3],
    /// In the horizontal unit of the file.
    radius: f64,
    separation_angle: f32,
    source: u32,
    touch: u32,
    /// NaN where the file has none.
    transmission: f32,
}

/// An index that was stored as a signed number: negative numbers of 32 bits stand above 2³¹.
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
