//! Balls in views from an eye: how far away a ball's surface is in the direction of a pixel.
//!
//! Only the angle between that direction and the direction of the ball's centre matters, so that one test covers every
//! projection. The directions of the pixels and the outline of a ball differ.

use super::ball_bound::{BallBound, BoundSide, margin};
use super::outline::{ALL, outline};
use super::tiles::{BLOCK, SplatSurface, TILE};
use belvedere_data::vector::{cross, length, to_f32};
use belvedere_data::view::{Projection, View};

/// A ball as seen from the eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct CentralSplat {
    /// Centre along right, down and forward, metres.
    center: [f32; 3],
    radius: f32,
    /// More than f32 errs by at this ball, metres.
    margin: f32,
    /// Lower bound of the depth that is drawn anywhere.
    near: f32,
    /// Columns and rows, pixels.
    extent: [[f32; 2]; 2],
    /// Row of the ball.
    ball: u32,
}

/// Position of a ball relative to a direction of sight: distance along it to the point nearest to the centre, and
/// squared distance from there to the centre.
#[derive(Clone, Copy)]
struct DirectionPassing {
    along: f32,
    beside_square: f32,
}

/// A turn by an angle: its cosine and sine.
#[derive(Clone, Copy)]
struct Turn {
    cos: f32,
    sin: f32,
}

impl Turn {
    /// A turn towards a ball that reaches at least as near as any direction within `angle`, radians.
    fn towards(angle: f64) -> Self {
        // a quarter turn on, everything may lie in the middle of the ball
        if angle < 1.5 {
            Self { cos: to_f32(angle.cos()), sin: to_f32(angle.sin()) }
        } else {
            Self { cos: -1.0, sin: 0.0 }
        }
    }

    /// A turn away from a ball that reaches at least as far as any direction within `angle`, radians.
    fn away(angle: f64) -> Self {
        if angle < 1.5 {
            Self { cos: to_f32(angle.cos()), sin: to_f32(angle.sin()) }
        } else {
            Self { cos: 0.0, sin: 1.0 }
        }
    }

    /// The passing of the direction nearest to the centre.
    #[inline(always)]
    fn nearest(self, passing: DirectionPassing, distance: f32) -> DirectionPassing {
        let beside = passing.beside_square.sqrt();
        let turned = beside * self.cos - passing.along * self.sin;
        let along = passing.along * self.cos + beside * self.sin;
        let reaches_middle = turned <= 0.0;
        DirectionPassing {
            along: if reaches_middle { distance } else { along },
            beside_square: if reaches_middle { 0.0 } else { turned * turned },
        }
    }

    /// The passing of the direction farthest from the centre.
    #[inline(always)]
    fn farthest(self, passing: DirectionPassing) -> DirectionPassing {
        let beside = passing.beside_square.sqrt();
        let turned = beside * self.cos + passing.along * self.sin;
        DirectionPassing { along: passing.along * self.cos - beside * self.sin, beside_square: turned * turned }
    }
}

/// Directions and bounds shared by the pixels of a tile.
pub(super) struct Directions {
    /// Unit vectors along right, down and forward.
    directions: [[f32; TILE * TILE]; 3],
    /// Depth per range of each pixel, and the least of them.
    depth_per_range: [f32; TILE * TILE],
    min_depth_per_range: f32,
    /// Turn from the middle of a block to anywhere within its pixels.
    block: Turn,
    /// Turn from the middle of a pixel to anywhere within it.
    pixel: [Turn; 2],
}

