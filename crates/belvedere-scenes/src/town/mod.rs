//! Town from a short description: streets, blocks of buildings and trees on undulating ground.

pub(crate) mod buildings;
pub(crate) mod open_blocks;
pub(crate) mod plain_blocks;
pub(crate) mod plan;
pub(crate) mod preset;
pub(crate) mod roofs;
pub(crate) mod row_blocks;
pub(crate) mod site;
pub(crate) mod street_furniture;
pub(crate) mod streets;
pub(crate) mod terrain;
pub(crate) mod trees;

use std::f64::consts::FRAC_PI_4;

use crate::random::Random;
use crate::scene::TriangleScene;
use crate::town::plan::{BlockRectangle, TownLayout};
use crate::town::site::RoofDetails;
use crate::town::site::{Clearance, TownSite};
use crate::town::terrain::Terrain;
use crate::town::trees::CrownMaterial;

/// Number of lanes that fit across a street.
const LANES_ACROSS: f64 = 4.5;

/// Kind of a block in a town.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BlockPlan {
    /// Two rows of plain terraced houses with sheds in the gardens between them.
    Terraces,
    /// Two plain L-shaped buildings, one gabled and one flat, about a courtyard.
    LShapes,
    /// A plain tower with a machine room on its roof, a hall with a flat roof and one with a ridge.
    TowerAndHall,
    /// Six plain detached houses with gables and hips.
    DetachedHouses,
    /// Two rows of houses that share party walls, with different eaves, chimneys, dormers, and balconies over fenced
    /// gardens.
    RowHouses,
    /// Houses that share party walls on all four sides of a courtyard, some over arcades.
    Perimeter,
    /// Alternately one building around a courtyard, and a U-shaped one about a court with a canopy and balconies.
    Courtyard,
    /// Two high-rise buildings with balconies, joined by a deck on posts, and a car park.
    HighRise,
    /// A square with a church, houses over arcades, a market hall without walls, stalls, masts and wires.
    Square,
    /// A petrol station: a canopy over open ground, a shop, cars.
    PetrolStation,
    /// Four detached houses with chimneys and dormers in fenced gardens, a car in front.
    Gardens,
    /// A lawn with a pavilion and a lookout platform, and low fences around it.
    Lawn,
}

/// Place of the trees of streets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StreetTrees {
    /// Along the middle of each street.
    Middle,
    /// Small trees in line with the parked cars.
    Kerb,
    /// No trees in streets.
    Without,
}

/// Parameters of [`town`]. Values out of range count as the nearest value within.
#[derive(Clone, Debug, PartialEq)]
pub struct TownParams {
    /// Side of the square of ground, metres, 60 to 5000. Below 100 there is one block, from there on at least two by
    /// two. Default 120: a scan of it stays near 200 000 points.
    pub extent: f64,
    /// Seed of the town, any number. Default 1.
    pub seed: u64,
    /// Centre of the town in the projected frame, and height of the ground there without hills, metres. Default (155
    /// 000, 463 000, 0), the middle of the Dutch grid (EPSG:28992, with heights EPSG:7415). Code that squeezes grid
    /// coordinates into f32 then fails visibly.
    pub origin: [f64; 3],
    /// Slope of the ground, metres per metre, 0 to 0.1. Default 0.03: 3.6 m across the town, clearly not a plane z = 0.
    pub slope: f64,
    /// Height of the hills above and below the inclined plane, metres, 0 to 5. Default 1.2.
    pub hill_height: f64,
    /// Depth of a dry canal through the middle of the town, crossed by bridges, metres, 0 (none) to 3. It needs two
    /// rows of blocks that stay 33 m deep beside it, or it is left out. Default 0.
    pub canal_depth: f64,
    /// Direction of the streets, radians counter-clockwise from east, 0 to π/4. Default 0.14, because walls along the
    /// rows of a raster flatter every raster method.
    pub street_angle: f64,
    /// Width of the streets between the blocks, metres, 4 to 12. Wider ones would push the houses of the smallest town
    /// into each other. Default 9.
    pub street_width: f64,
    /// Minimum distance between the middles of blocks, metres, 44 to 80; blocks share the remaining space. Default 52.
    pub block_pitch: f64,
    /// Kinds of blocks with their relative frequencies. The first blocks are one of each, in this order. Without any,
    /// the ground stays open. Default: terraces, L-shapes, tower and hall, detached houses, equally often.
    pub blocks: Vec<(BlockPlan, u32)>,
    /// Shares of roofs with eaves, parapets, boxes and chimneys. Default [`RoofDetails::PLAIN`].
    pub roofs: RoofDetails,
    /// Material of crowns. Default opaque.
    pub crowns: CrownMaterial,
    /// Heights of the lowest and the highest tree, metres, 3 to 22. Default 7 to 13.
    pub tree_heights: [f64; 2],
    /// Ground per attempt to plant a tree in gardens, courts and around the town, m², 20 or more. At most half of the
    /// attempts find room. Default 130.
    pub area_per_garden_tree: f64,
    /// Place of the trees of streets. Default in the middle.
    pub street_trees: StreetTrees,
    /// Share of the room for parked cars, masts with wires and bus stops in streets that is used, 0 to 1. Default 0.
    pub street_furniture: f64,
}

impl Default for TownParams {
    fn default() -> Self {
        Self {
            extent: 120.0,
            seed: 1,
            origin: [155_000.0, 463_000.0, 0.0],
            slope: 0.03,
            hill_height: 1.2,
            canal_depth: 0.0,
            street_angle: 0.14,
            street_width: 9.0,
            block_pitch: 52.0,
            blocks: vec![
                (BlockPlan::Terraces, 1),
                (BlockPlan::LShapes, 1),
                (BlockPlan::TowerAndHall, 1),
                (BlockPlan::DetachedHouses, 1),
            ],
            roofs: RoofDetails::PLAIN,
            crowns: CrownMaterial::Opaque,
            tree_heights: [7.0, 13.0],
            area_per_garden_tree: 130.0,
            street_trees: StreetTrees::Middle,
            street_furniture: 0.0,
        }
    }
}

