//! Sets of targets and viewers for tests of visibility.

use crate::random::Random;
use crate::scene::{Material, TriangleScene};
use crate::truth::{CONTACT, Truth};
use crate::vector::{add_scaled, cross, dot, length, scale, sub, unit};
use rayon::prelude::*;

/// Kind of target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum QuerySet {
    /// Random points in a box: the experiment of Peters, Ledoux & Biljecki 2015. It flatters every method, because
    /// points within the ground or a building are blocked anyway.
    Volume,
    /// Random points as in [`QuerySet::Volume`], but in free air.
    Air,
    /// Points 1.5 m above the ground, in free air: chests of people, also under decks and crowns.
    Pedestrians,
    /// Points 0.1 m above the ground, in free air.
    Ground,
    /// Points 0.1 m above roofs; not below their eaves or beside them.
    Roofs,
    /// Points 0.1 m outside walls; not above chimneys, and not at parapets.
    Facades,
    /// Pairs of eyes 1.6 m above the ground that look at each other, equally many in each class of length.
    LinesOfSight,
}

impl QuerySet {
    /// All kinds.
    pub const ALL: [Self; 7] =
        [Self::Volume, Self::Air, Self::Pedestrians, Self::Ground, Self::Roofs, Self::Facades, Self::LinesOfSight];

    /// Returns the short name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Volume => "VOL",
            Self::Air => "AIR",
            Self::Pedestrians => "PED",
            Self::Ground => "GRD",
            Self::Roofs => "ROOF",
            Self::Facades => "FACADE",
            Self::LinesOfSight => "LOS",
        }
    }
}

/// Heights above the ground and distances from surfaces, metres.
const CHEST: f64 = 1.5;
const EYE: f64 = 1.6;
const ABOVE_ROOF: f64 = 6.0;
const OFF_SURFACE: f64 = 0.1;
/// Maximum distance of a return from its surface along its line, metres: ten times the usual noise.
const RETURN_DEVIATION: f64 = 0.3;
/// Distance outside a surface of the point whose visibility is computed, metres.
const OUTSIDE: f64 = 0.03;
/// Limits of the upward component of the unit normal, without unit. A wall has an absolute value below `STEEP`, a roof
/// a value above `LEVEL`. Roofs may be steep, but the sides of their eaves are upright.
const STEEP: f64 = 0.5;
const LEVEL: f64 = 0.05;
/// Bounds of the classes of length of lines of sight, metres.
const SIGHT_LENGTHS: [f64; 5] = [5.0, 25.0, 50.0, 100.0, 200.0];
/// Minimum distance between two surfaces on a ray that count separately, metres. An edge or a doubled face counts as
/// one.
const SAME_SURFACE: f64 = 1e-4;
/// Maximum number of crossings of a ray; no place has so many floors.
const MAX_CROSSINGS: usize = 64;
/// Maximum number of draws per target, so that the search ends in a scene without free ground.
const DRAWS_PER_TARGET: u64 = 64;

/// Site in which targets are drawn.
#[derive(Clone, Copy, Debug)]
pub struct QuerySite<'a> {
    /// Scene of the site.
    pub scene: &'a TriangleScene,
    /// Index of the scene.
    pub truth: &'a Truth,
    /// Lowest and highest corner of the box of targets, absolute, metres. It is the box of the cloud.
    pub bounds: [[f64; 3]; 2],
}

/// Targets of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TargetsOfKind {
    /// Positions, (M, 3), absolute, metres.
    pub positions: Vec<[f64; 3]>,
    /// Other end of each line of sight, (M, 3), for [`QuerySet::LinesOfSight`]; empty otherwise.
    pub eyes: Vec<[f64; 3]>,
}

