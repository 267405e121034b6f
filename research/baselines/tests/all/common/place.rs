//! A simulated town surveyed from the air, and what pedestrians in it see of the sun.

use belvedere::cloud::to_local;
use belvedere::view::to_sun;
use belvedere::{Bounds, PointCloud};
use belvedere_baselines::simulated::flown;
use belvedere_scenes::{AirborneParams, Preset, QuerySet, QuerySite, Truth, town};

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
        let (cloud, scanner) = flown(&scene, &AirborneParams::covering(&scene, 8.0)).unwrap();
        let origin = cloud.frame.origin;
        let truth = Truth::new(&scene);
        let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + origin[i]) };
        let Bounds { low, high } = cloud.bounds().unwrap();
        let site = QuerySite { scene: &scene, truth: &truth, bounds: [absolute(low), absolute(high)] };
        let exact = site.targets(QuerySet::Pedestrians, 10_000, 5).positions;
        let suns = [[110.0_f64, 20.0_f64], [180.0, 65.0], [240.0, 35.0]].map(|[azimuth, elevation]| {
            let direction = to_sun(azimuth.to_radians(), elevation.to_radians());
            let hidden = truth.occluded_towards_each(&exact, direction);
            (direction, hidden.into_iter().map(|hidden| !hidden).collect())
        });
        let targets = exact.into_iter().map(|p| to_local(p, origin)).collect();
        Self { cloud, scanner, targets, suns: suns.into() }
    }
}
