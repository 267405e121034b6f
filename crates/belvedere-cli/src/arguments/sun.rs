//! Flags of where on earth the sun is asked about, how clocks run there, and which days.

use super::{Numbers, SceneInput, Shell, SkyOutputs, SkyPlaces, ThroughTrees, above_zero};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The place on earth, its clocks and its air.
#[derive(Args)]
#[command(next_help_heading = "Sun")]
pub(crate) struct SunPlace {
    /// Latitude and longitude of the scene in degrees, north and east positive [default: from its reference system]
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true)]
    pub(crate) location: Option<Numbers<2>>,
    /// Clocks that times and days are told by: a zone such as Europe/Amsterdam, or an offset such as +02:00 [default: those that a time is
    /// given with, else the mean solar time of the place]
    #[arg(long, value_name = "ZONE", allow_hyphen_values = true)]
    pub(crate) zone: Option<String>,
    /// Elevation of the sun: apparent, lifted by the air, or geometric
    #[arg(long, value_enum, value_name = "KIND", default_value_t = ElevationChoice::Apparent)]
    pub(crate) elevation: ElevationChoice,
    /// Air pressure in hPa and temperature in degrees Celsius, which lift the sun more or less [default: that of the standard atmosphere at
    /// the height of the scene, and 10]
    #[arg(long, value_name = "HPA,C", allow_hyphen_values = true)]
    pub(crate) air: Option<Numbers<2>>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ElevationChoice {
    /// As it appears
    Apparent,
    /// As it would be without air
    Geometric,
}

/// Days and periods.
#[derive(Args)]
#[command(next_help_heading = "When")]
pub(crate) struct SunPeriod {
    /// A day, such as 2026-06-21, or equinox (21 March), shortest-day or longest-day. May be given several times
    #[arg(long, value_name = "DATE", conflicts_with_all = ["from", "to"])]
    pub(crate) date: Vec<String>,
    /// First day of a period, or the time at which it begins: 2026-03-01, 2026-03-01T09:00+01:00
    #[arg(long, value_name = "TIME", requires = "to")]
    pub(crate) from: Option<String>,
    /// Last day of a period, which counts whole, or the time at which it ends
    #[arg(long, value_name = "TIME", requires = "from")]
    pub(crate) to: Option<String>,
    /// Minutes between suns, 10 seconds to 60 minutes; each stands for its step, and edges of shadows are true to half of it [default: 10]
    #[arg(long, value_name = "MIN", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) step: Option<f64>,
    /// Elevation above which the sun counts, in degrees [default: 0, or what a rule asks for]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) least_elevation: Option<f64>,
    /// Year of days that are given without one
    #[arg(long, value_name = "Y", default_value_t = 2026)]
    pub(crate) year: i16,
}

#[derive(Args)]
pub(crate) struct SunHours {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    /// Rule that each place is held against: nl-light, nl-strict, the-hague, bre-equinox, or one's own as HOURS@DAYS, such as 1.5@03-21,
    /// 1@shortest-day, or with a least elevation 2@02-19..10-21>10. May be given several times; without days of their own, results are about
    /// those of the first rule
    #[arg(long, value_name = "RULE", help_heading = "When")]
    pub(crate) rule: Vec<String>,
    /// Degrees by which a sun may stand from the direction that is asked in its place, above 0 to 5; 0 asks each sun itself [default: 0 up to
    /// 2000 suns, 1 beyond]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, help_heading = "When")]
    pub(crate) within: Option<f64>,
    #[command(flatten)]
    pub(crate) sun: SunPlace,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    #[command(flatten)]
    pub(crate) trees: ThroughTrees,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    /// Also keep what each place sees of each direction, to ask about other days and rules without looking again (.npz): NumPy arrays bits
    /// (places x words of 64 directions, lowest bit first), directions, targets, origin
    #[arg(long, value_name = "MATRIX", help_heading = "Result")]
    pub(crate) keep: Option<PathBuf>,
    /// Take what places see from a matrix that --keep wrote for the same balls and places. Each sun is stood for by the next direction
    /// kept, at most --within degrees off [default: 1]
    #[arg(long, value_name = "MATRIX", conflicts_with = "keep", help_heading = "When")]
    pub(crate) from_matrix: Option<PathBuf>,
}
