//! Lines of sight of a simulated town: what speaks for each, and the truth.

use belvedere::Result;
use belvedere::cast::to_index;
use belvedere::control::Control;
use belvedere::query::{BlockRule, Evidence, MedialScene, UnprovenAs};
use belvedere::ray_index::Ray;
use belvedere::view::to_sun;
use belvedere_baselines::medial::{MedialParams, Outward, scene_model};
use belvedere_baselines::simulated::{SurveyedScene, surveyed};
use belvedere_scenes::{Preset, QuerySet, Regime, TargetsOfKind};
use rayon::prelude::*;

/// Class of points of buildings.
const BUILDING: u8 = 6;
/// Sides of the towns, metres.
const EXTENT: f64 = 110.0;
/// Targets of each set.
const TARGETS: usize = 1500;
/// Azimuths and elevations of the suns.
const SUNS_DEG: [[f64; 2]; 4] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0], [80.0, 10.0]];
/// How far away an aircraft is, metres.
const AIRCRAFT_RANGE: f64 = 400.0;
/// How high above the horizon, degrees.
const AIRCRAFT_ELEVATION_DEG: f64 = 70.0;
/// Sets of targets, in the order of the tables.
pub(crate) const SETS: [QuerySet; 6] = [
    QuerySet::Air,
    QuerySet::Pedestrians,
    QuerySet::Roofs,
    QuerySet::Facades,
    QuerySet::LinesOfSight,
    QuerySet::Volume,
];

/// A town and its survey.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TownSurvey {
    pub(crate) preset: Preset,
    pub(crate) seed: u64,
    pub(crate) regime: Regime,
    pub(crate) pulses_per_m2: f64,
}

/// A line of sight.
#[derive(Clone)]
pub(crate) struct Case {
    pub(crate) set: QuerySet,
    pub(crate) evidence: Evidence,
    pub(crate) is_visible: bool,
}

/// The scene that a survey shows, and the truth.
pub(crate) struct SurveyedTown {
    pub(crate) town: SurveyedScene,
    pub(crate) scene: MedialScene,
    /// Points of buildings, local metres.
    pub(crate) roof_points: Vec<[f32; 3]>,
}

impl SurveyedTown {
    pub(crate) fn new(survey: &TownSurvey) -> Result<Self> {
        let params = survey.regime.town(survey.preset.params(EXTENT, survey.seed));
        let town = survey.regime.scene(&params);
        let survey = surveyed(&survey.regime.scan(&town, &params, survey.pulses_per_m2))?;
        let town = SurveyedScene::new(town, survey);
        let model = scene_model(&town.input(), Outward::Survey, &MedialParams::carved())?;
        let scene = model.scene(&BlockRule::carved(), UnprovenAs::Reported, &Control::none())?;
        let classes = town.cloud.attributes.classification.as_deref().unwrap_or_default();
        let of_buildings = town.cloud.positions.iter().zip(classes).filter(|(_, class)| **class == BUILDING);
        let roof_points = of_buildings.map(|(place, _)| *place).collect();
        Ok(Self { town, scene, roof_points })
    }
}

impl TownSurvey {
    /// What the surveyed scene says of lines of sight to suns and between people, and the truth. Places anywhere, of
    /// which some are in buildings and in the ground, are looked at by people and from an aircraft too.
    pub(crate) fn cases(&self) -> Result<Vec<Case>> {
        let surveyed = SurveyedTown::new(self)?;
        let of_set = |set: QuerySet| surveyed.town.site().targets(set, TARGETS, self.seed);
        let TargetsOfKind { positions: people, eyes } = of_set(QuerySet::LinesOfSight);
        let mut cases = surveyed.between(QuerySet::LinesOfSight, &people, &eyes);
        for set in SETS.into_iter().filter(|set| *set != QuerySet::LinesOfSight) {
            let places = of_set(set).positions;
            cases.extend(surveyed.towards_suns(set, &places));
            if set == QuerySet::Volume {
                let aircraft: Vec<[f64; 3]> = places.iter().map(|place| above(*place)).collect();
                cases.extend(surveyed.between(set, &places, &eyes));
                cases.extend(surveyed.between(set, &places, &aircraft));
            }
        }
        Ok(cases)
    }
}

/// Where an aircraft flies that is seen from a place in one of the directions of suns, chosen by the place.
fn above(place: [f64; 3]) -> [f64; 3] {
    let [azimuth, _] = SUNS_DEG[to_index(place[0].abs() * 1e3) % SUNS_DEG.len()];
    let towards = to_sun(azimuth.to_radians(), AIRCRAFT_ELEVATION_DEG.to_radians());
    std::array::from_fn(|i| place[i] + AIRCRAFT_RANGE * towards[i])
}

impl SurveyedTown {
    /// Local position as clouds store it, metres.
    pub(crate) fn local(&self, place: [f64; 3]) -> [f64; 3] {
        self.town.local(place).map(f64::from)
    }

    fn towards_suns(&self, set: QuerySet, places: &[[f64; 3]]) -> Vec<Case> {
        let of_sun = |[azimuth, elevation]: [f64; 2]| {
            let direction = to_sun(azimuth.to_radians(), elevation.to_radians());
            let blocked = self.town.truth.occluded_towards_each(places, direction);
            let lines = places.par_iter().zip(blocked).filter_map(|(place, is_blocked)| {
                let sight = Ray { origin: self.local(*place), direction, ranges: [0.0, f64::INFINITY] };
                self.case(set, &sight, !is_blocked)
            });
            lines.collect::<Vec<Case>>()
        };
        SUNS_DEG.into_iter().flat_map(of_sun).collect()
    }

    fn between(&self, set: QuerySet, places: &[[f64; 3]], eyes: &[[f64; 3]]) -> Vec<Case> {
        let line = |(place, eye): (&[f64; 3], &[f64; 3])| {
            let sight = Ray::between(self.local(*place), self.local(*eye))?;
            self.case(set, &sight, !self.town.truth.occluded(*place, *eye))
        };
        places.par_iter().zip(eyes).filter_map(line).collect()
    }

    /// `None` where pulses are not known.
    fn case(&self, set: QuerySet, sight: &Ray, is_visible: bool) -> Option<Case> {
        let evidence = self.scene.evidence(sight.origin, sight.direction, sight.ranges[1])?;
        Some(Case { set, evidence, is_visible })
    }
}
