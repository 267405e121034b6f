//! Planes of roofs: points that go on flat from each other.

use super::block::{Block, Building};
use super::fit::Plane;
use crate::neighbors::NeighborIndex;
use crate::normals::moments::Moments;
use belvedere_data::Result;
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::vector::{box_around, sub, to_f32};
use std::collections::BTreeMap;

/// Neighbours that show whether a point lies on something flat, without itself.
const NEIGHBORS: usize = 12;
/// Share of points whose neighbourhoods are smoother by noise alone, and the ratio of their roughness to the noise: the
/// lower quartile of χ with ten degrees of freedom, of thirteen points.
const SMOOTH: [f64; 2] = [0.25, 0.72];

/// Parameters of the planes of roofs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RoofParams {
    /// Maximum distance of neighbours on one plane, metres. Default 1.5.
    pub(super) max_step: f64,
    /// Cosine of the angle up to which a point faces the way of the plane it is added to. Default 0.985, 10°.
    pub(super) same_way_cosine: f64,
    /// Cosine of the angle up to which planes that touch may be one. Default 0.9945, 6°.
    pub(super) one_plane_cosine: f64,
    /// Minimum number of pairs of neighbours on two planes that touch. Default 4.
    pub(super) min_pairs: usize,
    /// Minimum upward part of the normal of a roof. Default 0.34, 70° of slope.
    pub(super) min_up: f64,
    /// Noise of ranges that is believed, whatever the points say, metres. Default 0.004 to 0.08.
    pub(super) noise: [f64; 2],
    /// Number of passes in which points beside planes are given to them. Default 3.
    pub(super) sweeps: usize,
    /// Maximum diagonal of the top of an object on a roof, metres. Default 5.
    pub(super) max_top_diagonal: f64,
    /// Minimum upward part of the normal of such a top. Default 0.98, 11° of slope.
    pub(super) min_top_up: f64,
    /// Criteria for points without a class.
    pub(super) unclassified: UnclassifiedParams,
}

/// Criteria by which a plane of points without a class is a roof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UnclassifiedParams {
    /// Minimum area, m². Default 6.
    pub(super) min_area: f64,
    /// Maximum noise of its points, metres. Default 0.05.
    pub(super) max_noise: f64,
    /// Minimum height of its middle above the ground, metres. Default 2.
    pub(super) min_height: f64,
    /// Distance around its points within which that ground is searched, metres. Default 4.
    pub(super) ground_reach: f64,
}

impl Default for RoofParams {
    fn default() -> Self {
        Self {
            max_step: 1.5,
            same_way_cosine: 0.985,
            one_plane_cosine: 0.9945,
            min_pairs: 4,
            min_up: 0.34,
            noise: [0.004, 0.08],
            sweeps: 3,
            max_top_diagonal: 5.0,
            min_top_up: 0.98,
            unclassified: UnclassifiedParams::default(),
        }
    }
}

impl Default for UnclassifiedParams {
    fn default() -> Self {
        Self { min_area: 6.0, max_noise: 0.05, min_height: 2.0, ground_reach: 4.0 }
    }
}

/// A plane and its points.
#[derive(Clone, Debug, Default)]
pub(super) struct Roof {
    pub(super) plane: Plane,
    /// Middle of its points, metres from the corner of the block.
    pub(super) center: [f64; 3],
    /// Rows among [`Roofs::points`].
    pub(super) rows: Vec<usize>,
    /// Mean distance of pulses, metres.
    pub(super) spacing: f64,
    /// True if it may be the level top of something that stands on a roof.
    pub(super) is_small: bool,
}

impl Roof {
    /// Standard deviation of the place at the middle, metres.
    pub(super) fn sd(&self) -> f64 {
        self.plane.noise / (self.rows.len() as f64).sqrt()
    }
}

/// The planes of a block and its margin.
pub(super) struct Roofs {
    /// First returns that may lie on buildings, metres from the corner of the block.
    pub(super) points: Vec<[f64; 3]>,
    /// Rows of the nearest of them about each, its own one where there are fewer.
    pub(super) neighbors: Vec<[u32; NEIGHBORS]>,
    /// Plane of each, `None` for those on none.
    pub(super) plane_of: Vec<Option<u32>>,
    /// The planes.
    pub(super) planes: Vec<Roof>,
    /// Plane of each return of the block, `None` for those on none.
    pub(super) plane_of_return: Vec<Option<u32>>,
    /// Row of each of the points among the returns of the block.
    return_of: Vec<usize>,
    /// Noise of points along the normals, metres.
    pub(super) noise: f64,
}

