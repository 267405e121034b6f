//! Scenes as text that other programs read.

mod cityjson;
mod obj;