impl QuerySite<'_> {
    /// Returns `count` targets of a kind, fewer in a place without enough room for them, such as one without roofs.
    ///
    /// Every target draws from its own stream of `seed`. A longer list therefore begins with the shorter one, for any
    /// number of threads. A point is in free air if [`QuerySite::is_inside`] is false.
    #[must_use]
    pub fn targets(&self, set: QuerySet, count: usize, seed: u64) -> TargetsOfKind {
        let surfaces = match set {
            QuerySet::Roofs => SurfaceSampler::new(self.scene, Material::Roof, |up| up > LEVEL),
            QuerySet::Facades => SurfaceSampler::new(self.scene, Material::Facade, |up| up.abs() < STEEP),
            _ => SurfaceSampler::default(),
        };
        let draw = |number: usize| {
            let mut random = Random::new(seed, ((set as u64) << 48) | number as u64);
            (0..DRAWS_PER_TARGET).find_map(|_| match set {
                QuerySet::Volume => Some((self.anywhere(&mut random), None)),
                QuerySet::Air => Some((self.anywhere(&mut random), None)).filter(|&(p, _)| !self.is_inside(p)),
                QuerySet::Pedestrians => self.above_ground(CHEST, &mut random).map(|p| (p, None)),
                QuerySet::Ground => self.above_ground(OFF_SURFACE, &mut random).map(|p| (p, None)),
                QuerySet::Roofs | QuerySet::Facades => {
                    let p = surfaces.draw(self.scene, &mut random)?;
                    let in_bounds = (0..2).all(|i| (self.bounds[0][i]..=self.bounds[1][i]).contains(&p[i]));
                    (in_bounds && !self.is_inside(p)).then_some((p, None))
                }
                QuerySet::LinesOfSight => {
                    let class = number % (SIGHT_LENGTHS.len() - 1);
                    self.line_of_sight(SIGHT_LENGTHS[class], SIGHT_LENGTHS[class + 1], &mut random)
                }
            })
        };
        let drawn: Vec<_> = (0..count).into_par_iter().filter_map(draw).collect();
        TargetsOfKind {
            positions: drawn.iter().map(|&(position, _)| position).collect(),
            eyes: drawn.iter().filter_map(|&(_, eye)| eye).collect(),
        }
    }

    /// Returns true if `point` lies within a solid or below the terrain.
    ///
    /// On the ray straight up, each surface left from within counts plus one, and each surface entered counts minus
    /// one. The sum is the winding number of the closed solids and the ground. It stays correct for overlapping solids.
    /// Triangles must be counter-clockwise seen from outside.
    #[must_use]
    pub fn is_inside(&self, point: [f64; 3]) -> bool {
        let up = [0.0, 0.0, 1.0];
        self.crossings(point, up).map(|(_, facing)| if facing > 0.0 { 1 } else { -1 }).sum::<i32>() > 0
    }

    /// Returns the height of the highest terrain at absolute (x, y), metres; `None` beyond its edge.
    #[must_use]
    pub fn ground_height(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let top = self.bounds[1][2].max(self.scene_top()) + 1.0;
        self.crossings([x, y, top], [0.0, 0.0, -1.0])
            .find(|&(hit, _)| self.scene.materials.get(hit.triangle as usize) == Some(&Material::Terrain))
            .map(|(hit, _)| top - hit.range)
    }

    /// Returns the surface that reflected a laser return at `point` to a scanner at `scanner`, both absolute, metres.
    /// The result is the crossing of their line nearest to the return, and a point 3 cm outside its surface. `None`
    /// without a surface within 0.3 m of the return along the line.
    ///
    /// Visibility of a cloud's own points is computed for the point outside, because noise puts the return itself in
    /// front of or behind the surface.
    #[must_use]
    pub fn surface_of_return(&self, scanner: [f64; 3], point: [f64; 3]) -> Option<(crate::Hit, [f64; 3])> {
        let direction = unit(sub(point, scanner))?;
        let range = length(sub(point, scanner));
        let (hit, _) = self
            .crossings_from(scanner, direction, (range - RETURN_DEVIATION).max(CONTACT))
            .take_while(|(hit, _)| hit.range <= range + RETURN_DEVIATION)
            .min_by(|a, b| (a.0.range - range).abs().total_cmp(&(b.0.range - range).abs()))?;
        let normal = self.scene.normal(hit.triangle as usize)?;
        Some((hit, add_scaled(add_scaled(scanner, direction, hit.range), normal, OUTSIDE)))
    }

    /// Returns two observers, absolute, metres. The first is the eyes of a person in the open near the middle of the
    /// place, or `None` without free ground. The second is a point 6 m above the highest roof, or `None` without a
    /// roof.
    #[must_use]
    pub fn observers(&self, seed: u64) -> [Option<[f64; 3]>; 2] {
        let [low, high] = self.bounds;
        let middle = [0, 1].map(|i| (low[i] + high[i]) / 2.0);
        let reach = [0, 1].map(|i| (high[i] - low[i]) / 6.0);
        let mut random = Random::new(seed, u64::MAX);
        let street = self.standing_in_the_open(middle, reach, &mut random);
        let highest = (0..self.scene.triangles.len())
            .filter(|&t| self.scene.materials.get(t) == Some(&Material::Roof))
            .filter_map(|t| self.scene.corners(t))
            .map(|[a, b, c]| scale([a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]], 1.0 / 3.0))
            .filter(|p| (0..2).all(|i| (low[i]..=high[i]).contains(&p[i])))
            .max_by(|a, b| a[2].total_cmp(&b[2]));
        [street, highest.map(|p| [p[0], p[1], p[2] + ABOVE_ROOF])]
    }

    /// Returns the eyes of `count` people in the open, absolute, metres; fewer on a site with little free ground. The
    /// outer twentieth of the place is left out. If no ground has the sky above it, the people stand under a ceiling.
    /// Results from one street observer are unreliable: an error near it spoils a whole sector of its view.
    #[must_use]
    pub fn street_observers(&self, count: usize, seed: u64) -> Vec<[f64; 3]> {
        let [low, high] = self.bounds;
        let middle = [0, 1].map(|i| (low[i] + high[i]) / 2.0);
        let reach = [0, 1].map(|i| (high[i] - low[i]) * 0.45);
        let eye = |number: usize| {
            self.standing_in_the_open(middle, reach, &mut Random::new(seed, u64::MAX - 1 - number as u64))
        };
        (0..count).into_par_iter().filter_map(eye).collect()
    }

    /// Returns eyes with room to step, not in a hedge, a passage or a car, within `reach` of `middle`. They are under
    /// the open sky. If all ground is covered, as within a building, they are under a ceiling.
    fn standing_in_the_open(&self, middle: [f64; 2], reach: [f64; 2], random: &mut Random) -> Option<[f64; 3]> {
        let is_under_the_sky = |eye: [f64; 3]| !self.truth.occluded_towards(eye, [0.0, 0.0, 1.0]);
        self.with_room_to_step(middle, reach, random, is_under_the_sky)
            .or_else(|| self.with_room_to_step(middle, reach, random, |_| true))
    }

    fn with_room_to_step(
        &self,
        middle: [f64; 2],
        reach: [f64; 2],
        random: &mut Random,
        is_wanted: impl Fn([f64; 3]) -> bool,
    ) -> Option<[f64; 3]> {
        (0..1000).find_map(|_| {
            let at = [0, 1].map(|i| middle[i] + random.between(-reach[i], reach[i]));
            let eye = self.standing_at(at, EYE)?;
            let free = (0..16).all(|i| {
                let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 16.0).sin_cos();
                self.truth.first_hit(eye, [cos, sin, 0.0], 1.5).is_none()
            });
            (free && is_wanted(eye)).then_some(eye)
        })
    }

    fn scene_top(&self) -> f64 {
        self.scene.bounds().map_or(0.0, |(_, high)| high[2])
    }

    /// Returns the surfaces along a ray, the nearest first, with the cosine between normal and ray (positive: left from
    /// within).
    fn crossings(&self, origin: [f64; 3], direction: [f64; 3]) -> impl Iterator<Item = (crate::Hit, f64)> + '_ {
        self.crossings_from(origin, direction, CONTACT)
    }

    fn crossings_from(
        &self,
        origin: [f64; 3],
        direction: [f64; 3],
        mut passed: f64,
    ) -> impl Iterator<Item = (crate::Hit, f64)> + '_ {
        std::iter::from_fn(move || {
            let hit = self.truth.first_hit_between(origin, direction, passed, f64::INFINITY)?;
            passed = hit.range + SAME_SURFACE;
            Some((hit, dot(self.scene.normal(hit.triangle as usize)?, direction)))
        })
        .take(MAX_CROSSINGS)
    }

    fn anywhere(&self, random: &mut Random) -> [f64; 3] {
        let [low, high] = self.bounds;
        std::array::from_fn(|i| random.between(low[i], high[i]))
    }

    /// Returns a free point `height` metres above the ground at (x, y).
    fn standing_at(&self, at: [f64; 2], height: f64) -> Option<[f64; 3]> {
        let point = [at[0], at[1], self.ground_height(at)? + height];
        (!self.is_inside(point)).then_some(point)
    }

    fn above_ground(&self, height: f64, random: &mut Random) -> Option<[f64; 3]> {
        let [x, y, _] = self.anywhere(random);
        self.standing_at([x, y], height)
    }

    fn line_of_sight(&self, shortest: f64, longest: f64, random: &mut Random) -> Option<([f64; 3], Option<[f64; 3]>)> {
        let target = self.above_ground(EYE, random)?;
        let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
        let distance = random.between(shortest, longest);
        let at = [target[0] + distance * cos, target[1] + distance * sin];
        let in_bounds = (0..2).all(|i| (self.bounds[0][i]..=self.bounds[1][i]).contains(&at[i]));
        let eye = in_bounds.then(|| self.standing_at(at, EYE))??;
        Some((target, Some(eye)))
    }
}

