//! `belvedere sun-hours`.

use super::sights::{Proving, blockers, scene_params};
use super::sky_targets::{Measure, SkyTargets};
use super::tree_light::{TreeLight, day_of_year};
use super::{check_distinct, check_output};
use crate::arguments::{Global, SunHours, Usage};
use crate::pipeline::{self, Points, Scene, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, rounded};
use anyhow::{Result, bail};
use belvedere::apps::sun::{Binning, DayOfLight, DayParams, Period, Site, SunSchedule, Zone, sun_days};
use belvedere::apps::sun_hours::{SunHours as Found, SunHoursParams, SunRule, sun_hours, sun_hours_through_crowns};
use belvedere::io::{SavedMatrix, read_matrix, write_matrix};
use belvedere::query::{BlockRule, VisibilityMatrix, scene_fingerprint, visibility_matrix};

/// Names of the columns of rules of one's own, in the order given.
const OWN_RULES: [&str; 8] = ["rule_1", "rule_2", "rule_3", "rule_4", "rule_5", "rule_6", "rule_7", "rule_8"];

pub(crate) fn run(arguments: &SunHours, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let rules = rules(&arguments.rule)?;
    if !arguments.when.is_given() && rules.is_empty() {
        return Err(Usage("say when: --date DAY, --from and --to, or --rule NAME".to_owned()).into());
    }
    arguments.when.check(&arguments.sun)?;
    let params = arguments.when.params(&arguments.sun)?;
    if let Some(keep) = &arguments.keep {
        check_output("--save-matrix", keep, &["npz"])?;
        check_distinct(arguments.outputs.output.iter().chain([keep]))?;
    }
    if arguments.trees.is_given() && (arguments.keep.is_some() || arguments.from_matrix.is_some()) {
        let what = "--through-trees: a matrix keeps what all balls hide, trees with the rest; leave out --save-matrix and --load-matrix";
        return Err(Usage(what.to_owned()).into());
    }
    let kept = arguments.from_matrix.as_deref().map(read_matrix).transpose()?;
    let suns = match (&kept, arguments.within) {
        (Some(kept), degrees) => Suns::Among(&kept.directions, degrees.unwrap_or(1.0).to_radians()),
        (None, None) => Suns::Of(Binning::Auto),
        (None, Some(0.0)) => Suns::Of(Binning::Exact),
        (None, Some(degrees)) => Suns::Of(Binning::Within(degrees.to_radians())),
    };
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut stages, &mut summary)?;
    let site = arguments.sun.site(&scene, &mut summary)?;
    let plan = Plan::new(arguments, &site, rules, &params, &suns, &mut summary)?;
    let targets = arguments.places.targets(&mut scene, global.seed, &mut stages, &mut summary)?;
    let trees = arguments.trees.of(&scene, &matrix_params(&scene, arguments), &mut summary)?;
    let matrix = match kept {
        Some(kept) => {
            let scene_number = matrix_scene(&scene, arguments);
            taken(kept, &targets, scene_number)?
        }
        None => look(arguments, &scene, &plan, &targets, &mut stages, &mut summary)?,
    };
    let found = match &trees {
        None => stages.run("summing up", 0, |_| plan.sum_up(&matrix, &targets))?,
        Some(trees) => {
            let opaque = stages.run("looking through trees", targets.positions.len(), |progress| {
                visibility_matrix(&trees.opaque, &targets.positions, &plan.directions, progress)
            })?;
            stages.run("summing up", 0, |_| plan.sum_up_through(&matrix, &opaque, trees, &site, &targets))?
        }
    };
    let columns = found.columns(&plan, &targets);
    let measures: Vec<Measure<'_>> = columns.iter().map(Column::measure).collect();
    summary.add("sun", targets.told(&measures));
    let title = format!("Sun hours, {}", plan.told);
    targets.write(&arguments.outputs, &measures, &title, &mut stages, &mut summary)?;
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

