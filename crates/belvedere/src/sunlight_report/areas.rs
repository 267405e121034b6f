//! Areas of a report: the share that meets a rule, and the shade that a plan adds.

use super::studies::{YearOfSun, hours_within};
use super::{ReportArea, ReportParams, add_remarks};
use crate::Result;
use crate::apps::ask::{self, Days, GridCells, Places, Remark, Scene, SunCalendarResults, SunHoursQuestion};
use crate::apps::sun::{Date, Site, SunSchedule, Zone};
use crate::apps::targets::{CellLevel, Measure, Targets};
use crate::control::Control;
use crate::polygon::is_inside;
use crate::query::{UnprovenAs, VisibilityMatrix};
use crate::vector::to_f32;
use std::sync::Arc;

/// Minutes between two suns of a rule in areas, which have many places.
const AREA_STEP_MIN: f64 = 10.0;
/// Side of the cells of areas, metres.
const AREA_CELL: f64 = 0.5;
/// Smallest share of an area whose shade is listed: one cell in a hundred.
const MIN_SHARE: f64 = 0.01;

/// Sun of an area in one state of the scene.
pub(super) struct AreaState {
    /// Share of the area that meets the rule, 0 to 1.
    pub(super) share: f64,
    /// Mean hours of sun a day on the days of the rule.
    pub(super) hours: f64,
    /// Number of cells on the ground.
    pub(super) cells: usize,
    /// Share of the area that lies outside of the survey, 0 to 1.
    pub(super) outside: f64,
    /// Shade that the plan adds on each day in detail; empty for the scene as it is.
    pub(super) added: Vec<AddedShade>,
    /// The sun of a year, where a study counts it and a plan is given.
    pub(super) year: Option<YearOfSun>,
    targets: Arc<Targets>,
    /// Suns of the days in detail that reach each cell.
    lit: VisibilityMatrix,
    /// Suns of a year that do.
    lit_in_year: Option<VisibilityMatrix>,
}

/// Suns whose shade counts.
pub(super) struct CountedSuns<'a> {
    schedule: &'a SunSchedule,
    /// Hours on the clock that count on each of its days.
    hours: Vec<[f64; 2]>,
    /// The suns of a year and their hours, where a study counts them.
    year: Option<(SunSchedule, Vec<[f64; 2]>)>,
}

impl<'a> CountedSuns<'a> {
    /// The suns of the days in detail, all day or in the hours of a study.
    pub(super) fn new(calendar: &'a SunCalendarResults, params: &ReportParams) -> Result<Self> {
        let clock: (&Site, &Zone) = (&calendar.site, &calendar.zone);
        let schedule = &calendar.schedule;
        let Some(study) = params.study else {
            let hours = vec![[f64::NEG_INFINITY, f64::INFINITY]; schedule.days.len()];
            return Ok(Self { schedule, hours, year: None });
        };
        let hours_of = |schedule: &SunSchedule| {
            schedule.days.iter().map(|day| study.hours(clock, day.date)).collect::<Result<Vec<_>>>()
        };
        let hours = hours_of(schedule)?;
        let year = match schedule.days.first() {
            Some(day) => study.year(clock, day.date.year(), params.days.params(&params.place))?,
            None => None,
        };
        let year = year.map(|schedule| Ok::<_, crate::Error>((hours_of(&schedule)?, schedule))).transpose()?;
        Ok(Self { schedule, hours, year: year.map(|(hours, schedule)| (schedule, hours)) })
    }
}

/// Shade that a plan adds to an area on a day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AddedShade {
    pub(super) date: Date,
    /// First and last time at which a hundredth of the area or more lost its sun, hours on the clock.
    pub(super) ends: [f32; 2],
    /// Hours with such a loss.
    pub(super) hours: f32,
    /// Greatest share of the area that lost its sun at one time, and that time.
    pub(super) most: (f64, f32),
    /// Sum of lost sun over the area, hours times square metres.
    pub(super) area_hours: f64,
}

/// Share of an area that does not lie over the cloud, 0 to 1.
fn share_outside(scene: &Scene, area: &ReportArea, targets: &Targets) -> f64 {
    let (Some(ground), Some(coverage)) = (targets.ground(), scene.model().coverage()) else { return 0.0 };
    let grid = ground.grid;
    let middles = (0..targets.len()).map(|cell| grid.center(cell % grid.width.max(1), cell / grid.width.max(1)));
    let within: Vec<[f64; 2]> = middles.filter(|middle| is_inside(&area.rings, *middle)).collect();
    let outside = within.iter().filter(|[x, y]| !coverage.holds_on_map([*x, *y, 0.0])).count();
    outside as f64 / within.len().max(1) as f64
}

