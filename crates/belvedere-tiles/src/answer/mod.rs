//! Answers to the questions of a plan on the cells of a tile.

pub(crate) mod cell_answers;
mod ground_cells;
mod how_sure;
pub(crate) mod lines;
pub(crate) mod obstacles;
mod parts;
pub(crate) mod proof;
mod sight;
mod strips;
pub(crate) mod surface_cells;
mod surroundings;
pub(crate) mod tile_scene;
