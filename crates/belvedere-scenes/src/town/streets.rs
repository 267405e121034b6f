//! Furniture of streets, bridges over the canal, and trees of a town.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::scene::ObjectPart;
use crate::solids::{JOINT, PlanPlacement};
use crate::town::plan::TownLayout;
use crate::town::site::{Clearance, TownSite};
use crate::town::street_furniture::{PostedSlab, bridge, car, mast, posted_slab, wire};
use crate::town::trees::TreeShape;
use crate::town::{StreetTrees, TownParams};

/// Distance between trees in the middle of a street, metres.
const STREET_TREE_SPACING: f64 = 11.0;
/// Minimum width of a street with parked cars, and of one with bus stops too, metres.
const MIN_WIDTH_FOR_CARS: f64 = 6.5;
const MIN_WIDTH_FOR_BUSES: f64 = 8.0;
/// Length of kerb per parked car, metres; every third place may have a tree.
const PARKING_PLACE: f64 = 5.6;
const MAST_HEIGHT: f64 = 7.0;

impl TownSite {
    /// Plants a row of trees along the middle of each street between the blocks.
    pub(crate) fn street_trees(&mut self, layout: &TownLayout) {
        let (centre, side) = (layout.centre, layout.side);
        for (&u, &v) in layout.streets_along_v.iter().zip(&layout.streets_along_u) {
            let mut along = -side / 2.0 + STREET_TREE_SPACING / 2.0;
            while along < side / 2.0 {
                let shift = self.random.between(-0.8, 0.8);
                self.plant(centre.at(u, along + shift));
                self.plant(centre.at(along + shift, v));
                along += STREET_TREE_SPACING;
            }
        }
    }

    /// Plants trees at random free places: in gardens, courtyards and the green belt around the town.
    pub(crate) fn garden_trees(&mut self, area_per_tree: f64) {
        let (centre, extent) = (self.centre, self.extent);
        let mut area_left = extent * extent;
        while area_left > 0.0 {
            let point = centre.map(|c| c + self.random.between(-extent / 2.0, extent / 2.0));
            self.plant(point);
            area_left -= area_per_tree;
        }
    }

    /// Builds bridges between the given ends, in streets of the given width.
    pub(crate) fn bridges(&mut self, ends: &[[[f64; 2]; 2]], street_width: f64) {
        for &ends in ends {
            let parts = bridge(ends, (street_width - 2.0).clamp(2.5, 7.0), &|point| self.ground(point));
            self.add("bridge", &parts);
        }
    }

    /// Adds cars, small trees, masts, wires and bus stops along the blocks, clear of the crossings.
    pub(crate) fn furnish_streets(&mut self, layout: &TownLayout, params: &TownParams) {
        if !(params.street_furniture > 0.0) && params.street_trees != StreetTrees::Kerb {
            return;
        }
        let [half_u, half_v] = layout.block_half_sides();
        for &v in &layout.streets_along_u {
            for &u in &layout.columns {
                self.furnish_street(&layout.centre.moved(u, v, 0.0), half_u, params);
            }
        }
        for &u in &layout.streets_along_v {
            for &v in &layout.rows {
                self.furnish_street(&layout.centre.moved(u, v, FRAC_PI_2), half_v, params);
            }
        }
    }

    /// Furnishes one side of a block. `middle` lies in the middle of the street, which runs along u for `half_length`
    /// each way.
    fn furnish_street(&mut self, middle: &PlanPlacement, half_length: f64, params: &TownParams) {
        let (share, half_width) = (params.street_furniture, params.street_width / 2.0);
        if share > 0.0 && self.random.chance(share) {
            let at = [-1.0, 1.0].map(|end| middle.moved(end * (half_length - 2.0), half_width - 0.6, PI));
            self.wired_masts(at);
        }
        if params.street_width >= MIN_WIDTH_FOR_BUSES && self.random.chance(0.35 * share) {
            self.bus_stop(middle.moved(0.0, half_width - 1.4, 0.0));
        }
        let kerb = -(half_width - 1.15);
        let mut along = -half_length + PARKING_PLACE / 2.0;
        let mut place = 0;
        while along < half_length - PARKING_PLACE / 2.0 {
            let position = middle.moved(along + self.random.between(-0.3, 0.3), kerb, 0.0);
            if place % 3 == 1 && params.street_trees == StreetTrees::Kerb {
                let height = self.random.between(5.0, 7.5);
                let shape = TreeShape { height, crown_radius: 0.19 * height, trunk_radius: 0.016 * height };
                self.plant_shaped(position.origin, &shape);
            } else if params.street_width >= MIN_WIDTH_FOR_CARS && self.random.chance(0.6 * share) {
                let turn = if self.random.chance(0.9) { 0.0 } else { PI };
                self.park(position.moved(0.0, 0.0, turn));
            }
            along += PARKING_PLACE;
            place += 1;
        }
    }

