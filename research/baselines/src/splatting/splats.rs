//! One splat, and how its size and shape follow from the points around it.

use super::{SplatParams, SplatShape};
use crate::lines_of_sight::box_corner;
use crate::sampling::{capped_spacing, for_neighborhoods};
use belvedere::Result;
use belvedere::cast::{to_f32, to_f32s};
use belvedere::control::Control;
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::ray_index::Ray;
use belvedere::vector::{cross, dot, length, sub, unit};

/// A piece of surface about a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SurfaceSplat {
    center: [f32; 3],
    /// Half axes, at right angles to each other; zero where the splat faces the line of sight.
    axes: [[f32; 3]; 2],
    /// Length of the longer half axis, metres.
    radius: f32,
}

impl SurfaceSplat {
    /// Range at which the line of `ray` passes through the splat, or `None` where it passes by.
    pub(super) fn range(&self, ray: &Ray) -> Option<f64> {
        let to_center = sub(self.center.map(f64::from), ray.origin);
        let [u, v] = self.axes.map(|axis| axis.map(f64::from));
        let (uu, vv) = (dot(u, u), dot(v, v));
        if uu == 0.0 {
            let range = dot(to_center, ray.direction);
            let radius = f64::from(self.radius);
            return (dot(to_center, to_center) - range * range <= radius * radius).then_some(range);
        }
        let normal = cross(u, v);
        let range = dot(to_center, normal) / dot(ray.direction, normal);
        let off_center: [f64; 3] = std::array::from_fn(|i| range * ray.direction[i] - to_center[i]);
        let (a, b) = (dot(off_center, u) / uu, dot(off_center, v) / vv);
        // NaN, for a ray in the plane of the splat, is not inside
        (a * a + b * b <= 1.0).then_some(range)
    }

    pub(super) fn bounding_box(&self) -> [[f32; 3]; 2] {
        let [u, v] = self.axes.map(|axis| axis.map(f64::from));
        let facing = u == [0.0; 3];
        let reach = |i: usize| if facing { f64::from(self.radius) } else { u[i].hypot(v[i]) };
        let corner = |sign: f64| std::array::from_fn(|i| f64::from(self.center[i]) + sign * reach(i));
        [box_corner(corner(-1.0), -1.0), box_corner(corner(1.0), 1.0)]
    }

    pub(super) fn outline(&self) -> ([f32; 3], [[f32; 3]; 2], f32) {
        (self.center, self.axes, self.radius)
    }
}

/// One splat per position, (N, 3) local metres.
///
/// # Errors
/// [`Error::InvalidParameter`](belvedere::Error::InvalidParameter) for a number of neighbours out of its range or a
/// position that is not finite.
pub(super) fn make(positions: &[[f32; 3]], params: &SplatParams) -> Result<Vec<SurfaceSplat>> {
    let index = NeighborIndex::new(positions, &Control::none())?;
    let normals = estimate(positions, &index, Neighborhood::Fixed { k: params.normal_neighbors }, &Control::none())?;
    let spacing = capped_spacing(positions, &index, params.radius_neighbor, params.max_radius_in_medians);
    Ok(for_neighborhoods(positions, &index, params.normal_neighbors, |point, neighbors, _| {
        let center = positions[point];
        let radius = f64::from(spacing[point]) * params.radius_scale;
        let facing = SurfaceSplat { center, axes: [[0.0; 3]; 2], radius: to_f32(radius) };
        let normal = unit(normals.vectors[point].map(f64::from)).filter(|_| params.shape != SplatShape::Facing);
        let Some((normal, first)) = normal.and_then(|normal| Some((normal, any_tangent(normal)?))) else {
            return facing;
        };
        let second = cross(normal, first);
        let axes = match params.shape {
            SplatShape::Ellipse => {
                let offsets = neighbors.iter().map(|&n| sub(positions[n].map(f64::from), center.map(f64::from)));
                let in_plane: Vec<[f64; 2]> = offsets.map(|d| [dot(d, first), dot(d, second)]).collect();
                let (angle, aspect) = spread(&in_plane);
                let stretch = aspect.min(params.max_aspect).sqrt();
                let (sin, cos) = angle.sin_cos();
                let along = std::array::from_fn(|i| radius * stretch * (cos * first[i] + sin * second[i]));
                let across = std::array::from_fn(|i| radius / stretch * (cos * second[i] - sin * first[i]));
                [along, across]
            }
            SplatShape::Disc | SplatShape::Facing => [first.map(|v| v * radius), second.map(|v| v * radius)],
        };
        let longer = length(axes[0]);
        // duplicates of one point have no extent, hence no axes
        SurfaceSplat { center, axes: axes.map(to_f32s), radius: to_f32(longer) }
    }))
}

/// A unit vector at right angles to a unit vector.
fn any_tangent(normal: [f64; 3]) -> Option<[f64; 3]> {
    let min = |a: usize, b: usize| if normal[b].abs() < normal[a].abs() { b } else { a };
    let mut axis = [0.0; 3];
    axis[min(min(0, 1), 2)] = 1.0;
    unit(cross(normal, axis))
}

/// Direction in which points of a plane spread most, radians from the first axis, and how many times farther they
/// spread that way than across (a ratio of standard deviations; infinite on a line).
fn spread(points: &[[f64; 2]]) -> (f64, f64) {
    let count = points.len().max(1) as f64;
    let mean = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / count);
    let moment = |i: usize, j: usize| points.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>() / count;
    let (xx, yy, xy) = (moment(0, 0), moment(1, 1), moment(0, 1));
    let (middle, half_gap) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
    let ratio = ((middle + half_gap) / (middle - half_gap).max(0.0)).sqrt();
    (xy.atan2((xx - yy) / 2.0) / 2.0, if ratio.is_nan() { 1.0 } else { ratio })
}
