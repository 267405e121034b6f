//! Lines of sight from the cells of a tile, and the areas where obstacles may block them.

use crate::grid::{LINE_ROOM, MapArea, TileId, block_area};
use crate::plan::Plan;
use crate::plan::prepared::SightLines;
use belvedere::apps::viewshed::Observer;
use belvedere::query::EarthParams;
use belvedere::vector::piece_in_box;
use std::collections::BTreeSet;

/// Number of directions up to which each is tested by itself.
const FEW: usize = 8;
/// Maximum distance above and beside its points that a ball reaches, metres: twice the initial radius of balls.
pub(crate) const MAX_BALL: f64 = 10.0;

/// Lines of sight from targets over an area, none lower than `lowest`.
pub(crate) struct AreaLines<'a> {
    pub(crate) targets: MapArea,
    /// Minimum height of the targets, local metres.
    pub(crate) lowest: f64,
    to: To<'a>,
    /// Minimum slope of the directions, metres of height for each metre on the map.
    flattest: f64,
}

/// Ends of lines of sight.
pub(crate) enum To<'a> {
    /// Unit vectors upward, for lines without end.
    Directions(&'a [[f64; 3]]),
    /// Eyes, local metres, over the curved earth.
    Eyes(Vec<[f64; 3]>, EarthParams),
}

impl<'a> AreaLines<'a> {
    /// Returns those of `lines` that start in cells over an area.
    pub(crate) fn of(lines: &'a SightLines, targets: MapArea, lowest: f64) -> Self {
        match lines {
            SightLines::Directions(directions) => Self::towards(directions, targets, lowest),
            SightLines::Observers(observers, earth) => Self::to_observers((observers, earth), targets, lowest),
        }
    }

    /// Returns the lines in `directions`, unit vectors upward, from cells over an area.
    pub(crate) fn towards(directions: &'a [[f64; 3]], targets: MapArea, lowest: f64) -> Self {
        Self::new(targets, lowest, To::Directions(directions))
    }

    /// Returns the lines to observers, as far as these see, over the curved earth, from cells over an area.
    pub(crate) fn to_observers((observers, earth): (&[Observer], &EarthParams), targets: MapArea, lowest: f64) -> Self {
        let is_near = |eye: &[f64; 3], reach: f64| targets.distance(&MapArea::at(*eye)) <= reach;
        let near = observers.iter().filter(|observer| is_near(&observer.eye, observer.limits.distance[1]));
        Self::new(targets, lowest, To::Eyes(near.map(|observer| observer.eye).collect(), *earth))
    }

    fn new(targets: MapArea, lowest: f64, to: To<'a>) -> Self {
        let slope = |d: &[f64; 3]| d[2] / d[0].hypot(d[1]).max(1e-12);
        let flattest = match &to {
            To::Directions(directions) => directions.iter().map(slope).fold(f64::INFINITY, f64::min),
            To::Eyes(..) => f64::INFINITY,
        };
        Self { targets, lowest, to, flattest }
    }

    /// True if there is no line.
    pub(crate) fn is_empty(&self) -> bool {
        match &self.to {
            To::Directions(directions) => directions.is_empty(),
            To::Eyes(eyes, _) => eyes.is_empty(),
        }
    }

    /// Returns true if an obstacle over `area`, no higher than `top`, local metres, may block one of the lines.
    pub(crate) fn may_meet(&self, area: &MapArea, top: f64) -> bool {
        match &self.to {
            To::Directions(directions) => self.may_meet_towards(directions, area, top),
            To::Eyes(eyes, earth) => eyes.iter().any(|&eye| self.may_meet_from((eye, earth), area, top)),
        }
    }

    fn may_meet_towards(&self, directions: &[[f64; 3]], area: &MapArea, top: f64) -> bool {
        let rise = top - self.lowest + LINE_ROOM;
        if rise < 0.0 {
            return false;
        }
        if self.targets.distance(area) * self.flattest > rise {
            return false;
        }
        directions.len() > FEW || directions.iter().any(|direction| self.meets_along(direction, area, rise))
    }

