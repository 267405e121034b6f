//! Sun hours and sky views of carved balls on a simulated town, against the rays of its exact mesh.

#[path = "score.rs"]
pub(crate) mod score;

use belvedere::Result;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid, SurfaceParams, highest_points, top_surface};
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, BlockingTriangles, MedialScene, Viewer, Visibility};
use belvedere_baselines::medial::{MedialParams, Outward, scene_model};
use belvedere_baselines::simulated::SurveyedScene;
use belvedere_scenes::{Material, Preset, QuerySet};
use score::{LightDirections, LightScore, Setting};
use std::f64::consts::TAU;

/// How near a wall or a fence stands that a cell is said to lie at, metres.
const AT_WALL: f64 = 2.0;

/// What a question above a cell of a surface grid stands on.
#[derive(Clone, Copy, Debug)]
pub(crate) enum CellTops {
    /// The highest point in the cell.
    Highest,
    /// The surface at its middle.
    Surface,
}

/// Targets, and what the mesh lets them see.
pub(crate) struct JudgedTargets {
    /// Where they truly are, absolute.
    exact: Vec<[f64; 3]>,
    /// Where a user would ask for them, local metres.
    queried: Vec<[f32; 3]>,
    settings: Vec<Setting>,
    /// Whether each sees each direction, (M x D).
    free: Vec<bool>,
}

impl JudgedTargets {
    pub(crate) fn len(&self) -> usize {
        self.queried.len()
    }
}

/// A town, its survey and the balls made of it.
pub(crate) struct LightTown {
    pub(crate) town: SurveyedScene,
    pub(crate) balls: MedialBalls,
    triangles: Option<BlockingTriangles>,
    ground: Ground,
    /// Cells free of buildings, and the exact height of the ground there.
    bare: Vec<([f64; 2], f64)>,
}

impl LightTown {
    /// A town of `extent` metres flown over at eight pulses a square metre, and its ground in cells of `cell` metres.
    pub(crate) fn new(preset: Preset, extent: f64, cell: f64, seed: u64) -> Result<Self> {
        let town = SurveyedScene::flown(preset, extent, seed, 8.0)?;
        let model = scene_model(&town.input(), Outward::Survey, &MedialParams::carved())?;
        let triangles = model.triangles().cloned();
        let balls = model.into_parts().balls;
        let (low, high) = town.cloud.bounds().unwrap_or_default().on_map();
        let [x, y, _] = town.cloud.frame.origin;
        let grid = MapGrid::covering(low, high, cell, [x, y])?;
        let (ground, _) = Ground::of_cloud(&town.cloud, grid, &GroundParams::default(), &Control::none())?;
        let site = town.site();
        let bare = (0..grid.len()).filter_map(|i| {
            let [x, y] = grid.center(i % grid.width, i / grid.width);
            let at = [x + town.cloud.frame.origin[0], y + town.cloud.frame.origin[1]];
            let height = site.ground_height(at)?;
            (!site.is_inside([at[0], at[1], height + 0.05])).then_some(([x, y], height))
        });
        let bare = bare.collect();
        Ok(Self { town, balls, triangles, ground, bare })
    }

    /// About `count` cells of the ground, `height` metres above it: the truth above the exact ground, the question
    /// above the ground found in the cloud.
    pub(crate) fn ground_cells(&self, height: f64, count: usize, light: &LightDirections) -> JudgedTargets {
        let step = (self.bare.len() / count.max(1)).max(1);
        let (mut exact, mut queried) = (Vec::new(), Vec::new());
        for &([x, y], z) in self.bare.iter().step_by(step) {
            let Some(found) = self.ground.height_at([x, y]) else { continue };
            let [x, y] = [x + self.town.cloud.frame.origin[0], y + self.town.cloud.frame.origin[1]];
            exact.push([x, y, z + height]);
            queried.push(self.town.local([x, y, found + self.town.cloud.frame.origin[2] + height]));
        }
        self.places(exact, queried, light)
    }

    /// About `count` cells whose top is a roof, `height` metres above it: the truth above the exact roof at the middle
    /// of the cell, the question above what the points tell of it.
    pub(crate) fn roof_cells(
        &self,
        tops: CellTops,
        height: f64,
        count: usize,
        light: &LightDirections,
    ) -> Result<JudgedTargets> {
        let grid = self.ground.grid;
        let tops = match tops {
            CellTops::Highest => highest_points(&self.town.cloud.positions, &self.ground),
            CellTops::Surface => {
                top_surface(&self.town.cloud.positions, &self.ground, &SurfaceParams::default(), &Control::none())?
            }
        };
        let above = self.town.site().bounds[1][2] + 100.0;
        let (mut exact, mut queried) = (Vec::new(), Vec::new());
        for (cell, &top) in tops.values().iter().enumerate() {
            let [x, y] = grid.center(cell % grid.width, cell / grid.width);
            let at = [x + self.town.cloud.frame.origin[0], y + self.town.cloud.frame.origin[1]];
            let Some(hit) = self.town.truth.first_hit([at[0], at[1], above], [0.0, 0.0, -1.0], f64::INFINITY) else {
                continue;
            };
            if self.town.material(hit.triangle) == Some(Material::Roof) && top.is_finite() {
                exact.push([at[0], at[1], above - hit.range + height]);
                queried.push(self.town.local([
                    at[0],
                    at[1],
                    f64::from(top) + self.town.cloud.frame.origin[2] + height,
                ]));
            }
        }
        let step = (queried.len() / count.max(1)).max(1);
        Ok(self.places(exact.into_iter().step_by(step).collect(), queried.into_iter().step_by(step).collect(), light))
    }

