//! Furniture of streets, squares and gardens: cars, fences, masts and wires, canopies, decks, bridges.

use crate::scene::{Material, ObjectPart};
use crate::solids::{JOINT, PlanPlacement, prism, swept};
use crate::town::terrain::Terrain;

/// Height of the ground at a place, for the solids that stand on it, metres.
pub(crate) type GroundHeight<'a> = &'a dyn Fn([f64; 2]) -> f64;

/// Returns a car that heads along u: a body that extends into the ground, so that it stands on slopes, and a cabin.
pub(crate) fn car(placement: &PlanPlacement, ground: f64) -> Vec<ObjectPart> {
    let at = |height: f64| move |[x, y]: [f64; 2]| [x, y, ground + height];
    let cabin = placement.moved(-0.2, 0.0, 0.0);
    let body = [placement.rectangle(4.3, 1.78).map(at(-0.5)), placement.rectangle(4.2, 1.74).map(at(0.8))];
    let cabin = [cabin.rectangle(2.5, 1.6).map(at(0.8 - JOINT)), cabin.rectangle(1.6, 1.36).map(at(1.45))];
    [body, cabin].iter().map(|rings| swept(rings, &[Material::Car], Material::Car)).collect()
}

/// Returns a strip of rectangular section, `width` across, along the straight line between two points. `heights` gives
/// bottom and top, metres, for each share of the line, 0 to 1. The strip has `steps` pieces.
fn strip(
    [from, to]: [[f64; 2]; 2],
    width: f64,
    steps: u32,
    heights: impl Fn(f64, [f64; 2]) -> [f64; 2],
    material: Material,
) -> ObjectPart {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    let left = [-along[1] / length * width / 2.0, along[0] / length * width / 2.0];
    let rings: Vec<[[f64; 3]; 4]> = (0..=steps)
        .map(|step| {
            let share = f64::from(step) / f64::from(steps);
            let [x, y] = [from[0] + along[0] * share, from[1] + along[1] * share];
            let [bottom, top] = heights(share, [x, y]);
            let (right_side, left_side) = ([x - left[0], y - left[1]], [x + left[0], y + left[1]]);
            [
                [right_side[0], right_side[1], bottom],
                [left_side[0], left_side[1], bottom],
                [left_side[0], left_side[1], top],
                [right_side[0], right_side[1], top],
            ]
        })
        .collect();
    swept(&rings, &[material], material)
}

/// Returns the number of pieces of at most `longest` metres into which a line of `length` metres is divided.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates, lengths are not negative")]
pub(crate) fn pieces(length: f64, longest: f64) -> u32 {
    (length / longest).ceil().max(1.0) as u32
}

/// Returns a fence from one point to another that follows the ground: `height` metres high, 6 cm thick.
pub(crate) fn fence(ends: [[f64; 2]; 2], height: f64, ground: GroundHeight<'_>) -> ObjectPart {
    let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
    let heights = |_: f64, point: [f64; 2]| {
        let ground = ground(point);
        [ground - 0.4, ground + height]
    };
    strip(ends, 0.06, pieces(length, 2.0), heights, Material::Fence)
}

/// Returns a bridge along a straight line between two points on the ground, with a slightly arched deck 40 cm thick and
/// parapets. Its ends run into the ground.
pub(crate) fn bridge(ends: [[f64; 2]; 2], width: f64, ground: GroundHeight<'_>) -> Vec<ObjectPart> {
    let grounds = ends.map(ground);
    let crown = 0.55;
    let deck_top = move |share: f64| {
        let bow = 1.0 - (2.0 * share - 1.0).powi(2);
        grounds[0] + (grounds[1] - grounds[0]) * share + crown * bow - 0.12
    };
    let steps = 12;
    let deck = strip(ends, width, steps, |share, _| [deck_top(share) - 0.4, deck_top(share)], Material::Bridge);
    let along = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let length = along[0].hypot(along[1]);
    let parapets = [-1.0, 1.0].map(|side| {
        // Just inside the edge of the deck, and sunk into it.
        let offset = side * (width / 2.0 - 0.15);
        let shifted = ends.map(|[x, y]| [x - along[1] / length * offset, y + along[0] / length * offset]);
        let heights = |share: f64, _: [f64; 2]| [deck_top(share) - JOINT, deck_top(share) + 0.95];
        strip(shifted, 0.15, steps, heights, Material::Bridge)
    });
    std::iter::once(deck).chain(parapets).collect()
}

