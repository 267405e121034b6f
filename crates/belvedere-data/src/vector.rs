//! Arithmetic on vectors of three numbers, f32 and f64 alike, in one fixed order so that results do not vary.

pub use crate::cast::to_f32;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

/// Compares two places by their coordinates, east first: an order of points that does not depend on their file.
#[must_use]
#[inline]
pub fn compare_places(a: &[f32; 3], b: &[f32; 3]) -> Ordering {
    // adding zero turns -0 into 0
    (0..3).map(|i| (a[i] + 0.0).total_cmp(&(b[i] + 0.0))).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// Returns the lowest and the highest corner of the box around places; infinite, turned inside out, without places.
pub fn box_around<const N: usize>(places: impl IntoIterator<Item = [f64; N]>) -> [[f64; N]; 2] {
    places.into_iter().fold([[f64::INFINITY; N], [f64::NEG_INFINITY; N]], |[low, high], place| {
        [std::array::from_fn(|i| low[i].min(place[i])), std::array::from_fn(|i| high[i].max(place[i]))]
    })
}

/// `a − b`.
#[must_use]
#[inline]
pub fn sub<T: Copy + Sub<Output = T>>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Scalar product.
#[must_use]
#[inline]
pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[must_use]
#[inline]
pub fn cross<T: Copy + Sub<Output = T> + Mul<Output = T>>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Euclidean length.
#[must_use]
#[inline]
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// `a` with length one, or `None` where it has no direction.
#[must_use]
#[inline]
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = length(a);
    (length.is_finite() && length > 0.0).then(|| a.map(|v| v / length))
}

/// The piece of a ray that lies in a box: the first and the last of the multiples of its `step` within `piece`. The box
/// is between two `sides` on each axis, as seen from where the ray starts. `None` where the ray passes beside it, and
/// for a box whose sides are in the wrong order.
#[must_use]
#[inline]
pub fn piece_in_box<const N: usize>(sides: [[f64; 2]; N], step: [f64; N], piece: [f64; 2]) -> Option<[f64; 2]> {
    let [mut from, mut to] = piece;
    for ([low, high], step) in sides.into_iter().zip(step) {
        if low > high || step == 0.0 && (low > 0.0 || high < 0.0) {
            return None;
        }
        if step != 0.0 {
            let (a, b) = (low / step, high / step);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
    }
    (from <= to).then_some([from, to])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_piece_of_a_ray_in_a_box_is_where_it_enters_and_leaves() {
        let unit = [[1.0, 2.0]; 2];
        let endless = [0.0, f64::INFINITY];
        for (step, piece, expected) in [
            ([1.0, 1.0], endless, Some([1.0, 2.0])),
            ([2.0, 1.5], endless, Some([2.0 / 3.0, 1.0])),
            ([-1.0, -1.0], endless, None),
            ([-1.0, -1.0], [f64::NEG_INFINITY, 0.0], Some([-2.0, -1.0])),
            ([1.0, 1.0], [0.0, 1.5], Some([1.0, 1.5])),
            ([1.0, 1.0], [0.0, 0.5], None),
            ([1.0, 2.0], endless, Some([1.0, 1.0])),
            ([1.0, 2.5], endless, None),
            ([1.0, 0.0], endless, None),
        ] {
            assert_eq!(piece_in_box(unit, step, piece), expected, "{step:?} {piece:?}");
        }
        assert_eq!(piece_in_box([[1.0, 2.0], [-1.0, 1.0]], [1.0, 0.0], endless), Some([1.0, 2.0]));
        assert_eq!(piece_in_box([[2.0, 1.0], [-1.0, 1.0]], [1.0, 0.0], endless), None);
    }

    #[test]
    fn a_box_holds_its_places_and_that_of_none_is_turned_inside_out() {
        assert_eq!(box_around([[1.0, 5.0], [3.0, -2.0]]), [[1.0, -2.0], [3.0, 5.0]]);
        assert_eq!(box_around::<1>([]), [[f64::INFINITY], [f64::NEG_INFINITY]]);
    }
}
