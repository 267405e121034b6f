//! The skyline around a place: how high the sky begins in each direction.

use crate::blocking::Ball;
use crate::query::{Blocker, EarthParams, MedialScene};
use crate::triangle_tree::Corners;
use belvedere_data::Result;
use belvedere_data::cast::to_i64;
use belvedere_data::control::Control;
use belvedere_data::vector::{length, sub};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Balls handed to a thread at once.
const CHUNK: usize = 1 << 15;

/// Lower edge of the sky in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkylinePoint {
    /// The least elevation above which nothing blocks up to the zenith, radians, −π/2 (nothing blocks at all) to π/2
    /// (the zenith is hidden).
    pub elevation: f64,
    /// Range of the obstacle, metres; infinite without one, and for far terrain.
    pub range: f64,
    /// Obstacle there; `None` for far terrain and for no obstacle.
    pub blocker: Option<Blocker>,
}

const EMPTY: SkylinePoint = SkylinePoint { elevation: -FRAC_PI_2, range: f64::INFINITY, blocker: None };

impl SkylinePoint {
    /// The higher of two; of equally high ones that of the lower row, so that their order does not matter.
    fn or(self, other: Self) -> Self {
        let comes_first = match (self.blocker, other.blocker) {
            (Some(own), Some(other)) => other < own,
            (own, other) => own.is_none() && other.is_some(),
        };
        match self.elevation.total_cmp(&other.elevation) {
            std::cmp::Ordering::Less => other,
            std::cmp::Ordering::Equal if comes_first => other,
            _ => self,
        }
    }
}

impl MedialScene {
    /// The skyline around `eye`, local metres: at `count` azimuths, the first north, clockwise in equal steps. Empty
    /// for an eye that is not finite.
    ///
    /// Exact for the union of balls, for added meshes and for surface patches, by the tangents of every ball in the
    /// vertical plane of each azimuth. Nothing that floats above a gap is missed, and there is no step to choose. The
    /// eye may be a place on a surface: balls give way to it by [`crate::blocking::BlockRule::shell`] as to any target.
    /// Balls that hold it even so are left out; [`MedialScene::enclosure`] returns them. Over the earth of `earth` far
    /// balls sink.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn skyline(
        &self,
        eye: [f64; 3],
        count: usize,
        earth: &EarthParams,
        control: &Control<'_>,
    ) -> Result<Vec<SkylinePoint>> {
        self.skyline_from(eye, count, 0.0, earth, control)
    }

    /// [`MedialScene::skyline`] whose first azimuth is `first`, radians clockwise from grid north.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn skyline_from(
        &self,
        eye: [f64; 3],
        count: usize,
        first: f64,
        earth: &EarthParams,
        control: &Control<'_>,
    ) -> Result<Vec<SkylinePoint>> {
        let mut skyline = self.skyline_of_cloud(eye, count, first, earth, control)?;
        if !self.far_terrain.is_empty() && !skyline.is_empty() {
            let elevations = self.far_terrain.elevations(eye, [first, TAU / count as f64], count, earth);
            for (point, elevation) in skyline.iter_mut().zip(elevations) {
                if elevation > point.elevation {
                    *point = SkylinePoint { elevation, ..EMPTY };
                }
            }
        }
        Ok(skyline)
    }

    /// [`MedialScene::skyline_from`] without the terrain beyond the cloud.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn skyline_of_cloud(
        &self,
        eye: [f64; 3],
        count: usize,
        first: f64,
        earth: &EarthParams,
        control: &Control<'_>,
    ) -> Result<Vec<SkylinePoint>> {
        if count == 0 || !eye.iter().all(|v| v.is_finite()) || !first.is_finite() {
            return Ok(Vec::new());
        }
        let step = TAU / count as f64;
        // sines and cosines of the azimuths
        let directions: Vec<[f64; 2]> = (0..count).map(|i| (first + i as f64 * step).sin_cos().into()).collect();
        let of_balls = self
            .tree()
            .balls()
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, balls)| {
                control.check()?;
                let mut skyline = vec![EMPTY; count];
                for (i, &ball) in balls.iter().enumerate() {
                    let Some((offset, radius)) = self.offset_and_radius(eye, ball, earth) else { continue };
                    let blocker = self.blocker_of_ball(chunk * CHUNK + i);
                    each_azimuth(offset, radius, [first, step], count, |azimuth| {
                        if let Some((elevation, range)) = top(offset, radius, directions[azimuth]) {
                            skyline[azimuth] = skyline[azimuth].or(SkylinePoint { elevation, range, blocker });
                        }
                    });
                }
                Ok(skyline)
            })
            .try_reduce(|| vec![EMPTY; count], |a, b| Ok(a.into_iter().zip(b).map(|(a, b)| a.or(b)).collect()));
        let mut skyline = of_balls?;
        for (corners, blocker) in self.triangles().into_iter().flat_map(|triangles| triangles.triangles_before(eye)) {
            control.check()?;
            let corners = corners.map(|corner| self.offset(eye, corner, earth));
            let middle = std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
            let radius = corners.iter().map(|&corner| length(sub(corner, middle))).fold(0.0, f64::max);
            each_azimuth(middle, radius, [first, step], count, |azimuth| {
                if let Some((elevation, range)) = top_of_triangle(&corners, directions[azimuth]) {
                    let blocker = Some(blocker);
                    skyline[azimuth] = skyline[azimuth].or(SkylinePoint { elevation, range, blocker });
                }
            });
        }
        Ok(skyline)
    }

    /// Returns the vector from the eye to a place; over a curved earth far places sink.
    fn offset(&self, eye: [f64; 3], place: [f64; 3], earth: &EarthParams) -> [f64; 3] {
        let mut offset = sub(place, eye);
        if earth.bends(eye, place) {
            offset[2] -= earth.fall(offset[0].hypot(offset[1]));
        }
        offset
    }

    /// Returns the vector from the eye to the centre of a ball, and its reduced radius; `None` if it holds the eye even
    /// so.
    fn offset_and_radius(&self, eye: [f64; 3], ball: Ball, earth: &EarthParams) -> Option<([f64; 3], f64)> {
        let (mut offset, radius) = self.tree().rule().seen_from(ball, eye)?;
        if earth.bends(eye, ball.center.map(f64::from)) {
            offset[2] -= earth.fall(offset[0].hypot(offset[1]));
        }
        Some((offset, radius))
    }
}

