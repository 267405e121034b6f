//! Medial balls as columns of numbers.

use crate::cast::to_row;
use crate::{Error, Result};

/// Value of [`MedialBalls::touch`] for a ball that is not bounded, or left out.
pub const NO_TOUCH: u32 = u32::MAX;

/// Value of [`MedialBalls::touch`] for a ball whose second contact is a pulse instead of a point.
pub const PULSE_TOUCH: u32 = NO_TOUCH - 1;

/// Value of [`MedialBalls::touch`] for a ball that neither a point nor a pulse bounds, but a limit of its radius.
pub const LIMIT_TOUCH: u32 = NO_TOUCH - 2;

/// Side of the surface on which a ball lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Inside the scene: centre = p − r·n for the outward normal n.
    Interior,
    /// In free space: centre = p + r·n.
    Exterior,
}

/// Medial balls, one per row.
///
/// A ball is tangent at its source point p and touches a second point q. One that met no second point is cut to a
/// limit, because the surface at p blocks all the same ([`LIMIT_TOUCH`]). Where there is no limit, as in the paper's
/// method, it keeps its initial radius: its touch is [`NO_TOUCH`], and it is not used for visibility.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MedialBalls {
    /// Centres, (B, 3), local metres.
    pub centers: Vec<[f32; 3]>,
    /// Radii, (B), metres.
    pub radii: Vec<f32>,
    /// Index of the point p each ball is tangent at, (B).
    pub source: Vec<u32>,
    /// Index of the second point q each ball touches, [`PULSE_TOUCH`] where a pulse bounds it, [`LIMIT_TOUCH`] or
    /// [`NO_TOUCH`], (B).
    pub touch: Vec<u32>,
    /// Separation angle ∠pcq in radians, (B); NaN for a ball that no point bounds.
    pub separation_angles: Vec<f32>,
}

impl MedialBalls {
    /// Number of balls.
    #[must_use]
    pub fn len(&self) -> usize {
        self.radii.len()
    }

    /// Returns true if there is no ball.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.radii.is_empty()
    }

    /// Checks that all columns are equally long.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for the first column that is not.
    pub fn validate(&self) -> Result<()> {
        let expected = self.centers.len();
        let columns = [
            ("radii of balls", self.radii.len()),
            ("source points of balls", self.source.len()),
            ("second points of balls", self.touch.len()),
            ("separation angles of balls", self.separation_angles.len()),
        ];
        match columns.into_iter().find(|(_, found)| *found != expected) {
            Some((what, found)) => Err(Error::LengthMismatch { what, expected, found }),
            None => Ok(()),
        }
    }

    /// The balls of these rows, in this order. A column without a value for a row skips that row.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        fn of<T: Copy>(column: &[T], rows: &[usize]) -> Vec<T> {
            rows.iter().filter_map(|&row| column.get(row).copied()).collect()
        }
        Self {
            centers: of(&self.centers, rows),
            radii: of(&self.radii, rows),
            source: of(&self.source, rows),
            touch: of(&self.touch, rows),
            separation_angles: of(&self.separation_angles, rows),
        }
    }

    /// Only the balls that shrank.
    #[must_use]
    pub fn shrunk(&self) -> Self {
        let is_shrunk = |row: &usize| self.touch.get(*row).is_some_and(|&touch| touch != NO_TOUCH);
        self.select(&(0..self.len()).filter(is_shrunk).collect::<Vec<_>>())
    }

    /// Adds a ball at point `source` that touches `touch` and has no separation angle.
    pub fn push(&mut self, source: usize, center: [f32; 3], radius: f32, touch: u32) {
        self.centers.push(center);
        self.radii.push(radius);
        self.source.push(to_row(source));
        self.touch.push(touch);
        self.separation_angles.push(f32::NAN);
    }
}
