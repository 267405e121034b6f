//! Glare: sun that panels and glass reflect to observers.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::observers::{Eyes, Observers, check_height};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{GlareSection, LinesSection, PeriodSection};
use super::sun::{Days, sun_days_above};
use super::sun_place::{SunPlace, remark_on_solar_hours};
use super::windows::{GivenWindow, with_number};
use crate::eyes::{EyeFault, fault_of};
use crate::glare::{EyeGlare, GlareParams, GlareStretch, Reflector, glare, glare_by_hour};
use crate::irradiance::{ClearSky, extraterrestrial};
use crate::result_columns::ResultColumn;
use crate::sun::{Binning, Date, Site, SunSchedule, Zone};
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::{MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::{clock_time, counted, rounded};
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Default time between two suns, minutes: glare of a house lasts some minutes a day.
const TIME_STEP_MIN: f64 = 1.0;

/// Sun that reflectors send to observers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GlareQuestion {
    /// The reflectors: rectangles with a size.
    #[serde(skip)]
    pub reflectors: Vec<GivenWindow>,
    /// Height above the ground of eyes without one, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// The days; a year without dates means all of it. A minute between suns unless they say otherwise.
    pub days: Days,
    /// Location on earth, clock, and the north of azimuths of reflectors.
    pub place: SunPlace,
    /// Angle by which reflectors spread a beam to each side, degrees, 0 to 11.4; `None` for 0.75.
    pub scatter_deg: Option<f64>,
    /// Minimum angle between a reflection and the sun itself, degrees, 0 to 180; `None` for 0.
    pub from_sun_deg: Option<f64>,
}

/// Glare of each observer.
#[derive(Clone, Debug)]
pub struct GlareResults {
    /// Observers.
    pub eyes: Eyes,
    /// Number of reflectors.
    pub reflector_count: usize,
    /// The suns.
    pub schedule: SunSchedule,
    /// Clock of the hours.
    pub zone: Zone,
    /// Glare of each observer; none for one that cannot look.
    pub of_observers: Vec<EyeGlare>,
}

/// Glare of a reflector, or of all of them, at an observer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GlareSummary {
    /// Hours of glare.
    pub hours: f64,
    /// Hours of glare that may leave an after-image.
    pub after_image_hours: f64,
    /// Hours of glare that are unproven.
    pub unproven_hours: f64,
    /// Number of days with glare.
    pub days: usize,
    /// Longest glare without a break, minutes.
    pub longest_min: f64,
    /// Maximum of a day, minutes.
    pub max_day_min: f64,
    /// Earliest and latest time of glare, hours on the clocks; `None` without glare.
    pub between: Option<[f64; 2]>,
    /// First and last day of the period with glare; `None` without glare.
    #[serde(skip)]
    pub dates: Option<[Date; 2]>,
}

impl GlareSummary {
    fn of(stretches: &[GlareStretch], schedule: &SunSchedule) -> Self {
        let sum = |hours: &dyn Fn(&GlareStretch) -> f32| {
            stretches.iter().fold(0.0, |sum: f64, one| sum + f64::from(hours(one)))
        };
        let of_days: Vec<&[GlareStretch]> = stretches.chunk_by(|a, b| a.day == b.day).collect();
        let of_day = |day: &&[GlareStretch]| day.iter().map(|stretch| f64::from(stretch.hours())).sum::<f64>();
        let date = |day: Option<&&[GlareStretch]>| Some(schedule.days.get(day?.first()?.day)?.date);
        let start = stretches.iter().map(|stretch| f64::from(stretch.start)).reduce(f64::min);
        let end = stretches.iter().map(|stretch| f64::from(stretch.end)).reduce(f64::max);
        let longest = stretches.iter().map(|stretch| f64::from(stretch.hours())).fold(0.0, f64::max);
        Self {
            hours: sum(&GlareStretch::hours),
            after_image_hours: sum(&|stretch| stretch.after_image),
            unproven_hours: sum(&|stretch| stretch.unproven),
            days: of_days.len(),
            longest_min: 60.0 * longest,
            max_day_min: 60.0 * of_days.iter().map(of_day).fold(0.0, f64::max),
            between: start.zip(end).map(|(start, end)| [start, end]),
            dates: date(of_days.first()).zip(date(of_days.last())).map(|(first, last)| [first, last]),
        }
    }
}

