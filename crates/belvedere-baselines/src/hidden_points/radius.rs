//! The radius of the sphere by Katz's rule.

use belvedere::vector::{length, sub};

use super::flip::FlippedView;

/// Exponents tried first, in halves: 0, where the sphere just holds the cloud, to 9, where all but hidden duplicates are
/// visible even for the far eye of a direction.
const LAST_HALF: u32 = 18;

/// An exponent of the radius, and how it was found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadiusChoice {
    /// γ of R = 10^γ · range of the farthest point.
    pub exponent: f64,
    /// Exponents tried, and how many points each makes visible from exactly one of the two viewpoints.
    pub tried: Vec<(f64, usize)>,
}

/// Centre and diagonal of the box around `positions`, metres.
pub(crate) fn extent(positions: &[[f32; 3]]) -> ([f64; 3], f64) {
    let (low, high) = belvedere::cloud::bounds(positions).unwrap_or_default();
    let (low, high) = (low.map(f64::from), high.map(f64::from));
    let centre = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
    (centre, length(sub(high, low)))
}

/// The exponent that makes most points visible from exactly one of `eye` and the viewpoint opposite, its image in the
/// centre of the cloud; the lower of two equals. All of the cloud is used: the best radius grows with the density of points,
/// so that a thinned cloud would find one that is too small.
///
/// # Source
/// Katz, Tal & Basri 2007, section 4: no point of a closed surface is visible from both sides. The grid is ours.
pub(crate) fn by_opposite_views(positions: &[[f32; 3]], eye: [f64; 3]) -> RadiusChoice {
    let mut choice = RadiusChoice::default();
    let mut best_count = 0;
    let mut attempt = |exponent: f64| {
        let count = seen_from_one_side(positions, eye, exponent);
        choice.tried.push((exponent, count));
        if count > best_count {
            (best_count, choice.exponent) = (count, exponent);
        }
        choice.exponent
    };
    let mut best = 0.0;
    for half in 0..=LAST_HALF {
        best = attempt(0.5 * f64::from(half));
    }
    for neighbor in [best - 0.25, best + 0.25] {
        attempt(neighbor.max(0.0));
    }
    choice
}

/// Points visible from exactly one of `eye` and its image in the centre of the cloud.
fn seen_from_one_side(positions: &[[f32; 3]], eye: [f64; 3], exponent: f64) -> usize {
    let (centre, _) = extent(positions);
    let opposite = std::array::from_fn(|i| 2.0 * centre[i] - eye[i]);
    let seen = |eye| FlippedView::new(positions, eye, exponent).corners(positions);
    let (here, there) = rayon::join(|| seen(eye), || seen(opposite));
    here.iter().zip(&there).filter(|(here, there)| here != there).count()
}
