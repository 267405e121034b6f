//! One ball on the picture plane: where it lies and how deep its surface is at a pixel.

use crate::view::View;

/// A ball in view space, in the units of its [`Shape`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    /// Centre in pixels from the upper left corner of the picture.
    pub(super) x: f32,
    pub(super) y: f32,
    /// Depth of the centre.
    pub(super) z: f32,
    pub(super) radius: f32,
    /// Row of the ball.
    pub(super) ball: u32,
}

impl Splat {
    /// Depth of the nearest point.
    pub(super) fn near(&self) -> f32 {
        self.z - self.radius
    }
}

/// A surface that stands for a ball, in units of its own.
pub(super) trait Shape {
    /// Units per pixel and per metre.
    fn scale(view: &View) -> Scale;
    /// The ball whose centre lies at `x`, `y` pixels and `z` metres, or `None` where it cannot be seen.
    fn place(x: f64, y: f64, z: f64, radius: f32, ball: u32, scale: Scale) -> Option<Splat>;
    /// Depth at the offset `dx`, `dy` from the centre, +∞ beside the ball.
    fn depth(splat: &Splat, dx: f32, dy: f32) -> f32;
}

/// Units of a [`Shape`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) units_per_pixel: f32,
    pub(super) units_per_metre: f32,
}

/// The sphere, in metres.
pub(super) struct Sphere;

impl Shape for Sphere {
    #[expect(clippy::cast_possible_truncation, reason = "a pixel size in metres")]
    fn scale(view: &View) -> Scale {
        Scale { units_per_pixel: (1.0 / view.pixels_per_metre()) as f32, units_per_metre: 1.0 }
    }

    #[expect(clippy::cast_possible_truncation, reason = "view coordinates relative to the picture's corner")]
    fn place(x: f64, y: f64, z: f64, radius: f32, ball: u32, _: Scale) -> Option<Splat> {
        (z + f64::from(radius) >= 0.0).then_some(Splat { x: x as f32, y: y as f32, z: z as f32, radius, ball })
    }

    #[inline(always)]
    fn depth(splat: &Splat, dx: f32, dy: f32) -> f32 {
        let square = (splat.radius * splat.radius - dy * dy) - dx * dx;
        let half_chord = square.max(0.0).sqrt();
        let front = (splat.z - half_chord).max(0.0);
        if square > 0.0 && splat.z + half_chord >= 0.0 { front } else { f32::INFINITY }
    }
}

/// The paper's cone, in pixels.
pub(super) struct Cone;

impl Shape for Cone {
    #[expect(clippy::cast_possible_truncation, reason = "pixels per metre")]
    fn scale(view: &View) -> Scale {
        Scale { units_per_pixel: 1.0, units_per_metre: view.pixels_per_metre() as f32 }
    }

    #[expect(clippy::cast_possible_truncation, reason = "view coordinates relative to the picture's corner")]
    fn place(x: f64, y: f64, z: f64, radius: f32, ball: u32, scale: Scale) -> Option<Splat> {
        let s = scale.units_per_metre;
        // the middle of the pixel that holds the centre, so that offsets to pixel centres are the paper's integers
        Some(Splat { x: x.floor() as f32 + 0.5, y: y.floor() as f32 + 0.5, z: z as f32 * s, radius: radius * s, ball })
    }

    #[inline(always)]
    fn depth(splat: &Splat, dx: f32, dy: f32) -> f32 {
        let h = (dx * dx + dy * dy).sqrt();
        if h < splat.radius { splat.z - (splat.radius - h) } else { f32::INFINITY }
    }
}
