//! Planes through points by least squares.

use crate::normals::estimate::min_component;
use crate::normals::moments::Moments;
use belvedere_data::vector::dot;

/// A plane through points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plane {
    /// Unit vector, upward.
    pub(super) normal: [f64; 3],
    /// Product of the normal with any point of the plane, metres.
    pub(super) offset: f64,
    /// Root mean square distance of its points, metres.
    pub(super) noise: f64,
}

impl Moments {
    /// The plane, `None` for fewer than three points.
    pub(super) fn plane(&self) -> Option<Plane> {
        if self.count < 3.0 {
            return None;
        }
        let mean = self.mean();
        let (values, normal) = min_component(self.covariance());
        let normal = if normal[2] < 0.0 { normal.map(|v| -v) } else { normal };
        normal.iter().all(|v| v.is_finite()).then(|| Plane {
            normal,
            offset: dot(normal, mean),
            noise: values[0].max(0.0).sqrt(),
        })
    }
}

impl Plane {
    /// Distance above the plane, metres.
    pub(super) fn distance_above(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, p) - self.offset
    }

    /// Height of the plane over a place in plan.
    pub(super) fn height(&self, [x, y]: [f64; 2]) -> f64 {
        (self.offset - self.normal[0] * x - self.normal[1] * y) / self.normal[2]
    }

    /// Returns the point in plan at which a line meets the plane. The line runs through `p` and moves by `lean` in plan
    /// for each metre up. `None` for a line nearly parallel to the plane.
    pub(super) fn crossing(&self, p: [f64; 3], lean: [f64; 2]) -> Option<[f64; 2]> {
        let nearer = dot(self.normal, [lean[0], lean[1], 1.0]);
        (nearer > 0.2).then(|| {
            let up = -self.distance_above(p) / nearer;
            [p[0] + lean[0] * up, p[1] + lean[1] * up]
        })
    }

    /// Cosine of the angle to another plane.
    pub(super) fn cosine(&self, other: &Self) -> f64 {
        dot(self.normal, other.normal)
    }
}
