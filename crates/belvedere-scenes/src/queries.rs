//! Sets of targets whose visibility is worth asking for, and the viewers to ask from.

use crate::random::Random;
use crate::scene::{Material, TriangleScene};
use crate::truth::{CONTACT, Truth};
use crate::vector::{add_scaled, cross, dot, length, scale, sub, unit};
use rayon::prelude::*;

/// A kind of target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum QuerySet {
    /// Anywhere in a box: the experiment of Peters, Ledoux & Biljecki 2015. It flatters every method, because what lies
    /// within the ground or a building is blocked anyway.
    Volume,
    /// As [`QuerySet::Volume`], but in free air.
    Air,
    /// 1.5 m above the ground, in free air: chests of people, under decks and crowns too.
    Pedestrians,
    /// 0.1 m above the ground, in free air.
    Ground,
    /// 0.1 m above roofs; not below their eaves or beside them.
    Roofs,
    /// 0.1 m outside walls; not above chimneys, and not at parapets.
    Facades,
    /// Eyes 1.6 m above the ground that look at each other, as many pairs in each class of length.
    LinesOfSight,
}

impl QuerySet {
    /// Every kind.
    pub const ALL: [Self; 7] =
        [Self::Volume, Self::Air, Self::Pedestrians, Self::Ground, Self::Roofs, Self::Facades, Self::LinesOfSight];

    /// Short name for tables.
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
/// How far a return may lie from the surface it came from, along its line, metres: ten times the usual noise.
const RETURN_DEVIATION: f64 = 0.3;
/// Distance outside a surface of the point for which its visibility is computed, metres.
const OUTSIDE: f64 = 0.03;
/// A surface is a wall where the upward part of its normal is less than this either way, and a roof where it is more
/// than this: roofs may be steep, the sides of their eaves are upright.
const STEEP: f64 = 0.5;
const LEVEL: f64 = 0.05;
/// Bounds of the classes of length that lines of sight are drawn in, metres.
const SIGHT_LENGTHS: [f64; 5] = [5.0, 25.0, 50.0, 100.0, 200.0];
/// Least distance between two surfaces that a ray crosses for both to count, metres: an edge or a doubled face is one.
const SAME_SURFACE: f64 = 1e-4;
/// Crossings after which a ray is given up; no place has so many floors.
const MAX_CROSSINGS: usize = 64;
/// Draws tried for each target wanted, so that a scene without free ground ends.
const DRAWS_PER_TARGET: u64 = 64;

/// Where targets are looked for.
#[derive(Clone, Copy, Debug)]
pub struct QuerySite<'a> {
    /// The scene.
    pub scene: &'a TriangleScene,
    /// Its index.
    pub truth: &'a Truth,
    /// Lowest and highest corner of the box that targets lie in, absolute, metres: the box of the cloud.
    pub bounds: [[f64; 3]; 2],
}

/// Targets of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TargetsOfKind {
    /// Positions, (M, 3), absolute, metres.
    pub positions: Vec<[f64; 3]>,
    /// The other end of each line of sight, (M, 3), for [`QuerySet::LinesOfSight`]; empty otherwise.
    pub eyes: Vec<[f64; 3]>,
}

impl QuerySite<'_> {
    /// `count` targets of a kind, fewer where the place has no room for them (no roof, say).
    ///
    /// Every target draws from its own stream of `seed`, so that a longer list begins with the shorter one, whatever
    /// the number of threads. Free air is what [`QuerySite::is_inside`] denies.
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

    /// Whether `point` lies within a solid or below the terrain.
    ///
    /// Straight above the point, each surface left from within counts one more, each entered one less: the winding
    /// number of the closed solids (and of the ground) around it, which overlapping solids do not confuse. Triangles
    /// must be counter-clockwise seen from outside.
    #[must_use]
    pub fn is_inside(&self, point: [f64; 3]) -> bool {
        let up = [0.0, 0.0, 1.0];
        self.crossings(point, up).map(|(_, facing)| if facing > 0.0 { 1 } else { -1 }).sum::<i32>() > 0
    }

    /// Height of the terrain at absolute (x, y), metres, or `None` beyond its edge. The highest, where there are
    /// several.
    #[must_use]
    pub fn ground_height(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let top = self.bounds[1][2].max(self.scene_top()) + 1.0;
        self.crossings([x, y, top], [0.0, 0.0, -1.0])
            .find(|&(hit, _)| self.scene.materials.get(hit.triangle as usize) == Some(&Material::Terrain))
            .map(|(hit, _)| top - hit.range)
    }

    /// The surface that a laser return at `point` came from, for a scanner at `scanner`: the crossing of their line
    /// that lies nearest to the return, its triangle, and a point 3 cm outside it; `None` where no surface lies within
    /// 0.3 m of the return along the line. All absolute, metres.
    ///
    /// Visibility of a cloud's own points is computed for the point outside: the return itself lies behind or before
    /// the surface by chance.
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

    /// Two observers: a person's eyes in the open near the middle of the place, and 6 m above its highest roof,
    /// absolute, metres. The first is missing where no ground is free, the second where there is no roof.
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

    /// `count` people's eyes in the open anywhere in the place but for its outer twentieth, absolute, metres; fewer
    /// where little ground is free. Where no ground has the sky above it, they stand under a ceiling. One street
    /// observer says little: an error near it spoils a whole sector of its view.
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

    /// Eyes with room to step, not in a hedge, a passage or a car, within `reach` of `middle`: under the open sky, or
    /// where none of the ground is, as within a building, under a ceiling.
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

    /// Surfaces along a ray, nearest first, and whether each faces along it (positive: left from within).
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

    /// A free point `height` metres above the ground at (x, y).
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
    /// Outward unit normal of triangle `index`, or `None` where it does not exist or has no area.
    #[must_use]
    pub fn normal(&self, index: usize) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners(index)?;
        unit(cross(sub(b, a), sub(c, a)))
    }
}

/// Triangles of one material that face a way, drawn in proportion to their area.
#[derive(Default)]
struct SurfaceSampler {
    triangles: Vec<usize>,
    /// Area of all triangles up to and including each, m².
    areas: Vec<f64>,
}

impl SurfaceSampler {
    /// Of those triangles of `material` whose upward part of the unit normal is `wanted`.
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

    /// A point 0.1 m outside the surface.
    fn draw(&self, scene: &TriangleScene, random: &mut Random) -> Option<[f64; 3]> {
        let at = random.uniform() * self.areas.last()?;
        let chosen = self.areas.partition_point(|&area| area <= at);
        let [a, b, c] = scene.corners(*self.triangles.get(chosen)?)?;
        let (root, v) = (random.uniform().sqrt(), random.uniform());
        let on_surface = add_scaled(add_scaled(a, sub(b, a), root * (1.0 - v)), sub(c, a), root * v);
        Some(add_scaled(on_surface, scene.normal(self.triangles[chosen])?, OFF_SURFACE))
    }
}
