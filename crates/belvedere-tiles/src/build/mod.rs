//! Balls of a tile, its pulses, crowns and surface patches, without cleared objects.

pub(crate) mod cleared;
pub(crate) mod make_balls;
pub(crate) mod patches;
pub(crate) mod tile_pulses;
