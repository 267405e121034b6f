//! The radius of the sphere by Katz's rule.

use super::flip::FlippedView;

/// Exponents tried, from, to and step.
pub(crate) const EXPONENTS: [f64; 3] = [0.0, 9.0, 0.5];

/// An exponent of the radius, and how it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusChoice {
    /// γ of R = 10^γ · range of the farthest point.
    pub exponent: f64,
    /// Exponents tried on the whole cloud, with the number of points visible from exactly one of the two viewpoints.
    pub tried: Vec<(f64, usize)>,
}

/// Centre and diagonal of the box around `positions`, metres.
pub(crate) fn extent(positions: &[[f32; 3]]) -> ([f64; 3], f64) {
    let (low, high) = belvedere::cloud::bounds(positions).unwrap_or_default();
    let (low, high) = (low.map(f64::from), high.map(f64::from));
    let centre = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
    (centre, belvedere::vector::length(belvedere::vector::sub(high, low)))
}

pub(crate) fn by_opposite_views(positions: &[[f32; 3]], eye: [f64; 3]) -> RadiusChoice {
    let mut tried = Vec::new();
    let [from, to, step] = EXPONENTS;
    let mut exponent = from;
    while exponent <= to {
        tried.push((exponent, seen_from_one_side(positions, eye, exponent)));
        exponent += step;
    }
    let best = tried.iter().copied().max_by_key(|&(_, count)| count).unwrap_or_default();
    RadiusChoice { exponent: best.0, tried }
}

/// Points visible from exactly one of `eye` and its image in the centre of the cloud.
pub(crate) fn seen_from_one_side(positions: &[[f32; 3]], eye: [f64; 3], exponent: f64) -> usize {
    let (centre, _) = extent(positions);
    let opposite = std::array::from_fn(|i| 2.0 * centre[i] - eye[i]);
    let seen = |eye| FlippedView::new(positions, eye, exponent).corners(positions);
    let (here, there) = rayon::join(|| seen(eye), || seen(opposite));
    here.iter().zip(&there).filter(|(here, there)| here != there).count()
}