/// Slab on square posts, in metres: `size` about the origin, with its underside at height `underside`. The posts stand
/// along its edge, `inset` metres inside it and at most `spacing` metres apart.
pub(crate) struct PostedSlab {
    pub(crate) size: [f64; 2],
    pub(crate) underside: f64,
    pub(crate) thickness: f64,
    pub(crate) post_side: f64,
    pub(crate) inset: f64,
    pub(crate) spacing: f64,
}

/// Returns a slab on posts over open ground, such as a canopy, deck or market stall. The slab comes first, then its
/// posts.
pub(crate) fn posted_slab(placement: &PlanPlacement, shape: &PostedSlab, terrain: &Terrain) -> Vec<ObjectPart> {
    let [length, width] = shape.size;
    let top = shape.underside + shape.thickness;
    let mut parts = vec![prism(&placement.rectangle(length, width), shape.underside, top, Material::Slab)];
    let steps = shape.size.map(|side| pieces((side - 2.0 * shape.inset).max(0.0), shape.spacing));
    for i in 0..=steps[0] {
        for j in 0..=steps[1] {
            let on_edge = i == 0 || j == 0 || i == steps[0] || j == steps[1];
            let position = |side: f64, step: u32, steps: u32| {
                (side - 2.0 * shape.inset) * (f64::from(step) / f64::from(steps) - 0.5)
            };
            let post = placement.moved(position(length, i, steps[0]), position(width, j, steps[1]), 0.0);
            let footprint = post.rectangle(shape.post_side, shape.post_side);
            if on_edge {
                let bottom = terrain.lowest(&footprint) - 1.0;
                // Half-way up into the slab, so that it neither touches nor pierces.
                parts.push(prism(&footprint, bottom, shape.underside + shape.thickness / 2.0, Material::Slab));
            }
        }
    }
    parts
}

/// Returns a six-sided lamp mast with an arm along v.
pub(crate) fn mast(placement: &PlanPlacement, ground: f64, height: f64) -> Vec<ObjectPart> {
    let ring = |radius: f64, height: f64| -> [[f64; 3]; 6] {
        std::array::from_fn(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / 6.0).sin_cos();
            let [x, y] = placement.at(radius * cos, radius * sin);
            [x, y, ground + height]
        })
    };
    let shaft = swept(&[ring(0.09, -1.0), ring(0.06, height)], &[Material::Mast], Material::Mast);
    let arm = placement.moved(0.0, 0.7, 0.0).rectangle(0.12, 1.4);
    vec![shaft, prism(&arm, ground + height - 0.2, ground + height - 0.08, Material::Mast)]
}

/// Returns a wire of 3 cm between two points, sagging by `sag` metres in the middle.
pub(crate) fn wire(from: [f64; 3], to: [f64; 3], sag: f64) -> ObjectPart {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    let left = [-dy / length, dx / length];
    let steps = 8;
    let rings: Vec<[[f64; 3]; 3]> = (0..=steps)
        .map(|step| {
            let share = f64::from(step) / f64::from(steps);
            let drop = sag * (1.0 - (2.0 * share - 1.0).powi(2));
            let centre: [f64; 3] = std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share);
            let corner = |across: f64, up: f64| {
                [centre[0] + left[0] * across, centre[1] + left[1] * across, centre[2] - drop + up]
            };
            [corner(-0.015, -0.01), corner(0.015, -0.01), corner(0.0, 0.016)]
        })
        .collect();
    swept(&rings, &[Material::Wire], Material::Wire)
}
