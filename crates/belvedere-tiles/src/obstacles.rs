//! What can block lines of sight from a tile: the balls of all tiles that are high and near enough.

use crate::grid::{Area, CELL, TileId, block_area};
use crate::make_balls::square_of;
use crate::plan::Plan;
use crate::record::{Outcome, Record, Stage};
use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::io::read_balls;
use belvedere::medial::MedialBalls;
use belvedere::query::MedialScene;
use belvedere::{Error, Result};
use std::collections::BTreeSet;
use std::path::Path;

/// Directions up to which each is looked at by itself.
const FEW: usize = 8;
/// By how much lines of sight are taken for wider than they are, metres: more than f32 rounds.
const ROOM: f64 = 0.25;
/// How far above and beside its points any ball reaches at most, metres: twice the radius that they start with.
const MOST_BALL: f64 = 10.0;

/// Lines of sight from targets over an area, none lower than `lowest`.
pub(crate) struct Lines<'a> {
    pub(crate) targets: Area,
    /// Local metres.
    pub(crate) lowest: f64,
    /// Unit vectors upward.
    pub(crate) directions: &'a [[f64; 3]],
}

impl Lines<'_> {
    /// Whether something over `area` that is no higher than `top`, local metres, may block one of them.
    pub(crate) fn may_meet(&self, area: &Area, top: f64) -> bool {
        let rise = top - self.lowest + ROOM;
        if rise < 0.0 {
            return false;
        }
        let slope = |d: &[f64; 3]| d[2] / d[0].hypot(d[1]).max(1e-12);
        let flattest = self.directions.iter().map(slope).fold(f64::INFINITY, f64::min);
        if self.targets.distance(area) * flattest > rise {
            return false;
        }
        self.directions.len() > FEW || self.directions.iter().any(|direction| self.meets_along(direction, area, rise))
    }

    /// The same for one direction, of which it is known which way on the map it runs.
    fn meets_along(&self, direction: &[f64; 3], area: &Area, rise: f64) -> bool {
        let level = direction[0].hypot(direction[1]);
        if level < 1e-9 {
            return self.targets.distance(area) <= ROOM;
        }
        let along = [direction[0] / level, direction[1] / level];
        let across = [-along[1], along[0]];
        let span = |area: &Area, axis: [f64; 2]| {
            let corners = [area.low, [area.high[0], area.low[1]], [area.low[0], area.high[1]], area.high];
            let places = corners.map(|[x, y]| x * axis[0] + y * axis[1]);
            [places.into_iter().fold(f64::INFINITY, f64::min), places.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        };
        let ([left, right], [own_left, own_right]) = (span(area, across), span(&self.targets, across));
        let ([near, far], [back, front]) = (span(area, along), span(&self.targets, along));
        let beside = left > own_right + ROOM || own_left > right + ROOM;
        let behind = far < back - ROOM;
        !beside && !behind && (near - front).max(0.0) * direction[2] / level <= rise
    }
}

/// What blocks lines of sight from a tile.
pub(crate) struct Obstacles {
    pub(crate) scene: MedialScene,
    pub(crate) ball_count: usize,
    /// Where balls are missing: what may stand there, and how high.
    pub(crate) missing: Vec<(Area, f64)>,
}

/// The tiles whose balls may matter for `lines`.
pub(crate) fn tiles(plan: &Plan, lines: &Lines<'_>) -> Vec<TileId> {
    let grid = plan.grid();
    let is_planned = |tile: &TileId| plan.tiles.binary_search(tile).is_ok();
    let mut tiles = BTreeSet::new();
    for block in &plan.blocks {
        let area = block_area(block.at).widened(MOST_BALL);
        if !lines.may_meet(&area, f64::from(block.heights[1]) + MOST_BALL) {
            continue;
        }
        let (first, last) = (grid.tile_of(area.low), grid.tile_of(area.high));
        for north in first.north..=last.north {
            tiles.extend((first.east..=last.east).map(|east| TileId { north, east }).filter(is_planned));
        }
    }
    tiles.into_iter().collect()
}

