//! Heat: the mean radiant temperature of a body outdoors, and the felt temperature that follows.
//!
//! The body absorbs radiation from the whole sphere. In each direction it sees the sky or a surface: ground, wall, roof
//! or crown, in the sun or in the shade. One sum over directions gives all fluxes.
//!
//! | step | function |
//! |---|---|
//! | rows of weather with their suns, sky and warm surfaces | [`heat_hours`] |
//! | surfaces that targets see | [`SceneSurfaces`] |
//! | radiation absorbed in each hour | [`fold_absorbed`] |
//! | mean radiant temperature | [`Body::mean_radiant_temperature`] |
//! | Universal Thermal Climate Index | [`utci`] |

mod absorption;
mod body;
mod hours;
mod humidity;
mod longwave;
mod materials;
mod pet;
mod seen_surfaces;
mod utci;

pub use absorption::{AbsorbedBlock, fold_absorbed};
pub use body::{Body, Receiver, STEFAN_BOLTZMANN};
pub(crate) use hours::{HeatDays, HeatRows, days_of_heat};
pub use hours::{HeatHour, HeatHours, HeatSun, heat_hours};
pub use humidity::saturation_pressure;
pub use longwave::{clear_sky_longwave, sky_longwave};
pub use materials::{GroundCover, Material, SurfaceParams, Warming};
pub use pet::{Person, pet};
pub use seen_surfaces::{SceneSurfaces, Surface, body_directions};
pub use utci::{Air, Stress, utci, utci_polynomial};
