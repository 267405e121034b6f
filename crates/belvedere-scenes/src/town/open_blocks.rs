//! Blocks with room between the buildings: high-rise, squares, petrol stations, gardens, lawns.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::scene::Material;
use crate::solids::{JOINT, PlanPlacement, RidgedProfile, extruded, ridged, ridged_to};
use crate::town::buildings::{RoofShape, chimney, dormer, steeple};
use crate::town::plan::BlockRectangle;
use crate::town::row_blocks::{BALCONY_DEPTH, RowStyle, STOREY};
use crate::town::site::TownSite;

impl TownSite {
    /// Builds a tower and a long building with balconies, a deck between them, and a car park with a shelter.
    pub(crate) fn high_rise(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        let (tower_side, slab_depth) = (14.0, 10.5);
        let slab_v = -half_v + slab_depth / 2.0 + BALCONY_DEPTH + 0.8;
        let slab = plan.centre.moved(0.0, slab_v, 0.0);
        let slab_height = self.random.between(14.0, 26.0);
        self.balconied(&slab, [1.8 * half_u, slab_depth], slab_height, &[0.0], 1);

        let tower = plan.centre.moved(-half_u + tower_side / 2.0 + 1.5, half_v - tower_side / 2.0 - 2.2, 0.0);
        let tower_v = half_v - tower_side / 2.0 - 2.2;
        let height = self.random.between(34.0, 58.0);
        // Balconies from above the deck up.
        self.balconied(&tower, [tower_side, tower_side], height, &[0.0, PI], 2);

        // From wall to wall, a little into both.
        let (from, to) = (slab_v + slab_depth / 2.0 - JOINT, tower_v - tower_side / 2.0 + JOINT);
        let tower_u = -half_u + tower_side / 2.0 + 1.5;
        if to - from > 3.0 {
            self.deck(plan.centre.moved(tower_u, (from + to) / 2.0, 0.0), [11.0, to - from], 3.7);
        }
        for (row, angle) in [(-0.02, FRAC_PI_2), (0.5, -FRAC_PI_2)] {
            let mut u = tower_u + tower_side / 2.0 + 4.0;
            while u < half_u - 2.0 {
                if self.random.chance(0.65) {
                    let askew = self.random.between(-0.03, 0.03);
                    self.park(plan.centre.moved(u, row * half_v, angle + askew));
                }
                u += 2.7;
            }
        }
        let shelter = plan.centre.moved(half_u * 0.55, half_v * 0.86, 0.0);
        if self.is_free(&shelter, [7.0, 2.4], 0.3) {
            self.canopy(shelter, [7.0, 2.4], 2.4, 0.12, 3.5);
        }
    }

    /// Builds a flat-roofed building with a machine room and rows of balconies, from the given storey up. The balconies
    /// are on the walls that face −v after a turn by each of `faces`.
    fn balconied(&mut self, place: &PlanPlacement, size: [f64; 2], height: f64, faces: &[f64], first_storey: u32) {
        let footprint = place.rectangle(size[0], size[1]);
        let ground = self.ground(place.origin);
        let top = ground + height;
        let room = extruded(&place.moved(0.12 * size[0], 0.5, 0.0).rectangle(5.0, 4.0), top - 0.5, top + 2.8);
        let mut parts = vec![extruded(&footprint, self.bottom(&footprint), top), room];
        parts.extend(self.next_parapet(&footprint, top));
        parts.extend(self.next_roof_boxes(place, size, top));
        let bays = crate::town::street_furniture::pieces(size[0] - 1.0, 4.6);
        let step = (size[0] - 1.0) / f64::from(bays);
        for &face in faces {
            let wall = place.moved(0.0, 0.0, face).moved(0.0, -size[1] / 2.0, 0.0);
            for bay in 0..bays {
                let u = step * (f64::from(bay) + 0.5) - (size[0] - 1.0) / 2.0;
                let base = ground + STOREY * f64::from(first_storey - 1);
                parts.extend(self.balconies(&wall.moved(u, 0.0, 0.0), base, top));
            }
        }
        self.take(*place, size[0], size[1] + 2.0 * BALCONY_DEPTH);
        self.add("building", &parts);
    }

