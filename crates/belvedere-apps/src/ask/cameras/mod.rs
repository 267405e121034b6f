//! Cameras: which of many possible ones to put up, with a proven bound on the best choice.

mod candidates;
mod lens;
mod site;
mod targets;

pub use candidates::{Candidates, GivenCamera};
pub use lens::CameraLens;
pub(super) use site::CameraSite;
pub use targets::{CameraTargets, PrivatePlaces};

use super::answers::{Answered, Answers, Ask};
use super::cells::GridCells;
use super::context::Context;
use super::how_sure::remark_from_ground;
use super::north::North;
use super::observers::skip_unfit;
use super::places::Places;
use super::scene::Scene;
use super::sections::{CamerasReport, ChoiceSection, LinesSection};
use super::standing::Reach;
use crate::cameras::{
    CAMERA_HEIGHT, CameraPose, CoverageParams, CoverageReport, CoverageTable, FREE_FRESNEL_SHARE, FresnelZone, Goal,
    Mount, Placement, PlacementParams, ROOF_CAMERA_HEIGHT, counted_weights, coverage, leave_out_private, place_cameras,
};
use crate::landmark::observer_cell_for;
use crate::radio_link::RadioWave;
use crate::targets::Targets;
use belvedere_core::query::{Certainty, EarthParams, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use candidates::given_eyes;
use serde::{Deserialize, Serialize};

/// Selection of cameras from many possible ones that covers much of some places.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct CamerasQuestion {
    /// Goal of the selection.
    pub goal: CameraGoal,
    /// Cameras that each target needs, 1 or more; one with fewer counts in proportion. Default 1.
    pub per_target: u32,
    /// Maximum number of branches of the search for the proven optimum, 0 for no search; `None` for about half a
    /// minute.
    pub search_limit: Option<usize>,
    /// Possible positions.
    pub candidates: Candidates,
    /// Cameras that stay.
    #[serde(skip)]
    pub existing: Vec<GivenCamera>,
    /// Height of cameras above the ground or the roof, metres; `None` for 4 above the ground and 1 above roofs.
    pub camera_height: Option<f64>,
    /// Lenses and motion.
    pub lens: CameraLens,
    /// Targets to cover, and places that must stay private.
    pub targets: CameraTargets,
    /// North of azimuths.
    pub north: North,
    /// Curvature of the earth on lines of sight.
    #[serde(skip)]
    pub earth: EarthParams,
    /// Frequency of radio links, GHz, 0.001 to 1000: a target is only covered if the first Fresnel zone is free too.
    /// `None` for no links.
    pub frequency_ghz: Option<f64>,
    /// Share of the radius of that zone that must be free, percent, above 0 to 100; `None` for 60.
    pub fresnel_percent: Option<f64>,
    /// Treatment of unproven targets that nothing blocks: they are covered only if they count as visible. A given value
    /// needs pulses.
    pub unproven: Option<UnprovenAs>,
    /// Minimum probability, above 0.5 and at most 1, with which a target must be visible to be covered; `None`, the
    /// default, where the answer alone counts. A value needs pulses.
    pub certain: Option<f64>,
}

/// Goal of a selection of cameras.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CameraGoal {
    /// To cover as much as possible with so many new ones.
    Count(usize),
    /// To cover so many percent of the targets, above 0 to 100, with as few new ones as possible.
    CoveragePercent(f64),
}

impl Default for CamerasQuestion {
    fn default() -> Self {
        Self {
            goal: CameraGoal::Count(1),
            per_target: 1,
            search_limit: None,
            candidates: Candidates::default(),
            existing: Vec::new(),
            camera_height: None,
            lens: CameraLens::default(),
            targets: CameraTargets::default(),
            north: North::True,
            earth: EarthParams::default(),
            frequency_ghz: None,
            fresnel_percent: None,
            unproven: None,
            certain: None,
        }
    }
}

/// A camera that stays or is to be put up.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenCamera {
    /// Position and direction.
    pub pose: CameraPose,
    /// True if it is to be installed.
    pub is_new: bool,
    /// Coverage that it adds, percent; NaN for one that stays.
    pub added_percent: f64,
    /// Rows of the targets that it covers.
    pub covered: Vec<usize>,
}

/// The cameras that were chosen.
pub struct CamerasResults {
    /// Existing cameras, then the new ones, by the coverage that they add, descending.
    pub cameras: Vec<ChosenCamera>,
    /// Proven properties of the selection.
    pub placed: Placement,
    /// Targets to cover.
    pub targets: Targets,
    /// Number of cameras that could be chosen.
    pub candidates: usize,
    /// Azimuth of grid north from the north that azimuths count from, radians.
    pub grid_north: f64,
}

impl CamerasResults {
    /// Returns the number of cameras that cover a target; `None` for one that does not count.
    #[must_use]
    pub fn count(&self, row: usize) -> Option<u32> {
        let counts = self.targets.is_target(row) && self.targets.weight(row) > 0.0;
        self.placed.counts.get(row).copied().filter(|_| counts)
    }

