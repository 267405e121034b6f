//! Coverage of cameras: lines of sight for the targets in their pictures.

use super::camera::Camera;
use super::candidates::CameraPose;
use super::table::{CoverageTable, check_size};
use crate::radio_link::RadioWave;
use crate::targets::Targets;
use crate::viewshed::{Observer, SightLimits, ViewshedParams, viewshed};
use belvedere_core::query::{Answer, Certainty, EarthParams, MedialScene, UnprovenAs, Viewer};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::Serialize;

/// Criteria for covering a target that is in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CoverageParams {
    /// Minimum pixels per metre, 0 or more. Default 0.
    pub density: f64,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Treatment of unproven lines of sight: they cover if they count as visible. Default: reported, which covers
    /// nothing.
    pub unproven: UnprovenAs,
    /// Minimum certainty that a target is visible. Default: the answer alone counts.
    pub certainty: Option<Certainty>,
    /// The Fresnel zone that must be free too. Default: none.
    pub zone: Option<FresnelZone>,
}

/// Required free part of the first Fresnel zone of a radio link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FresnelZone {
    /// The wave of the link.
    wave: RadioWave,
    /// Share of the radius of the zone, above 0 to 1.
    share: f64,
}

impl FresnelZone {
    /// The zone of a link with this wave, of which `share` of the radius must be free: above 0 to 1, usually
    /// [`FREE_FRESNEL_SHARE`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for another share.
    pub fn new(wave: RadioWave, share: f64) -> Result<Self> {
        if !(share > 0.0 && share <= 1.0) {
            return Err(Error::invalid(Parameter::FresnelShare, format!("{} %", 100.0 * share), "above 0 to 100 %"));
        }
        Ok(Self { wave, share })
    }
}

/// Share of the radius of the first Fresnel zone that usually must be free.
///
/// # Source
/// ITU-R P.530-18, section 2.2.
pub const FREE_FRESNEL_SHARE: f64 = 0.6;

belvedere_data::setters!(CoverageParams {
    with_density(density: f64),
    with_earth(earth: EarthParams),
    with_unproven(unproven: UnprovenAs),
    with_certainty(certainty: Option<Certainty>),
    with_zone(zone: Option<FresnelZone>),
});

impl Default for CoverageParams {
    fn default() -> Self {
        Self {
            density: 0.0,
            earth: EarthParams::default(),
            unproven: UnprovenAs::Reported,
            certainty: None,
            zone: None,
        }
    }
}

/// Lines of sight between places of cameras and targets in the picture of one of their cameras.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CoverageReport {
    /// All of them.
    pub lines_of_sight: usize,
    /// Number of lines that nothing blocks.
    pub visible: usize,
    /// Number of unproven lines that nothing blocks.
    pub unproven: usize,
    /// Number of visible lines below the wanted certainty; `None` if none is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncertain: Option<usize>,
    /// Number of visible lines whose Fresnel zone is not free; `None` if no Fresnel zone is tested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fresnel_zone_blocked: Option<usize>,
}

