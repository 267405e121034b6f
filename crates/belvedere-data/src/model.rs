//! The numbers that a scene consists of: the contents of a ball file.

use crate::balls::MedialBalls;
use crate::building_outlines::BuildingOutlines;
use crate::frame::{Bounds, FARTHEST, Frame, is_near};
use crate::free_segments::FreeSegmentColumns;
use crate::medium::ExtinctionVoxels;
use crate::patches::SurfacePatches;
use crate::{Error, Parameter, Result};
use std::collections::BTreeMap;

/// The plain data of a scene model: the contents of a ball file.
///
/// The crate `belvedere` makes it from a cloud and answers from it (`SceneModel`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelParts {
    /// Local coordinates of everything here: the frame of the cloud that the model was made from.
    pub frame: Frame,
    /// The smallest box around the points that the balls were made from, local metres: a view must hold it to show the
    /// scene. The balls may reach far beyond it.
    pub bounds: Bounds,
    /// The balls that block lines of sight.
    pub balls: MedialBalls,
    /// Share of the pulses that passed the part of a crown that a ball belongs to, (B), 0 to 1. NaN for a ball that is
    /// no vegetation, and 0 for vegetation that was not measured. Empty if vegetation is unknown.
    pub transmission: Vec<f32>,
    /// Surfaces that are known better than from single balls, and block beside them.
    pub patches: SurfacePatches,
    /// Surfaces of buildings; they block nothing. Only `.npz` files keep them.
    pub outlines: BuildingOutlines,
    /// Crowns as a medium, where pulses measured them. Only `.npz` files keep them.
    pub medium: Option<ExtinctionVoxels>,
    /// The pulses that prove lines of sight free, where they are known.
    pub pulses: Option<FreeSegmentColumns>,
    /// Construction of the model, by name: side, method, parameters, program, input.
    pub provenance: BTreeMap<String, String>,
}

/// Parts that follow from those of a model or were found with them, and take long to make again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DerivedParts {
    /// True for balls that are vegetation, (B); empty if that is not known.
    pub vegetation: Vec<bool>,
    /// Outward unit normals of the points that the model was built from, (N, 3); `None` where they were let go.
    pub normals: Option<Vec<[f32; 3]>>,
    /// The tree of boxes around the balls; `None` where it was not made.
    pub tree: Option<TreeParts>,
    /// Proof made from the pulses; `None` if it was not made.
    pub proof: Option<ProofParts>,
}

/// Pulses in the order of their index, and the space that they saw, as numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProofParts {
    /// Rows of the pulses in the order of the index, (P).
    pub order: Vec<u32>,
    /// Boxes around the pulses of each node of the index, at two planes, and these, (K, 10), local metres.
    pub boxes: Vec<[f32; 10]>,
    /// Columns of boxes over the survey, each a word of bits: which boxes are known to be near pulses. Empty where not
    /// all were made.
    pub seen_space: Vec<u64>,
}

/// A tree of boxes, as numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeParts {
    /// The nodes, (K, 20), each as the words of its fields.
    pub nodes: Vec<[u32; 20]>,
    /// For each row of the tree, which of the boxes it is, (B).
    pub order: Vec<u32>,
    /// Middle and half size of the box around all, local metres, (2, 3).
    pub around: [[f64; 3]; 2],
}

/// Triangulated ground points of a cloud and its returns, sorted by squares on the map, as numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroundParts {
    /// Ground points, (G, 3), local metres, sorted by their coordinates.
    pub points: Vec<[f32; 3]>,
    /// Rows of the corners of the triangles, (T, 3).
    pub triangles: Vec<[u32; 3]>,
    /// Numbers of triangles that reach into many squares.
    pub large: Vec<u32>,
    /// South-west corner of the squares, their side, and the number of their columns and rows less one.
    pub squares: [f64; 5],
    /// First triangle, point and return of each square, and the number of each, (S + 1, 3).
    pub starts: Vec<[u64; 3]>,
    /// Numbers of triangles, by square.
    pub triangles_of_squares: Vec<u32>,
    /// Rows of points, by square.
    pub points_of_squares: Vec<u32>,
    /// Places of returns on the map, by square, local metres.
    pub returns: Vec<[f32; 2]>,
}

impl ModelParts {
    /// The same with a further note on how they were made, such as the name of the input.
    #[must_use]
    pub fn with_provenance(mut self, name: &str, value: impl Into<String>) -> Self {
        self.provenance.insert(name.to_owned(), value.into());
        self
    }

    /// Checks that all columns are equally long, and centres, bounds and origin within [`FARTHEST`]. Checks that radii
    /// are within it too and not negative, and transmissions between 0 and 1. Checks the patches, the outlines of
    /// buildings and the pulses.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] or [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        self.balls.validate()?;
        let (expected, found) = (self.balls.len(), self.transmission.len());
        if !(found == 0 || found == expected) {
            return Err(Error::LengthMismatch { what: "transmissions of balls", expected, found });
        }
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        if let Some(c) = self.balls.centers.iter().find(|c| !is_near(**c)) {
            return invalid(Parameter::Ball, format!("at {c:?}"), "within 10000 km of the origin");
        }
        if let Some(r) = self.balls.radii.iter().find(|r| !(0.0..=FARTHEST).contains(*r)) {
            return invalid(Parameter::Ball, format!("of radius {r}"), "of radius 0 to 10000 km");
        }
        let Bounds { low, high } = self.bounds;
        if !(is_near(low) && is_near(high) && low.iter().zip(&high).all(|(low, high)| low <= high)) {
            let corners = format!("in the bounds {:?}", (low, high));
            return invalid(
                Parameter::Ball,
                corners,
                "in bounds from the lowest to the highest corner, within 10000 km of the origin",
            );
        }
        // a zone before the easting gives some 60 000 km; vertical systems and units add nothing to that
        if self.frame.origin.iter().any(|v| !(v.abs() <= 1e9)) {
            return invalid(Parameter::Origin, format!("{:?}", self.frame.origin), "within a million km of zero");
        }
        if let Some(t) = self.transmission.iter().find(|t| !(t.is_nan() || (0.0..=1.0).contains(*t))) {
            return invalid(Parameter::Ball, format!("of transmission {t}"), "of transmission 0 to 1, or NaN");
        }
        self.patches.validate()?;
        self.outlines.validate()?;
        self.medium.as_ref().map_or(Ok(()), ExtinctionVoxels::validate)?;
        self.pulses.as_ref().map_or(Ok(()), FreeSegmentColumns::validate)
    }
}
