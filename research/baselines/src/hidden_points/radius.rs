//! The radius of the sphere by Katz's rule.

use belvedere::Bounds;
use belvedere::vector::{length, sub};

use super::flip::FlippedView;

/// Exponents tried first, in halves: 0, where the sphere just holds the cloud, to 9, where all but hidden duplicates
/// are visible even for the far eye of a direction.
const LAST_HALF: u32 = 18;

/// Between the best exponents for eyes in a street and above a roof in simulated towns (2 to 4).
const FALLBACK_EXPONENT: f64 = 3.0;

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
    let (low, high) = Bounds::around(positions.iter().copied()).unwrap_or_default().corners();
    let centre = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
    (centre, length(sub(high, low)))
}

/// The exponent that makes most points visible from exactly one of two opposite viewpoints; the lower of two equals.
/// All of the cloud is used: the best radius grows with the density of points, so that a thinned cloud would find one
/// that is too small. Beyond the best radius ever more points are visible from both sides, so larger ones are not tried
/// once the number has fallen by half. Where no radius distinguishes the two viewpoints, because they are the same, it
/// is [`FALLBACK_EXPONENT`].
///
/// # Source
/// Katz, Tal & Basri 2007, section 4: no point of a closed surface is visible from both sides. The grid is ours.
pub(crate) fn by_opposite_views(positions: &[[f32; 3]], viewpoints: [[f64; 3]; 2]) -> RadiusChoice {
    let mut choice = RadiusChoice { exponent: FALLBACK_EXPONENT, tried: Vec::new() };
    let mut best_count = 0;
    let mut attempt = |exponent: f64| {
        let count = seen_from_one(positions, viewpoints, exponent);
        choice.tried.push((exponent, count));
        if count > best_count {
            (best_count, choice.exponent) = (count, exponent);
        }
        (choice.exponent, 2 * count < best_count)
    };
    let mut best = 0.0;
    for half in 0..=LAST_HALF {
        let (exponent, has_fallen) = attempt(0.5 * f64::from(half));
        best = exponent;
        if has_fallen {
            break;
        }
    }
    for neighbor in [best - 0.25, best + 0.25] {
        attempt(neighbor.max(0.0));
    }
    choice
}

/// Points visible from exactly one of two viewpoints.
fn seen_from_one(positions: &[[f32; 3]], viewpoints: [[f64; 3]; 2], exponent: f64) -> usize {
    let seen = |eye| FlippedView::new(positions, eye, exponent).corners(positions);
    let (here, there) = rayon::join(|| seen(viewpoints[0]), || seen(viewpoints[1]));
    here.iter().zip(&there).filter(|(here, there)| here != there).count()
}
