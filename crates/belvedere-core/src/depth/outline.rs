//! Outline of a ball in views from an eye.

use belvedere_data::view::{Projection, View};

/// The outline of a surface that covers the whole picture.
pub(super) const ALL: [[f64; 2]; 2] = [[f64::NEG_INFINITY, f64::INFINITY]; 2];

/// Returns the range of columns and of rows, in pixels from the upper left corner, of the outline of a ball in a view
/// from an eye. `None` if nothing of it lies beyond the near limit or it holds the eye. Infinite if the outline has no
/// end.
///
/// The ball is given by its centre along right, down and forward of the view's frame, and its radius, metres.
pub(super) fn outline(view: &View, center: [f64; 3], radius: f64) -> Option<[[f64; 2]; 2]> {
    let [near, _] = view.limits();
    let [x, y, z] = center;
    let middle = view.middle();
    match view.projection {
        Projection::Orthographic { .. } => None,
        Projection::Perspective { focal_px, .. } => {
            if z + radius <= near || center.map(|v| v * v).iter().sum::<f64>() <= radius * radius {
                return None;
            }
            let span = |axis: usize, across: f64| slopes(across, z, radius, near).map(|s| middle[axis] + focal_px * s);
            Some([span(0, x), span(1, y)])
        }
        Projection::Hemispherical { radius_px, .. } => {
            let beside = x.hypot(y);
            let range = beside.hypot(z);
            if !(radius < range) || range + radius <= near {
                return None;
            }
            let (off_axis, half) = (beside.atan2(z), (radius / range).asin());
            // a ball opposite to the axis covers the picture from some circle outward
            if off_axis + half > std::f64::consts::PI - 1e-6 {
                return Some(ALL);
            }
            let [inner, outer] = [off_axis - half, off_axis + half].map(|angle| (angle / 2.0).tan() * radius_px);
            let (distance, reach) = ((inner + outer) / 2.0, (outer - inner) / 2.0);
            let span = |axis: usize, across: f64| {
                let center = middle[axis] + if beside > 0.0 { distance * across / beside } else { 0.0 };
                [center - reach, center + reach]
            };
            Some([span(0, x), span(1, y)])
        }
    }
}

/// Returns the minimum and maximum slope across / forward at which a circle of `radius` around (`across`, `forward`) is
/// seen from the origin beyond the depth `near`. The circle is the ball's shadow on the plane of that axis and forward,
/// so that these are the exact bounds of the ball. If a tangent touches before the near limit, the circle's chord there
/// takes its place.
///
/// # Source
/// Mara & McGuire 2013, section 2.
fn slopes(across: f64, forward: f64, radius: f64, near: f64) -> [f64; 2] {
    let square = across * across + forward * forward;
    let tangent = square - radius * radius;
    let chord = (radius * radius - (near - forward).powi(2)).max(0.0).sqrt();
    [-1.0, 1.0].map(|side| {
        if tangent > 0.0 {
            // the tangent's direction, up to its length: the centre's turned by the angle whose sine is radius /
            // distance
            let length = tangent.sqrt();
            let at = [across * length + side * radius * forward, forward * length - side * radius * across];
            // the touching point is that direction times length / square
            if at[1] * length > near * square && at[1] > 0.0 {
                return at[0] / at[1];
            }
        }
        if near > 0.0 { (across + side * chord) / near } else { side * f64::INFINITY }
    })
}
