//! A simulated town with its survey, and questions with exact answers.

use belvedere::Bounds;
use belvedere::Result;
use belvedere::query::{Answer, MedialScene, Viewer, Visibility};
use belvedere::vector::{cross, unit};
use belvedere::view::to_sun;
use belvedere_baselines::MethodInput;
use belvedere_baselines::medial::MedialBaseline;
use belvedere_baselines::simulated::{SurveyedScene, flown, surveyed, without_returns_from_water};
use belvedere_scenes::{AirborneParams, Preset, QuerySet, Regime};
use std::collections::BTreeMap;

const EXTENT: f64 = 150.0;
const PULSES_PER_M2: f64 = 8.0;
const TARGETS: usize = 20_000;
/// Observers in streets.
const STREET_OBSERVERS: usize = 40;
/// Targets that each of them looks at.
const STREET_TARGETS: usize = 4000;
const SUNS_DEG: [[f64; 2]; 3] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0]];

/// How far targets may lie inside a surface, metres: see [`belvedere::query::BlockRule::shell`].
const SURFACE_TOLERANCE: f64 = 0.2;

/// How much of a solid is thin, metres.
const THIN: [f64; 2] = [0.2, 0.5];
/// From one side of a surface to the other, metres.
const SKIN: f64 = 1e-3;

/// The queries of one viewer for one set of targets.
pub(crate) struct ViewerTargets {
    pub(crate) set: &'static str,
    pub(crate) views: &'static str,
    pub(crate) viewer: Viewer<'static>,
    /// Whether each target is visible in truth.
    pub(crate) visible: Vec<bool>,
}

pub(crate) struct CarvingSite {
    town: SurveyedScene,
    /// Local positions by name of the set.
    pub(crate) targets: BTreeMap<&'static str, Vec<[f32; 3]>>,
    pub(crate) questions: Vec<ViewerTargets>,
}

/// What a survey lacks.
#[derive(Clone, Copy, Default)]
pub(crate) struct Missing {
    /// Classes of vegetation.
    pub(crate) vegetation: bool,
    /// Returns from the ground in strips, as if these were canals.
    pub(crate) water: bool,
}

/// Where lines of sight lie that are alike in truth, the wrongly answered ones and all: how many, how many at edges,
/// along unproven lines, and at either.
#[derive(Clone, Copy, Default)]
struct LineTally {
    wrong: [usize; 4],
    all: [usize; 4],
}

impl LineTally {
    fn add(&mut self, [is_at_edge, is_unproven]: [bool; 2], is_wrong: bool) {
        let counts = [true, is_at_edge, is_unproven, is_at_edge || is_unproven];
        for (k, is_counted) in counts.into_iter().enumerate() {
            self.all[k] += usize::from(is_counted);
            self.wrong[k] += usize::from(is_counted && is_wrong);
        }
    }
}

impl std::fmt::Display for LineTally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let shares = |counts: [usize; 4]| {
            let percent = |k: usize| 100.0 * counts[k] as f64 / counts[0].max(1) as f64;
            format!("{:.1} % at edges, {:.1} % unproven, {:.1} % at either", percent(1), percent(2), percent(3))
        };
        write!(f, "of these {}; of all {}", shares(self.wrong), shares(self.all))
    }
}

impl CarvingSite {
    /// A town with the usual survey from the air, or as `regime` has it, and with what is `missing` in it.
    pub(crate) fn simulated(preset: Preset, seed: u64, regime: Option<Regime>, missing: Missing) -> Result<Self> {
        let usual = preset.params(EXTENT, seed);
        let params = regime.map_or_else(|| usual.clone(), |regime| regime.town(usual.clone()));
        let scene = regime.unwrap_or(Regime::Air).scene(&params);
        let (mut cloud, scanner) = match regime {
            Some(regime) => surveyed(&regime.scan(&scene, &params, PULSES_PER_M2))?,
            None => flown(&scene, &AirborneParams { seed, ..AirborneParams::covering(&scene, PULSES_PER_M2) })?,
        };
        if missing.vegetation
            && let Some(classes) = &mut cloud.attributes.classification
        {
            classes.iter_mut().filter(|class| (3..=5).contains(*class)).for_each(|class| *class = 1);
        }
        let survey = if missing.water { without_returns_from_water(&cloud, &scanner) } else { (cloud, scanner) };
        let town = SurveyedScene::new(scene, survey);
        let mut place = Self { town, targets: BTreeMap::new(), questions: Vec::new() };
        place.ask(seed);
        Ok(place)
    }