/// Properties of points before planes grow.
struct Patchwork<'a> {
    params: &'a RoofParams,
    points: Vec<[f64; 3]>,
    neighbors: Vec<[u32; NEIGHBORS]>,
    local: Vec<Plane>,
    noise: f64,
}

/// Points that planes are looked for in.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Candidates {
    /// Points that may lie on buildings.
    Buildings,
    /// Points that may lie on slabs beside them, whose noise is this at most, metres.
    Slabs { max_noise: f64 },
}

/// The planes in a block.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn find(
    block: &Block,
    candidates: Candidates,
    min_points: usize,
    params: &RoofParams,
    control: &Control<'_>,
) -> Result<Roofs> {
    let is_candidate = |row: &usize| {
        let found = &block.returns[*row];
        match candidates {
            Candidates::Buildings => found.may_be_building() && found.is_first,
            Candidates::Slabs { .. } => found.may_be_slab(),
        }
    };
    let rows: Vec<usize> = (0..block.returns.len()).filter(is_candidate).collect();
    let max_noise = match candidates {
        Candidates::Buildings => params.noise[1],
        Candidates::Slabs { max_noise } => max_noise,
    };
    let points = rows.iter().map(|&row| block.returns[row].p).collect();
    let work = Patchwork::new(points, max_noise, params, control)?;
    let (mut plane_of, mut planes) = work.grow(min_points);
    for _ in 0..params.sweeps {
        plane_of = work.swept(&plane_of, &planes);
        planes = work.fitted(&plane_of, planes.len());
    }
    work.merge(&mut plane_of, &mut planes);
    let Patchwork { points, neighbors, noise, .. } = work;
    let mut roofs = Roofs {
        plane_of: vec![None; points.len()],
        plane_of_return: vec![None; block.returns.len()],
        return_of: rows,
        planes: Vec::new(),
        points,
        neighbors,
        noise,
    };
    roofs.keep(block, &plane_of, &planes, min_points, params);
    Ok(roofs)
}

impl Roofs {
    /// Rows among the returns of the block of the points of a roof.
    pub(super) fn returns_of<'a>(&'a self, roof: &'a Roof) -> impl Iterator<Item = usize> + Clone + 'a {
        roof.rows.iter().map(|&row| self.return_of[row])
    }

    /// Keeps the planes that are roofs, without points farther than three times the noise.
    fn keep(
        &mut self,
        block: &Block,
        plane_of: &[Option<u32>],
        planes: &[Plane],
        min_points: usize,
        params: &RoofParams,
    ) {
        let mut rows = vec![Vec::new(); planes.len()];
        for (row, plane) in plane_of.iter().enumerate() {
            if let Some(plane) = plane {
                rows[*plane as usize].push(row);
            }
        }
        for (plane, mut rows) in planes.iter().zip(rows) {
            let max = 3.0 * plane.noise.max(self.noise);
            rows.retain(|&row| plane.distance_above(self.points[row]).abs() <= max);
            let mut sums = Moments::default();
            rows.iter().for_each(|&row| sums.add(self.points[row]));
            let Some(plane) = sums.plane() else { continue };
            if rows.len() < min_points || plane.normal[2] < params.min_up {
                continue;
            }
            // spacings vary with overlap: their mean over the plane
            let area: f64 = rows.iter().map(|&row| block.spacing(self.points[row]).powi(2)).sum();
            let class = block.returns[self.return_of[rows[0]]].building;
            if class == Building::Unknown && !self.is_roof(block, &plane, &rows, area, &params.unclassified) {
                continue;
            }
            let number = u32::try_from(self.planes.len()).ok();
            for &row in &rows {
                self.plane_of[row] = number;
                self.plane_of_return[self.return_of[row]] = number;
            }
            let spacing = (area / rows.len() as f64).sqrt();
            let extent = |axis: usize| {
                let along = || rows.iter().map(|&row| self.points[row][axis]);
                along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
            };
            let is_small =
                extent(0).hypot(extent(1)) <= params.max_top_diagonal && plane.normal[2] >= params.min_top_up;
            self.planes.push(Roof { plane, center: sums.mean(), rows, spacing, is_small });
        }
    }

