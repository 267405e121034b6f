//! Medial balls: the volume of a scene as a union of balls that touch its surface.

pub mod balls;
pub mod carve;
pub mod feature_size;
pub mod shrinking_ball;

pub use balls::{MedialBalls, NO_TOUCH, Side};
pub use carve::{CarveParams, CarveReport, PULSE_TOUCH, carve};
pub use shrinking_ball::{ShrinkMethod, ShrinkParams, ShrinkReport, shrink};
