//! Town under construction: taken ground, and placement of new objects.

use std::collections::HashMap;

use crate::random::Random;
use crate::scene::{ObjectPart, TriangleScene};
use crate::solids::{PlanPlacement, RidgedProfile, extruded, ridged_to};
use crate::town::buildings::RoofShape;
use crate::town::terrain::Terrain;
use crate::town::trees::{CrownMaterial, TreeShape, tree};

/// Chances of roof details, 0 to 1 for each building.
///
/// The seed decides which buildings have them. A greater chance adds buildings and changes no other. Walls, streets and
/// parked cars stay in place, as far as eaves leave room.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoofDetails {
    /// Chance of eaves of 0.3 to 0.6 m below sloped roofs, with verges of 0.2 m at gables without a neighbouring house.
    pub eaves: f64,
    /// Chance of parapets 0.25 m thick and 0.3 to 1 m high around flat roofs, except on sheds.
    pub parapets: f64,
    /// Chance of one to three boxes of 0.6 to 1.8 m, for lifts and air, on flat roofs of more than 50 m².
    pub boxes: f64,
    /// Chance of a chimney on houses that are built without one.
    pub chimneys: f64,
}

impl RoofDetails {
    /// Roofs without any of these details.
    pub const PLAIN: Self = Self { eaves: 0.0, parapets: 0.0, boxes: 0.0, chimneys: 0.0 };
}

/// Depth of solids below the lowest ground they stand on, metres.
pub(crate) const BURIED: f64 = 1.0;
/// Minimum gap between a crown and a building or another crown, metres.
const CROWN_GAP: f64 = 0.3;
/// Minimum gap between the middle of a trunk and objects that its crown may overhang, metres.
const TRUNK_GAP: f64 = 0.8;
/// Side of the cells for look-ups of taken ground, metres.
const CELL: f64 = 16.0;
/// Maximum distance from a point of taken ground that can affect it, metres: the widest crown and its gap.
const REACH: f64 = 8.0;
/// Maximum radius of a crown as a multiple of its mean radius.
const CROWN_BULGE: f64 = 1.15;

/// Maximum short side of a shed, whose flat roof has neither parapet nor boxes, metres.
const SHED_SIDE: f64 = 4.0;

/// Part of a tree that keeps its distance from taken ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clearance {
    /// The whole crown, and all other objects.
    Crown,
    /// The trunk and all other objects; crowns may overhang.
    Trunk,
}

/// Ground taken by an object: a rectangle, or a disc if its half sides are zero.
struct Taken {
    placement: PlanPlacement,
    half_sides: [f64; 2],
    margin: f64,
    clearance: Clearance,
}

impl Taken {
    /// Returns the distance from `point` to the outline, metres, negative inside.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let (sin, cos) = self.placement.angle.sin_cos();
        let (dx, dy) = (point[0] - self.placement.origin[0], point[1] - self.placement.origin[1]);
        let local = [dx * cos + dy * sin, dy * cos - dx * sin];
        let [outside_u, outside_v] = [0, 1].map(|i| (local[i].abs() - self.half_sides[i]).max(0.0));
        outside_u.hypot(outside_v) - self.margin
    }

    /// Returns half the sides of the upright box around it.
    fn half_box(&self) -> [f64; 2] {
        let (sin, cos) = self.placement.angle.sin_cos();
        let [u, v] = self.half_sides;
        [u * cos.abs() + v * sin.abs() + self.margin, u * sin.abs() + v * cos.abs() + self.margin]
    }
}

/// Taken ground by cells, so that the time to build a city grows in proportion to its area.
#[derive(Default)]
struct TakenGround {
    all: Vec<Taken>,
    cells: HashMap<[i64; 2], Vec<usize>>,
}

impl TakenGround {
    fn push(&mut self, taken: Taken) {
        let half = taken.half_box();
        // No object lies at infinity, and its cells would be without end.
        if !taken.placement.origin.iter().chain(&half).all(|v| v.is_finite()) {
            return;
        }
        let range = |axis: usize| {
            let centre = taken.placement.origin[axis];
            cell(centre - half[axis] - REACH)..=cell(centre + half[axis] + REACH)
        };
        for i in range(0) {
            for j in range(1) {
                self.cells.entry([i, j]).or_default().push(self.all.len());
            }
        }
        self.all.push(taken);
    }