impl TownParams {
    /// Returns the ground of the town as a formula.
    #[must_use]
    pub fn terrain(&self) -> Terrain {
        Terrain::new(self.origin, self.slope, self.hill_height, self.seed)
            .with_canal(TownLayout::new(&self.within_limits()).trench())
    }

    /// Returns a lane along each street between the blocks, from one end of the town to the other, (R, 2, 2), metres,
    /// absolute. Lanes lie beside the trees and clear of parked cars and masts.
    #[must_use]
    pub fn lanes(&self) -> Vec<[[f64; 2]; 2]> {
        let params = self.within_limits();
        let layout = TownLayout::new(&params);
        let (half, beside) = (layout.side / 2.0, params.street_width / LANES_ACROSS);
        let along_u = layout.streets_along_u.iter().map(|v| [-half, half].map(|u| layout.centre.at(u, v + beside)));
        // For streets along v, a lane further left has a lower u.
        let along_v = layout.streets_along_v.iter().map(|u| [-half, half].map(|v| layout.centre.at(u - beside, v)));
        along_u.chain(along_v).collect()
    }

    /// Returns the description with all parameters of the plan within the limits that can be built.
    fn within_limits(&self) -> Self {
        Self {
            extent: within(self.extent, [60.0, 5000.0]),
            canal_depth: within(self.canal_depth, [0.0, 3.0]),
            street_angle: within(self.street_angle, [0.0, FRAC_PI_4]),
            street_width: within(self.street_width, [4.0, 12.0]),
            block_pitch: within(self.block_pitch, [44.0, 80.0]),
            tree_heights: self.tree_heights.map(|height| within(height, [3.0, 22.0])),
            area_per_garden_tree: within(self.area_per_garden_tree, [20.0, f64::INFINITY]),
            street_furniture: within(self.street_furniture, [0.0, 1.0]),
            ..self.clone()
        }
    }
}

/// Returns the nearest value between the two; the lower one for NaN.
fn within(value: f64, [low, high]: [f64; 2]) -> f64 {
    if value > low { value.min(high) } else { low }
}

/// Builds a town of the described blocks, with trees in gardens and streets, and furniture in the streets.
///
/// Object 0 is the terrain. The other names are `building 1`…, `tree 1`…, `deck 1`…, `canopy 1`…, `bridge 1`…, `fence
/// 1`…, `mast 1`…, `wire 1`… and `car 1`…. The objects are in the order of building. Coordinates are absolute. The same
/// parameters give the same town.
#[must_use]
pub fn town(params: &TownParams) -> TriangleScene {
    let params = &params.within_limits();
    let layout = TownLayout::new(params);
    let centre = layout.centre;
    let mut site = TownSite::new(params.terrain(), Random::new(params.seed, 0), centre.origin, layout.extent);
    site.roofs = params.roofs;
    site.seed = params.seed;
    site.crowns = params.crowns;
    site.tree_heights = params.tree_heights;

    for (number, plan) in layout.plans().iter().enumerate() {
        if let Some(kind) = choose(&params.blocks, number, &mut site.random) {
            site.build(kind, plan);
        }
    }
    if let Some((placement, size)) = layout.canal_ground() {
        site.take_for(placement, size, Clearance::Trunk);
        site.bridges(&layout.bridges(), params.street_width);
    }
    site.furnish_streets(&layout, params);
    // After the houses, so that trees give way to them; gardens last, so that they leave the streets free.
    if params.street_trees == StreetTrees::Middle {
        site.street_trees(&layout);
    }
    for &v in &layout.streets_along_u {
        site.take(centre.moved(0.0, v, 0.0), layout.side, params.street_width);
    }
    for &u in &layout.streets_along_v {
        site.take(centre.moved(u, 0.0, 0.0), params.street_width, layout.side);
    }
    site.garden_trees(params.area_per_garden_tree);
    site.scene
}

/// Returns the kind of block number `number`: one of each first, then at random by weight.
fn choose(blocks: &[(BlockPlan, u32)], number: usize, random: &mut Random) -> Option<BlockPlan> {
    if let Some(&(kind, _)) = blocks.get(number) {
        return Some(kind);
    }
    let total: u64 = blocks.iter().map(|&(_, weight)| u64::from(weight)).sum();
    let mut left = random.next_u64().checked_rem(total)?;
    for &(kind, weight) in blocks {
        if left < u64::from(weight) {
            return Some(kind);
        }
        left -= u64::from(weight);
    }
    None
}

impl TownSite {
    fn build(&mut self, kind: BlockPlan, plan: &BlockRectangle) {
        match kind {
            BlockPlan::Terraces => self.terraces(plan),
            BlockPlan::LShapes => self.l_shapes(plan),
            BlockPlan::TowerAndHall => self.tower_and_hall(plan),
            BlockPlan::DetachedHouses => self.detached_houses(plan),
            BlockPlan::RowHouses => self.row_houses(plan),
            BlockPlan::Perimeter => self.perimeter(plan),
            BlockPlan::Courtyard => self.courtyard(plan),
            BlockPlan::HighRise => self.high_rise(plan),
            BlockPlan::Square => self.square(plan),
            BlockPlan::PetrolStation => self.petrol_station(plan),
            BlockPlan::Gardens => self.gardens(plan),
            BlockPlan::Lawn => self.lawn(plan),
        }
    }
}
