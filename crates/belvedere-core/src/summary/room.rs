//! Rooms: floor and ceiling tell which axis is up, and their distance the unit of a cloud without a reference system.

use belvedere_data::Bounds;
use belvedere_data::cast::to_index;
use belvedere_data::contradiction::{FoundContradiction, UNIT_OF_ROOM};

/// A normal is along an axis where its component is more than this: within 14°.
pub(super) const ALONG: f32 = 0.97;
/// Units of exports, metres.
const UNITS: [f64; 2] = [0.01, 0.001];

/// Thresholds for rooms. Neighbouring values were not measured.
#[derive(Clone, Copy, Debug)]
struct RoomParams {
    /// Share of the points that are cut off at either end of an axis, 0 to 0.5. Default 0.01: noise, and points seen
    /// through doors.
    trimmed: f64,
    /// Thickness of the slabs of floor and ceiling, as a share of the height, 0 to 0.5. Default 0.12: thresholds, beams
    /// and lamps.
    slab: f32,
    /// Minimum share of the level points in each slab, 0 to 0.5. Default 0.2.
    min_slab_share: f64,
    /// Minimum share of the points on level surfaces, 0 to 1. Default 0.15.
    min_level_share: f64,
    /// Minimum share of the points on walls, 0 to 1. Default 0.1.
    min_wall_share: f64,
    /// Maximum height as a share of the shorter side, if nothing but its extents shows the height. Default 0.8.
    max_height: f32,
    /// Minimum height as a share of the longer side. Default 0.04: a ceiling over a field is a town seen from far
    /// above.
    min_height: f32,
    /// Minimum and maximum height of a room, metres. Default 2.1 to 9: building rules require 2.1 m and more, and
    /// stairwells and halls have up to three storeys.
    heights: [f32; 2],
    /// Minimum length of a corridor, in heights. Default 5.
    corridor_length: f32,
    /// Maximum width of a corridor, in heights. Default 1.5.
    corridor_width: f32,
    /// Minimum ratio of points in the lower half of a room to those in the upper one, if furniture shows the floor.
    /// Default 1.05.
    min_furniture: f64,
}

const ROOM: RoomParams = RoomParams {
    trimmed: 0.01,
    slab: 0.12,
    min_slab_share: 0.2,
    min_level_share: 0.15,
    min_wall_share: 0.1,
    max_height: 0.8,
    min_height: 0.04,
    heights: [2.1, 9.0],
    corridor_length: 5.0,
    corridor_width: 1.5,
    min_furniture: 1.05,
};

/// A closed room along an axis.
struct RoomExtent {
    /// Distance from floor to ceiling, in the unit of the cloud.
    height: f32,
    /// Points above the floor in the lower half of the room for each one in the upper half.
    furniture: f64,
    /// Share of the points on level surfaces.
    level_share: f64,
}

/// Returns true if the cloud is a room with its second axis up and not its third. Floor and ceiling face along y, in
/// two slabs at its ends, and walls along the others. Objects on a floor must not indicate z.
pub(super) fn is_room_along_y(positions: &[[f32; 3]], normals: &[[f32; 3]]) -> bool {
    let Some(along_y) = room_along(1, positions, normals) else { return false };
    if !(ROOM.heights[0]..=ROOM.heights[1]).contains(&along_y.height) && unit_of(along_y.height).is_none() {
        return false;
    }
    if is_corridor(positions, along_y.height) {
        return false;
    }
    room_along(2, positions, normals).is_none_or(|along_z| {
        along_z.level_share < along_y.level_share
            && (along_z.furniture < ROOM.min_furniture || along_z.furniture < along_y.furniture)
    })
}

/// Metres in the unit of a cloud that is a room hundreds or thousands of units high; `None` where it is no room, and
/// where it may be in metres.
fn unit_of_room(positions: &[[f32; 3]], normals: &[[f32; 3]]) -> Option<f64> {
    [2, 1].into_iter().find_map(|axis| unit_of(room_along(axis, positions, normals)?.height))
}

/// Returns the contradiction between the height of a room and the unit, metres by assumption for a cloud without a
/// reference system.
pub(super) fn unit_of_room_contradiction(positions: &[[f32; 3]], normals: &[[f32; 3]]) -> Option<FoundContradiction> {
    let unit = unit_of_room(positions, normals)?;
    let name = if unit < UNITS[0] { "millimetres" } else { "centimetres" };
    let text = format!(
        "this cloud looks like a room in {name}, and was read in metres, {} times as large; give its unit: --crs 'LOCAL_CS[\"site\",UNIT[\"{name}\",{unit}]]'",
        (1.0 / unit).round()
    );
    Some(UNIT_OF_ROOM.found(text).with("metres_per_unit", unit))
}

/// Returns true if a height of the cloud can be that of a room in another unit; noise lies beyond floor and ceiling.
pub(super) fn may_be_room(Bounds { low, high }: &Bounds) -> bool {
    let may_be = |axis: usize| [1.0, 0.9].into_iter().any(|share| unit_of(share * (high[axis] - low[axis])).is_some());
    [1, 2].into_iter().any(may_be)
}

fn unit_of(height: f32) -> Option<f64> {
    UNITS.into_iter().find(|unit| {
        let metres = f64::from(height) * unit;
        (f64::from(ROOM.heights[0])..=f64::from(ROOM.heights[1])).contains(&metres)
    })
}

/// Returns true if a cloud of this height along y may be a corridor that is higher, along z, than wide.
fn is_corridor(positions: &[[f32; 3]], height: f32) -> bool {
    let Some(Bounds { low, high }) = Bounds::around(positions.iter().copied()) else { return false };
    let [x, z] = [0, 2].map(|axis: usize| high[axis] - low[axis]);
    x.max(z) > ROOM.corridor_length * height && x.min(z) < ROOM.corridor_width * height
}

