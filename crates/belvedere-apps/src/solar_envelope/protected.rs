//! Objects that shadows must stay off: lines with a fence, faces of facades, points.

use crate::targets::TARGET_LIFT;
use belvedere_core::ground::Ground;
use belvedere_core::query::SurfacePieces;
use belvedere_data::cast::to_u32;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};

/// Maximum number of pieces of lines: every sun sweeps each over the parcel.
const MAX_PIECES: usize = 1_000_000;

/// A protected piece: a point, an edge or a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct ProtectedPiece {
    /// One, two or three corners, local metres.
    pub corners: Vec<[f64; 3]>,
    /// Outward unit normal of a face: suns behind it do not light it anyway. `None` for lines and points, which every
    /// sun lights.
    pub normal: Option<[f64; 3]>,
    /// Place at which it is tested whether something else shades the piece already, local metres.
    pub sample: [f32; 3],
    /// Number of the line, face or point that it belongs to, as the caller counts them.
    pub source: u32,
}

impl ProtectedPiece {
    /// A point.
    #[must_use]
    pub fn point(place: [f64; 3], source: u32) -> Self {
        let sample = [place[0], place[1], place[2] + TARGET_LIFT].map(to_f32);
        Self { corners: vec![place], normal: None, sample, source }
    }
}

/// Creates pieces of at most `spacing` metres of the top of a fence of `fence` metres along a line through `corners`,
/// local metres. Shadows may fall on the fence and stay below its top. If a corner has no height (NaN), the ground
/// below each piece's ends counts: the line follows the terrain. Pieces whose ground is not known are left out, and
/// their number is returned too.
///
/// # Errors
/// [`Error::InvalidParameter`] for a corner whose position in plan is not finite, a fence that is below zero or not
/// finite, and a spacing that is not above zero. Also for lines of more than a million pieces.
pub fn protected_line(
    corners: &[[f64; 3]],
    fence: f64,
    spacing: f64,
    ground: &Ground,
    source: u32,
) -> Result<(Vec<ProtectedPiece>, usize)> {
    check_fence(fence, spacing)?;
    let flat = |p: [f64; 3]| p[0].abs() < 1e7 && p[1].abs() < 1e7 && (p[2].is_nan() || p[2].abs() < 1e7);
    if let Some(corner) = corners.iter().find(|corner| !flat(**corner)) {
        let expected = "finite, within 10 000 km of the scene";
        return Err(Error::invalid(Parameter::ProtectedPlace, format!("{corner:?}"), expected));
    }
    let top = |mut place: [f64; 3]| {
        if place[2].is_nan() {
            place[2] = ground.height_at([place[0], place[1]])?;
        }
        place[2] += fence;
        Some(place)
    };
    let mut pieces = Vec::new();
    let mut unknown_count = 0;
    for pair in corners.windows(2) {
        let &[a, b] = pair else { continue };
        let count = ((b[0] - a[0]).hypot(b[1] - a[1]) / spacing).ceil().max(1.0);
        if count + pieces.len() as f64 > MAX_PIECES as f64 {
            return Err(Error::invalid(Parameter::Spacing, spacing, "enough for at most a million pieces"));
        }
        let at = |share: f64| [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
        for i in 0..to_u32(count) {
            let [from, to] = [i, i + 1].map(|i| at(f64::from(i) / count));
            match (top(from), top(to)) {
                (Some(from), Some(to)) => {
                    let mut middle = [0, 1, 2].map(|i| f64::midpoint(from[i], to[i]));
                    // off the ground, as other targets of the sun
                    middle[2] += TARGET_LIFT;
                    let corners = vec![from, to];
                    pieces.push(ProtectedPiece { corners, normal: None, sample: middle.map(to_f32), source });
                }
                _ => unknown_count += 1,
            }
        }
    }
    Ok((pieces, unknown_count))
}

/// Refuses fences that are below zero and spacings that are not above it.
pub(crate) fn check_fence(fence: f64, spacing: f64) -> Result<()> {
    if !(fence >= 0.0 && fence.is_finite()) {
        return Err(Error::invalid(Parameter::FenceHeight, fence, "0 or more metres"));
    }
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(Error::invalid(Parameter::Spacing, spacing, "above zero metres"));
    }
    Ok(())
}

/// The pieces of a surface, such as facades, each tested a little outside of itself (`lift`, metres); the source is the
/// number of the face.
#[must_use]
pub fn protected_faces(surface: &SurfacePieces, lift: f64) -> Vec<ProtectedPiece> {
    let of_piece = |piece: &belvedere_core::query::SurfacePiece| ProtectedPiece {
        corners: piece.corners.map(|corner| corner.map(f64::from)).to_vec(),
        normal: Some(piece.normal.map(f64::from)),
        sample: piece.lifted_along_normal(lift),
        source: piece.face,
    };
    surface.pieces.iter().map(of_piece).collect()
}
