//! Outlines of the cells of a grid that belong together.

use belvedere_data::raster::Raster;

/// An area of cells that touch along sides: corners in columns from the west and rows from the north, first corner
/// repeated at the end. Seen on a map with north up, the exterior runs counter-clockwise and holes clockwise, as RFC
/// 7946 requires.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GridPolygon {
    /// Outer outline of the area.
    pub exterior: Vec<[usize; 2]>,
    /// Outlines of its holes.
    pub holes: Vec<Vec<[usize; 2]>>,
    /// Number of cells.
    pub cell_count: usize,
}

impl GridPolygon {
    /// Its outer outline and those of its holes with the corners at their `place`.
    pub fn rings(&self, place: impl Fn([usize; 2]) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
        std::iter::once(&self.exterior)
            .chain(&self.holes)
            .map(|ring| ring.iter().map(|&corner| place(corner)).collect())
            .collect()
    }
}

const NONE: u32 = u32::MAX;

/// The outlines of the cells that are `true`, in the order of their first cells. Cells that touch at a corner only are
/// different areas; no outline touches itself.
#[must_use]
pub fn outlines(cells: &Raster<bool>) -> Vec<GridPolygon> {
    let (width, height) = (cells.width(), cells.height());
    let (labels, counts) = labelled(cells);
    let label = |column: isize, row: isize| -> u32 {
        let inside =
            usize::try_from(column).ok().zip(usize::try_from(row).ok()).filter(|&(c, r)| c < width && r < height);
        inside.and_then(|(column, row)| labels.get(row * width + column).copied()).unwrap_or(NONE)
    };
    let mut polygons: Vec<GridPolygon> =
        counts.iter().map(|&cell_count| GridPolygon { exterior: Vec::new(), holes: Vec::new(), cell_count }).collect();
    // every outline, outer or inner, has a side that runs west along the north of a cell
    let mut walked = vec![false; width * height];
    for row in 0..height {
        for column in 0..width {
            let own = labels[row * width + column];
            let above = label(column.cast_signed(), row.cast_signed() - 1);
            if own == NONE || above != NONE || walked[row * width + column] {
                continue;
            }
            for ring in simple_rings(walk([column, row], &label, &mut walked, width)) {
                let Some(polygon) = polygons.get_mut(own as usize) else { continue };
                if doubled_area(&ring) > 0 {
                    polygon.exterior = ring;
                } else {
                    polygon.holes.push(ring);
                }
            }
        }
    }
    polygons
}

/// A number for each cell by the area it belongs to, and the number of cells of each area.
fn labelled(cells: &Raster<bool>) -> (Vec<u32>, Vec<usize>) {
    let width = cells.width();
    let values = cells.values();
    let mut labels = vec![NONE; values.len()];
    let mut counts = Vec::new();
    let mut open = Vec::new();
    for start in 0..values.len() {
        if !values[start] || labels[start] != NONE {
            continue;
        }
        let Ok(label) = u32::try_from(counts.len()) else { break };
        labels[start] = label;
        open.push(start);
        let mut count = 0;
        while let Some(cell) = open.pop() {
            count += 1;
            let column = cell % width;
            let neighbors = [
                (column > 0).then(|| cell - 1),
                (column + 1 < width).then_some(cell + 1),
                cell.checked_sub(width),
                Some(cell + width),
            ];
            for near in neighbors.into_iter().flatten() {
                if values.get(near) == Some(&true) && labels[near] == NONE {
                    labels[near] = label;
                    open.push(near);
                }
            }
        }
        counts.push(count);
    }
    (labels, counts)
}

/// Steps to the west, south, east and north: turning left on a map whose rows count southward.
const STEPS: [[isize; 2]; 4] = [[-1, 0], [0, 1], [1, 0], [0, -1]];