/// Surface of a ball that is drawn in a view from an eye.
pub(super) trait CentralSurface: Sync {
    /// Pixels beyond the outline of a ball whose depth may be finite.
    const BEYOND_PX: f32;
    /// True if depths are ranges in every view.
    const IN_RANGE: bool;
    /// The radius to draw with, or `None` where a ball does not count. `fronts` is the least and the most range of its
    /// front; nothing smaller than `min_cover` covers a pixel at its range.
    fn radius(&self, radius: f32, size: f64, fronts: [f64; 2], min_cover: f64) -> Option<f32>;
    /// The radius that a ball counts with in a view from an eye that is `distance` metres from its centre.
    fn radius_at_eye(&self, radius: f64, _distance: f64, _margin: f64) -> f64 {
        radius
    }
    /// Minimum and maximum depth drawn.
    fn limits(&self, view: &View) -> [f64; 2];
    /// Returns the area that a ball covers when its surface passes through the eye, or it holds the eye, so that its
    /// outline gives no information; `None` for no area.
    fn at_eye(&self, _distance: f64, _radius: f64, _margin: f64) -> Option<[[f64; 2]; 2]> {
        None
    }
    /// Depth in one direction, +∞ beside the ball.
    fn depth(&self, pixel: &PixelRay<'_>, splat: &CentralSplat) -> f32;
}

/// One direction past one ball.
pub(super) struct PixelRay<'a> {
    passing: DirectionPassing,
    distance: f32,
    depth_per_range: f32,
    limits: [f32; 2],
    turns: &'a [Turn; 2],
}

/// Balls in a view from an eye.
pub(super) struct Central<S> {
    view: View,
    limits: [f32; 2],
    /// Lower bound of the sine of the angle from the middle of any pixel to its corners.
    min_pixel: f64,
    surface: S,
}

impl<S: CentralSurface> Central<S> {
    pub(super) fn new(view: &View, surface: S) -> Self {
        let limits = surface.limits(view).map(to_f32);
        // pixels are smallest at the corners of a perspective picture and at those of a stereographic map
        let corner = view.direction([0.0; 2]);
        let inward = view.direction([0.5; 2]);
        let min_pixel = length(cross(corner, inward)) * 0.5;
        Self { view: *view, limits, min_pixel, surface }
    }

    fn is_in_range(&self) -> bool {
        S::IN_RANGE || matches!(self.view.projection, Projection::Hemispherical { .. })
    }

    /// Returns a lower bound of the angle between two directions through places of the picture, per pixel between them.
    /// The nearest such place is `off_middle` pixels from the middle of the picture.
    fn angle_per_pixel(&self, off_middle: f64) -> f64 {
        let (scale, steepness) = match self.view.projection {
            Projection::Orthographic { pixels_per_metre } => (pixels_per_metre, 0.0),
            // a step d from p turns the direction (p, 1) by at most d / |(p, 1)|
            Projection::Perspective { focal_px, .. } => {
                (focal_px, 1.0 / (1.0 + (off_middle / focal_px).powi(2)).sqrt())
            }
            // stereographic maps stretch all directions alike
            Projection::Hemispherical { radius_px, .. } => (radius_px, 2.0 / (1.0 + (off_middle / radius_px).powi(2))),
        };
        // a little more, so that rounding leaves no gap
        steepness / scale * 1.000_01
    }
}

impl<S: CentralSurface> SplatSurface for Central<S> {
    type Splat = CentralSplat;
    type PixelTile = Box<Directions>;

    fn place(&self, center: [f32; 3], radius: f32, ball: u32) -> Option<CentralSplat> {
        let center = self.view.frame.view_from_local(center);
        let distance = center.map(|v| v * v).iter().sum::<f64>().sqrt();
        let whole = f64::from(radius);
        if !distance.is_finite() {
            return None;
        }
        let size = center.iter().map(|v| v.abs()).sum();
        let margin = margin(size, whole);
        let whole = self.surface.radius_at_eye(whole, distance, margin);
        let radius = to_f32(whole);
        let silhouette = ((distance - whole) * (distance + whole)).max(0.0).sqrt();
        let radius = self.surface.radius(radius, size, [distance - whole, silhouette], distance * self.min_pixel)?;
        let extent = outline(&self.view, center, whole).or_else(|| self.surface.at_eye(distance, whole, margin))?;
        let inside = |[min, max]: [f64; 2], size: usize| max > -1.0 && min < size as f64 + 1.0;
        if !(inside(extent[0], self.view.size_px[0]) && inside(extent[1], self.view.size_px[1])) {
            return None;
        }
        let min = if self.is_in_range() { distance - f64::from(radius) } else { center[2] - f64::from(radius) };
        let [near, far] = self.limits;
        let near = to_f32(min - margin).max(near);
        let beyond = |[min, max]: [f64; 2]| [to_f32(min) - S::BEYOND_PX, to_f32(max) + S::BEYOND_PX];
        (near <= far).then_some(CentralSplat {
            center: center.map(to_f32),
            radius,
            margin: to_f32(margin),
            near,
            extent: extent.map(beyond),
            ball,
        })
    }

