//! `belvedere sun-hours`.

use super::check_output;
use super::in_tiles::TypedCells;
use super::targets::TargetOutput;
use crate::arguments::{Global, SunHoursArguments, Usage};
use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::ask::{self, Answers, Ask, Context, OnTargets, Places, PreparedSun, Scene};
use belvedere::apps::rows::{RowBlock, fold_rows};
use belvedere::apps::sun_hours::SunSums;
use belvedere::apps::targets::Targets;
use belvedere::apps::tree_light::Season;
use belvedere::io::{MatrixHead, read_matrix_head, read_matrix_rows, write_matrix_rows};
use belvedere::query::{VisibilityMatrix, scene_fingerprint};
use std::path::Path;

pub(crate) fn run(arguments: &SunHoursArguments, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let question = ask::SunHoursQuestion {
        days: arguments.when.days(),
        rules: arguments.rule.clone(),
        place: arguments.sun.place_from_true_north()?,
        sun_tolerance_deg: arguments.within,
        trees: arguments.trees.choice()?,
        interval: arguments.interval.interval,
    };
    question.check()?;
    if let Some(keep) = &arguments.keep {
        check_output("--save-matrix", keep, &["npz"])?;
    }
    if question.trees.is_light() && (arguments.keep.is_some() || arguments.from_matrix.is_some()) {
        let what = "--through-trees does not work with --save-matrix and --load-matrix: a matrix does not separate trees from other obstacles";
        return Err(Usage(what.to_owned()).into());
    }
    if question.interval && (arguments.keep.is_some() || arguments.from_matrix.is_some()) {
        let what = "--interval does not work with --save-matrix and --load-matrix: run without them";
        return Err(Usage(what.to_owned()).into());
    }
    let mut run = CommandContext::new(global);
    let cells = TypedCells::of_sky(
        (&arguments.scene, &arguments.memory),
        &arguments.places,
        &arguments.trees,
        &arguments.outputs,
        &[
            ("--shell", arguments.shell.shell.is_some()),
            ("--save-matrix", arguments.keep.is_some()),
            ("--load-matrix", arguments.from_matrix.is_some()),
        ],
    );
    if cells.answered(ask::Question::SunHours(question.clone()), None, &mut run)?.is_some() {
        return Ok(run.finish());
    }
    let head = match &arguments.from_matrix {
        Some(path) => Some((path.as_path(), read_matrix_head(path)?)),
        None => None,
    };
    let scene = pipeline::scene_of_places(&arguments.scene, &arguments.places, arguments.shell.shell, &mut run)?;
    let (places, source) = arguments.places.places(&scene, &mut run)?;
    let answers = match (&head, &arguments.keep) {
        (None, None) => ask::ask(&scene, &question, &places, &run.control())?,
        (Some((path, head)), _) => from_matrix(&scene, &question, &places, (path, head), &run)?,
        (None, Some(keep)) => {
            run.summary.add("matrix_written", keep.display().to_string());
            with_matrix(&scene, &question, &places, keep, &run)?
        }
    };
    run.answered(&answers);
    let shown = TargetOutput::new(&answers.found, source, &scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    Ok(run.finish())
}

/// The sun at each target; what targets see of the directions is kept in a file.
fn with_matrix(
    scene: &Scene,
    question: &ask::SunHoursQuestion,
    places: &Places,
    file: &Path,
    run: &CommandContext,
) -> Result<Answers<OnTargets>> {
    let mut context = Context::default();
    let prepared = question.prepare(scene, places, None, &mut context, &run.control())?;
    let (plan, targets) = (&prepared.plan, prepared.targets());
    let head = MatrixHead {
        origin: targets.frame.origin,
        targets: targets.positions.clone(),
        directions: plan.directions().to_vec(),
        scene: fingerprint(scene, leaves_of(&prepared)?),
    };
    let (mut sums, factor) = (SunSums::default(), leaves_of(&prepared)?.unwrap_or_default());
    run.stage("testing sun", targets.len(), |control| {
        write_matrix_rows(file, &head, |sink| {
            fold_rows(prepared.obstacles().into(), &targets.positions, plan.directions(), control, |block| {
                // a matrix has a yes or no for each line, also of those through crowns
                let block = RowBlock { matrix: block.free_lines(factor)?, crowns: None, ..block };
                (0..block.matrix.target_count()).try_for_each(|row| sink(block.matrix.row(row)))?;
                sums.add(plan, &block, targets.normals.as_deref(), None)
            })
        })
    })?;
    Ok(prepared.answers(sums, &mut context).with(context))
}

/// The sun at each target, from what an earlier run found that targets see.
fn from_matrix(
    scene: &Scene,
    question: &ask::SunHoursQuestion,
    places: &Places,
    (file, head): (&Path, &MatrixHead),
    run: &CommandContext,
) -> Result<Answers<OnTargets>> {
    let mut context = Context::default();
    let prepared = question.prepare(scene, places, Some(&head.directions), &mut context, &run.control())?;
    check_kept(head, prepared.targets(), fingerprint(scene, leaves_of(&prepared)?))?;
    let sums = run.stage("reading matrix", prepared.targets().len(), |control| {
        let mut sums = SunSums::default();
        let mut first = 0;
        read_matrix_rows(file, head, |words| {
            control.check()?;
            let count = words.len() / head.words_of_row().max(1);
            let matrix = VisibilityMatrix::from_words(count, head.directions.len(), words.to_vec())?;
            add_rows(&mut sums, &prepared, first, matrix)?;
            first += count;
            control.advance(count);
            Ok(())
        })?;
        if head.directions.is_empty() {
            // of a night without sun there are no rows
            let matrix = VisibilityMatrix::from_words(prepared.targets().len(), 0, Vec::new())?;
            add_rows(&mut sums, &prepared, 0, matrix)?;
        }
        Ok::<_, belvedere::Error>(sums)
    })?;
    Ok(prepared.answers(sums, &mut context).with(context))
}

/// Adds rows of a matrix from number `first` on.
fn add_rows(
    sums: &mut SunSums,
    prepared: &PreparedSun,
    first: usize,
    matrix: VisibilityMatrix,
) -> belvedere::Result<()> {
    let block = RowBlock { rows: first..first + matrix.target_count(), matrix, crowns: None };
    sums.add(&prepared.plan, &block, prepared.targets().normals.as_deref(), None)
}

/// The number by which a matrix knows the balls that it was made of, and the leaves of crowns that were measured.
fn fingerprint(scene: &Scene, leaves: Option<f64>) -> u64 {
    let model = scene.model();
    let of_balls = scene_fingerprint(model.balls(), model.added(), model.far_terrain(), scene.rule());
    // a factor of 0 does not occur
    of_balls ^ leaves.map_or(0, f64::to_bits)
}

/// By what the depth of crowns that were measured is multiplied on all days; `None` where they are solid.
///
/// # Errors
/// A usage error for days of several seasons: bits of a matrix are those of one.
fn leaves_of(prepared: &PreparedSun) -> Result<Option<f64>> {
    let Some(crowns) = prepared.obstacles().trees.map(|trees| trees.crowns) else { return Ok(None) };
    let mut factors = prepared.plan.dates().map(|date| crowns.factor(Some(Season::on(date, &prepared.site))));
    let first = factors.next();
    match first.is_some_and(|first| factors.all(|other| other == first)) {
        true => Ok(first),
        false => {
            let what = "--save-matrix and --load-matrix need days of one season, since crowns change with leaves; give --leaves, or --through-trees none";
            Err(Usage(what.to_owned()).into())
        }
    }
}

/// Refuses bits that were kept for other places or balls.
fn check_kept(kept: &MatrixHead, targets: &Targets, scene: u64) -> Result<()> {
    if kept.scene != scene {
        bail!(
            "--load-matrix: the matrix is for other balls, other leaves, or for another --add, --terrain, --horizon or --shell; make it again with --save-matrix"
        );
    }
    let same = |a: &[f32; 3], b: &[f32; 3]| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
    let is_of_targets = kept.origin == targets.frame.origin
        && kept.targets.len() == targets.len()
        && kept.targets.iter().zip(&targets.positions).all(|(a, b)| same(a, b));
    if !is_of_targets {
        bail!(
            "--load-matrix: the matrix is for {} other targets; use the same targets, or make it again with --save-matrix",
            kept.targets.len()
        );
    }
    Ok(())
}
