//! Radiation of sun and sky on planes that obstacles shade, and the energy it makes over a period.
//!
//! | question | function |
//! |---|---|
//! | what arrives above the atmosphere, how much air it passes | [`extraterrestrial`], [`air_mass`] |
//! | what a clear sky gives | [`ClearSky::irradiance`] |
//! | what the sun and the sky are where only global radiation is known | [`split_global`], [`complete`] |
//! | how diffuse radiation falls on a tilted plane | [`diffuse_parts`], [`patch_radiation`] |
//! | which instants a period has | [`weather_instants`], [`clear_instants`] |
//! | what a period sends from each direction | [`PeriodRadiation::gather`] |
//! | what a period sends, in parts by what trees let through | [`period_seasons`] |
//! | what each target gets of it, and what it loses | [`season_irradiation`], [`scene_irradiation`], [`irradiation`] |
//! | what roofs and planes of panels in strings get | [`roof_irradiation`], [`plane_irradiation`] |
//! | what a plane gets in each row of weather | [`PeriodRows::on_plane`] |
//! | the electricity of panels on roofs, in sum and row by row | [`roof_yields`], [`plane_hours`] |

mod atmosphere;
mod clear_sky;
mod diffuse;
mod erbs;
mod hour_columns;
mod instants;
mod intervals;
mod irradiation;
mod measures;
mod patch_sky;
mod period;
mod period_rows;
mod pvwatts;
mod roof_columns;
mod roofs;
mod roofs_report;
mod seasons;
mod strings;
mod weather_clock;
mod yields;

pub use atmosphere::{SOLAR_CONSTANT, absolute_air_mass, air_mass, extraterrestrial, pressure};
pub use clear_sky::{BirdParams, ClearSky};
pub use diffuse::{DiffuseParts, SkyModel, diffuse_parts};
pub use erbs::{complete, split_global};
pub use hour_columns::{hour_columns, sky_loss_percent};
pub use instants::{PARTS, clear_instants, weather_instants};
pub use irradiation::{Irradiation, irradiation, irradiation_through_crowns, scene_irradiation};
pub use measures::{ENERGY, ENERGY_NAME, MONTH_COLUMNS, irradiation_measures};
pub use patch_sky::patch_radiation;
pub use period::{Grouping, Instant, IrradianceParams, PeriodRadiation, PeriodReport, Surroundings};
pub use period_rows::{PeriodRow, PeriodRows, RowRadiation};
pub use pvwatts::{PvPower, PvSystem, cell_temperature, cover_transmission, glass_reflectance};
pub use roof_columns::{RoofRows, building_columns, roof_columns};
pub use roofs::{RoofIrradiation, above_roof, horizon_places, roof_irradiation};
pub use roofs_report::RoofsReport;
pub use seasons::{
    CLEAR_SKY_YEAR, RadiationSource, SeasonRadiation, TargetEnergies, look_count, period_seasons, season_irradiation,
};
pub use strings::{PlaneIrradiation, PlaneLight, plane_irradiation};
pub(crate) use weather_clock::clock_contradiction;
pub use yields::{PlaneHour, PlaneYield, PvEnergy, USUAL_TEMPERATURE, performance_ratio, plane_hours, roof_yields};
