//! Polygons on the map.

/// Whether a place lies within an outline and outside its holes: the rule of odd crossings over all rings, which may be
/// closed or not.
#[must_use]
pub fn is_inside(rings: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for ring in rings {
        let Some(mut previous) = ring.last() else { continue };
        for corner in ring {
            let ([ax, ay], [bx, by]) = (*previous, *corner);
            if (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) {
                inside = !inside;
            }
            previous = corner;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_and_closed_rings_are_understood() {
        let outline = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        let hole = vec![[4.0, 4.0], [6.0, 4.0], [6.0, 6.0], [4.0, 6.0]];
        let polygon = [outline, hole];
        for (place, expected) in
            [([1.0, 1.0], true), ([5.0, 5.0], false), ([5.0, 3.0], true), ([11.0, 5.0], false), ([-1.0, 4.0], false)]
        {
            assert_eq!(is_inside(&polygon, place), expected, "{place:?}");
        }
        assert!(!is_inside(&[], [0.0; 2]));
    }
}
