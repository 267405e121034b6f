//! Points with outward normals: the only cloud that medial balls can be shrunk from.

use belvedere_data::crs::Crs;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};

/// A cloud whose normals point out of the scene.
///
/// All columns have one value per point, every position is finite, and every normal is a unit vector or zero: the
/// fields are private so that nothing can break this.
#[derive(Clone, Debug, Default)]
pub struct OrientedCloud {
    positions: Vec<[f32; 3]>,
    origin: [f64; 3],
    crs: Crs,
    normals: Vec<[f32; 3]>,
    quality: Vec<f32>,
    confidence: Vec<f32>,
}

impl OrientedCloud {
    /// Creates a cloud from local positions, (N, 3), metres; outward normals, (N, 3), of any length; the quality of
    /// each normal's line, (N), and the confidence in its sign, (N). Quality and confidence are clamped to 0 to 1.
    ///
    /// Normals are scaled to unit length; those that are not finite or vanish become zero, with zero quality and
    /// confidence.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] where lengths differ, [`Error::InvalidParameter`] for a position that is not finite.
    pub fn new(
        positions: Vec<[f32; 3]>,
        mut normals: Vec<[f32; 3]>,
        mut quality: Vec<f32>,
        mut confidence: Vec<f32>,
    ) -> Result<Self> {
        let expected = positions.len();
        for (what, found) in [("normals", normals.len()), ("quality", quality.len()), ("confidence", confidence.len())]
        {
            if found != expected {
                return Err(Error::LengthMismatch { what, expected, found });
            }
        }
        if let Some(p) = positions.iter().find(|p| p.iter().any(|v| !v.is_finite())) {
            return Err(Error::invalid(Parameter::Position, format!("{p:?}"), "finite"));
        }
        for ((normal, quality), confidence) in normals.iter_mut().zip(&mut quality).zip(&mut confidence) {
            let unit = unit_or_zero(*normal);
            *normal = unit;
            let known = if unit == [0.0; 3] { 0.0 } else { 1.0 };
            // max first: it turns NaN into 0
            *quality = quality.max(0.0).min(known);
            *confidence = confidence.max(0.0).min(known);
        }
        Ok(Self { positions, origin: [0.0; 3], crs: Crs::default(), normals, quality, confidence })
    }

    /// Creates a cloud as [`OrientedCloud::new`] for normals that are certain, such as those of a mesh: quality and
    /// confidence 1.
    ///
    /// # Errors
    /// As [`OrientedCloud::new`].
    pub fn with_known_normals(positions: Vec<[f32; 3]>, normals: Vec<[f32; 3]>) -> Result<Self> {
        let sure = vec![1.0; positions.len()];
        Self::new(positions, normals, sure.clone(), sure)
    }

    /// The same cloud at this origin (metres) in this reference system.
    #[must_use]
    pub fn with_place(self, origin: [f64; 3], crs: Crs) -> Self {
        Self { origin, crs, ..self }
    }

    /// The same normals at other places, local metres; the cloud as it was where these are not one finite place for
    /// each point.
    pub(crate) fn moved_to(mut self, positions: Vec<[f32; 3]>) -> Self {
        if positions.len() == self.len() && positions.iter().flatten().all(|v| v.is_finite()) {
            self.positions = positions;
        }
        self
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns true if there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Local positions, (N, 3), metres.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Outward unit normals, (N, 3); zero where none is known.
    #[must_use]
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }

    /// Returns the quality of the line of each normal, (N), 0 to 1.
    #[must_use]
    pub fn quality(&self) -> &[f32] {
        &self.quality
    }

    /// Returns the confidence in the sign of each normal, (N), 0 to 1; below 0.05 it is as good as unknown.
    #[must_use]
    pub fn confidence(&self) -> &[f32] {
        &self.confidence
    }

    /// Returns the position of local (0, 0, 0), metres.
    #[must_use]
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Reference system and unit of the file.
    #[must_use]
    pub fn crs(&self) -> &Crs {
        &self.crs
    }
}

/// `vector` at unit length, or zero where it has no direction. A vector that already has unit length within rounding is
/// kept bit for bit.
pub(super) fn unit_or_zero(vector: [f32; 3]) -> [f32; 3] {
    let v = vector.map(f64::from);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if !(length.is_finite() && length > 1e-20) {
        return [0.0; 3];
    }
    if (length - 1.0).abs() < 1e-6 {
        return vector;
    }
    v.map(|x| to_f32(x / length))
}
