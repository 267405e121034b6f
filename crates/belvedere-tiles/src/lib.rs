//! Surveys larger than memory: a city on one machine, a country on many.
//!
//! A [`Plan`] cuts the survey into tiles and keeps the statistics of the whole survey that every tile needs. Each tile
//! is then a pure function of the plan and the number of the tile ([`make_balls`], and an answer to each question). A
//! tile reads a window of the inputs, then writes its result and last its record. Each of these files appears complete
//! or not at all. The records are the ledger: a tile with a record is done. [`run`] does interrupted tiles again.
//!
//! Balls are made once for each tile, from the points of the tile and of a margin around it. A ball belongs to the tile
//! that contains the point of the ball. A question is then answered tile by tile, with the balls of all tiles that can
//! change the answer. The highest tops of balls, on squares of 16 m, identify these tiles. If balls that can change an
//! answer are missing, its cell has no value.
//!
//! # Tiles make no difference
//! Every ball and every answer is the same, bit by bit, for any size of tiles. There are three reasons:
//! - Values that a model estimates from its whole cloud are estimated once, with the plan
//!   ([`belvedere::model::SurveyStatistics`]).
//! - All tiles share one frame, in which a position has the same numbers for all of them.
//! - No step uses points farther away than the margin.

mod answer;
mod build;
mod columns;
mod grid;
mod inputs;
mod plan;
mod run;
mod sealed;

pub use build::make_balls::make_balls;
pub use grid::{TileGrid, TileId};
pub use inputs::InputFile;
pub use plan::cell_sizes::CellSizes;
pub use plan::estimate::RunEstimate;
pub use plan::make_plan::PlanParams;
pub use plan::question::{TileQuestion, Topic};
pub use plan::record::{TileOutcome, TileRecord};
pub use plan::side_files::SideFile;
pub use plan::stage::Stage;
pub use plan::{Plan, PlanFrame};
pub use run::any_size::{SurveyCells, SurveyPart, SurveyQuestion, TooLarge};
pub use run::joined::JoinedSurvey;
pub use run::merge::{Merged, UnfinishedRun, merge, merged_within, write_catalogue};
pub use run::places::SurveyPlaces;
pub use run::status::{StageStatus, Status, status};
pub use run::{RunParams, RunReport, Shard, Steps, run};
