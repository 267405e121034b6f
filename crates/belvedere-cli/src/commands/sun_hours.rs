//! `belvedere sun-hours`.

use super::check_output;
use super::sights::{Proving, blockers, scene_params};
use crate::arguments::{Global, SunHours, Usage};
use crate::pipeline::{self, Points, Scene, flagged};
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::{Result, bail};
use belvedere::apps::rows::{Obstacles, RowBlock, fold_rows};
use belvedere::apps::sun::{Binning, DayParams, Period, Site, SunSchedule, Zone, sun_days};
use belvedere::apps::sun_hours::{SunPlan, SunRule, SunSums, scene_sun_hours};
use belvedere::apps::targets::Targets;
use belvedere::apps::tree_light::TreeLight;
use belvedere::io::{MatrixHead, read_matrix_head, read_matrix_rows, write_matrix_rows};
use belvedere::query::{BlockRule, VisibilityMatrix, scene_fingerprint};

/// Names of the columns of rules of one's own, in the order given.
const OWN_RULES: [&str; 8] = ["rule_1", "rule_2", "rule_3", "rule_4", "rule_5", "rule_6", "rule_7", "rule_8"];

pub(crate) fn run(arguments: &SunHours, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let rules = rules(&arguments.rule)?;
    if !arguments.when.is_given() && rules.is_empty() {
        return Err(Usage("a period is missing: give --date DAY, --from and --to, or --rule NAME".to_owned()).into());
    }
    arguments.when.check(&arguments.sun)?;
    let params = arguments.when.params(&arguments.sun)?;
    if let Some(keep) = &arguments.keep {
        check_output("--save-matrix", keep, &["npz"])?;
    }
    if arguments.trees.is_given() && (arguments.keep.is_some() || arguments.from_matrix.is_some()) {
        let what = "--through-trees does not work with --save-matrix and --load-matrix: a matrix does not separate trees from other obstacles";
        return Err(Usage(what.to_owned()).into());
    }
    let kept = match &arguments.from_matrix {
        Some(path) => Some((path, read_matrix_head(path)?)),
        None => None,
    };
    let suns = match (&kept, arguments.within) {
        (Some((_, head)), degrees) => Suns::Among(&head.directions, degrees.unwrap_or(1.0).to_radians()),
        (None, None) => Suns::Of(Binning::Auto),
        (None, Some(0.0)) => Suns::Of(Binning::Exact),
        (None, Some(degrees)) => Suns::Of(Binning::Within(degrees.to_radians())),
    };
    let mut run = Run::new(global);
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    arguments.places.far.set(&mut scene, &mut run)?;
    let site = arguments.sun.site(&scene, &mut run.summary)?;
    let (plan, zone) = plan(arguments, &site, rules, &params, &suns, &mut run.summary)?;
    let asked = arguments.places.targets(&mut scene, &mut run)?;
    asked.report_edge(&arguments.places, &scene, plan.directions(), &mut run)?;
    let targets = &asked.targets;
    let trees = arguments.trees.of(&scene, &matrix_params(&scene, arguments), &mut run.summary)?;
    let sums = match &kept {
        Some((path, head)) => {
            check_kept(head, targets, matrix_scene(&scene, arguments))?;
            run.stage("reading matrix", targets.len(), |control| {
                let mut sums = SunSums::default();
                let mut first = 0;
                read_matrix_rows(path.as_path(), head, |words| {
                    control.check()?;
                    let count = words.len() / head.words_of_row().max(1);
                    let matrix = VisibilityMatrix::from_words(count, head.directions.len(), words.to_vec())?;
                    let block = RowBlock { rows: first..first + count, matrix, without_trees: None };
                    sums.add(&plan, &block, targets.normals.as_deref(), None)?;
                    first += count;
                    control.advance(count);
                    Ok(())
                })?;
                if head.directions.is_empty() {
                    // of a night without sun there are no rows
                    let matrix = VisibilityMatrix::from_words(targets.len(), 0, Vec::new())?;
                    let block = RowBlock { rows: 0..targets.len(), matrix, without_trees: None };
                    sums.add(&plan, &block, targets.normals.as_deref(), None)?;
                }
                Ok::<_, belvedere::Error>(sums)
            })?
        }
        None => look(arguments, &scene, &plan, targets, (trees.as_ref(), &site), &mut run)?,
    };
    let measures = sums.into_measures(&plan, targets);
    run.summary.add("sun", asked.statistics(&measures));
    let days = days_in_words(plan.period(), &zone);
    let title = match plan.rules().first().filter(|_| !arguments.when.is_given()) {
        Some(first) => format!("Sun hours on the days of the rule {}, {days}", first.rule.name),
        None => format!("Sun hours, {days}"),
    };
    let title = arguments.places.far.titled(&title);
    asked.write(&arguments.outputs, &measures, &title, &mut run)?;
    Ok(run.finish())
}

