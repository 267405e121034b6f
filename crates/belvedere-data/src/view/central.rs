//! Views from an eye: perspective, hemispheres, and the full sphere as two of them.

use super::{MAX_PIXEL_COUNT, MAX_SIDE, Projection, View, ViewFrame, to_sun};
use crate::vector::{sub, unit};
use crate::{Error, Parameter, Result};
use std::f64::consts::{FRAC_PI_2, PI};

/// Widest angle of a perspective view, radians: beyond, its border is stretched too far to be useful, and its pixels
/// exceed f32.
const WIDEST: f64 = 175.0 * PI / 180.0;
/// Widest half-angle of a stereographic view, radians, for the same reason.
const WIDEST_HALF: f64 = 170.0 * PI / 180.0;

fn checked_eye(eye: [f64; 3]) -> Result<[f64; 3]> {
    if eye.iter().all(|v| v.is_finite()) {
        return Ok(eye);
    }
    Err(Error::invalid(Parameter::Eye, format!("{eye:?}"), "finite"))
}

fn checked_size(size_px: [usize; 2]) -> Result<[usize; 2]> {
    let is_short = size_px.iter().all(|side| *side <= MAX_SIDE);
    match size_px[0].checked_mul(size_px[1]) {
        Some(1..=MAX_PIXEL_COUNT) if is_short => Ok(size_px),
        _ => Err(Error::invalid(
            Parameter::PictureSize,
            format!("{} x {} pixels", size_px[0], size_px[1]),
            "at least one pixel, at most 65536 on a side and 268435456 pixels in all",
        )),
    }
}

impl View {
    /// Creates the view of a pinhole camera at `eye` that looks at `look_at`, both local metres. The picture has
    /// `size_px` pixels (width, height), spans `fov` radians from its left to its right edge, and shows depths from
    /// `near` to `far` metres. The picture's up is the world's up, or north when looking straight down or up.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a position is not finite or both are the same, and for an angle that is not above
    /// 0 and at most 175°. Also for an empty picture or one of more than [`MAX_PIXEL_COUNT`] pixels, and for limits of
    /// depth that are not 0 ≤ `near` < `far`.
    pub fn perspective(
        eye: [f64; 3],
        look_at: [f64; 3],
        fov: f64,
        size_px: [usize; 2],
        near: f64,
        far: f64,
    ) -> Result<Self> {
        let Some(forward) = unit(sub(look_at, checked_eye(eye)?)) else {
            return Err(Error::invalid(Parameter::LookAt, format!("{look_at:?}"), "finite and different from the eye"));
        };
        if !(fov > 0.0 && fov <= WIDEST) {
            return Err(Error::invalid(
                Parameter::FieldOfView,
                format!("{} degrees", fov.to_degrees()),
                "above 0 and at most 175 degrees; a hemispherical view sees more",
            ));
        }
        let size_px = checked_size(size_px)?;
        let focal_px = size_px[0] as f64 / 2.0 / (fov / 2.0).tan();
        let projection = Projection::Perspective { focal_px, near: 0.0, far: f64::INFINITY };
        Self { frame: ViewFrame::looking(eye, forward), projection, size_px }.with_limits(near, far)
    }

    /// Creates a stereographic view of everything up to `half_angle` radians off `axis` (local, any length), seen from
    /// `eye`, local metres, with `size_px` by `size_px` pixels. The corners of the square show directions farther off.
    /// The picture's up is the world's up, or north for an axis straight up or down. It is seen from the inside, so
    /// that east lies left of north on a map around the zenith.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the eye is not finite, the axis has no direction, or the half-angle is not above
    /// 0 and at most 170°. Also if the picture is empty or has more than [`MAX_PIXEL_COUNT`] pixels.
    pub fn fisheye(eye: [f64; 3], axis: [f64; 3], half_angle: f64, size_px: usize) -> Result<Self> {
        let Some(forward) = unit(axis) else {
            return Err(Error::invalid(Parameter::ViewDirection, format!("{axis:?}"), "finite and longer than zero"));
        };
        if !(half_angle > 0.0 && half_angle <= WIDEST_HALF) {
            return Err(Error::invalid(
                Parameter::FieldOfView,
                format!("half of {} degrees", 2.0 * half_angle.to_degrees()),
                "half of an angle above 0 and at most 340 degrees; two maps cover all directions",
            ));
        }
        let size_px = checked_size([size_px; 2])?;
        let radius_px = size_px[0] as f64 / 2.0 / (half_angle / 2.0).tan();
        let projection = Projection::Hemispherical { radius_px, near: 0.0, far: f64::INFINITY };
        Ok(Self { frame: ViewFrame::looking(checked_eye(eye)?, forward), projection, size_px })
    }

    /// The hemisphere around `axis`: [`View::fisheye`] with a half-angle of 90°.
    ///
    /// # Errors
    /// As [`View::fisheye`].
    pub fn hemisphere(eye: [f64; 3], axis: [f64; 3], size_px: usize) -> Result<Self> {
        Self::fisheye(eye, axis, FRAC_PI_2, size_px)
    }

    /// Everything around `eye`, local metres: the hemispheres around the zenith and the nadir, `size_px` by `size_px`
    /// pixels each, which meet at the horizon.
    ///
    /// # Errors
    /// As [`View::fisheye`].
    pub fn panorama(eye: [f64; 3], size_px: usize) -> Result<[Self; 2]> {
        let around = |z: f64| Self::hemisphere(eye, [0.0, 0.0, z], size_px);
        Ok([around(1.0)?, around(-1.0)?])
    }
}

/// Returns the unit vector (local) through the middle of a pixel (column, row) of a panorama of `width` columns and
/// half as many rows. A column is an azimuth: clockwise from south at the left edge over west, north in the middle and
/// east to south again. A row is an elevation, from the zenith to the nadir.
#[must_use]
pub fn panorama_direction(width: usize, [column, row]: [usize; 2]) -> [f64; 3] {
    let step = 2.0 * PI / width.max(1) as f64;
    to_sun((column as f64 + 0.5) * step - PI, FRAC_PI_2 - (row as f64 + 0.5) * step)
}
