//! Sun hours: how long the sun reaches places on days, and whether rules of daylight are met.

mod hourly_sun;

pub use hourly_sun::HourlySun;

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::how_sure::{check_interval, check_interval_scene, knows_intervals};
use super::places::Places;
use super::remark::Remark;
use super::scene::{Scene, Whereabouts};
use super::sections::{MeasuresSection, NamedValues, PeriodSection, PlacesReport};
use super::sun::{Days, sun_days_above};
use super::sun_and_sky::{Light, OnTargets};
use super::sun_place::{SunPlace, remark_on_solar_hours};
use super::trees::{ThroughTrees, remark_on_leaves};
use crate::sum_errors::Intervals;
use crate::sun::{Binning, DayParams, Period, Site, SunDay, SunSchedule, Zone};
use crate::sun_hours::{SunPlan, SunRule, WindowClock, scene_sun_hours};
use crate::targets::{Measure, ResultKind};
use crate::tree_light::Season;
use belvedere_core::query::UnprovenAs;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Names of the columns of rules of one's own, in the order given.
const OWN_RULES: [&str; 8] = ["rule_1", "rule_2", "rule_3", "rule_4", "rule_5", "rule_6", "rule_7", "rule_8"];

/// Hours of sun at places.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SunHoursQuestion {
    /// The days; none for those of the first rule.
    pub days: Days,
    /// Rules of daylight, by name or as HOURS@DAYS.
    pub rules: Vec<String>,
    /// Location on earth, and clock.
    pub place: SunPlace,
    /// Maximum angle between a sun and the direction that is tested for it, degrees, 0 to 5; `None` for 0 up to 2000
    /// suns, else 1.
    pub sun_tolerance_deg: Option<f64>,
    /// Light through trees.
    pub trees: ThroughTrees,
    /// True to give the expected value of hours and an interval that holds 90 %. Only for opaque trees. Default: false.
    #[serde(default)]
    pub interval: bool,
}

/// The rules, each with the name of its column.
///
/// # Errors
/// [`Error::InvalidParameter`] for a rule that cannot be read, is given twice, and for more than eight of one's own.
pub fn rules(texts: &[String]) -> Result<Vec<(&'static str, SunRule)>> {
    let refused = |value: &str, expected| Err(Error::invalid(Parameter::Rule, value, expected));
    let mut own = OWN_RULES.into_iter();
    let mut rules: Vec<(&'static str, SunRule)> = Vec::new();
    for text in texts {
        let rule = SunRule::parse(text)?;
        let known = SunRule::columns().find(|(name, _)| *name == rule.name).map(|(_, column)| column);
        let Some(column) = known.or_else(|| own.next()) else {
            return refused(text, "one of at most 8 rules of your own");
        };
        if rules.iter().any(|(_, other)| other.name == rule.name) {
            return refused(text, "given once");
        }
        rules.push((column, rule));
    }
    Ok(rules)
}

impl SunHoursQuestion {
    fn binning(&self) -> Binning {
        match self.sun_tolerance_deg {
            None => Binning::Auto,
            Some(0.0) => Binning::Exact,
            Some(degrees) => Binning::Within(degrees.to_radians()),
        }
    }

    /// Returns the suns of the days and of the rules at a site, and its time zone.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] without days, and for values that are not possible.
    pub fn plan(&self, site: &Site) -> Result<(SunPlan, Zone)> {
        let zone = self.place.zone_at(site, self.days.times())?;
        let params = self.days.params(&self.place);
        let schedule = |period: &Period, params: &DayParams| {
            SunSchedule::new(&sun_days_above(site, &zone, period, params)?, self.binning())
        };
        let mut of_rules = Vec::new();
        for (column, rule) in rules(&self.rules)? {
            let (days, _) = days_of_rule(&rule, &self.days, (site, &zone), params)?;
            let schedule = SunSchedule::new(&days, self.binning())?;
            of_rules.push((column.to_owned(), rule, schedule));
        }
        let main = match (self.days.period(&self.place, site, &zone)?, of_rules.first()) {
            (Some(period), _) => schedule(&period, &params)?,
            (None, Some((.., first))) => first.clone(),
            (None, None) => return missing_period(),
        };
        Ok((SunPlan::new(main, of_rules), zone))
    }

    pub(super) fn title(&self, plan: &SunPlan, zone: &Zone, whereabouts: &Whereabouts<'_>) -> String {
        let days = days_in_words(plan.period(), zone);
        let of_rule = plan.rules().first().filter(|_| self.days.is_empty());
        let what = match of_rule {
            Some(first) => format!("Sun hours on the days of the rule {}", first.rule.name),
            None => "Sun hours".to_owned(),
        };
        format!("{what}, {days}{}", whereabouts.far_in_words())
    }
}

pub(super) fn missing_period<T>() -> Result<T> {
    Err(Error::invalid(Parameter::Period, "missing", "given as days, as two times, or by a rule"))
}

/// Returns the light that a rule counts on each of its days, and the parameters of their division: with its minimum
/// elevation, unless `days` have one.
pub(super) fn days_of_rule(
    rule: &SunRule,
    days: &Days,
    (site, zone): (&Site, &Zone),
    params: DayParams,
) -> Result<(Vec<SunDay>, DayParams)> {
    let min_elevation = days.min_sun_elevation_deg.map_or(rule.min_elevation, f64::to_radians);
    let params = params.with_min_elevation(min_elevation);
    let found = rule.sun_days(days.dates_of(rule.days, site, zone)?, site, zone, &params)?;
    if found.iter().all(|day| day.steps.is_empty()) {
        // says why there is no sun
        sun_days_above(site, zone, &Period::Days(found.iter().map(|day| day.date).collect()), &params)?;
    }
    Ok((found, params))
}

/// A warning of the first of `rules` that counts hours of a clock that is that of the sun.
pub(super) fn remark_on_hours_of_rules<'a>(
    rules: impl IntoIterator<Item = &'a SunRule>,
    zone: &Zone,
) -> Option<Remark> {
    let by_clock = |rule: &SunRule| rule.window.filter(|window| window.clock == WindowClock::Zone);
    let hours = rules.into_iter().find_map(by_clock).map(|window| window.hours);
    remark_on_solar_hours("the rule counts sun", hours, zone)
}

