//! A simulated town surveyed from the air, and what pedestrians in it see of the sun.

use belvedere::PointCloud;
use belvedere::view::to_sun;
use belvedere_baselines::simulated::{SurveyedScene, flown};
use belvedere_scenes::{AirborneParams, Preset, QuerySet, town};

/// A town, its scan, where the scanner was, and places in its streets with what is known of their light.
pub(crate) struct TownWithLight {
    pub(crate) cloud: PointCloud,
    pub(crate) scanner: Vec<[f32; 3]>,
    pub(crate) targets: Vec<[f32; 3]>,
    /// Directions to suns, and whether each target sees them.
    pub(crate) suns: Vec<([f64; 3], Vec<bool>)>,
}

impl TownWithLight {
    /// 80 m of a town of this kind, 8 pulses per m².
    pub(crate) fn new(preset: Preset) -> Self {
        let scene = town(&preset.params(80.0, 5));
        let survey = flown(&scene, &AirborneParams::covering(&scene, 8.0)).unwrap();
        let place = SurveyedScene::new(scene, survey);
        let exact = place.site().targets(QuerySet::Pedestrians, 10_000, 5).positions;
        let suns = [[110.0_f64, 20.0_f64], [180.0, 65.0], [240.0, 35.0]].map(|[azimuth, elevation]| {
            let direction = to_sun(azimuth.to_radians(), elevation.to_radians());
            let hidden = place.truth.occluded_towards_each(&exact, direction);
            (direction, hidden.into_iter().map(|hidden| !hidden).collect())
        });
        let targets = exact.into_iter().map(|p| place.local(p)).collect();
        let SurveyedScene { cloud, scanner, .. } = place;
        Self { cloud, scanner, targets, suns: suns.into() }
    }
}