    /// Returns true if an obstacle over `area` may block lines in one direction, with the azimuth of the direction
    /// taken into account.
    fn meets_along(&self, direction: &[f64; 3], area: &MapArea, rise: f64) -> bool {
        let level = direction[0].hypot(direction[1]);
        if level < 1e-9 {
            return self.targets.distance(area) <= LINE_ROOM;
        }
        let along = [direction[0] / level, direction[1] / level];
        let across = [-along[1], along[0]];
        let ([left, right], [own_left, own_right]) = (area.span(across), self.targets.span(across));
        let ([near, far], [back, front]) = (area.span(along), self.targets.span(along));
        let beside = left > own_right + LINE_ROOM || own_left > right + LINE_ROOM;
        let behind = far < back - LINE_ROOM;
        !beside && !behind && (near - front).max(0.0) * direction[2] / level <= rise
    }

    /// Returns true if an obstacle over `area` may block lines that end in an eye.
    fn may_meet_from(&self, (eye, earth): ([f64; 3], &EarthParams), area: &MapArea, top: f64) -> bool {
        let place = MapArea::at(eye);
        // On the map: apart if any axis separates the area from both the eye and the targets.
        let sides = self.targets.corners().map(|corner| [eye[1] - corner[1], corner[0] - eye[0]]);
        let axes = sides.into_iter().map(|[x, y]| [x / x.hypot(y).max(1e-12), y / x.hypot(y).max(1e-12)]);
        let is_apart = |axis: [f64; 2]| {
            let ([low, high], [eye_low, eye_high]) = (area.span(axis), place.span(axis));
            let [own_low, own_high] = self.targets.span(axis);
            low > own_high.max(eye_high) + LINE_ROOM || high < own_low.min(eye_low) - LINE_ROOM
        };
        if axes.chain([[1.0, 0.0], [0.0, 1.0]]).any(is_apart) {
            return false;
        }
        // Lines that fall towards the targets are lowest at the far side of the area.
        let (nearest, farthest) = (place.distance(&self.targets), place.farthest(&self.targets));
        let share = if nearest > 0.0 { (place.farthest(area) / nearest).min(1.0) } else { 1.0 };
        let lowest = eye[2] + share * (self.lowest - eye[2]).min(0.0);
        top >= lowest - earth.sag(farthest, 0.5) - LINE_ROOM
    }
}

/// Returns the tiles whose balls may block `lines`.
pub(crate) fn tiles(plan: &Plan, lines: &AreaLines<'_>) -> Vec<TileId> {
    let grid = plan.grid();
    let is_planned = |tile: &TileId| plan.tiles.binary_search(tile).is_ok();
    let mut tiles = BTreeSet::new();
    for block in &plan.blocks {
        let area = block_area(block.at).widened(MAX_BALL);
        if !lines.may_meet(&area, f64::from(block.heights[1]) + MAX_BALL) {
            continue;
        }
        let (first, last) = (grid.tile_of(area.low), grid.tile_of(area.high));
        for north in first.north..=last.north {
            tiles.extend((first.east..=last.east).map(|east| TileId { north, east }).filter(is_planned));
        }
    }
    tiles.into_iter().collect()
}