impl GlareQuestion {
    /// The days with a minute between suns, and a whole year where only that is given.
    fn stepped(&self) -> Days {
        let time_step_min = self.days.time_step_min.or(Some(TIME_STEP_MIN));
        let whole_year = || Some([format!("{}-01-01", self.days.year?), format!("{}-12-31", self.days.year?)]);
        let between = if self.days.is_empty() { whole_year() } else { self.days.between.clone() };
        Days { time_step_min, between, ..self.days.clone() }
    }

    fn params(&self) -> GlareParams {
        let usual = GlareParams::default();
        GlareParams {
            scatter: self.scatter_deg.map_or(usual.scatter, f64::to_radians),
            min_separation: self.from_sun_deg.map_or(usual.min_separation, f64::to_radians),
        }
    }

    fn schedule(&self, scene: &Scene, context: &mut Context) -> Result<(SunSchedule, Zone, Site)> {
        let days = self.stepped();
        let site = self.place.site(scene, context, None)?;
        let zone = self.place.clock(&site, days.times(), context)?;
        let params = days.params(&self.place);
        let Some(period) = days.period(&self.place, &site, &zone)? else { return missing_days() };
        let schedule = SunSchedule::new(&sun_days_above(&site, &zone, &period, &params)?, Binning::Exact)?;
        context.report.period = Some(PeriodSection::of(&schedule, &zone, &params));
        Ok((schedule, zone, site))
    }
}

fn missing_days<T>() -> Result<T> {
    Err(Error::invalid(Parameter::Period, "missing", "given as a year, as days, or as two times"))
}

impl Ask for GlareQuestion {
    type Found = GlareResults;

    fn check(&self) -> Result<()> {
        if self.reflectors.is_empty() {
            let expected = "at least one, with place, azimuth, tilt, width and height";
            return Err(Error::invalid(Parameter::Reflector, "missing", expected));
        }
        for (row, reflector) in self.reflectors.iter().enumerate() {
            let checked = reflector.check().and_then(|()| Reflector::of(&reflector.in_grid(0.0)));
            checked.map_err(|error| with_number((row, error)))?;
        }
        let days = self.stepped();
        if days.is_empty() {
            return missing_days();
        }
        check_height(self.observer_height)?;
        self.params().validate()?;
        days.check(&self.place)
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let (schedule, zone, site) = self.schedule(scene, context)?;
        let north = self.place.north.of_scene(scene);
        context.north(&north);
        let in_grid = |given: &GivenWindow| Reflector::of(&given.in_grid(north.of_grid));
        let reflectors = self.reflectors.iter().map(in_grid).collect::<Result<Vec<_>>>()?;
        context.add(remark_on_reflectors_outside(&self.reflectors, scene));
        let Observers { eyes, .. } =
            Observers::of(places, (self.observer_height, self.ground), scene, context, control)?;
        let blockers = scene.blockers(UnprovenAs::Reported, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, Some(schedule.directions.len())));
        let params = self.params();
        let direct = direct_radiation(&schedule, &site);
        context.add(remark_on_reflectors_inside(&reflectors, &blockers));
        let of_observers = control.stage("testing reflections", eyes.eyes.len() * reflectors.len(), || {
            glare(&blockers, (&eyes.eyes, &reflectors), (&schedule, &direct), &params, control)
        })?;
        let found = GlareResults { eyes, reflector_count: reflectors.len(), schedule, zone, of_observers };
        let all = (0..found.of_observers.len()).filter_map(|observer| found.of_observer(observer)?.between);
        let hours = all.reduce(|[from, to], [start, end]| [from.min(start), to.max(end)]);
        context.add(remark_on_solar_hours("glare is", hours.map(|v| v.map(|v| rounded(v, 2))), &found.zone));
        found.summarise(&params, context);
        Ok(Answers::new(found, Vec::new()))
    }
}

/// Direct radiation of a clear sky for each direction of a schedule, W/m².
fn direct_radiation(schedule: &SunSchedule, site: &Site) -> Vec<f64> {
    let mut direct = vec![0.0; schedule.directions.len()];
    for day in &schedule.days {
        let above = extraterrestrial(day.date.noon_utc());
        for step in &day.steps {
            let row = step.direction as usize;
            let zenith = schedule.directions[row][2].clamp(-1.0, 1.0).acos();
            direct[row] = ClearSky::default().irradiance(zenith, site.height, above).dni;
        }
    }
    direct
}

