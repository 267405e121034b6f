//! Replacement for the database of reference systems in a build without the cargo feature `crs`: nothing is known.

use super::Crs;

/// Why nothing is known.
const REASON: &str = "this program was built without the cargo feature `crs`";

pub(super) fn system(_text: &str) -> Option<Crs> {
    None
}

pub(super) fn system_of_code(_code: u32) -> Option<Crs> {
    None
}

pub(super) fn name_of_code(_code: u32) -> Option<String> {
    None
}

pub(super) fn horizontal_code_of(_code: u32) -> Option<u32> {
    None
}

pub(super) fn vertical_metres_of_code(_code: u32) -> Option<f64> {
    None
}

/// Name of the vertical system with an EPSG code, where it counts downwards.
pub(super) fn depth_of_code(_code: u32) -> Option<String> {
    None
}

pub(super) fn wkt(_text: &str) -> Option<String> {
    None
}

pub(super) fn area_of_use(_code: u32) -> Option<[f64; 4]> {
    None
}

/// A projection of a program without the database of reference systems: there is none.
pub(super) enum CrsProjection {}

impl CrsProjection {
    pub(super) fn new(_definition: &str) -> Result<Self, String> {
        Err(REASON.to_owned())
    }

    pub(super) fn untied(_definition: &str) -> Result<Self, String> {
        Err(REASON.to_owned())
    }

    pub(super) fn forward(&self, _longitude: f64, _latitude: f64) -> Result<(f64, f64), String> {
        match *self {}
    }

    pub(super) fn back(&self, _x: f64, _y: f64) -> Result<(f64, f64), String> {
        match *self {}
    }
}
