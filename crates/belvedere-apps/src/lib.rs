//! Applications: each queries [`belvedere_core::query`] and summarises the answers.

pub mod ask;
pub mod calibration;
pub mod cameras;
pub mod difference;
pub mod edge;
pub mod exposure;
pub mod eyes;
pub mod glare;
pub mod heat;
pub mod held_out;
pub mod horizon;
pub mod irradiance;
pub mod isovist;
pub mod landmark;
pub mod profile;
pub mod protected_view;
pub mod resampling;
pub mod roof_planes;
pub mod rows;
pub mod shadow;
pub mod sky_view;
pub mod solar_envelope;
pub mod sum_errors;
pub mod sun;
pub mod sun_calendar;
pub mod sun_hours;
pub mod survey_plan;
pub mod survey_reliability;
pub mod targets;
pub mod towers;
pub mod tree_light;
pub mod viewshed;
pub mod window_views;
pub mod wireline;

pub use belvedere_data::result_columns;
