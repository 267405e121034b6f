//! Parts of buildings: arcades, dormers, chimneys, balconies; and spires.

use crate::scene::{Material, ObjectPart};
use crate::solids::{JOINT, PlanPlacement, extruded, prism, ridged, swept};

/// Ridge, eaves and size of a house with its ridge along u, for dormers and chimneys. Metres, absolute heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoofShape {
    pub(crate) length: f64,
    pub(crate) width: f64,
    pub(crate) eaves: f64,
    pub(crate) ridge: f64,
}

impl RoofShape {
    /// Returns the height of the roof at a distance from the wall under the eaves.
    fn height(&self, inset: f64) -> f64 {
        self.eaves + (self.ridge - self.eaves) * inset / (self.width / 2.0)
    }
}

/// Returns a chimney that comes out of the roof near the ridge, `along` metres from the middle of the house.
pub(crate) fn chimney(house: &PlanPlacement, roof: &RoofShape, along: f64) -> ObjectPart {
    let footprint = house.moved(along, 0.7, 0.0).rectangle(0.75, 0.55);
    prism(&footprint, roof.eaves, roof.ridge + 0.8, Material::Facade)
}

/// Returns a gabled dormer in the slope towards −v, `along` metres from the middle of the house; `None` if the roof is
/// too low.
pub(crate) fn dormer(house: &PlanPlacement, roof: &RoofShape, along: f64) -> Option<ObjectPart> {
    let inset = 0.8;
    let eaves = roof.height(inset) + 1.1;
    let ridge = eaves + 0.5;
    if ridge > roof.ridge - 0.3 {
        return None;
    }
    // The back end lies inside the roof: the ridge of the house is above it.
    let depth = roof.width / 2.0 - inset;
    let middle = house.moved(along, -roof.width / 2.0 + inset + depth / 2.0, std::f64::consts::FRAC_PI_2);
    Some(ridged(&middle.rectangle(depth, 1.8), roof.eaves - JOINT, eaves, ridge, 0.0))
}

/// Returns a balcony in front of a wall that faces −v and runs through the origin. It is a slab 16 cm thick with a
/// parapet around it, and its upper side lies at `floor`. It is one solid with a hollow, its back buried in the wall.
pub(crate) fn balcony(wall: &PlanPlacement, width: f64, depth: f64, floor: f64) -> ObjectPart {
    let (thickness, parapet_height, parapet_width) = (0.16, 1.0, 0.08);
    let rectangle = |inset: f64, height: f64, back: f64| {
        let (u, v) = (width / 2.0 - inset, -depth + inset);
        [(-u, v), (u, v), (u, back), (-u, back)].map(|(u, v)| {
            let [x, y] = wall.at(u, v);
            [x, y, height]
        })
    };
    let back = 2.5 * JOINT;
    // From the underside up the outside, over the top edge and down to the floor.
    let rings = [
        rectangle(0.0, floor - thickness, back),
        rectangle(0.0, floor + parapet_height, back),
        rectangle(parapet_width, floor + parapet_height, JOINT),
        rectangle(parapet_width, floor, JOINT),
    ];
    swept(&rings, &[Material::Slab], Material::Slab)
}

/// Returns a house over an arcade, then its pillars. Its ground floor towards −v stands back by `setback` behind
/// pillars. The floors above extend to the full `roof` outline and rest on a ceiling at height `ceiling`.
pub(crate) fn arcaded(
    house: &PlanPlacement,
    roof: &RoofShape,
    bottom: f64,
    ceiling: f64,
    setback: f64,
) -> Vec<ObjectPart> {
    let half = roof.width / 2.0;
    // From the inner edge of the ceiling, from where every corner of the section is in sight.
    let section = [
        (-half + setback, ceiling),
        (-half + setback, bottom),
        (half, bottom),
        (half, roof.eaves),
        (0.0, roof.ridge),
        (-half, roof.eaves),
        (-half, ceiling),
    ];
    let ring = |u: f64| {
        section.map(|(v, height)| {
            let [x, y] = house.at(u, v);
            [x, y, height]
        })
    };
    use Material::{Facade, Roof, Slab};
    let sides = [Facade, Facade, Facade, Roof, Roof, Facade, Slab];
    let mut parts = vec![swept(&[ring(-roof.length / 2.0), ring(roof.length / 2.0)], &sides, Facade)];
    let bays = (roof.length / 3.2).ceil().max(1.0);
    let step = (roof.length - 0.7) / bays;
    let mut u = -(roof.length - 0.7) / 2.0;
    while u < roof.length / 2.0 {
        let footprint = house.moved(u, -half + 0.35, 0.0).rectangle(0.4, 0.4);
        parts.push(prism(&footprint, bottom, ceiling + JOINT, Facade));
        u += step;
    }
    parts
}

/// Returns the tower of a church: a square shaft with a pyramid on it.
pub(crate) fn steeple(placement: &PlanPlacement, side: f64, bottom: f64, eaves: f64, top: f64) -> Vec<ObjectPart> {
    let pyramid: [[f64; 3]; 4] = placement.rectangle(side + 0.6, side + 0.6).map(|[x, y]| [x, y, eaves - JOINT]);
    // The point is a square of a centimetre, which keeps the solid closed without a special case.
    let point: [[f64; 3]; 4] = placement.rectangle(0.01, 0.01).map(|[x, y]| [x, y, top]);
    vec![
        extruded(&placement.rectangle(side, side), bottom, eaves),
        swept(&[pyramid, point], &[Material::Roof], Material::Roof),
    ]
}
