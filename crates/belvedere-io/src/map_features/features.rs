//! Features: shapes on the map with their properties.

use serde_json::{Map, Value};

/// Geometry of a feature: absolute metres in the system of the cloud, height NaN if the file has none.
#[derive(Clone, Debug, PartialEq)]
pub enum FeatureShape {
    /// A point.
    Point([f64; 3]),
    /// A line through corners.
    Line(Vec<[f64; 3]>),
    /// Outer ring and holes.
    Polygon(Vec<Vec<[f64; 3]>>),
}

impl FeatureShape {
    /// Its corners, one ring after the other.
    pub fn corners(&self) -> impl Iterator<Item = &[f64; 3]> {
        let (one, line, rings): (_, &[[f64; 3]], &[Vec<[f64; 3]>]) = match self {
            Self::Point(place) => (Some(place), &[], &[]),
            Self::Line(corners) => (None, corners, &[]),
            Self::Polygon(rings) => (None, &[], rings),
        };
        one.into_iter().chain(line).chain(rings.iter().flatten())
    }
}

/// A shape with its properties in the file. Features of several shapes give one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFeature {
    /// Its place.
    pub shape: FeatureShape,
    /// Its properties.
    pub properties: Map<String, Value>,
    /// Number in the file, from 0: parts of a shape of several share it.
    pub number: usize,
}
