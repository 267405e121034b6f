//! Sun hours and sky views of carved balls on a simulated town, against the rays of its exact mesh.

#[path = "../../tests/common/flown.rs"]
mod flown;

use belvedere::apps::sky_view::SkyDirections;
use belvedere::ground::{Ground, GroundParams, MapGrid, highest_points};
use belvedere::medial::MedialBalls;
use belvedere::progress::Progress;
use belvedere::query::{MedialScene, SceneParams, visibility_matrix};
use belvedere::{PointCloud, Result};
use belvedere_baselines::Survey;
use belvedere_baselines::medial::{MedialParams, Outward, interior_balls};
use belvedere_scenes::{AirborneParams, Material, Preset, QuerySet, QuerySite, Scene, Truth, town};
use flown::flown;
use std::f64::consts::{PI, TAU};

/// How near a wall or a fence stands that a cell is said to lie at, metres.
const AT_WALL: f64 = 2.0;
/// Upper ends of the classes of elevation of the sun, degrees.
pub(crate) const ELEVATIONS_DEG: [f64; 5] = [5.0, 15.0, 30.0, 45.0, 90.0];

/// What is above or beside a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Setting {
    BelowCrown,
    BelowDeck,
    AtWall,
    Open,
}

impl Setting {
    pub(crate) const ALL: [Self; 4] = [Self::BelowCrown, Self::BelowDeck, Self::AtWall, Self::Open];
}

/// Directions of the sun through a day, and of the sky.
pub(crate) struct Light {
    pub(crate) directions: Vec<[f64; 3]>,
    /// How many of them are of the sun; those of the sky follow.
    pub(crate) sun_count: usize,
    /// Hours that each of the sun stands for.
    hours: f64,
}

impl Light {
    /// The sun of a declination at a latitude (radians) every `minutes` of a day while it is above the horizon, and `sky_count` directions
    /// of the sky.
    pub(crate) fn of_day(latitude: f64, declination: f64, minutes: f64, sky_count: usize) -> Result<Self> {
        let steps = (24.0 * 60.0 / minutes).round();
        let ((sin, cos), (sin_d, cos_d)) = (latitude.sin_cos(), declination.sin_cos());
        let mut directions = Vec::new();
        let mut step = 0.5;
        while step < steps {
            let (sin_t, cos_t) = (TAU * step / steps - PI).sin_cos();
            let to_sun = [-cos_d * sin_t, cos * sin_d - sin * cos_d * cos_t, sin * sin_d + cos * cos_d * cos_t];
            if to_sun[2] > 0.0 {
                directions.push(to_sun);
            }
            step += 1.0;
        }
        let sun_count = directions.len();
        directions.extend(SkyDirections::even(sky_count)?.directions);
        Ok(Self { directions, sun_count, hours: minutes / 60.0 })
    }

    /// Class of elevation of a direction.
    fn class(&self, direction: usize) -> usize {
        let elevation = self.directions.get(direction).map_or(0.0, |d| d[2].asin().to_degrees());
        ELEVATIONS_DEG.iter().position(|&most| elevation < most).unwrap_or(ELEVATIONS_DEG.len() - 1)
    }
}

/// Targets, and what the mesh lets them see.
pub(crate) struct Places {
    /// Where they truly are, absolute.
    exact: Vec<[f64; 3]>,
    /// Where a user would ask for them, local metres.
    asked: Vec<[f32; 3]>,
    settings: Vec<Setting>,
    /// Whether each sees each direction, (M x D).
    free: Vec<bool>,
}

impl Places {
    pub(crate) fn len(&self) -> usize {
        self.asked.len()
    }
}

/// How far answers are from the truth.
#[derive(Clone, Debug, Default)]
pub(crate) struct Score {
    /// Hours of sun: mean true, mean absolute error, and mean hours wrongly lit and wrongly shaded.
    pub(crate) sun: [f64; 4],
    /// The same with the sun above 5 degrees.
    pub(crate) sun_above_5: [f64; 4],
    /// Sky view factor of the level plane, and openness: mean true, mean absolute error, bias.
    pub(crate) factor: [f64; 3],
    pub(crate) openness: [f64; 3],
    /// Mean hours wrongly lit and wrongly shaded by class of elevation of the sun.
    pub(crate) by_elevation: [[f64; 2]; ELEVATIONS_DEG.len()],
    /// By what is above or beside: share of the targets, and what of the mean absolute error, of the hours wrongly lit and of the hours
    /// wrongly shaded they make; sky view factors likewise.
    pub(crate) by_setting: [[f64; 5]; Setting::ALL.len()],
}