/// A warning of reflectors that lie beside the cloud, where nothing is known to block their light.
fn remark_on_reflectors_outside(reflectors: &[GivenWindow], scene: &Scene) -> Option<Remark> {
    let (low, high) = scene.model().bounds().corners();
    let is_beside = |given: &&GivenWindow| (0..2).any(|axis| !(low[axis]..=high[axis]).contains(&given.place[axis]));
    let count = reflectors.iter().filter(is_beside).count();
    let text = format!(
        "{count} of {} reflectors lie beside the cloud, where nothing is known to block their light: are their places in \
         the coordinates of the cloud?",
        reflectors.len()
    );
    (count > 0).then(|| Remark::warning("reflectors-outside", text).with("count", count as f64))
}

/// A warning of reflectors in an obstacle, such as the wall that they belong to: no light leaves them.
fn remark_on_reflectors_inside(reflectors: &[Reflector], scene: &MedialScene) -> Option<Remark> {
    let is_inside =
        |reflector: &&Reflector| matches!(fault_of(scene, None, reflector.front()), Some(EyeFault::InsideObstacle(_)));
    let count = reflectors.iter().filter(is_inside).count();
    let text = format!(
        "the middle of {count} of {} reflectors lies inside an obstacle, such as the wall behind it: no light leaves it; \
         move it outward",
        reflectors.len()
    );
    (count > 0).then(|| Remark::warning("reflectors-inside-obstacle", text).with("count", count as f64))
}

impl GlareResults {
    /// Glare of a pair; `None` for an observer that cannot look.
    #[must_use]
    pub fn of_pair(&self, observer: usize, reflector: usize) -> Option<GlareSummary> {
        let stretches = self.of_observers.get(observer)?.of_reflectors.get(reflector)?;
        self.can_look(observer).then(|| GlareSummary::of(stretches, &self.schedule))
    }

    /// Glare of an observer, of all reflectors together; `None` for one that cannot look.
    #[must_use]
    pub fn of_observer(&self, observer: usize) -> Option<GlareSummary> {
        let stretches = &self.of_observers.get(observer)?.of_any;
        self.can_look(observer).then(|| GlareSummary::of(stretches, &self.schedule))
    }

    fn can_look(&self, observer: usize) -> bool {
        self.eyes.eyes.get(observer).is_some_and(|eye| eye[0].is_finite())
    }

    /// A row for each pair, and with several reflectors one for each observer with reflector 0: all of them together.
    /// `names` are those of the reflectors, where they have some.
    #[must_use]
    pub fn columns(&self, names: &[String]) -> Vec<ResultColumn> {
        let together = (self.reflector_count > 1).then_some(None);
        let of_observer = |observer: usize| {
            (0..self.reflector_count).map(Some).chain(together).map(move |reflector| (observer, reflector))
        };
        let rows: Vec<(usize, Option<usize>)> = (0..self.of_observers.len()).flat_map(of_observer).collect();
        let summaries: Vec<Option<GlareSummary>> = rows
            .iter()
            .map(|&(observer, reflector)| match reflector {
                Some(reflector) => self.of_pair(observer, reflector),
                None => self.of_observer(observer),
            })
            .collect();
        let real = |name: &str, of: &dyn Fn(&GlareSummary) -> f64, decimals| {
            ResultColumn::real(name, summaries.iter().map(|one| one.as_ref().map_or(f64::NAN, of)), decimals)
        };
        let clock = |name: &str, end: usize| {
            let hour = |one: &Option<GlareSummary>| one.and_then(|one| one.between).map_or(f64::NAN, |ends| ends[end]);
            ResultColumn::clock(name, summaries.iter().map(hour))
        };
        let day = |name: &str, end: usize| {
            let date = |one: &Option<GlareSummary>| {
                one.and_then(|one| one.dates).map_or_else(String::new, |dates| dates[end].to_string())
            };
            ResultColumn::words(name, summaries.iter().map(date))
        };
        let name = |&(_, reflector): &(usize, Option<usize>)| match reflector {
            Some(reflector) => names.get(reflector).cloned().unwrap_or_default(),
            None => "all".to_owned(),
        };
        vec![
            ResultColumn::whole("observer", rows.iter().map(|(observer, _)| observer + 1)),
            ResultColumn::whole("reflector", rows.iter().map(|(_, reflector)| reflector.map_or(0, |own| own + 1))),
            ResultColumn::words("name", rows.iter().map(name)),
            real("hours", &|one| one.hours, 3),
            real("after_image_hours", &|one| one.after_image_hours, 3),
            real("unproven_hours", &|one| one.unproven_hours, 3),
            real("days", &|one| one.days as f64, 0),
            day("first_day", 0),
            day("last_day", 1),
            clock("earliest", 0),
            clock("latest", 1),
            real("longest_min", &|one| one.longest_min, 1),
            real("max_day_min", &|one| one.max_day_min, 1),
        ]
    }

