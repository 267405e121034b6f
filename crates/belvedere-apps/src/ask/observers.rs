//! Who looks, and what is looked at: places on the ground become eyes, and those that cannot look are skipped and
//! named.

use super::places::Places;
use super::report::GroundSection;
use super::scene::Scene;
use super::{Context, Remark};
use crate::eyes::{EyeFault, EyesReport, SkippedEye, skip_unfit_eyes, skip_unfit_far_eyes};
use crate::targets::{grid_around, set_on_ground, set_on_terrain};
use crate::viewshed::OBSERVER_HEIGHT;
use belvedere_core::ground::{Ground, GroundPoints};
use belvedere_core::query::{MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use serde::Serialize;
use std::sync::Arc;

/// Most eyes that are named one by one in remarks.
const MAX_NAMED: usize = 5;

/// A place where somebody stands, or that is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Local metres; the height is NaN where it follows from the ground.
    pub place: [f64; 3],
    /// Height of the eye above the ground, metres; `None` for that of the question.
    pub height: Option<f64>,
}

/// Eyes of which some cannot look.
#[derive(Clone, Debug)]
pub struct Eyes {
    /// Where each stands, local metres.
    pub places: Vec<[f64; 3]>,
    /// The eyes, local metres; NaN for one that cannot look, so that others keep their rows.
    pub eyes: Vec<[f64; 3]>,
    /// How many cannot look, and why.
    pub report: EyesReport,
}

/// Observers who look around themselves, and the balls that block their sight.
pub(super) struct Observers {
    pub(super) eyes: Eyes,
    pub(super) blockers: Arc<MedialScene>,
}

/// How far lines of sight may run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Within the cloud.
    Cloud,
    /// To the terrain beyond it, where there is any.
    FarTerrain,
}

/// Those who cannot look, for reports.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ObserversSection {
    /// How many cannot look, and why.
    #[serde(flatten)]
    pub eyes: EyesReport,
    /// Where the only one looks from, in the coordinates of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// How far that is above the ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub above_ground_m: Option<f64>,
}

