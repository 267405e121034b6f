//! Medial balls: the volume of a scene as a union of balls that touch its surface.

pub mod balls;

pub use balls::{MedialBalls, NO_TOUCH, Side};
