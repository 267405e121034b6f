//! Places midway between neighbouring points, where something is filled that its points are too sparse for.

use belvedere_data::cast::to_cell;
use rayon::slice::ParallelSliceMut;
use std::cmp::Ordering;

/// Keeps one of `rows` in each cube of this side, metres, in ascending order, whatever the order of the points. Dense
/// clouds have thousands of points within reach of each other, and more balls there fill nothing more.
pub(super) fn one_in_each_cell(positions: &[[f32; 3]], mut rows: Vec<usize>, side: f32) -> Vec<usize> {
    let cell = |row: usize| positions[row].map(|v| to_cell(f64::from(v / side)));
    let first = |a: usize, b: usize| cell(a).cmp(&cell(b)).then(by_axes(positions[a], positions[b])).then(a.cmp(&b));
    rows.par_sort_unstable_by(|&a, &b| first(a, b));
    rows.dedup_by_key(|row| cell(*row));
    // as the points were, so that balls of neighbours stay together
    rows.sort_unstable();
    rows
}

/// Returns the indices of the Gabriel neighbours of `p` (in plan) among `near` that are farther than `least` metres.
/// `share` scales the diameter of the empty circle: 1 gives the graph of Gabriel & Sokal 1969, less gives more
/// neighbours. Each pair is returned for one of its points only, whatever their order.
pub(super) fn neighbors_after(p: [f32; 3], near: &[[f32; 3]], least: f32, share: f32) -> impl Iterator<Item = usize> {
    near.iter().enumerate().filter_map(move |(number, &q)| {
        let (middle, gap) = ([(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0, 0.0], distance_in_plan(p, q));
        let has_third = || {
            near.iter()
                .enumerate()
                .any(|(third, &r)| third != number && distance_in_plan(r, middle) < share * gap / 2.0)
        };
        (gap > least && by_axes(p, q).is_lt() && !has_third()).then_some(number)
    })
}

/// Distance of two places, seen from above.
pub(super) fn distance_in_plan(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn by_axes(a: [f32; 3], b: [f32; 3]) -> Ordering {
    a.iter().zip(&b).map(|(a, b)| a.total_cmp(b)).fold(Ordering::Equal, Ordering::then)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 1, a point just off its middle, and one far away.
    const PLACES: [[f32; 3]; 6] =
        [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [1.0, 1.0, 5.1], [0.0, 1.0, 5.0], [0.5, 0.4, 5.0], [9.0, 0.5, 5.0]];

    #[test]
    fn neighbors_have_nothing_between_them_and_each_pair_is_found_once() {
        let mut pairs = Vec::new();
        for (number, &p) in PLACES.iter().enumerate() {
            let near: Vec<_> = PLACES.iter().copied().filter(|&q| q != p).collect();
            pairs.extend(
                neighbors_after(p, &near, 0.1, 1.0).map(|q| (number, PLACES.iter().position(|&r| r == near[q]))),
            );
        }
        pairs.sort_unstable();
        // the lower side has the middle in its circle, diagonals have it too
        let expected = [
            (0, Some(3)),
            (0, Some(4)),
            (1, Some(2)),
            (1, Some(5)),
            (2, Some(5)),
            (3, Some(2)),
            (3, Some(4)),
            (4, Some(1)),
            (4, Some(2)),
        ];
        assert_eq!(pairs, expected);
        assert_eq!(
            neighbors_after(PLACES[0], &PLACES[1..], 0.9, 1.0).collect::<Vec<_>>(),
            [2],
            "the one off the middle is too near"
        );
    }

    #[test]
    fn one_point_of_each_cell_stays_whatever_their_order() {
        let twice: Vec<_> = PLACES.iter().chain(&PLACES).copied().collect();
        assert_eq!(one_in_each_cell(&twice, (0..12).collect(), 0.1), [0, 1, 2, 3, 4, 5]);
        assert_eq!(one_in_each_cell(&PLACES, vec![5, 3, 0], 100.0).len(), 1);
        let kept = |rows: Vec<usize>| one_in_each_cell(&PLACES, rows, 0.7);
        assert_eq!(kept(vec![4, 0, 1, 5]), kept(vec![5, 1, 0, 4]));
    }
}
