//! Lines of sight of a simulated town: what speaks for each, and the truth.

use belvedere::Result;
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::query::{BlockRule, Evidence, MedialScene, UnprovenAs};
use belvedere::ray_index::Ray;
use belvedere::view::to_sun;
use belvedere_baselines::MethodInput;
use belvedere_baselines::medial::{MedialParams, Outward, scene_model};
use belvedere_baselines::simulated::surveyed;
use belvedere_scenes::{Preset, QuerySet, QuerySite, Regime, TriangleScene, Truth};
use rayon::prelude::*;

/// Sides of the towns, metres.
const EXTENT: f64 = 110.0;
/// Targets of each set.
const TARGETS: usize = 1500;
/// Azimuths and elevations of the suns.
const SUNS_DEG: [[f64; 2]; 4] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0], [80.0, 10.0]];
/// Sets of targets, in the order of the tables.
pub(crate) const SETS: [QuerySet; 5] =
    [QuerySet::Air, QuerySet::Pedestrians, QuerySet::Roofs, QuerySet::Facades, QuerySet::LinesOfSight];

/// A town and its survey.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TownSurvey {
    pub(crate) preset: Preset,
    pub(crate) seed: u64,
    pub(crate) regime: Regime,
    pub(crate) pulses_per_m2: f64,
}

/// A line of sight.
pub(crate) struct Case {
    pub(crate) set: QuerySet,
    pub(crate) evidence: Evidence,
    pub(crate) is_visible: bool,
}

/// The scene that a survey shows, and the truth.
pub(crate) struct SurveyedTown {
    town: TriangleScene,
    pub(crate) scene: MedialScene,
    pub(crate) truth: Truth,
    pub(crate) origin: [f64; 3],
    bounds: [[f64; 3]; 2],
}

impl SurveyedTown {
    pub(crate) fn new(survey: &TownSurvey) -> Result<Self> {
        let params = survey.regime.town(survey.preset.params(EXTENT, survey.seed));
        let town = survey.regime.scene(&params);
        let (cloud, scanner) = surveyed(&survey.regime.scan(&town, &params, survey.pulses_per_m2))?;
        let input = MethodInput { cloud: &cloud, scanner: &scanner, models: &[] };
        let model = scene_model(&input, Outward::Survey, &MedialParams::carved())?;
        let scene = model.scene(&BlockRule::carved(), UnprovenAs::Reported, &Control::none())?;
        let (origin, bounds) = (cloud.frame.origin, cloud.bounds().unwrap_or_default());
        let absolute = |p: [f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + origin[i]);
        let bounds = [bounds.low, bounds.high].map(absolute);
        Ok(Self { truth: Truth::new(&town), town, scene, origin, bounds })
    }

    pub(crate) fn site(&self) -> QuerySite<'_> {
        QuerySite { scene: &self.town, truth: &self.truth, bounds: self.bounds }
    }
}

impl TownSurvey {
    /// What the surveyed scene says of lines of sight to suns and between people, and the truth.
    pub(crate) fn cases(&self) -> Result<Vec<Case>> {
        let surveyed = SurveyedTown::new(self)?;
        let SurveyedTown { scene, truth, origin, .. } = &surveyed;
        let mut cases = Vec::new();
        for set in SETS {
            let found = surveyed.site().targets(set, TARGETS, self.seed);
            let local: Vec<[f64; 3]> = found.positions.iter().map(|p| to_local(*p, *origin).map(f64::from)).collect();
            if set == QuerySet::LinesOfSight {
                let ends = local.par_iter().zip(&found.eyes).zip(&found.positions);
                cases.par_extend(ends.filter_map(|((target, eye), position)| {
                    let sight = Ray::between(*target, to_local(*eye, *origin).map(f64::from))?;
                    case(scene, set, &sight, !truth.occluded(*position, *eye))
                }));
                continue;
            }
            for [azimuth, elevation] in SUNS_DEG {
                let direction = to_sun(azimuth.to_radians(), elevation.to_radians());
                let blocked = truth.occluded_towards_each(&found.positions, direction);
                cases.par_extend(local.par_iter().zip(blocked).filter_map(|(target, is_blocked)| {
                    let sight = Ray { origin: *target, direction, ranges: [0.0, f64::INFINITY] };
                    case(scene, set, &sight, !is_blocked)
                }));
            }
        }
        Ok(cases)
    }
}

/// `None` where pulses are not known.
fn case(scene: &MedialScene, set: QuerySet, sight: &Ray, is_visible: bool) -> Option<Case> {
    let evidence = scene.evidence(sight.origin, sight.direction, sight.ranges[1])?;
    Some(Case { set, evidence, is_visible })
}
