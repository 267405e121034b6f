//! Balls and boxes of the index as beams take them: by column, so that several are tested at once.

use crate::blocking::Ball;
use crate::ray_index::{PARTS, Parts};
use belvedere_data::vector::{cross, dot};

/// Balls that are tested side by side.
pub(super) const LANES: usize = 8;

/// A node of the index as a box, local metres.
#[derive(Clone, Copy)]
pub(super) struct Node {
    pub(super) center: [f32; 3],
    pub(super) half: [f32; 3],
    pub(super) number: u32,
}

impl Node {
    pub(super) fn of(number: u32, parts: &Parts, lane: usize) -> Self {
        let part = |sides: &[[f32; PARTS]; 3]| sides.map(|sides| sides[lane]);
        Self { center: part(&parts.centers), half: part(&parts.half_sizes), number }
    }
}

/// Balls by column, so that several are tested at once; padded to whole lanes with balls that nothing meets.
#[derive(Default)]
pub(super) struct BallColumns {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    radius: Vec<f32>,
    pub(super) row: Vec<u32>,
}

impl BallColumns {
    /// Fills up the lanes.
    pub(super) fn pad(&mut self) {
        while !self.len().is_multiple_of(LANES) {
            self.push(Ball { center: [0.0; 3], radius: f32::NEG_INFINITY }, 0);
        }
    }

    pub(super) fn len(&self) -> usize {
        self.row.len()
    }

    #[inline]
    pub(super) fn push(&mut self, ball: Ball, row: u32) {
        self.x.push(ball.center[0]);
        self.y.push(ball.center[1]);
        self.z.push(ball.center[2]);
        self.radius.push(ball.radius);
        self.row.push(row);
    }

    #[inline]
    pub(super) fn get(&self, place: usize) -> (Ball, u32) {
        let center = [self.x[place], self.y[place], self.z[place]];
        (Ball { center, radius: self.radius[place] }, self.row[place])
    }

    pub(super) fn truncate(&mut self, length: usize) {
        self.x.truncate(length);
        self.y.truncate(length);
        self.z.truncate(length);
        self.radius.truncate(length);
        self.row.truncate(length);
    }

    /// Centres and radii of `LANES` balls from `start` on.
    #[inline(always)]
    pub(super) fn lanes(&self, start: usize) -> [[f32; LANES]; 4] {
        [&self.x, &self.y, &self.z, &self.radius].map(|column| {
            column.get(start..start + LANES).and_then(|lanes| lanes.try_into().ok()).unwrap_or([f32::NAN; LANES])
        })
    }

    /// Which of the balls from `start` on may touch the half line from `origin` along the unit vector `direction`.
    #[inline]
    pub(super) fn near_line(&self, start: usize, origin: [f32; 3], direction: [f32; 3], room: f32) -> [bool; LANES] {
        let [x, y, z, radius] = self.lanes(start);
        std::array::from_fn(|lane| {
            let m = [x[lane] - origin[0], y[lane] - origin[1], z[lane] - origin[2]];
            let across = cross(m, direction);
            let reach = radius[lane] + room;
            (dot(across, across) <= reach * reach) & (dot(m, direction) >= -reach) & (reach > 0.0)
        })
    }
}