/// Computes which of `cameras` cover which of `targets`; control counts cameras. Cameras at one place should follow
/// each other: their lines of sight are tested once.
///
/// # Errors
/// Those of [`viewshed`], and [`belvedere_data::Error::InvalidParameter`] for a table of more than 8 GiB and where
/// certainty is wanted without pulses.
pub fn coverage(
    scene: &MedialScene,
    cameras: &[Camera],
    targets: &Targets,
    params: &CoverageParams,
    control: &Control<'_>,
) -> Result<(CoverageTable, CoverageReport)> {
    check_size(cameras.len(), targets.len())?;
    let query = TargetQuery { scene, targets, eastward: eastward(targets), params };
    let groups: Vec<&[Camera]> = cameras.chunk_by(|a, b| a.eye == b.eye).collect();
    let rows: Vec<(Vec<u64>, CoverageReport)> =
        groups.par_iter().map(|group| query.rows(group, control)).collect::<Result<_>>()?;
    let mut report = CoverageReport {
        uncertain: params.certainty.map(|_| 0),
        fresnel_zone_blocked: params.zone.map(|_| 0),
        ..CoverageReport::default()
    };
    for (_, of_group) in &rows {
        let optional = [
            (&mut report.fresnel_zone_blocked, of_group.fresnel_zone_blocked),
            (&mut report.uncertain, of_group.uncertain),
        ];
        for (all, of_group) in optional {
            *all = all.map(|all| all + of_group.unwrap_or(0));
        }
        report.lines_of_sight += of_group.lines_of_sight;
        report.visible += of_group.visible;
        report.unproven += of_group.unproven;
    }
    let bits = rows.into_iter().flat_map(|(bits, _)| bits).collect();
    Ok((CoverageTable::of_bits(targets.len(), bits), report))
}

/// Flags the `cameras` that have any of the `private` places in their picture, at any distance and density. A place
/// that cannot be proven hidden counts as seen. Control counts cameras.
///
/// # Errors
/// Those of [`coverage`].
pub fn sees_private(
    scene: &MedialScene,
    cameras: &[Camera],
    private: &Targets,
    earth: &EarthParams,
    control: &Control<'_>,
) -> Result<Vec<bool>> {
    let without_limits = |camera: &Camera| Camera {
        limits: SightLimits { distance: SightLimits::default().distance, ..camera.limits },
        ..*camera
    };
    let cameras: Vec<Camera> = cameras.iter().map(without_limits).collect();
    let params = CoverageParams::default().with_earth(*earth).with_unproven(UnprovenAs::Visible);
    // what is seen from behind is seen
    let private = Targets { normals: None, ..private.clone() };
    let (table, _) = coverage(scene, &cameras, &private, &params, control)?;
    Ok((0..cameras.len()).map(|camera| table.covered_by(camera).next().is_some()).collect())
}

/// Leaves out of `poses` those whose cameras have any of the `private` places in their picture ([`sees_private`]).
///
/// # Errors
/// Those of [`coverage`].
pub fn leave_out_private(
    scene: &MedialScene,
    poses: &mut Vec<CameraPose>,
    private: &Targets,
    earth: &EarthParams,
    control: &Control<'_>,
) -> Result<()> {
    let cameras: Vec<Camera> = poses.iter().map(|pose| pose.camera).collect();
    let mut seen = sees_private(scene, &cameras, private, earth, control)?.into_iter();
    poses.retain(|_| seen.next() == Some(false));
    Ok(())
}

/// Targets, and the parameters of their queries.
struct TargetQuery<'a> {
    scene: &'a MedialScene,
    targets: &'a Targets,
    eastward: Vec<(f32, u32)>,
    params: &'a CoverageParams,
}

/// The targets that have a position, from west to east.
fn eastward(targets: &Targets) -> Vec<(f32, u32)> {
    let mut order: Vec<(f32, u32)> = (0..)
        .zip(&targets.positions)
        .filter(|&(row, _)| targets.is_target(row as usize))
        .map(|(row, p)| (p[0], row))
        .collect();
    order.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order
}

