//! Flags of sun calendars and of sunlight reports.

use super::{
    CornersArgument, FarTerrainArguments, GroundChoice, MapPosition, NorthArguments, SceneInput, Shell, SunPeriod,
    SunPlaceArguments, above_zero, height,
};
use belvedere::sunlight_report::{Language, ShadowStudy};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct SunCalendarArguments {
    #[command(flatten)]
    pub(crate) places: CalendarPlaces,
    #[command(flatten, next_help_heading = "Places")]
    pub(crate) north: NorthArguments,
    /// Height of --at above the ground, or above the roof that covers it, in metres [default: 0.1]
    #[arg(long = "target-height", value_name = "M", requires = "at", conflicts_with = "windows",
        allow_negative_numbers = true, value_parser = height::<f32>,
        help_heading = "Places")]
    pub(crate) height: Option<f32>,
    /// Source of the ground heights: auto, classed, found or cloud=FILE
    ///
    /// auto: ground points (class 2) if the cloud has them, else found. classed: class 2 only. found: detected from the
    /// shape of the cloud. cloud=FILE: the ground of another cloud, which a ball file needs.
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Places")]
    pub(crate) ground: GroundChoice,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    /// Daylight rule whose days and hours are listed, as in `belvedere sun-hours`
    #[arg(long, value_name = "RULE", conflicts_with_all = ["date", "from", "to"], help_heading = "Period")]
    pub(crate) rule: Option<String>,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Table with a row for each stretch of sun and shade (.csv), or appointments for a calendar (.ics); repeatable
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

/// Windows or places.
#[derive(Args)]
#[command(next_help_heading = "Places (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct CalendarPlaces {
    /// Windows: a table (.csv), of which the middles count
    ///
    /// The table has the columns x, y, z of the middle and azimuth in degrees from true north (see --grid-north). It
    /// may have tilt (90: vertical) and name.
    #[arg(long, value_name = "FILE")]
    pub(crate) windows: Option<PathBuf>,
    /// A place: X,Y[,Z] in file coordinates, or LATITUDE,LONGITUDE in degrees; repeatable
    ///
    /// Without Z it is --target-height above the ground, or above the roof that covers it.
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub(crate) at: Vec<MapPosition>,
}

#[derive(Args)]
pub(crate) struct ReportArguments {
    /// Windows: a table (.csv), of which the middles count
    ///
    /// The table has the columns x, y, z of the middle and azimuth in degrees from true north (see --grid-north). It
    /// may have tilt (90: vertical), name and room: for a rule, the sun of the windows of one room adds up.
    #[arg(long, value_name = "FILE", required_unless_present = "area", help_heading = "Windows and areas")]
    pub(crate) windows: Option<PathBuf>,
    /// Areas such as gardens: polygons (GeoJSON, GeoPackage, Shapefile), or "X,Y X,Y X,Y"; repeatable
    ///
    /// Their ground counts, on cells of 0.5 m.
    #[arg(long, value_name = "FILE|CORNERS", allow_hyphen_values = true, help_heading = "Windows and areas")]
    pub(crate) area: Vec<CornersArgument>,
    #[command(flatten, next_help_heading = "Windows and areas")]
    pub(crate) north: NorthArguments,
    /// Daylight rule of the windows, as in `belvedere sun-hours`, such as nl-light or 2@03-21 [default: no verdict]
    #[arg(long, value_name = "RULE", help_heading = "Rules and days")]
    pub(crate) rule: Option<String>,
    /// Daylight rule of the areas [default: bre-equinox, 2 h on 21 March]
    #[arg(long = "area-rule", value_name = "RULE", requires = "area", help_heading = "Rules and days")]
    pub(crate) area_rule: Option<String>,
    /// Shadow study of a city: its days and hours count for the shade that the plan adds to areas
    ///
    /// Needs --area and a plan (--add or --clear). The report has its tables.
    #[arg(long, value_enum, value_name = "CITY", requires = "area", help_heading = "Rules and days")]
    pub(crate) study: Option<StudyChoice>,
    /// A day in detail: 2026-06-21, equinox, shortest-day or longest-day; repeatable [default: these three, or
    /// those of --study]
    #[arg(long, value_name = "DATE", help_heading = "Rules and days")]
    pub(crate) date: Vec<String>,
    /// Year of days that are given without a year [default: this year]
    #[arg(long, value_name = "Y", help_heading = "Rules and days")]
    pub(crate) year: Option<i16>,
    /// Time between two suns in minutes, 1/6 to 60 [default: 2 for windows, 10 for areas]
    #[arg(long = "time-step-min", value_name = "MIN", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Rules and days")]
    pub(crate) step: Option<f64>,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Title of the report
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true, help_heading = "Result")]
    pub(crate) title: String,
    /// A line below the title, such as the client, the address or the author; repeatable
    #[arg(long, value_name = "TEXT", help_heading = "Result")]
    pub(crate) note: Vec<String>,
    /// Language of the report
    #[arg(long, value_enum, value_name = "CODE", default_value_t = LanguageChoice::En, help_heading = "Result")]
    pub(crate) language: LanguageChoice,
    /// The report (.html)
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyChoice {
    /// New York, CEQR Technical Manual (2021): four days, 1.5 hours from sunrise and sunset
    Ceqr,
    /// San Francisco, Planning Code section 295: m² × hours of a year, an hour from sunrise and sunset
    SanFrancisco,
    /// Toronto: 21 March, 21 June and 21 September, 9:18 to 18:18
    Toronto,
}

impl From<StudyChoice> for ShadowStudy {
    fn from(choice: StudyChoice) -> Self {
        match choice {
            StudyChoice::Ceqr => Self::Ceqr,
            StudyChoice::SanFrancisco => Self::SanFrancisco,
            StudyChoice::Toronto => Self::Toronto,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LanguageChoice {
    /// English
    En,
    /// Dutch
    Nl,
    /// German
    De,
    /// French
    Fr,
}

impl From<LanguageChoice> for Language {
    fn from(choice: LanguageChoice) -> Self {
        match choice {
            LanguageChoice::En => Self::English,
            LanguageChoice::Nl => Self::Dutch,
            LanguageChoice::De => Self::German,
            LanguageChoice::Fr => Self::French,
        }
    }
}
