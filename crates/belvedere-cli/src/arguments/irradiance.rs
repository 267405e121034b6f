//! Flags of irradiance and of photovoltaic loss.

use super::{
    AreaOutputs, IntervalArgument, Numbers, SceneInput, Shell, SkyOutputs, SkyPlaces, ThroughTreesArguments,
    TilesArguments, above_zero, at_least_one, location,
};
use belvedere::apps::ask::PvChoice;
use belvedere::apps::irradiance::{SkyModel, Surroundings};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct IrradianceArguments {
    #[command(flatten)]
    pub(crate) radiation: RadiationChoice,
    /// Year of the clear sky [default: 2026]
    #[arg(long, value_name = "YEAR", requires = "clear_sky", conflicts_with = "weather", help_heading = "Radiation")]
    pub(crate) year: Option<i16>,
    /// Latitude and longitude in degrees, north and east positive
    /// [default: from the reference system, else the weather file]
    #[arg(long, value_name = "LAT,LON", value_parser = location, allow_hyphen_values = true, help_heading = "Radiation")]
    pub(crate) location: Option<Numbers<2>>,
    #[command(flatten)]
    pub(crate) model: RadiationModel,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    #[command(flatten)]
    pub(crate) trees: ThroughTreesArguments,
    /// Also write the roof planes, as a table (.csv) or outlines (.geojson .gpkg); repeatable
    ///
    /// Columns: building, tilt, azimuth from true north, area, radiation, the minimum and maximum shading loss, and the
    /// peak power and electricity of panels there.
    #[arg(long, value_name = "OUT", help_heading = "Roofs")]
    pub(crate) planes: Vec<PathBuf>,
    /// Minimum area of a roof plane in square metres [default: 4]
    #[arg(
        long = "min-area",
        value_name = "M2",
        requires = "planes",
        allow_negative_numbers = true,
        help_heading = "Roofs"
    )]
    pub(crate) min_area: Option<f64>,
    /// Side of the panels that a roof plane is divided into, in metres; a row of panels is a string [default: 1]
    #[arg(long, value_name = "M", requires = "planes", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Roofs")]
    pub(crate) panel: Option<f64>,
    /// Minimum number of cells of a roof plane that is listed; smaller planes are only counted [default: 10]
    #[arg(long = "min-cells", value_name = "N", requires = "planes", help_heading = "Roofs")]
    pub(crate) min_cells: Option<usize>,
    /// Also write the horizon of each roof plane into this folder (for PVGIS); created if it does not exist
    ///
    /// One elevation in degrees for each of 48 azimuths, clockwise from true north, from the cell
    /// nearest to the middle of the plane that has nothing above it.
    #[arg(long, value_name = "DIR", requires = "planes", help_heading = "Roofs")]
    pub(crate) horizons: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) photovoltaics: PvArguments,
    /// Also report the energy of each month
    #[arg(long, help_heading = "Result")]
    pub(crate) months: bool,
    #[command(flatten)]
    pub(crate) interval: IntervalArgument,
    #[command(flatten)]
    pub(crate) outputs: IrradianceOutputs,
    #[command(flatten)]
    pub(crate) tiles: TilesArguments,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

/// Panels on roofs, and their buildings.
#[derive(Args)]
#[command(next_help_heading = "Roofs")]
pub(crate) struct PvArguments {
    /// Also write the sums of each building, as a table (.csv)
    ///
    /// Planes that touch in plan are one building, unless --footprints says otherwise.
    #[arg(long, value_name = "OUT", requires = "planes")]
    pub(crate) buildings: Option<PathBuf>,
    /// Outlines of buildings: polygons (.geojson .gpkg .shp) or a city model (.city.json, .city.jsonl)
    ///
    /// A plane belongs to the outline with most of it. Names are those of the members name, identificatie, identifier
    /// or id, or of city objects.
    #[arg(long, value_name = "FILE", requires = "planes")]
    pub(crate) footprints: Option<PathBuf>,
    /// Also write the hours of each roof plane into this folder (PVsyst, SAM); created if it does not exist
    ///
    /// For each plane a table of radiation, shading losses and electricity by row of weather, and a column of beam
    /// shading losses.
    #[arg(long, value_name = "DIR", requires = "planes")]
    pub(crate) hourly: Option<PathBuf>,
    /// Peak power of a square metre of panels in kW, or their efficiency as a share [default: 0.2]
    #[arg(long, value_name = "SHARE", requires = "planes", allow_negative_numbers = true)]
    pub(crate) module_efficiency: Option<f64>,
    /// Change of the power of panels per degree Celsius, as a share [default: -0.0037]
    #[arg(long, value_name = "SHARE", requires = "planes", allow_negative_numbers = true)]
    pub(crate) temperature_coefficient: Option<f64>,
    /// Share of the direct current that is lost by dirt, wires, mismatch and the like, without shading
    /// [default: 0.1142]
    #[arg(long, value_name = "SHARE", requires = "planes", allow_negative_numbers = true)]
    pub(crate) system_losses: Option<f64>,
    /// Nominal efficiency of the inverters [default: 0.96]
    #[arg(long, value_name = "SHARE", requires = "planes", allow_negative_numbers = true)]
    pub(crate) inverter_efficiency: Option<f64>,
    /// Peak power of panels for each power of their inverter [default: 1.2]
    #[arg(long, value_name = "RATIO", requires = "planes", allow_negative_numbers = true)]
    pub(crate) dc_ac_ratio: Option<f64>,
}

