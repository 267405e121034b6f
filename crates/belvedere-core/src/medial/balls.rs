//! The balls themselves, as columns.

use belvedere_data::{Error, Result};

/// Value of [`MedialBalls::touch`] for a ball that never shrank.
pub const NO_TOUCH: u32 = u32::MAX;

/// Which side of the surface a ball lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Inside the scene: centre = p − r·n for the outward normal n.
    Interior,
    /// In free space: centre = p + r·n.
    Exterior,
}

/// Medial balls, one per row.
///
/// A ball is tangent at its source point p and touches a second point q. One that met no second point kept its initial
/// radius: its touch is [`NO_TOUCH`], it says nothing about the scene and is never used for visibility.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MedialBalls {
    /// Centres, (B, 3), local metres.
    pub centers: Vec<[f32; 3]>,
    /// Radii, (B), metres.
    pub radii: Vec<f32>,
    /// Index of the point p each ball is tangent at, (B).
    pub source: Vec<u32>,
    /// Index of the second point q each ball touches, [`super::PULSE_TOUCH`] where a pulse bounds it, or [`NO_TOUCH`], (B).
    pub touch: Vec<u32>,
    /// Separation angle ∠pcq in radians, (B); NaN for a ball that never shrank or that a pulse bounds.
    pub separation_angles: Vec<f32>,
}

impl MedialBalls {
    /// Checks that all columns are equally long.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for the first column that is not.
    pub fn validate(&self) -> Result<()> {
        let expected = self.radii.len();
        let columns = [
            ("centres of balls", self.centers.len()),
            ("source points of balls", self.source.len()),
            ("touching points of balls", self.touch.len()),
            ("separation angles of balls", self.separation_angles.len()),
        ];
        match columns.into_iter().find(|(_, found)| *found != expected) {
            Some((what, found)) => Err(Error::LengthMismatch { what, expected, found }),
            None => Ok(()),
        }
    }

    /// Number of balls.
    #[must_use]
    pub fn len(&self) -> usize {
        self.radii.len()
    }

    /// Only the balls that shrank.
    #[must_use]
    pub fn shrunk(&self) -> Self {
        let rows: Vec<usize> = (0..self.len()).filter(|&i| self.touch[i] != NO_TOUCH).collect();
        Self {
            centers: rows.iter().map(|&i| self.centers[i]).collect(),
            radii: rows.iter().map(|&i| self.radii[i]).collect(),
            source: rows.iter().map(|&i| self.source[i]).collect(),
            touch: rows.iter().map(|&i| self.touch[i]).collect(),
            separation_angles: rows.iter().map(|&i| self.separation_angles[i]).collect(),
        }
    }

    /// Adds a ball at point `source` that touches `touch` and has no separation angle.
    pub(super) fn push(&mut self, source: usize, center: [f32; 3], radius: f32, touch: u32) {
        self.centers.push(center);
        self.radii.push(radius);
        #[expect(clippy::cast_possible_truncation, reason = "rows of a cloud are numbered with 32 bits everywhere")]
        self.source.push(source as u32);
        self.touch.push(touch);
        self.separation_angles.push(f32::NAN);
    }

    /// Whether there is no ball.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.radii.is_empty()
    }
}
