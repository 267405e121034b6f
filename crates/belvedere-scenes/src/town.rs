//! A small town: streets, blocks of houses, a tower and trees on undulating ground.

use std::f64::consts::FRAC_PI_2;

use crate::random::Random;
use crate::scene::{Part, Scene};
use crate::solids::{Placement, extruded, l_shaped_ridged, ridged};
use crate::terrain::Terrain;
use crate::trees::{TreeShape, tree};

/// What [`town`] builds.
#[derive(Clone, Debug, PartialEq)]
pub struct TownParams {
    /// Side of the square of ground, metres, 100 to 5000; smaller values count as 100, since a town has at least two by two
    /// blocks. Default 120: a scan of it stays near 200 000 points.
    pub extent: f64,
    /// Any number; another one gives another town. Default 1.
    pub seed: u64,
    /// Centre of the town in the projected frame, and height of the ground there before hills, metres. Default
    /// (155 000, 463 000, 0): the middle of the Dutch grid (EPSG:28992, with heights EPSG:7415), so that code that squeezes
    /// grid coordinates into f32 shows itself.
    pub origin: [f64; 3],
    /// Rise of the ground, metres per metre, 0 to 0.1. Default 0.03: 3.6 m across the town, clearly not a plane z = 0.
    pub slope: f64,
    /// Height of the hills above and below the inclined plane, metres, 0 to 5. Default 1.2.
    pub hill_height: f64,
    /// Direction of the streets, radians counter-clockwise from east, 0 to π/4. Default 0.14: walls that run along the rows
    /// of a raster flatter every raster method.
    pub street_angle: f64,
    /// Width of the streets between the blocks, metres, 4 to 12: wider ones would push the houses of the smallest town into
    /// each other. Default 9.
    pub street_width: f64,
}

impl Default for TownParams {
    fn default() -> Self {
        Self {
            extent: 120.0,
            seed: 1,
            origin: [155_000.0, 463_000.0, 0.0],
            slope: 0.03,
            hill_height: 1.2,
            street_angle: 0.14,
            street_width: 9.0,
        }
    }
}

impl TownParams {
    /// The ground of the town as a formula.
    #[must_use]
    pub fn terrain(&self) -> Terrain {
        Terrain::new(self.origin, self.slope, self.hill_height, self.seed)
    }
}

/// Least side of the ground, metres.
const MIN_EXTENT: f64 = 100.0;
/// Least distance between block centres, metres, where there are more than two by two.
const BLOCK_PITCH: f64 = 52.0;
/// Half the side of the square within a block that the block plans are drawn for, metres.
const PLAN_HALF_SIDE: f64 = 20.0;
/// Ground kept free of buildings at the rim, metres.
const RIM: f64 = 4.0;
/// How far solids reach below the lowest ground they stand on, metres.
const BURIED: f64 = 1.0;
/// Least gap between a crown and a building or another crown, metres.
const CROWN_GAP: f64 = 0.3;
/// Ground per tree that is tried in gardens, m²: about half of the tries find room.
const AREA_PER_GARDEN_TREE: f64 = 130.0;
/// Distance between street trees, metres.
const STREET_TREE_SPACING: f64 = 11.0;

/// Builds a town: blocks of terraced houses, L-shaped buildings (one gabled, one flat), a tower with a hall, and detached
/// houses with gables and hips, with gardens, street trees and bare streets between them.
///
/// The first four blocks are one of each kind, so that the smallest town has all. Object 0 is the terrain, then come
/// `building 1`… and `tree 1`…; coordinates are absolute.
#[must_use]
pub fn town(params: &TownParams) -> Scene {
    let extent = params.extent.max(MIN_EXTENT);
    let mut site = Site {
        scene: Scene::default(),
        terrain: params.terrain(),
        random: Random::new(params.seed, 0),
        taken: Vec::new(),
        building_count: 0,
        tree_count: 0,
    };
    site.scene.add_object("terrain", &[site.terrain.mesh(extent)]);

    let centre = Placement { origin: [params.origin[0], params.origin[1]], angle: params.street_angle };
    // The turned grid of blocks has to fit into the upright square.
    let (sin, cos) = params.street_angle.sin_cos();
    let side = (extent - 2.0 * RIM) / (sin.abs() + cos.abs());
    let blocks_across = ((side + params.street_width) / BLOCK_PITCH).floor().max(2.0);
    let pitch = (side + params.street_width) / blocks_across;
    let block_side = pitch - params.street_width;

    let positions = centred_steps(blocks_across, pitch);
    let blocks = positions.iter().flat_map(|&v| positions.iter().map(move |&u| (u, v)));
    for (number, (u, v)) in blocks.enumerate() {
        let plan = Plan { centre: centre.moved(u, v, 0.0), scale: block_side / 2.0 / PLAN_HALF_SIDE };
        let kind = if number < 4 { number } else { (site.random.next_u64() % 4) as usize };
        match kind {
            0 => site.terraces(&plan),
            1 => site.l_shapes(&plan),
            2 => site.tower_and_hall(&plan),
            _ => site.detached_houses(&plan),
        }
    }
    // After the houses, so that trees give way to them; gardens last, so that they leave the streets free.
    let streets: Vec<f64> = positions.iter().skip(1).map(|&block| block - pitch / 2.0).collect();
    site.street_trees(&centre, &streets, side, extent);
    for &street in &streets {
        site.take(centre.moved(0.0, street, 0.0), side, params.street_width);
        site.take(centre.moved(street, 0.0, 0.0), params.street_width, side);
    }
    site.garden_trees(centre.origin, extent);
    site.scene
}