    fn near(&self, point: [f64; 2]) -> impl Iterator<Item = &Taken> {
        let numbers = self.cells.get(&point.map(cell)).map_or([].as_slice(), Vec::as_slice);
        numbers.iter().filter_map(|&number| self.all.get(number))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates far outside any town")]
fn cell(coordinate: f64) -> i64 {
    (coordinate / CELL).floor() as i64
}

/// Town under construction.
pub(crate) struct TownSite {
    pub(crate) scene: TriangleScene,
    pub(crate) terrain: Terrain,
    pub(crate) random: Random,
    /// Middle and side of the upright square of ground, metres.
    pub(crate) centre: [f64; 2],
    pub(crate) extent: f64,
    pub(crate) roofs: RoofDetails,
    /// Seed of independent random numbers, so that one detail does not change others.
    pub(crate) seed: u64,
    pub(crate) crowns: CrownMaterial,
    pub(crate) tree_heights: [f64; 2],
    taken: TakenGround,
    counts: HashMap<&'static str, u32>,
    courtyards: u32,
}

impl TownSite {
    /// Creates the bare square of ground of side `extent` about `centre`.
    pub(crate) fn new(terrain: Terrain, random: Random, centre: [f64; 2], extent: f64) -> Self {
        let mut scene = TriangleScene::default();
        scene.add_object("terrain", &[terrain.mesh(extent)]);
        Self {
            scene,
            terrain,
            random,
            centre,
            extent,
            roofs: RoofDetails::PLAIN,
            seed: 0,
            crowns: CrownMaterial::Opaque,
            tree_heights: [7.0, 13.0],
            taken: TakenGround::default(),
            counts: HashMap::new(),
            courtyards: 0,
        }
    }

    pub(crate) fn ground(&self, [x, y]: [f64; 2]) -> f64 {
        self.terrain.height(x, y)
    }

    /// Returns the height at which solids over `footprint` end below the ground.
    pub(crate) fn bottom(&self, footprint: &[[f64; 2]]) -> f64 {
        self.terrain.lowest(footprint) - BURIED
    }

    /// Adds an object with a number of its own among those of its `kind`, from 1.
    pub(crate) fn add(&mut self, kind: &'static str, parts: &[ObjectPart]) {
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        self.scene.add_object(format!("{kind} {count}"), parts);
    }

    /// Returns the number of objects of a kind.
    pub(crate) fn count(&self, kind: &str) -> u32 {
        self.counts.get(kind).copied().unwrap_or(0)
    }

    /// Returns the kind of the next courtyard, 0 and 1 alternately.
    pub(crate) fn next_courtyard(&mut self) -> u32 {
        let count = self.courtyards;
        self.courtyards += 1;
        count % 2
    }

    pub(crate) fn take(&mut self, placement: PlanPlacement, length: f64, width: f64) {
        self.take_for(placement, [length, width], Clearance::Crown);
    }

    pub(crate) fn take_for(&mut self, placement: PlanPlacement, [length, width]: [f64; 2], clearance: Clearance) {
        let half_sides = [length / 2.0, width / 2.0];
        self.taken.push(Taken { placement, half_sides, margin: 0.0, clearance });
    }

    /// Returns true if a rectangle lies inside the square and `gap` metres off all taken ground. It is tested at points
    /// a metre apart, so corners of other objects may extend into it by half a metre.
    pub(crate) fn is_free(&self, placement: &PlanPlacement, [length, width]: [f64; 2], gap: f64) -> bool {
        let steps = [length, width].map(|side| crate::town::street_furniture::pieces(side, 1.0));
        let share = |step: u32, steps: u32| f64::from(step) / f64::from(steps) - 0.5;
        (0..=steps[0]).flat_map(|i| (0..=steps[1]).map(move |j| (i, j))).all(|(i, j)| {
            let point = placement.at(length * share(i, steps[0]), width * share(j, steps[1]));
            self.is_inside(point, gap) && self.taken.near(point).all(|taken| taken.distance(point) >= gap)
        })
    }

    /// Returns true if the square extends `reach` metres beyond `point` on all sides.
    fn is_inside(&self, point: [f64; 2], reach: f64) -> bool {
        [0, 1].iter().all(|&i| (point[i] - self.centre[i]).abs() + reach < self.extent / 2.0)
    }

    /// Adds a house of `length` by `width` centred on `placement`, ridge along u.
    pub(crate) fn house(&mut self, placement: PlanPlacement, size: [f64; 2], eaves: f64, roof_height: f64, hip: f64) {
        let footprint = placement.rectangle(size[0], size[1]);
        let eaves = self.ground(placement.origin) + eaves;
        let (bottom, ridge, overhang) = (self.bottom(&footprint), eaves + roof_height, self.next_overhang(true));
        let mut parts = vec![ridged_to(&footprint, hip, &RidgedProfile { bottom, eaves, ridge, overhang })];
        parts.extend(self.next_chimney(&placement, &RoofShape { length: size[0], width: size[1], eaves, ridge }));
        self.take(placement, size[0] + 2.0 * overhang.eaves, size[1] + 2.0 * overhang.eaves);
        self.add("building", &parts);
    }

    /// Adds a box of `length` by `width` centred on `placement`.
    pub(crate) fn flat_block(&mut self, placement: PlanPlacement, size: [f64; 2], height: f64) {
        let footprint = placement.rectangle(size[0], size[1]);
        let top = self.ground(placement.origin) + height;
        let mut parts = vec![extruded(&footprint, self.bottom(&footprint), top)];
        if size[0].min(size[1]) > SHED_SIDE {
            parts.extend(self.next_parapet(&footprint, top));
            parts.extend(self.next_roof_boxes(&placement, size, top));
        }
        self.take(placement, size[0], size[1]);
        self.add("building", &parts);
    }

    /// Plants a tree of a random size if its crown fits.
    pub(crate) fn plant(&mut self, point: [f64; 2]) {
        let shape = TreeShape::random(self.tree_heights, &mut self.random);
        self.plant_shaped(point, &shape);
    }

    /// Plants a tree if its crown fits.
    pub(crate) fn plant_shaped(&mut self, point: [f64; 2], shape: &TreeShape) {
        let reach = shape.crown_radius * CROWN_BULGE;
        let gap = |taken: &Taken| match taken.clearance {
            Clearance::Crown => reach + CROWN_GAP,
            Clearance::Trunk => TRUNK_GAP,
        };
        if !self.is_inside(point, reach) || self.taken.near(point).any(|t| t.distance(point) < gap(t)) {
            return;
        }
        self.taken.push(Taken {
            placement: PlanPlacement { origin: point, angle: 0.0 },
            half_sides: [0.0; 2],
            margin: reach,
            clearance: Clearance::Crown,
        });
        let foot = [point[0], point[1], self.ground(point)];
        let parts = tree(foot, shape, self.crowns, BURIED, &mut self.random);
        self.add("tree", &parts);
    }
}
