//! The sun of each hour of a year at each target, a bit for each.

use super::SunHoursQuestion;
use crate::ask::answers::Answers;
use crate::ask::context::Context;
use crate::ask::places::{Places, test_edge};
use crate::ask::scene::Scene;
use crate::irradiance::CLEAR_SKY_YEAR;
use crate::sun::{Date, Site, SunDay, SunSchedule, SunStep, Zone, sun_position_with};
use crate::targets::Targets;
use belvedere_core::query::{UnprovenAs, VisibilityMatrix};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::sync::Arc;

const HOUR: f64 = 3600.0;
/// Maximum number of bits that are held: 8 GiB.
const MAX_BITS: usize = 1 << 36;
/// Targets that a thread answers at once.
const CHUNK: usize = 1024;

/// The hours of a year with sun, at each target.
#[derive(Clone, Debug)]
pub struct HourlySun {
    /// The year.
    pub year: i16,
    /// The targets.
    pub targets: Arc<Targets>,
    hours: Vec<SunnyHour>,
    lit: VisibilityMatrix,
}

/// An hour of the clock at whose middle the sun is up.
#[derive(Clone, Copy, Debug)]
struct SunnyHour {
    /// 1 to 12.
    month: i8,
    /// 1 to 31.
    day: i8,
    /// 0 to 23.
    hour: u32,
    /// Row of the direction.
    direction: u32,
}

impl HourlySun {
    /// Hours of a day.
    pub const HOURS: u32 = 24;
    /// The word of cells that are no targets: its bit is that of no day.
    pub const NO_BITS: u32 = 1 << 31;

    /// Computes for each target and each day of a month, 1 to 12, whether the sun shines in the middle of an hour of
    /// the clock, 0 to 23. The lowest bit of a word is that of day 1.
    #[must_use]
    pub fn days(&self, month: i8, hour: u32) -> Vec<u32> {
        let is_of = |sunny: &&SunnyHour| (sunny.month, sunny.hour) == (month, hour);
        let days: Vec<&SunnyHour> = self.hours.iter().filter(is_of).collect();
        let word = |target: usize| {
            if !self.targets.is_target(target) {
                return Self::NO_BITS;
            }
            let bit = |day: &&SunnyHour| {
                u32::from(self.lit.is_free(target, day.direction as usize)) << (day.day - 1).unsigned_abs()
            };
            days.iter().map(bit).fold(0, std::ops::BitOr::bitor)
        };
        (0..self.targets.len()).into_par_iter().with_min_len(CHUNK).map(word).collect()
    }
}

impl SunHoursQuestion {
    /// Computes the sun of each hour of `year` at level places, among opaque obstacles; without one, of the year of the
    /// first day. Suns share directions as in the answer of the question.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for more than 8 GiB of answers, and those of [`MedialScene::visibility_matrix`].
    ///
    /// [`MedialScene::visibility_matrix`]: belvedere_core::query::MedialScene::visibility_matrix
    pub fn hourly_sun(
        &self,
        year: Option<i16>,
        places: &Places,
        scene: &Scene,
        control: &Control<'_>,
    ) -> Result<Answers<HourlySun>> {
        self.place.check()?;
        let mut context = Context::default();
        let site = self.place.site(scene, &mut context, None)?;
        let zone = self.place.clock(&site, self.days.times(), &mut context)?;
        let year = match year {
            Some(year) => year,
            None => self.plan(&site)?.0.dates().next().map_or(CLEAR_SKY_YEAR, Date::year),
        };
        let targets = places.targets(scene, &mut context, control)?;
        let days = self.days_by_hour(year, &site, &zone)?;
        let schedule = SunSchedule::new(&days, self.binning())?;
        if schedule.directions.len().saturating_mul(targets.len()) > MAX_BITS {
            return Err(Error::invalid(
                Parameter::Cell,
                format!("{} cells with {} suns each", targets.len(), schedule.directions.len()),
                "fewer for the hours of a year: choose larger cells, or a smaller cloud",
            ));
        }
        test_edge(scene, &targets, &schedule.directions, &mut context, control)?;
        let blockers = scene.blockers(UnprovenAs::Visible, control)?;
        let lit = control.stage("testing sun of a year", targets.len(), || {
            blockers.visibility_matrix(&targets.positions, &schedule.directions, control)
        })?;
        let mut hours = Vec::new();
        for (day, light) in days.iter().zip(&schedule.days) {
            let (month, number) = (day.date.month(), day.date.day());
            hours.extend(day.steps.iter().zip(&light.steps).map(|(step, light)| SunnyHour {
                month,
                day: number,
                hour: step.number,
                direction: light.direction,
            }));
        }
        Ok(Answers::new(HourlySun { year, targets, hours, lit }, Vec::new()).with(context))
    }

    /// The days of a year, with a step for each hour of the clock at whose middle the sun is up.
    fn days_by_hour(&self, year: i16, site: &Site, zone: &Zone) -> Result<Vec<SunDay>> {
        let lowest = self.days.params(&self.place).min_elevation;
        let day = |date: Date| {
            let clock_start = zone.instant_of(date, 0.0)?;
            let mut steps = Vec::new();
            for number in 0..HourlySun::HOURS {
                let start = zone.instant_of(date, f64::from(number))?;
                let sun = sun_position_with(site, start + 0.5 * HOUR, self.place.refraction)?;
                if sun.elevation > lowest {
                    steps.push(SunStep { number, start, end: start + HOUR, direction: sun.to_sun(site) });
                }
            }
            let [noon, end] = [12.0, 24.0].map(|hours| clock_start + hours * HOUR);
            Ok(SunDay { date, clock_start, start: clock_start, end, noon, steps })
        };
        Date::new(year, 1, 1)?.to(Date::new(year, 12, 31)?).map(day).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ask::{Days, SunPlace};

    #[test]
    fn hours_of_a_year_are_those_of_the_clock() {
        let place = SunPlace { zone: Some("Europe/Amsterdam".to_owned()), ..SunPlace::default() };
        let question = SunHoursQuestion { place, days: Days::default(), ..SunHoursQuestion::default() };
        let site =
            Site { latitude: 52.0_f64.to_radians(), longitude: 5.0_f64.to_radians(), height: 0.0, convergence: 0.0 };
        let zone = Zone::parse("Europe/Amsterdam").unwrap();
        let days = question.days_by_hour(2026, &site, &zone).unwrap();
        assert_eq!(days.len(), 365);
        // almanac of 52 N, 5 E: 05:19 to 22:03 in summer time, 08:46 to 16:29 in winter time
        let hours = |day: &SunDay| [day.steps[0].number, day.steps[day.steps.len() - 1].number];
        assert_eq!(hours(&days[171]), [5, 21]);
        assert_eq!(hours(&days[354]), [9, 15]);
        // half of the year: refraction and the sizes of sun and half hours add little
        let count: usize = days.iter().map(|day| day.steps.len()).sum();
        assert!((4380..4480).contains(&count), "{count}");
    }
}
