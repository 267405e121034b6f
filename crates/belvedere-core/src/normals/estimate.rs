//! Normals by principal components of the nearest neighbours.

use super::moments::Moments;
use super::{Normals, Scatter};
use crate::neighbors::{Neighbor, NeighborIndex};
use belvedere_data::cast::to_f32;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::dot;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Number of neighbours that describe the surface at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Neighborhood {
    /// The point and its `k` nearest neighbours, 3 to 256. The paper takes 6, masbcpp 10.
    Fixed {
        /// Number of neighbours besides the point itself.
        k: usize,
    },
    /// The largest of 8, 11, 16, 22, 32, 45 and 64 neighbours that still lie within `flatness` of a plane (root mean
    /// square). If none does, the number with the smallest eigenentropy of the neighbourhood (Weinmann et al. 2015).
    Adaptive {
        /// Metres; a little more than the noise of the cloud along its normals.
        flatness: f32,
    },
}

impl Default for Neighborhood {
    /// 16 neighbours: enough to average centimetre noise out, few enough to stay on one roof at ten points a square
    /// metre.
    fn default() -> Self {
        Self::Fixed { k: 16 }
    }
}

impl Neighborhood {
    /// Makes the checks of [`estimate`] before a cloud is there.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for fewer than 3 or more than 256 neighbours, or a flatness that is not above zero.
    pub fn check(self) -> Result<()> {
        self.largest().map(|_| ())
    }

    /// The most neighbours that are looked at.
    fn largest(self) -> Result<usize> {
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        match self {
            Self::Fixed { k } if (3..=256).contains(&k) => Ok(k),
            Self::Fixed { k } => invalid(Parameter::NeighborCount, k.to_string(), "3 to 256"),
            Self::Adaptive { flatness } if flatness > 0.0 && flatness.is_finite() => Ok(ADAPTIVE_SIZES[6]),
            Self::Adaptive { flatness } => invalid(Parameter::Flatness, flatness.to_string(), "above zero metres"),
        }
    }

    /// Adaptive with a flatness of 0.05 m, the noise of airborne scans.
    #[must_use]
    pub fn adaptive() -> Self {
        Self::Adaptive { flatness: 0.05 }
    }
}

/// Sizes an adaptive neighbourhood chooses from, about a factor √2 apart.
const ADAPTIVE_SIZES: [usize; 7] = [8, 11, 16, 22, 32, 45, 64];
/// Points handed to a thread at once; their searches share the cache.
const CHUNK: usize = 1024;

/// One normal per point of `positions`, (N, 3) local metres, which `index` was built from; signs are arbitrary.
///
/// A point whose neighbourhood is a single spot or a line gets the normal (0, 0, 0) and quality 0. With fewer points
/// than requested neighbours, all points are neighbours.
///
/// # Errors
/// [`Error::InvalidParameter`] for fewer than 3 or more than 256 neighbours or a flatness that is not above zero;
/// [`Error::LengthMismatch`] where `index` holds another number of points; [`Error::Cancelled`].
///
/// # Source
/// Principal components: Hoppe et al. 1992, section 3.1. Choice of size by eigenentropy: Weinmann, Jutzi, Hinz & Mallet
/// 2015, equation 8; the flatness rule before it is ours, because entropy alone favours large neighbourhoods that bend
/// around eaves.
pub fn estimate(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    neighborhood: Neighborhood,
    control: &Control<'_>,
) -> Result<Normals> {
    Ok(estimate_with_scatter(positions, index, neighborhood, control)?.0)
}

/// Computes [`estimate`], and the scatter of points around the planes of the normals.
///
/// # Errors
/// Those of [`estimate`].
pub fn estimate_with_scatter(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    neighborhood: Neighborhood,
    control: &Control<'_>,
) -> Result<(Normals, Scatter)> {
    estimate_within(positions, index, neighborhood, f32::INFINITY, control)
}