/// What each place sees of the directions, kept where that is asked for.
fn look(
    arguments: &SunHours,
    scene: &Scene,
    plan: &Plan,
    targets: &SkyTargets,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<VisibilityMatrix> {
    let mut section = Summary::default();
    let profile = arguments.scene.profile.into();
    let (blockers, _) = blockers(scene, profile, &arguments.shell.giving_way(), Proving::Never, stages, &mut section)?;
    section.add("directions", plan.directions.len());
    summary.add("lines_of_sight", section);
    let matrix = stages.run("looking at the sun", targets.positions.len(), |progress| {
        visibility_matrix(&blockers, &targets.positions, &plan.directions, progress)
    })?;
    if let Some(keep) = &arguments.keep {
        let saved = SavedMatrix {
            origin: targets.frame().frame.origin,
            targets: targets.positions.clone(),
            directions: plan.directions.clone(),
            words: (0..matrix.target_count()).flat_map(|target| matrix.row(target)).copied().collect(),
            scene: matrix_scene(scene, arguments),
        };
        stages.run("keeping what is seen", 0, |_| write_matrix(keep, &saved))?;
        summary.add("kept", keep.display().to_string());
    }
    Ok(matrix)
}

/// How balls block.
fn matrix_params(scene: &Scene, arguments: &SunHours) -> BlockRule {
    scene_params(scene, arguments.scene.profile.into(), &arguments.shell.giving_way())
}

/// The number by which a matrix knows the balls that it was made of.
fn matrix_scene(scene: &Scene, arguments: &SunHours) -> u64 {
    scene_fingerprint(scene.model.balls(), &matrix_params(scene, arguments))
}

/// The bits that were kept, if they belong to these places and balls.
fn taken(kept: SavedMatrix, targets: &SkyTargets, scene: u64) -> Result<VisibilityMatrix> {
    if kept.scene != scene {
        bail!(
            "--load-matrix: it was made of other balls, or with another --shell or --ball-profile; make it again with --save-matrix"
        );
    }
    let same = |a: &[f32; 3], b: &[f32; 3]| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
    let check_distinct = kept.origin == targets.frame().frame.origin
        && kept.targets.len() == targets.positions.len()
        && kept.targets.iter().zip(&targets.positions).all(|(a, b)| same(a, b));
    if !check_distinct {
        bail!(
            "--load-matrix: it was made for {} other places; ask with the flags of places it was kept with, or make it again with --save-matrix",
            kept.targets.len()
        );
    }
    Ok(VisibilityMatrix::from_words(kept.targets.len(), kept.directions.len(), kept.words)?)
}

/// Which directions stand for suns.
enum Suns<'a> {
    Of(Binning),
    /// These, each for suns within an angle.
    Among(&'a [[f64; 3]], f64),
}

fn rules(typed: &[String]) -> Result<Vec<(&'static str, SunRule)>> {
    let mut own = OWN_RULES.into_iter();
    let mut rules: Vec<(&'static str, SunRule)> = Vec::new();
    for text in typed {
        let rule = flagged("--rule", SunRule::parse(text))?;
        let column = match SunRule::columns().find(|(name, _)| *name == rule.name) {
            Some((_, column)) => Some(column),
            None => own.next(),
        };
        let Some(column) = column else {
            return Err(Usage(format!("--rule: {} rules of one's own at most", OWN_RULES.len())).into());
        };
        if rules.iter().any(|(_, other)| other.name == rule.name) {
            return Err(Usage(format!("--rule {text}: given twice")).into());
        }
        rules.push((column, rule));
    }
    Ok(rules)
}

/// Suns to look at, and what they are for.
struct Plan {
    /// What results are about.
    main: SunSchedule,
    /// Column, rule, schedule and first direction of each rule.
    rules: Vec<(&'static str, SunRule, SunSchedule, usize)>,
    /// All directions, those of `main` first.
    directions: Vec<[f64; 3]>,
    /// The days in a few words.
    told: String,
}

impl Plan {
    fn new(
        arguments: &SunHours,
        site: &Site,
        rules: Vec<(&'static str, SunRule)>,
        params: &DayParams,
        suns: &Suns<'_>,
        summary: &mut Summary,
    ) -> Result<Self> {
        let when = &arguments.when;
        let zone = arguments.sun.zone(site, &when.times())?;
        let schedule = |period: &Period, params: &DayParams| {
            let days =
                flagged("--time-step-min, --min-sun-elevation or --from", sun_days(site, &zone, period, params))?;
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
            let schedule = schedule(&Period::Days(dates), &DayParams { least_elevation, ..*params })?;
            of_rules.push((column, rule, schedule, 0));
        }
        let main = match (when.period(&arguments.sun, site, &zone)?, of_rules.first()) {
            (Some(period), _) => schedule(&period, params)?,
            (None, Some((.., first, _))) => first.clone(),
            (None, None) => return Err(Usage("say when: --date, --from and --to, or --rule".to_owned()).into()),
        };
        let mut directions = main.directions.clone();
        for (.., schedule, first) in &mut of_rules {
            // directions that were kept are those of all
            let is_main = *schedule == main || matches!(suns, Suns::Among(..));
            *first = if is_main { 0 } else { directions.len() };
            if !is_main {
                directions.extend(&schedule.directions);
            }
        }
        let told = told(&main, &zone);
        summary.add("when", figures(&main, &zone, params, &of_rules));
        Ok(Self { main, rules: of_rules, directions, told })
    }

    fn sum_up(&self, matrix: &VisibilityMatrix, targets: &SkyTargets) -> belvedere::Result<Sums> {
        let normals = targets.normals.as_deref();
        self.sums(&|schedule, params| sun_hours(matrix, schedule, normals, params))
    }

    /// The same with trees that let a share of the sun through, each day its own: `opaque` is what the rest leaves free.
    fn sum_up_through(
        &self,
        matrix: &VisibilityMatrix,
        opaque: &VisibilityMatrix,
        trees: &TreeLight,
        site: &Site,
        targets: &SkyTargets,
    ) -> belvedere::Result<Sums> {
        let normals = targets.normals.as_deref();
        self.sums(&|schedule, params| {
            let share = |day: &DayOfLight| trees.share(Some((day_of_year(day.date), site.latitude)));
            let shares: Vec<f64> = schedule.days.iter().map(share).collect();
            sun_hours_through_crowns(matrix, opaque, schedule, normals, params, &shares)
        })
    }

    fn sums(&self, of: &dyn Fn(&SunSchedule, &SunHoursParams) -> belvedere::Result<Found>) -> belvedere::Result<Sums> {
        let main = of(&self.main, &SunHoursParams::default())?;
        let of_rule = |(_, rule, schedule, first): &(_, SunRule, SunSchedule, usize)| {
            of(schedule, &SunHoursParams { first_direction: *first, sufficient_hours: rule.hours })
        };
        Ok(Sums { main, rules: self.rules.iter().map(of_rule).collect::<belvedere::Result<_>>()? })
    }
}

fn told(schedule: &SunSchedule, zone: &Zone) -> String {
    let [first, last] = [schedule.days.first(), schedule.days.last()].map(|day| day.map(|day| day.date.to_string()));
    let (first, last) = (first.unwrap_or_default(), last.unwrap_or_default());
    let days = if first == last { first } else { format!("{first} to {last}, mean of days") };
    format!("{days} ({})", zone.name())
}

fn figures(
    main: &SunSchedule,
    zone: &Zone,
    params: &DayParams,
    rules: &[(&'static str, SunRule, SunSchedule, usize)],
) -> Summary {
    let mut section = Summary::default();
    let count = main.days.len().max(1) as f64;
    let [first, last] = [main.days.first(), main.days.last()].map(|day| day.map(|day| day.date.to_string()));
    section
        .add("first_day", first.unwrap_or_default())
        .add("last_day", last.unwrap_or_default())
        .add("days", main.days.len())
        .add("clocks", zone.name())
        .add("step_min", rounded(params.step / 60.0, 3))
        .add("suns", main.days.iter().map(|day| day.steps.len()).sum::<usize>())
        .add("directions", main.directions.len())
        .add("possible_hours_a_day", rounded(main.possible_hours() / count, 3));
    if main.greatest_error > 0.0 {
        section
            .add("directions_off_at_most_deg", rounded(main.greatest_error.to_degrees(), 3))
            .add("directions_off_rms_deg", rounded(main.rms_error.to_degrees(), 3));
    }
    for (column, rule, schedule, _) in rules {
        section.add(column, format!("{} on {} days", rule.description, schedule.days.len()));
    }
    section
}

/// Statistics of the days and of each rule.
struct Sums {
    main: Found,
    rules: Vec<Found>,
}

/// A measure with its values.
struct Column {
    name: &'static str,
    description: &'static str,
    range: Option<[f64; 2]>,
    values: Vec<f32>,
}

impl Column {
    fn measure(&self) -> Measure<'_> {
        Measure { name: self.name, description: self.description, decimals: 3, range: self.range, values: &self.values }
    }
}

impl Sums {
    /// All figures as columns, with no value where there is no place to ask about.
    fn columns(self, plan: &Plan, targets: &SkyTargets) -> Vec<Column> {
        let is_several = plan.main.days.len() > 1;
        let most = plan.main.days.iter().map(|day| day.possible_hours).fold(0.0, f64::max);
        let hours = Some([0.0, most.max(0.1)]);
        let clock = Some([0.0, 24.0]);
        let mut columns = vec![
            Column { name: "sun_hours", description: "hours of sun a day", range: hours, values: self.main.hours },
            Column {
                name: "sun_share",
                description: "share of possible sun",
                range: Some([0.0, 1.0]),
                values: self.main.share,
            },
            Column {
                name: "first_light",
                description: "first sun, hour of the day",
                range: clock,
                values: self.main.first,
            },
            Column {
                name: "last_light",
                description: "last sun, hour of the day",
                range: clock,
                values: self.main.last,
            },
            Column {
                name: "longest",
                description: "longest sun on end, hours",
                range: hours,
                values: self.main.longest,
            },
        ];
        if is_several {
            let days = plan.main.days.len() as f32;
            let total = columns[0].values.iter().map(|hours| hours * days).collect();
            columns.push(Column {
                name: "least_day",
                description: "hours on the darkest day",
                range: hours,
                values: self.main.least,
            });
            columns.push(Column {
                name: "total_hours",
                description: "hours of sun in all",
                range: None,
                values: total,
            });
        }
        for ((name, _, schedule, _), found) in plan.rules.iter().zip(self.rules) {
            let passes = found.days.iter().map(|&days| if days as usize == schedule.days.len() { 1.0 } else { 0.0 });
            columns.push(Column {
                name,
                description: "rule is met",
                range: Some([0.0, 1.0]),
                values: passes.collect(),
            });
        }
        for column in &mut columns {
            for (value, position) in column.values.iter_mut().zip(&targets.positions) {
                if !position.iter().all(|v| v.is_finite()) {
                    *value = f32::NAN;
                }
            }
        }
        columns
    }
}
