//! Other ways of answering visibility on point clouds, each a [`belvedere::query::Visibility`], and their accuracy.
//!
//! Every method gets the same [`MethodInput`]: what a LAZ file and its trajectory hold, and for some a model.
//! [`methods::methods`] lists them all, [`agreement`] scores their answers.

pub mod agreement;
pub mod audit;
mod curve;
pub mod dsm;
pub mod held_out;
pub mod hidden_points;
pub mod implicit_surface;
mod lines_of_sight;
pub mod medial;
pub mod mesh_rays;
pub mod methods;
pub mod poisson;
mod sampling;
pub mod shadow_map;
pub mod simulated;
pub mod splatting;
pub mod voxels;

use belvedere::{Mesh, PointCloud};

/// What the methods may use of a place: nothing that could not be at hand.
#[derive(Clone, Copy)]
pub struct MethodInput<'a> {
    /// The cloud, with the attributes of its file.
    pub cloud: &'a PointCloud,
    /// Local position of the scanner for each point, (N, 3), metres; NaN where unknown. Empty where nothing is known.
    pub scanner: &'a [[f32; 3]],
    /// Models of the place, such as a city model.
    pub models: &'a [PlaceModel],
}

/// A model of a place.
#[derive(Clone, Debug)]
pub struct PlaceModel {
    /// Name in tables and on the command line: lower case, digits and hyphens.
    pub name: String,
    /// Its surface, in metres of its reference system (not local).
    pub mesh: Mesh,
}
