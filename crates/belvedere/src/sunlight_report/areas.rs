//! Areas of a report: the share that meets a rule, and the shade that a plan adds.

use super::{ReportArea, ReportParams, add_remarks};
use crate::Result;
use crate::apps::ask::{self, Days, GridCells, Places, Remark, Scene, SunHoursQuestion};
use crate::apps::sun::{Date, SunSchedule};
use crate::apps::targets::{CellLevel, Measure, Targets};
use crate::control::Control;
use crate::polygon::is_inside;
use crate::query::{UnprovenAs, VisibilityMatrix};
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
    targets: Arc<Targets>,
    /// Suns of the days in detail that reach each cell.
    lit: VisibilityMatrix,
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
    pub(super) fn of(
        scene: &Scene,
        (area, params): (&ReportArea, &ReportParams),
        schedule: &SunSchedule,
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
        let lit = control.stage("testing sun of areas", targets.len(), || {
            blockers.visibility_matrix(&targets.positions, &schedule.directions, control)
        })?;
        let (share, hours) = (mean(answers.measures.last()), mean(answers.measures.first()));
        let outside = share_outside(scene, area, &targets);
        Ok(Self { share, hours, cells: targets.target_count(), outside, added: Vec::new(), targets, lit })
    }

    /// Compares this state with the one before, of the same cells: ground that a plan covers has no sun.
    pub(super) fn compare(&mut self, before: &Self, schedule: &SunSchedule) {
        let left = self.cells as f64 / before.cells as f64;
        let scaled = |value: f64| if self.cells == 0 { 0.0 } else { value * left };
        [self.share, self.hours] = [self.share, self.hours].map(scaled);
        let cells: Vec<usize> = (0..before.targets.len()).filter(|&cell| before.targets.is_target(cell)).collect();
        let lost = |direction: usize| {
            let loses = |&&cell: &&usize| before.lit.is_free(cell, direction) && !self.lit.is_free(cell, direction);
            cells.iter().filter(loses).count() as f64 / cells.len().max(1) as f64
        };
        let mut added = Vec::new();
        for day in &schedule.days {
            let mut of_day: Option<AddedShade> = None;
            for step in &day.steps {
                let share = lost(step.direction as usize);
                if share < MIN_SHARE {
                    continue;
                }
                let (start, end) = (step.start, step.start + step.hours);
                let none =
                    AddedShade { date: day.date, ends: [start, end], hours: 0.0, most: (0.0, start), area_hours: 0.0 };
                let found = of_day.get_or_insert(none);
                found.ends[1] = end;
                found.hours += step.hours;
                found.area_hours += share * f64::from(step.hours) * cells.len() as f64 * AREA_CELL * AREA_CELL;
                if share > found.most.0 {
                    found.most = (share, (start + end) / 2.0);
                }
            }
            added.extend(of_day);
        }
        self.added = added;
    }
}
