//! Medial balls: the volume of a scene as a union of balls that touch its surface.

pub mod bounds;
pub mod carve;
pub mod carved;
mod cells;
mod chains;
pub mod close_range;
pub mod crowns;
pub mod feature_size;
mod layers;
pub mod orient_by_carving;
pub mod prune;
pub mod relief;
pub mod roof_edges;
pub mod shrinking_ball;
pub mod slender;
mod spacing;
pub mod thin_surfaces;
pub mod vegetation;
pub mod vegetation_balls;

pub use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls, NO_TOUCH, PULSE_TOUCH, Side};
pub use bounds::{Kind, KindBounds, RadiusBounds, kinds};
pub use carve::{CarveReport, carve};
pub use carved::{CarvedBalls, CarvedInput, CarvedParams, CarvedReport, Rule, carved_balls};
pub use close_range::CloseRangeParams;
pub use crowns::{CrownParams, Trees};
pub use orient_by_carving::{OrientByCarvingParams, OrientByCarvingReport, orient_by_carving};
pub use prune::{PruneParams, prune};
pub use relief::ReliefParams;
pub use roof_edges::RoofEdgeParams;
pub use shrinking_ball::{ShrinkMethod, ShrinkParams, ShrinkReport, shrink};
pub use slender::SlenderParams;
pub use thin_surfaces::{ThinSurfaceParams, on_thin_surfaces};
pub use vegetation::VegetationParams;
pub use vegetation_balls::{vegetation_of_classes, vegetation_of_transmission, without_vegetation};