    fn ball(splat: &CentralSplat) -> u32 {
        splat.ball
    }

    fn nearest_depth(splat: &CentralSplat) -> f32 {
        splat.near
    }

    fn extent(&self, splat: &CentralSplat) -> [[f32; 2]; 2] {
        splat.extent
    }

    fn tile(&self, left: usize, top: usize) -> Box<Directions> {
        let middle = self.view.middle();
        let off = |middle: f64, from: usize| (from as f64 - middle).max(middle - (from + TILE) as f64).max(0.0);
        let angle = self.angle_per_pixel(off(middle[0], left).hypot(off(middle[1], top)));
        let pixel = angle * std::f64::consts::FRAC_1_SQRT_2;
        let mut tile = Box::new(Directions {
            directions: [[0.0; TILE * TILE]; 3],
            depth_per_range: [1.0; TILE * TILE],
            min_depth_per_range: 1.0,
            block: Turn::towards(pixel * (1.0 + BLOCK as f64)),
            pixel: [Turn::towards(pixel), Turn::away(pixel)],
        });
        for row in 0..TILE {
            for column in 0..TILE {
                let place = [(left + column) as f64 + 0.5, (top + row) as f64 + 0.5];
                let direction = self.view.direction(place);
                let at = row * TILE + column;
                for (axis, component) in direction.into_iter().enumerate() {
                    tile.directions[axis][at] = to_f32(component);
                }
                if !self.is_in_range() {
                    tile.depth_per_range[at] = to_f32(direction[2]);
                    tile.min_depth_per_range = tile.min_depth_per_range.min(to_f32(direction[2]));
                }
            }
        }
        tile
    }

    fn min_depth(&self, tile: &Self::PixelTile, splat: &CentralSplat, [column, row]: [usize; 2]) -> f32 {
        // the pixel right and below of the middle: half a pixel's diagonal off it
        let at = (row + BLOCK / 2) * TILE + column + BLOCK / 2;
        let direction = [0, 1, 2].map(|axis: usize| tile.directions[axis][at]);
        let distance = splat.center.map(|v| v * v).iter().sum::<f32>().sqrt();
        let passing = tile.block.nearest(passing(splat.center, direction), distance);
        let radius = splat.radius + splat.margin;
        let square = radius * radius - passing.beside_square;
        let half_chord = square.max(0.0).sqrt();
        if square > 0.0 && passing.along + half_chord >= 0.0 {
            (passing.along - half_chord).max(0.0) * tile.min_depth_per_range * (1.0 - 1e-6)
        } else {
            f32::INFINITY
        }
    }

    #[inline(always)]
    fn depths(&self, tile: &Self::PixelTile, splat: &CentralSplat, [column, row]: [usize; 2]) -> [f32; BLOCK] {
        let first = row * TILE + column;
        let [x, y, z] = [0, 1, 2].map(|axis: usize| &tile.directions[axis][first..][..BLOCK]);
        let depth_per_range = &tile.depth_per_range[first..][..BLOCK];
        let distance = splat.center.map(|v| v * v).iter().sum::<f32>().sqrt();
        std::array::from_fn(|lane| {
            let pixel = PixelRay {
                passing: passing(splat.center, [x[lane], y[lane], z[lane]]),
                distance,
                depth_per_range: depth_per_range[lane],
                limits: self.limits,
                turns: &tile.pixel,
            };
            self.surface.depth(&pixel, splat)
        })
    }
}

impl<S: CentralSurface> Central<S> {
    /// Depth of one ball at the centre of one pixel, as computed by [`SplatSurface::depths`].
    pub(super) fn depth_at(&self, splat: &CentralSplat, pixel: [usize; 2]) -> f32 {
        let direction = self.view.direction(pixel.map(|at| at as f64 + 0.5)).map(to_f32);
        let pixel = PixelRay {
            passing: passing(splat.center, direction),
            distance: splat.center.map(|v| v * v).iter().sum::<f32>().sqrt(),
            depth_per_range: if self.is_in_range() { 1.0 } else { direction[2] },
            limits: self.limits,
            turns: &[Turn { cos: 1.0, sin: 0.0 }; 2],
        };
        self.surface.depth(&pixel, splat)
    }
}