impl TargetQuery<'_> {
    /// The rows of cameras at one place.
    fn rows(&self, cameras: &[Camera], control: &Control<'_>) -> Result<(Vec<u64>, CoverageReport)> {
        control.check()?;
        let words = self.targets.len().div_ceil(64);
        let mut bits = vec![0_u64; words * cameras.len()];
        let mut report = CoverageReport::default();
        let Some(eye) = cameras.first().map(|camera| camera.eye).filter(|eye| eye.iter().all(|v| v.is_finite())) else {
            control.advance(cameras.len());
            return Ok((bits, report));
        };
        let near = self.within_reach(eye, cameras);
        // pictures first: most targets are in none
        let mut in_picture = Vec::new();
        for &(_, row) in near {
            let target = self.targets.positions[row as usize].map(f64::from);
            let normal = self.targets.normals.as_ref().and_then(|normals| normals.get(row as usize));
            let normal = normal.map(|normal| normal.map(f64::from));
            let mut is_covered = false;
            for (camera, row_bits) in cameras.iter().zip(bits.chunks_exact_mut(words)) {
                if camera.covers(target, normal, self.params.density) {
                    row_bits[row as usize / 64] |= 1 << (row % 64);
                    is_covered = true;
                }
            }
            if is_covered {
                in_picture.push(row);
            }
        }
        let positions: Vec<[f32; 3]> = in_picture.iter().map(|&row| self.targets.positions[row as usize]).collect();
        let params = ViewshedParams::default().with_earth(self.params.earth).with_unproven(self.params.unproven);
        let observer = Observer { eye, ..Observer::default() };
        let seen = viewshed(self.scene, &[observer], &positions, &params, &Control::none())?;
        report.lines_of_sight = positions.len();
        let is_uncertain = self.uncertain(eye, &positions, &seen.answers)?;
        report.uncertain = self.params.certainty.map(|_| is_uncertain.iter().filter(|is| **is).count());
        let mut blocked_zones = 0;
        for (i, (&row, position)) in in_picture.iter().zip(&positions).enumerate() {
            let answer = &seen.answers[i];
            report.visible += usize::from(*answer == Answer::Visible);
            report.unproven += usize::from(*answer == Answer::Unproven);
            let is_zone_blocked = *answer == Answer::Visible && self.is_zone_blocked(eye, position.map(f64::from));
            blocked_zones += usize::from(is_zone_blocked);
            if *answer != Answer::Visible || is_uncertain[i] || is_zone_blocked {
                for row_bits in bits.chunks_exact_mut(words) {
                    row_bits[row as usize / 64] &= !(1 << (row % 64));
                }
            }
        }
        report.fresnel_zone_blocked = self.params.zone.map(|_| blocked_zones);
        control.advance(cameras.len());
        Ok((bits, report))
    }

    /// Flags the visible targets below the wanted certainty.
    fn uncertain(&self, eye: [f64; 3], positions: &[[f32; 3]], answers: &[Answer]) -> Result<Vec<bool>> {
        let mut is_uncertain = vec![false; positions.len()];
        let Some(certainty) = self.params.certainty else { return Ok(is_uncertain) };
        let visible: Vec<usize> = (0..positions.len()).filter(|&i| answers[i] == Answer::Visible).collect();
        let of_visible: Vec<[f32; 3]> = visible.iter().map(|&i| positions[i]).collect();
        let probabilities = self.scene.visible_probabilities(Viewer::Eye(eye), &of_visible, &Control::none())?;
        for (i, probability) in visible.into_iter().zip(probabilities) {
            is_uncertain[i] = !certainty.is_visible(probability);
        }
        Ok(is_uncertain)
    }

    /// Returns true if an obstacle reaches into the Fresnel zone that must be free.
    fn is_zone_blocked(&self, eye: [f64; 3], target: [f64; 3]) -> bool {
        self.params.zone.is_some_and(|FresnelZone { wave, share }| {
            !(wave.zone_clearance(self.scene, [eye, target], &self.params.earth, share) >= share)
        })
    }

    /// The targets of the strip from north to south in which the cameras reach anything.
    fn within_reach(&self, eye: [f64; 3], cameras: &[Camera]) -> &[(f32, u32)] {
        let reach = cameras.iter().map(|camera| camera.reach(self.params.density)).fold(0.0, f64::max);
        let from = self.eastward.partition_point(|(x, _)| f64::from(*x) < eye[0] - reach);
        let to = self.eastward.partition_point(|(x, _)| f64::from(*x) <= eye[0] + reach);
        &self.eastward[from..to]
    }
}