    /// Builds a church, houses over arcades, a market hall and stalls.
    pub(crate) fn square(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        let style = RowStyle {
            house_width: 7.0,
            depth: 8.5,
            eaves: [7.0, 10.5],
            arcades: 1.0,
            balconies: 0.0,
            corner: 0.0,
            dormers: 0.6,
        };
        // Their fronts face the square.
        self.row(&plan.centre.moved(0.0, half_v - style.depth / 2.0 - 0.8, 0.0), 2.0 * half_u - 1.0, &style);

        let nave = plan.centre.moved(-half_u + 12.0, -half_v + 6.5, 0.0);
        let (footprint, ground) = (nave.rectangle(19.0, 9.5), self.ground(nave.origin));
        let bottom = self.bottom(&footprint);
        let (eaves, ridge, overhang) = (ground + 8.0, ground + 14.5, self.next_overhang(true));
        let mut church = vec![ridged_to(&footprint, 0.0, &RidgedProfile { bottom, eaves, ridge, overhang })];
        let tower = nave.moved(9.5 + 2.5, 0.3, 0.0);
        let eaves = ground + self.random.between(18.0, 22.0);
        church.extend(steeple(&tower, 6.0, self.bottom(&tower.rectangle(6.0, 6.0)), eaves, eaves + 11.0));
        self.take(nave, 19.0, 9.5 + 2.0 * overhang.eaves);
        self.take(tower, 6.6, 6.6);
        self.add("building", &church);

        self.canopy(plan.centre.moved(0.0, 0.05 * half_v, 0.0), [13.0, 6.5], 4.2, 0.3, 6.0);
        self.wired_masts([-0.85, 0.85].map(|u| plan.centre.moved(u * half_u, 0.32 * half_v, PI)));
        for (u, v) in [(-0.75, -0.12), (-0.75, 0.12), (0.75, -0.12), (0.75, 0.12), (0.9, -0.3), (0.6, -0.55)] {
            let stall = plan.centre.moved(u * half_u, v * half_v, self.random.between(-0.1, 0.1));
            if self.is_free(&stall, [3.0, 3.0], 0.4) {
                self.canopy(stall, [3.0, 3.0], 2.3, 0.08, 3.0);
            }
        }
        self.park(plan.centre.moved(half_u - 5.0, -half_v + 2.5, 0.0));
        self.park(plan.centre.moved(half_u - 5.0, -half_v + 5.5, PI));
    }

    /// Builds a canopy over the pumps, a shop, cars and a fence at the back.
    pub(crate) fn petrol_station(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        self.park(plan.centre.moved(-2.0, -0.25 * half_v - 2.0, 0.0));
        self.park(plan.centre.moved(3.5, -0.25 * half_v + 2.2, PI));
        self.canopy(plan.centre.moved(0.0, -0.25 * half_v, 0.0), [16.0, 10.0], 4.8, 0.6, 12.0);
        self.flat_block(plan.centre.moved(0.1 * half_u, 0.5 * half_v, 0.0), [15.0, 9.0], 4.0);
        let back = 0.95 * half_v;
        self.fence([plan.centre.at(-0.95 * half_u, back), plan.centre.at(0.95 * half_u, back)], 2.0);
        for u in [-0.8, -0.62, -0.44] {
            self.park(plan.centre.moved(u * half_u, 0.6 * half_v, FRAC_PI_2));
        }
        self.wired_masts([-0.9, 0.9].map(|u| plan.centre.moved(u * half_u, -0.9 * half_v, 0.0)));
    }

