//! Candidate cameras and their targets.

use super::camera::{Camera, Lens};
use crate::roof_planes::BUILDING;
use crate::targets::{CellLevel, CellParams, Targets};
use crate::viewshed::SightLimits;
use belvedere_core::ground::{Ground, highest_points};
use belvedere_data::control::Control;
use belvedere_data::polygon::is_inside;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use std::f64::consts::TAU;

/// Height of cameras above the ground, metres: out of reach, as on a lamp post.
pub const CAMERA_HEIGHT: f64 = 4.0;
/// Height of cameras above roofs, metres.
pub const ROOF_CAMERA_HEIGHT: f64 = 1.0;
/// Height of targets of cameras above the ground, metres: the head of a person.
pub const CAMERA_TARGET_HEIGHT: f64 = 1.5;
/// Minimum height of a roof above the ground, metres: lower ones are cars and hedges.
const MIN_ROOF: f64 = 2.0;

/// Motion of cameras: fixed or turning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// They keep looking to one side. Default.
    #[default]
    Fixed,
    /// They are turned and tilted to whatever there is.
    Turning,
}

/// Default mounting of cameras.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MountingParams {
    /// Lens and pixels.
    pub lens: Lens,
    /// Motion: fixed or turning.
    pub motion: Motion,
    /// Headings to choose from at each place, evenly spread from north on, 1 or more. Default 8. One is enough for
    /// cameras that see or turn all around.
    pub headings: usize,
    /// Angles below the horizon to choose from, radians, −π/2 to π/2. Default: 15 degrees.
    pub tilts: Vec<f64>,
    /// Horizontal distances that they are good for, metres. Default: 0 to infinity.
    pub distance: [f64; 2],
}

belvedere_data::setters!(MountingParams {
    with_lens(lens: Lens),
    with_motion(motion: Motion),
    with_headings(headings: usize),
    with_tilts(tilts: Vec<f64>),
    with_distance(distance: [f64; 2]),
});

impl Default for MountingParams {
    fn default() -> Self {
        Self {
            lens: Lens::default(),
            motion: Motion::Fixed,
            headings: 8,
            tilts: vec![15_f64.to_radians()],
            distance: SightLimits::default().distance,
        }
    }
}

/// A place for cameras, with the settings given for it; the others are as in [`MountingParams`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mount {
    /// Position of the eye, local metres.
    pub eye: [f64; 3],
    /// The only heading, radians clockwise from grid north.
    pub heading: Option<f64>,
    /// The only angle below the horizon, radians.
    pub tilt: Option<f64>,
    /// Horizontal field of view, radians.
    pub width: Option<f64>,
    /// Minimum and maximum distance, metres.
    pub distance: [Option<f64>; 2],
    /// Azimuths that a camera can be turned to, radians clockwise from grid north, and its elevations.
    pub azimuth: Option<[f64; 2]>,
    /// Elevations that a camera can be tilted to, radians.
    pub elevation: Option<[f64; 2]>,
}

/// A camera with its heading and tilt, for reports; NaN for one that turns or sees all around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// The camera.
    pub camera: Camera,
    /// Azimuth that it looks to, radians clockwise from grid north.
    pub heading: f64,
    /// Angle below the horizon that it looks to, radians.
    pub tilt: f64,
    /// Horizontal field of view, radians.
    pub width: f64,
}

impl MountingParams {
    /// The cameras to choose from at a place.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for angles, pixels and distances outside their range.
    pub fn poses_at(&self, mount: &Mount) -> Result<Vec<CameraPose>> {
        let lens = Lens { width: mount.width.unwrap_or(self.lens.width), ..self.lens };
        lens.validate()?;
        let distance = [0, 1].map(|i| mount.distance[i].unwrap_or(self.distance[i]));
        let limits = SightLimits { azimuth: mount.azimuth, elevation: mount.elevation, distance };
        limits.validate()?;
        if self.motion == Motion::Turning {
            let camera = Camera::turning(mount.eye, &lens, limits);
            return Ok(vec![CameraPose { camera, heading: f64::NAN, tilt: f64::NAN, width: lens.width }]);
        }
        if self.headings == 0 || self.headings > 360 {
            return Err(Error::invalid(Parameter::Headings, self.headings, "1 to 360"));
        }
        let sees_all_around = lens.width >= TAU - 1e-9;
        let headings: Vec<f64> = match mount.heading {
            Some(heading) => vec![heading],
            None if sees_all_around => vec![0.0],
            None => (0..self.headings).map(|i| TAU * i as f64 / self.headings as f64).collect(),
        };
        let tilts = mount.tilt.map_or_else(|| self.tilts.clone(), |tilt| vec![tilt]);
        let mut poses = Vec::with_capacity(headings.len() * tilts.len());
        for (&heading, &tilt) in headings.iter().flat_map(|heading| tilts.iter().map(move |tilt| (heading, tilt))) {
            if !(tilt.abs() <= TAU / 4.0 + 1e-9 && heading.is_finite()) {
                let value = format!("{} and {}", heading.to_degrees(), tilt.to_degrees());
                let expected = "a finite heading, and a tilt from -90 to 90";
                return Err(Error::invalid(Parameter::HeadingAndTilt, value, expected));
            }
            let camera = Camera::fixed(mount.eye, heading, tilt, &lens, distance);
            let heading = if sees_all_around { f64::NAN } else { heading };
            poses.push(CameraPose { camera, heading, tilt, width: lens.width });
        }
        Ok(poses)
    }

