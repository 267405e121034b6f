//! Balls in parallel views: where a ball lies on the picture plane and how deep its surface is at a pixel.

use super::ball_bound::{BallBound, BoundSide, margin};
use super::tiles::{BLOCK, SplatSurface};
use belvedere_data::vector::to_f32;
use belvedere_data::view::View;

/// A ball in view space, in the units of its [`ParallelSurface`].
#[derive(Clone, Copy, Debug)]
pub(super) struct ParallelSplat {
    /// Centre in pixels from the upper left corner of the picture.
    x: f32,
    y: f32,
    /// Depth of the centre.
    z: f32,
    radius: f32,
    /// Row of the ball.
    ball: u32,
}

/// A surface that represents a ball, in its own units.
pub(super) trait ParallelSurface: Sync {
    /// Pixels beyond the outline of a ball whose depth may be finite.
    const BEYOND_PX: f32 = 0.0;
    /// Units of depth in a metre.
    fn units_per_metre(&self) -> f32 {
        1.0
    }
    /// The ball whose centre lies at `x`, `y` pixels and `z` metres, or `None` where it cannot be seen.
    fn place(&self, x: f64, y: f64, z: f64, radius: f32, ball: u32) -> Option<ParallelSplat>;
    /// Depth at the offset `dx`, `dy` from the centre, +∞ beside the ball. It must not fall as the size of either
    /// offset grows, not even by rounding.
    fn depth(&self, splat: &ParallelSplat, dx: f32, dy: f32) -> f32;
}

/// Balls in a parallel view.
pub(super) struct Parallel<S> {
    view: View,
    pixels_per_metre: f64,
    units_per_pixel: f32,
    surface: S,
}

impl<S: ParallelSurface> Parallel<S> {
    pub(super) fn new(view: &View, pixels_per_metre: f64, surface: S) -> Self {
        let units_per_pixel = match surface.units_per_metre() {
            1.0 => to_f32(1.0 / pixels_per_metre),
            _ => 1.0,
        };
        Self { view: *view, pixels_per_metre, units_per_pixel, surface }
    }
}

impl<S: ParallelSurface> SplatSurface for Parallel<S> {
    type Splat = ParallelSplat;
    /// First column and row.
    type PixelTile = [usize; 2];

    fn place(&self, center: [f32; 3], radius: f32, ball: u32) -> Option<ParallelSplat> {
        let [width, height] = self.view.size_px.map(|v| v as f64);
        let [x, y, z] = self.view.frame.view_from_local(center);
        let (x, y) = (x * self.pixels_per_metre, y * self.pixels_per_metre);
        // a pixel more than the ball reaches: the cone's centre moves by up to half of one, and bounds look at whole
        // pixels
        let reach = f64::from(radius) * self.pixels_per_metre + 1.0;
        // a comparison with NaN is false, so centres that are not finite fall out here
        let inside = x + reach > 0.0 && x - reach < width && y + reach > 0.0 && y - reach < height && z.is_finite();
        if inside { self.surface.place(x, y, z, radius, ball) } else { None }
    }

    fn ball(splat: &ParallelSplat) -> u32 {
        splat.ball
    }

    fn nearest_depth(splat: &ParallelSplat) -> f32 {
        splat.z - splat.radius
    }

    fn extent(&self, splat: &ParallelSplat) -> [[f32; 2]; 2] {
        let reach = splat.radius / self.units_per_pixel + S::BEYOND_PX;
        [[splat.x - reach, splat.x + reach], [splat.y - reach, splat.y + reach]]
    }

    fn tile(&self, left: usize, top: usize) -> [usize; 2] {
        [left, top]
    }

    /// This is the depth at the offset within the block that is nearest to the centre. Every operation from offset to
    /// depth is monotone in f32, so no pixel of the block can come out nearer, not even by rounding.
    fn min_depth(&self, &[left, top]: &[usize; 2], splat: &ParallelSplat, [column, row]: [usize; 2]) -> f32 {
        let offset = |first: usize, center: f32| {
            let [first, last] = [first, first + BLOCK - 1].map(|pixel| pixel as f32 + 0.5 - center);
            0f32.clamp(first, last) * self.units_per_pixel
        };
        let dx = offset(left + column, splat.x);
        let dy = offset(top + row, splat.y);
        self.surface.depth(splat, dx, dy)
    }

