//! What roofs of real towns have and plain solids do not: eaves, verges, parapets, boxes, chimneys.

use crate::random::Random;
use crate::scene::ObjectPart;
use crate::solids::{Overhang, PlanPlacement, extruded, parapet};
use crate::town::buildings::{RoofShape, chimney};
use crate::town::site::TownSite;

/// How many of the roofs of a town have what, as chances from 0 to 1 of each building.
///
/// Which buildings they are follows from the seed. A greater chance adds to them and changes no other, and walls,
/// streets and parked cars stay where they are, as far as eaves leave room.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoofDetails {
    /// Eaves of 0.3 to 0.6 m below sloped roofs, and verges of 0.2 m at gables where no other house stands.
    pub eaves: f64,
    /// Parapets 0.25 m thick and 0.3 to 1 m high about flat roofs, but for those of sheds.
    pub parapets: f64,
    /// One to three boxes of 0.6 to 1.8 m, for lifts and air, on flat roofs of more than 50 m².
    pub boxes: f64,
    /// A chimney on houses that are built without.
    pub chimneys: f64,
}

impl RoofDetails {
    /// None of all that.
    pub const PLAIN: Self = Self { eaves: 0.0, parapets: 0.0, boxes: 0.0, chimneys: 0.0 };
}

/// Reach of eaves and of verges beyond the walls, metres.
///
/// # Source
/// Edges of roofs against walls in two tiles of AHN3 over Delft: half of all roofs reach more than 15 cm beyond the
/// wall, 15 to 40 % more than 30 cm, 5 % 44 to 66 cm; gables about 15 cm.
const EAVES: [f64; 2] = [0.3, 0.6];
const VERGE: f64 = 0.2;
/// Thickness and height of parapets, metres.
const PARAPET_THICKNESS: f64 = 0.25;
const PARAPET_HEIGHT: [f64; 2] = [0.3, 1.0];
/// Sides and height of boxes on roofs, metres, how far they reach into the roof, and how far they stay off its edge.
const BOX_SIDE: [f64; 2] = [0.8, 2.5];
const BOX_HEIGHT: [f64; 2] = [0.6, 1.8];
const BOX_DEPTH: f64 = 0.3;
const BOX_MARGIN: f64 = 1.2;
/// Least area of a flat roof with boxes, m².
const MIN_AREA_FOR_BOXES: f64 = 50.0;

/// What has random numbers of its own in each building.
#[derive(Clone, Copy)]
enum RoofDetail {
    Eaves = 1,
    Parapet,
    Boxes,
    Chimney,
}

impl TownSite {
    /// Random numbers for a detail of the building that is added next.
    fn random_of(&self, detail: RoofDetail) -> Random {
        Random::new(self.seed, ((detail as u64) << 48) | u64::from(self.count("building")))
    }

    /// Eaves and verges of the next house; none, or without verges, where the town or the house has none.
    pub(crate) fn next_overhang(&self, has_free_gables: bool) -> Overhang {
        let mut random = self.random_of(RoofDetail::Eaves);
        let verge = if has_free_gables { VERGE } else { 0.0 };
        let has_eaves = random.chance(self.roofs.eaves);
        if has_eaves { Overhang { eaves: random.between(EAVES[0], EAVES[1]), verge } } else { Overhang::default() }
    }

    /// The parapet of the next flat roof at height `top` over walls along `outline`, (N, 2), counter-clockwise.
    pub(crate) fn next_parapet(&self, outline: &[[f64; 2]], top: f64) -> Option<ObjectPart> {
        let mut random = self.random_of(RoofDetail::Parapet);
        random
            .chance(self.roofs.parapets)
            .then(|| parapet(outline, PARAPET_THICKNESS, top, random.between(PARAPET_HEIGHT[0], PARAPET_HEIGHT[1])))
    }

    /// The boxes on the next flat roof at height `top`, of `size` about `place`.
    pub(crate) fn next_roof_boxes(&self, place: &PlanPlacement, size: [f64; 2], top: f64) -> Vec<ObjectPart> {
        let mut random = self.random_of(RoofDetail::Boxes);
        if size[0] * size[1] < MIN_AREA_FOR_BOXES || !random.chance(self.roofs.boxes) {
            return Vec::new();
        }
        let mut boxes = Vec::new();
        for chance in [1.0, 0.6, 0.4] {
            let sides = [0, 1].map(|_| random.between(BOX_SIDE[0], BOX_SIDE[1]));
            let [u, v] = [0, 1].map(|axis| {
                let reach = (size[axis] - sides[axis]) / 2.0 - BOX_MARGIN;
                random.between(-reach, reach)
            });
            let height = random.between(BOX_HEIGHT[0], BOX_HEIGHT[1]);
            if random.chance(chance) {
                let footprint = place.moved(u, v, 0.0).rectangle(sides[0], sides[1]);
                boxes.push(extruded(&footprint, top - BOX_DEPTH, top + height));
            }
        }
        boxes
    }

    /// The chimney of the next house that is built without one.
    pub(crate) fn next_chimney(&self, house: &PlanPlacement, roof: &RoofShape) -> Option<ObjectPart> {
        let mut random = self.random_of(RoofDetail::Chimney);
        random.chance(self.roofs.chimneys).then(|| chimney(house, roof, random.between(-0.2, 0.2) * roof.length))
    }
}
