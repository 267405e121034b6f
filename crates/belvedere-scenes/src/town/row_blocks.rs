//! Blocks of houses wall to wall: rows with gardens, perimeters and buildings around courtyards.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::scene::ObjectPart;
use crate::solids::{JOINT, Overhang, PlanPlacement, RidgedProfile, WingCourse, ridged_to, winged};
use crate::town::buildings::{RoofShape, arcaded, balcony, chimney, dormer};
use crate::town::plan::BlockRectangle;
use crate::town::site::{Clearance, TownSite};
use crate::town::street_furniture::fence;

/// Height of a storey, metres.
pub(crate) const STOREY: f64 = 2.9;
/// Depth of a balcony in front of the wall, metres.
pub(crate) const BALCONY_DEPTH: f64 = 1.4;
/// Width of a balcony, metres.
const BALCONY_WIDTH: f64 = 3.0;
/// Overlap of neighbouring houses, metres: party walls without a seam.
const PARTY_WALL: f64 = 0.06;

/// Houses of one row. Lengths are in metres, chances from 0 to 1 per house.
pub(crate) struct RowStyle {
    pub(crate) house_width: f64,
    pub(crate) depth: f64,
    pub(crate) eaves: [f64; 2],
    pub(crate) arcades: f64,
    pub(crate) balconies: f64,
    /// Length at either end of the row with other houses behind, and therefore without balconies.
    pub(crate) corner: f64,
    pub(crate) dormers: f64,
}

impl TownSite {
    /// Builds two rows of houses with fenced gardens between them.
    pub(crate) fn row_houses(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        let style = RowStyle {
            house_width: 5.4,
            depth: 9.0,
            eaves: [5.4, 8.6],
            arcades: 0.0,
            balconies: 0.4,
            corner: 0.0,
            dormers: 0.5,
        };
        let front_garden = 0.9;
        let back = half_v - front_garden - style.depth;
        let mut count = 0;
        for angle in [0.0, PI] {
            let row = plan.centre.moved(0.0, 0.0, angle).moved(0.0, -half_v + front_garden + style.depth / 2.0, 0.0);
            count = self.row(&row, 2.0 * half_u, &style);
            let garden = plan.centre.moved(0.0, 0.0, angle);
            let width = 2.0 * half_u / f64::from(count);
            for boundary in 1..count {
                let u = -half_u + width * f64::from(boundary);
                // From inside the house, for any place of its back wall, to the fence at the end of the garden.
                self.fence([garden.at(u, -back - 1.0), garden.at(u, 0.02)], 1.5);
            }
            for house in 0..count {
                let u = -half_u + width * (f64::from(house) + 0.5);
                if self.random.chance(0.45) {
                    self.flat_block(garden.moved(u + 0.8, -1.9, 0.0), [2.4, 2.0], 2.3);
                }
            }
        }
        if count > 0 {
            self.fence([plan.centre.at(-half_u, 0.0), plan.centre.at(half_u, 0.0)], 1.7);
        }
    }

    /// Builds houses on four sides of a courtyard, with a canopy in it.
    pub(crate) fn perimeter(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        let depth = 8.0;
        let style = |arcades: f64, corner: f64| RowStyle {
            house_width: 6.6,
            depth,
            eaves: [6.8, 11.5],
            arcades,
            balconies: 0.4,
            corner,
            dormers: 0.5,
        };
        // The other rows and their balconies, and a metre.
        let corner = BALCONY_DEPTH + 1.0;
        let margin = 0.5;
        for (angle, arcades) in [(0.0, 0.7), (PI, 0.2)] {
            let side = plan.centre.moved(0.0, 0.0, angle);
            let row = side.moved(0.0, -half_v + depth / 2.0 + margin, 0.0);
            self.row(&row, 2.0 * (half_u - margin), &style(arcades, depth + corner));
        }
        for angle in [FRAC_PI_2, 1.5 * PI] {
            let side = plan.centre.moved(0.0, 0.0, angle);
            let row = side.moved(0.0, -half_u + depth / 2.0 + margin, 0.0);
            // Into the backs of the other rows, whose depth varies.
            self.row(&row, 2.0 * (half_v - depth - margin + 0.6), &style(0.0, corner));
        }
        let [court_u, court_v] = [half_u - depth - margin, half_v - depth - margin];
        if court_u > 7.0 && court_v > 6.0 {
            let shed = plan.centre.moved(court_u * 0.4, court_v * 0.3, 0.2);
            self.canopy(shed, [5.0, 3.5], 2.6, 0.15, 5.0);
        }
    }