    fn ask(&mut self, seed: u64) {
        let site = self.town.site();
        let sets = [
            ("AIR", QuerySet::Air, TARGETS),
            ("PED", QuerySet::Pedestrians, TARGETS),
            ("ROOF", QuerySet::Roofs, TARGETS),
            ("FACADE", QuerySet::Facades, TARGETS),
            ("STREET", QuerySet::Pedestrians, STREET_TARGETS),
        ];
        let mut sets_of_targets = BTreeMap::new();
        for (name, set, count) in sets {
            let positions = site.targets(set, count, seed).positions;
            sets_of_targets.insert(name, positions.into_iter().map(|p| self.town.local(p)).collect::<Vec<_>>());
        }
        let suns = SUNS_DEG.map(|[a, e]| ("suns", Viewer::Direction(to_sun(a.to_radians(), e.to_radians()))));
        let local = |eye: [f64; 3]| Viewer::Eye(self.town.eye(eye));
        let eyes = site.observers(seed).into_iter().flatten().map(|eye| ("eyes", local(eye)));
        let street = site.street_observers(STREET_OBSERVERS, seed).into_iter().map(|eye| ("street", local(eye)));
        let viewers: Vec<(&'static str, Viewer<'static>)> = suns.into_iter().chain(eyes).chain(street).collect();
        let mut questions = Vec::new();
        for (views, viewer) in viewers {
            for (&set, targets) in &sets_of_targets {
                if (views == "street") != (set == "STREET") {
                    continue;
                }
                let exact: Vec<[f64; 3]> = targets.iter().map(|&p| self.town.absolute(p)).collect();
                let blocked = match viewer {
                    Viewer::Direction(direction) => self.town.truth.occluded_towards_each(&exact, direction),
                    Viewer::Eye(eye) => self.town.truth.occluded_each(&exact, self.town.absolute_of(eye)),
                    Viewer::Each(_) => continue,
                };
                let visible = blocked.into_iter().map(|blocked| !blocked).collect();
                questions.push(ViewerTargets { set, views, viewer, visible });
            }
        }
        (self.targets, self.questions) = (sets_of_targets, questions);
    }

    /// Corners of the cloud, local metres.
    pub(crate) fn bounds(&self) -> Bounds {
        self.town.cloud.bounds().unwrap_or_default()
    }

    /// Whether a local position lies in a solid or in the ground.
    pub(crate) fn is_inside(&self, p: [f32; 3]) -> bool {
        self.town.site().is_inside(self.town.absolute(p))
    }

    /// The free local position `height` above the ground, if there is one.
    pub(crate) fn above_ground(&self, [x, y]: [f32; 2], height: f32) -> Option<[f32; 3]> {
        let [east, north, _] = self.town.absolute([x, y, 0.0]);
        let ground = self.town.local([east, north, self.town.site().ground_height([east, north])?]);
        let p = [x, y, ground[2] + height];
        (!self.is_inside(p)).then_some(p)
    }

    /// Whether nothing stands between a local position and the sun.
    pub(crate) fn is_lit(&self, p: [f32; 3], sun: [f64; 3]) -> bool {
        !self.town.truth.occluded_towards(self.town.absolute(p), sun)
    }

