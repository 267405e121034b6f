//! What commands that ask lines of sight have in common: the scene, the earth and the ground.

use crate::arguments::{Earth, GivingWay, GroundChoice, Usage};
use crate::pipeline::Scene;
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::{Result, bail};
use belvedere::apps::edge::{EdgeReport, near_edge};
use belvedere::apps::eyes::{EyeFault, EyesReport, SkippedEye, skip_unfit_eyes};
use belvedere::apps::targets::Targets;
use belvedere::depth::Profile;
use belvedere::ground::{Ground, GroundParams, GroundPoints, MapGrid};
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::query::{BlockRule, EarthParams, MedialScene, UnprovenAs};
use belvedere::{Frame, PointCloud};

/// What is warned of with the share of what it happens to.
pub(crate) const OUTSIDE_CLOUD: &str = "are outside the cloud, where nothing is known, and have no answer";
/// Most eyes that are skipped by name.
const MOST_NAMED: usize = 5;

/// Share of targets near the edge that is warned of, percent.
const EDGE_WARNING_PERCENT: f64 = 1.0;
const NEAR_EDGE: &str = "are near the edge of the cloud: objects beyond it, as high as its highest point, could take some of their sun or sky";

/// Whether pulses are asked about lines of sight that nothing blocks.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Proving {
    /// Balls alone count.
    Never,
    /// Where that can change an answer.
    IfItDecides,
}

/// How balls block, as the flags say.
pub(crate) fn scene_params(scene: &Scene, profile: Profile, flags: &GivingWay) -> BlockRule {
    let usual = scene.model.rule();
    BlockRule { profile, shell: flags.shell.map_or(usual.shell, f64::from), ..usual }
}

/// Balls that lines of sight are cut with, and what to make of what is not proven.
pub(crate) fn blockers(
    scene: &Scene,
    profile: Profile,
    flags: &GivingWay,
    proving: Proving,
    run: &mut Run,
    section: &mut Summary,
) -> Result<(MedialScene, UnprovenAs)> {
    if flags.unproven.is_some() && scene.model.pulses().is_none() {
        let what = "--unproven needs pulses: a cloud with known scanner positions (see `belvedere info`), or an .npz file from such a cloud";
        return Err(Usage(what.to_owned()).into());
    }
    if flags.shell.is_some() && !scene.model.is_carved() {
        return Err(Usage("--shell applies only to carved balls, and these are not carved".to_owned()).into());
    }
    let params = scene_params(scene, profile, flags);
    let unproven_as = flags.unproven.map_or(UnprovenAs::Reported, UnprovenAs::from);
    let asked = if proving == Proving::IfItDecides { unproven_as } else { UnprovenAs::Visible };
    let blockers = scene.model.scene(&params, asked, &run.control())?;
    section
        .add("balls", blockers.ball_count())
        .add("depth_bias_m", rounded(params.bias, 4))
        .add("shell_m", rounded(params.shell, 4));
    add_proof(&blockers, section);
    Ok((blockers, unproven_as))
}

/// [`blockers`] that prove where that can change an answer, with their report.
pub(crate) fn proving_blockers(
    scene: &Scene,
    profile: Profile,
    flags: &GivingWay,
    run: &mut Run,
) -> Result<(MedialScene, UnprovenAs)> {
    let mut section = Summary::default();
    let found = blockers(scene, profile, flags, Proving::IfItDecides, run, &mut section)?;
    run.summary.add("lines_of_sight", section);
    Ok(found)
}

/// How near pulses must pass and how much may be unseen, where pulses tell visible from unproven.
pub(crate) fn add_proof(scene: &MedialScene, section: &mut Summary) {
    if let Some(proof) = scene.proof() {
        section
            .add("proof_distance_m", rounded(proof.nearness(), 3))
            .add("max_unproven_length_m", rounded(proof.tolerance(), 3));
    }
}

impl Earth {
    /// Parameters as typed.
    pub(crate) fn params(&self) -> Result<EarthParams> {
        let usual = EarthParams::default();
        let refraction = self.refraction.unwrap_or(usual.refraction);
        let params = EarthParams { curvature: self.curvature.into(), refraction, ..usual };
        params.validate()?;
        Ok(params)
    }
}

/// The cloud whose points show the ground: the scene's own, or the one that was named, in the frame of the scene.
pub(crate) fn ground_cloud(
    choice: &GroundChoice,
    scene: &mut Scene,
    run: &mut Run,
) -> Result<(PointCloud, GroundPoints)> {
    match choice {
        GroundChoice::OfScene(points) => {
            if scene.cloud.is_empty() {
                let what =
                    "a ball file has no points, so the ground is unknown: give the cloud with --ground cloud=FILE";
                return Err(Usage(what.to_owned()).into());
            }
            let frame = PointCloud::in_frame(scene.cloud.frame.clone());
            Ok((std::mem::replace(&mut scene.cloud, frame), *points))
        }
        GroundChoice::Cloud(path) => {
            let (cloud, _) = run.stage("reading ground", 0, |control| {
                read_cloud(std::slice::from_ref(path), &ReadOptions::default(), control)
            })?;
            let frame = &scene.cloud.frame;
            cloud.frame.crs.check_for(&frame.crs, "ground", path)?;
            // a scene that knows no system takes that of its ground
            let own = Some(cloud.frame.crs.clone()).filter(|crs| crs.kind != belvedere::crs::CrsKind::Unknown);
            let mut cloud = cloud.moved_to(frame);
            if let Some(crs) = own {
                cloud.frame.crs = crs;
            }
            Ok((cloud, GroundPoints::Auto))
        }
    }
}