    /// The camera that stands at a place.
    ///
    /// # Errors
    /// Those of [`MountingParams::poses_at`], and [`Error::InvalidParameter`] for a place that leaves open where its
    /// camera looks.
    pub fn existing_at(&self, mount: &Mount) -> Result<CameraPose> {
        match self.poses_at(mount)?[..] {
            [pose] => Ok(pose),
            _ => Err(Error::invalid(
                Parameter::ExistingCamera,
                "without heading or tilt",
                "one heading and one tilt for each camera: give the columns heading and tilt",
            )),
        }
    }
}

/// Places for cameras `height` metres above the ground, in the middle of the cells of `ground`, local metres. There are
/// none below roofs.
///
/// # Errors
/// Those of [`Targets::of_cells`].
pub fn ground_places(cloud: &PointCloud, ground: Ground, height: f64, control: &Control<'_>) -> Result<Vec<[f64; 3]>> {
    let (targets, _) = Targets::of_cells(cloud, ground, &CellParams::default().with_height(height), control)?;
    Ok((0..targets.len())
        .filter(|&row| targets.is_target(row))
        .map(|row| targets.positions[row].map(f64::from))
        .collect())
}

/// Places for cameras `height` metres above roofs, in the middle of the cells of `ground`, local metres: where
/// something is at least 2 m high. In a cloud that knows buildings (class 6), the highest point of the cell must be
/// one.
///
/// # Errors
/// Those of [`Targets::of_cells`].
pub fn roof_places(cloud: &PointCloud, ground: Ground, height: f64, control: &Control<'_>) -> Result<Vec<[f64; 3]>> {
    let highest = highest_points(&cloud.positions, &ground);
    let classes = cloud.attributes.classification.as_deref().filter(|classes| classes.contains(&BUILDING));
    let of_buildings = classes.map(|classes| {
        let points = cloud.positions.iter().zip(classes).filter(|(_, class)| **class == BUILDING);
        highest_points(&points.map(|(point, _)| *point).collect::<Vec<_>>(), &ground)
    });
    let levels = ground.heights.clone();
    let params = CellParams::default().with_level(CellLevel::Surface).with_height(height);
    let (targets, _) = Targets::of_cells(cloud, ground, &params, control)?;
    let is_roof = |row: usize| {
        let place = targets.positions[row];
        let is_high = f64::from(place[2] - levels.values()[row]) - height >= MIN_ROOF;
        is_high && of_buildings.as_ref().is_none_or(|tops| tops.values()[row] >= highest.values()[row])
    };
    let rows = (0..targets.len()).filter(|&row| targets.is_target(row) && is_roof(row));
    Ok(rows.map(|row| targets.positions[row].map(f64::from)).collect())
}

/// A polygon on the map, and how much targets in it count.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightedArea {
    /// Its outline and holes, local metres.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// Weight of each target in it, 0 or more.
    pub weight: f64,
}

/// Leaves out targets outside all `areas`, and gives the others the greatest weight of the areas that they lie in.
pub fn keep_within(targets: &mut Targets, areas: &[WeightedArea]) {
    targets.weights = vec![0.0; targets.len()];
    for (position, weight) in targets.positions.iter_mut().zip(&mut targets.weights) {
        let place = [position[0], position[1]].map(f64::from);
        let found = areas.iter().filter(|area| is_inside(&area.rings, place)).map(|area| area.weight);
        match found.reduce(f64::max) {
            Some(max) => *weight = max,
            None => *position = [f32::NAN; 3],
        }
    }
}

/// Returns the weight of each target for [`super::place_cameras`]; 0 for one without a position.
#[must_use]
pub fn counted_weights(targets: &Targets) -> Vec<f64> {
    (0..targets.len()).map(|row| if targets.is_target(row) { targets.weight(row) } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_place_has_the_cameras_that_are_not_ruled_out() {
        let usual = MountingParams::default().with_tilts(vec![0.1, 0.4]);
        let poses = usual.poses_at(&Mount::default()).unwrap();
        assert_eq!(poses.len(), 16);
        assert!((poses[15].heading - 7.0 * TAU / 8.0).abs() < 1e-12 && poses[15].tilt == 0.4);
        let existing = Mount { heading: Some(1.0), tilt: Some(0.2), width: Some(PI), ..Mount::default() };
        let one = usual.existing_at(&existing).unwrap();
        assert_eq!((one.heading, one.tilt, one.camera.picture), (1.0, 0.2, None));
        assert!(usual.existing_at(&Mount { heading: Some(1.0), ..Mount::default() }).is_err());
        // all around, headings are no choice
        let around = Mount { width: Some(TAU), tilt: Some(0.0), ..Mount::default() };
        assert!(usual.existing_at(&around).unwrap().heading.is_nan());
        let turning = usual.clone().with_motion(Motion::Turning).with_distance([2.0, 9.0]);
        let poses = turning.poses_at(&Mount { distance: [None, Some(30.0)], ..Mount::default() }).unwrap();
        assert_eq!((poses.len(), poses[0].camera.limits.distance), (1, [2.0, 30.0]));
    }

    #[test]
    fn poses_that_no_camera_has_are_refused() {
        let usual = MountingParams::default();
        let at = |mount: Mount| usual.poses_at(&mount);
        assert!(at(Mount { tilt: Some(2.0), ..Mount::default() }).is_err());
        assert!(at(Mount { heading: Some(f64::NAN), ..Mount::default() }).is_err());
        assert!(at(Mount { distance: [Some(9.0), Some(3.0)], ..Mount::default() }).is_err());
        assert!(usual.clone().with_headings(0).poses_at(&Mount::default()).is_err());
    }
}
