//! Sun calendars: from when to when the sun shines at windows and places, and what shades them otherwise.

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::places::{Places, test_edge};
use super::scene::Scene;
use super::sections::{LinesSection, MeasuresSection, PeriodSection, PlacesReport};
use super::seen_kinds::kinds_of_balls;
use super::sun::{Days, sun_days_above};
use super::sun_hours::{days_in_words, days_of_rule, missing_period, remark_on_hours_of_rules};
use super::sun_place::SunPlace;
use super::windows::GivenWindows;
use crate::sun::{Binning, Date, Site, SunSchedule, Zone};
use crate::sun_calendar::{CalendarDay, SunObstacle, SunStretch, sun_calendars};
use crate::sun_hours::SunRule;
use crate::targets::{Measure, Targets, Window};
use crate::window_views::{ClassMeanings, SeenKind};
use belvedere_core::query::UnprovenAs;
use belvedere_data::control::Control;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Default time between two suns, minutes: starts and ends are known to half of it.
const TIME_STEP_MIN: f64 = 2.0;

/// Sun and shade at windows or places through days.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SunCalendarQuestion {
    /// The windows, of which the middle counts; without any, the question is about its places.
    #[serde(skip)]
    pub windows: GivenWindows,
    /// The days. Two minutes between suns unless they say otherwise.
    pub days: Days,
    /// Daylight rule whose days and hours are listed in place of days.
    pub rule: Option<String>,
    /// Location on earth, clock, and the north of azimuths of windows.
    pub place: SunPlace,
    /// Meanings of classes of points that differ from ASPRS.
    pub classes: Vec<(u8, SeenKind)>,
    /// True to list the days without trees, too.
    pub without_trees: bool,
}

/// Calendars of windows or places.
#[derive(Clone, Debug)]
pub struct SunCalendarResults {
    /// The windows, with azimuths from grid north; empty for places.
    pub windows: Vec<Window>,
    /// The targets.
    pub targets: Arc<Targets>,
    /// True near the edge of the cloud; `None` if that is not known.
    pub near_edge: Vec<Option<bool>>,
    /// The suns.
    pub schedule: SunSchedule,
    /// The rule, where one was given.
    pub rule: Option<SunRule>,
    /// Clock of the hours.
    pub zone: Zone,
    /// Location on earth.
    pub site: Site,
    /// Days of each target.
    pub days: Vec<Vec<CalendarDay>>,
    /// The same without trees; `None` unless wanted, and where trees are not known.
    pub without_trees: Option<Vec<Vec<CalendarDay>>>,
    /// Kind of each ball of the model, (B).
    pub kinds: Vec<SeenKind>,
    /// Names of the meshes that were added.
    pub meshes: Vec<String>,
    /// Azimuth of grid north from the north of the question, clockwise, radians.
    pub grid_north: f64,
}

impl SunCalendarQuestion {
    /// This with two minutes between suns, unless a time is given.
    fn stepped(&self) -> Days {
        Days { time_step_min: self.days.time_step_min.or(Some(TIME_STEP_MIN)), ..self.days.clone() }
    }

    fn schedule(&self, scene: &Scene, context: &mut Context) -> Result<(SunSchedule, Option<SunRule>, Zone, Site)> {
        let days = self.stepped();
        let site = self.place.site(scene, context, None)?;
        let zone = self.place.clock(&site, days.times(), context)?;
        let params = days.params(&self.place);
        let rule = self.rule.as_deref().map(SunRule::parse).transpose()?;
        let (of_days, params) = match (&rule, days.period(&self.place, &site, &zone)?) {
            (Some(rule), _) => {
                context.add(remark_on_hours_of_rules([rule], &zone));
                days_of_rule(rule, &days, (&site, &zone), params)?
            }
            (None, Some(period)) => (sun_days_above(&site, &zone, &period, &params)?, params),
            (None, None) => return missing_period(),
        };
        let schedule = SunSchedule::new(&of_days, Binning::Exact)?;
        context.report.period = Some(PeriodSection::of(&schedule, &zone, &params));
        Ok((schedule, rule, zone, site))
    }

    /// Windows, or the places of the question.
    fn targets(
        &self,
        grid_north: f64,
        (scene, places): (&Scene, &Places),
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<(Arc<Targets>, Vec<Window>)> {
        if !matches!(places, Places::Scene) {
            return Ok((places.targets(scene, context, control)?, Vec::new()));
        }
        let middles = match &self.windows {
            GivenWindows::Each(each) if !each.is_empty() => {
                let mut middles = each.clone();
                middles.iter_mut().for_each(|window| window.size = None);
                GivenWindows::Each(middles)
            }
            GivenWindows::Each(_) => return refused("missing"),
            GivenWindows::Faces(_) => return refused("faces of a mesh"),
        };
        let mut found = middles.targets(scene.frame(), grid_north, (1.0, 0))?;
        found.leave_out_outside(scene, context)?;
        Ok((Arc::new(found.targets), found.windows))
    }
}

fn refused<T>(value: &str) -> Result<T> {
    Err(Error::invalid(Parameter::Targets, value, "windows one by one, or places"))
}

impl Ask for SunCalendarQuestion {
    type Found = SunCalendarResults;

