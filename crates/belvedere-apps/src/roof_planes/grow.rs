//! Growing planes from point to point.

use super::RoofPlaneParams;
use super::fit::{PlaneFit, fit};
use belvedere_core::neighbors::NeighborIndex;
use belvedere_core::normals::Normals;
use belvedere_data::Result;
use belvedere_data::cast::to_row;
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, sub, to_f32};

/// Points that a plane has at least: fewer make one of anything.
const MIN_POINTS: usize = 12;
/// Points at which a plane is first fitted anew; then each time it has grown by half.
const FIRST_FIT: usize = 12;
/// Times that the points near a grown plane are taken anew: the first fit leans to where it began.
const ROUNDS: usize = 2;
/// Minimum share of the points within reach of a plane's points that lie on it, too. In a crown, where planes pass
/// through by chance, it is a fifth, and on a roof between others more than two thirds.
const MIN_SHARE: f64 = 0.5;

const FREE: u32 = u32::MAX;
/// Owner of points on a plane that is no roof: they are no seed, but may join a plane that is.
const DROPPED: u32 = u32::MAX - 1;

/// Rows of the points of each plane that `is_roof`, rising, and its fit.
pub(super) fn regions(
    points: &[[f32; 3]],
    index: &NeighborIndex,
    normals: &Normals,
    params: &RoofPlaneParams,
    is_roof: impl Fn(&[u32], &PlaneFit) -> bool,
    control: &Control<'_>,
) -> Result<Vec<(Vec<u32>, PlaneFit)>> {
    let mut owner = vec![FREE; points.len()];
    let mut regions = Vec::new();
    for seed in seeds(normals) {
        if owner[seed as usize] != FREE {
            continue;
        }
        control.check()?;
        let number = to_row(regions.len());
        let Some(normal) = upward(normals.vectors[seed as usize]) else { continue };
        let start = PlaneFit { middle: points[seed as usize].map(f64::from), normal, roughness: 0.0 };
        let mut region = Region { points, index, normals, params, owner: &mut owner, number };
        let Some((mut rows, fit)) = region.grow_again(seed, start) else { continue };
        rows.sort_unstable();
        if is_roof(&rows, &fit) {
            regions.push((rows, fit));
        } else {
            rows.iter().for_each(|&row| owner[row as usize] = DROPPED);
        }
    }
    absorb(points, index, params, &mut owner, &mut regions);
    Ok(regions)
}

/// Assigns points left over because their normals bend, as near ridges, to the adjacent plane that they lie on. It is
/// the nearest one, or the first of several equally near.
fn absorb(
    points: &[[f32; 3]],
    index: &NeighborIndex,
    params: &RoofPlaneParams,
    owner: &mut [u32],
    regions: &mut [(Vec<u32>, PlaneFit)],
) {
    let reach = to_f32(params.reach);
    let mut is_member = vec![false; regions.len()];
    let mut joined: Vec<(u32, u32)> = Vec::new();
    for (row, point) in (0_u32..).zip(points) {
        if owner.get(row as usize).is_none_or(|&owner| owner < DROPPED) {
            continue;
        }
        let mut near: Vec<u32> = Vec::new();
        index.within_radius(*point, reach, |neighbor| {
            let number = owner[neighbor.index as usize];
            if number < DROPPED && !std::mem::replace(&mut is_member[number as usize], true) {
                near.push(number);
            }
        });
        near.sort_unstable();
        let place = point.map(f64::from);
        let off = |number: u32| {
            let fit = &regions[number as usize].1;
            dot(sub(place, fit.middle), fit.normal).abs()
        };
        let nearest = near.iter().copied().min_by(|&a, &b| off(a).total_cmp(&off(b)));
        joined.extend(nearest.filter(|&number| off(number) <= params.distance).map(|number| (row, number)));
        near.into_iter().for_each(|number| is_member[number as usize] = false);
    }
    for (row, number) in joined {
        owner[row as usize] = number;
        regions[number as usize].0.push(row);
    }
    regions.iter_mut().for_each(|(rows, _)| rows.sort_unstable());
}

