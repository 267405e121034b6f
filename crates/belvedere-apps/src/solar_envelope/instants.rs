//! The suns that an envelope keeps: days and the hours between which they count.

use crate::sun::{Date, DayParams, Site, Zone, sun_position_with};
use belvedere_data::cast::to_index;
use belvedere_data::{Error, Parameter, Result};

/// Maximum number of instants: three years at 10 minutes.
const MAX_INSTANTS: usize = 200_000;

/// A sun that must reach the protected pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvelopeSun {
    /// Seconds of UTC since 1970.
    pub unix_s: f64,
    /// Unit vector to it in the axes of the grid.
    pub direction: [f64; 3],
}

/// Returns the suns of each of `dates` at a site, from the first to the last of the hours `between` on the clocks of
/// `zone`, both included. The first and the last sun of a day cast the longest shadows, and bind. Steps are shortened a
/// little to fill the time. Suns at or below the minimum elevation of `params` are left out; their number is returned
/// too.
///
/// # Errors
/// [`Error::InvalidParameter`] for hours that are not 0 to 24 in rising order, a step that is not 10 to 3600 seconds,
/// and more than 200 000 instants. Also the errors of [`Zone::instant_of`] and [`sun_position_with`].
pub fn envelope_suns(
    site: &Site,
    zone: &Zone,
    dates: &[Date],
    between: [f64; 2],
    params: &DayParams,
) -> Result<(Vec<EnvelopeSun>, usize)> {
    check_hours(between)?;
    if !(10.0..=3600.0).contains(&params.step) {
        return Err(Error::invalid(Parameter::TimeStep, params.step, "10 to 3600 seconds"));
    }
    let count = to_index(((between[1] - between[0]) * 3600.0 / params.step - 1e-9).ceil());
    if dates.len().saturating_mul(count + 1) > MAX_INSTANTS {
        let expected = "at most 200 000";
        return Err(Error::invalid(Parameter::InstantCount, format!("{} x {}", dates.len(), count + 1), expected));
    }
    let (mut suns, mut low_count) = (Vec::new(), 0);
    for &date in dates {
        // both ends by the clock, and even steps of time between them, whatever clocks do meanwhile
        let [first, last] = [zone.instant_of(date, between[0])?, zone.instant_of(date, between[1])?];
        for i in 0..=count {
            let unix_s = first + (last - first) * i as f64 / count.max(1) as f64;
            let sun = sun_position_with(site, unix_s, params.refraction)?;
            if sun.elevation > params.min_elevation {
                suns.push(EnvelopeSun { unix_s, direction: sun.to_sun(site) });
            } else {
                low_count += 1;
            }
        }
    }
    Ok((suns, low_count))
}

/// Refuses hours that are not 0 to 24 in rising order.
pub(crate) fn check_hours(between: [f64; 2]) -> Result<()> {
    if 0.0 <= between[0] && between[0] <= between[1] && between[1] <= 24.0 {
        return Ok(());
    }
    Err(Error::invalid(Parameter::HoursOfDay, format!("{between:?}"), "from 0 to 24, the first not after the last"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_hours_are_among_the_instants_and_the_night_is_not() {
        let site = Site { latitude: 0.9, longitude: 0.0, height: 0.0, convergence: 0.0 };
        let date = Date::new(2026, 12, 21).unwrap();
        let params = DayParams { step: 1000.0, ..DayParams::default() };
        let (suns, low) = envelope_suns(&site, &Zone::utc(), &[date], [10.0, 14.0], &params).unwrap();
        let midnight = date.noon_utc() - 43_200.0;
        assert_eq!((suns.len(), low), (16, 0));
        assert!((suns[0].unix_s - midnight - 36_000.0).abs() < 1e-6);
        assert!((suns[15].unix_s - midnight - 50_400.0).abs() < 1e-6);
        // at 51.6° north on the shortest day the sun is up for some eight hours
        let (suns, low) = envelope_suns(&site, &Zone::utc(), &[date], [0.0, 24.0], &params).unwrap();
        let hours = suns.len() as f64 * 1000.0 / 3600.0;
        assert!((7.3..8.7).contains(&hours) && suns.len() + low == 88, "{hours}");
        assert!(suns.iter().all(|sun| sun.direction[2] > 0.0));
    }

    #[test]
    fn senseless_hours_and_steps_are_refused() {
        let site = Site { latitude: 0.9, longitude: 0.0, height: 0.0, convergence: 0.0 };
        let date = Date::new(2026, 6, 21).unwrap();
        let ask = |between, step| {
            let params = DayParams { step, ..DayParams::default() };
            envelope_suns(&site, &Zone::utc(), &[date], between, &params)
        };
        for between in [[15.0, 9.0], [-1.0, 9.0], [9.0, 25.0], [f64::NAN, 9.0]] {
            assert!(ask(between, 600.0).is_err(), "{between:?}");
        }
        assert!(ask([9.0, 15.0], 0.0).is_err() && ask([9.0, 15.0], f64::NAN).is_err());
        assert_eq!(ask([12.0, 12.0], 600.0).unwrap().0.len(), 1);
    }
}