    /// Builds alternately a building around a courtyard and one around three sides of a court.
    pub(crate) fn courtyard(&mut self, plan: &BlockRectangle) {
        let [a, b] = plan.half_sides().map(|half| half - 0.9);
        let depth = 9.5;
        let corners = |inset: f64| {
            [[-a, b], [-a, -b], [a, -b], [a, b]]
                .map(|[u, v]: [f64; 2]| plan.centre.at(u - inset.copysign(u), v - inset.copysign(v)))
        };
        let (outer, mut inner) = (corners(0.0), corners(depth));
        let ground = self.ground(plan.centre.origin);
        let bottom = self.bottom(&outer);
        let closed = self.next_courtyard() == 0;
        let eaves = ground + self.random.between(9.5, 14.0);
        let sloped = closed || self.random.chance(0.5);
        let ridge = eaves + if sloped { self.random.between(3.6, 4.6) } else { 0.0 };
        let course = if closed { WingCourse::Closed } else { WingCourse::Open };
        if !closed {
            for (corner, u) in [(0, -a + depth), (3, a - depth)] {
                inner[corner] = plan.centre.at(u, b);
            }
        }
        let overhang = if sloped { self.next_overhang(true) } else { Overhang::default() };
        let mut parts = vec![winged(&outer, &inner, course, &RidgedProfile { bottom, eaves, ridge, overhang })];
        if !sloped {
            let outline: Vec<[f64; 2]> = outer.into_iter().chain(inner.into_iter().rev()).collect();
            parts.extend(self.next_parapet(&outline, ridge));
        }
        // Details on the wing towards −v, whose back faces the court.
        let wing = plan.centre.moved(0.0, -b + depth / 2.0, 0.0);
        let roof = RoofShape { length: 2.0 * (a - depth), width: depth, eaves, ridge };
        let back = wing.moved(0.0, depth / 2.0, PI);
        for along in [-0.32, 0.0, 0.32].map(|share| share * roof.length) {
            if sloped {
                parts.extend(dormer(&wing, &roof, along));
                parts.push(chimney(&wing, &roof, along + 2.0));
            }
            parts.extend(self.balconies(&back.moved(along, 0.0, 0.0), ground, eaves));
        }
        self.take_wings(plan, [a, b].map(|half| half + overhang.eaves), depth + 2.0 * overhang.eaves, closed);
        self.add("building", &parts);
        if a - depth > 6.0 && b - depth > 6.0 {
            self.canopy(plan.centre.moved(2.0, 0.25 * b, 0.0), [6.0, 3.6], 2.7, 0.15, 5.0);
        }
    }

    fn take_wings(&mut self, plan: &BlockRectangle, [a, b]: [f64; 2], depth: f64, closed: bool) {
        for side in [-1.0, 1.0] {
            self.take(plan.centre.moved(side * (a - depth / 2.0), 0.0, 0.0), depth, 2.0 * b);
            if side < 0.0 || closed {
                self.take(plan.centre.moved(0.0, side * (b - depth / 2.0), 0.0), 2.0 * a, depth);
            }
        }
        // The balconies in the court.
        self.take(plan.centre.moved(0.0, -b + depth + BALCONY_DEPTH / 2.0, 0.0), 2.0 * (a - depth), BALCONY_DEPTH);
    }

    /// Returns one balcony per storey from the first floor up, on a wall that faces −v and runs through the origin.
    pub(crate) fn balconies(&self, wall: &PlanPlacement, ground: f64, top: f64) -> Vec<ObjectPart> {
        let floors = std::iter::successors(Some(ground + STOREY), |floor| Some(floor + STOREY));
        let below = floors.take_while(|floor| floor + 1.6 < top);
        below.map(|floor| balcony(wall, BALCONY_WIDTH, BALCONY_DEPTH, floor)).collect()
    }

    /// Builds a row of houses along u about `row`, with their fronts towards −v. Returns their number.
    pub(crate) fn row(&mut self, row: &PlanPlacement, length: f64, style: &RowStyle) -> u32 {
        let count = crate::town::street_furniture::pieces(length, style.house_width * 1.15);
        let width = length / f64::from(count);
        for house in 0..count {
            let u = -length / 2.0 + width * (f64::from(house) + 0.5);
            let has_open_back = u.abs() + BALCONY_WIDTH / 2.0 < length / 2.0 - style.corner;
            let balconies = if has_open_back { style.balconies } else { 0.0 };
            self.party_house(&row.moved(u, 0.0, 0.0), width, &RowStyle { balconies, ..*style });
        }
        count
    }

    fn party_house(&mut self, place: &PlanPlacement, width: f64, style: &RowStyle) {
        // No two fronts, backs or roofs lie in one plane. In an overlap of such faces, the first surface of a ray would
        // be undefined.
        let depth = style.depth + self.random.between(-0.4, 0.4);
        let forward = self.random.between(0.0, 0.3);
        let house = place.moved(0.0, (depth - style.depth) / 2.0 - forward, 0.0);
        let length = width + PARTY_WALL;
        let footprint = house.rectangle(length, depth);
        let (ground, bottom) = (self.ground(house.origin), self.bottom(&footprint));
        let eaves = ground + self.random.between(style.eaves[0], style.eaves[1]);
        let ridge = eaves + depth * self.random.between(0.36, 0.5);
        let roof = RoofShape { length, width: depth, eaves, ridge };
        let mut overhang = Overhang::default();
        let mut parts = if self.random.chance(style.arcades) {
            let ceiling = ground + self.random.between(3.2, 3.7);
            arcaded(&house, &roof, bottom, ceiling, 2.5)
        } else {
            overhang = self.next_overhang(false);
            vec![ridged_to(&footprint, 0.0, &RidgedProfile { bottom, eaves, ridge, overhang })]
        };
        if self.random.chance(0.7) {
            parts.push(chimney(&house, &roof, self.random.between(-0.35, 0.35) * width));
        }
        if self.random.chance(style.dormers) {
            parts.extend(dormer(&house, &roof, self.random.between(-0.2, 0.2) * width));
        }
        let mut taken = depth + 2.0 * overhang.eaves;
        if self.random.chance(style.balconies) {
            let back = house.moved(0.0, depth / 2.0, PI);
            parts.extend(self.balconies(&back, ground, eaves));
            taken = depth + 2.0 * (BALCONY_DEPTH + JOINT);
        }
        self.take(house, length, taken);
        self.add("building", &parts);
    }

    pub(crate) fn fence(&mut self, ends: [[f64; 2]; 2], height: f64) {
        let part = fence(ends, height + self.random.between(-0.1, 0.1), &|point| self.ground(point));
        let along = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
        let origin = [0, 1].map(|axis| (ends[0][axis] + ends[1][axis]) / 2.0);
        let placement = PlanPlacement { origin, angle: along[1].atan2(along[0]) };
        self.take_for(placement, [along[0].hypot(along[1]), 0.1], Clearance::Trunk);
        self.add("fence", &[part]);
    }
}