/// Rows from the flattest surroundings on.
fn seeds(normals: &Normals) -> Vec<u32> {
    let mut seeds: Vec<u32> = (0..to_row(normals.vectors.len())).collect();
    let quality = |row: u32| normals.quality.get(row as usize).copied().unwrap_or(0.0);
    seeds.sort_by(|&a, &b| quality(b).total_cmp(&quality(a)).then(a.cmp(&b)));
    seeds
}

fn upward(normal: [f32; 3]) -> Option<[f64; 3]> {
    let normal = normal.map(f64::from);
    let normal = if normal[2] < 0.0 { normal.map(|v| -v) } else { normal };
    (dot(normal, normal) > 0.5).then_some(normal)
}

/// A plane that grows.
struct Region<'a> {
    points: &'a [[f32; 3]],
    index: &'a NeighborIndex,
    normals: &'a Normals,
    params: &'a RoofPlaneParams,
    owner: &'a mut [u32],
    number: u32,
}

impl Region<'_> {
    /// Grows, then once more with the plane found. Points of a region that does not become a plane are given free.
    fn grow_again(&mut self, seed: u32, start: PlaneFit) -> Option<(Vec<u32>, PlaneFit)> {
        let mut plane = start;
        for round in 0..ROUNDS {
            let (rows, fit, share) = self.grow(seed, plane);
            let is_last = round + 1 == ROUNDS;
            let is_plane = rows.len() >= MIN_POINTS && share >= MIN_SHARE;
            let fit = fit.filter(|fit| is_plane && fit.roughness <= self.params.distance);
            if !is_last || fit.is_none() {
                for &row in &rows {
                    self.owner[row as usize] = FREE;
                }
            }
            let found = fit?;
            if is_last {
                return Some((rows, found));
            }
            plane = found;
        }
        None
    }

    /// The points that are found from `seed`, their plane, and the share of all points within reach of them that lie on
    /// it.
    fn grow(&mut self, seed: u32, start: PlaneFit) -> (Vec<u32>, Option<PlaneFit>, f64) {
        let min_cosine = self.params.angle.cos();
        let reach = to_f32(self.params.reach);
        let mut plane = start;
        let mut rows = vec![seed];
        self.owner[seed as usize] = self.number;
        let mut next = 0;
        let mut next_fit = FIRST_FIT;
        let (mut near_count, mut on_count) = (0.0, 0.0);
        while let Some(&row) = rows.get(next) {
            next += 1;
            let (points, normals, owner) = (self.points, self.normals, &mut *self.owner);
            let mut near = Vec::new();
            self.index.within_radius(points[row as usize], reach, |neighbor| near.push(neighbor.index));
            // the order of the index depends on all points; that of rows only on those near
            near.sort_unstable();
            for row in near {
                let place = points[row as usize].map(f64::from);
                let Some(normal) = upward(normals.vectors[row as usize]) else { continue };
                let is_near = dot(sub(place, plane.middle), plane.normal).abs() <= self.params.distance;
                near_count += 1.0;
                on_count += f64::from(u8::from(is_near));
                if owner[row as usize] == FREE && is_near && dot(normal, plane.normal) >= min_cosine {
                    owner[row as usize] = self.number;
                    rows.push(row);
                }
            }
            if rows.len() >= next_fit {
                if let Some(fit) = self.fitted(&rows, plane.normal) {
                    plane = fit;
                }
                next_fit = rows.len() + rows.len() / 2;
            }
        }
        let fit = self.fitted(&rows, plane.normal);
        (rows, fit, on_count / f64::max(near_count, 1.0))
    }

    fn fitted(&self, rows: &[u32], about: [f64; 3]) -> Option<PlaneFit> {
        fit(rows.iter().map(|&row| self.points[row as usize].map(f64::from)), about)
    }
}