impl AreaState {
    /// Area of its cells on the ground, m².
    pub(super) fn square_metres(&self) -> f64 {
        self.cells as f64 * AREA_CELL * AREA_CELL
    }

    pub(super) fn of(
        scene: &Scene,
        (area, params): (&ReportArea, &ReportParams),
        suns: &CountedSuns<'_>,
        remarks: &mut Vec<Remark>,
        control: &Control<'_>,
    ) -> Result<Self> {
        let corners = || area.rings.iter().flatten();
        let end = |pick: fn(f64, f64) -> f64, start| [0, 1].map(|axis| corners().map(|c| c[axis]).fold(start, pick));
        let cells = GridCells {
            cell: Some(AREA_CELL),
            level: CellLevel::Ground,
            bounds: Some((end(f64::min, f64::INFINITY), end(f64::max, f64::NEG_INFINITY))),
            within: area.rings.clone(),
            ..GridCells::default()
        };
        let step = params.days.time_step_min.or(Some(AREA_STEP_MIN));
        let question = SunHoursQuestion {
            days: Days { year: params.detailed_days().year, time_step_min: step, ..Days::default() },
            rules: vec![params.area_rule().to_owned()],
            place: params.place.clone(),
            ..SunHoursQuestion::default()
        };
        let answers = ask::ask(scene, &question, &Places::Cells(cells), control)?;
        add_remarks(remarks, &answers);
        let mean = |measure: Option<&Measure>| {
            let known = measure.into_iter().flat_map(|measure| &measure.values).filter(|value| value.is_finite());
            let values: Vec<f64> = known.map(|&value| value.into()).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let targets = answers.found.targets;
        let blockers = scene.blockers(UnprovenAs::Visible, control)?;
        let lit_by = |schedule: &SunSchedule| {
            control.stage("testing sun of areas", targets.len(), || {
                blockers.visibility_matrix(&targets.positions, &schedule.directions, control)
            })
        };
        let lit = lit_by(suns.schedule)?;
        let lit_in_year = suns.year.as_ref().map(|(schedule, _)| lit_by(schedule)).transpose()?;
        let (share, hours) = (mean(answers.measures.last()), mean(answers.measures.first()));
        let outside = share_outside(scene, area, &targets);
        let cells = targets.target_count();
        Ok(Self { share, hours, cells, outside, added: Vec::new(), year: None, targets, lit, lit_in_year })
    }

    /// Compares this state with the one before, of the same cells: ground that a plan covers has no sun.
    pub(super) fn compare(&mut self, before: &Self, suns: &CountedSuns<'_>) {
        let left = self.cells as f64 / before.cells as f64;
        let scaled = |value: f64| if self.cells == 0 { 0.0 } else { value * left };
        [self.share, self.hours] = [self.share, self.hours].map(scaled);
        let cells: Vec<usize> = (0..before.targets.len()).filter(|&cell| before.targets.is_target(cell)).collect();
        let area = cells.len() as f64 * AREA_CELL * AREA_CELL;
        let share = |is_so: &dyn Fn(usize) -> bool| {
            cells.iter().filter(|&&cell| is_so(cell)).count() as f64 / cells.len().max(1) as f64
        };
        let lost = |before: &VisibilityMatrix, after: &VisibilityMatrix, direction: usize| {
            share(&|cell| before.is_free(cell, direction) && !after.is_free(cell, direction))
        };
        let mut added = Vec::new();
        for (day, &hours) in suns.schedule.days.iter().zip(&suns.hours) {
            let mut of_day: Option<AddedShade> = None;
            for step in &day.steps {
                let ends = hours_within(hours, step.start, step.hours);
                if ends[0] >= ends[1] {
                    continue;
                }
                let share = lost(&before.lit, &self.lit, step.direction as usize);
                if share < MIN_SHARE {
                    continue;
                }
                let length = ends[1] - ends[0];
                let [start, end] = ends.map(to_f32);
                let none =
                    AddedShade { date: day.date, ends: [start, end], hours: 0.0, most: (0.0, start), area_hours: 0.0 };
                let found = of_day.get_or_insert(none);
                found.ends[1] = end;
                found.hours += to_f32(length);
                found.area_hours += share * length * area;
                if share > found.most.0 {
                    found.most = (share, (start + end) / 2.0);
                }
            }
            added.extend(of_day);
        }
        self.added = added;
        if let (Some((schedule, hours)), Some(was), Some(is)) = (&suns.year, &before.lit_in_year, &self.lit_in_year) {
            let share_lit = |direction: usize| share(&|cell| was.is_free(cell, direction));
            let share_lost = |direction: usize| lost(was, is, direction);
            self.year = Some(YearOfSun::of(schedule, hours, area, (share_lit, share_lost)));
        }
    }
}