/// Computes [`estimate_with_scatter`], with neighbours no farther than `farthest` metres away.
///
/// # Errors
/// Those of [`estimate`].
pub fn estimate_within(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    neighborhood: Neighborhood,
    farthest: f32,
    control: &Control<'_>,
) -> Result<(Normals, Scatter)> {
    if index.len() != positions.len() {
        return Err(Error::LengthMismatch { what: "neighbour index", expected: positions.len(), found: index.len() });
    }
    let k = neighborhood.largest()?;
    let order = index.tree_order();
    let mut in_tree_order = vec![Plane::NONE; positions.len()];
    in_tree_order.par_chunks_mut(CHUNK).zip(order.par_chunks(CHUNK)).try_for_each(|(planes, points)| {
        control.check()?;
        let mut found = Vec::with_capacity(k + 2);
        for (plane, &i) in planes.iter_mut().zip(points) {
            // the point itself is its own nearest neighbour, or a duplicate of it stands in
            index.k_nearest(positions[i as usize], k + 1, &mut found);
            found.retain(|neighbor| neighbor.distance_squared <= farthest * farthest);
            *plane = match neighborhood {
                Neighborhood::Fixed { .. } => plane_of(positions, &found),
                Neighborhood::Adaptive { flatness } => adaptive_plane_of(positions, &found, flatness),
            };
        }
        control.advance(points.len());
        Ok(())
    })?;
    let mut normals = Normals { vectors: vec![[0.0; 3]; positions.len()], quality: vec![0.0; positions.len()] };
    let mut scatter =
        Scatter { to_plane: vec![[0.0; 3]; positions.len()], roughness: vec![f32::INFINITY; positions.len()] };
    for (&i, plane) in order.iter().zip(in_tree_order) {
        let i = i as usize;
        normals.vectors[i] = plane.normal;
        normals.quality[i] = plane.quality;
        scatter.to_plane[i] = plane.normal.map(|v| v * plane.offset);
        scatter.roughness[i] = plane.roughness;
    }
    Ok((normals, scatter))
}

/// The planes of all `positions`, (N, 3) local metres, within `reach`, (M), metres, of each of `places`, (M, 3); the
/// points are moved onto planes from `places`. `index` must have been built from the positions.
///
/// # Errors
/// [`Error::LengthMismatch`] where lengths differ; [`Error::Cancelled`].
pub(crate) fn estimate_within_reach(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    places: &[[f32; 3]],
    reach: &[f32],
    control: &Control<'_>,
) -> Result<(Normals, Scatter)> {
    for (what, expected, found) in
        [("neighbour index", positions.len(), index.len()), ("reaches", places.len(), reach.len())]
    {
        if expected != found {
            return Err(Error::LengthMismatch { what, expected, found });
        }
    }
    let stop = Stop::new(control);
    let plane_at = |(&place, &reach): (&[f32; 3], &f32)| {
        let mut moments = Moments::default();
        if !stop.is_set() {
            index.within_radius(place, reach, |found| moments.add(relative(positions, &found, place)));
        }
        let (values, normal) = min_component(moments.covariance());
        Plane::new(values, normal, moments.mean())
    };
    let planes: Vec<Plane> = places.par_iter().zip(reach).map(plane_at).collect();
    stop.check()?;
    let mut found = (Normals::default(), Scatter::default());
    for plane in planes {
        plane.push_to(&mut found);
    }
    Ok(found)
}

/// The plane through a neighbourhood.
#[derive(Clone, Copy)]
struct Plane {
    normal: [f32; 3],
    /// Quality of the normal, see [`Normals::quality`].
    quality: f32,
    /// Distance from the point to the plane along the normal, metres.
    offset: f32,
    /// Root mean square distance of the neighbourhood from it, metres.
    roughness: f32,
}

fn relative(positions: &[[f32; 3]], neighbor: &Neighbor, base: [f32; 3]) -> [f64; 3] {
    let p = positions[neighbor.index as usize];
    std::array::from_fn(|i| f64::from(p[i]) - f64::from(base[i]))
}

fn plane_of(positions: &[[f32; 3]], found: &[Neighbor]) -> Plane {
    let Some(first) = found.first() else { return Plane::NONE };
    let base = positions[first.index as usize];
    let mut moments = Moments::default();
    found.iter().for_each(|n| moments.add(relative(positions, n, base)));
    let (values, normal) = min_component(moments.covariance());
    Plane::new(values, normal, moments.mean())
}

fn adaptive_plane_of(positions: &[[f32; 3]], found: &[Neighbor], flatness: f32) -> Plane {
    let Some(first) = found.first() else { return Plane::NONE };
    let base = positions[first.index as usize];
    let mut moments = Moments::default();
    let mut largest_flat = None;
    let mut max_ordered: Option<(f64, Plane)> = None;
    for (i, neighbor) in found.iter().enumerate() {
        moments.add(relative(positions, neighbor, base));
        let is_last = i + 1 == found.len();
        if !(ADAPTIVE_SIZES.contains(&i) || is_last) {
            continue;
        }
        let (values, normal) = min_component(moments.covariance());
        let plane = Plane::new(values, normal, moments.mean());
        if values[0].max(0.0).sqrt() <= f64::from(flatness) {
            largest_flat = Some(plane);
        }
        let entropy = eigenentropy(values);
        if max_ordered.as_ref().is_none_or(|(min, ..)| entropy < *min) {
            max_ordered = Some((entropy, plane));
        }
    }
    largest_flat.or(max_ordered.map(|(_, plane)| plane)).unwrap_or(Plane::NONE)
}

