//! Blocks of plain solids: terraces, L-shapes, a tower and a hall, detached houses. The default town consists of them.

use std::f64::consts::FRAC_PI_2;

use crate::solids::{PlanPlacement, extruded, l_shaped_ridged};
use crate::town::plan::BlockRectangle;
use crate::town::site::TownSite;

impl TownSite {
    /// Builds two rows of terraced houses with sheds in the gardens between them.
    pub(crate) fn terraces(&mut self, plan: &BlockRectangle) {
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

    /// Builds a gabled and a flat-roofed L about a courtyard.
    pub(crate) fn l_shapes(&mut self, plan: &BlockRectangle) {
        let turn = if self.random.chance(0.5) { 0.0 } else { 2.0 * FRAC_PI_2 };
        let turned = BlockRectangle { centre: plan.centre.moved(0.0, 0.0, turn), scale: plan.scale };

        let (corner, lengths, width) = (turned.at(-18.0, -18.0, 0.0), [33.0, 29.0], 9.5);
        let footprint = corner.l_shape(lengths[0], lengths[1], width);
        let eaves = self.ground(corner.at(width, width)) + self.random.between(7.0, 9.0);
        self.take_l_shape(&corner, lengths, width);
        let part = l_shaped_ridged(&corner, lengths, width, self.bottom(&footprint), eaves, eaves + 4.5);
        self.add("building", &[part]);

        let (corner, lengths, width) = (turned.at(18.0, 18.0, 2.0 * FRAC_PI_2), [21.0, 19.0], 8.0);
        let footprint = corner.l_shape(lengths[0], lengths[1], width);
        let top = self.ground(corner.at(width, width)) + self.random.between(9.0, 12.0);
        self.take_l_shape(&corner, lengths, width);
        let mut parts = vec![extruded(&footprint, self.bottom(&footprint), top)];
        parts.extend(self.next_parapet(&footprint, top));
        self.add("building", &parts);
    }

    fn take_l_shape(&mut self, corner: &PlanPlacement, [length_u, length_v]: [f64; 2], width: f64) {
        self.take(corner.moved(length_u / 2.0, width / 2.0, 0.0), length_u, width);
        self.take(corner.moved(width / 2.0, length_v / 2.0, 0.0), width, length_v);
    }

    /// Builds a tower with a machine room on its roof, a hall with a flat roof and one with a ridge.
    pub(crate) fn tower_and_hall(&mut self, plan: &BlockRectangle) {
        let placement = plan.at(-9.0, 8.0, 0.0);
        let footprint = placement.rectangle(13.0, 13.0);
        let top = self.ground(placement.origin) + self.random.between(34.0, 40.0);
        let tower = extruded(&footprint, self.bottom(&footprint), top);
        // Sunk into the roof: a solid that only touches another would leave a seam that the scanner sees into.
        let room = extruded(&placement.moved(1.5, -1.0, 0.0).rectangle(5.0, 4.0), top - 0.5, top + 3.0);
        self.take(placement, 13.0, 13.0);
        self.add("building", &[tower, room]);
        self.flat_block(plan.at(10.0, 9.0, 0.0), [14.0, 11.0], 5.5);
        self.house(plan.at(-3.0, -13.0, 0.0), [24.0, 10.0], 4.5, 3.0, 0.0);
    }

    /// Builds six detached houses, each turned a little from the street, with gables or hips.
    pub(crate) fn detached_houses(&mut self, plan: &BlockRectangle) {
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
}
