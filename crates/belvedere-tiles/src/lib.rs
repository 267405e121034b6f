//! Surveys larger than memory: a city on one machine, a country on many.
//!
//! A [`Plan`] cuts the survey into tiles and keeps what every tile must know of the whole. Then each tile is a pure
//! function of the plan and its number ([`make_balls`], and an answer to each question): it reads a window of the
//! inputs, writes its result and then its record, each of which appears whole. The records are the ledger: what has one
//! is done, and whatever was interrupted is done again by [`run`].
//!
//! Balls are made once for each tile, from the points of the tile and a margin around it, and belong to the tile that
//! their point lies in. A question is then answered tile by tile with the balls of all tiles that can matter for it:
//! the highest tops of balls, on squares of 16 m, say which these are. Where balls that can matter are missing, the
//! answer is unproven and never lit.
//!
//! # Tiles make no difference
//! Every ball and every answer is the same, bit by bit, whatever the size of the tiles. Three things make it so: what a
//! model estimates from its whole cloud is estimated once, with the plan ([`belvedere::model::SurveyStatistics`]); all
//! tiles share one frame, in which positions are the same numbers for all; and every step of the way looks at points no
//! farther away than the margin.

mod answer;
mod any_size;
mod cell_sizes;
mod cleared;
mod columns;
mod estimate;
mod grid;
mod ground_cells;
mod how_sure;
mod inputs;
mod kept;
mod lines;
mod make_balls;
mod make_plan;
mod merge;
mod obstacles;
mod parts;
mod patches;
mod plan;
mod planned;
mod proof;
mod question;
mod record;
mod report;
mod run;
mod sealed;
mod stage;
mod status;
mod strips;
mod survey;
mod window;

pub use any_size::{SurveyCells, SurveyPart, SurveyQuestion, TooLarge};
pub use cell_sizes::{CellSizes, Topic};
pub use estimate::RunEstimate;
pub use grid::{TileGrid, TileId};
pub use inputs::InputFile;
pub use make_balls::make_balls;
pub use make_plan::PlanParams;
pub use merge::{Merged, UnfinishedRun, merge, merged_within, write_catalogue};
pub use plan::{Plan, PlanFrame};
pub use planned::SideFile;
pub use question::{TileQuestion, TileRadiation};
pub use record::{TileOutcome, TileRecord};
pub use run::{RunParams, RunReport, Shard, Steps, run};
pub use stage::Stage;
pub use status::{StageStatus, Status, status};
