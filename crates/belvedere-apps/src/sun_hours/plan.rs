//! Suns of a period and of rules, computed together, and the measures that follow.

use super::{RULE_IS_MET, SUN_HOURS, SunHours, SunHoursParams, SunRule, sun_hours, sun_hours_through_crowns};
use crate::rows::{RowBlock, SkyObstacles, check_normals, fold_rows, normals_of};
use crate::sum_errors::{Intervals, Outlines, SumKind, expected_measures};
use crate::sun::{Date, Site, SunSchedule};
use crate::targets::{Measure, ResultKind, Targets};
use crate::tree_light::{CrownLight, Season};
use belvedere_data::control::Control;
use belvedere_data::{Error, Result};

/// A rule with its own suns.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedRule {
    /// Name of its column.
    pub column: String,
    /// The rule.
    pub rule: SunRule,
    /// The suns of its days.
    pub schedule: SunSchedule,
    first_direction: usize,
}

/// The requested results about the sun: hours over a period, and rules.
#[derive(Clone, Debug, PartialEq)]
pub struct SunPlan {
    period: SunSchedule,
    rules: Vec<PlannedRule>,
    directions: Vec<[f64; 3]>,
}

impl SunPlan {
    /// A plan for the suns of `period` and of `rules`, each with the name of its column and its suns. Rules whose
    /// directions are those of the period share them.
    #[must_use]
    pub fn new(period: SunSchedule, rules: Vec<(String, SunRule, SunSchedule)>) -> Self {
        let mut directions = period.directions.clone();
        let rules = rules
            .into_iter()
            .map(|(column, rule, schedule)| {
                let is_shared = schedule.directions == period.directions;
                let first_direction = if is_shared { 0 } else { directions.len() };
                if !is_shared {
                    directions.extend(&schedule.directions);
                }
                PlannedRule { column, rule, schedule, first_direction }
            })
            .collect();
        Self { period, rules, directions }
    }

    /// The suns of the period.
    #[must_use]
    pub fn period(&self) -> &SunSchedule {
        &self.period
    }

    /// The rules.
    #[must_use]
    pub fn rules(&self) -> &[PlannedRule] {
        &self.rules
    }

    /// All dates, those of the period first.
    pub fn dates(&self) -> impl Iterator<Item = Date> {
        let schedules = std::iter::once(&self.period).chain(self.rules.iter().map(|rule| &rule.schedule));
        schedules.flat_map(|schedule| schedule.days.iter().map(|day| day.date))
    }

    /// Directions for which targets are tested, unit vectors, (D, 3): those of the period first.
    #[must_use]
    pub fn directions(&self) -> &[[f64; 3]] {
        &self.directions
    }
}

/// The sun of a plan at targets, summed up block after block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SunSums {
    /// Over the days of the period.
    pub period: SunHours,
    /// Over the days of each rule.
    pub rules: Vec<SunHours>,
    /// Error classes of the hours of the period; empty if not requested.
    pub classes: Vec<u8>,
}

impl SunSums {
    /// Adds the targets of `block`, whose columns are the directions of `plan` and which follow those added before.
    /// `normals`, (M, 3), are those of all targets. If `block` has a matrix without trees, `crowns` with the site give
    /// the share of the light of each day that trees let through.
    ///
    /// # Errors
    /// Those of [`sun_hours`] and [`sun_hours_through_crowns`].
    pub fn add(
        &mut self,
        plan: &SunPlan,
        block: &RowBlock<'_>,
        normals: Option<&[[f32; 3]]>,
        crowns: Option<(CrownLight, &Site)>,
    ) -> Result<()> {
        let normals = normals_of(normals, &block.rows);
        let of = |schedule: &SunSchedule, params: &SunHoursParams| match (&block.crowns, crowns) {
            (Some(_), Some((crowns, site))) => {
                let factors: Vec<f64> =
                    schedule.days.iter().map(|day| crowns.factor(Some(Season::on(day.date, site)))).collect();
                sun_hours_through_crowns(block, schedule, normals, params, &factors)
            }
            _ => sun_hours(&block.matrix, schedule, normals, params),
        };
        self.period.append(of(&plan.period, &SunHoursParams::default())?);
        self.rules.resize_with(plan.rules.len(), SunHours::default);
        for (sums, planned) in self.rules.iter_mut().zip(&plan.rules) {
            let SunRule { hours: sufficient_hours, counted, .. } = planned.rule;
            let params = SunHoursParams { first_direction: planned.first_direction, sufficient_hours, counted };
            sums.append(of(&planned.schedule, &params)?);
        }
        Ok(())
    }

