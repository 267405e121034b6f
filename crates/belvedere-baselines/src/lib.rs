//! Other ways of answering visibility on point clouds, each a [`belvedere::query::Visibility`], and how right they are.
//!
//! Every method gets the same [`Survey`]: what a LAZ file and its trajectory hold, and for some a model.

pub mod held_out;
pub mod hidden_points;

use belvedere::{Mesh, PointCloud};

/// What the methods may use of a place: nothing a survey would not deliver.
#[derive(Clone, Copy)]
pub struct Survey<'a> {
    /// The cloud, with the attributes of its file.
    pub cloud: &'a PointCloud,
    /// Local position of the scanner for each point, (N, 3), metres; NaN where unknown. Empty where nothing is known.
    pub scanner: &'a [[f32; 3]],
    /// A model of the place in metres of its reference system (not local), where one is given.
    pub model: Option<&'a Mesh>,
}
