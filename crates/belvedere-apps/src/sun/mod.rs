//! The sun: its position, the hours of light of a day, and the directions that represent the suns of many days.
//!
//! Instants are seconds of UTC since 1970-01-01T00:00:00Z, without leap seconds. UTC is taken for UT1; they differ by
//! less than a second, in which the sky turns by 0.004°. Azimuths count clockwise from true north. Unit vectors are in
//! the axes of the grid, x east, y grid north, z up, and the convergence of meridians is subtracted for them.

mod days;
mod position;
mod schedule;
mod site;
mod time;
mod zones;

pub use days::{DayParams, Period, SunDay, SunStep, sun_day, sun_days};
pub use position::{
    Refraction, SunPosition, SunTimes, declination, sun_distance, sun_position, sun_position_with, sun_times,
};
pub use schedule::{Binning, DayOfLight, LightStep, SunSchedule};
pub use site::{Site, SiteFrom};
pub use time::{Date, Zone, parse_hour, parse_instant, zone_of_instant};
pub use zones::ZoneOfPlace;