fn balls_of(cloud: &PointCloud, scanner: &[[f32; 3]], params: &MedialParams) -> Result<MedialBalls> {
    let survey = Survey { cloud, scanner, models: &[] };
    interior_balls(&survey, Outward::Survey, params)
}

/// A town, its survey and the balls made of it.
pub(crate) struct Town {
    pub(crate) scene: Scene,
    pub(crate) truth: Truth,
    pub(crate) cloud: PointCloud,
    pub(crate) scanner: Vec<[f32; 3]>,
    pub(crate) balls: MedialBalls,
    ground: Ground,
    /// Cells free of buildings, and the exact height of the ground there.
    bare: Vec<([f64; 2], f64)>,
}

impl Town {
    /// A town of `extent` metres flown over at eight pulses a square metre, and its ground in cells of `cell` metres.
    pub(crate) fn new(preset: Preset, extent: f64, cell: f64, seed: u64) -> Result<Self> {
        let scene = town(&preset.params(extent, seed));
        let (cloud, scanner) = flown(&scene, &AirborneParams { seed, ..AirborneParams::covering(&scene, 8.0) })?;
        let balls = balls_of(&cloud, &scanner, &MedialParams::carved())?;
        let truth = Truth::new(&scene);
        let (low, high) = cloud.bounds().unwrap_or_default();
        let on_map = |p: [f32; 3]| [f64::from(p[0]), f64::from(p[1])];
        let grid = MapGrid::covering(on_map(low), on_map(high), cell, [cloud.origin[0], cloud.origin[1]])?;
        let (ground, _) = Ground::of_cloud(&cloud, grid, &GroundParams::default())?;
        let mut town = Self { scene, truth, cloud, scanner, balls, ground, bare: Vec::new() };
        let site = town.site();
        let bare = (0..grid.len()).filter_map(|i| {
            let [x, y] = grid.center(i % grid.width, i / grid.width);
            let at = [x + town.cloud.origin[0], y + town.cloud.origin[1]];
            let height = site.ground_height(at)?;
            (!site.is_inside([at[0], at[1], height + 0.05])).then_some(([x, y], height))
        });
        town.bare = bare.collect();
        Ok(town)
    }

    pub(crate) fn remake(&mut self, params: &MedialParams) -> Result<()> {
        self.balls = balls_of(&self.cloud, &self.scanner, params)?;
        Ok(())
    }

