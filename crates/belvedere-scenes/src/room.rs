//! Two furnished rooms with a door between them and one to the outside: a scene for scans from inside.

use crate::random::Random;
use crate::scene::{Material, ObjectPart, TriangleScene};
use crate::solids::{PlanPlacement, extruded};

/// Centre of the floor, metres, in the grid of the towns.
const ORIGIN: [f64; 3] = [155_000.0, 463_000.0, 0.0];
/// Height of the ceiling, metres.
const HEIGHT: f64 = 2.7;
/// Thickness of walls, floor and ceiling, metres.
const THICKNESS: f64 = 0.2;
/// Half the width of a door and its height, metres.
const DOOR: (f64, f64) = (0.45, 2.1);
/// Height and thickness of the top of a table, and side of its legs, metres.
const TABLE: (f64, f64, f64) = (0.75, 0.04, 0.06);
/// Height of the scanner above the floor, metres.
const INSTRUMENT: f64 = 1.6;

/// Sizes of the rooms, metres: west and east of the wall between them, and from south to north.
struct RoomSizes {
    west: f64,
    east: f64,
    depth: f64,
}

impl RoomSizes {
    fn new(random: &mut Random) -> Self {
        Self { west: random.between(4.5, 6.0), east: random.between(4.0, 5.0), depth: random.between(4.5, 6.0) }
    }
}

/// Returns the two rooms and the position of a scanner in each of them, (2, 3), metres, absolute. Another seed gives
/// other sizes and other furniture.
///
/// The floor is terrain, walls and cupboards are facades, the ceiling and the tops of tables are slabs. All solids are
/// closed.
pub(crate) fn furnished_rooms(seed: u64) -> (TriangleScene, [[f64; 3]; 2]) {
    let mut random = Random::new(seed, 0);
    let plan = RoomSizes::new(&mut random);
    let mut scene = TriangleScene::default();
    scene.add_object("floor", &[floor(&plan)]);
    let (door_between, door_out) = (random.between(-0.6, 0.6), random.between(-0.6, 0.6));
    let (south, north) = (-plan.depth / 2.0, plan.depth / 2.0);
    let (left, right) = (-plan.west, plan.east);
    let out = THICKNESS;
    let mut walls = vec![
        solid([left - out, right + out], [south - out, south], [-out, HEIGHT]),
        solid([left - out, right + out], [north, north + out], [-out, HEIGHT]),
        solid([right, right + out], [south, north], [-out, HEIGHT]),
    ];
    walls.extend(wall_with_door([left - out, left], [south, north], door_out));
    walls.extend(wall_with_door([-out / 2.0, out / 2.0], [south, north], door_between));
    scene.add_object("walls", &walls);
    let ceiling = solid([left - out, right + out], [south - out, north + out], [HEIGHT, HEIGHT + out]);
    scene.add_object("ceiling", &[ceiling.with_material(Material::Slab)]);
    for (name, [from, to]) in [("west", [left, -out / 2.0]), ("east", [out / 2.0, right])] {
        let middle = (from + to) / 2.0;
        let table = [middle + random.between(-0.3, 0.3), south + random.between(0.9, 1.2)];
        scene.add_object(format!("table {name}"), &table_at(table));
        // Along the north wall, which has no door.
        let width = random.between(1.2, 2.0);
        let start = random.between(from + 0.3, to - 0.3 - width);
        let height = random.between(0.8, 2.1);
        let cupboard = solid([start, start + width], [north - random.between(0.35, 0.6), north], [0.0, height]);
        scene.add_object(format!("cupboard {name}"), &[cupboard]);
    }
    let [x, y, z] = ORIGIN;
    let stations = [[-plan.west / 2.0, 0.3], [plan.east / 2.0, 0.5]];
    (scene, stations.map(|[u, v]| [x + u, y + v, z + INSTRUMENT]))
}

/// Returns a box between these coordinates east, north and up of the centre of the floor.
fn solid([west, east]: [f64; 2], [south, north]: [f64; 2], [bottom, top]: [f64; 2]) -> ObjectPart {
    let [x, y, z] = ORIGIN;
    let middle = [x + (west + east) / 2.0, y + (south + north) / 2.0];
    let footprint = PlanPlacement { origin: middle, angle: 0.0 }.rectangle(east - west, north - south);
    extruded(&footprint, z + bottom, z + top).with_material(Material::Facade)
}

/// Returns a wall from south to north with a door in it, `door` metres north of the middle.
fn wall_with_door(across: [f64; 2], [south, north]: [f64; 2], door: f64) -> [ObjectPart; 3] {
    let (half, height) = DOOR;
    [
        solid(across, [south, door - half], [-THICKNESS, HEIGHT]),
        solid(across, [door + half, north], [-THICKNESS, HEIGHT]),
        solid(across, [door - half, door + half], [height, HEIGHT]),
    ]
}

/// Returns a table of 1.4 by 0.8 m on four legs.
fn table_at([u, v]: [f64; 2]) -> [ObjectPart; 5] {
    let (top, thickness, leg) = TABLE;
    let (length, width) = (0.7, 0.4);
    let leg_at = |side: f64, end: f64| {
        let (u, v) = (u + side * (length - leg), v + end * (width - leg));
        solid([u - leg / 2.0, u + leg / 2.0], [v - leg / 2.0, v + leg / 2.0], [0.0, top - thickness])
    };
    let plate = solid([u - length, u + length], [v - width, v + width], [top - thickness, top]);
    [plate.with_material(Material::Slab), leg_at(-1.0, -1.0), leg_at(1.0, -1.0), leg_at(-1.0, 1.0), leg_at(1.0, 1.0)]
}

/// Returns the floor, a sheet.
fn floor(plan: &RoomSizes) -> ObjectPart {
    let [x, y, z] = ORIGIN;
    let mut part = ObjectPart::default();
    let (west, east, half) = (x - plan.west, x + plan.east, plan.depth / 2.0);
    part.vertices = vec![[west, y - half, z], [east, y - half, z], [east, y + half, z], [west, y + half, z]];
    part.add_polygon(&[0, 1, 2, 3], Material::Terrain);
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{QuerySite, Truth};

    #[test]
    fn rooms_are_closed_but_for_their_doors() {
        for seed in 1..6 {
            let (scene, stations) = furnished_rooms(seed);
            let truth = Truth::new(&scene);
            let (low, high) = scene.bounds().unwrap();
            let site = QuerySite { scene: &scene, truth: &truth, bounds: [low, high] };
            for station in stations {
                assert!(!site.is_inside(station), "{seed}");
                let mut open = 0;
                for i in 0_u16..3600 {
                    let (azimuth, up) =
                        (f64::from(i % 60) * std::f64::consts::TAU / 60.0, f64::from(i / 60) / 30.0 - 1.0);
                    let level = (1.0 - up * up).sqrt();
                    let hit = truth.first_hit(station, [level * azimuth.cos(), level * azimuth.sin(), up], 100.0);
                    open += usize::from(hit.is_none());
                }
                // A door of 0.9 by 2.1 m, 2 m away or more, is at most a twentieth of all directions.
                assert!(open < 180, "{seed}: {open}");
            }
        }
    }
}