impl Observers {
    /// The observers of `places`, those without a height that far above the ground; those who cannot look are named.
    pub(super) fn of(
        places: &Places,
        (height, points): (Option<f64>, GroundPoints),
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Self> {
        let usual = height.unwrap_or(OBSERVER_HEIGHT);
        let places = stand(places.eyes()?, (usual, points), scene, context, control)?;
        let blockers = scene.blockers(UnprovenAs::Visible, control)?;
        let eyes = skip_unfit(places, ("observer", Reach::Cloud), (&blockers, None), (scene, context), control)?;
        let report = eyes.report.clone();
        context.report.observers = Some(ObserversSection { eyes: report, ..ObserversSection::default() });
        note_enclosed(&blockers, &eyes.eyes, "observer", context);
        Ok(Self { eyes, blockers })
    }
}

/// Checks a height above the ground.
///
/// # Errors
/// [`Error::InvalidParameter`] for one below it, or that is not finite.
pub(super) fn check_height(height: Option<f64>) -> Result<()> {
    match height.filter(|height| !(height.is_finite() && *height >= 0.0)) {
        Some(height) => Err(Error::InvalidParameter {
            parameter: Parameter::HeightAboveGround,
            value: height.to_string(),
            expected: "0 metres or more",
        }),
        None => Ok(()),
    }
}

/// The places, local metres: those without a height stand on the ground, or on the terrain beyond the cloud. The height
/// is NaN where neither is known.
///
/// # Errors
/// Those of computing the ground, which is done only where a place over the cloud has no height.
pub(super) fn stand(
    standing: &[Standing],
    (usual, points): (f64, GroundPoints),
    scene: &Scene,
    context: &mut Context,
    control: &Control<'_>,
) -> Result<Vec<[f64; 3]>> {
    let mut places: Vec<[f64; 3]> = standing.iter().map(|one| one.place).collect();
    let heights = || standing.iter().map(|one| one.height.unwrap_or(usual));
    let coverage = scene.model().coverage();
    // ground is made where there are points: one place far away would make its cells large for all
    let is_over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    if let Some(grid) = grid_around(places.iter().copied().filter(is_over), scene.frame().origin)? {
        let known = scene.ground(grid, points, control)?;
        context.report.ground = Some(GroundSection::of(&known));
        set_on_ground(places.iter_mut().zip(heights()), &known.ground);
    }
    set_on_terrain(places.iter_mut().zip(heights()), scene.model());
    Ok(places)
}

/// Makes eyes that cannot look NaN, and names them in remarks. `who` they are is a word such as "observer".
///
/// # Errors
/// [`Error::NoObserver`] where none is left, and [`Error::Cancelled`].
pub(super) fn skip_unfit(
    places: Vec<[f64; 3]>,
    (who, reach): (&'static str, Reach),
    (blockers, ground): (&Arc<MedialScene>, Option<&Ground>),
    (scene, context): (&Scene, &mut Context),
    control: &Control<'_>,
) -> Result<Eyes> {
    let mut eyes = places.clone();
    let report = control.stage("testing observers", eyes.len(), || match reach {
        Reach::Cloud => skip_unfit_eyes(blockers, ground, &mut eyes, control),
        Reach::FarTerrain => skip_unfit_far_eyes(blockers, ground, &mut eyes, control),
    })?;
    remark_on_skipped(&report, who, scene, context)?;
    Ok(Eyes { places, eyes, report })
}

/// Names those who are skipped.
///
/// # Errors
/// [`Error::NoObserver`] where none is left.
pub(super) fn remark_on_skipped(
    report: &EyesReport,
    who: &'static str,
    scene: &Scene,
    context: &mut Context,
) -> Result<()> {
    let name = |skipped: &SkippedEye| {
        let [x, y, _] = scene.frame().file_from_local(skipped.place);
        format!("{who} {} at {x:.3},{y:.3}", skipped.row + 1)
    };
    let named = || report.faults.iter().take(MAX_NAMED);
    if report.skipped == report.count && report.skipped > 0 {
        let listed: Vec<String> = named().map(|skipped| format!("{}: {}", name(skipped), skipped.fault)).collect();
        let more = report.skipped.saturating_sub(MAX_NAMED);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        let is_inside = |skipped: &SkippedEye| matches!(skipped.fault, EyeFault::InsideObstacle(_));
        let advice = match report.faults.iter().any(is_inside) {
            true => "; give places outside of obstacles, or heights above them",
            false => "",
        };
        return Err(Error::NoObserver { who, what: format!("{}{more}{advice}", listed.join("; ")) });
    }
    for skipped in named() {
        let text = format!("{} is skipped: {}", name(skipped), skipped.fault);
        context.add(Some(Remark::warning("observer-skipped", text).with("row", (skipped.row + 1) as f64)));
    }
    if report.skipped > MAX_NAMED {
        let (skipped, count) = (report.skipped, report.count);
        let text = format!("{skipped} of {count} {who}s are skipped");
        context.add(Some(Remark::warning("observers-skipped", text).with("count", skipped as f64)));
    }
    Ok(())
}

/// Notes eyes that are just inside the surface of an obstacle: the balls around them are ignored.
pub(super) fn note_enclosed(blockers: &MedialScene, eyes: &[[f64; 3]], who: &str, context: &mut Context) {
    let mut count = 0;
    for (number, &eye) in (1_usize..).zip(eyes).filter(|(_, eye)| eye[0].is_finite()) {
        let enclosure = blockers.enclosure(eye);
        if enclosure.ball_count == 0 {
            continue;
        }
        count += 1;
        if count > MAX_NAMED {
            continue;
        }
        let text = format!(
            "{who} {number} is inside an obstacle: {} balls, up to {:.2} m deep; these balls are ignored",
            enclosure.ball_count, enclosure.depth
        );
        context.add(Some(Remark::note("eye-inside-obstacle", text).with("depth_m", enclosure.depth)));
    }
    if count > MAX_NAMED {
        let text = format!("{count} {who}s are inside obstacles, just below their surface");
        context.add(Some(Remark::note("eyes-inside-obstacle", text).with("count", count as f64)));
    }
}
