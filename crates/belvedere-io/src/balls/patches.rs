//! Surface patches in files.

use belvedere_data::patches::PatchTriangle;
use belvedere_data::vector::to_f32;
use belvedere_data::{PatchKind, SurfacePatches};

/// Begins the bytes of patches: their format.
const MAGIC: [u8; 8] = *b"patches1";
/// Bytes of a triangle: nine numbers and its kind.
const TRIANGLE_BYTES: usize = 37;
/// Bytes before the triangles: format, checksum, origin.
const HEAD_BYTES: usize = MAGIC.len() + 8 + 24;

/// Nine numbers as the corners of a triangle.
pub(super) fn in_corners(values: &[f32; 9]) -> PatchTriangle {
    std::array::from_fn(|corner| std::array::from_fn(|axis| values[3 * corner + axis]))
}

/// The kinds of codes; a message for the first code without a kind.
pub(super) fn kinds_of_codes(codes: &[u8]) -> Result<Vec<PatchKind>, String> {
    let kind = |&code: &u8| PatchKind::of_code(code).ok_or_else(|| format!("no surface patch is of kind {code}"));
    codes.iter().map(kind).collect()
}

/// Encodes the patches as bytes, for records of files that hold points. The record has the format, a checksum of all
/// that follows, the origin (three f64, metres), and for each triangle its corners (nine f32, metres relative to the
/// origin) and its kind. All are little-endian. Every bit is kept, even if another program drops the metadata.
pub(super) fn to_bytes(patches: &SurfacePatches, origin: [f64; 3]) -> Vec<u8> {
    let mut body: Vec<u8> = origin.iter().flat_map(|v| v.to_le_bytes()).collect();
    for (triangle, kind) in patches.iter() {
        body.extend(triangle.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
        body.push(kind.code());
    }
    let mut bytes = MAGIC.to_vec();
    bytes.extend(checksum(&body).to_le_bytes());
    bytes.extend(body);
    bytes
}

/// The patches of [`to_bytes`], and the origin of their coordinates; a message for damaged bytes.
pub(super) fn from_bytes(bytes: &[u8]) -> Result<(SurfacePatches, [f64; 3]), String> {
    let damaged = || "its surface patches are damaged; make the ball file again".to_owned();
    let (head, rows) = bytes.split_at_checked(HEAD_BYTES).ok_or_else(damaged)?;
    let body = &bytes[MAGIC.len() + 8..];
    let is_sound = head.starts_with(&MAGIC) && head[MAGIC.len()..].starts_with(&checksum(body).to_le_bytes());
    let (rows, rest) = rows.as_chunks::<TRIANGLE_BYTES>();
    if !is_sound || !rest.is_empty() {
        return Err(damaged());
    }
    let numbers = head[HEAD_BYTES - 24..].as_chunks::<8>().0;
    let origin = std::array::from_fn(|axis| f64::from_le_bytes(numbers[axis]));
    let corners = |row: &[u8; TRIANGLE_BYTES]| {
        let values = row.as_chunks::<4>().0;
        in_corners(&std::array::from_fn(|i| f32::from_le_bytes(values[i])))
    };
    let codes: Vec<u8> = rows.iter().map(|row| row[TRIANGLE_BYTES - 1]).collect();
    let patches = SurfacePatches { triangles: rows.iter().map(corners).collect(), kinds: kinds_of_codes(&codes)? };
    Ok((patches, origin))
}

/// FNV-1a of 64 bits (Fowler, Noll & Vo).
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Patches relative to one origin, relative to another; the same bits where both are one.
pub(super) fn moved(patches: SurfacePatches, from: [f64; 3], to: [f64; 3]) -> SurfacePatches {
    if from == to {
        return patches;
    }
    let place = |p: [f32; 3]| std::array::from_fn(|axis| to_f32(f64::from(p[axis]) + from[axis] - to[axis]));
    let triangles = patches.triangles.iter().map(|triangle| triangle.map(place)).collect();
    SurfacePatches { triangles, kinds: patches.kinds }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_of_patches_keep_every_bit_and_any_change_is_found() {
        let mut patches = SurfacePatches::default();
        patches.push([[0.1, -2.5, 3.0], [1.0 / 3.0, 1e-7, 4e5], [-0.0, 5.5, 6.25]], PatchKind::Parapet);
        patches.push([[7.0, 8.0, 9.0], [10.0, 11.0, 12.0], [13.0, 14.0, 15.5]], PatchKind::Roof);
        let origin = [85_000.125, 446_000.0, -3.5];
        let bytes = to_bytes(&patches, origin);
        let (read, place) = from_bytes(&bytes).unwrap();
        assert_eq!((&read, place), (&patches, origin));
        assert!(read.triangles[0][2][0].is_sign_negative());
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 4;
            assert!(from_bytes(&changed).is_err(), "{at}");
            assert!(from_bytes(&bytes[..at]).is_err(), "{at}");
        }
        let there = moved(patches.clone(), [10.0, 20.0, 30.0], [0.0; 3]);
        assert_eq!(there.triangles[1][0], [17.0, 28.0, 39.0]);
        assert_eq!(moved(patches.clone(), origin, origin), patches);
    }
}