/// The sun at each target; what it sees of the directions is kept where that is asked for.
fn look(
    arguments: &SunHours,
    scene: &Scene,
    plan: &SunPlan,
    targets: &Targets,
    (trees, site): (Option<&TreeLight>, &Site),
    run: &mut Run,
) -> Result<SunSums> {
    let mut section = Summary::default();
    let profile = scene.profile;
    let (blockers, _) = blockers(scene, profile, &arguments.shell.giving_way(), Proving::Never, run, &mut section)?;
    section.add("directions", plan.directions().len());
    run.summary.add("lines_of_sight", section);
    let obstacles = Obstacles { scene: &blockers, trees };
    let looks = targets.len() * obstacles.matrix_count();
    let Some(keep) = &arguments.keep else {
        let sums =
            run.stage("testing sun", looks, |control| scene_sun_hours(obstacles, targets, plan, Some(site), control));
        return Ok(sums?);
    };
    let head = MatrixHead {
        origin: targets.frame.origin,
        targets: targets.positions.clone(),
        directions: plan.directions().to_vec(),
        scene: matrix_scene(scene, arguments),
    };
    let mut sums = SunSums::default();
    run.stage("testing sun", looks, |control| {
        write_matrix_rows(keep, &head, |sink| {
            fold_rows(obstacles.into(), &targets.positions, plan.directions(), control, |block| {
                (0..block.matrix.target_count()).try_for_each(|row| sink(block.matrix.row(row)))?;
                sums.add(plan, &block, targets.normals.as_deref(), None)
            })
        })
    })?;
    run.summary.add("matrix_written", keep.display().to_string());
    Ok(sums)
}

/// How balls block.
fn matrix_params(scene: &Scene, arguments: &SunHours) -> BlockRule {
    scene_params(scene, scene.profile, &arguments.shell.giving_way())
}

/// The number by which a matrix knows the balls that it was made of.
fn matrix_scene(scene: &Scene, arguments: &SunHours) -> u64 {
    scene_fingerprint(
        scene.model.balls(),
        scene.model.added(),
        scene.model.far_terrain(),
        &matrix_params(scene, arguments),
    )
}