/// The ground of a cloud on a grid, reported.
pub(crate) fn ground(cloud: &PointCloud, points: GroundPoints, grid: MapGrid, run: &mut Run) -> Result<Ground> {
    let params = GroundParams { points, ..GroundParams::default() };
    let (ground, report) =
        run.stage("computing ground", 0, |control| Ground::of_cloud(cloud, grid, &params, control))?;
    let mut section = Summary::default();
    let from = match report.from {
        GroundPoints::Found => "detected points (no class 2)",
        _ => "class 2",
    };
    section
        .add("source", from)
        .add("points", report.point_count)
        .add("grid_columns", grid.width)
        .add("grid_rows", grid.height)
        .add("cell_m", rounded(grid.cell, 4))
        .add("cells_without_ground", grid.len() - report.cell_count);
    run.summary.add("ground", section);
    Ok(ground)
}

/// Makes eyes that cannot look NaN, and warns of each: those of `who`, such as "observer". Fails where none is left.
pub(crate) fn skip_unfit(
    blockers: &MedialScene,
    ground: Option<&Ground>,
    (who, frame): (&str, &Frame),
    eyes: &mut [[f64; 3]],
    run: &mut Run,
) -> Result<EyesReport> {
    let report = run.stage("testing observers", 0, |control| skip_unfit_eyes(blockers, ground, eyes, control))?;
    warn_of_skipped(report, (who, frame), &mut run.summary)
}

fn warn_of_skipped(report: EyesReport, (who, frame): (&str, &Frame), summary: &mut Summary) -> Result<EyesReport> {
    let named = |skipped: &SkippedEye| {
        let [x, y, _] = frame.file_from_local(skipped.place);
        (format!("{who} {} at {x:.3},{y:.3}", skipped.row + 1), skipped.fault)
    };
    if report.skipped == report.count && report.skipped > 0 {
        let told = |skipped| {
            let (name, fault) = named(skipped);
            format!("{name}: {fault}")
        };
        let listed: Vec<String> = report.faults.iter().take(MOST_NAMED).map(told).collect();
        let more = report.skipped.saturating_sub(MOST_NAMED);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        let is_inside = |skipped: &SkippedEye| matches!(skipped.fault, EyeFault::InsideObstacle(_));
        let advice = match report.faults.iter().any(is_inside) {
            true => "; give places outside of obstacles, or heights above them",
            false => "",
        };
        bail!("no {who} is left: {}{more}{advice}", listed.join("; "));
    }
    for (name, fault) in report.faults.iter().take(MOST_NAMED).map(named) {
        summary.warn("observer-skipped", format!("{name} is skipped: {fault}"));
    }
    if report.skipped > MOST_NAMED {
        summary.warn("observers-skipped", format!("{} of {} {who}s are skipped", report.skipped, report.count));
    }
    Ok(report)
}

/// Notes for people on an eye inside something solid.
pub(crate) fn enclosure_note(blockers: &MedialScene, eye: [f64; 3], who: &str) -> Option<String> {
    let enclosure = blockers.enclosure(eye);
    (enclosure.ball_count > 0).then(|| {
        format!(
            "{who} is inside an obstacle: {} balls, up to {:.2} m deep; these balls are ignored",
            enclosure.ball_count, enclosure.depth
        )
    })
}

/// Reports how many targets are so near the edge of the cloud that objects beyond it could change their result, warns of many, and gives a flag for each.
pub(super) fn report_edge(
    targets: &Targets,
    scene: &Scene,
    directions: &[[f64; 3]],
    run: &mut Run,
) -> Result<Vec<Option<bool>>> {
    let Some(coverage) = scene.model.coverage() else { return Ok(vec![None; targets.len()]) };
    let flags = run.stage("testing the edge of the cloud", targets.len(), |control| {
        near_edge(&coverage, &targets.positions, directions, control)
    })?;
    let report = EdgeReport::of(&flags);
    run.summary.add_report(&report);
    if report.targets_near_edge_percent >= EDGE_WARNING_PERCENT {
        let share = (report.targets_near_edge, targets.asked_count());
        run.summary.warn_of_share("targets-near-edge", share, "targets", NEAR_EDGE);
    }
    Ok(flags)
}

/// Leaves out targets beside or below the cloud, and warns of them.
pub(super) fn leave_out_outside(targets: &mut Targets, scene: &Scene, summary: &mut Summary) {
    let count = targets.asked_count();
    let outside = scene.model.coverage().map_or(0, |coverage| targets.leave_out_outside(&coverage));
    summary.add("targets_outside_cloud", outside).warn_of_share(
        "targets-outside-cloud",
        (outside, count),
        "targets",
        OUTSIDE_CLOUD,
    );
}
