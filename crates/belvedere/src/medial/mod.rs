//! Medial balls: the volume of a scene as a union of balls that touch its surface.

pub mod balls;
pub mod bounds;
pub mod carve;
pub mod carved;
pub mod feature_size;
mod layers;
pub mod shrinking_ball;
pub mod thin_surfaces;

pub use balls::{MedialBalls, NO_TOUCH, Side};
pub use bounds::{Kind, KindBounds, RadiusBounds, kinds};
pub use carve::{CarveReport, PULSE_TOUCH, carve};
pub use carved::{CarvedInput, CarvedParams, CarvedReport, carved_balls};
pub use shrinking_ball::{ShrinkMethod, ShrinkParams, ShrinkReport, shrink};
pub use thin_surfaces::{ThinSurfaceParams, on_thin_surfaces};
