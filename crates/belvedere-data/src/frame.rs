//! Frames of local coordinates, and boxes of them.

use crate::crs::Crs;
use crate::vector::to_f32;

/// Maximum distance from the origin of anything in a scene, and maximum radius of a ball, metres. Larger values are
/// damage: readers leave out points that are 1000 km away, and squares of much larger numbers leave the range of f32.
pub const FARTHEST: f32 = 1e7;

/// Returns true if a scene can hold a local position.
pub(crate) fn is_near(position: [f32; 3]) -> bool {
    position.iter().all(|v| v.abs() <= FARTHEST)
}

/// [`is_near`] for positions in double precision.
pub(crate) fn is_near_f64(position: [f64; 3]) -> bool {
    position.iter().all(|v| v.abs() <= f64::from(FARTHEST))
}

/// `coordinates − origin`, subtracted in f64.
#[must_use]
pub fn to_local(coordinates: [f64; 3], origin: [f64; 3]) -> [f32; 3] {
    std::array::from_fn(|i| to_f32(coordinates[i] - origin[i]))
}

/// The local coordinates of a scene: metres, x east, y north, z up, counted from an origin in a reference system.
///
/// Clouds, scenes and rasters that share a frame have comparable positions without any conversion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Position of local (0, 0, 0), metres (file coordinates times [`Crs::metres_per_unit`]).
    pub origin: [f64; 3],
    /// Reference system and unit of the file.
    pub crs: Crs,
}

impl Frame {
    /// Coordinates of a local position in the unit and reference system of the file.
    #[must_use]
    pub fn to_file_coordinates(&self, local: [f32; 3]) -> [f64; 3] {
        self.file_from_local(local.map(f64::from))
    }

    /// The same for a local position in f64.
    #[must_use]
    pub fn file_from_local(&self, local: [f64; 3]) -> [f64; 3] {
        let scale = self.crs.metres_per_unit_xyz();
        std::array::from_fn(|i| (local[i] + self.origin[i]) / scale[i])
    }

    /// Local position of coordinates in the unit and reference system of the file, rounded to f32.
    #[must_use]
    pub fn from_file_coordinates(&self, file: [f64; 3]) -> [f32; 3] {
        let scale = self.crs.metres_per_unit_xyz();
        to_local(std::array::from_fn(|i| file[i] * scale[i]), self.origin)
    }

    /// The same, not rounded.
    #[must_use]
    pub fn local_from_file(&self, file: [f64; 3]) -> [f64; 3] {
        let scale = self.crs.metres_per_unit_xyz();
        std::array::from_fn(|i| file[i] * scale[i] - self.origin[i])
    }
}

/// A box along the axes of a frame, local metres. Faces belong to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Lowest corner.
    pub low: [f32; 3],
    /// Highest corner.
    pub high: [f32; 3],
}

impl Bounds {
    /// The smallest box around `positions`, (N, 3), or `None` without any.
    #[must_use]
    pub fn around(positions: impl IntoIterator<Item = [f32; 3]>) -> Option<Self> {
        positions.into_iter().map(|p| Self { low: p, high: p }).reduce(|bounds, p| bounds.joined(&p))
    }

    /// The smallest box around both.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|i| self.low[i].min(other.low[i])),
            high: std::array::from_fn(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Lowest and highest corner in f64.
    #[must_use]
    pub fn corners(&self) -> ([f64; 3], [f64; 3]) {
        (self.low.map(f64::from), self.high.map(f64::from))
    }

    /// Lowest and highest corner on the map: x and y.
    #[must_use]
    pub fn on_map(&self) -> ([f64; 2], [f64; 2]) {
        let [low, high] = [self.low, self.high].map(|[x, y, _]| [f64::from(x), f64::from(y)]);
        (low, high)
    }

    /// Lengths of the edges, metres.
    #[must_use]
    pub fn size(&self) -> [f32; 3] {
        std::array::from_fn(|i| self.high[i] - self.low[i])
    }

    /// Returns true if `position` lies in the box or on its faces.
    #[must_use]
    pub fn contains(&self, position: [f32; 3]) -> bool {
        (0..3).all(|i| self.low[i] <= position[i] && position[i] <= self.high[i])
    }

    /// Returns true if all corners are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.low.iter().chain(&self.high).all(|v| v.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_hold_what_they_were_made_around_and_nothing_beyond() {
        let positions = [[1.0, -2.0, 3.0], [-4.0, 5.0, 0.5], [0.0, 0.0, 9.0]];
        let bounds = Bounds::around(positions).unwrap();
        assert_eq!((bounds.low, bounds.high, bounds.size()), ([-4.0, -2.0, 0.5], [1.0, 5.0, 9.0], [5.0, 7.0, 8.5]));
        assert!(positions.iter().all(|&p| bounds.contains(p)));
        assert!(!bounds.contains([1.0, 5.0, 9.001]) && !bounds.contains([f32::NAN, 0.0, 1.0]));
        assert_eq!(Bounds::around([]), None);
    }

    #[cfg(feature = "crs")]
    #[test]
    fn feet_come_back_through_a_frame() {
        let crs = Crs::parse("EPSG:2992").unwrap();
        let frame = Frame { origin: [200_000.0, 300_000.0, 10.0], crs };
        let file = frame.file_from_local([12.5, -3.25, 1.0]);
        assert!((file[0] - 200_012.5 / 0.3048).abs() < 1e-6);
        let back = frame.local_from_file(file);
        assert!(back.iter().zip([12.5, -3.25, 1.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}