impl Obstacles {
    /// Gathers the balls of the tiles that may matter for `lines`, as far as they are there.
    ///
    /// # Errors
    /// Those of [`read_balls`] and [`MedialScene::new`].
    pub(crate) fn gather(plan: &Plan, run: &Path, lines: &Lines<'_>, control: &Control<'_>) -> Result<Self> {
        let mut balls = MedialBalls::default();
        let mut missing = Vec::new();
        for tile in tiles(plan, lines) {
            control.check()?;
            let record = Record::read(plan, run, Stage::Balls, tile);
            match record.as_ref().map(|record| &record.outcome) {
                Some(Outcome::Nothing) => {}
                Some(Outcome::Done) => {
                    let tops = record.iter().flat_map(|record| &record.tops);
                    if tops.clone().any(|&(block, top)| lines.may_meet(&block_area(block), top.into())) {
                        match read_balls(Stage::Balls.result(run, tile)) {
                            Ok(parts) => add(&mut balls, &parts.balls, lines),
                            Err(Error::Cancelled) => return Err(Error::Cancelled),
                            // damaged since; it is unknown what stands there
                            Err(_) => missing.extend(unknown(plan, tile)),
                        }
                    }
                }
                Some(Outcome::Failed(_)) | None => missing.extend(unknown(plan, tile)),
            }
        }
        let rule = if plan.facts.carves { BlockRule::carved() } else { BlockRule::uncarved() };
        let ball_count = balls.len();
        let scene = control.stage("indexing balls", ball_count, || MedialScene::new(&balls, &rule))?;
        Ok(Self { scene, ball_count, missing })
    }

    /// Whether a line of sight from a target, local metres, along an upward unit vector may meet what is missing.
    pub(crate) fn is_unknown(&self, target: [f64; 3], direction: [f64; 3]) -> bool {
        self.missing.iter().any(|(area, top)| {
            let (mut from, mut to) = (0.0_f64, ((top - target[2]) / direction[2]).max(-1.0));
            for axis in 0..2 {
                let (low, high) = (area.low[axis] - target[axis], area.high[axis] - target[axis]);
                if direction[axis] == 0.0 {
                    if low > 0.0 || high < 0.0 {
                        return false;
                    }
                    continue;
                }
                let (a, b) = (low / direction[axis], high / direction[axis]);
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            }
            from <= to
        })
    }
}

/// Adds those of `more` that may block one of `lines`.
fn add(balls: &mut MedialBalls, more: &MedialBalls, lines: &Lines<'_>) {
    for (row, (&center, &radius)) in more.centers.iter().zip(&more.radii).enumerate() {
        if lines.may_meet(&square_of(center, radius), f64::from(center[2]) + f64::from(radius)) {
            let touch = more.touch.get(row).copied().unwrap_or(belvedere::medial::PULSE_TOUCH);
            balls.push(0, center, radius, touch);
        }
    }
}

/// What may stand on a tile of which nothing is known but how high its points are.
fn unknown(plan: &Plan, tile: TileId) -> Vec<(Area, f64)> {
    let core = plan.grid().core(tile);
    let part = |block: &crate::survey::Block| {
        let own = block_area(block.at);
        let low = [0, 1].map(|axis| own.low[axis].max(core.low[axis]));
        let high = [0, 1].map(|axis| (own.low[axis] + CELL).min(core.high[axis]));
        (Area { low, high }.widened(MOST_BALL), f64::from(block.heights[1]) + MOST_BALL)
    };
    plan.blocks_in(&core).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TARGETS: Area = Area { low: [0.0, 0.0], high: [100.0, 100.0] };

    fn place(x: f64, y: f64) -> Area {
        Area { low: [x, y], high: [x + 1.0, y + 1.0] }
    }

    #[test]
    fn only_what_stands_towards_the_sun_and_high_enough_may_block_it() {
        // a sun in the east, 45 degrees high
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let directions = [[half, 0.0, half]];
        let lines = Lines { targets: TARGETS, lowest: 0.0, directions: &directions };
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
        // many directions: whatever the azimuth
        let many = vec![[0.0, half, half]; FEW + 1];
        let lines = Lines { targets: TARGETS, lowest: 0.0, directions: &many };
        assert!(lines.may_meet(&place(150.0, 50.0), 60.0));
        assert!(!lines.may_meet(&place(150.0, 50.0), 40.0));
    }

    #[test]
    fn a_line_is_unknown_where_it_runs_below_what_is_missing() {
        let scene = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
        let missing = vec![(Area { low: [10.0, -5.0], high: [20.0, 5.0] }, 30.0)];
        let obstacles = Obstacles { scene, ball_count: 0, missing };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        assert!(obstacles.is_unknown([0.0; 3], [half, 0.0, half]));
        assert!(!obstacles.is_unknown([0.0, 0.0, 25.0], [half, 0.0, half]));
        assert!(!obstacles.is_unknown([0.0; 3], [-half, 0.0, half]));
        assert!(!obstacles.is_unknown([0.0, 9.0, 0.0], [half, 0.0, half]));
        assert!(obstacles.is_unknown([15.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    }
}