    /// Parks a car if there is room.
    pub(crate) fn park(&mut self, placement: PlanPlacement) {
        let size = [4.4, 1.9];
        if self.is_free(&placement, size, 0.3) {
            let parts = car(&placement, self.ground(placement.origin));
            self.take_for(placement, size, Clearance::Trunk);
            self.add("car", &parts);
        }
    }

    /// Adds two masts with a pair of wires between them, if there is room for both masts.
    pub(crate) fn wired_masts(&mut self, placements: [PlanPlacement; 2]) {
        if !placements.iter().all(|placement| self.is_free(placement, [0.3, 0.3], 0.2)) {
            return;
        }
        let tops = placements.map(|placement| {
            let ground = self.ground(placement.origin);
            self.take_for(placement, [0.3, 0.3], Clearance::Trunk);
            self.add("mast", &mast(&placement, ground, MAST_HEIGHT));
            [placement.origin[0], placement.origin[1], ground + MAST_HEIGHT]
        });
        let span = (tops[1][0] - tops[0][0]).hypot(tops[1][1] - tops[0][1]);
        for below_top in [0.4, 0.9] {
            let [from, to] = tops.map(|[x, y, top]| [x, y, top - below_top]);
            self.add("wire", &[wire(from, to, 0.015 * span)]);
        }
        // Crowns keep off the wires.
        let middle = [0, 1].map(|axis| (tops[0][axis] + tops[1][axis]) / 2.0);
        let angle = (tops[1][1] - tops[0][1]).atan2(tops[1][0] - tops[0][0]);
        self.take_for(PlanPlacement { origin: middle, angle }, [span, 0.1], Clearance::Crown);
    }

    fn bus_stop(&mut self, placement: PlanPlacement) {
        let size = [4.2, 1.5];
        if self.is_free(&placement, size, 0.3) {
            self.canopy(placement, size, 2.5, 0.12, 3.0);
        }
    }

    /// Adds a roof over open ground: a slab of `size` with its underside `clear` metres above the ground at its middle.
    /// Its posts are at most `spacing` metres apart.
    pub(crate) fn canopy(
        &mut self,
        placement: PlanPlacement,
        size: [f64; 2],
        clear: f64,
        thickness: f64,
        spacing: f64,
    ) {
        let parts = self.canopy_parts(placement, size, clear, thickness, spacing);
        self.add("canopy", &parts);
    }

    /// Returns the solids of a canopy, the slab first, so that others can be put on it. Takes the ground of the canopy.
    pub(crate) fn canopy_parts(
        &mut self,
        placement: PlanPlacement,
        size: [f64; 2],
        clear: f64,
        thickness: f64,
        spacing: f64,
    ) -> Vec<ObjectPart> {
        let inset = 0.1 * size[0].min(size[1]);
        let post_side = if clear < 3.0 { 0.1 } else { 0.3 };
        let underside = self.ground(placement.origin) + clear;
        let shape = PostedSlab { size, underside, thickness, post_side, inset: inset.max(post_side), spacing };
        self.take(placement, size[0], size[1]);
        posted_slab(&placement, &shape, &self.terrain)
    }

    /// Adds a deck to walk on and under, as a canopy with a thicker slab. Its ends may lie inside buildings by
    /// [`JOINT`].
    pub(crate) fn deck(&mut self, placement: PlanPlacement, size: [f64; 2], clear: f64) {
        let underside = self.ground(placement.origin) + clear;
        let inset = 1.0 + JOINT;
        let shape = PostedSlab { size, underside, thickness: 0.28, post_side: 0.35, inset, spacing: 6.0 };
        let parts = posted_slab(&placement, &shape, &self.terrain);
        self.take(placement, size[0], size[1]);
        self.add("deck", &parts);
    }
}
