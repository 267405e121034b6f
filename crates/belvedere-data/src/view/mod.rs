//! Views: from where, in which direction, and how densely a scene is looked at.

mod central;
mod frame;
mod parallel;
mod projection;

pub use central::panorama_direction;
pub use frame::ViewFrame;
pub use projection::Projection;

/// Maximum number of pixels a view may have, so that a mistyped pixel size is an error and not a crash: 1 GiB of f32.
pub const MAX_PIXEL_COUNT: usize = 1 << 28;
/// Maximum number of pixels on a side: longer pictures are slips, and many programs cannot open them.
pub const MAX_SIDE: usize = 1 << 16;
/// Width and height of a camera where no size is given, pixels: those of usual screens.
pub const CAMERA_SIZE: [usize; 2] = [1280, 720];
/// Field of view of a camera where none is given, radians: 60 degrees, a little wider than the gaze of people.
pub const CAMERA_FOV: f64 = std::f64::consts::FRAC_PI_3;
/// Width of a panorama where none is given, pixels: 0.18 degrees each.
pub const PANORAMA_WIDTH: usize = 2048;

/// A view: frame, projection and picture size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position and orientation.
    pub frame: ViewFrame,
    /// Projection.
    pub projection: Projection,
    /// Width and height in pixels.
    pub size_px: [usize; 2],
}

/// Unit vector from the scene to the sun, for an azimuth clockwise from grid north and an elevation, radians.
#[must_use]
pub fn to_sun(azimuth: f64, elevation: f64) -> [f64; 3] {
    [azimuth.sin() * elevation.cos(), azimuth.cos() * elevation.cos(), elevation.sin()]
}

/// Returns a pixel size, metres, for a scene between two corners: 0.25 m, half the usual spacing of airborne scans, or
/// a thousandth of the extent of a small object.
#[must_use]
pub fn default_pixel_size(low: [f64; 3], high: [f64; 3]) -> f64 {
    let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    if extent > 0.0 { (extent / 1000.0).min(0.25) } else { 0.25 }
}
