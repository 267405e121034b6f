//! What users ask of a scene: each application puts questions to [`belvedere_core::query`] and sums up the answers.

pub mod ask;
pub mod cameras;
pub mod difference;
pub mod edge;
pub mod exposure;
pub mod eyes;
pub mod horizon;
pub mod irradiance;
pub mod isovist;
pub mod landmark;
pub mod profile;
pub mod protected_view;
pub mod roof_planes;
pub mod rows;
pub mod shadow;
pub mod sky_view;
pub mod solar_envelope;
pub mod sum_errors;
pub mod sun;
pub mod sun_hours;
pub mod survey_plan;
pub mod targets;
pub mod tree_light;
pub mod viewshed;
pub mod window_views;
