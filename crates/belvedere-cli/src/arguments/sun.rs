//! Flags of the location, the time zone, the days and the sun hours.

use super::{
    CloudInput, IntervalArgument, Numbers, SceneInput, Shell, SkyOutputs, SkyPlaces, ThroughTreesArguments,
    TilesArguments, above_zero, location,
};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The place on earth, its clocks and its air.
#[derive(Args)]
#[command(next_help_heading = "Sun")]
pub(crate) struct SunPlaceArguments {
    /// Latitude and longitude of the scene in degrees, north and east positive [default: from its reference system]
    #[arg(long, value_name = "LAT,LON", value_parser = location, allow_hyphen_values = true)]
    pub(crate) location: Option<Numbers<2>>,
    /// Time zone of times and days: Europe/Amsterdam, +02:00, or solar
    /// [default: that of a given time, else of the place]
    #[arg(long, value_name = "ZONE", allow_hyphen_values = true)]
    pub(crate) zone: Option<String>,
    /// Elevation of the sun: apparent (with refraction of the air) or geometric
    #[arg(long = "sun-elevation", value_enum, value_name = "KIND", default_value_t = ElevationChoice::Apparent)]
    pub(crate) elevation: ElevationChoice,
    /// Air pressure in hPa and temperature in degrees Celsius, for refraction
    /// [default: standard atmosphere, 10 degrees]
    ///
    /// The default pressure is that of the standard atmosphere at the height of the scene.
    #[arg(long, value_name = "HPA,C", allow_hyphen_values = true)]
    pub(crate) air: Option<Numbers<2>>,
}

#[derive(Args)]
pub(crate) struct SunPositionArguments {
    /// An instant: 2026-06-21T15:00, or 2026-06-21T15:00+02:00; repeatable
    ///
    /// Without an offset it is on the clocks of the place, or of --zone.
    #[arg(long = "time", value_name = "TIME", required = true, help_heading = "Sun")]
    pub(crate) times: Vec<String>,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    /// Table of times, azimuths and elevations (.csv)
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) input: CloudInput,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ElevationChoice {
    /// With refraction
    Apparent,
    /// Without refraction
    Geometric,
}

/// Days and periods.
#[derive(Args)]
#[command(next_help_heading = "Period")]
pub(crate) struct SunPeriod {
    /// A day: 2026-06-21, equinox, shortest-day or longest-day; repeatable
    ///
    /// The equinox is 21 March.
    #[arg(long, value_name = "DATE", conflicts_with_all = ["from", "to"])]
    pub(crate) date: Vec<String>,
    /// First day of a period, or its start time: 2026-03-01T09:00+01:00
    #[arg(long, value_name = "TIME", requires = "to")]
    pub(crate) from: Option<String>,
    /// Last day of a period (included), or its end time
    #[arg(long, value_name = "TIME", requires = "from")]
    pub(crate) to: Option<String>,
    /// Time between two suns in minutes, 1/6 to 60 [default: 10]
    ///
    /// Each sun position represents its whole step, so shadow edges are accurate to half a step.
    #[arg(long = "time-step-min", value_name = "MIN", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) step: Option<f64>,
    /// Minimum elevation of the sun in degrees; lower suns are ignored [default: 0, or that of a rule]
    #[arg(long = "min-sun-elevation", value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) min_elevation: Option<f64>,
    /// Year of days that are given without a year
    #[arg(long, value_name = "Y", default_value_t = 2026)]
    pub(crate) year: i16,
}

#[derive(Args)]
pub(crate) struct SunHoursArguments {
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    /// Daylight rule by name, such as nl-light, en17037-minimum or pl, or your own as HOURS@DAYS; repeatable
    ///
    /// Names are in the text above. Examples of your own: 1.5@03-21, 2@02-19..10-21>10 (sun above 10 degrees),
    /// 3@equinoxes@7-17, 2@shortest-day@9-15,piece. Without --date or --from, the results are for the days of the first
    /// rule.
    #[arg(long, value_name = "RULE", help_heading = "Period")]
    pub(crate) rule: Vec<String>,
    /// Maximum angle between a sun and the direction used for it, in degrees, 0 to 5
    /// [default: 0 up to 2000 suns, else 1]
    ///
    /// 0 uses the exact direction of each sun. Larger values let several suns share one direction, which is faster.
    #[arg(long = "sun-tolerance-deg", value_name = "DEG", allow_negative_numbers = true, help_heading = "Period")]
    pub(crate) within: Option<f64>,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    #[command(flatten)]
    pub(crate) interval: IntervalArgument,
    /// Also write the sun of each hour of a year into this folder: 01.tif to 12.tif, a bit for each day
    ///
    /// The layout of the Google Solar API: a band for each hour of the clock, 00 to 23, and the lowest bit for day 1.
    /// The sun in the middle of the hour counts, for all days of the year of the first day. Trees are opaque.
    #[arg(long = "hourly-sun", value_name = "DIR", conflicts_with = "through_trees", help_heading = "Result")]
    pub(crate) hourly_sun: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) trees: ThroughTreesArguments,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    #[command(flatten)]
    pub(crate) tiles: TilesArguments,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}