/// `count` positions `step` apart, symmetric about 0.
fn centred_steps(count: f64, step: f64) -> Vec<f64> {
    let first = -step * (count - 1.0) / 2.0;
    std::iter::successors(Some(first), |previous| Some(previous + step))
        .take_while(|p| *p < -first + step / 2.0)
        .collect()
}

/// The square that a block plan is drawn in: ±[`PLAN_HALF_SIDE`] in plan metres, stretched by `scale` to the block.
struct Plan {
    centre: Placement,
    scale: f64,
}

impl Plan {
    /// Placement at plan position (u, v), turned by `angle`. Only positions stretch, buildings keep their size.
    fn at(&self, u: f64, v: f64, angle: f64) -> Placement {
        self.centre.moved(u * self.scale, v * self.scale, angle)
    }
}

/// Ground that something stands on already: a rectangle, or a disc where its half sides are zero.
struct Taken {
    placement: Placement,
    half_sides: [f64; 2],
    margin: f64,
}

impl Taken {
    /// Distance from `point` to the rim, metres, negative inside.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let (sin, cos) = self.placement.angle.sin_cos();
        let (dx, dy) = (point[0] - self.placement.origin[0], point[1] - self.placement.origin[1]);
        let local = [dx * cos + dy * sin, dy * cos - dx * sin];
        let [outside_u, outside_v] = [0, 1].map(|i| (local[i].abs() - self.half_sides[i]).max(0.0));
        outside_u.hypot(outside_v) - self.margin
    }
}

/// A town under construction.
struct Site {
    scene: Scene,
    terrain: Terrain,
    random: Random,
    taken: Vec<Taken>,
    building_count: u32,
    tree_count: u32,
}

impl Site {
    fn ground(&self, [x, y]: [f64; 2]) -> f64 {
        self.terrain.height(x, y)
    }

    fn bottom(&self, footprint: &[[f64; 2]]) -> f64 {
        self.terrain.lowest(footprint) - BURIED
    }

    fn add_building(&mut self, parts: &[Part]) {
        self.building_count += 1;
        self.scene.add_object(format!("building {}", self.building_count), parts);
    }

    fn take(&mut self, placement: Placement, length: f64, width: f64) {
        self.taken.push(Taken { placement, half_sides: [length / 2.0, width / 2.0], margin: 0.0 });
    }

    /// House of `length` by `width` centred on `placement`, ridge along u.
    fn house(&mut self, placement: Placement, [length, width]: [f64; 2], eaves: f64, roof_height: f64, hip: f64) {
        let footprint = placement.rectangle(length, width);
        let ground = self.ground(placement.origin);
        let part = ridged(&footprint, self.bottom(&footprint), ground + eaves, ground + eaves + roof_height, hip);
        self.take(placement, length, width);
        self.add_building(&[part]);
    }

    /// Box of `length` by `width` centred on `placement`.
    fn flat_block(&mut self, placement: Placement, [length, width]: [f64; 2], height: f64) {
        let footprint = placement.rectangle(length, width);
        let part = extruded(&footprint, self.bottom(&footprint), self.ground(placement.origin) + height);
        self.take(placement, length, width);
        self.add_building(&[part]);
    }

    /// Two rows of terraced houses with sheds in the gardens between them.
    fn terraces(&mut self, plan: &Plan) {
        for (v, angle) in [(-14.5, 0.0), (14.5, 2.0 * FRAC_PI_2)] {
            for u in [-10.5, 10.5] {
                let eaves = self.random.between(5.2, 6.4);
                self.house(plan.at(u, v, angle), [17.5, 9.0], eaves, 4.0, 0.0);
            }
        }
        for u in [-15.0, -5.0, 5.0, 15.0] {
            let v = if self.random.chance(0.5) { -2.5 } else { 2.5 };
            self.flat_block(plan.at(u, v, 0.0), [3.2, 2.4], 2.4);
        }
    }