    /// A row for each observer and month: minutes of glare in each hour of the clock, of all reflectors together.
    #[must_use]
    pub fn columns_by_hour(&self) -> Vec<ResultColumn> {
        let of_observer = |(observer, glare): (usize, &EyeGlare)| match self.can_look(observer) {
            true => glare_by_hour(&glare.of_any, &self.schedule),
            false => [[f32::NAN; 24]; 12],
        };
        let minutes: Vec<[[f32; 24]; 12]> = self.of_observers.iter().enumerate().map(of_observer).collect();
        let rows = || (0..minutes.len()).flat_map(|observer| (0..12).map(move |month| (observer, month)));
        let hour = |hour: usize| {
            let values = rows().map(|(observer, month)| f64::from(minutes[observer][month][hour]));
            ResultColumn::real(format!("min_{hour:02}"), values, 1)
        };
        let observers = ResultColumn::whole("observer", rows().map(|(observer, _)| observer + 1));
        let months = ResultColumn::whole("month", rows().map(|(_, month)| month + 1));
        [observers, months].into_iter().chain((0..24).map(hour)).collect()
    }

    fn summarise(&self, params: &GlareParams, context: &mut Context) {
        let observers = self.of_observers.len();
        let all: Vec<(usize, GlareSummary)> =
            (0..observers).filter_map(|observer| Some((observer, self.of_observer(observer)?))).collect();
        let sum = |hours: &dyn Fn(&GlareSummary) -> f64| {
            rounded(all.iter().fold(0.0, |sum: f64, (_, one)| sum + hours(one)), 3)
        };
        let section = GlareSection {
            observers,
            reflectors: self.reflector_count,
            hours: sum(&|one| one.hours),
            after_image_hours: sum(&|one| one.after_image_hours),
            unproven_hours: sum(&|one| one.unproven_hours),
            scatter_deg: rounded(params.scatter.to_degrees(), 2),
            from_sun_deg: rounded(params.min_separation.to_degrees(), 2),
            clear_sky: ClearSky::default().to_string(),
        };
        let days = self.schedule.days.len();
        let possible = self.schedule.possible_hours();
        context.headline(format!(
            "Glare of {} at {}, {} with {possible:.0} h of sun",
            counted(self.reflector_count, "reflector"),
            counted(observers, "observer"),
            counted(days, "day")
        ));
        let mut order: Vec<&(usize, GlareSummary)> = all.iter().collect();
        order.sort_by(|(_, a), (_, b)| b.hours.total_cmp(&a.hours));
        for (observer, own) in order.into_iter().take(MAX_LISTED) {
            let name = if observers == 1 { String::new() } else { format!("observer {}: ", observer + 1) };
            context.headline(format!("{name}{}", own.in_words()));
        }
        context.report.glare = Some(section);
    }
}

/// Maximum number of observers in the headline.
const MAX_LISTED: usize = 5;

impl GlareSummary {
    fn in_words(&self) -> String {
        let (Some([from, to]), Some([first, last])) = (self.between, self.dates) else { return "no glare".to_owned() };
        let after = match self.after_image_hours > 0.0 {
            true => format!(", {:.1} h of it with possible after-images", self.after_image_hours),
            false => ", too weak for after-images".to_owned(),
        };
        let when = match first == last {
            true => format!("on {first}"),
            false => format!("on {} from {first} to {last}", counted(self.days, "day")),
        };
        format!(
            "{:.1} h {when}, between {} and {}, at most {:.0} min a day{after}",
            self.hours,
            clock_time(from),
            clock_time(to),
            self.max_day_min
        )
    }
}
