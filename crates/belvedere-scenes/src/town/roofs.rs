//! Details of roofs that plain solids lack: eaves, verges, parapets, boxes, chimneys.

use crate::random::Random;
use crate::scene::ObjectPart;
use crate::solids::{Overhang, PlanPlacement, extruded, parapet};
use crate::town::buildings::{RoofShape, chimney};
use crate::town::site::TownSite;

/// Overhang of eaves and of verges beyond the walls, metres.
///
/// # Source
/// Edges of roofs against walls in two tiles of AHN3 over Delft. Half of all roofs extend more than 15 cm beyond the
/// wall. 15 to 40 % extend more than 30 cm, and 5 % 44 to 66 cm. Gables extend about 15 cm.
const EAVES: [f64; 2] = [0.3, 0.6];
const VERGE: f64 = 0.2;
/// Thickness and height of parapets, metres.
const PARAPET_THICKNESS: f64 = 0.25;
const PARAPET_HEIGHT: [f64; 2] = [0.3, 1.0];
/// Sides and height of boxes on roofs, their depth in the roof, and their distance from its edge, metres.
const BOX_SIDE: [f64; 2] = [0.8, 2.5];
const BOX_HEIGHT: [f64; 2] = [0.6, 1.8];
const BOX_DEPTH: f64 = 0.3;
const BOX_MARGIN: f64 = 1.2;
/// Minimum area of a flat roof with boxes, m².
const MIN_AREA_FOR_BOXES: f64 = 50.0;

/// Detail with random numbers of its own in each building.
#[derive(Clone, Copy)]
enum RoofDetail {
    Eaves = 1,
    Parapet,
    Boxes,
    Chimney,
}

impl TownSite {
    /// Returns random numbers for a detail of the next building.
    fn random_of(&self, detail: RoofDetail) -> Random {
        Random::new(self.seed, ((detail as u64) << 48) | u64::from(self.count("building")))
    }

    /// Returns the eaves and verges of the next house. Both are zero if the town or the house has none, and verges are
    /// zero without free gables.
    pub(crate) fn next_overhang(&self, has_free_gables: bool) -> Overhang {
        let mut random = self.random_of(RoofDetail::Eaves);
        let verge = if has_free_gables { VERGE } else { 0.0 };
        let has_eaves = random.chance(self.roofs.eaves);
        if has_eaves { Overhang { eaves: random.between(EAVES[0], EAVES[1]), verge } } else { Overhang::default() }
    }

    /// Returns the parapet of the next flat roof at height `top` over walls along `outline`, (N, 2), counter-clockwise.
    pub(crate) fn next_parapet(&self, outline: &[[f64; 2]], top: f64) -> Option<ObjectPart> {
        let mut random = self.random_of(RoofDetail::Parapet);
        random
            .chance(self.roofs.parapets)
            .then(|| parapet(outline, PARAPET_THICKNESS, top, random.between(PARAPET_HEIGHT[0], PARAPET_HEIGHT[1])))
    }

    /// Returns the boxes on the next flat roof at height `top`, of `size` about `place`.
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

    /// Returns the chimney of the next house that is built without one.
    pub(crate) fn next_chimney(&self, house: &PlanPlacement, roof: &RoofShape) -> Option<ObjectPart> {
        let mut random = self.random_of(RoofDetail::Chimney);
        random.chance(self.roofs.chimneys).then(|| chimney(house, roof, random.between(-0.2, 0.2) * roof.length))
    }
}