    fn new(
        poses: &[CameraPose],
        existing: usize,
        table: &CoverageTable,
        placed: Placement,
        targets: Targets,
        grid_north: f64,
    ) -> Self {
        let covered = |row: usize| table.covered_by(row).filter(|&target| targets.weight(target) > 0.0).collect();
        let stays = (0..existing).map(|row| (row, false, f64::NAN));
        let gains = placed.curve.windows(2).map(|pair| 100.0 * (pair[1] - pair[0]));
        let new = placed.chosen.iter().zip(gains).map(|(&row, added)| (row, true, added));
        let chosen = |(row, is_new, added_percent): (usize, bool, f64)| {
            let pose = *poses.get(row)?;
            Some(ChosenCamera { pose, is_new, added_percent, covered: covered(row) })
        };
        let cameras = stays.chain(new).filter_map(chosen).collect();
        Self { cameras, placed, targets, candidates: poses.len() - existing, grid_north }
    }
}

impl CamerasQuestion {
    fn coverage_params(&self) -> Result<CoverageParams> {
        let share = self.fresnel_percent.map_or(FREE_FRESNEL_SHARE, |percent| percent / 100.0);
        let zone =
            self.frequency_ghz.map(|ghz| RadioWave::of_frequency(ghz).and_then(|wave| FresnelZone::new(wave, share)));
        Ok(CoverageParams::default()
            .with_density(self.lens.lens()?.required_density(self.lens.density)?)
            .with_earth(self.earth)
            .with_unproven(self.unproven.unwrap_or(UnprovenAs::Reported))
            .with_certainty(self.certain.map(Certainty::new).transpose()?)
            .with_zone(zone.transpose()?))
    }

    fn placement_params(&self, existing: usize) -> PlacementParams {
        let goal = match self.goal {
            CameraGoal::Count(count) => Goal::Count(count),
            CameraGoal::CoveragePercent(percent) => Goal::Coverage(percent / 100.0),
        };
        PlacementParams::new(goal)
            .with_existing((0..existing).collect())
            .with_required(self.per_target)
            .with_search_limit(self.search_limit)
    }

    /// The cells that are targets, or on which the ground below others is known.
    fn cells(&self, scene: &Scene, places: &Places) -> GridCells {
        let (low, high) = scene.model().bounds().on_map();
        let given = match places {
            Places::Cells(cells) => cells.clone(),
            _ => GridCells::default(),
        };
        let cell = given.cell.unwrap_or_else(|| observer_cell_for(low, high));
        GridCells { cell: Some(cell), height: Some(self.targets.height), ground: self.targets.ground, ..given }
    }

