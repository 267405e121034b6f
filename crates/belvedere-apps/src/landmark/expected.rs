//! Expected visible part of a landmark.

use super::view::{LandmarkParams, LandmarkView, NEAREST};
use belvedere_core::query::{MedialScene, SurfacePieces, Viewer};
use belvedere_core::ray_index::Ray;
use belvedere_data::vector::{length, sub};

/// Pieces whose probability is computed. It differs from the answer for some; of 64 the mean difference is known to
/// about 2 points.
const SAMPLE: usize = 64;

/// The expected area that an eye sees, m²: the unblocked area in its `view`, corrected by the difference of
/// probabilities from it on pieces at even steps. `None` for a scene without pulses.
pub(super) fn area(
    scene: &MedialScene,
    landmark: &SurfacePieces,
    eye: [f64; 3],
    params: &LandmarkParams,
    view: &LandmarkView,
) -> Option<f64> {
    let place = |row: usize| landmark.pieces[row].lifted(Viewer::Eye(eye), params.faces.lift).map(f64::from);
    let counts = |row: &usize| {
        let range = length(sub(place(*row), eye));
        params.can_be_seen(landmark, &landmark.pieces[*row], eye) && range <= params.max_range && range > NEAREST
    };
    let rows: Vec<usize> = (0..landmark.pieces.len()).filter(counts).collect();
    let area = |row: usize| f64::from(landmark.pieces[row].area);
    let step = rows.len().div_ceil(SAMPLE).max(1);
    let (mut looked_at, mut more) = (0.0, 0.0);
    for &row in rows.iter().skip(step / 2).step_by(step) {
        let Ray { origin, direction, ranges: [_, range] } = Ray::between(eye, place(row))?;
        let evidence = scene.evidence(origin, direction, range)?;
        let answer = if evidence.lines.is_free { 1.0 } else { 0.0 };
        more += area(row) * (f64::from(evidence.probability()) - answer);
        looked_at += area(row);
    }
    let all: f64 = rows.iter().map(|&row| area(row)).sum();
    let free = view.visible_area + view.unproven_area;
    Some(if looked_at > 0.0 { (free + more * all / looked_at).clamp(0.0, all) } else { 0.0 })
}