    fn check(&self) -> Result<()> {
        if self.rule.as_deref().map(SunRule::parse).transpose()?.is_none() && self.days.is_empty() {
            return missing_period();
        }
        self.windows.check()?;
        self.days.check(&self.place)
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let (schedule, rule, zone, site) = self.schedule(scene, context)?;
        let north = self.place.north.of_scene(scene);
        let (targets, windows) = self.targets(north.of_grid, (scene, places), context, control)?;
        if !windows.is_empty() {
            context.north(&north);
        }
        let near_edge = test_edge(scene, &targets, &schedule.directions, context, control)?;
        let meanings = self.classes.iter().fold(ClassMeanings::default(), |all, &(class, seen)| all.with(class, seen));
        let kinds = kinds_of_balls(scene, &meanings, context)?;
        let blockers = scene.blockers(UnprovenAs::Reported, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, Some(schedule.directions.len())));
        let days = control
            .stage("testing sun", targets.len(), || sun_calendars(&blockers, &targets, &kinds, &schedule, control))?;
        let vegetation = scene.model().vegetation();
        let without_trees = match self.without_trees && vegetation.len() == kinds.len() {
            true => {
                let without = scene.without_vegetation(control)?;
                let rest = kinds.iter().zip(vegetation).filter(|(_, is_tree)| !**is_tree);
                let rest: Vec<SeenKind> = rest.map(|(kind, _)| *kind).collect();
                Some(control.stage("testing sun without trees", targets.len(), || {
                    sun_calendars(&without, &targets, &rest, &schedule, control)
                })?)
            }
            false => None,
        };
        let meshes = scene.model().added().map(|added| added.names().to_vec()).unwrap_or_default();
        let found = SunCalendarResults {
            windows,
            targets,
            near_edge,
            schedule,
            rule,
            zone,
            site,
            days,
            without_trees,
            kinds,
            meshes,
            grid_north: north.of_grid,
        };
        let measures = found.measures();
        found.summarise(&measures, context);
        Ok(Answers::new(found, measures))
    }
}

impl SunCalendarResults {
    /// Hours a day of sun, and of shade by each obstacle, the mean of the days.
    fn measures(&self) -> Vec<Measure> {
        let count = self.schedule.days.len().max(1) as f64;
        let mean = |counts: &dyn Fn(SunObstacle) -> bool| -> Vec<f32> {
            let of_target = |(row, days): (usize, &Vec<CalendarDay>)| match self.targets.is_target(row) {
                true => to_f32(days.iter().map(|day| day.hours(counts)).sum::<f64>() / count),
                false => f32::NAN,
            };
            self.days.iter().enumerate().map(of_target).collect()
        };
        let is_else = |obstacle: SunObstacle| match obstacle {
            SunObstacle::Seen(kind) => !matches!(kind, SeenKind::Building | SeenKind::Vegetation),
            _ => obstacle == SunObstacle::Terrain,
        };
        let hours = |name: &str, description, counts: &dyn Fn(SunObstacle) -> bool| {
            Measure::new(name, mean(counts)).with_description(description).with_unit("h").with_decimals(3)
        };
        let seen = |kind| move |obstacle: SunObstacle| obstacle == SunObstacle::Seen(kind);
        vec![
            hours("sun_hours", "hours of sun a day", &|obstacle| obstacle == SunObstacle::None),
            hours("shade_of_buildings", "hours a day in the shade of buildings", &seen(SeenKind::Building)),
            hours("shade_of_trees", "hours a day in the shade of trees", &seen(SeenKind::Vegetation)),
            hours("shade_of_plan", "hours a day in the shade of added meshes", &|obstacle| {
                matches!(obstacle, SunObstacle::Mesh(_))
            }),
            hours("shade_of_others", "hours a day in the shade of ground and other things", &is_else),
            hours("behind_own_wall", "hours a day with the sun behind the wall", &|obstacle| {
                obstacle == SunObstacle::OwnWall
            }),
        ]
    }

    fn summarise(&self, measures: &[Measure], context: &mut Context) {
        let places = match self.windows.len() {
            0 => PlacesReport::in_words(&self.targets),
            1 => "1 window".to_owned(),
            count => format!("{count} windows"),
        };
        context.headline(format!("Sun calendar of {places}, {}", days_in_words(&self.schedule, &self.zone)));
        for measure in measures.iter().filter(|measure| measure.values.iter().any(|&hours| hours > 0.0)) {
            context.headline(format!("{}: {}", measure.description, spread(&measure.values, 2, "hours")));
        }
        context.report.measures = Some(MeasuresSection::of(&self.targets, measures));
    }

    /// All stretches with the row of their place and their date, in the order of places and time.
    pub fn stretches(&self) -> impl Iterator<Item = (usize, Date, &SunStretch)> {
        self.days.iter().enumerate().flat_map(|(place, days)| {
            let dated = self.schedule.days.iter().zip(days);
            dated.flat_map(move |(of_day, day)| day.0.iter().map(move |stretch| (place, of_day.date, stretch)))
        })
    }

    /// Name of the mesh that is an obstacle; `None` for other obstacles.
    #[must_use]
    pub fn mesh_name(&self, obstacle: SunObstacle) -> Option<&str> {
        let SunObstacle::Mesh(number) = obstacle else { return None };
        self.meshes.get(number).map(String::as_str)
    }
}
