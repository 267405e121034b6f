//! `belvedere sky-view`.

use super::sights::{Proving, blockers};
use super::sky_targets::Measure;
use crate::arguments::{Global, PatchesChoice, SkyView};
use crate::pipeline::{self, Points, flagged};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections, sky_view};
use belvedere::apps::tree_light::through_crowns;
use belvedere::query::visibility_matrix;

pub(crate) fn run(arguments: &SkyView, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let sky = match arguments.patches {
        Some(PatchesChoice::Tregenza) => SkyDirections::patches(1)?,
        Some(PatchesChoice::Reinhart) => SkyDirections::patches(2)?,
        None => flagged("--directions", SkyDirections::even(arguments.directions.unwrap_or(SKY_DIRECTIONS)))?,
    };
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut stages, &mut summary)?;
    let targets = arguments.places.targets(&mut scene, global.seed, &mut stages, &mut summary)?;
    let mut section = Summary::default();
    let profile = arguments.scene.profile.into();
    let (blockers, _) =
        blockers(&scene, profile, &arguments.shell.giving_way(), Proving::Never, &mut stages, &mut section)?;
    section.add("directions", sky.directions.len());
    summary.add("lines_of_sight", section);
    let matrix = stages.run("looking at the sky", targets.positions.len(), |progress| {
        visibility_matrix(&blockers, &targets.positions, &sky.directions, progress)
    })?;
    let mut seen = stages.run("summing up", 0, |_| sky_view(&matrix, &sky, targets.normals.as_deref()))?;
    if let Some(trees) = arguments.trees.of(&scene, blockers.params(), &mut summary)? {
        let matrix = stages.run("looking through trees", targets.positions.len(), |progress| {
            visibility_matrix(&trees.opaque, &targets.positions, &sky.directions, progress)
        })?;
        let without = sky_view(&matrix, &sky, targets.normals.as_deref())?;
        let share = trees.share(None);
        seen.factors = through_crowns(&seen.factors, &without.factors, share)?;
        seen.openness = through_crowns(&seen.openness, &without.openness, share)?;
    }
    for (row, position) in targets.positions.iter().enumerate() {
        if !position.iter().all(|v| v.is_finite()) {
            seen.factors[row] = f32::NAN;
            seen.openness[row] = f32::NAN;
        }
    }
    let range = Some([0.0, 1.0]);
    let measures = [
        Measure {
            name: "sky_view_factor",
            description: "sky view factor, cosine",
            decimals: 4,
            range,
            values: &seen.factors,
        },
        Measure {
            name: "sky_openness",
            description: "sky openness, solid angle",
            decimals: 4,
            range,
            values: &seen.openness,
        },
    ];
    summary.add("sky", targets.told(&measures));
    targets.write(&arguments.outputs, &measures, "Sky view factor (cosine-weighted)", &mut stages, &mut summary)?;
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}
