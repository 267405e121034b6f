//! The plane through many points.

use belvedere_data::vector::{cross, dot, sub, unit};

/// A plane and how well it fits.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneFit {
    pub(super) middle: [f64; 3],
    /// Upward.
    pub(super) normal: [f64; 3],
    pub(super) roughness: f64,
}

/// Two unit vectors in a plane with a unit `normal` that is not level: along its contour lines, and up its slope. Of a
/// level plane east and north.
pub(super) fn axes(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let along = unit(cross([0.0, 0.0, 1.0], normal)).filter(|_| normal[2].abs() < 1.0 - 1e-9);
    let along = along.unwrap_or([1.0, 0.0, 0.0]);
    [along, cross(normal, along)]
}

/// The plane near one with a unit normal `about` that fits `places` best by its offsets along `about`, or `None` where
/// they lie on a line.
pub(super) fn fit(places: impl Iterator<Item = [f64; 3]> + Clone, about: [f64; 3]) -> Option<PlaneFit> {
    let mut count = 0.0;
    let mut sum = [0.0; 3];
    for place in places.clone() {
        count += 1.0;
        for (sum, v) in sum.iter_mut().zip(place) {
            *sum += v;
        }
    }
    let middle = sum.map(|v| v / count);
    let [u_axis, v_axis] = axes(about);
    let (mut uu, mut uv, mut vv, mut uw, mut vw) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for place in places.clone() {
        let offset = sub(place, middle);
        let (u, v, w) = (dot(offset, u_axis), dot(offset, v_axis), dot(offset, about));
        uu += u * u;
        uv += u * v;
        vv += v * v;
        uw += u * w;
        vw += v * w;
    }
    let determinant = uu * vv - uv * uv;
    // a band a thousand times longer than wide is a line
    if !(determinant > 1e-6 * (uu + vv) * (uu + vv)) {
        return None;
    }
    let (slope_u, slope_v) = ((uw * vv - vw * uv) / determinant, (vw * uu - uw * uv) / determinant);
    let normal = unit([0, 1, 2].map(|i| about[i] - slope_u * u_axis[i] - slope_v * v_axis[i]))?;
    let normal = if normal[2] < 0.0 { normal.map(|v| -v) } else { normal };
    let square: f64 = places.map(|place| dot(sub(place, middle), normal).powi(2)).sum();
    Some(PlaneFit { middle, normal, roughness: (square / count).sqrt() })
}