    /// Converts all figures into measures of `targets`: `sun_hours`, `sun_share`, `first_light`, `last_light`,
    /// `longest`. Several days also have `min_sun_hours` and `total_hours`. Each rule has 1 if it is met on the days
    /// that it needs, otherwise 0.
    #[must_use]
    pub fn into_measures(self, plan: &SunPlan, targets: &Targets) -> Vec<Measure> {
        let max = plan.period.days.iter().map(|day| day.possible_hours).fold(0.0, f64::max);
        let hours = Some([0.0, max.max(0.1)]);
        let (clock, share) = (Some([0.0, 24.0]), Some([0.0, 1.0]));
        let measure = |name: &str, description, range, values| {
            Measure::new(name, values).with_description(description).with_decimals(3).with_range(range)
        };
        let day_count = plan.period.days.len();
        #[expect(clippy::cast_precision_loss, reason = "a few thousand days at most")]
        let of_all_days = |hours: &f32| hours * day_count as f32;
        let total: Vec<f32> =
            if day_count > 1 { self.period.hours.iter().map(of_all_days).collect() } else { Vec::new() };
        let mut measures = vec![
            measure("sun_hours", SUN_HOURS, hours, self.period.hours).with_unit("h"),
            measure("sun_share", "share of possible sun", share, self.period.share),
            measure("first_light", "first sun, hour of the day", clock, self.period.first).with_unit("h"),
            measure("last_light", "last sun, hour of the day", clock, self.period.last).with_unit("h"),
            measure("longest", "longest uninterrupted sun, hours", hours, self.period.longest).with_unit("h"),
        ];
        if day_count > 1 {
            measures.push(
                measure("min_sun_hours", "hours of the day with the least sun", hours, self.period.min).with_unit("h"),
            );
            measures.push(measure("total_hours", "hours of sun in all", None, total).with_unit("h"));
        }
        if let (Some(hours), false) = (measures.first(), self.classes.is_empty()) {
            let possible = plan.period.possible_hours() / day_count.max(1) as f64;
            measures.extend(expected_measures("hours", &hours.clone(), |_| possible, SumKind::Sun, &self.classes));
        }
        for (planned, found) in plan.rules.iter().zip(self.rules) {
            let days = planned.schedule.days.len();
            let is_met = |met: &u32| f32::from(u8::from(planned.rule.needed.are_met(*met as usize, days)));
            let is_met = found.days.iter().map(is_met).collect();
            measures.push(measure(&planned.column, RULE_IS_MET, share, is_met).with_kind(ResultKind::Answer));
        }
        measures.iter_mut().for_each(|measure| targets.clear_unasked(&mut measure.values));
        measures
    }
}

/// The sun of `plan` at each of `targets` among `obstacles`. Where trees let light through, `site` says when they carry
/// leaves. Progress counts targets, once or twice each.
///
/// # Errors
/// Those of [`fold_rows`] and [`SunSums::add`], and [`Error::MissingAttribute`] for trees without a site.
pub fn scene_sun_hours<'a>(
    obstacles: impl Into<SkyObstacles<'a>>,
    targets: &Targets,
    plan: &SunPlan,
    site: Option<&Site>,
    intervals: Intervals,
    control: &Control<'_>,
) -> Result<SunSums> {
    let obstacles = obstacles.into();
    let crowns = match (obstacles.crowns(), site) {
        (Some(crowns), Some(site)) => Some((crowns, site)),
        (None, _) => None,
        (Some(_), None) => {
            return Err(Error::MissingAttribute {
                attribute: "site",
                needed_for: "the season of trees",
                advice: "give the place on earth",
            });
        }
    };
    let normals = targets.normals.as_deref();
    check_normals(normals, targets.len())?;
    let mut sums = SunSums::default();
    let are_inside = intervals.are_inside(obstacles, targets, control)?;
    let outlines = are_inside
        .map(|are_inside| (are_inside, Outlines::new(&plan.period.directions, &plan.period.hours_of_directions())));
    // outlines are those of the first day
    let factor = match (crowns, plan.period.days.first()) {
        (Some((crowns, site)), Some(day)) => crowns.factor(Some(Season::on(day.date, site))),
        _ => 0.0,
    };
    fold_rows(obstacles, &targets.positions, plan.directions(), control, |block| {
        if let Some((are_inside, outlines)) = &outlines {
            sums.classes.extend(outlines.classes((&block, factor), are_inside, normals)?);
        }
        sums.add(plan, &block, normals, crowns)
    })?;
    Ok(sums)
}