impl Ask for SunHoursQuestion {
    type Found = OnTargets;

    fn check(&self) -> Result<()> {
        if rules(&self.rules)?.is_empty() && self.days.is_empty() {
            return missing_period();
        }
        check_interval(self.interval, &self.trees)?;
        self.days.check(&self.place)
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        check_interval_scene(self.interval, scene, control)?;
        // a single place costs little more with its interval
        let is_single = matches!(places, Places::At(..));
        let has_interval = self.interval || is_single && !self.trees.is_light() && knows_intervals(scene, control)?;
        let site = self.place.site(scene, context, None)?;
        let (plan, zone) = self.plan(&site)?;
        context.add(self.place.remark_on_border(&site, self.days.times())?);
        let rules = plan.rules().iter().map(|planned| &planned.rule);
        context.add(remark_on_hours_of_rules(rules, &zone));
        context.report.period = Some(section(&plan, &zone, &self.days.params(&self.place)));
        let trees = (&self.trees, Some(site.latitude), UnprovenAs::Visible);
        let light = Light::resolve(places, plan.directions(), trees, scene, context, control)?;
        let seasons = plan.dates().map(|date| Some(Season::on(date, &site)));
        context.add(light.crowns().and_then(|crowns| remark_on_leaves(crowns, crowns.known_factors(seasons))));
        let targets = &light.targets;
        let sums = control.stage("testing sun", light.steps(), || {
            let intervals = Intervals::wanted(has_interval);
            scene_sun_hours(light.obstacles(), targets, &plan, Some(&site), intervals, control)
        })?;
        let measures = sums.into_measures(&plan, targets);
        context.report.measures = Some(MeasuresSection::of(targets, &measures));
        let title = self.title(&plan, &zone, &scene.whereabouts());
        summarise(&plan, &title, &measures, &PlacesReport::in_words(targets), context);
        Ok(Answers::new(light.titled(title), measures))
    }
}

/// Reports the hours, where they are the first measure, and whether each rule is met; the measures of rules are the
/// last.
pub(super) fn summarise(plan: &SunPlan, title: &str, measures: &[Measure], places: &str, context: &mut Context) {
    context.headline(format!("{title}: {places}"));
    let schedule = plan.period();
    let possible = schedule.possible_hours() / schedule.days.len().max(1) as f64;
    if let Some(hours) = measures.first().filter(|first| first.kind == ResultKind::Number) {
        let spread = spread(&hours.values, 2, "hours a day");
        context.headline(format!("sun hours: {spread}, of {possible:.2} possible"));
    }
    let of_rules = measures.len().saturating_sub(plan.rules().len());
    for (planned, measure) in plan.rules().iter().zip(&measures[of_rules..]) {
        let share = measure.statistics().map_or(f64::NAN, |found| 100.0 * found.mean);
        context.headline(format!("rule {}: met by {share:.1} %", planned.rule.name));
    }
}

/// The days of a schedule in a few words.
pub(super) fn days_in_words(schedule: &SunSchedule, zone: &Zone) -> String {
    let [first, last] = ends(schedule);
    let days = match &schedule.days[..] {
        [_] | [] => first,
        [_, _] => format!("mean of {first} and {last}"),
        days => format!("mean of {} days, {first} to {last}", days.len()),
    };
    format!("{days} ({})", zone.name())
}

/// Earliest and latest day.
fn ends(schedule: &SunSchedule) -> [String; 2] {
    let dates = || schedule.days.iter().map(|day| day.date);
    [dates().min(), dates().max()].map(|date| date.map(|date| date.to_string()).unwrap_or_default())
}

fn section(plan: &SunPlan, zone: &Zone, params: &DayParams) -> PeriodSection {
    let rule = |planned: &crate::sun_hours::PlannedRule| {
        let text = format!("{} on {} days", planned.rule.description, planned.schedule.days.len());
        (planned.column.clone(), text)
    };
    let rules = NamedValues(plan.rules().iter().map(rule).collect());
    PeriodSection { rules, ..PeriodSection::of(plan.period(), zone, params) }
}
