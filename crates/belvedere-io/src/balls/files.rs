//! Ball files: scene models saved for later runs and for other programs.

use crate::balls;
use crate::files::output::Output;
use crate::files::source::{Source, unusable};
use belvedere_data::model::ModelParts;
use belvedere_data::{Error, Result};

/// Extensions of ball files.
pub(crate) const SUPPORTED: &str = ".npz .ply .laz .las";

/// Writes `balls` in the format that follows from the extension (.npz .ply .laz .las).
///
/// An `.npz` file keeps every bit. Its arrays are:
///
/// - `centers` (B, 3) f32 in metres relative to `origin` (3) f64 metres; `radii` (B) f32 metres; `source` and `touch`
///   (B) u32; `separation_angles` (B) f32 radians;
/// - `metadata`, JSON text as u8, with reference system, bounds and provenance;
/// - if known, `transmission` (B) f32;
/// - the pulses that prove visibility: `pulse_starts` (P, 3) f32 metres relative to the origin, `pulse_slopes` (P, 2)
///   i16 in steps of 0.0001, `pulse_top` (1) f32 metres;
/// - `pulse_lengths` (P) f32 metres unless all reach the top, and `pulse_ways` (P) u8 unless all go up: 16 to 21 bytes
///   for each pulse;
/// - surface patches: `patch_corners` (T, 3, 3) f32 metres relative to the origin and `patch_kinds` (T) u8 (0 roof, 1
///   wall, 2 parapet, 3 inside);
/// - buildings, all f64, metres relative to the origin, in the next four;
/// - `roof_planes` (R, 15): normal, middle, lowest and highest corner, points, noise, standard deviation;
/// - `roof_edges` (E, 10): both ends, plane, standard deviation, sides, drop;
/// - `roof_ridges` (K, 9): both ends, both planes, 1 if both fall from it;
/// - `walls` (W, 12): both ends in plan, lowest and highest height, edge, points, noise, standard deviation, share,
///   eaves.
///
/// `.ply`, `.las` and `.laz` files are point clouds of the centres in the reference system and unit of the cloud
/// (doubles in PLY, steps of at most a millimetre in LAS). Their columns are `radius`, in the horizontal unit of the
/// file, `separation_angle` in radians, `source` and `touch`, −1 for a ball that never shrank, and `transmission` if
/// known.
///
/// They are for viewing, with the radius as the size of a point, and answer as the balls alone do: they hold no pulses.
/// Surface patches are an element `patch` of PLY (corners x1, y1, z1 to z3 and `kind`). In LAS they are the record 3 of
/// the user `belvedere`, which keeps every bit.
///
/// # Errors
/// [`Error::UnknownFormat`] for other extensions, [`Error::MissingFeature`], those of [`ModelParts::validate`], and
/// [`Error::Io`]. An existing file is replaced only by a complete one.
pub fn write_balls<'a>(output: impl Into<Output<'a>>, balls: &ModelParts) -> Result<()> {
    balls.validate()?;
    let output = output.into();
    match output.extension().as_str() {
        #[cfg(feature = "npy")]
        "npz" => balls::write_npz(output, balls),
        "ply" => balls::write_ply(output, balls),
        #[cfg(feature = "las")]
        "las" | "laz" => balls::write_las(output, balls),
        _ => Err(unusable(output.name(), "ball", SUPPORTED)),
    }
}

/// The balls that [`write_balls`] wrote.
///
/// Bit for bit from `.npz`; rounded as the format demands from the others, which other programs may have filtered or
/// extended by columns since. Without a saved origin it is chosen near the middle of the centres.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::MissingFeature`], [`Error::Io`], and [`Error::Malformed`] for a file that is
/// damaged or holds no balls.
pub fn read_balls<'a>(source: impl Into<Source<'a>>) -> Result<ModelParts> {
    let source = source.into();
    let path = source.name().to_owned();
    let balls: ModelParts = match source.extension().as_str() {
        #[cfg(feature = "npy")]
        "npz" => balls::read_npz(source.open()?),
        #[cfg(feature = "ply")]
        "ply" => balls::read_ply(source.open()?),
        #[cfg(feature = "las")]
        "las" | "laz" => balls::read_las(source.open()?),
        _ => Err(unusable(&path, "ball", SUPPORTED)),
    }?;
    balls.validate().map_err(|e| Error::malformed(&path, e.to_string()))?;
    Ok(balls)
}

/// Returns true if a source holds balls and no cloud, by its header; `false` also for an unknown format. An `.npz` file
/// is never a cloud: [`read_balls`] reports its errors.
///
/// # Errors
/// [`Error::Io`] when the file cannot be opened.
pub fn is_ball_file<'a>(source: impl Into<Source<'a>>) -> Result<bool> {
    let source = source.into();
    if let Some(folder) = source.folder() {
        folder.read_dir().map_err(Error::io(folder))?;
        return Ok(false);
    }
    Ok(match source.extension().as_str() {
        #[cfg(feature = "npy")]
        "npz" => source.open().map(|_| true)?,
        #[cfg(feature = "ply")]
        "ply" => balls::ply_has_balls(source.open()?),
        #[cfg(feature = "las")]
        "las" | "laz" => balls::las_has_balls(source.open()?),
        _ => {
            source.open()?;
            false
        }
    })
}
