//! Interface of all methods that answer visibility.

use super::Answer;
use crate::ray_index::Ray;
use belvedere_data::{Error, Parameter, Result};

/// Viewer of the targets: the other end of each line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewer<'a> {
    /// Infinitely far away, in this direction from the scene (local, unit length): the sun.
    Direction([f64; 3]),
    /// One point, local metres: an observer.
    Eye([f64; 3]),
    /// One point for each target, (M, 3), local metres: pairs of points.
    Each(&'a [[f32; 3]]),
}

/// Answers for targets, (M, 3) local metres, in their order; returned by [`Visibility::seen_from`].
pub type Sight<'a> = Box<dyn Fn(&[[f32; 3]]) -> Result<Vec<Answer>> + Sync + 'a>;

/// A model of a scene for queries of visibility: medial balls, and every method that is compared with them.
pub trait Visibility: Sync {
    /// Prepares all data that do not depend on the targets, such as a depth map or a convex hull, and returns the
    /// function that answers them.
    ///
    /// # Errors
    /// [`Error::UnsupportedViewer`] where the method knows no such viewer, [`Error::InvalidParameter`] for a viewer
    /// that is not finite. The returned function fails with [`Error::UnsupportedTargets`] where the method cannot
    /// answer targets of this kind, and with [`Error::LengthMismatch`] where [`Viewer::Each`] has another number of
    /// eyes than targets.
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>>;

    /// The answer for each of `targets`, (M, 3) local metres, seen by `viewer`.
    ///
    /// # Errors
    /// As [`Visibility::seen_from`] and its function.
    fn visible(&self, viewer: Viewer<'_>, targets: &[[f32; 3]]) -> Result<Vec<Answer>> {
        self.seen_from(viewer)?(targets)
    }

    /// Returns the probability that each of `targets`, (M, 3) local metres, is visible for `viewer`, 0 to 1, NaN
    /// without an answer. `None`, the default, for a method without probabilities.
    ///
    /// # Errors
    /// As [`Visibility::visible`].
    fn probabilities(&self, _viewer: Viewer<'_>, _targets: &[[f32; 3]]) -> Result<Option<Vec<f32>>> {
        Ok(None)
    }
}

impl Viewer<'_> {
    /// Checks that a common viewer is finite and a direction is not zero. The eyes of [`Viewer::Each`] are not looked
    /// at: a target with an eye that is not finite gets [`Answer::OutsideView`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn validate(&self) -> Result<()> {
        let (parameter, vector) = match self {
            Self::Direction(direction) => (Parameter::ViewDirection, direction),
            Self::Eye(eye) => (Parameter::Eye, eye),
            Self::Each(_) => return Ok(()),
        };
        let zero = matches!(self, Self::Direction(d) if d.iter().all(|&v| v == 0.0));
        if zero || !vector.iter().all(|v| v.is_finite()) {
            return Err(Error::invalid(
                parameter,
                format!("{vector:?}"),
                "finite, and longer than zero where it is a direction",
            ));
        }
        Ok(())
    }

    /// Checks that `targets` are as many as the eyes of [`Viewer::Each`].
    ///
    /// # Errors
    /// [`Error::LengthMismatch`].
    pub fn validate_count(&self, targets: &[[f32; 3]]) -> Result<()> {
        match self {
            Self::Each(eyes) if eyes.len() != targets.len() => {
                Err(Error::LengthMismatch { what: "eyes", expected: targets.len(), found: eyes.len() })
            }
            _ => Ok(()),
        }
    }

    /// Returns the line of sight of target `index` for exact answers: between both ends, from the first of them by
    /// [`Ray::between`], or from the target towards a viewer infinitely far away. `None` if a coordinate is not finite
    /// or the two points coincide.
    #[must_use]
    pub fn sight(&self, index: usize, target: [f32; 3]) -> Option<Ray> {
        match self {
            Self::Direction(_) => {
                let (direction, range) = self.line_of_sight(index, target)?;
                Some(Ray { origin: target.map(f64::from), direction, ranges: [0.0, range] })
            }
            Self::Eye(eye) => Ray::between(target.map(f64::from), *eye),
            Self::Each(eyes) => Ray::between(target.map(f64::from), eyes.get(index)?.map(f64::from)),
        }
    }

    /// Returns the line of sight of target `index`: the unit vector from the target to its viewer and the range of the
    /// viewer (infinite for a direction). `None` if a coordinate is not finite or the two points coincide.
    #[must_use]
    pub fn line_of_sight(&self, index: usize, target: [f32; 3]) -> Option<([f64; 3], f64)> {
        let target = target.map(f64::from);
        let eye = match self {
            Self::Direction(direction) => {
                let unit = belvedere_data::vector::unit(*direction)?;
                return target.iter().all(|v| v.is_finite()).then_some((unit, f64::INFINITY));
            }
            Self::Eye(eye) => *eye,
            Self::Each(eyes) => eyes.get(index)?.map(f64::from),
        };
        let towards: [f64; 3] = std::array::from_fn(|i| eye[i] - target[i]);
        let range = belvedere_data::vector::dot(towards, towards).sqrt();
        belvedere_data::vector::unit(towards).map(|unit| (unit, range))
    }
}