impl PvArguments {
    /// Returns the photovoltaic system that was typed.
    pub(crate) fn system(&self) -> PvChoice {
        PvChoice {
            module_efficiency: self.module_efficiency,
            temperature_coefficient: self.temperature_coefficient,
            system_losses: self.system_losses,
            inverter_efficiency: self.inverter_efficiency,
            dc_ac_ratio: self.dc_ac_ratio,
        }
    }
}

/// Model of radiation.
#[derive(Args)]
#[command(next_help_heading = "Radiation")]
pub(crate) struct RadiationModel {
    /// Linke turbidity of a clear sky by ineichen, 1 to 20: 2 clean, 3 normal, 5 hazy [default: 3]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) linke: Option<f64>,
    /// Number of sun positions for each row of weather; pvlib uses 1 [default: 4]
    #[arg(long = "parts-per-row", value_name = "N", value_parser = at_least_one, conflicts_with = "clear_sky")]
    pub(crate) parts: Option<usize>,
    /// Model of the diffuse sky [default: patches]
    #[arg(long = "sky-model", value_enum, value_name = "MODEL")]
    pub(crate) sky: Option<SkyModelChoice>,
    /// Number of sky patches: 1 for 145, 2 for 577, 4 for 2305 [default: 2]
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    pub(crate) patch_division: Option<usize>,
    /// Albedo of the ground, 0 to 1 [default: 0.2]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub(crate) albedo: Option<f64>,
    /// Radiation from obstacles, instead of the sky that they hide [default: dark]
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) surroundings: Option<SurroundingsChoice>,
    /// Side of the cells that group the sun directions, in degrees, 0.5 to 36 [default: 3]
    #[arg(long = "sun-cell-deg", value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) sun_cell: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Radiation")]
#[group(required = true, multiple = false)]
pub(crate) struct RadiationChoice {
    /// Weather file: EPW, TMY3, CSV of PVGIS (typical year, or series on a horizontal plane), or CSV of NSRDB
    #[arg(long, value_name = "FILE")]
    pub(crate) weather: Option<PathBuf>,
    /// Model of a year without clouds
    #[arg(long, value_enum, value_name = "MODEL", id = "clear_sky")]
    pub(crate) clear_sky: Option<ClearSkyChoice>,
}

/// As [`SkyOutputs`], but needed only where there are no planes.
#[derive(Args)]
pub(crate) struct IrradianceOutputs {
    /// Raster (.tif), map (.png), points (.laz .las .ply .csv) or mesh table (.csv .ply); repeatable
    ///
    /// On a grid: .tif has all measures as bands, the total first, with nodata -9999, and .png is a map of the total
    /// with a legend. Cells and points: all measures as columns. A mesh: a table with a row for each object and each
    /// face (.csv), or the mesh coloured by the total (.ply).
    #[arg(short, long, value_name = "OUT", required_unless_present_any = ["planes", "at", "by_area"], help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write a raster of each measure of a grid into this folder; created if it does not exist
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) measures: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) by_area: AreaOutputs,
}

impl IrradianceOutputs {
    /// The same as other commands have it.
    pub(crate) fn of_places(&self) -> SkyOutputs {
        SkyOutputs { output: self.output.clone(), measures: self.measures.clone(), by_area: self.by_area.clone() }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ClearSkyChoice {
    /// Ineichen & Perez 2002, from height and turbidity
    Ineichen,
    /// Haurwitz 1945, from the elevation of the sun only
    Haurwitz,
    /// Bird & Hulstrom 1981, with a standard atmosphere
    Bird,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum SkyModelChoice {
    /// The same radiance from all directions
    Isotropic,
    /// Hay & Davies 1980: isotropic and circumsolar
    HayDavies,
    /// Perez et al. 1990: isotropic, circumsolar and horizon
    Perez,
    /// Perez et al. 1993: a radiance for each sky patch
    Patches,
}

impl From<SkyModelChoice> for SkyModel {
    fn from(choice: SkyModelChoice) -> Self {
        match choice {
            SkyModelChoice::Isotropic => Self::Isotropic,
            SkyModelChoice::HayDavies => Self::HayDavies,
            SkyModelChoice::Perez => Self::Perez,
            SkyModelChoice::Patches => Self::Patches,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum SurroundingsChoice {
    /// None: a lower bound
    Dark,
    /// As much as the ground reflects: an upper bound
    LikeGround,
}

impl From<SurroundingsChoice> for Surroundings {
    fn from(choice: SurroundingsChoice) -> Self {
        match choice {
            SurroundingsChoice::Dark => Self::Dark,
            SurroundingsChoice::LikeGround => Self::LikeGround,
        }
    }
}
