//! Arguments and files that several commands take: to questions, places and scenes.

pub(crate) mod camera_places;
pub(crate) mod earth;
pub(crate) mod far_terrain;
pub(crate) mod landmark_shape;
pub(crate) mod line_pairs;
pub(crate) mod map_shapes;
pub(crate) mod observers;
pub(crate) mod points;
pub(crate) mod radiation;
pub(crate) mod sun;
pub(crate) mod targets;
pub(crate) mod tree_light;
pub(crate) mod typed_places;
pub(crate) mod views;
pub(crate) mod windows;
