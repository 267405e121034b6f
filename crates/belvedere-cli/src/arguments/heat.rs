//! Flags of heat.

use super::envelope::Hours;
use super::{Numbers, SceneInput, Shell, SkyOutputs, SkyPlaces, ThroughTreesArguments, at_least_one, location};
use belvedere::apps::heat::{Body, GroundCover};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct HeatArguments {
    /// Weather file with temperature and humidity: EPW, TMY3, CSV of PVGIS (typical year), or CSV of NSRDB
    #[arg(long, value_name = "FILE", required = true, help_heading = "Weather")]
    pub(crate) weather: PathBuf,
    /// A day: 2026-07-21, or 07-21; repeatable
    ///
    /// A typical year has each day once, and the year does not matter.
    #[arg(long, value_name = "DATE", conflicts_with_all = ["from", "to"], help_heading = "Weather")]
    pub(crate) date: Vec<String>,
    /// First day of a period: 2026-06-01
    #[arg(long, value_name = "DATE", requires = "to", help_heading = "Weather")]
    pub(crate) from: Option<String>,
    /// Last day of a period (included)
    #[arg(long, value_name = "DATE", requires = "from", help_heading = "Weather")]
    pub(crate) to: Option<String>,
    /// Hours of each day that count, on the clocks of --zone, both included [default: all]
    #[arg(long, value_name = "HH:MM,HH:MM", help_heading = "Weather")]
    pub(crate) between: Option<Hours>,
    /// Time zone of days and hours: Europe/Amsterdam, +02:00, or solar [default: that of the place]
    #[arg(long, value_name = "ZONE", allow_hyphen_values = true, help_heading = "Weather")]
    pub(crate) zone: Option<String>,
    /// Latitude and longitude in degrees, north and east positive
    /// [default: from the reference system, else the weather file]
    #[arg(long, value_name = "LAT,LON", value_parser = location, allow_hyphen_values = true, help_heading = "Weather")]
    pub(crate) location: Option<Numbers<2>>,
    /// Factor of the wind, 0 to 2: shelter by buildings is not computed [default: 1]
    #[arg(long = "wind-factor", value_name = "N", allow_negative_numbers = true, help_heading = "Weather")]
    pub(crate) wind_factor: Option<f64>,
    /// Number of sun positions for each row of weather, 1 to 60 [default: 4]
    #[arg(long = "parts-per-row", value_name = "N", value_parser = at_least_one, help_heading = "Weather")]
    pub(crate) parts: Option<usize>,
    /// Shape of the body that absorbs radiation
    #[arg(long, value_enum, value_name = "BODY", default_value_t = BodyChoice::Standing, help_heading = "Body and surfaces")]
    pub(crate) body: BodyChoice,
    /// Cover of the ground
    #[arg(long = "ground-cover", value_enum, value_name = "COVER", default_value_t = CoverChoice::Paved,
        help_heading = "Body and surfaces")]
    pub(crate) cover: CoverChoice,
    /// Share of the published warming of surfaces in the sun, 0 to 2 [default: 0.5]
    ///
    /// 0 keeps surfaces as warm as the air, 1 warms them as single surfaces that were measured: the two ends of what
    /// is not known.
    #[arg(
        long = "ground-warming",
        value_name = "SHARE",
        allow_negative_numbers = true,
        help_heading = "Body and surfaces"
    )]
    pub(crate) warming: Option<f64>,
    #[command(flatten)]
    pub(crate) trees: ThroughTreesArguments,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Also give each hour, 48 at most: UTCI and mean radiant temperature
    #[arg(long = "by-hour", help_heading = "Result")]
    pub(crate) by_hour: bool,
    /// Also compute the Physiological Equivalent Temperature (PET) of a standing man of 35 years, lightly active
    #[arg(long, help_heading = "Result")]
    pub(crate) pet: bool,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BodyChoice {
    /// Six faces of a standing person (VDI 3787), as sensors measure it from six directions
    Standing,
    /// Six equal faces
    Sitting,
    /// Alike from all sides, with the projected area of a standing person towards the sun
    Round,
}

impl From<BodyChoice> for Body {
    fn from(choice: BodyChoice) -> Self {
        match choice {
            BodyChoice::Standing => Self::Standing,
            BodyChoice::Sitting => Self::Sitting,
            BodyChoice::Round => Self::Round,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CoverChoice {
    /// Cobble and concrete
    Paved,
    /// Dark asphalt
    Asphalt,
    /// Grass
    Grass,
    /// Bare soil
    Soil,
}

impl From<CoverChoice> for GroundCover {
    fn from(choice: CoverChoice) -> Self {
        match choice {
            CoverChoice::Paved => Self::Paved,
            CoverChoice::Asphalt => Self::Asphalt,
            CoverChoice::Grass => Self::Grass,
            CoverChoice::Soil => Self::Soil,
        }
    }
}
