//! Simulated scans as clouds, with the position of the scanner at each point and the exact scene.

use crate::MethodInput;
use belvedere::cloud::{centre_rounded, to_local};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, Error, Frame, GpsTimeKind, Parameter, PointCloud, Result};
use belvedere_scenes::{AirborneParams, Material, Preset, QuerySite, Scan, TriangleScene, Truth, scan_airborne, town};

/// A scene, its exact rays, and a survey of it.
pub struct SurveyedScene {
    /// The exact scene.
    pub scene: TriangleScene,
    /// Exact rays in the scene.
    pub truth: Truth,
    /// The points of the survey.
    pub cloud: PointCloud,
    /// Local position of the scanner for each point, (N, 3), metres; empty where unknown.
    pub scanner: Vec<[f32; 3]>,
    /// Lowest and highest corner of the cloud, absolute, metres.
    bounds: [[f64; 3]; 2],
}

impl SurveyedScene {
    /// Puts a scene beside a survey of it.
    #[must_use]
    pub fn new(scene: TriangleScene, (cloud, scanner): (PointCloud, Vec<[f32; 3]>)) -> Self {
        let bounds = cloud.bounds().unwrap_or_default();
        let absolute = |p: [f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + cloud.frame.origin[i]);
        let bounds = [bounds.low, bounds.high].map(absolute);
        Self { truth: Truth::new(&scene), scene, cloud, scanner, bounds }
    }

    /// Flies over a town of `extent` metres.
    ///
    /// # Errors
    /// See [`surveyed`].
    pub fn flown(preset: Preset, extent: f64, seed: u64, pulses_per_m2: f64) -> Result<Self> {
        let scene = town(&preset.params(extent, seed));
        let survey = flown(&scene, &AirborneParams { seed, ..AirborneParams::covering(&scene, pulses_per_m2) })?;
        Ok(Self::new(scene, survey))
    }

    /// The survey as methods get it, without models.
    #[must_use]
    pub fn input(&self) -> MethodInput<'_> {
        MethodInput { cloud: &self.cloud, scanner: &self.scanner, models: &[] }
    }

    /// The box of the cloud in the scene.
    #[must_use]
    pub fn site(&self) -> QuerySite<'_> {
        QuerySite { scene: &self.scene, truth: &self.truth, bounds: self.bounds }
    }

    /// Absolute position of a local one, metres.
    #[must_use]
    pub fn absolute(&self, local: [f32; 3]) -> [f64; 3] {
        self.absolute_of(local.map(f64::from))
    }

    /// Absolute position of an eye, metres.
    #[must_use]
    pub fn absolute_of(&self, eye: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| eye[i] + self.cloud.frame.origin[i])
    }

    /// Local position of an absolute one, metres.
    #[must_use]
    pub fn local(&self, absolute: [f64; 3]) -> [f32; 3] {
        to_local(absolute, self.cloud.frame.origin)
    }

    /// Local position of an absolute one, metres, for eyes.
    #[must_use]
    pub fn eye(&self, absolute: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| absolute[i] - self.cloud.frame.origin[i])
    }

    /// Material of a triangle.
    #[must_use]
    pub fn material(&self, triangle: u32) -> Option<Material> {
        self.scene.materials.get(triangle as usize).copied()
    }
}

/// The kind of town with a name.
///
/// # Errors
/// [`Error::InvalidParameter`] for another name.
pub fn preset(name: &str) -> Result<Preset> {
    Preset::ALL.into_iter().find(|preset| preset.name() == name).ok_or_else(|| Error::InvalidParameter {
        parameter: Parameter::MethodSetting,
        value: format!("{name} for the preset"),
        expected: "village, town, old-town, towers or park",
    })
}

/// The cloud of a survey from the air, and the position of the scanner at each of its points, (N, 3) local metres.
///
/// # Errors
///
/// See [`surveyed`].
pub fn flown(scene: &TriangleScene, params: &AirborneParams) -> Result<(PointCloud, Vec<[f32; 3]>)> {
    surveyed(&scan_airborne(scene, params))
}

/// The cloud of a scan, and the position of the scanner at each of its points, (N, 3) local metres.
///
/// # Errors
///
/// If the path of the scanner does not cover the times of the points.
pub fn surveyed(scan: &Scan) -> Result<(PointCloud, Vec<[f32; 3]>)> {
    let coordinates = || (0..scan.len()).map(|i| [scan.x[i], scan.y[i], scan.z[i]]);
    let origin = centre_rounded(coordinates());
    let cloud = PointCloud {
        frame: Frame { origin, ..Frame::default() },
        positions: coordinates().map(|c| to_local(c, origin)).collect(),
        attributes: Attributes {
            classification: Some(scan.classification.clone()),
            gps_time: Some(scan.gps_time.clone()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: Some(scan.return_number.clone()),
            return_count: Some(scan.return_count.clone()),
            point_source_id: Some(scan.point_source_id.clone()),
            ..Attributes::default()
        },
        ..PointCloud::default()
    };
    let path = scan.sensor_path.times.iter().copied().zip(scan.sensor_path.positions.iter().copied());
    let (scanner, _) = Trajectory::from_records(path.collect()).0.scanner_positions(&cloud)?;
    Ok((cloud, scanner))
}

/// Canals run north: how far it is from one to the next and how wide each is, metres.
const CANALS_EACH: f32 = 36.0;
const CANAL_WIDTH: f32 = 12.0;

/// What a survey would be if the ground were water in canals: pulses that end there do not return.
pub fn without_returns_from_water(cloud: &PointCloud, scanner: &[[f32; 3]]) -> (PointCloud, Vec<[f32; 3]>) {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let is_water =
        |row: usize| classes.get(row) == Some(&2) && cloud.positions[row][0].rem_euclid(CANALS_EACH) < CANAL_WIDTH;
    let (rows, scanner): (Vec<u32>, Vec<_>) = (0..).zip(scanner).filter(|(row, _)| !is_water(*row as usize)).unzip();
    (cloud.select(&rows), scanner)
}
