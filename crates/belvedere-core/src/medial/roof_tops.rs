//! Roofs that pulses left partly without points: a building does not reach above the top of its roof.
//!
//! Between two strips, and where a surface is too dark or too smooth, a roof has few points or none. Balls of the walls
//! below it then bulge out of it, as far as the next pulse.

use super::cells::{Cells, cell};
use crate::normals::OrientedCloud;
use rayon::prelude::*;

/// Minimum upward part of the normal of a roof: 60° of slope.
pub(super) const MIN_UP: f32 = 0.5;

/// Heights of the highest points in cells of the map.
pub(super) struct RoofTops<'a> {
    /// Heights of all points.
    all: &'a Cells<f32>,
    /// Highest point in a cell and its neighbours.
    near: Cells<f32>,
    /// Heights of points on roofs and on level ground.
    level: Cells<f32>,
    /// Maximum height of a ball above the top of a roof, metres.
    penetration: f32,
    /// Radius below which balls are not cut, metres.
    min_radius: f32,
}

impl<'a> RoofTops<'a> {
    /// Collects the roof tops of `oriented`; `all` are the heights that [`super::cells::highest`] returns.
    pub(super) fn new(oriented: &OrientedCloud, all: &'a Cells<f32>, penetration: f32, min_radius: f32) -> Self {
        let points = oriented.positions().par_iter().zip(oriented.normals());
        let level = points.filter(|(_, normal)| normal[2] >= MIN_UP).map(|(&p, _)| (cell(p), p[2]));
        let level = Cells::new(level.collect(), f32::max);
        Self { all, near: all.with_neighbors(f32::max), level, penetration, min_radius }
    }

    /// Returns the remaining radius of a ball at a point of height `z`, with an outward normal whose upward part is
    /// `up`. A ball is cut where it rises above every point over its whole width. The top of the building is known only
    /// if the highest of these points lies on a roof; other balls are unchanged.
    pub(super) fn radius(&self, center: [f32; 3], radius: f32, z: f32, up: f32) -> f32 {
        let top = if up < 1.0 { self.roof_height(center, radius) } else { None };
        let Some(top) = top else { return radius };
        // the ball of radius r at this point ends r (1 - up) above it
        let left = (top + self.penetration - z) / (1.0 - up);
        radius.min(left.max(self.min_radius))
    }

    /// Returns the height of the roof over a ball: that of the highest point over its whole width. `None` if the ball
    /// does not rise above that, or if that point is higher above every roof than a ball may be.
    fn roof_height(&self, center: [f32; 3], radius: f32) -> Option<f32> {
        let tolerance = self.penetration;
        let is_below = |highest: f32| highest >= center[2] + radius - tolerance;
        // most balls lie below the points about their middle
        if self.near.get(cell(center)).is_some_and(is_below) {
            return None;
        }
        let [low, high] = [-radius, radius].map(|off| cell([center[0] + off, center[1] + off, center[2]]));
        let highest = self.all.in_rectangle(low, high, f32::max).filter(|&highest| !is_below(highest))?;
        let level = self.level.in_rectangle(low, high, f32::max)?;
        (level >= highest - tolerance).then_some(highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medial::cells::highest;
    use crate::medial::marks::{self, cuts_of};
    use belvedere_data::balls::MedialBalls;
    use belvedere_data::control::Control;

    const PENETRATION: f32 = 0.05;
    const MIN_RADIUS: f32 = 0.5;

    /// A wall from the ground to a height of 9 m, and points 0.25 m apart on the roof behind it from `from` metres
    /// behind it on.
    fn building(from: f32) -> OrientedCloud {
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        for i in 0_u8..36 {
            for k in 0_u8..40 {
                let (along, across) = (f32::from(k) * 0.25 - 5.0, f32::from(i) * 0.25);
                positions.push([0.0, along, across]);
                normals.push([-1.0, 0.0, 0.0]);
                if across + 0.25 > from {
                    positions.push([across + 0.25, along, 9.0]);
                    normals.push([0.0, 0.0, 1.0]);
                }
            }
        }
        OrientedCloud::with_known_normals(positions, normals).unwrap()
    }

    /// The balls of radius 3 m of all points of the wall.
    fn balls(oriented: &OrientedCloud) -> MedialBalls {
        let mut balls = MedialBalls::default();
        for (row, (p, n)) in oriented.positions().iter().zip(oriented.normals()).enumerate() {
            let radius = if n[0] < 0.0 { 3.0 } else { 0.1 };
            balls.push(row, std::array::from_fn(|i| p[i] - radius * n[i]), radius, 7);
        }
        balls
    }

    fn cut(oriented: &OrientedCloud, balls: &mut MedialBalls) -> usize {
        let all = highest(oriented.positions());
        let tops = RoofTops::new(oriented, &all, PENETRATION, MIN_RADIUS);
        let (positions, normals) = (oriented.positions(), oriented.normals());
        let cuts = cuts_of(balls, MIN_RADIUS, &Control::none(), |row| {
            tops.radius(balls.centers[row], balls.radii[row], positions[row][2], normals[row][2])
        })
        .unwrap();
        marks::cut(balls, oriented, &cuts);
        cuts.len()
    }

    #[test]
    fn balls_of_a_wall_end_at_the_roof_that_is_partly_without_points() {
        let oriented = building(4.0);
        let mut found = balls(&oriented);
        assert!(cut(&oriented, &mut found) > 0);
        for (center, radius) in found.centers.iter().zip(&found.radii) {
            // what is no larger than the least radius is not cut
            let most = if *radius > MIN_RADIUS { 9.0 + PENETRATION } else { 9.0 + 2.0 * radius };
            assert!(center[2] + radius < most + 1e-4, "{center:?} {radius}");
        }
    }

    #[test]
    fn balls_below_the_roof_stay() {
        let oriented = building(4.0);
        let mut found = balls(&oriented);
        let before = found.clone();
        cut(&oriented, &mut found);
        for (row, center) in before.centers.iter().enumerate().filter(|(_, center)| center[2] <= 6.0) {
            assert_eq!((found.centers[row], found.radii[row]), (*center, before.radii[row]));
        }
    }

    #[test]
    fn without_a_point_of_the_roof_its_height_is_not_known_and_balls_stay() {
        let oriented = building(f32::INFINITY);
        let mut found = balls(&oriented);
        let before = found.clone();
        assert_eq!(cut(&oriented, &mut found), 0);
        assert_eq!((found.centers, found.radii), (before.centers, before.radii));
    }
}