    /// Returns true if a plane of points without a class is one of a building: large, flat, and above all ground around
    /// it.
    fn is_roof(&self, block: &Block, plane: &Plane, rows: &[usize], area: f64, params: &UnclassifiedParams) -> bool {
        let reach = params.ground_reach;
        let points = rows.iter().map(|&row| self.points[row]);
        let [low, high] = box_around(points.clone().map(|[x, y, _]| [x, y]));
        let [low, high] = [low.map(|v| v - reach), high.map(|v| v + reach)];
        let height = points.fold(0.0, |height, p| height + p[2] / rows.len() as f64);
        let is_above = || block.ground(low, high).is_some_and(|ground| height > ground + params.min_height);
        area >= params.min_area && plane.noise <= params.max_noise && is_above()
    }
}

impl<'a> Patchwork<'a> {
    /// Noise is at most `max_noise` metres.
    fn new(points: Vec<[f64; 3]>, max_noise: f64, params: &'a RoofParams, control: &Control<'_>) -> Result<Self> {
        let places: Vec<[f32; 3]> = points.iter().map(|p| p.map(to_f32)).collect();
        let index = NeighborIndex::new(&places, control)?;
        let mut neighbors: Vec<[u32; NEIGHBORS]> = (0..).take(points.len()).map(|row| [row; NEIGHBORS]).collect();
        let mut local = vec![Plane::default(); points.len()];
        let mut found = Vec::new();
        for &row in index.tree_order() {
            let row = row as usize;
            index.k_nearest(places[row], NEIGHBORS + 1, &mut found);
            let mut sums = Moments::default();
            // sums of small numbers keep their digits
            sums.add([0.0; 3]);
            let others = found.iter().map(|near| near.index).filter(|&near| near as usize != row);
            for (place, near) in neighbors[row].iter_mut().zip(others) {
                *place = near;
                sums.add(sub(points[near as usize], points[row]));
            }
            local[row] = sums.plane().unwrap_or(Plane { noise: f64::INFINITY, ..Plane::default() });
        }
        let mut roughness: Vec<f64> = local.iter().map(|plane| plane.noise).filter(|v| v.is_finite()).collect();
        roughness.sort_unstable_by(f64::total_cmp);
        let quartile = roughness.get(to_index(roughness.len() as f64 * SMOOTH[0])).copied();
        let noise = quartile.map_or(max_noise, |v| (v / SMOOTH[1]).clamp(params.noise[0], max_noise));
        Ok(Self { params, points, neighbors, local, noise })
    }