    #[inline(always)]
    fn depths(&self, &[left, top]: &[usize; 2], splat: &ParallelSplat, [column, row]: [usize; 2]) -> [f32; BLOCK] {
        let dy = ((top + row) as f32 + 0.5 - splat.y) * self.units_per_pixel;
        std::array::from_fn(|lane| {
            let dx = ((left + column + lane) as f32 + 0.5 - splat.x) * self.units_per_pixel;
            self.surface.depth(splat, dx, dy)
        })
    }

    fn units_per_metre(&self) -> f32 {
        self.surface.units_per_metre()
    }
}

/// The sphere, in metres.
pub(super) struct ParallelSphere;

impl ParallelSurface for ParallelSphere {
    fn place(&self, x: f64, y: f64, z: f64, radius: f32, ball: u32) -> Option<ParallelSplat> {
        (z + f64::from(radius) >= 0.0).then_some(ParallelSplat {
            x: to_f32(x),
            y: to_f32(y),
            z: to_f32(z),
            radius,
            ball,
        })
    }

    #[inline(always)]
    fn depth(&self, splat: &ParallelSplat, dx: f32, dy: f32) -> f32 {
        let square = (splat.radius * splat.radius - dy * dy) - dx * dx;
        let half_chord = square.max(0.0).sqrt();
        let front = (splat.z - half_chord).max(0.0);
        if square > 0.0 && splat.z + half_chord >= 0.0 { front } else { f32::INFINITY }
    }
}

/// The paper's cone, in pixels.
pub(super) struct Cone {
    pub(super) pixels_per_metre: f32,
}

impl ParallelSurface for Cone {
    fn units_per_metre(&self) -> f32 {
        self.pixels_per_metre
    }

    fn place(&self, x: f64, y: f64, z: f64, radius: f32, ball: u32) -> Option<ParallelSplat> {
        let s = self.pixels_per_metre;
        // the middle of the pixel that holds the centre, so that offsets to pixel centres are the paper's integers
        Some(ParallelSplat {
            x: to_f32(x.floor()) + 0.5,
            y: to_f32(y.floor()) + 0.5,
            z: to_f32(z) * s,
            radius: radius * s,
            ball,
        })
    }

    #[inline(always)]
    fn depth(&self, splat: &ParallelSplat, dx: f32, dy: f32) -> f32 {
        let h = (dx * dx + dy * dy).sqrt();
        if h < splat.radius { splat.z - (splat.radius - h) } else { f32::INFINITY }
    }
}

/// Bounds of the depth of a ball over the square of each pixel.
pub(super) struct ParallelBound {
    bound: BallBound,
    /// Half a pixel, metres, and a little more so that rounding leaves no gap.
    half_px: f32,
    metres_per_px: f64,
}

impl ParallelBound {
    pub(super) fn new(bound: BallBound, pixels_per_metre: f64) -> Self {
        let metres_per_px = 1.0 / pixels_per_metre;
        Self { bound, half_px: to_f32(metres_per_px * 0.500_01), metres_per_px }
    }
}

impl ParallelSurface for ParallelBound {
    /// A square reaches half a pixel beyond its centre.
    const BEYOND_PX: f32 = 1.0;

    fn place(&self, x: f64, y: f64, z: f64, radius: f32, ball: u32) -> Option<ParallelSplat> {
        let size = (x.abs() + y.abs()) * self.metres_per_px + z.abs();
        let whole = f64::from(radius);
        let radius = self.bound.radius(radius, size, [z - whole, z], f64::from(self.half_px))?;
        Some(ParallelSplat { x: to_f32(x), y: to_f32(y), z: to_f32(z), radius, ball })
    }

    #[inline(always)]
    fn depth(&self, splat: &ParallelSplat, dx: f32, dy: f32) -> f32 {
        let [dx, dy] = match self.bound.side {
            BoundSide::Lower => [dx, dy].map(|d| (d.abs() - self.half_px).max(0.0)),
            BoundSide::Upper => [dx, dy].map(|d| d.abs() + self.half_px),
        };
        let beside = dx * dx + dy * dy;
        let front = |radius: f32| {
            let square = radius * radius - beside;
            if square > 0.0 { splat.z - square.sqrt() } else { f32::INFINITY }
        };
        match self.bound.side {
            BoundSide::Lower => front(splat.radius),
            BoundSide::Upper => {
                let size = (splat.x.abs() + splat.y.abs()) * self.half_px * 2.0 + splat.z.abs();
                let margin = margin(f64::from(size), f64::from(splat.radius));
                let behind = self.bound.behind(splat.z, splat.radius, to_f32(margin));
                let behind = if beside < splat.radius * splat.radius { behind } else { f32::INFINITY };
                front(self.bound.min_radius(splat.radius)).min(behind)
            }
        }
    }
}