    /// A gabled and a flat-roofed L about a courtyard.
    fn l_shapes(&mut self, plan: &Plan) {
        let turn = if self.random.chance(0.5) { 0.0 } else { 2.0 * FRAC_PI_2 };
        let turned = Plan { centre: plan.centre.moved(0.0, 0.0, turn), scale: plan.scale };

        let (corner, lengths, width) = (turned.at(-18.0, -18.0, 0.0), [33.0, 29.0], 9.5);
        let footprint = corner.l_shape(lengths[0], lengths[1], width);
        let eaves = self.ground(corner.at(width, width)) + self.random.between(7.0, 9.0);
        self.take_l_shape(&corner, lengths, width);
        let part = l_shaped_ridged(&corner, lengths, width, self.bottom(&footprint), eaves, eaves + 4.5);
        self.add_building(&[part]);

        let (corner, lengths, width) = (turned.at(18.0, 18.0, 2.0 * FRAC_PI_2), [21.0, 19.0], 8.0);
        let footprint = corner.l_shape(lengths[0], lengths[1], width);
        let top = self.ground(corner.at(width, width)) + self.random.between(9.0, 12.0);
        self.take_l_shape(&corner, lengths, width);
        self.add_building(&[extruded(&footprint, self.bottom(&footprint), top)]);
    }

    fn take_l_shape(&mut self, corner: &Placement, [length_u, length_v]: [f64; 2], width: f64) {
        self.take(corner.moved(length_u / 2.0, width / 2.0, 0.0), length_u, width);
        self.take(corner.moved(width / 2.0, length_v / 2.0, 0.0), width, length_v);
    }

    /// A tower with a machine room on its roof, a hall with a flat roof and one with a ridge.
    fn tower_and_hall(&mut self, plan: &Plan) {
        let placement = plan.at(-9.0, 8.0, 0.0);
        let footprint = placement.rectangle(13.0, 13.0);
        let top = self.ground(placement.origin) + self.random.between(34.0, 40.0);
        let tower = extruded(&footprint, self.bottom(&footprint), top);
        // Sunk into the roof: a solid that only touches another would leave the scanner a seam to look into.
        let room = extruded(&placement.moved(1.5, -1.0, 0.0).rectangle(5.0, 4.0), top - 0.5, top + 3.0);
        self.take(placement, 13.0, 13.0);
        self.add_building(&[tower, room]);
        self.flat_block(plan.at(10.0, 9.0, 0.0), [14.0, 11.0], 5.5);
        self.house(plan.at(-3.0, -13.0, 0.0), [24.0, 10.0], 4.5, 3.0, 0.0);
    }

    /// Six detached houses, each turned a little from the street, with gables or hips.
    fn detached_houses(&mut self, plan: &Plan) {
        for (number, (u, v)) in [-13.5, 0.0, 13.5].iter().flat_map(|&u| [(u, -12.0), (u, 12.0)]).enumerate() {
            let quarter = if self.random.chance(0.5) { 0.0 } else { FRAC_PI_2 };
            let angle = quarter + self.random.between(-0.08, 0.08);
            let size = [self.random.between(9.0, 10.5), self.random.between(7.0, 8.5)];
            let eaves = self.random.between(3.0, 5.8);
            let roof_height = self.random.between(2.6, 4.2);
            let hip = if number % 3 == 1 { size[1] / 2.0 } else { 0.0 };
            self.house(plan.at(u, v, angle), size, eaves, roof_height, hip);
        }
    }

    /// A row of trees along the middle of each street between the blocks, `streets` away from the centre.
    fn street_trees(&mut self, centre: &Placement, streets: &[f64], side: f64, extent: f64) {
        for &street in streets {
            let mut along = -side / 2.0 + STREET_TREE_SPACING / 2.0;
            while along < side / 2.0 {
                let shift = self.random.between(-0.8, 0.8);
                self.plant(centre.at(street, along + shift), centre.origin, extent);
                self.plant(centre.at(along + shift, street), centre.origin, extent);
                along += STREET_TREE_SPACING;
            }
        }
    }

    /// Trees at random places that are free: in gardens, courtyards and the green belt about the town.
    fn garden_trees(&mut self, centre: [f64; 2], extent: f64) {
        let mut area_left = extent * extent;
        while area_left > 0.0 {
            let point = centre.map(|c| c + self.random.between(-extent / 2.0, extent / 2.0));
            self.plant(point, centre, extent);
            area_left -= AREA_PER_GARDEN_TREE;
        }
    }

    /// Plants a tree where its crown fits.
    fn plant(&mut self, point: [f64; 2], centre: [f64; 2], extent: f64) {
        let shape = TreeShape::random(&mut self.random);
        // A crown bulges beyond its mean radius.
        let reach = shape.crown_radius * 1.15;
        let inside = [0, 1].iter().all(|&i| (point[i] - centre[i]).abs() + reach < extent / 2.0);
        if !inside || self.taken.iter().any(|t| t.distance(point) < reach + CROWN_GAP) {
            return;
        }
        self.taken.push(Taken {
            placement: Placement { origin: point, angle: 0.0 },
            half_sides: [0.0; 2],
            margin: reach,
        });
        let foot = [point[0], point[1], self.ground(point)];
        let parts = tree(foot, &shape, BURIED, &mut self.random);
        self.tree_count += 1;
        self.scene.add_object(format!("tree {}", self.tree_count), &parts);
    }
}
