//! Kinds of points by class and return number, and the maximum size of balls for each.

use belvedere_data::Attributes;

/// Largest radii by the kind of point, metres, above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KindCaps {
    /// Largest radius at a point of vegetation (class 3 to 5). Default 1.
    pub vegetation_radius: f32,
    /// Largest radius at a point that is not the first return of its pulse. Something before it let the pulse through,
    /// so that it mostly lies in or under a crown, where neither its normal nor the side it was seen from says much. In
    /// spacings of pulses; default 0.95.
    pub later_return_spacings: f32,
    /// Largest radius at a point of the ground (class 2). Default 2.
    pub ground_radius: f32,
    /// Largest radius of a ball that neither a point nor a pulse bounds: one of the ground, or behind a wall that
    /// nothing was seen behind. Default 0.5, as thick as balls from points alone are at most.
    pub unbounded_radius: f32,
}

impl Default for KindCaps {
    fn default() -> Self {
        Self { vegetation_radius: 1.0, later_return_spacings: 0.95, ground_radius: 2.0, unbounded_radius: 0.5 }
    }
}

/// Kind of the surface below a point, by its class and return number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Class 2.
    Ground,
    /// Classes 3 to 5.
    Vegetation,
    /// Return after the first of its pulse, and neither ground nor vegetation.
    Later,
    /// Anything else.
    Other,
}

/// The kind of each of `count` points with these attributes, of which class and return number are used where present.
#[must_use]
pub fn kinds(attributes: &Attributes, count: usize) -> Vec<Kind> {
    let of = |column: &Option<Vec<u8>>, row: usize| column.as_ref().and_then(|values| values.get(row)).copied();
    let kind = |row| match of(&attributes.classification, row) {
        Some(2) => Kind::Ground,
        Some(3..=5) => Kind::Vegetation,
        _ if of(&attributes.return_number, row).is_some_and(|number| number > 1) => Kind::Later,
        _ => Kind::Other,
    };
    (0..count).map(kind).collect()
}