/// Returns the extent of the room that closes a cloud along an axis; `None` if it is no room along it.
fn room_along(axis: usize, positions: &[[f32; 3]], normals: &[[f32; 3]]) -> Option<RoomExtent> {
    let Bounds { low, high } = Bounds::around(positions.iter().copied())?;
    let others = [(axis + 1) % 3, (axis + 2) % 3];
    let sides = others.map(|other| high[other] - low[other]);
    let mut heights: Vec<f32> = positions.iter().map(|p| p[axis]).collect();
    let at = |share: f64| to_index((heights.len() - 1) as f64 * share);
    let [first, last] = [at(ROOM.trimmed), at(1.0 - ROOM.trimmed)];
    let floor = *heights.select_nth_unstable_by(first, f32::total_cmp).1;
    let ceiling = *heights.select_nth_unstable_by(last, f32::total_cmp).1;
    let height = ceiling - floor;
    if !(height > 0.0
        && height <= ROOM.max_height * sides[0].min(sides[1])
        && height >= ROOM.min_height * sides[0].max(sides[1]))
    {
        return None;
    }
    let (mut level, mut walls, mut slabs, mut halves) = (0_usize, [0_usize; 2], [0_usize; 2], [0_usize; 2]);
    for (p, n) in positions.iter().zip(normals) {
        let part = (p[axis] - floor) / height;
        let is_level = n[axis].abs() > ALONG;
        level += usize::from(is_level);
        for (count, other) in walls.iter_mut().zip(others) {
            *count += usize::from(n[other].abs() > ALONG);
        }
        match part {
            _ if part < ROOM.slab => slabs[0] += usize::from(is_level),
            _ if part > 1.0 - ROOM.slab => slabs[1] += usize::from(is_level),
            _ if part < 0.5 => halves[0] += 1,
            _ => halves[1] += 1,
        }
    }
    let count = positions.len() as f64;
    let is_closed = slabs.into_iter().all(|slab| slab as f64 >= ROOM.min_slab_share * level as f64);
    let has_walls = walls.into_iter().map(|wall| wall as f64).sum::<f64>() >= ROOM.min_wall_share * count;
    let level_share = level as f64 / count;
    let furniture = halves[0] as f64 / halves[1].max(1) as f64;
    (is_closed && has_walls && level_share >= ROOM.min_level_share).then_some(RoomExtent {
        height,
        furniture,
        level_share,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    /// Points and normals of the inside of a box with the given sides, z up, on all faces alike for each square metre,
    /// and of a table on its floor.
    fn room([width, depth, height]: [f32; 3], with_table: bool) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
        let areas = [width * depth, width * depth, width * height, width * height, depth * height, depth * height];
        let mut points = (Vec::new(), Vec::new());
        for (face, area) in (0_u64..).zip(areas) {
            for i in 0..to_index(f64::from(100.0 * area)) as u64 {
                let [a, b] = [2 * face, 2 * face + 1].map(|seed| to_f32(uniform(seed, i)));
                let (p, n) = match face {
                    0 => ([width * a, depth * b, 0.0], [0.0, 0.0, 1.0]),
                    1 => ([width * a, depth * b, height], [0.0, 0.0, -1.0]),
                    2 => ([width * a, 0.0, height * b], [0.0, 1.0, 0.0]),
                    3 => ([width * a, depth, height * b], [0.0, -1.0, 0.0]),
                    4 => ([0.0, depth * a, height * b], [1.0, 0.0, 0.0]),
                    _ => ([width, depth * a, height * b], [-1.0, 0.0, 0.0]),
                };
                points.0.push(p);
                points.1.push(n);
            }
        }
        for i in (0..2000).filter(|_| with_table) {
            let [a, b] = [20, 21].map(|seed| to_f32(uniform(seed, i)));
            points.0.push([0.3 * width + a, 0.3 * depth + 0.8 * b, 0.75]);
            points.1.push([0.0, 0.0, 1.0]);
        }
        points
    }

    fn turned([x, y, z]: [f32; 3]) -> [f32; 3] {
        [x, z, -y]
    }

    const ROOMS: [[f32; 3]; 5] =
        [[6.0, 4.0, 3.0], [9.0, 7.0, 2.6], [14.0, 6.0, 3.2], [5.0, 3.6, 2.5], [30.0, 18.0, 6.0]];

    #[test]
    fn floor_and_ceiling_tell_which_axis_of_a_room_is_up() {
        for sides in ROOMS {
            for with_table in [false, true] {
                let (points, normals) = room(sides, with_table);
                assert!(!is_room_along_y(&points, &normals), "{sides:?}");
                let [on_side, normals_on_side] =
                    [&points, &normals].map(|all| all.iter().map(|&p| turned(p)).collect::<Vec<_>>());
                assert!(is_room_along_y(&on_side, &normals_on_side), "{sides:?} {with_table}");
            }
        }
        // corridors are higher than wide
        for sides in [[20.0, 1.8, 2.6], [25.0, 2.4, 3.4], [12.0, 2.0, 2.4]] {
            let (points, normals) = room(sides, true);
            assert!(!is_room_along_y(&points, &normals), "{sides:?}");
        }
    }

    #[test]
    fn the_height_of_a_room_tells_its_unit() {
        for sides in ROOMS {
            let (points, normals) = room(sides, true);
            assert_eq!(unit_of_room(&points, &normals), None, "{sides:?}");
            for (scale, unit) in [(1000.0, 0.001), (100.0, 0.01)] {
                let scaled: Vec<[f32; 3]> = points.iter().map(|p| p.map(|v| scale * v)).collect();
                assert_eq!(unit_of_room(&scaled, &normals), Some(unit), "{sides:?}");
            }
        }
    }
}