    pub(crate) fn survey(&self) -> MethodInput<'_> {
        self.town.input()
    }

    /// Whether a line of sight half a spacing of pulses beside this one, on any side, is blocked in truth where this
    /// one is free, or free where it is blocked. What is nearer to the target than the surface tolerance does not
    /// count.
    fn is_at_edge(&self, target: [f32; 3], towards: [f64; 3], range: f64, is_free: bool) -> bool {
        let across = unit(cross(towards, [0.0, 0.0, 1.0])).unwrap_or([1.0, 0.0, 0.0]);
        let up = cross(across, towards);
        let half_spacing = 0.5 / PULSES_PER_M2.sqrt();
        let target = self.town.absolute(target);
        (0..8_u32).any(|eighth| {
            let (sin, cos) = (f64::from(eighth) * std::f64::consts::FRAC_PI_4).sin_cos();
            let beside: [f64; 3] = std::array::from_fn(|i| {
                target[i] + SURFACE_TOLERANCE * towards[i] + half_spacing * (cos * across[i] + sin * up[i])
            });
            let is_hit = || self.town.truth.first_hit(beside, towards, range - SURFACE_TOLERANCE).is_some();
            (self.town.site().is_inside(beside) || is_hit()) == is_free
        })
    }

    /// Prints by surface what hides what a model calls visible, and at what its balls sit that hide what is visible;
    /// and what share of both lies at edges or along lines that the pulses of `with_pulses` do not prove.
    pub(crate) fn blame(&self, model: &MedialBaseline, with_pulses: &MedialScene) -> Result<()> {
        let absolute = |p| self.town.absolute(p);
        let site = self.town.site();
        let kind = |triangle: u32| self.town.material(triangle).map_or("?", |material| material.name());
        for views in ["suns", "street"] {
            for set in ["PED", "AIR", "ROOF", "FACADE", "STREET"] {
                let (mut missed, mut blocking) = (BTreeMap::<&str, usize>::new(), BTreeMap::<String, usize>::new());
                let (mut visible_count, mut blocked_count) = (0, 0);
                // those that are blocked in truth, and those that are visible
                let mut tallies = [LineTally::default(); 2];
                let mut thin = [0; 2];
                for question in self.questions.iter().filter(|q| q.set == set && q.views == views) {
                    let targets = &self.targets[set];
                    let answers = model.visible(question.viewer, targets)?;
                    for ((&target, &visible), &answer) in targets.iter().zip(&question.visible).zip(&answers) {
                        let Some((towards, range)) = question.viewer.line_of_sight(0, target) else { continue };
                        visible_count += usize::from(visible);
                        blocked_count += usize::from(!visible);
                        let place = [
                            self.is_at_edge(target, towards, range, visible),
                            with_pulses.is_unproven(target.map(f64::from), towards, range),
                        ];
                        tallies[usize::from(visible)].add(place, visible == (answer == Answer::Blocked));
                        if !visible && answer == Answer::Visible {
                            let hit = self.town.truth.first_hit(absolute(target), towards, range);
                            *missed.entry(hit.map_or("?", |hit| kind(hit.triangle))).or_default() += 1;
                            let enters = hit.map_or(0.0, |hit| hit.range) + SKIN;
                            let inside = std::array::from_fn(|i| absolute(target)[i] + enters * towards[i]);
                            let solid = self.town.truth.first_hit(inside, towards, f64::INFINITY).map(|hit| hit.range);
                            for (count, max) in thin.iter_mut().zip(THIN) {
                                *count += usize::from(solid.is_some_and(|solid| solid < max));
                            }
                        }
                        if visible && answer == Answer::Blocked {
                            let block = model.scene().first_block(target.map(f64::from), towards, range);
                            let Some(row) = block.and_then(|(blocker, _)| blocker.ball()) else { continue };
                            let (source, radius) = (model.balls().source[row] as usize, model.balls().radii[row]);
                            let surface = site
                                .surface_of_return(
                                    absolute(self.town.scanner[source]),
                                    absolute(self.town.cloud.positions[source]),
                                )
                                .map_or("?", |(hit, _)| kind(hit.triangle));
                            let size = ["<.2", "<.5", "<1", "<2", ">2"]
                                [[0.2, 0.5, 1.0, 2.0].iter().filter(|&&r| radius > r).count()];
                            *blocking.entry(format!("{surface} r{size}")).or_default() += 1;
                        }
                    }
                }
                let share = |count: usize, all: usize| 100.0 * count as f64 / all.max(1) as f64;
                let list = |items: Vec<(String, f64)>| {
                    let mut items = items;
                    items.sort_by(|a, b| b.1.total_cmp(&a.1));
                    items.iter().take(9).map(|(name, v)| format!("{name} {v:.2}")).collect::<Vec<_>>().join(", ")
                };
                let all_missed = missed.values().sum();
                let missed = missed.into_iter().map(|(k, v)| (k.to_owned(), share(v, blocked_count))).collect();
                let blocking = blocking.into_iter().map(|(k, v)| (k, share(v, visible_count))).collect();
                if visible_count > 0 {
                    println!("  {views} {set}: false-visible by {}; {}", list(missed), tallies[0]);
                    let [narrow, half] = thin.map(|count| share(count, all_missed));
                    println!(
                        "  {views} {set}: of these {narrow:.1} and {half:.1} % through less than 0.2 and 0.5 m of the first solid"
                    );
                    println!("  {views} {set}: false-blocked by {}; {}", list(blocking), tallies[1]);
                }
            }
        }
        Ok(())
    }
}
