//! The held-out pulse test on clouds of which nothing else is known.

use super::place::{ComparisonPlace, file_name, missing_points, state_of};
use super::results::{HeldOutResult, keep, kept};
use crate::arguments::Compare;
use crate::run::Run;
use anyhow::{Context, Result};
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud, read_trajectory};
use belvedere::pulses::{SensorEstimateParams, SensorPositions, group};
use belvedere_baselines::MethodInput;
use belvedere_baselines::held_out::{ErrorTally, HeldOut, HeldOutParams, HeldOutScore, score, split};
use belvedere_baselines::methods::{Listing, methods};
use std::path::Path;

/// Judges every method that needs the cloud alone on the pulses of `path` that were kept from it.
pub(super) fn judge_all(path: &Path, arguments: &Compare, run: &mut Run) -> Result<Vec<HeldOutResult>> {
    let control = &Control::none();
    let (cloud, report) = run.stage("reading", || read_cloud(&[path.to_owned()], &ReadOptions::default(), control))?;
    run.warnings.extend(missing_points(&report));
    let named = || path.display().to_string();
    let (pulses, _) = group(&cloud, control).with_context(named)?;
    let (scanner, report) = run.stage("estimating scanner positions", || match &arguments.trajectory {
        Some(file) => {
            let (trajectory, _) = read_trajectory(file, &cloud.frame.crs)?;
            SensorPositions::from_trajectory(&cloud, &pulses, &trajectory)
        }
        None => SensorPositions::from_returns(&cloud, &pulses, &SensorEstimateParams::default(), control),
    })?;
    let held_params = HeldOutParams { seed: arguments.seed, ..HeldOutParams::default() };
    let held_out = split(&cloud, &pulses, &scanner, &held_params).with_context(named)?;
    let kept_cloud = cloud.select(&held_out.kept);
    let of_all = scanner.per_point(&pulses, cloud.len());
    let of_kept: Vec<[f32; 3]> = held_out.kept.iter().map(|&row| of_all[row as usize]).collect();
    let survey = MethodInput { cloud: &kept_cloud, scanner: &of_kept, models: &[] };

    let name = file_name(path);
    let known_percent = 100.0 * report.known_count as f64 / report.pulse_count.max(1) as f64;
    let made_from = format!(
        "belvedere {}; {}; scanner by {}; {} of {} pulses held out, scanner known for {known_percent:.1} %; seed {}",
        env!("CARGO_PKG_VERSION"),
        state_of(path),
        arguments.trajectory.as_deref().map_or_else(|| "the pulses".to_owned(), state_of),
        held_out.pulse_count,
        pulses.len(),
        arguments.seed
    );
    let methods = methods(&survey);
    // places know methods of models, which a cloud alone does not have
    if ComparisonPlace::all(arguments).is_empty() {
        arguments.check_methods(&methods.iter().map(|method| method.key.clone()).collect::<Vec<_>>())?;
    }
    let mut results = Vec::new();
    let listing = |listing: Listing| if listing == Listing::OnHeldOutPulses { Listing::Always } else { listing };
    for method in methods.iter().filter(|method| arguments.wants(&method.key, listing(method.listing))) {
        let file = arguments.output.join("results").join(format!("{name}--held-out--{}.json", method.key));
        if let Some(result) = kept(&file, &made_from) {
            results.push(result);
            continue;
        }
        let answered =
            run.stage("testing held-out pulses", || method.build().and_then(|built| score(built.as_ref(), &held_out)));
        let mut result = HeldOutResult {
            made_from: made_from.clone(),
            cloud: name.clone(),
            pulses: held_out.pulse_count,
            scanner_known: known_percent / 100.0,
            method: method.key.clone(),
            title: method.title.clone(),
            shares: Vec::new(),
            failed: None,
        };
        match answered {
            Ok(score) => result.shares = shares(&score, &held_out),
            Err(error) => result.failed = Some(error.to_string()),
        }
        keep(&file, &result)?;
        results.push(result);
    }
    Ok(results)
}

/// Rates by name, in the order of the table.
fn shares(score: &HeldOutScore, held_out: &HeldOut) -> Vec<(String, Option<f64>)> {
    let share = |tally: &ErrorTally| (tally.answered_count > 0).then(|| tally.share());
    let mut shares = vec![
        ("false-blocked".to_owned(), share(&score.false_blocked)),
        ("ground".to_owned(), share(&score.false_blocked_ground)),
        ("building".to_owned(), share(&score.false_blocked_building)),
        ("other".to_owned(), share(&score.false_blocked_other)),
    ];
    for at in &score.false_visible {
        shares.push((format!("false-visible {} m behind building", at.depth), share(&at.building)));
    }
    for at in &score.false_visible {
        shares.push((format!("{} m behind ground", at.depth), share(&at.ground)));
    }
    for at in &score.false_visible {
        shares.push((format!("{} m behind other", at.depth), share(&at.other)));
    }
    let undecided = score.false_blocked.undecided_count as f64 / held_out.free.targets.len().max(1) as f64;
    shares.push(("no answer".to_owned(), Some(undecided)));
    shares
}