/// Returns the position of a centre relative to a unit vector of sight. The distance beside it is that of a vector
/// product, which does not cancel.
#[inline(always)]
fn passing([cx, cy, cz]: [f32; 3], [x, y, z]: [f32; 3]) -> DirectionPassing {
    let (across, down, forward) = (cy * z - cz * y, cz * x - cx * z, cx * y - cy * x);
    DirectionPassing {
        along: cx * x + cy * y + cz * z,
        beside_square: across * across + down * down + forward * forward,
    }
}

/// The sphere, sampled in the directions of pixel centres.
pub(super) struct CentralSphere;

impl CentralSurface for CentralSphere {
    const BEYOND_PX: f32 = 0.1;
    const IN_RANGE: bool = false;

    fn radius(&self, radius: f32, _: f64, [min, _]: [f64; 2], _: f64) -> Option<f32> {
        // a ball that holds the eye is left out
        (min > 0.0).then_some(radius)
    }

    fn limits(&self, view: &View) -> [f64; 2] {
        view.limits()
    }

    #[inline(always)]
    fn depth(&self, pixel: &PixelRay<'_>, splat: &CentralSplat) -> f32 {
        let [near, far] = pixel.limits;
        let square = splat.radius * splat.radius - pixel.passing.beside_square;
        let half_chord = square.max(0.0).sqrt();
        let front = ((pixel.passing.along - half_chord) * pixel.depth_per_range).max(near);
        let back = (pixel.passing.along + half_chord) * pixel.depth_per_range;
        let is_hit = (square > 0.0) & (back >= near) & (back > 0.0) & (front <= far);
        if is_hit { front } else { f32::INFINITY }
    }
}

/// Bounds of the range of a ball over each pixel.
pub(super) struct CentralBound(pub(super) BallBound);

impl CentralSurface for CentralBound {
    /// A square reaches √½ of a pixel beyond its centre.
    const BEYOND_PX: f32 = 1.0;
    const IN_RANGE: bool = true;

    fn radius(&self, radius: f32, size: f64, fronts: [f64; 2], min_cover: f64) -> Option<f32> {
        self.0.radius(radius, size, fronts, min_cover)
    }

    fn limits(&self, _: &View) -> [f64; 2] {
        [0.0, f64::INFINITY]
    }

    fn radius_at_eye(&self, radius: f64, distance: f64, margin: f64) -> f64 {
        self.0.radius_at_eye(radius, distance, margin)
    }

    fn at_eye(&self, distance: f64, radius: f64, margin: f64) -> Option<[[f64; 2]; 2]> {
        // exact lines of sight decide what it blocks
        (distance - radius < margin && self.0.side == BoundSide::Lower).then_some(ALL)
    }

    #[inline(always)]
    fn depth(&self, pixel: &PixelRay<'_>, splat: &CentralSplat) -> f32 {
        let passing = match self.0.side {
            BoundSide::Lower => pixel.turns[0].nearest(pixel.passing, pixel.distance),
            BoundSide::Upper => pixel.turns[1].farthest(pixel.passing),
        };
        let front = |radius: f32| {
            let square = radius * radius - passing.beside_square;
            let half_chord = square.max(0.0).sqrt();
            let front = (passing.along - half_chord).max(0.0);
            if (square > 0.0) & (passing.along + half_chord > 0.0) { front } else { f32::INFINITY }
        };
        match self.0.side {
            BoundSide::Lower => front(splat.radius),
            BoundSide::Upper => {
                let is_covered = (passing.beside_square < splat.radius * splat.radius) & (passing.along > 0.0);
                let behind = self.0.behind(pixel.distance, splat.radius, splat.margin);
                front(self.0.min_radius(splat.radius)).min(if is_covered { behind } else { f32::INFINITY })
            }
        }
    }
}