    /// The cameras that stay; one that cannot look is NaN, so that others keep their numbers.
    fn existing_poses(
        &self,
        site: &CameraSite<'_>,
        report: &mut CamerasReport,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<CameraPose>> {
        if self.existing.is_empty() {
            return Ok(Vec::new());
        }
        let eyes = given_eyes(&self.existing, self.camera_height.unwrap_or(CAMERA_HEIGHT), site.ground);
        let (reach, looking) = (Reach::Cloud, (site.blockers, Some(site.ground)));
        let eyes = skip_unfit(eyes, ("existing camera", reach), looking, (site.scene, context), control)?;
        report.existing_camera_places = Some(eyes.report);
        let mounting = self.lens.mounting()?;
        let pose = |(given, eye): (&GivenCamera, [f64; 3])| mounting.existing_at(&given.mount(eye, site.grid_north));
        self.existing.iter().zip(eyes.eyes).map(pose).collect()
    }

    /// The cameras to choose from.
    fn candidate_poses(
        &self,
        site: &CameraSite<'_>,
        report: &mut CamerasReport,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<CameraPose>> {
        let usual = if matches!(self.candidates, Candidates::Roofs(_)) { ROOF_CAMERA_HEIGHT } else { CAMERA_HEIGHT };
        let height = self.camera_height.unwrap_or(usual);
        let (eyes, fitting) = self.candidates.eyes((height, self.targets.ground), site, context, control)?;
        report.candidate_places = fitting;
        let mounts: Vec<Mount> = match &self.candidates {
            Candidates::Given(given) => {
                given.iter().zip(eyes).map(|(given, eye)| given.mount(eye, site.grid_north)).collect()
            }
            _ => eyes.into_iter().map(|eye| Mount { eye, ..Mount::default() }).collect(),
        };
        let mounting = self.lens.mounting()?;
        let mut poses = Vec::new();
        for mount in mounts.iter().filter(|mount| mount.eye[0].is_finite()) {
            poses.extend(mounting.poses_at(mount)?);
        }
        Ok(poses)
    }

    /// The cameras that stay, then those to choose from, which must not see private places.
    fn poses(
        &self,
        private: Option<&Targets>,
        site: &CameraSite<'_>,
        report: &mut CamerasReport,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<(Vec<CameraPose>, Vec<CameraPose>)> {
        let existing = self.existing_poses(site, report, context, control)?;
        let mut candidates = self.candidate_poses(site, report, context, control)?;
        let count = candidates.len();
        if let Some(private) = private {
            control.stage("testing private places", count, || {
                leave_out_private(site.blockers, &mut candidates, private, &self.earth, control)
            })?;
        }
        report.cameras_to_choose_from =
            ChoiceSection { count, see_private_places: count - candidates.len(), existing: existing.len() };
        if count == 0 {
            let what = "all lie inside obstacles, below the ground or outside the cloud".to_owned();
            return Err(Error::NoObserver { who: "place for a camera", what });
        }
        if candidates.is_empty() {
            let what =
                format!("all {count} have a private place in their picture; give other candidates, or more headings");
            return Err(Error::NoObserver { who: "camera", what });
        }
        Ok((existing, candidates))
    }
}

impl Ask for CamerasQuestion {
    type Found = CamerasResults;

    fn check(&self) -> Result<()> {
        self.earth.validate()?;
        self.coverage_params()?;
        if self.per_target == 0 {
            return Err(Error::invalid(Parameter::RequiredCameras, "0", "1 or more"));
        }
        self.lens.mounting()?.poses_at(&Mount::default())?;
        if let CameraGoal::CoveragePercent(percent) = self.goal
            && !(percent > 0.0 && percent <= 100.0)
        {
            return Err(Error::invalid(Parameter::Coverage, format!("{percent} %"), "above 0 to 100 %"));
        }
        self.targets.check()
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        if self.unproven.is_some() {
            scene.check_proof()?;
        }
        if self.certain.is_some() {
            scene.check_pulses(Parameter::Certainty)?;
        }
        let params = self.coverage_params()?;
        let north = self.north.of_scene(scene);
        context.north(&north);
        let cells = self.cells(scene, places);
        let known = scene.ground(cells.grid(scene)?, cells.ground, control)?;
        let blockers = scene.blockers(params.unproven, control)?;
        context.add(self.certain.and_then(|_| remark_from_ground(&blockers)));
        let site = CameraSite { scene, blockers: &blockers, ground: &known.ground, grid_north: north.of_grid };
        let targets = self.targets.of((places, &cells), &site, context, control)?;
        let private = self.targets.private_of(&cells, &site, control)?;
        let mut report = CamerasReport {
            targets: targets.target_count(),
            private_places: private.as_ref().map(Targets::target_count),
            ..CamerasReport::default()
        };
        context.ground(scene.frame(), &known);
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let (existing, candidates) = self.poses(private.as_ref(), &site, &mut report, context, control)?;
        let poses: Vec<CameraPose> = existing.iter().chain(&candidates).copied().collect();
        let cameras: Vec<_> = poses.iter().map(|pose| pose.camera).collect();
        let (table, lines): (CoverageTable, CoverageReport) =
            control.stage("testing lines of sight", cameras.len(), || {
                coverage(&blockers, &cameras, &targets, &params, control)
            })?;
        report.pictures.fill(params.density, lines, table.pair_count());
        let weights = counted_weights(&targets);
        let placed = control.stage("choosing cameras", 0, || {
            place_cameras(&table, &weights, &self.placement_params(existing.len()), control)
        })?;
        report.coverage.fill(&placed, &weights, self.per_target);
        report
            .coverage
            .headlines(existing.len(), &weights, self.certain)
            .into_iter()
            .for_each(|line| context.headline(line));
        context.report.cameras = Some(report);
        let found = CamerasResults::new(&poses, existing.len(), &table, placed, targets, north.of_grid);
        Ok(Answers::new(found, Vec::new()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_that_cannot_be_are_refused_before_a_scene_is_needed() {
        let usual = CamerasQuestion::default;
        let lens = |lens: CameraLens| CamerasQuestion { lens, ..usual() };
        assert!(usual().check().is_ok());
        for wrong in [
            CamerasQuestion { goal: CameraGoal::CoveragePercent(0.0), ..usual() },
            CamerasQuestion { goal: CameraGoal::CoveragePercent(120.0), ..usual() },
            CamerasQuestion { per_target: 0, ..usual() },
            CamerasQuestion { certain: Some(0.5), ..usual() },
            CamerasQuestion { frequency_ghz: Some(2400.0), ..usual() },
            CamerasQuestion { frequency_ghz: Some(2.4), fresnel_percent: Some(101.0), ..usual() },
            lens(CameraLens { fov_deg: Some(400.0), ..CameraLens::default() }),
            lens(CameraLens { fov_deg: Some(360.0), density: Some(25.0), ..CameraLens::default() }),
            lens(CameraLens { headings: Some(0), ..CameraLens::default() }),
            lens(CameraLens { tilts_deg: vec![15.0, 95.0], ..CameraLens::default() }),
            lens(CameraLens { min_distance: Some(9.0), max_distance: Some(3.0), ..CameraLens::default() }),
            CamerasQuestion {
                targets: CameraTargets { weights: vec![1.0, -1.0], ..CameraTargets::default() },
                ..usual()
            },
        ] {
            assert!(matches!(wrong.check(), Err(Error::InvalidParameter { .. })), "{wrong:?}");
        }
    }
}
