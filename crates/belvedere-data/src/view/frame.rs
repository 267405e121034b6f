//! Position of a viewer and orientation of its picture.

use crate::vector::{cross, dot, unit};

/// Position and orientation of a viewer in local coordinates.
///
/// `right`, `down` and `forward` are orthonormal and right-handed: `right × down = forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    /// The upper left corner of the picture plane for a parallel view, the eye for the others, local metres.
    pub eye: [f64; 3],
    /// Unit vector along the rows of the picture.
    pub right: [f64; 3],
    /// Unit vector along the columns of the picture, downward.
    pub down: [f64; 3],
    /// Unit vector of sight.
    pub forward: [f64; 3],
}

impl ViewFrame {
    /// The frame at `eye`, local metres, that looks along the unit vector `forward`. The picture's up is the world's
    /// up, or north when looking straight down or up.
    #[must_use]
    pub(super) fn looking(eye: [f64; 3], forward: [f64; 3]) -> Self {
        // within a thousandth of straight up or down there is no usable sideways vector from the world's up
        let up = if forward[2].abs() < 1.0 - 1e-6 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
        let right = unit(cross(forward, up)).unwrap_or([1.0, 0.0, 0.0]);
        Self { eye, right, down: cross(forward, right), forward }
    }

    /// Coordinates of a local position in this frame: along right, down and forward, metres.
    #[must_use]
    pub fn view_from_local(&self, local: [f32; 3]) -> [f64; 3] {
        let d: [f64; 3] = std::array::from_fn(|i| f64::from(local[i]) - self.eye[i]);
        [dot(self.right, d), dot(self.down, d), dot(self.forward, d)]
    }

    /// Local position of coordinates along right, down and forward.
    #[must_use]
    pub fn local_from_view(&self, view: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| {
            self.eye[i] + view[0] * self.right[i] + view[1] * self.down[i] + view[2] * self.forward[i]
        })
    }
}