impl TriangleScene {
    /// Returns the outward unit normal of triangle `index`; `None` for a missing triangle or one without area.
    #[must_use]
    pub fn normal(&self, index: usize) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners(index)?;
        unit(cross(sub(b, a), sub(c, a)))
    }
}

/// Triangles of one material and orientation, drawn in proportion to their area.
#[derive(Default)]
struct SurfaceSampler {
    triangles: Vec<usize>,
    /// Cumulative area of the triangles, m².
    areas: Vec<f64>,
}

impl SurfaceSampler {
    /// Selects the triangles of `material` for which `wanted` accepts the upward component of the unit normal.
    fn new(scene: &TriangleScene, material: Material, wanted: impl Fn(f64) -> bool) -> Self {
        let mut sampler = Self::default();
        let mut total = 0.0;
        for triangle in 0..scene.triangles.len() {
            let Some([a, b, c]) = scene.corners(triangle) else { continue };
            let area = length(cross(sub(b, a), sub(c, a))) / 2.0;
            let faces = scene.normal(triangle).is_some_and(|normal| wanted(normal[2]));
            if faces && scene.materials.get(triangle) == Some(&material) && area > 0.0 && area.is_finite() {
                total += area;
                sampler.triangles.push(triangle);
                sampler.areas.push(total);
            }
        }
        sampler
    }

    /// Draws a point 0.1 m outside the surface.
    fn draw(&self, scene: &TriangleScene, random: &mut Random) -> Option<[f64; 3]> {
        let at = random.uniform() * self.areas.last()?;
        let chosen = self.areas.partition_point(|&area| area <= at);
        let [a, b, c] = scene.corners(*self.triangles.get(chosen)?)?;
        let (root, v) = (random.uniform().sqrt(), random.uniform());
        let on_surface = add_scaled(add_scaled(a, sub(b, a), root * (1.0 - v)), sub(c, a), root * v);
        Some(add_scaled(on_surface, scene.normal(self.triangles[chosen])?, OFF_SURFACE))
    }
}
