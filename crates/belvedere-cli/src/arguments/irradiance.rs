//! Flags of irradiance and of photovoltaic loss.

use super::{Numbers, SceneInput, Shell, SkyOutputs, SkyPlaces, ThroughTrees, above_zero, at_least_one};
use belvedere::apps::irradiance::{SkyModel, Surroundings};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Irradiance {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) radiation: RadiationChoice,
    /// Linke turbidity of a clear sky by ineichen, 1 to 20: 2 clean, 3 usual, 5 hazy [default: 3]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Radiation")]
    pub(crate) linke: Option<f64>,
    /// Year of a clear sky [default: 2026]
    #[arg(long, value_name = "YEAR", requires = "clear_sky", help_heading = "Radiation")]
    pub(crate) year: Option<i16>,
    /// Latitude and longitude in degrees, north and east positive [default: those of the cloud's reference system, else those of the weather
    /// file]
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true, help_heading = "Radiation")]
    pub(crate) location: Option<Numbers<2>>,
    /// Parts of a row of weather, each with a sun of its own; 1 is what pvlib does [default: 4]
    #[arg(long, value_name = "N", value_parser = at_least_one, conflicts_with = "clear_sky", help_heading = "Radiation")]
    pub(crate) parts: Option<usize>,
    /// Model of the diffuse sky [default: patches]
    #[arg(long, value_enum, value_name = "MODEL", help_heading = "Radiation")]
    pub(crate) sky: Option<SkyModelChoice>,
    /// Division of the sky into patches: 145 for 1, 577 for 2, 2305 for 4 [default: 2]
    #[arg(long, value_name = "N", value_parser = at_least_one, help_heading = "Radiation")]
    pub(crate) patch_division: Option<usize>,
    /// Share of global radiation that the ground reflects, 0 to 1 [default: 0.2]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, help_heading = "Radiation")]
    pub(crate) albedo: Option<f64>,
    /// What obstacles send in place of the sky that they hide [default: dark]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Radiation")]
    pub(crate) surroundings: Option<SurroundingsChoice>,
    /// Side in degrees of the cells in which directions of the sun count as one, 0.5 to 36 [default: 1]
    #[arg(long, value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Radiation")]
    pub(crate) sun_cell: Option<f64>,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) shell: Shell,
    #[command(flatten)]
    pub(crate) trees: ThroughTrees,
    /// Planes of roofs: a table (.csv) or their outlines (.geojson), with tilt, azimuth from true north, area, energy, and the least and most
    /// that a plant there loses by shading. May be given several times
    #[arg(long, value_name = "OUT", help_heading = "Roofs")]
    pub(crate) planes: Vec<PathBuf>,
    /// Least area of a plane in m² [default: 4]
    #[arg(long, value_name = "M2", requires = "planes", allow_negative_numbers = true, help_heading = "Roofs")]
    pub(crate) least_area: Option<f64>,
    /// Side of the cells that a plane is cut into, whose rows are strings of panels, in metres [default: 1]
    #[arg(long, value_name = "M", requires = "planes", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Roofs")]
    pub(crate) panel: Option<f64>,
    /// Also write the horizon around the middle of each plane into this folder, made if it is not there, as PVGIS takes it: a height in
    /// degrees for each of 48 azimuths, clockwise from true north
    #[arg(long, value_name = "DIR", requires = "planes", help_heading = "Roofs")]
    pub(crate) horizons: Option<PathBuf>,
    /// Also tell the energy of each month
    #[arg(long, help_heading = "Result")]
    pub(crate) months: bool,
    #[command(flatten)]
    pub(crate) outputs: IrradianceOutputs,
}

#[derive(Args)]
#[command(next_help_heading = "Radiation")]
#[group(required = true, multiple = false)]
pub(crate) struct RadiationChoice {
    /// Weather: EPW, CSV of PVGIS (typical year, or series on a level plane), TMY3, CSV of NSRDB
    #[arg(long, value_name = "FILE")]
    pub(crate) weather: Option<PathBuf>,
    /// A year without clouds
    #[arg(long, value_enum, value_name = "MODEL", id = "clear_sky")]
    pub(crate) clear_sky: Option<ClearSkyChoice>,
}

/// As [`SkyOutputs`], but needed only where there are no planes.
#[derive(Args)]
pub(crate) struct IrradianceOutputs {
    /// Results on a grid as raster of the total (.tif, nodata -9999), or a map with a legend (.png); on cells and points all measures as
    /// columns (.laz .las .ply .csv); on a mesh a table with a row for each object and face (.csv), or the mesh coloured by the total (.ply).
    /// May be given several times
    #[arg(short, long, value_name = "OUT", required_unless_present = "planes", help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write a raster for each measure of a grid into this folder, made if it is not there
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) measures: Option<PathBuf>,
}

impl IrradianceOutputs {
    /// The same as other commands have it.
    pub(crate) fn of_places(&self) -> SkyOutputs {
        SkyOutputs { output: self.output.clone(), measures: self.measures.clone() }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ClearSkyChoice {
    /// Ineichen & Perez 2002, by height and turbidity
    Ineichen,
    /// Haurwitz 1945, by the sun's height alone
    Haurwitz,
    /// Bird & Hulstrom 1981, of a standard atmosphere
    Bird,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum SkyModelChoice {
    /// The same from everywhere
    Isotropic,
    /// Hay & Davies 1980: a part from the sun
    HayDavies,
    /// Perez et al. 1990: parts from the sun and the horizon
    Perez,
    /// Perez et al. 1993: a radiance for each patch of the sky
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
    /// Nothing: a lower bound
    Dark,
    /// As much as the ground: an upper bound
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
