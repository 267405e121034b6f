//! `belvedere sun-hours`.

use super::sights::{Proving, blockers};
use super::sky_targets::{Measure, SkyTargets};
use crate::arguments::{Global, SunHours, Usage};
use crate::pipeline::{self, Points, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::sun::{Binning, DayParams, Period, Site, SunSchedule, Zone, sun_days};
use belvedere::apps::sun_hours::{SunHours as Found, SunHoursParams, SunRule, sun_hours};
use belvedere::query::{VisibilityMatrix, visibility_matrix};

/// Names of the columns of rules of one's own, in the order given.
const OWN_RULES: [&str; 8] = ["rule_1", "rule_2", "rule_3", "rule_4", "rule_5", "rule_6", "rule_7", "rule_8"];

pub(crate) fn run(arguments: &SunHours, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let rules = rules(&arguments.rule)?;
    if !arguments.when.is_given() && rules.is_empty() {
        return Err(Usage("say when: --date DAY, --from and --to, or --rule NAME".to_owned()).into());
    }
    let params = arguments.when.params(&arguments.sun)?;
    let binning = match arguments.within {
        None => Binning::Auto,
        Some(0.0) => Binning::Exact,
        Some(degrees) => Binning::Within(degrees.to_radians()),
    };
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let points = if arguments.places.needs_points() { Points::Keep } else { Points::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut stages, &mut summary)?;
    let site = arguments.sun.site(&scene, &mut summary)?;
    let plan = Plan::new(arguments, &site, rules, &params, binning, &mut summary)?;
    let targets = arguments.places.targets(&mut scene, global.seed, &mut stages, &mut summary)?;
    let mut section = Summary::default();
    let profile = arguments.scene.profile.into();
    let (blockers, _) = blockers(&scene, profile, &arguments.giving_way, Proving::Never, &mut stages, &mut section)?;
    section.add("directions", plan.directions.len());
    summary.add("lines_of_sight", section);
    let matrix = stages.run("looking at the sun", targets.positions.len(), |progress| {
        visibility_matrix(&blockers, &targets.positions, &plan.directions, progress)
    })?;
    let found = stages.run("summing up", 0, |_| plan.sum_up(&matrix, &targets))?;
    let columns = found.columns(&plan, &targets);
    let measures: Vec<Measure<'_>> = columns.iter().map(Column::measure).collect();
    summary.add("sun", targets.told(&measures));
    let title = format!("Sun hours, {}", plan.told);
    targets.write(&arguments.outputs, &measures, &title, &mut stages, &mut summary)?;
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
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
        binning: Binning,
        summary: &mut Summary,
    ) -> Result<Self> {
        let when = &arguments.when;
        let zone = arguments.sun.zone(site, &when.times())?;
        let schedule = |period: &Period, params: &DayParams| {
            let days = flagged("--step, --least-elevation or --from", sun_days(site, &zone, period, params))?;
            flagged("--within", SunSchedule::new(&days, binning))
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
            let is_main = *schedule == main;
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
        let main = sun_hours(matrix, &self.main, normals, &SunHoursParams::default())?;
        let of_rule = |(_, rule, schedule, first): &(_, SunRule, SunSchedule, usize)| {
            let params = SunHoursParams { first_direction: *first, sufficient_hours: rule.hours };
            sun_hours(matrix, schedule, normals, &params)
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