/// Walks around an area with its cells at the left hand, from the north-east corner of `start` westward. Returns the
/// corners at which the walk turns, without repeating the first, and marks the cells whose north sides it followed.
fn walk(start: [usize; 2], label: &impl Fn(isize, isize) -> u32, walked: &mut [bool], width: usize) -> Vec<[usize; 2]> {
    let start = [start[0].cast_signed() + 1, start[1].cast_signed()];
    let (mut corner, mut heading) = (start, 0);
    let mut corners = Vec::new();
    // the cells left and right of the side that leaves a corner in a direction
    let left = |[x, y]: [isize; 2], heading: usize| match heading {
        0 => label(x - 1, y),
        1 => label(x, y),
        2 => label(x, y - 1),
        _ => label(x - 1, y - 1),
    };
    let right = |[x, y]: [isize; 2], heading: usize| match heading {
        0 => label(x - 1, y - 1),
        1 => label(x - 1, y),
        2 => label(x, y),
        _ => label(x, y - 1),
    };
    loop {
        if heading == 0 {
            let cell = corner[1].cast_unsigned() * width + (corner[0] - 1).cast_unsigned();
            if let Some(walked) = walked.get_mut(cell) {
                *walked = true;
            }
        }
        corner = [corner[0] + STEPS[heading][0], corner[1] + STEPS[heading][1]];
        // left, straight on, right: staying with the same cell where two meet at a corner
        let next = [1, 0, 3]
            .into_iter()
            .map(|turn| (heading + turn) % 4)
            .find(|&next| left(corner, next) != NONE && right(corner, next) == NONE);
        let Some(next) = next else { break };
        if next != heading {
            corners.push(corner.map(isize::cast_unsigned));
        }
        heading = next;
        if corner == start && heading == 0 {
            break;
        }
    }
    corners
}

/// Cuts a ring that comes back to a corner into rings that do not, each closed by its first corner.
fn simple_rings(corners: Vec<[usize; 2]>) -> Vec<Vec<[usize; 2]>> {
    let mut rings = Vec::new();
    let mut open: Vec<[usize; 2]> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for corner in corners {
        if let Some(&first) = places.get(&corner) {
            let mut ring = open.split_off(first);
            for corner in &ring {
                places.remove(corner);
            }
            ring.push(corner);
            rings.push(ring);
        }
        places.insert(corner, open.len());
        open.push(corner);
    }
    if let Some(&first) = open.first() {
        open.push(first);
        rings.push(open);
    }
    rings
}

/// Twice the area within a ring, above zero where it runs counter-clockwise on a map with north up.
fn doubled_area(ring: &[[usize; 2]]) -> i64 {
    let signed = |v: usize| i64::try_from(v).unwrap_or(i64::MAX);
    ring.windows(2)
        .map(|pair| match pair {
            [a, b] => signed(b[0]) * signed(a[1]) - signed(a[0]) * signed(b[1]),
            _ => 0,
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;

    fn raster(rows: &[&str]) -> Raster<bool> {
        let values = rows.iter().flat_map(|row| row.bytes().map(|b| b == b'#')).collect();
        Raster::from_values(rows[0].len(), rows.len(), values).unwrap()
    }

    #[test]
    fn a_frame_has_a_hole_and_runs_the_right_way() {
        let polygons = outlines(&raster(&["####", "#..#", "####"]));
        assert_eq!(polygons.len(), 1);
        assert_eq!((doubled_area(&polygons[0].exterior), polygons[0].cell_count), (24, 10));
        assert_eq!(polygons[0].exterior.len(), 5);
        assert_eq!(polygons[0].holes.iter().map(|h| doubled_area(h)).collect::<Vec<_>>(), [-4]);
    }

    #[test]
    fn cells_that_touch_at_a_corner_are_two_areas_and_holes_that_do_are_two_holes() {
        assert_eq!(outlines(&raster(&["#.", ".#"])).len(), 2);
        let holes = outlines(&raster(&["####", "#.##", "##.#", "####"]));
        assert_eq!((holes.len(), holes[0].holes.len()), (1, 2));
        // a hole that touches the outer outline at a corner is still a hole
        let touching = outlines(&raster(&[".##", "#.#", "###"]));
        assert_eq!((touching.len(), touching[0].holes.len()), (1, 1));
    }

    #[test]
    fn areas_of_random_grids_add_up_and_no_ring_touches_itself() {
        for seed in 0..40 {
            let (width, height) = (19, 13);
            let share = 0.3 + 0.01 * f64::from(seed);
            let values: Vec<bool> =
                (0..width * height).map(|i| uniform(u64::from(seed as u32), i as u64) < share).collect();
            let cells = Raster::from_values(width, height, values.clone()).unwrap();
            let polygons = outlines(&cells);
            let mut total = 0;
            for polygon in &polygons {
                let own = doubled_area(&polygon.exterior);
                let holes: i64 = polygon.holes.iter().map(|hole| doubled_area(hole)).sum();
                assert!(own > 0 && holes <= 0);
                assert_eq!(own + holes, 2 * polygon.cell_count as i64);
                total += polygon.cell_count;
                for ring in std::iter::once(&polygon.exterior).chain(&polygon.holes) {
                    assert_eq!(ring.first(), ring.last());
                    let distinct: std::collections::HashSet<_> = ring.iter().collect();
                    assert_eq!(distinct.len(), ring.len() - 1);
                }
            }
            assert_eq!(total, values.iter().filter(|v| **v).count());
        }
    }
}