/// −Σ e ln e over the eigenvalues as shares of their sum.
fn eigenentropy(values: [f64; 3]) -> f64 {
    let total: f64 = values.iter().map(|v| v.max(0.0)).sum();
    values.iter().map(|v| v.max(0.0) / total).filter(|&e| e > 0.0).map(|e| -e * e.ln()).sum()
}

/// A line is thinner than a hundredth of its length: its eigenvalues differ by the square.
const LINE: f64 = 1e-4;

impl Plane {
    fn push_to(&self, (normals, scatter): &mut (Normals, Scatter)) {
        normals.vectors.push(self.normal);
        normals.quality.push(self.quality);
        scatter.to_plane.push(self.normal.map(|v| v * self.offset));
        scatter.roughness.push(self.roughness);
    }

    /// Plane of a point or a line: none.
    const NONE: Self = Self { normal: [0.0; 3], quality: 0.0, offset: 0.0, roughness: f32::INFINITY };

    /// The plane of a neighbourhood with these eigenvalues, this component of the least one and this mean, from the
    /// point.
    fn new(values: [f64; 3], normal: [f64; 3], mean: [f64; 3]) -> Self {
        let [min, middle, largest] = values;
        if !(middle > LINE * largest && largest > 0.0 && normal.iter().all(|v| v.is_finite())) {
            return Self::NONE;
        }
        Self {
            normal: normal.map(to_f32),
            quality: to_f32(1.0 - min.max(0.0) / middle),
            offset: to_f32(dot(mean, normal)),
            roughness: to_f32(min.max(0.0).sqrt()),
        }
    }
}

/// Eigenvalues in ascending order and the unit eigenvector of the least, of the symmetric matrix xx, yy, zz, xy, yz,
/// zx.
///
/// Closed form (Smith 1961) with the eigenvector from the longest cross product of two rows of A − λI. If two
/// eigenvalues nearly coincide, these rows are useless and Jacobi rotations take over.
pub(crate) fn min_component(m: [f64; 6]) -> ([f64; 3], [f64; 3]) {
    let [xx, yy, zz, xy, yz, zx] = m;
    let mean = (xx + yy + zz) / 3.0;
    let off = xy * xy + yz * yz + zx * zx;
    let (dx, dy, dz) = (xx - mean, yy - mean, zz - mean);
    let spread = ((dx * dx + dy * dy + dz * dz + 2.0 * off) / 6.0).sqrt();
    if !(spread > 0.0) {
        return ([mean; 3], [0.0, 0.0, 1.0]);
    }
    let determinant = dx * (dy * dz - yz * yz) - xy * (xy * dz - yz * zx) + zx * (xy * yz - dy * zx);
    let half = (determinant / (2.0 * spread * spread * spread)).clamp(-1.0, 1.0);
    let angle = half.acos() / 3.0;
    let largest = mean + 2.0 * spread * angle.cos();
    let min = mean + 2.0 * spread * (angle + 2.0 * std::f64::consts::FRAC_PI_3).cos();
    let middle = 3.0 * mean - largest - min;
    // below this gap the rows of A − λI are mostly rounding
    if middle - min < 1e-6 * spread {
        return jacobi(m);
    }
    let rows = [[xx - min, xy, zx], [xy, yy - min, yz], [zx, yz, zz - min]];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let square = |a: [f64; 3]| a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    let candidates = [cross(rows[0], rows[1]), cross(rows[1], rows[2]), cross(rows[2], rows[0])];
    let longest = candidates.into_iter().fold([0.0; 3], |best, v| if square(v) > square(best) { v } else { best });
    let length = square(longest).sqrt();
    if !(length > 0.0) {
        return jacobi(m);
    }
    ([min, middle, largest], longest.map(|v| v / length))
}

