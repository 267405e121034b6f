//! Questions: the one way from a user's request to an answer, for the command line, Python, the page and cities.
//!
//! A face parses the user's input into a [`Question`] and [`Places`], puts it to a [`Scene`] with [`ask`], and shows
//! the [`Answers`]. Defaults, checks, warnings and the third state of an answer are made here, so that no face has its
//! own.
//!
//! | step | module |
//! |---|---|
//! | what there is to find | [`Question`], a module for each |
//! | places, and those without an answer | [`places`] |
//! | suns, days, clocks, north | [`sun`], [`north`] |
//! | who looks, and who cannot | [`observers`] |
//! | the scene, and what questions share | [`scene`] |
//! | warnings and notes | [`remark`] |
//! | figures beside the answer | [`report`] |

mod answers;
mod calibrate;
mod cameras;
mod casters;
mod cells;
mod comfort;
mod context;
mod depth_map;
mod envelope;
mod found;
mod given_places;
mod glare;
mod heat;
mod horizon;
mod how_sure;
mod in_parts;
mod irradiance;
mod isovist;
mod known_ground;
mod landmark;
mod line_of_sight;
mod mesh_levels;
pub mod north;
pub mod observers;
mod placed_question;
pub mod places;
mod protected_view;
mod question;
mod reliability;
pub mod remark;
pub mod report;
pub mod scene;
#[cfg(feature = "schema")]
mod schema;
pub mod sections;
mod seen_kinds;
mod sentences;
mod shadow;
mod shared;
mod sight_network;
mod sight_table;
mod single_places;
mod sky_view;
mod standing;
pub mod sun;
mod sun_and_sky;
mod sun_calendar;
mod sun_hours;
mod sun_place;
mod sun_position;
mod survey;
pub mod survey_parts;
mod survey_plan;
mod terrain_heights;
mod towers;
mod trees;
mod view_targets;
mod viewer;
mod viewshed;
mod weather;
mod window_views;
pub mod windows;

pub use crate::shadow::UNPROVEN;
pub use answers::{Answered, Answers, Ask, ask};
pub use calibrate::calibrate;
pub use cameras::{
    CameraGoal, CameraLens, CameraTargets, CamerasQuestion, CamerasResults, Candidates, ChosenCamera, GivenCamera,
    PrivatePlaces,
};
pub use casters::{CASTER, caster_name};
pub use cells::GridCells;
pub use comfort::{ComfortQuestion, ComfortResults, RoutesOrWindows};
pub use context::Context;
pub use depth_map::{DepthMapQuestion, DepthMapResults, ViewFrom};
pub use envelope::{EnvelopeQuestion, EnvelopeResults, Protected, ProtectedShape, ProtectedSuns};
pub use given_places::{GivenCells, GivenPlace, GivenPlaces};
pub use glare::{GlareQuestion, GlareResults, GlareSummary};
pub use heat::HeatQuestion;
pub use horizon::{BelowLevel, HorizonQuestion, HorizonResults};
pub use how_sure::{
    BEING_FREE, EXPECTED, EXPECTED_OBSERVERS, HowSure, PROBABILITY, UNCERTAIN, check_interval, knows_intervals,
    remark_from_ground,
};
pub use in_parts::{ask_in_parts, summarise_parts};
pub use irradiance::{
    IrradianceQuestion, IrradianceResults, PvChoice, Radiation, Roofs, RoofsResults, remark_on_radiation,
};
pub use isovist::{IsovistsQuestion, IsovistsResults};
pub use landmark::{LandmarkQuestion, LandmarkResults, LandmarkShape};
pub use line_of_sight::{LinesOfSightQuestion, ProfileRows, SightColumns, SightsResults};
pub use mesh_levels::remarks_on_model;
pub use north::{AzimuthNorth, North};
pub use observers::Eyes;
pub use placed_question::PlacedQuestion;
pub use places::{NetworkPlaces, Places, Turned, remark_on_edge, remark_on_empty_areas};
pub use protected_view::{ProtectedViewQuestion, ProtectedViewResults};
pub use question::{Found, Question};
pub use reliability::with_reliability;
pub use remark::{Remark, Severity, remark_on_left_out};
pub use report::Report;
pub use scene::Scene;
#[cfg(feature = "schema")]
pub use schema::question_schema;
pub use sections::{
    CertaintySection, EnvelopeSection, ExposureSection, FacesSection, GlareSection, HeatSection, HeightFrom,
    LandmarkSection, NetworkSection, PictureSection, PlaceSection, SeenSection, TargetsSection, TowersSection,
    ViewSection,
};
pub use shadow::{ShadowQuestion, ShadowResults};
pub use shared::SharedObject;
pub use sight_network::SightNetwork;
pub use sky_view::{SkyParts, SkyViewQuestion};
pub use standing::{Reach, Standing, end_on_map, position_on_map, standing_on_map};
pub use sun::{Days, NamedSun, SunRange, Suns, check_sun, remark_on_sun};
pub use sun_and_sky::OnTargets;
pub use sun_calendar::{SunCalendarQuestion, SunCalendarResults};
pub use sun_hours::{HourlySun, SunHoursQuestion, rules};
pub use sun_place::{SOLAR, SunPlace};
pub use sun_position::{SunPositionQuestion, SunStands};
pub use survey::remarks_on_survey;
pub use survey_plan::{PlannedStation, SurveyPlanQuestion, SurveyPlanResults};
pub use terrain_heights::remark_on_terrain;
pub use towers::{FarTowers, GivenTower, MAX_WIRELINES, TowerWirelines, TowersQuestion, TowersResults};
pub use trees::{ThroughTrees, density_at, remark_on_leaves};
pub use view_targets::{ViewTargetsQuestion, ViewTargetsResults};
pub use viewer::{
    remark_on_axis, remark_on_cleared, remark_on_doubt, remark_on_eye, remark_on_faces, remark_on_inside,
    remark_on_mesh, remark_on_outside, remark_on_roofs, remark_on_targets_beside, remark_on_targets_inside,
    remark_on_unused, remarks_on_reading,
};
pub use viewshed::{FarSeen, StandingObserver, ViewLimits, ViewshedQuestion, ViewshedResults, ViewshedTargets};
pub use window_views::{WindowViewsQuestion, WindowViewsResults};
pub use windows::{GivenWindow, GivenWindows};
