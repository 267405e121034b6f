//! Where cameras stand: from flags and files to poses.

use super::what::Site;
use crate::arguments::{CameraLens, Cameras, Usage};
use crate::commands::sights::{ground, skip_unfit};
use crate::run::Run;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::cameras::{
    CAMERA_HEIGHT, Lens, Motion, Mount, MountingParams, Pose, ROOF_CAMERA_HEIGHT, ground_places, roof_places,
};
use belvedere::apps::eyes::skip_unfit_eyes;
use belvedere::apps::targets::set_on_ground;
use belvedere::apps::viewshed::places_along;
use belvedere::ground::GroundPoints;
use belvedere::io::{ObserverRow, RowsAre, read_observers};
use belvedere::query::MedialScene;
use std::path::Path;

/// Metres between the candidates on a line of GeoJSON.
const STEP: f64 = 5.0;

/// What is needed to put cameras up.
pub(super) struct Standing<'a> {
    pub(super) site: &'a Site<'a>,
    pub(super) blockers: &'a MedialScene,
    pub(super) mounting: &'a MountingParams,
    /// Azimuth of grid north, radians.
    pub(super) north: f64,
}

/// The lens of the flags.
pub(super) fn lens(flags: &CameraLens) -> Result<Lens> {
    let mut lens = Lens::default().with_height(flags.vertical_fov.map(f64::to_radians));
    if let Some(fov) = flags.fov {
        lens = lens.with_width(fov.to_radians());
    }
    if let Some(pixels) = flags.pixels {
        lens = lens.with_pixels(pixels as f64);
    }
    lens.validate()?;
    Ok(lens)
}

/// How cameras are put up, as the flags say.
pub(super) fn mounting(flags: &CameraLens, lens: Lens) -> MountingParams {
    let usual = MountingParams::default();
    let tilts =
        if flags.tilt.is_empty() { usual.tilts.clone() } else { flags.tilt.iter().map(|t| t.to_radians()).collect() };
    let distance =
        [flags.min_distance.map_or(usual.distance[0], f64::from), flags.max_distance.unwrap_or(usual.distance[1])];
    let headings = flags.headings.unwrap_or(usual.headings);
    usual
        .with_lens(lens)
        .with_motion(if flags.turning { Motion::Turning } else { Motion::Fixed })
        .with_headings(headings)
        .with_tilts(tilts)
        .with_distance(distance)
}

impl Standing<'_> {
    /// The cameras to choose from.
    pub(super) fn candidates(
        &self,
        arguments: &Cameras,
        ground_points: GroundPoints,
        run: &mut Run,
    ) -> Result<Vec<Pose>> {
        let mut mounts = match (&arguments.candidates.file, arguments.candidates.on_roofs) {
            (Some(path), _) => self.of_file(path, arguments.step.unwrap_or(STEP), arguments.camera_height)?,
            (None, roofs) => {
                let cell = roofs.or(arguments.candidates.on_ground).unwrap_or(STEP);
                let grid = super::map_grid(self.site.scene, cell)
                    .map_err(|error| Usage(format!("--on-ground, --on-roofs: {error}")))?;
                let cloud = self.site.cloud;
                let ground = run.aside(|run| ground(cloud, ground_points, grid, run)).0?;
                let height = arguments.camera_height;
                let places = run.stage("finding places for cameras", 0, |control| match roofs {
                    Some(_) => roof_places(cloud, ground, height.unwrap_or(ROOF_CAMERA_HEIGHT), control),
                    None => ground_places(cloud, ground, height.unwrap_or(CAMERA_HEIGHT), control),
                })?;
                places.into_iter().map(|eye| Mount { eye, ..Mount::default() }).collect()
            }
        };
        let warn = if arguments.candidates.file.is_some() { Warn::OfEach } else { Warn::Never };
        self.skip_unfit(&mut mounts, ("candidate", warn), run)?;
        let mut poses = Vec::new();
        for mount in mounts.iter().filter(|mount| mount.eye[0].is_finite()) {
            poses.extend(self.mounting.poses_at(mount)?);
        }
        Ok(poses)
    }

    /// The cameras that stay.
    pub(super) fn existing(&self, path: &Path, height: Option<f64>, run: &mut Run) -> Result<Vec<Pose>> {
        let mut mounts = self.of_file(path, f64::INFINITY, height)?;
        self.skip_unfit(&mut mounts, ("existing camera", Warn::OfEach), run)?;
        // one that cannot look keeps its number
        let at_fault = |error| Usage(format!("{}: {error}", path.display())).into();
        let pose = |mount: &Mount| self.mounting.existing_at(mount).map_err(at_fault);
        mounts.iter().map(pose).collect()
    }

    /// The places of a file, those on lines `step` metres apart.
    fn of_file(&self, path: &Path, step: f64, height: Option<f64>) -> Result<Vec<Mount>> {
        let frame = &self.site.cloud.frame;
        let (mut mounts, mut heights): (Vec<Mount>, Vec<f64>) = (Vec::new(), Vec::new());
        for row in read_observers(path, &frame.crs, RowsAre::Places)? {
            let corners: Vec<[f64; 3]> =
                row.corners.iter().map(|c| std::array::from_fn(|i| c[i] - frame.origin[i])).collect();
            let places = places_along(&corners, step)?;
            heights.extend(places.iter().map(|_| row.height.or(height).unwrap_or(CAMERA_HEIGHT)));
            mounts.extend(places.into_iter().map(|eye| self.mount(eye, &row)));
        }
        set_on_ground(mounts.iter_mut().map(|mount| &mut mount.eye).zip(heights), self.site.ground);
        Ok(mounts)
    }

    fn mount(&self, eye: [f64; 3], row: &ObserverRow) -> Mount {
        let in_grid = |azimuth: f64| azimuth.to_radians() - self.north;
        let pair = |[from, to]: [Option<f64>; 2]| Some([from?, to?]);
        Mount {
            eye,
            heading: row.heading_deg.map(in_grid),
            tilt: row.tilt_deg.map(f64::to_radians),
            width: row.fov_deg.map(f64::to_radians),
            distance: row.distance,
            azimuth: pair(row.azimuth_deg).map(|range| range.map(in_grid)),
            elevation: pair(row.elevation_deg).map(|range| range.map(f64::to_radians)),
        }
    }

    /// Makes the eyes of cameras that cannot look NaN.
    fn skip_unfit(&self, mounts: &mut [Mount], (who, warn): (&str, Warn), run: &mut Run) -> Result<()> {
        let mut eyes: Vec<[f64; 3]> = mounts.iter().map(|mount| mount.eye).collect();
        let ground = Some(self.site.ground);
        let report = match warn {
            Warn::OfEach => {
                let named = (who, &self.site.cloud.frame);
                skip_unfit(self.blockers, ground, named, &mut eyes, run)?
            }
            Warn::Never => run
                .stage("testing candidates", 0, |control| skip_unfit_eyes(self.blockers, ground, &mut eyes, control))?,
        };
        run.summary.add(&format!("{}_places", who.replace(' ', "_")), Summary::of(&report));
        mounts.iter_mut().zip(eyes).for_each(|(mount, eye)| mount.eye = eye);
        Ok(())
    }
}

/// Whether places that are skipped are warned of: those of a grid are nobody's choice.
#[derive(Clone, Copy)]
enum Warn {
    OfEach,
    Never,
}
