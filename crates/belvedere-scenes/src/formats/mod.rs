//! Text formats of scenes for other programs.

mod cityjson;
mod obj;
