//! Hours of sun, and how much of the sky is seen.

use crate::errors::{exception, wrong};
use crate::scene::{Inner, Scene};
use crate::sun::Place;
use crate::targets::{Results, Wanted};
use crate::trees::Through;
use crate::work::run;
use belvedere::apps::rows::Obstacles;
use belvedere::apps::sky_view::{SKY_DIRECTIONS, SkyDirections, scene_sky_view};
use belvedere::apps::sun::{Binning, Date, DayParams, Period, Site, SunSchedule, Zone, parse_instant, sun_days};
use belvedere::apps::sun_hours::{RuleDays, SunPlan, SunRule, scene_sun_hours};
use belvedere::query::UnprovenAs;
use pyo3::prelude::*;
use std::sync::Arc;

/// Days, as Python gives them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Days {
    dates: Vec<String>,
    /// First and last day, or two times.
    between: Option<[String; 2]>,
    year: Option<i16>,
    /// Minutes between suns.
    step: Option<f64>,
    /// Degrees.
    min_sun_elevation: Option<f64>,
    /// Most angle between a sun and its direction, degrees.
    tolerance: Option<f64>,
}

impl Days {
    pub(crate) fn params(&self, place: &Place) -> PyResult<DayParams> {
        let usual = DayParams::default();
        let params = usual
            .with_step(self.step.map_or(usual.step, |minutes| minutes * 60.0))
            .with_least_elevation(self.min_sun_elevation.map_or(usual.least_elevation, f64::to_radians))
            .with_refraction(place.refraction()?);
        params.validate().map_err(exception)?;
        Ok(params)
    }

    /// The times among the days, which can say how clocks run.
    pub(crate) fn times(&self) -> Vec<String> {
        self.between.iter().flatten().cloned().collect()
    }

    /// Dates of a day such as `longest-day` or `2026-06-21`.
    fn dates_of(&self, text: &str, site: &Site, zone: &Zone) -> PyResult<Vec<Date>> {
        match RuleDays::parse(text) {
            Some(days) => self.dates_of_rule(days, site, zone),
            None => Ok(vec![Date::parse(text).map_err(exception)?]),
        }
    }

    fn dates_of_rule(&self, days: RuleDays, site: &Site, zone: &Zone) -> PyResult<Vec<Date>> {
        let Some(year) = self.year else {
            return Err(wrong("year", "missing", "these days have no year: give year=2026"));
        };
        days.dates(year, site, zone).map_err(exception)
    }

    pub(crate) fn period(&self, site: &Site, zone: &Zone) -> PyResult<Option<Period>> {
        if let Some([from, to]) = &self.between {
            return Ok(Some(match (Date::parse(from), Date::parse(to)) {
                (Ok(first), Ok(last)) if last < first => {
                    return Err(wrong("last day", &last.to_string(), "give the first day or a later one"));
                }
                (Ok(first), Ok(last)) => Period::Days(first.to(last).collect()),
                (Err(_), Err(_)) => {
                    let instant = |text: &str| parse_instant(text, None).map_err(exception);
                    Period::Between([instant(from)?, instant(to)?])
                }
                _ => return Err(wrong("period", &format!("{from} to {to}"), "give two days, or two times")),
            }));
        }
        let mut dates = Vec::new();
        for text in &self.dates {
            dates.extend(self.dates_of(text, site, zone)?);
        }
        Ok((!dates.is_empty()).then_some(Period::Days(dates)))
    }

    fn plan(&self, inner: &Inner, place: &Place, rules: &[String]) -> PyResult<(SunPlan, Site)> {
        let site = place.site(inner)?;
        let zone = place.zone(&site, &self.times())?;
        let params = self.params(place)?;
        let binning = match self.tolerance {
            None => Binning::Auto,
            Some(0.0) => Binning::Exact,
            Some(degrees) => Binning::Within(degrees.to_radians()),
        };
        let schedule = |period: &Period, params: &DayParams| {
            SunSchedule::new(&sun_days(&site, &zone, period, params).map_err(exception)?, binning).map_err(exception)
        };
        let mut of_rules = Vec::new();
        let mut own = 0;
        for text in rules {
            let rule = SunRule::parse(text).map_err(exception)?;
            let known = SunRule::columns().find(|(name, _)| *name == rule.name).map(|(_, column)| column.to_owned());
            let column = known.unwrap_or_else(|| {
                own += 1;
                format!("rule_{own}")
            });
            let dates = self.dates_of_rule(rule.days, &site, &zone)?;
            let least = self.min_sun_elevation.map_or(rule.least_elevation, f64::to_radians);
            let schedule = schedule(&Period::Days(dates), &params.with_least_elevation(least))?;
            of_rules.push((column, rule, schedule));
        }
        let main = match (self.period(&site, &zone)?, of_rules.first()) {
            (Some(period), _) => schedule(&period, &params)?,
            (None, Some((.., first))) => first.clone(),
            (None, None) => return Err(wrong("period", "missing", "give date, period or rule")),
        };
        Ok((SunPlan::new(main, of_rules), site))
    }
}

#[pymethods]
impl Scene {
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn sun_hours<'py>(
        &self,
        py: Python<'py>,
        days: Days,
        rules: Vec<String>,
        place: Place,
        targets: Wanted<'py>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Results<'py>> {
        let inner = Arc::clone(&self.0);
        let asked = targets.owned(py, &inner)?;
        let (plan, site) = days.plan(&inner, &place, &rules)?;
        let (measures, found) = run(py, progress, move |control| {
            let found = asked.targets(&inner, control)?;
            let targets = &found.targets;
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let trees = trees.of(&inner, control)?;
            let obstacles = Obstacles { scene: &scene, trees: trees.as_ref() };
            let looks = targets.len() * obstacles.matrix_count();
            let sums = control
                .stage("testing sun", looks, || scene_sun_hours(obstacles, targets, &plan, Some(&site), control))?;
            Ok((sums.into_measures(&plan, targets), found))
        })?;
        found.results(py, measures)
    }

    fn sky_view<'py>(
        &self,
        py: Python<'py>,
        directions: Option<usize>,
        patches: Option<&str>,
        targets: Wanted<'py>,
        trees: Through,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Results<'py>> {
        let sky = match patches {
            None => SkyDirections::even(directions.unwrap_or(SKY_DIRECTIONS)),
            Some("tregenza") => SkyDirections::patches(1),
            Some("reinhart") => SkyDirections::patches(2),
            Some(other) => return Err(wrong("patches", &format!("'{other}'"), "use 'tregenza' or 'reinhart'")),
        };
        let sky = sky.map_err(exception)?;
        let inner = Arc::clone(&self.0);
        let asked = targets.owned(py, &inner)?;
        let (seen, found) = run(py, progress, move |control| {
            let found = asked.targets(&inner, control)?;
            let targets = &found.targets;
            let scene = inner.blockers(UnprovenAs::Visible, control)?;
            let trees = trees.of(&inner, control)?;
            let obstacles = Obstacles { scene: &scene, trees: trees.as_ref() };
            let looks = targets.len() * obstacles.matrix_count();
            let seen = control.stage("testing sky", looks, || scene_sky_view(obstacles, targets, &sky, control))?;
            Ok((seen, found))
        })?;
        found.results(py, seen.into_measures())
    }
}