/// Calls `visit` for each azimuth at which the vertical half plane from the eye meets a ball.
fn each_azimuth([x, y, _]: [f64; 3], radius: f64, [first, step]: [f64; 2], count: usize, mut visit: impl FnMut(usize)) {
    let across = x.hypot(y);
    if across <= radius {
        (0..count).for_each(visit);
        return;
    }
    let (middle, half) = ((x.atan2(y) - first).rem_euclid(TAU), (radius / across).asin());
    // a step of rounding outward costs nothing: the exact test follows
    let (from, to) = (((middle - half) / step - 1e-9).ceil(), ((middle + half) / step + 1e-9).floor());
    let (from, to) = (to_i64(from), to_i64(to));
    #[expect(clippy::cast_possible_wrap, clippy::cast_possible_truncation, reason = "below count")]
    (from..=to).for_each(|i| visit(i.rem_euclid(count as i64) as usize));
}

/// The highest elevation at which a half plane meets a ball, and the range of the tangent there.
fn top([x, y, z]: [f64; 3], radius: f64, [sin, cos]: [f64; 2]) -> Option<(f64, f64)> {
    let (ahead, aside) = (x * sin + y * cos, x * cos - y * sin);
    let disc = radius * radius - aside * aside;
    let square = ahead * ahead + z * z;
    if disc <= 0.0 || square <= disc {
        return None;
    }
    let (middle, half) = (z.atan2(ahead), (disc / square).sqrt().asin());
    // the disc may reach over the vertical through the eye, into the half plane behind it or from there
    let in_front = middle - half < FRAC_PI_2 && middle + half > -FRAC_PI_2;
    in_front.then(|| ((middle + half).min(FRAC_PI_2), (square - disc).sqrt()))
}

/// The highest elevation at which a half plane meets a triangle, corners from the eye, and the range there.
fn top_of_triangle(corners: &Corners, [sin, cos]: [f64; 2]) -> Option<(f64, f64)> {
    let [from, to] = cut(corners, [sin, cos])?;
    if from[0] < 0.0 && to[0] < 0.0 {
        return None;
    }
    // elevations along a piece lie between those of its ends; what lies behind the eye is cut off
    let ends = [(from, to), (to, from)].map(|(end, other)| match end[0] < 0.0 {
        true => [0.0, end[1] + (other[1] - end[1]) * -end[0] / (other[0] - end[0])],
        false => end,
    });
    let point = |[ahead, up]: [f64; 2]| (up.atan2(ahead), ahead.hypot(up));
    let [a, b] = ends.map(point);
    Some(if a.0 > b.0 || (a.0 == b.0 && a.1 < b.1) { a } else { b })
}

/// The piece of a triangle in the vertical plane along an azimuth (its sine and cosine) through the origin: ahead and
/// up.
pub(super) fn cut(corners: &Corners, [sin, cos]: [f64; 2]) -> Option<[[f64; 2]; 2]> {
    let flat = corners.map(|[x, y, z]| (x * cos - y * sin, [x * sin + y * cos, z]));
    let mut ends: Option<[[f64; 2]; 2]> = None;
    let mut take = |place: [f64; 2]| {
        let [low, high] = ends.unwrap_or([place; 2]);
        let before = |a: [f64; 2], b: [f64; 2]| (a[0], a[1]) < (b[0], b[1]);
        ends = Some([if before(place, low) { place } else { low }, if before(high, place) { place } else { high }]);
    };
    for (i, &(aside, place)) in flat.iter().enumerate() {
        let (next_aside, next) = flat[(i + 1) % 3];
        if aside == 0.0 {
            take(place);
        }
        if (aside < 0.0) != (next_aside < 0.0) && aside != 0.0 && next_aside != 0.0 {
            let share = aside / (aside - next_aside);
            take([0, 1].map(|k| place[k] + share * (next[k] - place[k])));
        }
    }
    ends
}