    pub(crate) fn site(&self) -> QuerySite<'_> {
        let (low, high) = self.cloud.bounds().unwrap_or_default();
        let bounds = [low, high].map(|corner| self.absolute(corner));
        QuerySite { scene: &self.scene, truth: &self.truth, bounds }
    }

    pub(crate) fn absolute(&self, p: [f32; 3]) -> [f64; 3] {
        std::array::from_fn(|i| f64::from(p[i]) + self.cloud.origin[i])
    }

    #[expect(clippy::cast_possible_truncation, reason = "local positions are f32")]
    fn local(&self, p: [f64; 3]) -> [f32; 3] {
        std::array::from_fn(|i| (p[i] - self.cloud.origin[i]) as f32)
    }

    /// About `count` cells of the ground, `height` metres above it: the truth above the exact ground, the question above the ground
    /// found in the cloud.
    pub(crate) fn ground_cells(&self, height: f64, count: usize, light: &Light) -> Places {
        let step = (self.bare.len() / count.max(1)).max(1);
        let (mut exact, mut asked) = (Vec::new(), Vec::new());
        for &([x, y], z) in self.bare.iter().step_by(step) {
            let Some(found) = self.ground.height_at([x, y]) else { continue };
            let [x, y] = [x + self.cloud.origin[0], y + self.cloud.origin[1]];
            exact.push([x, y, z + height]);
            asked.push(self.local([x, y, found + self.cloud.origin[2] + height]));
        }
        self.places(exact, asked, light)
    }

    /// About `count` cells whose top is a roof, `height` metres above it: the truth above the exact roof at the middle of the cell, the
    /// question above the highest point in the cell.
    pub(crate) fn roof_cells(&self, height: f64, count: usize, light: &Light) -> Places {
        let grid = self.ground.grid;
        let tops = highest_points(&self.cloud.positions, &self.ground);
        let above = self.site().bounds[1][2] + 100.0;
        let (mut exact, mut asked) = (Vec::new(), Vec::new());
        for (cell, &top) in tops.values().iter().enumerate() {
            let [x, y] = grid.center(cell % grid.width, cell / grid.width);
            let at = [x + self.cloud.origin[0], y + self.cloud.origin[1]];
            let Some(hit) = self.truth.first_hit([at[0], at[1], above], [0.0, 0.0, -1.0], f64::INFINITY) else {
                continue;
            };
            if self.scene.materials.get(hit.triangle as usize) == Some(&Material::Roof) && top.is_finite() {
                exact.push([at[0], at[1], above - hit.range + height]);
                asked.push(self.local([at[0], at[1], f64::from(top) + self.cloud.origin[2] + height]));
            }
        }
        let step = (asked.len() / count.max(1)).max(1);
        self.places(exact.into_iter().step_by(step).collect(), asked.into_iter().step_by(step).collect(), light)
    }

    /// About `count` places 0.1 m outside roofs, whose position is known.
    pub(crate) fn roofs(&self, count: usize, light: &Light) -> Places {
        let exact = self.site().targets(QuerySet::Roofs, count, 1).positions;
        let asked = exact.iter().map(|&p| self.local(p)).collect();
        self.places(exact, asked, light)
    }

    /// About `count` returns from roofs: the truth on their surface, the question at the return.
    pub(crate) fn roof_returns(&self, count: usize, light: &Light) -> Places {
        let site = self.site();
        let (mut exact, mut asked) = (Vec::new(), Vec::new());
        for (&p, &scanner) in self.cloud.positions.iter().zip(&self.scanner).step_by(7) {
            let Some((hit, outside)) = site.surface_of_return(self.absolute(scanner), self.absolute(p)) else {
                continue;
            };
            if self.scene.materials.get(hit.triangle as usize) == Some(&Material::Roof) && asked.len() < 4 * count {
                exact.push(outside);
                asked.push(p);
            }
        }
        let step = (asked.len() / count.max(1)).max(1);
        self.places(exact.into_iter().step_by(step).collect(), asked.into_iter().step_by(step).collect(), light)
    }

    fn places(&self, exact: Vec<[f64; 3]>, asked: Vec<[f32; 3]>, light: &Light) -> Places {
        let (mut from, mut towards) = (Vec::new(), Vec::new());
        for &p in &exact {
            for &direction in &light.directions {
                from.push(p);
                towards.push(direction);
            }
        }
        let free = self.truth.first_hits(&from, &towards, f64::INFINITY).iter().map(Option::is_none).collect();
        let settings = exact.iter().map(|&p| self.setting(p)).collect();
        Places { exact, asked, settings, free }
    }

    fn material(&self, from: [f64; 3], towards: [f64; 3], range: f64) -> Option<Material> {
        let hit = self.truth.first_hit(from, towards, range)?;
        self.scene.materials.get(hit.triangle as usize).copied()
    }

    fn setting(&self, p: [f64; 3]) -> Setting {
        match self.material(p, [0.0, 0.0, 1.0], f64::INFINITY) {
            Some(Material::TreeCrown | Material::Leaf | Material::Trunk) => return Setting::BelowCrown,
            Some(_) => return Setting::BelowDeck,
            None => {}
        }
        let knee = [p[0], p[1], p[2] + 0.5];
        let at_wall = (0..16).any(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 16.0).sin_cos();
            matches!(
                self.material(knee, [cos, sin, 0.0], AT_WALL),
                Some(Material::Facade | Material::Fence | Material::Slab | Material::Roof)
            )
        });
        if at_wall { Setting::AtWall } else { Setting::Open }
    }

    /// What balls that block as `params` say answer for places, asked `lift` metres higher.
    pub(crate) fn judge(&self, places: &Places, light: &Light, lift: f32, params: &SceneParams) -> Result<Score> {
        let scene = MedialScene::new(&self.balls, params)?;
        let asked: Vec<[f32; 3]> = places.asked.iter().map(|p| [p[0], p[1], p[2] + lift]).collect();
        let found = visibility_matrix(&scene, &asked, &light.directions, Progress::none())?;
        let mut score = Score::default();
        let width = light.directions.len();
        let one = 1.0 / places.len().max(1) as f64;
        let sky_count = (width - light.sun_count) as f64;
        for (target, (free, setting)) in places.free.chunks(width).zip(&places.settings).enumerate() {
            let mut lit = [[0.0; 2]; 2];
            let mut wrong = [[0.0; 2]; 2];
            let mut sky = [[0.0; 2]; 2];
            for (column, (&truly, direction)) in free.iter().zip(&light.directions).enumerate() {
                let seen = found.is_free(target, column);
                if column >= light.sun_count {
                    for (i, is_free) in [truly, seen].into_iter().enumerate() {
                        sky[0][i] += f64::from(u8::from(is_free)) * 2.0 * direction[2] / sky_count;
                        sky[1][i] += f64::from(u8::from(is_free)) / sky_count;
                    }
                    continue;
                }
                let class = light.class(column);
                for above in 0..if class > 0 { 2 } else { 1 } {
                    lit[above][0] += if truly { light.hours } else { 0.0 };
                    lit[above][1] += if seen { light.hours } else { 0.0 };
                    if seen != truly {
                        wrong[above][usize::from(truly)] += light.hours;
                    }
                }
                if seen != truly {
                    score.by_elevation[class][usize::from(truly)] += one * light.hours;
                }
            }
            for (sums, (lit, wrong)) in
                [&mut score.sun, &mut score.sun_above_5].into_iter().zip(lit.into_iter().zip(wrong))
            {
                for (sum, value) in sums.iter_mut().zip([lit[0], (lit[1] - lit[0]).abs(), wrong[0], wrong[1]]) {
                    *sum += one * value;
                }
            }
            for (sums, [truly, seen]) in [&mut score.factor, &mut score.openness].into_iter().zip(sky) {
                for (sum, value) in sums.iter_mut().zip([truly, (seen - truly).abs(), seen - truly]) {
                    *sum += one * value;
                }
            }
            let row = Setting::ALL.iter().position(|other| other == setting).unwrap_or_default();
            let parts = [1.0, (lit[0][1] - lit[0][0]).abs(), wrong[0][0], wrong[0][1], (sky[0][1] - sky[0][0]).abs()];
            for (sum, value) in score.by_setting[row].iter_mut().zip(parts) {
                *sum += one * value;
            }
        }
        Ok(score)
    }

    pub(crate) fn map(&self, places: &Places, light: &Light, params: &SceneParams) -> Result<Vec<[f64; 7]>> {
        let scene = MedialScene::new(&self.balls, params)?;
        let found = visibility_matrix(&scene, &places.asked, &light.directions, Progress::none())?;
        let width = light.directions.len();
        let mut rows = Vec::new();
        for (target, free) in places.free.chunks(width).enumerate() {
            let p = places.asked[target].map(f64::from);
            let mut row = [p[0], p[1], p[2], 0.0, 0.0, 0.0, 0.0];
            for column in 0..light.sun_count {
                let (truly, seen) = (free[column], found.is_free(target, column));
                row[3] += if truly { light.hours } else { 0.0 };
                row[4] += if seen { light.hours } else { 0.0 };
                row[5] += if seen && !truly { light.hours } else { 0.0 };
                row[6] += if !seen && truly { light.hours } else { 0.0 };
            }
            rows.push(row);
        }
        Ok(rows)
    }

    /// What blocks wrongly: the class of the point that the ball met first belongs to and how far off it is met; and what the balls
    /// miss: the material met first. Hours a target, the largest first.
    pub(crate) fn blame(
        &self,
        places: &Places,
        light: &Light,
        lift: f32,
        params: &SceneParams,
    ) -> Result<Vec<(String, f64)>> {
        let scene = MedialScene::new(&self.balls, params)?;
        let mut sums = std::collections::BTreeMap::<String, f64>::new();
        let width = light.directions.len();
        let classes = self.cloud.attributes.classification.as_deref().unwrap_or_default();
        let near = |range: f64| match range {
            r if r < 1.0 => "< 1 m",
            r if r < 5.0 => "1 to 5 m",
            _ => "> 5 m",
        };
        for (target, free) in places.free.chunks(width).enumerate() {
            let at = places.asked[target].map(f64::from);
            let at = [at[0], at[1], at[2] + f64::from(lift)];
            for (&truly, &direction) in free.iter().zip(&light.directions).take(light.sun_count) {
                let block = scene.first_block(at, direction, f64::INFINITY);
                let what = match block {
                    Some((row, range)) if truly => {
                        let class = self.balls.source.get(row).and_then(|&i| classes.get(i as usize));
                        format!("false shade: ball of class {} {} off", class.copied().unwrap_or(0), near(range))
                    }
                    None if !truly => {
                        let Some(hit) = self.truth.first_hit(places.exact[target], direction, f64::INFINITY) else {
                            continue;
                        };
                        let material = self.scene.materials.get(hit.triangle as usize).map_or("", |m| m.name());
                        format!("false light: {material} {} off", near(hit.range))
                    }
                    _ => continue,
                };
                *sums.entry(what).or_default() += light.hours / places.len().max(1) as f64;
            }
        }
        let mut sums: Vec<_> = sums.into_iter().collect();
        sums.sort_by(|a, b| b.1.total_cmp(&a.1));
        Ok(sums)
    }
}