    /// How high the questions of places stand above where these truly are, metres: mean, and mean of the absolute
    /// values.
    pub(crate) fn heights_off(places: &JudgedTargets, origin: f64) -> [f64; 2] {
        let off = |(exact, queried): (&[f64; 3], &[f32; 3])| f64::from(queried[2]) + origin - exact[2];
        let off: Vec<f64> = places.exact.iter().zip(&places.queried).map(off).collect();
        let mean = |value: fn(f64) -> f64| off.iter().map(|&v| value(v)).sum::<f64>() / off.len().max(1) as f64;
        [mean(|v| v), mean(f64::abs)]
    }

    /// About `count` places 0.1 m outside roofs, whose position is known.
    pub(crate) fn roofs(&self, count: usize, light: &LightDirections) -> JudgedTargets {
        let exact = self.town.site().targets(QuerySet::Roofs, count, 1).positions;
        let queried = exact.iter().map(|&p| self.town.local(p)).collect();
        self.places(exact, queried, light)
    }

    /// About `count` returns from roofs: the truth on their surface, the question at the return.
    pub(crate) fn roof_returns(&self, count: usize, light: &LightDirections) -> JudgedTargets {
        let site = self.town.site();
        let (mut exact, mut queried) = (Vec::new(), Vec::new());
        for (&p, &scanner) in self.town.cloud.positions.iter().zip(&self.town.scanner).step_by(7) {
            let Some((hit, outside)) = site.surface_of_return(self.town.absolute(scanner), self.town.absolute(p))
            else {
                continue;
            };
            if self.town.material(hit.triangle) == Some(Material::Roof) && queried.len() < 4 * count {
                exact.push(outside);
                queried.push(p);
            }
        }
        let step = (queried.len() / count.max(1)).max(1);
        self.places(exact.into_iter().step_by(step).collect(), queried.into_iter().step_by(step).collect(), light)
    }

    fn places(&self, exact: Vec<[f64; 3]>, queried: Vec<[f32; 3]>, light: &LightDirections) -> JudgedTargets {
        let (mut from, mut towards) = (Vec::new(), Vec::new());
        for &p in &exact {
            for &direction in &light.directions {
                from.push(p);
                towards.push(direction);
            }
        }
        let free = self.town.truth.first_hits(&from, &towards, f64::INFINITY).iter().map(Option::is_none).collect();
        let settings = exact.iter().map(|&p| self.setting(p)).collect();
        JudgedTargets { exact, queried, settings, free }
    }

    fn material(&self, from: [f64; 3], towards: [f64; 3], range: f64) -> Option<Material> {
        let hit = self.town.truth.first_hit(from, towards, range)?;
        self.town.material(hit.triangle)
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

    /// Answers for places of balls that block as `params` say; the places are queried `lift` metres higher.
    pub(crate) fn judge(
        &self,
        places: &JudgedTargets,
        light: &LightDirections,
        lift: f32,
        params: &BlockRule,
    ) -> Result<LightScore> {
        let scene = MedialScene::new(&self.balls, params)?.with_triangles(self.triangles.clone());
        let queried: Vec<[f32; 3]> = places.queried.iter().map(|p| [p[0], p[1], p[2] + lift]).collect();
        let found = scene.visibility_matrix(&queried, &light.directions, &Control::none())?;
        Ok(LightScore::new(places, light, &|target, column| found.is_free(target, column)))
    }

    /// What any other method answers for places.
    pub(crate) fn judge_other(
        &self,
        method: &dyn Visibility,
        places: &JudgedTargets,
        light: &LightDirections,
    ) -> Result<LightScore> {
        let mut columns = Vec::new();
        for &direction in &light.directions {
            columns.push(method.visible(Viewer::Direction(direction), &places.queried)?);
        }
        Ok(LightScore::new(places, light, &|target, column| columns[column][target] == Answer::Visible))
    }

    /// What blocks wrongly: the class of the point that the ball met first belongs to and how far off it is met; and
    /// what the balls miss: the material met first. Hours a target, the largest first.
    pub(crate) fn blame(
        &self,
        places: &JudgedTargets,
        light: &LightDirections,
        lift: f32,
        params: &BlockRule,
    ) -> Result<Vec<(String, f64)>> {
        let scene = MedialScene::new(&self.balls, params)?.with_triangles(self.triangles.clone());
        let mut sums = std::collections::BTreeMap::<String, f64>::new();
        let width = light.directions.len();
        let classes = self.town.cloud.attributes.classification.as_deref().unwrap_or_default();
        let near = |range: f64| match range {
            r if r < 1.0 => "< 1 m",
            r if r < 5.0 => "1 to 5 m",
            _ => "> 5 m",
        };
        for (target, free) in places.free.chunks(width).enumerate() {
            let at = places.queried[target].map(f64::from);
            let at = [at[0], at[1], at[2] + f64::from(lift)];
            for (&truly, &direction) in free.iter().zip(&light.directions).take(light.sun_count) {
                let block = scene.first_block(at, direction, f64::INFINITY);
                let what = match block {
                    Some((blocker, range)) if truly => {
                        let class = blocker
                            .ball()
                            .and_then(|row| self.balls.source.get(row))
                            .and_then(|&i| classes.get(i as usize));
                        format!("false shade: ball of class {} {} off", class.copied().unwrap_or(0), near(range))
                    }
                    None if !truly => {
                        let Some(hit) = self.town.truth.first_hit(places.exact[target], direction, f64::INFINITY)
                        else {
                            continue;
                        };
                        let material = self.town.material(hit.triangle).map_or("", |m| m.name());
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