    /// Builds four detached houses in fenced gardens.
    pub(crate) fn gardens(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        for (side_u, side_v) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            // Fronts face −v as placed, so gardens of the upper row are turned about.
            let facing = if side_v < 0.0 { 0.0 } else { PI };
            let turn = self.random.between(-0.1, 0.1);
            let house = plan.centre.moved(side_u * 0.52 * half_u, side_v * 0.58 * half_v, facing + turn);
            self.detached_house(&house);
            let drive = 0.86 * half_u * side_u;
            if self.random.chance(0.7) {
                self.park(plan.centre.moved(drive, side_v * 0.7 * half_v, FRAC_PI_2));
            }
            let shed = plan.centre.moved(side_u * 0.25 * half_u, side_v * 0.14 * half_v, 0.0);
            if self.random.chance(0.6) && self.is_free(&shed, [3.2, 2.4], 0.3) {
                self.flat_block(shed, [3.2, 2.4], 2.3);
            }
            // Along the street, with a gap for the gate.
            let front = side_v * 0.97 * half_v;
            let gate = side_u * 0.74 * half_u;
            self.fence([plan.centre.at(side_u * 0.03 * half_u, front), plan.centre.at(gate, front)], 0.9);
            let outer = side_u * 0.98 * half_u;
            self.fence([plan.centre.at(outer, side_v * 0.03 * half_v), plan.centre.at(outer, front)], 1.1);
        }
        self.fence([plan.centre.at(-0.97 * half_u, 0.0), plan.centre.at(0.97 * half_u, 0.0)], 1.6);
        for side in [-1.0, 1.0] {
            self.fence([plan.centre.at(0.0, side * 0.02), plan.centre.at(0.0, side * 0.93 * half_v)], 1.4);
        }
    }

    /// Builds a house with its front towards −v, a chimney, dormers or hips.
    fn detached_house(&mut self, house: &PlanPlacement) {
        let size = [self.random.between(9.5, 11.5), self.random.between(7.5, 8.8)];
        let footprint = house.rectangle(size[0], size[1]);
        let ground = self.ground(house.origin);
        let eaves = ground + self.random.between(2.9, 5.6);
        let ridge = eaves + self.random.between(3.2, 4.4);
        let hip = if self.random.chance(0.35) { size[1] / 2.5 } else { 0.0 };
        let roof = RoofShape { length: size[0], width: size[1], eaves, ridge };
        let (bottom, overhang) = (self.bottom(&footprint), self.next_overhang(true));
        let mut parts = vec![ridged_to(&footprint, hip, &RidgedProfile { bottom, eaves, ridge, overhang })];
        parts.push(chimney(house, &roof, self.random.between(-0.12, 0.12) * size[0]));
        if hip == 0.0 {
            for share in [-0.26, 0.26] {
                if self.random.chance(0.6) {
                    parts.extend(dormer(house, &roof, share * size[0]));
                }
            }
        }
        self.take(*house, size[0] + 2.0 * overhang.eaves, size[1] + 2.0 * overhang.eaves);
        self.add("building", &parts);
    }

    /// Builds a pavilion, a lookout platform and low fences.
    pub(crate) fn lawn(&mut self, plan: &BlockRectangle) {
        let [half_u, half_v] = plan.half_sides();
        let pavilion = plan.centre.moved(0.3 * half_u, 0.2 * half_v, self.random.between(0.0, FRAC_PI_2));
        let mut parts = self.canopy_parts(pavilion, [7.0, 5.0], 2.8, 0.2, 3.5);
        // Its roof is sunk into the slab.
        let base = self.ground(pavilion.origin) + 2.8 + 0.1;
        let roof = ridged(&pavilion.rectangle(6.8, 4.8), base, base + 0.2, base + 1.9, 2.2);
        parts.push(roof.with_material(Material::Slab));
        self.add("canopy", &parts);
        if self.random.chance(0.5) {
            let lookout = plan.centre.moved(-0.55 * half_u, -0.45 * half_v, self.random.between(0.0, FRAC_PI_2));
            self.deck(lookout, [7.0, 7.0], 3.0);
        }
        for side in [-1.0, 1.0] {
            let v = side * 0.96 * half_v;
            for (from, to) in [(-0.95, -0.12), (0.12, 0.95)] {
                self.fence([plan.centre.at(from * half_u, v), plan.centre.at(to * half_u, v)], 0.8);
            }
        }
    }
}
