//! Open surveys: which published point clouds cover a place, and their points around it.
//!
//! The table `surveys.json` holds the surveys: area, licence, reference system, and the way to find tiles. A new survey
//! is a row of it.

mod index;
mod table;
mod tiles;
mod transfer;

pub use index::SurveyTile;
pub use table::{MAX_CLOUD_RADIUS, OpenSurvey, SurveyArea, TileIndex, known_surveys, read_surveys};
pub use tiles::{FoundSurvey, best_covering, find_surveys, find_tiles, surveys_at};
pub use transfer::{download_tiles, read_area, write_origin};