/// Refuses bits that were kept for other places or balls.
fn check_kept(kept: &MatrixHead, targets: &Targets, scene: u64) -> Result<()> {
    if kept.scene != scene {
        bail!(
            "--load-matrix: the matrix is for other balls, or for another --add, --terrain, --horizon, --shell or --ball-profile; make it again with --save-matrix"
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

/// Which directions stand for suns.
enum Suns<'a> {
    Of(Binning),
    /// These, each for suns within an angle.
    Among(&'a [[f64; 3]], f64),
}

/// The rules that were typed, each with the name of its column.
pub(super) fn rules(typed: &[String]) -> Result<Vec<(&'static str, SunRule)>> {
    let mut own = OWN_RULES.into_iter();
    let mut rules: Vec<(&'static str, SunRule)> = Vec::new();
    for text in typed {
        let rule = flagged("--rule", SunRule::parse(text))?;
        let column = match SunRule::columns().find(|(name, _)| *name == rule.name) {
            Some((_, column)) => Some(column),
            None => own.next(),
        };
        let Some(column) = column else {
            return Err(Usage(format!("--rule: at most {} rules of your own", OWN_RULES.len())).into());
        };
        if rules.iter().any(|(_, other)| other.name == rule.name) {
            return Err(Usage(format!("--rule {text}: given twice")).into());
        }
        rules.push((column, rule));
    }
    Ok(rules)
}

/// The suns that were typed, those of rules with them, and how clocks run.
fn plan(
    arguments: &SunHours,
    site: &Site,
    rules: Vec<(&'static str, SunRule)>,
    params: &DayParams,
    suns: &Suns<'_>,
    summary: &mut Summary,
) -> Result<(SunPlan, Zone)> {
    let when = &arguments.when;
    let zone = arguments.sun.zone(site, &when.times())?;
    let schedule = |period: &Period, params: &DayParams| {
        let days = flagged("--time-step-min, --min-sun-elevation or --from", sun_days(site, &zone, period, params))?;
        flagged(
            "--sun-tolerance-deg",
            match suns {
                Suns::Of(binning) => SunSchedule::new(&days, *binning),
                Suns::Among(directions, angle) => SunSchedule::among(&days, directions, *angle),
            },
        )
    };
    let mut of_rules = Vec::new();
    for (column, rule) in rules {
        let dates = flagged("--year", rule.days.dates(when.year, site, &zone))?;
        let least_elevation = when.least_elevation.map_or(rule.least_elevation, f64::to_radians);
        let schedule = schedule(&Period::Days(dates), &params.with_least_elevation(least_elevation))?;
        of_rules.push((column.to_owned(), rule, schedule));
    }
    let main = match (when.period(&arguments.sun, site, &zone)?, of_rules.first()) {
        (Some(period), _) => schedule(&period, params)?,
        (None, Some((.., first))) => first.clone(),
        (None, None) => {
            return Err(Usage("a period is missing: give --date, --from and --to, or --rule".to_owned()).into());
        }
    };
    let plan = SunPlan::new(main, of_rules);
    summary.add("period", figures(&plan, &zone, params));
    Ok((plan, zone))
}

/// The days of a schedule in a few words.
fn days_in_words(schedule: &SunSchedule, zone: &Zone) -> String {
    let [first, last] = [schedule.days.first(), schedule.days.last()].map(|day| day.map(|day| day.date.to_string()));
    let (first, last) = (first.unwrap_or_default(), last.unwrap_or_default());
    let days = if first == last { first } else { format!("{first} to {last}, mean of days") };
    format!("{days} ({})", zone.name())
}

fn figures(plan: &SunPlan, zone: &Zone, params: &DayParams) -> Summary {
    let main = plan.period();
    let mut section = Summary::default();
    let count = main.days.len().max(1) as f64;
    let [first, last] = [main.days.first(), main.days.last()].map(|day| day.map(|day| day.date.to_string()));
    section
        .add("first_day", first.unwrap_or_default())
        .add("last_day", last.unwrap_or_default())
        .add("days", main.days.len())
        .add("time_zone", zone.name())
        .add("time_step_min", rounded(params.step / 60.0, 3))
        .add("suns", main.days.iter().map(|day| day.steps.len()).sum::<usize>())
        .add("directions", main.directions.len())
        .add("possible_hours_per_day", rounded(main.possible_hours() / count, 3));
    if main.greatest_error > 0.0 {
        section
            .add("max_direction_error_deg", rounded(main.greatest_error.to_degrees(), 3))
            .add("rms_direction_error_deg", rounded(main.rms_error.to_degrees(), 3));
    }
    for planned in plan.rules() {
        let text = format!("{} on {} days", planned.rule.description, planned.schedule.days.len());
        section.add(&planned.column, text);
    }
    section
}