    /// Neighbours of a point, the point itself where there are too few.
    fn neighbors_of(&self, row: usize) -> impl Iterator<Item = usize> + '_ {
        self.neighbors[row].iter().map(|&near| near as usize)
    }

    /// Returns true if a point lies on something flat.
    fn is_flat(&self, row: usize) -> bool {
        self.local[row].noise < 1.6 * self.noise + 0.01
    }

    /// Planes that grow from the flattest points on; the plane of each point, `None` for those on none.
    fn grow(&self, min_points: usize) -> (Vec<Option<u32>>, Vec<Plane>) {
        let mut plane_of = vec![None; self.points.len()];
        let mut is_tried = vec![false; self.points.len()];
        let mut planes = Vec::new();
        let mut seeds: Vec<usize> = (0..self.points.len()).filter(|&row| self.is_flat(row)).collect();
        seeds.sort_unstable_by(|&a, &b| self.local[a].noise.total_cmp(&self.local[b].noise).then(a.cmp(&b)));
        let mut rows = Vec::new();
        for seed in seeds {
            if plane_of[seed].is_some() || is_tried[seed] {
                continue;
            }
            let number = u32::try_from(planes.len()).ok();
            let plane = self.grown(seed, number, &mut plane_of, &mut rows);
            if rows.len() >= min_points {
                planes.push(plane);
            } else {
                for &row in &rows {
                    plane_of[row] = None;
                    is_tried[row] = true;
                }
            }
        }
        (plane_of, planes)
    }

    /// The plane that grows from a seed, whose points are put into `rows`. It is fitted anew as often as its number of
    /// points has grown by half.
    fn grown(&self, seed: usize, number: Option<u32>, plane_of: &mut [Option<u32>], rows: &mut Vec<usize>) -> Plane {
        let base = self.points[seed];
        let own = self.local[seed];
        let mut plane = Plane { offset: 0.0, ..own };
        let (mut sums, mut next, mut fit_at) = (Moments::default(), 0, 8);
        rows.clear();
        rows.push(seed);
        plane_of[seed] = number;
        sums.add([0.0; 3]);
        let reach = 2.5 * self.noise + 0.02;
        let (max_step, same_way) = (self.params.max_step, self.params.same_way_cosine);
        while let Some(&row) = rows.get(next) {
            next += 1;
            for near in self.neighbors_of(row) {
                if plane_of[near].is_some() || !self.is_flat(near) {
                    continue;
                }
                let (from, at) = (self.points[row], sub(self.points[near], base));
                let step = sub(self.points[near], from);
                let is_near = step.iter().map(|v| v * v).sum::<f64>() < max_step * max_step;
                if is_near && plane.cosine(&self.local[near]).abs() > same_way && plane.distance_above(at).abs() < reach
                {
                    plane_of[near] = number;
                    rows.push(near);
                    sums.add(at);
                }
            }
            if rows.len() >= fit_at {
                plane = sums.plane().unwrap_or(plane);
                fit_at = rows.len() * 3 / 2;
            }
        }
        plane = sums.plane().unwrap_or(plane);
        let moved: f64 = (0..3).map(|i| plane.normal[i] * base[i]).sum();
        Plane { offset: plane.offset + moved, ..plane }
    }

    /// Returns for each point the nearest plane of those that it or its neighbours lie on, if it lies near enough.
    fn swept(&self, plane_of: &[Option<u32>], planes: &[Plane]) -> Vec<Option<u32>> {
        let reach = 2.5 * self.noise + 0.01;
        let chosen = |row: usize| {
            let own = plane_of[row];
            let far = |plane: u32| planes[plane as usize].distance_above(self.points[row]).abs();
            let mut best = (own.map_or(reach, far), own);
            for near in self.neighbors_of(row) {
                let Some(other) = plane_of[near].filter(|&other| best.1 != Some(other)) else { continue };
                if planes[other as usize].normal[2] >= self.params.min_up && far(other) < best.0 {
                    best = (far(other), Some(other));
                }
            }
            best.1
        };
        (0..plane_of.len()).map(chosen).collect()
    }

    /// The planes through the points of each.
    fn fitted(&self, plane_of: &[Option<u32>], count: usize) -> Vec<Plane> {
        self.sums(plane_of, count).iter().map(|sums| sums.plane().unwrap_or_default()).collect()
    }

    fn sums(&self, plane_of: &[Option<u32>], count: usize) -> Vec<Moments> {
        let mut sums = vec![Moments::default(); count];
        for (point, plane) in self.points.iter().zip(plane_of) {
            if let Some(plane) = plane {
                sums[*plane as usize].add(*point);
            }
        }
        sums
    }

    /// Merges planes that touch and fit one plane as well as each its own.
    fn merge(&self, plane_of: &mut [Option<u32>], planes: &mut [Plane]) {
        let mut sums = self.sums(plane_of, planes.len());
        let mut pairs: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for row in 0..self.points.len() {
            for near in self.neighbors_of(row) {
                if let (Some(a), Some(b)) = (plane_of[row], plane_of[near])
                    && a != b
                {
                    *pairs.entry((a.min(b), a.max(b))).or_default() += 1;
                }
            }
        }
        let mut into: Vec<u32> = (0..).take(planes.len()).collect();
        for ((a, b), count) in pairs {
            let [a, b] = [a, b].map(|mut plane| {
                while into[plane as usize] != plane {
                    plane = into[plane as usize];
                }
                plane as usize
            });
            if a == b || count < self.params.min_pairs || planes[a].cosine(&planes[b]) < self.params.one_plane_cosine {
                continue;
            }
            let both = sums[a].plus(&sums[b]);
            let own = (sums[a].count * planes[a].noise.powi(2) + sums[b].count * planes[b].noise.powi(2)) / both.count;
            if let Some(plane) = both.plane().filter(|plane| plane.noise < 1.2 * own.sqrt() + 0.003) {
                (planes[a], sums[a]) = (plane, both);
                into[b] = into[a];
            }
        }
        for plane in plane_of.iter_mut().flatten() {
            while into[*plane as usize] != *plane {
                *plane = into[*plane as usize];
            }
        }
    }
}