#[expect(clippy::needless_range_loop, reason = "two rows change at once")]
/// Computes [`min_component`] by cyclic Jacobi rotations: slower, and exact for any spectrum.
fn jacobi(m: [f64; 6]) -> ([f64; 3], [f64; 3]) {
    let [xx, yy, zz, xy, yz, zx] = m;
    let mut a = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // a 3 x 3 matrix is diagonal to the last bit after six to eight sweeps
    for _ in 0..12 {
        for (p, q) in [(0, 1), (1, 2), (0, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta: f64 = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
            }
            for row in &mut v {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    (order.map(|i| a[i][i]), [v[0][order[0]], v[1][order[0]], v[2][order[0]]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_eigen(values: [f64; 3], axes: [[f64; 3]; 3]) -> [f64; 6] {
        let entry = |i: usize, j: usize| (0..3).map(|k| values[k] * axes[k][i] * axes[k][j]).sum::<f64>();
        [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)]
    }

    fn rotated_axes(a: f64, b: f64) -> [[f64; 3]; 3] {
        let (sa, ca, sb, cb) = (a.sin(), a.cos(), b.sin(), b.cos());
        [[ca * cb, sa * cb, sb], [-sa, ca, 0.0], [-ca * sb, -sa * sb, cb]]
    }

    #[test]
    fn least_component_agrees_with_nalgebra_from_planes_to_near_isotropy() {
        for i in 0..2000 {
            let t = f64::from(i);
            let axes = rotated_axes(t * 0.7, (t * 0.3).sin());
            let gap = 10f64.powf(-(t % 11.0));
            let m = from_eigen([1.0, 1.0 + gap, 1.0 + gap + (t % 7.0)], axes);
            let (values, vector) = min_component(m);
            let [xx, yy, zz, xy, yz, zx] = m;
            let other = nalgebra::Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz).symmetric_eigen();
            let mut theirs: Vec<f64> = other.eigenvalues.iter().copied().collect();
            theirs.sort_by(f64::total_cmp);
            for (mine, theirs) in values.iter().zip(theirs) {
                // the closed form loses half the digits where eigenvalues coincide
                assert!((mine - theirs).abs() < 1e-7, "{values:?} {theirs}");
            }
            let along: f64 = (0..3).map(|k| vector[k] * axes[0][k]).sum();
            if gap > 1e-5 {
                assert!(along.abs() > 1.0 - 1e-6, "gap {gap}: {along}");
            }
        }
    }

    #[test]
    fn a_tilted_plane_gives_its_normal_with_full_quality() {
        let normal = [0.6f32, 0.0, 0.8];
        let points: Vec<[f32; 3]> = (0..400)
            .map(|i| {
                let (u, v) = ((i % 20) as f32 * 0.3, (i / 20) as f32 * 0.3);
                [0.8 * u, v, -0.6 * u]
            })
            .collect();
        let index = NeighborIndex::new(&points, &Control::none()).unwrap();
        for neighborhood in
            [Neighborhood::Fixed { k: 6 }, Neighborhood::default(), Neighborhood::Adaptive { flatness: 0.01 }]
        {
            let normals = estimate(&points, &index, neighborhood, &Control::none()).unwrap();
            for (n, q) in normals.vectors.iter().zip(&normals.quality) {
                let along: f32 = (0..3).map(|i| n[i] * normal[i]).sum();
                assert!(along.abs() > 0.999_99 && *q > 0.999, "{n:?} {q}");
            }
        }
    }

    #[test]
    fn spots_and_lines_have_no_normal() {
        let spot = vec![[1.0f32, 2.0, 3.0]; 40];
        let line: Vec<[f32; 3]> = (0..40).map(|i| [i as f32, 2.0 * i as f32, 0.0]).collect();
        for points in [spot, line, vec![[0.0; 3]], vec![[0.0; 3], [1.0; 3]]] {
            let index = NeighborIndex::new(&points, &Control::none()).unwrap();
            let normals = estimate(&points, &index, Neighborhood::Fixed { k: 6 }, &Control::none()).unwrap();
            assert!(normals.vectors.iter().all(|n| *n == [0.0; 3]), "{:?}", normals.vectors);
            assert!(normals.quality.iter().all(|q| *q == 0.0));
        }
    }

    #[test]
    fn adaptive_neighborhoods_are_large_on_planes_and_small_at_edges() {
        // two planes that meet at a right angle: far from the edge both find the plane, near it the fixed 64 mix both
        let mut points = Vec::new();
        for i in 0..40 {
            for j in 0..20 {
                let (u, v) = (i as f32 * 0.25, j as f32 * 0.25 + 0.125);
                points.push([u, v, 0.0]);
                points.push([u, 0.0, v]);
            }
        }
        let index = NeighborIndex::new(&points, &Control::none()).unwrap();
        let off = |neighborhood| {
            let normals = estimate(&points, &index, neighborhood, &Control::none()).unwrap();
            normals
                .vectors
                .iter()
                .zip(&points)
                .filter(|(n, p)| (if p[2] == 0.0 { n[2] } else { n[1] }).abs() < 0.95)
                .count()
        };
        let (adaptive, fixed) = (off(Neighborhood::Adaptive { flatness: 0.03 }), off(Neighborhood::Fixed { k: 64 }));
        assert!(adaptive * 2 < fixed, "{adaptive} of {} normals off, fixed {fixed}", points.len());
    }

    #[test]
    fn absurd_parameters_are_refused() {
        let index = NeighborIndex::new(&[], &Control::none()).unwrap();
        assert!(estimate(&[], &index, Neighborhood::Fixed { k: 2 }, &Control::none()).is_err());
        assert!(estimate(&[], &index, Neighborhood::Fixed { k: 1000 }, &Control::none()).is_err());
        assert!(estimate(&[], &index, Neighborhood::Adaptive { flatness: f32::NAN }, &Control::none()).is_err());
        assert!(estimate(&[[0.0; 3]], &index, Neighborhood::default(), &Control::none()).is_err());
    }
}
