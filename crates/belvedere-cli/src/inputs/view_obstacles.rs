//! Common parts of commands about views: obstacles and the curved earth.

use crate::arguments::{Earth, GivingWay, Usage};
use crate::pipeline::LoadedScene;
use crate::run::CommandContext;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::depth::Profile;
use belvedere::query::{BlockRule, EarthParams, MedialScene, UnprovenAs};

/// Balls that lines of sight are cut with, and what to make of what is not proven; reported.
pub(crate) fn proving_blockers(
    scene: &LoadedScene,
    profile: Profile,
    flags: &GivingWay,
    run: &mut CommandContext,
) -> Result<(MedialScene, UnprovenAs)> {
    if flags.unproven.is_some() && scene.model.pulses().is_none() {
        let what = "--unproven needs pulses: a cloud with known scanner positions (see `belvedere info`), or an .npz file from such a cloud";
        return Err(Usage(what.to_owned()).into());
    }
    if flags.shell.is_some() && !scene.model.is_carved() {
        return Err(Usage("--shell applies only to carved balls, and these are not carved".to_owned()).into());
    }
    let usual = scene.model.rule();
    let rule = BlockRule { profile, shell: flags.shell.map_or(usual.shell, f64::from), ..usual };
    let unproven = flags.unproven.map_or(UnprovenAs::Reported, UnprovenAs::from);
    let blockers = scene.model.scene(&rule, unproven, &run.control())?;
    let mut section = Summary::default();
    section
        .add("balls", blockers.ball_count())
        .add("depth_bias_m", rounded(rule.bias, 4))
        .add("shell_m", rounded(rule.shell, 4));
    add_proof(&blockers, &mut section);
    run.summary.add("lines_of_sight", section);
    Ok((blockers, unproven))
}

/// Adds the proof distance and the maximum unproven length, if pulses separate visible from unproven.
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