/// Returns true if the line of sight from a target, local metres, may meet obstacles over `area` up to `top`. The line
/// ends after `length` times the vector `way`, or never.
pub(crate) fn passes(target: [f64; 3], way: [f64; 3], length: f64, area: &MapArea, top: f64) -> bool {
    let sides = [0, 1].map(|axis| [area.low[axis] - target[axis], area.high[axis] - target[axis]]);
    let over = piece_in_box(sides, [way[0], way[1]], [0.0, length]);
    over.is_some_and(|[from, to]| target[2] + way[2] * (if way[2] >= 0.0 { from } else { to }) <= top)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TARGETS: MapArea = MapArea { low: [0.0, 0.0], high: [100.0, 100.0] };

    fn place(x: f64, y: f64) -> MapArea {
        MapArea { low: [x, y], high: [x + 1.0, y + 1.0] }
    }

    #[test]
    fn only_what_stands_towards_the_sun_and_high_enough_may_block_it() {
        // A sun in the east, 45 degrees high.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let directions = [[half, 0.0, half]];
        let lines = AreaLines::new(TARGETS, 0.0, To::Directions(&directions));
        for (area, top, expected) in [
            (place(150.0, 50.0), 60.0, true),
            (place(150.0, 50.0), 40.0, false),
            (place(-10.0, 50.0), 500.0, false),
            (place(150.0, 110.0), 500.0, false),
            (place(20.0, 20.0), 1.0, true),
            (place(20.0, 20.0), -1.0, false),
        ] {
            assert_eq!(lines.may_meet(&area, top), expected, "{area:?} {top}");
        }
        // Many directions: the azimuth does not count.
        let many = vec![[0.0, half, half]; FEW + 1];
        let lines = AreaLines::new(TARGETS, 0.0, To::Directions(&many));
        assert!(lines.may_meet(&place(150.0, 50.0), 60.0));
        assert!(!lines.may_meet(&place(150.0, 50.0), 40.0));
    }

    #[test]
    fn only_what_stands_between_eye_and_targets_and_high_enough_may_block_the_view() {
        // An eye 300 m east of the targets and 40 m above them.
        let lines = AreaLines::new(TARGETS, 0.0, To::Eyes(vec![[400.0, 50.0, 40.0]], EarthParams::default()));
        for (area, top, expected) in [
            (place(110.0, 50.0), 3.0, true),
            (place(110.0, 50.0), -1.0, false),
            // Lines half-way are no lower than 20 m, except lower lines to the near edge.
            (place(250.0, 50.0), 22.0, true),
            (place(250.0, 50.0), 18.0, false),
            (place(410.0, 50.0), 500.0, false),
            (place(-20.0, 50.0), 500.0, false),
            // Beside the triangle between eye and targets.
            (place(250.0, 90.0), 500.0, false),
            (place(110.0, 90.0), 500.0, true),
        ] {
            assert_eq!(lines.may_meet(&area, top), expected, "{area:?} {top}");
        }
        // An eye below the targets, among them.
        let lines = AreaLines::new(TARGETS, 10.0, To::Eyes(vec![[50.0, 50.0, 2.0]], EarthParams::default()));
        assert!(lines.may_meet(&place(70.0, 70.0), 3.0));
        assert!(!lines.may_meet(&place(70.0, 70.0), 1.0));
        assert!(!lines.may_meet(&place(120.0, 70.0), 90.0));
    }

    #[test]
    fn a_line_passes_what_stands_above_it_on_its_way() {
        let area = MapArea { low: [10.0, -5.0], high: [20.0, 5.0] };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let towards = |target, way| passes(target, way, f64::INFINITY, &area, 30.0);
        assert!(towards([0.0; 3], [half, 0.0, half]));
        assert!(!towards([0.0, 0.0, 25.0], [half, 0.0, half]));
        assert!(!towards([0.0; 3], [-half, 0.0, half]));
        assert!(!towards([0.0, 9.0, 0.0], [half, 0.0, half]));
        assert!(towards([15.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
        assert!(towards([0.0; 3], [1.0, 0.0, 0.0]) && !towards([0.0, 0.0, 31.0], [1.0, 0.0, 0.0]));
        // To an eye in front of the area, to one beyond it, and down from above.
        assert!(!passes([0.0; 3], [8.0, 0.0, 0.0], 1.0, &area, 30.0));
        assert!(passes([0.0; 3], [30.0, 0.0, 0.0], 1.0, &area, 30.0));
        assert!(passes([0.0, 0.0, 60.0], [40.0, 0.0, -70.0], 1.0, &area, 30.0));
        assert!(!passes([0.0, 0.0, 60.0], [40.0, 0.0, -50.0], 1.0, &area, 30.0));
    }
}
