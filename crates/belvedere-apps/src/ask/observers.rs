//! Observers and observed places: places on the ground become eyes, and those that cannot look are skipped and named.

use super::context::Context;
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::ObserversSection;
use super::standing::{Reach, Standing};
use super::viewer::remark_on_beside;
use crate::eyes::{EyeFault, EyesReport, SkippedEye, skip_unfit_eyes, skip_unfit_far_eyes};
use crate::targets::{grid_around, set_on_ground, set_on_terrain};
use crate::viewshed::OBSERVER_HEIGHT;
use belvedere_core::ground::{Ground, GroundPoints};
use belvedere_core::query::{MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, Result};
use std::sync::Arc;

/// Maximum number of eyes that are named one by one in remarks.
const MAX_NAMED: usize = 5;
/// Radius around a place within which its ground is compared, metres.
const FOOTING_RADIUS: f64 = 10.0;
/// Maximum height difference between the ground below a place and that around it, metres: more than steps, ramps and
/// moats.
const MAX_STEP: f64 = 2.0;

/// Eyes of which some cannot look.
#[derive(Clone, Debug)]
pub struct Eyes {
    /// Position of each, local metres.
    pub places: Vec<[f64; 3]>,
    /// The eyes, local metres; NaN for one that cannot look, so that others keep their rows.
    pub eyes: Vec<[f64; 3]>,
    /// Number that cannot look, with the reasons.
    pub report: EyesReport,
}

/// Observers who look around themselves, and the balls that block their sight.
pub(super) struct Observers {
    pub(super) eyes: Eyes,
    pub(super) blockers: Arc<MedialScene>,
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
        let given = places.eyes()?;
        let places = stand(given, (usual, points), scene, context, control)?;
        let blockers = scene.blockers(UnprovenAs::Visible, control)?;
        let eyes = skip_unfit(places, ("observer", Reach::Cloud), (&blockers, None), (scene, context), control)?;
        let mut section = ObserversSection { eyes: eyes.report.clone(), ..ObserversSection::default() };
        if let ([eye], [standing]) = (&eyes.eyes[..], given) {
            section.eye = Some(scene.frame().file_from_local(*eye).map(|v| rounded(v, 3)));
            let height = standing.height.unwrap_or(usual);
            section.above_ground_m = standing.place[2].is_nan().then(|| rounded(height, 3));
        }
        context.report.observers = Some(section);
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
        Some(height) => Err(Error::invalid(Parameter::HeightAboveGround, height, "0 metres or more")),
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
    let is_on_ground: Vec<bool> = places.iter().map(|place| place[2].is_nan()).collect();
    let coverage = scene.model().coverage();
    // ground is made where there are points: one place far away would make its cells large for all
    let is_over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    if let Some(grid) = grid_around(places.iter().copied().filter(is_over), scene.frame().origin)? {
        let known = scene.ground(grid, points, control)?;
        context.ground(scene.frame(), &known);
        set_on_ground(places.iter_mut().zip(heights()), &known.ground);
        let feet = places.iter().zip(heights()).zip(is_on_ground);
        let feet = feet.map(
            |((&[x, y, z], height), is_on_ground)| {
                if is_on_ground { [x, y, z - height] } else { [f64::NAN; 3] }
            },
        );
        remark_on_footing(feet, &known.ground, "place", scene, context);
    }
    set_on_terrain(places.iter_mut().zip(heights()), scene.model());
    Ok(places)
}

/// Warns of those who stand on ground far below or above the ground around them. `feet` are where they stand, local
/// metres, NaN for who does not stand on the ground.
pub(super) fn remark_on_footing(
    feet: impl IntoIterator<Item = [f64; 3]>,
    ground: &Ground,
    who: &str,
    scene: &Scene,
    context: &mut Context,
) {
    let mut count = 0;
    for (number, foot) in (1_usize..).zip(feet).filter(|(_, foot)| foot[2].is_finite()) {
        let Some([low, high]) = ground.heights_around([foot[0], foot[1]], FOOTING_RADIUS) else { continue };
        let (below, above) = (low - foot[2], foot[2] - high);
        let off = below.max(above);
        if off <= MAX_STEP {
            continue;
        }
        count += 1;
        if count > MAX_NAMED {
            continue;
        }
        let level = scene.frame().file_from_local(foot)[2];
        let side = if below > above { "below" } else { "above" };
        let text = format!(
            "{who} {number} stands on ground at {level:.2}, {off:.1} m {side} the ground within {FOOTING_RADIUS} m of it: \
             give its height as a third coordinate if that is wrong"
        );
        context.add(Some(Remark::warning("odd-ground", text).with("row", number as f64).with("off_m", off)));
    }
    if count > MAX_NAMED {
        let text = format!("{count} {who}s stand on ground metres below or above the ground around them");
        context.add(Some(Remark::warning("odd-grounds", text).with("count", count as f64)));
    }
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
    note_beside(blockers, &eyes, who, context);
    Ok(Eyes { places, eyes, report })
}

/// Notes eyes in the air beside the cloud.
pub(super) fn note_beside(blockers: &MedialScene, eyes: &[[f64; 3]], who: &str, context: &mut Context) {
    let is_beside = |eye: &&[f64; 3]| {
        let coverage = blockers.coverage().filter(|coverage| !coverage.holds(**eye));
        coverage.is_some_and(|coverage| coverage.holds_end(**eye)) && !blockers.is_on_far_terrain(**eye)
    };
    let count = eyes.iter().filter(is_beside).count();
    let who_are = match eyes.len() {
        1 => format!("the {who} is"),
        all => format!("{count} of {all} {who}s are"),
    };
    context.add((count > 0).then(|| remark_on_beside(&who_are)));
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

/// Notes eyes that are just inside the surface of an obstacle: the balls around them give way.
pub(super) fn note_enclosed(blockers: &MedialScene, eyes: &[[f64; 3]], who: &str, context: &mut Context) {
    let mut count = 0;
    for (number, &eye) in (1_usize..).zip(eyes).filter(|(_, eye)| eye[0].is_finite()) {
        let enclosure = blockers.enclosure(eye);
        if enclosure.ball_count == 0 || blockers.is_inside_obstacle(eye) {
            continue;
        }
        count += 1;
        if count > MAX_NAMED {
            continue;
        }
        let text = format!(
            "{who} {number} is in the surface of an obstacle: {} balls, up to {:.2} m deep, which give way",
            enclosure.ball_count, enclosure.depth
        );
        context.add(Some(Remark::note("eye-in-surface", text).with("depth_m", enclosure.depth)));
    }
    if count > MAX_NAMED {
        let text = format!("{count} {who}s are in the surface of obstacles, which give way");
        context.add(Some(Remark::note("eyes-in-surface", text).with("count", count as f64)));
    }
}
